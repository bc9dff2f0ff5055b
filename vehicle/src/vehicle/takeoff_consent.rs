//! ArduPilot's consent to a takeoff in Auto: a raised throttle or a command gives it.

use super::situation::Situation;
use crate::mode::Mode;

/// Whether it has been given since the vehicle was armed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct TakeoffConsent {
    given: bool,
}

impl TakeoffConsent {
    /// A command gives it.
    pub fn give(&mut self) {
        self.given = true;
    }

    /// Whether the mission may lift off.
    pub fn is_given(self) -> bool {
        self.given
    }

    /// Looks at the throttle. What flies has taken off already; disarming ends it, and so does a lowered throttle that is the thrust.
    pub fn watch(&mut self, situation: &Situation) {
        let pilot = &situation.pilot;
        let lowered = situation.mode.is_flown_by_thrust() && pilot.throttle_is_zero && !pilot.lost;
        let raised = pilot.present_sticks().is_some_and(|sticks| sticks.throttle() > 0.0);
        let gives = raised || !situation.landed || situation.mode == Mode::Throw;
        self.given = situation.armed && !lowered && (self.given || gives);
    }
}

#[cfg(test)]
mod tests {
    use super::{Mode, TakeoffConsent};
    use crate::vehicle::Sticks;
    use crate::vehicle::scene::Scene;

    #[test]
    fn a_raised_throttle_gives_it_and_disarming_ends_it() {
        let mut scene = Scene::on_the_ground();
        let mut consent = TakeoffConsent::default();
        let mut watch = |scene: &Scene| {
            consent.watch(&scene.situation());
            consent.is_given()
        };
        assert!(!watch(&scene), "nobody has raised a throttle");
        scene.pilot.sticks = Some(Sticks { up: -1.0, ..Sticks::default() });
        assert!(!watch(&scene));
        scene.pilot.sticks = Some(Sticks { up: -0.9, ..Sticks::default() });
        assert!(watch(&scene));
        scene.pilot.sticks = Some(Sticks { up: -1.0, ..Sticks::default() });
        scene.pilot.throttle_is_zero = true;
        assert!(watch(&scene), "it stays given");
        scene.mode = Mode::Stabilize;
        assert!(!watch(&scene), "a throttle that is the thrust takes it back");
        scene.mode = Mode::Mission;
        scene.landed = false;
        assert!(watch(&scene), "what flies has taken off");
        (scene.landed, scene.armed) = (true, false);
        assert!(!watch(&scene));
    }
}
