//! The estimator, in the messages of ArduPilot's third filter.

use vehicle::world::heading_deg;

use super::field::{Field, field, instance};
use crate::flight_log::LogSource;

fn believed<'a>(source: &LogSource<'a>) -> &'a quadrotor::Outputs {
    source.vehicle.outputs()
}

fn horizontal_m(source: &LogSource<'_>) -> f64 {
    source.vehicle.estimate().map_or(0.0, |estimate| estimate.horizontal_accuracy_m)
}

/// Bits of what of the solution is valid, with the numbers of EKF_STATUS_REPORT.
fn solution(source: &LogSource<'_>) -> f64 {
    let valid = source.vehicle.validity();
    let bits = [
        (valid.tilt && valid.heading, 0),
        (valid.horizontal_velocity, 1),
        (valid.vertical_velocity, 2),
        (valid.horizontal_position, 3),
        (valid.horizontal_position, 4),
        (valid.vertical_position, 5),
        (valid.horizontal_position, 8),
        (valid.horizontal_position, 9),
    ];
    f64::from(bits.into_iter().map(|(set, bit)| u16::from(set) << bit).sum::<u16>())
}

/// State: attitude, velocity, place.
pub const XKF1: &[Field] = &[
    instance("C"),
    field("Roll", 'c', 'd', 'B', |source| believed(source).attitude_rad.x.to_degrees()),
    field("Pitch", 'c', 'd', 'B', |source| believed(source).attitude_rad.y.to_degrees()),
    field("Yaw", 'C', 'h', 'B', |source| heading_deg(believed(source).attitude_rad.z)),
    field("VN", 'f', 'n', '0', |source| believed(source).velocity_m_s.x),
    field("VE", 'f', 'n', '0', |source| believed(source).velocity_m_s.y),
    field("VD", 'f', 'n', '0', |source| believed(source).velocity_m_s.z),
    field("dPD", 'f', 'n', '0', |source| believed(source).velocity_m_s.z),
    field("PN", 'f', 'm', '0', |source| believed(source).position_m.x),
    field("PE", 'f', 'm', '0', |source| believed(source).position_m.y),
    field("PD", 'f', 'm', '0', |source| believed(source).position_m.z),
    field("GX", 'c', 'k', 'B', |_| 0.0),
    field("GY", 'c', 'k', 'B', |_| 0.0),
    field("GZ", 'c', 'k', 'B', |_| 0.0),
    field("OH", 'e', 'm', 'B', |source| source.vehicle.frame().origin().altitude_m),
];

/// State: wind and field.
pub const XKF2: &[Field] = &[
    instance("C"),
    field("AX", 'c', '-', '-', |_| 0.0),
    field("AY", 'c', '-', '-', |_| 0.0),
    field("AZ", 'c', '-', '-', |_| 0.0),
    field("VWN", 'c', 'n', 'B', |source| source.vehicle.wind_m_s().x),
    field("VWE", 'c', 'n', 'B', |source| source.vehicle.wind_m_s().y),
    field("MN", 'h', 'G', 'C', |_| 0.0),
    field("ME", 'h', 'G', 'C', |_| 0.0),
    field("MD", 'h', 'G', 'C', |_| 0.0),
    field("MX", 'h', 'G', 'C', |_| 0.0),
    field("MY", 'h', 'G', 'C', |_| 0.0),
    field("MZ", 'h', 'G', 'C', |_| 0.0),
    field("IDX", 'f', 'o', '0', |_| 0.0),
    field("IDY", 'f', 'o', '0', |_| 0.0),
    field("IS", 'f', 'r', '0', |_| 0.0),
];

/// Innovations: our estimator tells their ratios to what it expects, which are below.
pub const XKF3: &[Field] = &[
    instance("C"),
    field("IVN", 'c', 'n', 'B', |_| 0.0),
    field("IVE", 'c', 'n', 'B', |_| 0.0),
    field("IVD", 'c', 'n', 'B', |_| 0.0),
    field("IPN", 'c', 'm', 'B', |_| 0.0),
    field("IPE", 'c', 'm', 'B', |_| 0.0),
    field("IPD", 'c', 'm', 'B', |_| 0.0),
    field("IMX", 'h', 'G', 'C', |_| 0.0),
    field("IMY", 'h', 'G', 'C', |_| 0.0),
    field("IMZ", 'h', 'G', 'C', |_| 0.0),
    field("IYAW", 'c', 'd', 'B', |_| 0.0),
    field("IVT", 'c', '?', 'B', |_| 0.0),
    field("RErr", 'f', '-', '0', |_| 0.0),
    field("ErSc", 'f', '-', '0', |_| 0.0),
];

/// Ratios of the innovations and health.
pub const XKF4: &[Field] = &[
    instance("C"),
    field("SV", 'c', '-', '-', |source| source.test_ratios().velocity),
    field("SP", 'c', '-', '-', |source| source.test_ratios().horizontal_position),
    field("SH", 'c', '-', '-', |source| source.test_ratios().height),
    field("SM", 'c', '-', '-', |source| source.test_ratios().heading),
    field("SVT", 'c', '-', '-', |_| 0.0),
    field("errRP", 'f', '-', '-', |_| 0.0),
    field("OFN", 'f', 'm', '?', horizontal_m),
    field("OFE", 'f', 'm', '?', horizontal_m),
    field("FS", 'H', '-', '-', |_| 0.0),
    field("TS", 'B', '-', '-', |_| 0.0),
    field("SS", 'I', '-', '-', solution),
    field("GPS", 'H', '-', '-', |_| 0.0),
    field("PI", 'b', '-', '-', |_| 0.0),
];
