//! What is worth a warning about a configuration that flies.

use thiserror::Error;

/// Why a vehicle with this configuration will fly badly: it is accepted, but its user should know.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum StabilityWarning {
    /// A loop oscillates long after each disturbance.
    #[error(
        "the {name} loop swings: damping ratio {damping_ratio:.2} at {frequency_rad_s:.1} rad/s; lower its weights \
         or airframe.rotor.time_constant"
    )]
    Swings {
        /// The loop.
        name: &'static str,
        /// Damping ratio of its least damped mode.
        damping_ratio: f64,
        /// Angular frequency of that mode, rad/s.
        frequency_rad_s: f64,
    },
    /// A loop is slow to correct errors.
    #[error(
        "the {name} loop is slow: errors decay with a time constant of {time_constant_s:.0} s; raise its output weight \
         or lower its rate and increment weights"
    )]
    Slow {
        /// The loop.
        name: &'static str,
        /// Time constant of its slowest mode, s.
        time_constant_s: f64,
    },
    /// The position controller is too fast for the attitude controller: only the torque that is fed forward to the attitude
    /// reference keeps them stable, and saturation cuts that off.
    #[error(
        "the {name} loop is stable only while no torque saturates: the attitude controller is too slow for it; lower \
         controller.attitude.increment_weight or raise controller.position.increment_weight"
    )]
    SlowAttitude {
        /// "north" or "east".
        name: &'static str,
    },
    /// The attitude controller answers measurement noise with more torque than the rotors have.
    #[error(
        "measurement noise saturates the {name} torque: the commands spread over {share:.1} times what the rotors can \
         make; lower the sensor noise or raise controller.attitude.increment_weight"
    )]
    Saturated {
        /// The axis.
        name: &'static str,
        /// Standard deviation of the commanded torque as a multiple of the largest torque in hover.
        share: f64,
    },
    /// Measurement noise makes the vehicle lean a good part of its tilt limit.
    #[error(
        "measurement noise tilts the vehicle by {tilt_rad:.2} rad (standard deviation), and limits.tilt is \
         {limit_rad} rad; lower the sensor noise or set sensor.output_feedback"
    )]
    Shaken {
        /// Standard deviation of the tilt about one axis, rad.
        tilt_rad: f64,
        /// limits.tilt, rad.
        limit_rad: f64,
    },
    /// No rigid body has such moments of inertia.
    #[error(
        "no rigid body has airframe.inertia = {x}, {y}, {z} kg·m²: each moment must be at most the sum of the other two"
    )]
    Inertia {
        /// J_x, kg·m².
        x: f64,
        /// J_y, kg·m².
        y: f64,
        /// J_z, kg·m².
        z: f64,
    },
    /// No propeller has so much drag torque beside its thrust.
    #[error(
        "no propeller has airframe.rotor.torque_coefficient = {ratio_m:.2} m times airframe.rotor.thrust_coefficient: it \
         must be at most airframe.arm_length = {arm_length_m} m; lower airframe.rotor.torque_coefficient"
    )]
    RotorDrag {
        /// Drag torque of a rotor over its thrust, m.
        ratio_m: f64,
        /// airframe.arm_length, m.
        arm_length_m: f64,
    },
}
