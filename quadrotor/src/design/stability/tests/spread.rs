//! Noise spreads nonlinear flights as far as the report says.

use super::flight::{End, designed, fly, towards};
use crate::{Configuration, ControllerKind, Sensors};

/// Little noise, so that no limit is active. Over a minute the standard deviation of the slowest loops is known to about a sixth.
#[test]
fn noise_spreads_tilt_position_and_height_as_the_report_says() {
    for (kind, output_feedback) in
        [(ControllerKind::Lmpc, false), (ControllerKind::Lmpc, true), (ControllerKind::Dlqr, false)]
    {
        let mut configuration = Configuration::default();
        configuration.controllers.kind = kind;
        configuration.sensors = Sensors {
            output_feedback,
            position_noise_m: 2e-3,
            velocity_noise_m_s: 2e-3,
            // Beside the predictor, attitude noise moves the height by the squares of the rotors' speeds, which no linear
            // loop has.
            attitude_noise_rad: if output_feedback { 0.0 } else { 1e-3 },
            body_rate_noise_rad_s: 1e-3,
            seed: 1,
        };
        let design = designed(&configuration).expect("a design");
        let [_, _, yaw, north, _, altitude] =
            design.stability.loops().map(|each| each.spread.expect("noise"));
        let (mut count, mut sums, mut squares) = (0.0, [0.0; 6], [0.0; 6]);
        let end = fly(design, &towards([0.0; 3], 0.0), 65.0, 10_000, |outputs| {
            if outputs.time_us > 5_000_000 {
                count += 1.0;
                let (angle, place) = (outputs.attitude_rad, outputs.position_m);
                for (index, seen) in
                    [angle.x, angle.y, place.x, place.y, place.z, angle.z].into_iter().enumerate()
                {
                    sums[index] += seen;
                    squares[index] += seen * seen;
                }
            }
        });
        assert_eq!(end, End::Flown);
        let variance = |index: usize| squares[index] / count - (sums[index] / count) * (sums[index] / count);
        let both = |one, other| libm::sqrt((variance(one) + variance(other)) / 2.0);
        let measured = [both(0, 1), both(2, 3), both(4, 4), both(5, 5)];
        let expected = [north.angle_rad, north.position_m, altitude.position_m, yaw.angle_rad];
        for (measured, expected) in measured.into_iter().zip(expected).filter(|(_, expected)| *expected > 0.0)
        {
            assert!(
                (measured / expected - 1.0).abs() < 0.25,
                "{kind:?} {output_feedback}: {measured} {expected}"
            );
        }
    }
}
