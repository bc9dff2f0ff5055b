//! Sticks that do not turn with the nose: ArduPilot's simple and super simple modes.

use nalgebra::{Rotation2, Vector2};

use super::receiver::Pilot;
use super::situation::Situation;
use super::sticks::Sticks;
use crate::radio::Position;

/// Nearer to home than this, m, the direction away from it stays.
const NEAR_M: f64 = 10.0;

/// What sticks refer to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StickReference {
    /// The nose.
    Nose,
    /// The heading of arming.
    Arming,
    /// The direction away from home.
    Home,
}

impl StickReference {
    /// That of a switch in a position: one for the heading of arming alone, or for both.
    pub fn of(position: Position, both: bool) -> Self {
        match position {
            Position::Low => Self::Nose,
            Position::Middle if both => Self::Arming,
            Position::Middle => Self::Nose,
            Position::High if both => Self::Home,
            Position::High => Self::Arming,
        }
    }
}

/// The headings that sticks refer to, rad.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct SimpleFlight {
    /// What a switch has chosen in place of the mode switch.
    chosen: Option<StickReference>,
    /// That of arming.
    armed_rad: f64,
    /// Away from home.
    away_rad: f64,
}

impl SimpleFlight {
    /// It is armed with a heading, rad.
    pub fn arm(&mut self, yaw_rad: f64) {
        *self = Self { armed_rad: yaw_rad, away_rad: yaw_rad, ..*self };
    }

    /// A switch chooses what sticks refer to.
    pub fn choose(&mut self, reference: StickReference) {
        self.chosen = Some(reference);
    }

    /// Looks where home is.
    pub fn watch(&mut self, situation: &Situation) {
        let away = (situation.outputs.position_m - situation.home.position_m).xy();
        if situation.armed && away.norm() > NEAR_M {
            self.away_rad = libm::atan2(away.y, away.x);
        }
    }

    /// The pilot, with sticks that refer to the nose. `slot` is the position of the mode switch from 0, the bits of which choose simple and
    /// super simple.
    pub fn seen(&self, pilot: &Pilot, slot: Option<usize>, [simple, away]: [u32; 2], yaw_rad: f64) -> Pilot {
        let is_set = |bits: u32| slot.is_some_and(|slot| bits >> slot & 1 == 1);
        let of_slot = match (is_set(away), is_set(simple)) {
            (true, _) => StickReference::Home,
            (_, true) => StickReference::Arming,
            _ => StickReference::Nose,
        };
        let reference_rad = match self.chosen.unwrap_or(of_slot) {
            StickReference::Home => self.away_rad,
            StickReference::Arming => self.armed_rad,
            StickReference::Nose => return *pilot,
        };
        let turned = |sticks: Sticks| {
            let turn = Rotation2::new(reference_rad - yaw_rad);
            let stick = turn * Vector2::new(sticks.forward, sticks.right);
            Sticks { forward: stick.x.clamp(-1.0, 1.0), right: stick.y.clamp(-1.0, 1.0), ..sticks }
        };
        Pilot { sticks: pilot.sticks.map(turned), ..*pilot }
    }
}

#[cfg(test)]
mod tests {
    use core::f64::consts::FRAC_PI_2;

    use super::{Pilot, SimpleFlight, Sticks};
    use crate::vehicle::scene::Scene;

    fn pilot(forward: f64) -> Pilot {
        Pilot { sticks: Some(Sticks { forward, ..Sticks::default() }), ..Pilot::default() }
    }

    /// Armed to the north and turned east, forward is north: to the left of the nose.
    #[test]
    fn forward_is_where_the_nose_was_when_it_was_armed() {
        let mut simple = SimpleFlight::default();
        simple.arm(0.0);
        let seen = |slot, bits| simple.seen(&pilot(0.5), slot, bits, FRAC_PI_2).sticks.expect("a pilot");
        let turned = seen(Some(2), [0b100, 0]);
        assert!(turned.forward.abs() < 1e-12 && (turned.right + 0.5).abs() < 1e-12, "{turned:?}");
        for (slot, bits) in [(Some(1), [0b100, 0]), (None, [0b100, 0]), (Some(2), [0, 0])] {
            assert_eq!(seen(slot, bits).forward, 0.5, "another position of the switch");
        }
    }

    /// East of home and turned north, forward is farther east: to the right.
    #[test]
    fn forward_is_away_from_home() {
        let mut simple = SimpleFlight::default();
        simple.arm(0.0);
        let at = |simple: &mut SimpleFlight, east_m: f64| {
            simple.watch(&Scene::hovering_at([0.0, east_m, -10.0]).situation());
            simple.seen(&pilot(0.5), Some(0), [0, 1], 0.0).sticks.expect("a pilot")
        };
        assert!((at(&mut simple, 5.0).forward - 0.5).abs() < 1e-12, "near home the heading stays");
        let turned = at(&mut simple, 20.0);
        assert!(turned.forward.abs() < 1e-12 && (turned.right - 0.5).abs() < 1e-12, "{turned:?}");
    }
}
