//! A pilot's sticks, and what they mean.

use nalgebra::{Rotation2, Vector2};

use super::conduct::Conduct;
use super::set_point::{AxisTarget, PositionSetPoint, YawTarget};
use super::stick_settings::StickSettings;

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

impl Sticks {
    /// Way of the throttle from its low end, 0 to 1.
    pub fn throttle(&self) -> f64 {
        (self.up.clamp(-1.0, 1.0) + 1.0) / 2.0
    }

    /// The climb rate that is asked for, m/s.
    pub fn climb_m_s(&self, conduct: &Conduct) -> f64 {
        let up = beyond(self.up, 2.0 * conduct.sticks.throttle_dead_zone);
        up * if up < 0.0 { conduct.fastest_stick_sink_m_s() } else { conduct.stick_climb_m_s }
    }

    /// Without their dead zones.
    pub fn live(&self, settings: &StickSettings) -> Self {
        let live = |stick| beyond(stick, settings.dead_zone);
        let (forward, right) = (live(self.forward), live(self.right));
        Self { forward, right, up: live(self.up), turn: live(self.turn) }
    }

    /// The rate of turn that is asked for, rad/s, no faster than a limit.
    pub fn turn_rad_s(&self, settings: &StickSettings, fastest_rad_s: f64) -> f64 {
        (self.turn.clamp(-1.0, 1.0) * settings.turn_rad_s).clamp(-fastest_rad_s, fastest_rad_s)
    }

    /// Forward and to the right without their dead zones, together at most 1: a stick in the corner is not faster than one at the edge.
    pub fn over_ground(&self, settings: &StickSettings) -> Vector2<f64> {
        let live = self.live(settings);
        let stick = Vector2::new(live.forward, live.right);
        if stick.norm() > 1.0 { stick.normalize() } else { stick }
    }

    /// Velocities in the frame of the heading, and a turn no faster than a limit, rad/s.
    pub fn set_point(&self, conduct: &Conduct, yaw_rad: f64, fastest_rad_s: f64) -> PositionSetPoint {
        let live = self.live(&conduct.sticks);
        let velocity = Rotation2::new(yaw_rad) * self.over_ground(&conduct.sticks) * conduct.stick_speed_m_s;
        let turn_rad_s = live.turn_rad_s(&conduct.sticks, fastest_rad_s);
        PositionSetPoint {
            axes: [
                AxisTarget::Velocity(velocity.x),
                AxisTarget::Velocity(velocity.y),
                AxisTarget::Velocity(-self.climb_m_s(conduct)),
            ],
            yaw: if turn_rad_s == 0.0 { YawTarget::Hold } else { YawTarget::Rate(turn_rad_s) },
        }
    }

    /// Roll and pitch that are asked for, rad: no more than the largest lean in any direction.
    pub fn lean_rad(&self, largest_rad: f64) -> [f64; 2] {
        let stick = Vector2::new(self.right.clamp(-1.0, 1.0), -self.forward.clamp(-1.0, 1.0));
        let stick = if stick.norm() > 1.0 { stick.normalize() } else { stick };
        [stick.x * largest_rad, stick.y * largest_rad]
    }

    /// Whether roll or pitch is asked for.
    pub fn leans(&self, settings: &StickSettings) -> bool {
        let live = self.live(settings);
        live.forward != 0.0 || live.right != 0.0
    }

    /// Share of the largest thrust that a throttle asks for by hand, where this share hovers.
    pub fn thrust(&self, conduct: &Conduct, hover: f64, ardupilot: bool) -> f64 {
        let (way, settings) = (self.throttle(), &conduct.sticks);
        if ardupilot {
            // A cubic through the hovering thrust in the middle and the largest one at the top.
            let bend = (-(hover - 0.5) / 0.375).clamp(-0.5, 1.0);
            return way * (1.0 - bend) + bend * way * way * way;
        }
        let least = settings.least_thrust.min(hover);
        if !settings.hovers_centred {
            return least + way * (1.0 - least);
        }
        if self.up < 0.0 { hover + self.up * (hover - least) } else { hover + self.up * (1.0 - hover) }
    }
}

/// A deflection without its dead zone, within ±1.
fn beyond(stick: f64, dead_zone: f64) -> f64 {
    let stick = stick.clamp(-1.0, 1.0);
    let beyond = (stick.abs() - dead_zone).max(0.0) / (1.0 - dead_zone);
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

    #[test]
    fn a_centred_throttle_hovers_and_the_ends_are_the_least_and_the_largest_thrust() {
        for (ardupilot, least) in [(true, 0.0), (false, 0.08)] {
            let conduct = Conduct::new(ardupilot);
            let thrust = |up: f64| Sticks { up, ..Sticks::default() }.thrust(&conduct, 0.3139, ardupilot);
            assert!((thrust(-1.0) - least).abs() < 1e-9 && (thrust(1.0) - 1.0).abs() < 1e-9);
            assert!((thrust(0.0) - 0.3139).abs() < 1e-3, "{}", thrust(0.0));
            let steps: Vec<f64> = (-10..=10).map(|tenth| thrust(f64::from(tenth) / 10.0)).collect();
            assert!(steps.windows(2).all(|pair| pair[1] > pair[0]), "{steps:?}");
        }
    }

    #[test]
    fn a_corner_leans_no_further_than_an_edge() {
        let [roll, pitch] = Sticks { forward: 1.0, right: 1.0, ..Sticks::default() }.lean_rad(0.5);
        assert!((roll.hypot(pitch) - 0.5).abs() < 1e-12 && roll > 0.0 && pitch < 0.0);
    }
}
