//! Which of PX4's speeds hold for what is flown: a takeoff near the ground has its own, and what a pilot or a program asks for is
//! bounded by the largest speeds instead of those of automatic flight.

use super::situation::Situation;
use crate::mode::{Leader, Mode};

/// The choice.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct SpeedChoice {
    /// Climb rate of a takeoff near the ground, m/s.
    pub takeoff_m_s: Option<f64>,
    /// Whether somebody else leads.
    pub is_led: bool,
}

impl SpeedChoice {
    /// For the present flight; `takes_off` says whether the mission does.
    pub fn of(situation: &Situation, takes_off: bool) -> Self {
        if situation.identity.is_ardupilot() {
            return Self::default();
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
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Mode, SpeedChoice};
    use crate::identity::Identity;
    use crate::vehicle::scene::Scene;

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
}
