//! How the autopilot sits on the airframe.

use core::f64::consts::FRAC_PI_4;

use quadrotor::Direction;

/// Where the autopilot's forward points, between the airframe's arms or along one. Its motors are numbered by PX4's
/// convention, which puts the same number on the same rotor in both:
///
/// | motor | x | + | rotor of a "+" | turns, seen from above |
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
    /// Where motors 1 to 4 are, as angles from the autopilot's forward to the right, rad, and which way they turn.
    pub fn motors(self) -> [(f64, Direction); 4] {
        let between = match self {
            Self::X => 0.0,
            Self::Plus => FRAC_PI_4,
        };
        let places = [FRAC_PI_4, -3.0 * FRAC_PI_4, -FRAC_PI_4, 3.0 * FRAC_PI_4];
        let [first, second, third, fourth] = places.map(|angle_rad| angle_rad + between);
        let (right, left) = (Direction::Clockwise, Direction::Counterclockwise);
        [(first, left), (second, left), (third, right), (fourth, right)]
    }
}
