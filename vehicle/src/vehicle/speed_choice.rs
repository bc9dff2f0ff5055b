//! Which speeds hold for what is flown. PX4: a takeoff near the ground has its own, and what a pilot or a program asks for is
//! bounded by the largest speeds instead of those of automatic flight. ArduPilot: what a pilot asks for has speeds of its own.

use super::situation::Situation;
use crate::mode::{Leader, Mode};

/// The choice.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct SpeedChoice {
    /// Climb rate of a takeoff near the ground, m/s.
    pub takeoff_m_s: Option<f64>,
    /// Whether somebody else leads.
    pub is_led: bool,
    /// Speeds that full sticks ask for, m/s: horizontally, up, down. Those of missions do not bound them.
    pub sticks_m_s: Option<[f64; 3]>,
}

impl SpeedChoice {
    /// For the present flight; `takes_off` says whether the mission does.
    pub fn of(situation: &Situation, takes_off: bool) -> Self {
        if situation.identity.is_ardupilot() {
            return Self { sticks_m_s: sticks_m_s(situation), ..Self::default() };
        }
        let speeds = &situation.conduct.speeds;
        let takes_off = situation.mode == Mode::Takeoff || situation.mode == Mode::Mission && takes_off;
        // The landing slows down at least as far up.
        let slow_below_m = speeds.slow_below_m.max(situation.conduct.land_slow_below_m);
        let here_m = &situation.outputs.position_m;
        let is_low = || situation.terrain.z_below_m(here_m) - here_m.z < slow_below_m;
        Self {
            takeoff_m_s: (takes_off && is_low()).then_some(speeds.takeoff_m_s),
            is_led: situation.mode.leader() != Leader::Vehicle,
            sticks_m_s: None,
        }
    }
}

/// Speeds of ArduPilot's pilot, where sticks ask for speeds: a zigzag's way across is automatic flight.
fn sticks_m_s(situation: &Situation) -> Option<[f64; 3]> {
    let asked = match situation.mode {
        Mode::Position | Mode::PositionHold | Mode::Altitude => true,
        Mode::ZigZag => situation.steering.asked().is_some_and(|asked| asked.is_velocity()),
        _ => false,
    };
    let conduct = situation.conduct;
    asked.then(|| [conduct.stick_speed_m_s, conduct.stick_climb_m_s, conduct.fastest_stick_sink_m_s()])
}

#[cfg(test)]
mod tests {
    use super::{Mode, SpeedChoice};
    use crate::identity::Identity;
    use crate::vehicle::conduct::Conduct;
    use crate::vehicle::scene::Scene;
    use crate::vehicle::set_point::{AxisTarget, PositionSetPoint, YawTarget};

    /// PX4: MPC_TKO_SPEED holds for a takeoff below MPC_LAND_ALT1, and for nothing else.
    #[test]
    fn a_takeoff_is_slow_near_the_ground() {
        for (identity, mode, takes_off, height_m, slow) in [
            (Identity::Px4, Mode::Takeoff, false, 0.0, true),
            (Identity::Px4, Mode::Takeoff, false, 9.9, true),
            (Identity::Px4, Mode::Takeoff, false, 10.1, false),
            (Identity::Px4, Mode::Mission, true, 5.0, true),
            (Identity::Px4, Mode::Mission, false, 5.0, false),
            (Identity::Px4, Mode::Hold, true, 5.0, false),
            (Identity::ArduPilot, Mode::Takeoff, true, 5.0, false),
        ] {
            let mut scene = Scene::hovering_at([0.0, 0.0, -height_m]);
            (scene.identity, scene.mode) = (identity, mode);
            let choice = SpeedChoice::of(&scene.situation(), takes_off);
            let expected = slow.then_some(1.5);
            assert_eq!(choice.takeoff_m_s, expected, "{identity:?} {mode:?} {takes_off} {height_m}");
        }
    }

    /// ArduPilot: LOIT_SPEED_MS, PILOT_SPD_UP and PILOT_SPD_DN are the pilot's; a way across, a mission and Guided have WP_SPD.
    #[test]
    fn ardupilots_pilot_has_speeds_of_its_own() {
        let pilots = Some([12.5, 2.5, 2.5]);
        for (mode, goes_to_a_place, expected) in [
            (Mode::Position, false, pilots),
            (Mode::PositionHold, false, pilots),
            (Mode::Altitude, false, pilots),
            (Mode::ZigZag, false, pilots),
            (Mode::ZigZag, true, None),
            (Mode::Mission, true, None),
            (Mode::Offboard, false, None),
            (Mode::Return, true, None),
        ] {
            let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]);
            (scene.identity, scene.mode) = (Identity::ArduPilot, mode);
            scene.conduct = Conduct::new(true);
            let place = [40.0, 0.0, -10.0].map(AxisTarget::Position);
            let there = PositionSetPoint { axes: place, yaw: YawTarget::Hold };
            let asked = if goes_to_a_place { there } else { PositionSetPoint::HOLD };
            scene.show(|situation, proposal| proposal.follow(situation, &asked));
            let chosen = SpeedChoice::of(&scene.situation(), false);
            assert_eq!(chosen.sticks_m_s, expected, "{mode:?} {goes_to_a_place}");
            scene.identity = Identity::Px4;
            assert_eq!(SpeedChoice::of(&scene.situation(), false).sticks_m_s, None);
        }
    }
}
