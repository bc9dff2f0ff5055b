//! How the autopilot sits on the airframe.

use core::f64::consts::FRAC_PI_4;

use nalgebra::{UnitQuaternion, Vector3};

/// Where the autopilot's forward points, between the airframe's arms or along one. Its motors are numbered by PX4's
/// convention, which puts the same number on the same rotor in both:
///
/// | motor | x | + | airframe's rotor | turns, seen from above |
/// | --- | --- | --- | --- | --- |
/// | 1 | front right | right | right | counter-clockwise |
/// | 2 | back left | left | left | counter-clockwise |
/// | 3 | front left | front | front | clockwise |
/// | 4 | back right | back | back | clockwise |
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, clap::ValueEnum)]
pub enum Mount {
    /// Forward between two arms (quad x).
    #[default]
    X,
    /// Forward along an arm (quad +).
    Plus,
}

impl Mount {
    /// The autopilot's axes into the airframe's, FRD: in x its forward lies between the front and the right rotor.
    pub fn rotation(self) -> UnitQuaternion<f64> {
        UnitQuaternion::from_axis_angle(&Vector3::z_axis(), self.yaw_rad())
    }

    /// Heading of the autopilot minus that of the airframe, rad.
    pub fn yaw_rad(self) -> f64 {
        match self {
            Self::X => FRAC_PI_4,
            Self::Plus => 0.0,
        }
    }

    /// The airframe's front, right, back and left rotor of motors 1 to 4.
    pub fn rotors([right, left, front, back]: [f64; 4]) -> [f64; 4] {
        [front, right, back, left]
    }
}
