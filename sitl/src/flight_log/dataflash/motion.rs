//! Attitude, rates, place and the references that are flown.

use quadrotor::PositionReference;
use vehicle::world::heading_deg;
use vehicle::{SteeringKind, TICK_S};

use super::field::{Field, field};
use crate::flight_log::LogSource;

fn wanted_deg(source: &LogSource<'_>) -> [f64; 3] {
    let (roll, pitch, yaw) = source.vehicle.tracked_attitude().attitude.euler_angles();
    [roll.to_degrees(), pitch.to_degrees(), heading_deg(yaw)]
}

fn attitude_deg(source: &LogSource<'_>) -> [f64; 3] {
    let [roll, pitch, yaw] = source.vehicle.outputs().attitude_rad.into();
    [roll.to_degrees(), pitch.to_degrees(), heading_deg(yaw)]
}

fn yaw_error_deg(source: &LogSource<'_>) -> f64 {
    vehicle::wrapped((wanted_deg(source)[2] - attitude_deg(source)[2]).to_radians()).to_degrees().abs()
}

fn lean_error_deg(source: &LogSource<'_>) -> f64 {
    let (wanted, actual) = (wanted_deg(source), attitude_deg(source));
    libm::hypot(wanted[0] - actual[0], wanted[1] - actual[1])
}

fn rate_deg_s(source: &LogSource<'_>) -> [f64; 3] {
    source.vehicle.outputs().body_rate_rad_s.map(f64::to_degrees).into()
}

fn wanted_rate_deg_s(source: &LogSource<'_>) -> [f64; 3] {
    source.vehicle.tracked_attitude().body_rate_rad_s.map(f64::to_degrees).into()
}

/// Torques as shares of what the arms could make with the strongest thrust.
fn torque_share(source: &LogSource<'_>) -> [f64; 3] {
    let airframe = &source.vehicle.simulation().configuration().airframe;
    let most_n_m = source.strongest_n() * airframe.arm_length_m;
    source.vehicle.outputs().torque_n_m.map(|torque| torque / most_n_m).into()
}

fn throttle(source: &LogSource<'_>) -> f64 {
    source.vehicle.outputs().thrust_n / source.strongest_n()
}

/// The reference where the vehicle is steered by position, else its own motion.
fn reference(source: &LogSource<'_>) -> PositionReference {
    let now = source.vehicle.outputs();
    if source.vehicle.steering_kind() == SteeringKind::Position {
        return now.setpoint;
    }
    PositionReference {
        position_m: now.position_m,
        velocity_m_s: now.velocity_m_s,
        acceleration_m_s2: now.acceleration_m_s2,
        ..now.setpoint
    }
}

fn home_z_m(source: &LogSource<'_>) -> f64 {
    source.vehicle.home().position_m.z
}

/// Attitude, wanted and actual.
pub const ATT: &[Field] = &[
    field("DesRoll", 'c', 'd', 'B', |source| wanted_deg(source)[0]),
    field("Roll", 'c', 'd', 'B', |source| attitude_deg(source)[0]),
    field("DesPitch", 'c', 'd', 'B', |source| wanted_deg(source)[1]),
    field("Pitch", 'c', 'd', 'B', |source| attitude_deg(source)[1]),
    field("DesYaw", 'C', 'h', 'B', |source| wanted_deg(source)[2]),
    field("Yaw", 'C', 'h', 'B', |source| attitude_deg(source)[2]),
    field("ErrRP", 'C', 'd', 'B', lean_error_deg),
    field("ErrYaw", 'C', 'h', 'B', yaw_error_deg),
    field("AEKF", 'B', '-', '-', |_| 3.0),
];

/// The same as the attitude controller has it, and its time step.
pub const ANG: &[Field] = &[
    field("DesRoll", 'f', 'd', '0', |source| wanted_deg(source)[0]),
    field("Roll", 'f', 'd', '0', |source| attitude_deg(source)[0]),
    field("DesPitch", 'f', 'd', '0', |source| wanted_deg(source)[1]),
    field("Pitch", 'f', 'd', '0', |source| attitude_deg(source)[1]),
    field("DesYaw", 'f', 'h', '0', |source| wanted_deg(source)[2]),
    field("Yaw", 'f', 'h', '0', |source| attitude_deg(source)[2]),
    field("Dt", 'f', 's', '0', |_| TICK_S),
];

/// Rates, wanted and actual, and what the controllers make of them.
pub const RATE: &[Field] = &[
    field("RDes", 'f', 'k', '-', |source| wanted_rate_deg_s(source)[0]),
    field("R", 'f', 'k', '-', |source| rate_deg_s(source)[0]),
    field("ROut", 'f', '-', '-', |source| torque_share(source)[0]),
    field("PDes", 'f', 'k', '-', |source| wanted_rate_deg_s(source)[1]),
    field("P", 'f', 'k', '-', |source| rate_deg_s(source)[1]),
    field("POut", 'f', '-', '-', |source| torque_share(source)[1]),
    field("YDes", 'f', 'k', '-', |source| wanted_rate_deg_s(source)[2]),
    field("Y", 'f', 'k', '-', |source| rate_deg_s(source)[2]),
    field("YOut", 'f', '-', '-', |source| torque_share(source)[2]),
    field("ADes", 'f', 'o', '0', |source| -reference(source).acceleration_m_s2.z),
    field("A", 'f', 'o', '0', |source| -source.vehicle.outputs().acceleration_m_s2.z),
    field("AOut", 'f', '-', '-', throttle),
];

