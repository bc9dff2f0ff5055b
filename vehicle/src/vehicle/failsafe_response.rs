//! What a cause of a failsafe leads to in the present mode, and the words for it.

use super::failsafe::{Action, Cause};
use super::situation::Situation;
use crate::fence::Breach;
use crate::mode::{Leader, Mode};

/// Bits of FS_OPTIONS, each with the causes and the modes in which the vehicle flies on, and ArduPilot's words for that.
const GOES_ON: &[(u32, Cause, Flown, &str)] = &[
    (1, Cause::PilotLost, Flown::Mission, "Continuing Auto"),
    (2, Cause::GroundStationLost, Flown::Mission, "Continuing Auto Mode"),
    (4, Cause::PilotLost, Flown::Guided, "Continuing Guided Mode"),
    (8, Cause::PilotLost, Flown::Landing, "Continuing Landing"),
    (8, Cause::GroundStationLost, Flown::Landing, "Continuing Landing"),
    (8, Cause::BatteryLow, Flown::Landing, "Continuing Landing"),
    (8, Cause::BatteryCritical, Flown::Landing, "Continuing Landing"),
    (16, Cause::GroundStationLost, Flown::Sticks, "Continuing Pilot Control"),
];

/// Modes that FS_OPTIONS tells apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Flown {
    Mission,
    Guided,
    Landing,
    Sticks,
}

impl Flown {
    fn is(self, mode: Mode) -> bool {
        match self {
            Self::Mission => mode == Mode::Mission,
            Self::Guided => mode == Mode::Takeoff || mode.leader() == Leader::SetPoints,
            Self::Landing => mode == Mode::Land,
            Self::Sticks => mode.leader() == Leader::Sticks,
        }
    }
}

/// What a cause leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Response {
    /// What is done, as far as nothing is missing for it.
    pub action: Action,
    /// Why the mode goes on instead, in ArduPilot's words.
    pub goes_on: Option<&'static str>,
    /// Whether it disarms at once, on the ground.
    pub disarms: bool,
}

/// What a cause leads to in the present mode.
pub fn response(situation: &Situation, cause: Cause) -> Response {
    let action = situation.conduct.failsafe.action(cause);
    if action <= Action::Warn {
        return Response { action, goes_on: None, disarms: false };
    }
    if !situation.identity.is_ardupilot() {
        let spared = cause == Cause::PilotLost && goes_on_without_pilot(situation);
        let action = if spared { Action::Warn } else { possible(situation, action) };
        return Response { action, goes_on: None, disarms: false };
    }
    let options = situation.conduct.radio.options;
    let mut rows = GOES_ON.iter();
    let row = rows.find(|(bit, of, flown, _)| options & bit != 0 && *of == cause && flown.is(situation.mode));
    let disarms = matches!(
        cause,
        Cause::PilotLost | Cause::GroundStationLost | Cause::BatteryLow | Cause::BatteryCritical
    );
    Response {
        action: possible(situation, action),
        goes_on: row.map(|(.., words)| *words),
        disarms: disarms && situation.armed && situation.landed,
    }
}

/// The action, or what is left of it without a trail or a place.
fn possible(situation: &Situation, action: Action) -> Action {
    let action = match action {
        Action::TraceOrReturn if !situation.has_trail => Action::Return,
        Action::TraceOrLand if !situation.has_trail => Action::Land,
        // Without a pilot nobody would fly it.
        Action::Altitude | Action::Stabilize if needs_pilot(situation) => Action::Return,
        action => action,
    };
    let flown = |mode: Mode| mode == Mode::Land || situation.can_fly(mode);
    if action.mode().is_none_or(flown) { action } else { Action::Land }
}

/// Whether PX4 has no pilot to hand over to.
fn needs_pilot(situation: &Situation) -> bool {
    !situation.identity.is_ardupilot() && situation.pilot.present_sticks().is_none()
}

/// Whether the present mode is one that COM_RCL_EXCEPT lets go on without the pilot.
fn goes_on_without_pilot(situation: &Situation) -> bool {
    const MISSION: u32 = 1;
    const AUTOMATIC: u32 = 2;
    const OFFBOARD: u32 = 4;
    let bit = match situation.mode {
        Mode::Mission => MISSION,
        mode => match mode.leader() {
            Leader::Sticks => 0,
            Leader::SetPoints => OFFBOARD,
            Leader::Vehicle => AUTOMATIC,
        },
    };
    situation.conduct.radio.lost_exceptions & bit != 0
}

/// Whether FS_OPTIONS lets go of what the vehicle carries.
pub fn releases_gripper(situation: &Situation, cause: Cause) -> bool {
    const RELEASES: u32 = 32;
    let of_failsafe = matches!(
        cause,
        Cause::PilotLost | Cause::GroundStationLost | Cause::BatteryLow | Cause::BatteryCritical
    );
    situation.identity.is_ardupilot() && of_failsafe && situation.conduct.radio.options & RELEASES != 0
}

