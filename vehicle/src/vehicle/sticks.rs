//! Sticks of the position mode.

use nalgebra::{Rotation2, Vector2};

use super::conduct::Conduct;
use super::set_point::{AxisTarget, PositionSetPoint, YawTarget};

/// Deflections, each within ±1.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Sticks {
    /// Forward.
    pub forward: f64,
    /// To the right.
    pub right: f64,
    /// Up.
    pub up: f64,
    /// Clockwise seen from above.
    pub turn: f64,
}

/// Share of a stick's way around its centre that means zero.
const DEAD_ZONE: f64 = 0.1;

impl Sticks {
    /// Velocities in the frame of the heading.
    pub fn set_point(&self, conduct: &Conduct, yaw_rad: f64, yaw_rate_rad_s: f64) -> PositionSetPoint {
        let stick = Vector2::new(live(self.forward), live(self.right));
        // A stick in the corner is not faster than one at the edge.
        let stick = if stick.norm() > 1.0 { stick.normalize() } else { stick };
        let velocity = Rotation2::new(yaw_rad) * stick * conduct.stick_speed_m_s;
        let up = live(self.up);
        let climb = up * if up > 0.0 { conduct.stick_climb_m_s } else { conduct.stick_sink_m_s };
        let turn = live(self.turn);
        PositionSetPoint {
            axes: [
                AxisTarget::Velocity(velocity.x),
                AxisTarget::Velocity(velocity.y),
                AxisTarget::Velocity(-climb),
            ],
            yaw: if turn == 0.0 { YawTarget::Hold } else { YawTarget::Rate(turn * yaw_rate_rad_s) },
        }
    }
}

/// A deflection without its dead zone, within ±1.
fn live(stick: f64) -> f64 {
    let stick = stick.clamp(-1.0, 1.0);
    let beyond = (stick.abs() - DEAD_ZONE).max(0.0) / (1.0 - DEAD_ZONE);
    if beyond == 0.0 { 0.0 } else { libm::copysign(beyond, stick) }
}

#[cfg(test)]
mod tests {
    use super::{AxisTarget, Conduct, Sticks, YawTarget};

    #[test]
    fn sticks_command_velocity_in_the_frame_of_the_heading() {
        let conduct = Conduct::new(false);
        let centred = Sticks { forward: 0.05, ..Sticks::default() }.set_point(&conduct, 1.0, 0.8);
        assert_eq!(centred.axes, [AxisTarget::Velocity(0.0); 3]);
        assert_eq!(centred.yaw, YawTarget::Hold);
        // Heading east, the stick forward and down.
        let sticks = Sticks { forward: 1.0, up: -1.0, turn: -1.0, ..Sticks::default() };
        let moving = sticks.set_point(&conduct, core::f64::consts::FRAC_PI_2, 0.8);
        let [AxisTarget::Velocity(north), AxisTarget::Velocity(east), AxisTarget::Velocity(down)] =
            moving.axes
        else {
            panic!("{moving:?}")
        };
        assert!(north.abs() < 1e-12 && (east - 5.0).abs() < 1e-12 && (down - 1.5).abs() < 1e-12);
        assert_eq!(moving.yaw, YawTarget::Rate(-0.8));
    }
}