/// Where it is.
pub const POS: &[Field] = &[
    field("Lat", 'L', 'D', 'G', |source| source.place(source.vehicle.outputs()).latitude_deg),
    field("Lng", 'L', 'U', 'G', |source| source.place(source.vehicle.outputs()).longitude_deg),
    field("Alt", 'f', 'm', '0', |source| source.place(source.vehicle.outputs()).altitude_m),
    field("RelHomeAlt", 'f', 'm', '0', |source| home_z_m(source) - source.vehicle.outputs().position_m.z),
    field("RelOriginAlt", 'f', 'm', '0', |source| -source.vehicle.outputs().position_m.z),
];

/// Throttle and height.
pub const CTUN: &[Field] = &[
    field("ThI", 'f', '-', '-', throttle),
    field("ABst", 'f', '-', '-', |_| 0.0),
    field("ThO", 'f', '-', '-', throttle),
    field("ThH", 'f', '-', '-', |source| {
        source.vehicle.simulation().configuration().airframe.hover_thrust_share()
    }),
    field("DAlt", 'f', 'm', '0', |source| home_z_m(source) - reference(source).position_m.z),
    field("Alt", 'f', 'm', '0', |source| home_z_m(source) - source.vehicle.outputs().position_m.z),
    field("BAlt", 'e', 'm', 'B', |source| {
        source.barometer().0 - source.vehicle.frame().origin().altitude_m + home_z_m(source)
    }),
    field("DSAlt", 'f', 'm', '0', |_| f64::NAN),
    field("SAlt", 'f', 'm', '0', |_| f64::NAN),
    field("TAlt", 'f', 'm', '0', |_| f64::NAN),
    field("DCRt", 'h', 'n', 'B', |source| -100.0 * reference(source).velocity_m_s.z),
    field("CRt", 'h', 'n', 'B', |source| -100.0 * source.vehicle.outputs().velocity_m_s.z),
];

macro_rules! position_control {
    ($name:ident, $text:literal, $axis:ident, $target:literal, $position:literal, $desired_velocity:literal, $target_velocity:literal,
     $velocity:literal, $desired_acceleration:literal, $target_acceleration:literal, $acceleration:literal) => {
        #[doc = $text]
        pub const $name: &[Field] = &[
            field($target, 'f', 'm', '0', |source| reference(source).position_m.$axis),
            field($position, 'f', 'm', '0', |source| source.vehicle.outputs().position_m.$axis),
            field($desired_velocity, 'f', 'n', '0', |source| reference(source).velocity_m_s.$axis),
            field($target_velocity, 'f', 'n', '0', |source| reference(source).velocity_m_s.$axis),
            field($velocity, 'f', 'n', '0', |source| source.vehicle.outputs().velocity_m_s.$axis),
            field($desired_acceleration, 'f', 'o', '0', |source| reference(source).acceleration_m_s2.$axis),
            field($target_acceleration, 'f', 'o', '0', |source| reference(source).acceleration_m_s2.$axis),
            field($acceleration, 'f', 'o', '0', |source| source.vehicle.outputs().acceleration_m_s2.$axis),
        ];
    };
}

position_control!(
    PSCN,
    "The position controller, north.",
    x,
    "TPN",
    "PN",
    "DVN",
    "TVN",
    "VN",
    "DAN",
    "TAN",
    "AN"
);
position_control!(
    PSCE,
    "The position controller, east.",
    y,
    "TPE",
    "PE",
    "DVE",
    "TVE",
    "VE",
    "DAE",
    "TAE",
    "AE"
);
position_control!(
    PSCD,
    "The position controller, down.",
    z,
    "TPD",
    "PD",
    "DVD",
    "TVD",
    "VD",
    "DAD",
    "TAD",
    "AD"
);

/// The truth.
pub const SIM: &[Field] = &[
    field("Roll", 'c', 'd', 'B', |source| source.vehicle.truth().attitude_rad.x.to_degrees()),
    field("Pitch", 'c', 'd', 'B', |source| source.vehicle.truth().attitude_rad.y.to_degrees()),
    field("Yaw", 'C', 'h', 'B', |source| heading_deg(source.vehicle.truth().attitude_rad.z)),
    field("Alt", 'f', 'm', '0', |source| source.place(source.vehicle.truth()).altitude_m),
    field("Lat", 'L', 'D', 'G', |source| source.place(source.vehicle.truth()).latitude_deg),
    field("Lng", 'L', 'U', 'G', |source| source.place(source.vehicle.truth()).longitude_deg),
    field("Q1", 'f', '?', '?', |source| source.vehicle.truth().quaternion[0]),
    field("Q2", 'f', '?', '?', |source| source.vehicle.truth().quaternion[1]),
    field("Q3", 'f', '?', '?', |source| source.vehicle.truth().quaternion[2]),
    field("Q4", 'f', '?', '?', |source| source.vehicle.truth().quaternion[3]),
];