/// What clients of ArduPilot look for when a cause begins.
pub fn announced(situation: &Situation, cause: Cause) -> Option<String> {
    let name = match cause {
        Cause::Fence if situation.fence_is_ahead => "Fence ahead",
        _ if !situation.identity.is_ardupilot() => return None,
        Cause::Fence => return situation.breach.map(|breach| crossed(situation, breach)),
        Cause::BatteryLow => "Battery 1 is low",
        Cause::BatteryCritical => "Battery 1 is critical",
        Cause::PilotLost => "Radio Failsafe",
        Cause::GroundStationLost => "GCS Failsafe",
        Cause::PositionLost => "EKF Failsafe",
        _ => return None,
    };
    Some(name.to_owned())
}

/// A breach of the fence in the words of the autopilot.
pub fn crossed(situation: &Situation, breach: Breach) -> String {
    if situation.identity.is_ardupilot() {
        return format!("{} fence breached", breach.ardupilot_name());
    }
    Cause::Fence.name().to_owned()
}

/// What is told when a cause is over.
pub fn cleared(situation: &Situation, cause: Cause) -> String {
    let named = [Cause::PilotLost, Cause::GroundStationLost, Cause::PositionLost];
    match announced(situation, cause) {
        Some(name) if named.contains(&cause) => format!("{name} Cleared"),
        _ => format!("Failsafe cleared: {}", cause.cleared()),
    }
}

#[cfg(test)]
mod tests {
    use super::{Action, Cause, Mode, Response, response};
    use crate::identity::Identity;
    use crate::vehicle::scene::Scene;

    fn scene(mode: Mode, options: u32) -> Scene {
        let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]);
        (scene.identity, scene.mode) = (Identity::ArduPilot, mode);
        scene.conduct = crate::vehicle::Conduct::new(true);
        scene.conduct.failsafe.ground_station_lost = Action::Return;
        scene.conduct.failsafe.battery.low = Action::Return;
        scene.conduct.radio.options = options;
        scene
    }

    /// The bits of FS_OPTIONS as ArduPilot documents them.
    #[test]
    fn each_option_spares_its_modes_and_no_others() {
        let documented = [
            (1, Cause::PilotLost, &[Mode::Mission][..]),
            (2, Cause::GroundStationLost, &[Mode::Mission]),
            (4, Cause::PilotLost, &[Mode::Offboard, Mode::Takeoff, Mode::GuidedAttitude]),
            (8, Cause::PilotLost, &[Mode::Land]),
            (8, Cause::GroundStationLost, &[Mode::Land]),
            (8, Cause::BatteryLow, &[Mode::Land]),
            (16, Cause::GroundStationLost, &[Mode::Altitude, Mode::Stabilize, Mode::Position]),
        ];
        let modes = [Mode::Mission, Mode::Offboard, Mode::Land, Mode::Altitude, Mode::Return, Mode::Orbit];
        for (bit, cause, spared) in documented {
            for mode in spared.iter().chain(&modes) {
                let goes_on = response(&scene(*mode, bit).situation(), cause).goes_on.is_some();
                assert_eq!(goes_on, spared.contains(mode), "{bit} {cause:?} {mode:?}");
                let without = response(&scene(*mode, 0).situation(), cause);
                assert_eq!((without.goes_on, without.disarms), (None, false), "{cause:?} {mode:?}");
            }
        }
    }

    #[test]
    fn what_is_missing_leaves_the_rest_of_an_action() {
        let mut scene = scene(Mode::Altitude, 0);
        let mut asked = |action, trail, place| {
            scene.conduct.failsafe.battery.low = action;
            (scene.has_trail, scene.validity.horizontal_position) = (trail, place);
            let Response { action, .. } = response(&scene.situation(), Cause::BatteryLow);
            action
        };
        assert_eq!(asked(Action::TraceOrReturn, true, true), Action::TraceOrReturn);
        assert_eq!(asked(Action::TraceOrReturn, false, true), Action::Return);
        assert_eq!(asked(Action::TraceOrReturn, false, false), Action::Land);
        assert_eq!(asked(Action::TraceOrLand, false, true), Action::Land);
        assert_eq!(asked(Action::BrakeOrLand, true, true), Action::BrakeOrLand);
        assert_eq!(asked(Action::BrakeOrLand, true, false), Action::Land);
        assert_eq!(asked(Action::Terminate, true, false), Action::Terminate);
    }

    /// PX4 hands over to a pilot who is there, and flies home without one.
    #[test]
    fn only_a_pilot_takes_over() {
        let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]);
        for action in [Action::Altitude, Action::Stabilize] {
            scene.conduct.failsafe.set_points_lost = action;
            scene.pilot.sticks = None;
            assert_eq!(response(&scene.situation(), Cause::SetPointsLost).action, Action::Return);
            scene.pilot.sticks = Some(crate::vehicle::Sticks::default());
            assert_eq!(response(&scene.situation(), Cause::SetPointsLost).action, action);
        }
    }

    /// On the ground it does not fly home.
    #[test]
    fn ardupilot_disarms_on_the_ground() {
        let mut scene = scene(Mode::Stabilize, 0);
        scene.landed = true;
        for cause in [Cause::PilotLost, Cause::GroundStationLost, Cause::BatteryLow] {
            assert!(response(&scene.situation(), cause).disarms, "{cause:?}");
        }
        scene.armed = false;
        assert!(!response(&scene.situation(), Cause::PilotLost).disarms);
    }
}
