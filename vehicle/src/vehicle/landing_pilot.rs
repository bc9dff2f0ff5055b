//! A pilot of ArduPilot's moves the place of a landing, and may break it off.

use nalgebra::Rotation2;

use super::notice::Severity;
use super::proposal::Proposal;
use super::situation::Situation;
use crate::mode::Mode;

/// A full stick moves the place with the velocity that the acceleration of missions reaches in this time, s.
const REACHED_S: f64 = 0.5;
/// Share of the throttle's way beyond which it breaks the landing off, where it may.
const BREAKS_OFF: f64 = 0.7;

/// Whether the pilot has chosen another place to land.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct LandingPilot {
    moved: bool,
}

impl LandingPilot {
    /// Whether the landing has no place any more but where the sticks have left it.
    pub fn has_moved(&self) -> bool {
        self.moved
    }

    /// Looks at the sticks on the way down.
    pub fn watch(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let comes_down = situation.comes_down && !situation.landed;
        self.moved = comes_down && (self.moved || velocity_m_s(situation).is_some());
        let Some(sticks) = pilot(situation).filter(|_| comes_down) else { return };
        let may = situation.conduct.sticks.high_throttle_ends_landings();
        if may && sticks.throttle() > BREAKS_OFF {
            proposal.say(Severity::Info, "Landing broken off by the throttle");
            proposal.enter(if situation.knows_its_place() { Mode::Position } else { Mode::Altitude });
        }
    }
}

/// North and east, m/s: how fast the sticks move the place of the landing, if they do.
pub fn velocity_m_s(situation: &Situation) -> Option<[f64; 2]> {
    let settings = &situation.conduct.sticks;
    let sticks = pilot(situation).filter(|sticks| settings.move_landings && sticks.leans(settings))?;
    let fastest_m_s = REACHED_S * situation.limits().acceleration_horizontal_m_s2;
    let stick = sticks.over_ground(settings) * fastest_m_s;
    Some((Rotation2::new(situation.outputs.attitude_rad.z) * stick).into())
}

fn pilot(situation: &Situation) -> Option<super::sticks::Sticks> {
    situation.pilot.present_sticks().filter(|_| situation.identity.is_ardupilot())
}

#[cfg(test)]
mod tests {
    use super::{LandingPilot, Mode, velocity_m_s};
    use crate::identity::Identity;
    use crate::vehicle::Conduct;
    use crate::vehicle::proposal::Request;
    use crate::vehicle::scene::Scene;
    use crate::vehicle::sticks::Sticks;

    fn landing() -> Scene {
        let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]);
        (scene.identity, scene.conduct, scene.mode) = (Identity::ArduPilot, Conduct::new(true), Mode::Land);
        scene.comes_down = true;
        scene
    }

    fn watch(pilot: &mut LandingPilot, scene: &mut Scene, sticks: Sticks) -> Vec<Request> {
        scene.pilot.sticks = Some(sticks);
        scene.show(|situation, proposal| pilot.watch(situation, proposal))
    }

    /// The velocity of a full stick is half a second of the acceleration of missions, in the frame of the nose.
    #[test]
    fn a_full_stick_moves_the_place_and_the_place_stays_moved() {
        let (mut scene, mut pilot) = (landing(), LandingPilot::default());
        scene.outputs.attitude_rad.z = core::f64::consts::FRAC_PI_2;
        assert!(watch(&mut pilot, &mut scene, Sticks::default()).is_empty() && !pilot.has_moved());
        watch(&mut pilot, &mut scene, Sticks { forward: 1.0, ..Sticks::default() });
        let [north, east] = velocity_m_s(&scene.situation()).expect("a velocity");
        let expected = 0.5 * scene.limits.wanted().acceleration_horizontal_m_s2;
        assert!(north.abs() < 1e-12 && (east - expected).abs() < 1e-12, "{north} {east}");
        watch(&mut pilot, &mut scene, Sticks::default());
        assert!(pilot.has_moved() && velocity_m_s(&scene.situation()).is_none());
        scene.comes_down = false;
        watch(&mut pilot, &mut scene, Sticks::default());
        assert!(!pilot.has_moved(), "another landing");
    }

    #[test]
    fn a_high_throttle_breaks_off_where_it_may() {
        let (mut scene, mut pilot) = (landing(), LandingPilot::default());
        let high = Sticks { up: 0.5, ..Sticks::default() };
        assert!(watch(&mut pilot, &mut scene, high).is_empty());
        scene.conduct.sticks.throttle_behaviour = 2;
        assert!(watch(&mut pilot, &mut scene, high).contains(&Request::Enter(Mode::Position)));
        assert!(watch(&mut pilot, &mut scene, Sticks { up: 0.3, ..Sticks::default() }).is_empty());
    }
}
