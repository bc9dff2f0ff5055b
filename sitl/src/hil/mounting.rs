//! Which rotor of an airframe each motor of the autopilot drives.

use core::f64::consts::{FRAC_PI_4, FRAC_PI_6, PI};

use nalgebra::{UnitQuaternion, Vector3};
use quadrotor::{ConfigurationError, Direction, RotorLayout};

use super::mount::Mount;

/// An autopilot on an airframe: its heading on it, and its motors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mounting {
    /// Heading of the autopilot minus that of the airframe, rad.
    pub yaw_rad: f64,
    /// The airframe's rotor of each of motors 1 to 4.
    rotors: [usize; 4],
}

/// Headings of the autopilot on the airframe, in eighths of a turn, the most natural ones first.
const TURNS: [i8; 8] = [0, 1, -1, 2, -2, 3, -3, 4];
/// A rotor may be this far beside the place of its motor, rad: an X that is longer than wide is one.
const BESIDE_RAD: f64 = FRAC_PI_6;

impl Mounting {
    /// Turns the autopilot, as little as possible, until its motors lie on rotors that turn as PX4's motors do.
    ///
    /// # Errors
    /// [`ConfigurationError::Layout`] when no turn does that.
    pub fn new(mount: Mount, layout: &RotorLayout) -> Result<Self, ConfigurationError> {
        let turned = TURNS.into_iter().find_map(|turn| {
            let yaw_rad = f64::from(turn) * FRAC_PI_4;
            let rotor = |motor: usize| rotor_at(mount, motor, yaw_rad, layout);
            let rotors = [rotor(0)?, rotor(1)?, rotor(2)?, rotor(3)?];
            Some(Self { yaw_rad, rotors })
        });
        turned.ok_or(ConfigurationError::Layout {
            reason: "its rotors do not turn as the motors of PX4's quad x do; start without --hil",
        })
    }

    /// The autopilot's axes into the airframe's, FRD.
    pub fn rotation(&self) -> UnitQuaternion<f64> {
        UnitQuaternion::from_axis_angle(&Vector3::z_axis(), self.yaw_rad)
    }

    /// Values of motors 1 to 4 in the order of the airframe's rotors.
    pub fn rotors(&self, motors: [f64; 4]) -> [f64; 4] {
        let mut values = [0.0; 4];
        for (rotor, motor) in self.rotors.into_iter().zip(motors) {
            if let Some(value) = values.get_mut(rotor) {
                *value = motor;
            }
        }
        values
    }
}

/// The rotor at the place of a motor, if it turns the same way.
fn rotor_at(mount: Mount, motor: usize, yaw_rad: f64, layout: &RotorLayout) -> Option<usize> {
    let (angle_rad, direction): (f64, Direction) = *mount.motors().get(motor)?;
    layout.rotors.iter().position(|rotor| {
        let apart_rad = rotor.y.atan2(rotor.x) - angle_rad - yaw_rad;
        let apart_rad = (apart_rad + PI).rem_euclid(2.0 * PI) - PI;
        apart_rad.abs() < BESIDE_RAD && rotor.direction == direction
    })
}

#[cfg(test)]
mod tests {
    use core::f64::consts::FRAC_PI_4;

    use quadrotor::{AirframePreset, RotorLayout};

    use super::{Mount, Mounting};

    /// Numbers of the motors at the airframe's rotors.
    fn numbers(mount: Mount, layout: RotorLayout) -> (f64, [f64; 4]) {
        let mounting = Mounting::new(mount, &layout).expect("a quadrotor");
        (mounting.yaw_rad / FRAC_PI_4, mounting.rotors([1.0, 2.0, 3.0, 4.0]))
    }

    /// PX4's quad x: 1 front right and 2 back left turn counterclockwise, 3 front left and 4 back right clockwise.
    #[test]
    fn motors_lie_on_rotors_that_turn_as_they_do() {
        // Front, right, back, left, of which front and back turn clockwise.
        assert_eq!(numbers(Mount::X, RotorLayout::plus()), (1.0, [3.0, 1.0, 4.0, 2.0]));
        assert_eq!(numbers(Mount::Plus, RotorLayout::plus()), (0.0, [3.0, 1.0, 4.0, 2.0]));
        // Front right, back right, back left, front left, of which front right turns counterclockwise.
        let reversed = RotorLayout::x().reversed();
        assert_eq!(numbers(Mount::X, reversed), (0.0, [1.0, 4.0, 2.0, 3.0]));
        assert_eq!(numbers(Mount::X, AirframePreset::Iris.airframe().layout), (0.0, [1.0, 4.0, 2.0, 3.0]));
        assert_eq!(numbers(Mount::Plus, reversed), (-1.0, [1.0, 4.0, 2.0, 3.0]));
        // Front right turns clockwise: what is called front of it is a side.
        assert_eq!(numbers(Mount::X, RotorLayout::x()).0.abs(), 2.0);
    }

    #[test]
    fn rotors_that_turn_otherwise_are_refused() {
        let mut layout = RotorLayout::plus();
        layout.rotors.swap(0, 1);
        assert!(Mounting::new(Mount::X, &layout).is_ok(), "their order does not matter");
        let mut pairs = RotorLayout::x();
        let [first, second, ..] = &mut pairs.rotors;
        std::mem::swap(&mut first.direction, &mut second.direction);
        assert!(Mounting::new(Mount::X, &pairs).expect_err("pairs").to_string().contains("PX4"));
    }
}
