//! Failsafes: every transition of the table is flown, and the documentation draws the table.

use std::collections::BTreeSet;

use crate::common::failsafe_bench::*;
use vehicle::identity::Identity;
use vehicle::{Action, Cause, Mode};

/// Every action that a parameter can choose for a cause is taken and told.
fn every_action_of(cause: Cause) {
    every_action_as(Identity::Px4, cause);
}

fn every_action_as(identity: Identity, cause: Cause) {
    for (number, action) in choices(identity, cause) {
        let mut bench = hovering_as(identity, cause);
        set(&mut bench, parameter(identity, cause), f64::from(number));
        let before = bench.mode();
        bench.heard.clear();
        spoil(&mut bench, cause);
        // Until the next heartbeat that comes by itself.
        bench.fly(1.1);
        let (vehicle, texts) = (bench.autopilot.vehicle(), bench.texts());
        // ArduPilot's words are its own.
        let told = match cause {
            _ if !identity.is_ardupilot() => cause.name(),
            Cause::BatteryLow => "Battery 1 is low",
            Cause::BatteryCritical => "Battery 1 is critical",
            Cause::GroundStationLost => "GCS Failsafe",
            Cause::Fence => "Max Alt fence breached",
            Cause::PositionLost => "EKF Failsafe",
            _ => cause.name(),
        };
        let announced = texts.iter().any(|text| text.starts_with(told));
        assert_eq!(announced, action != Action::None, "{cause:?} {action:?}: {texts:?}");
        match action {
            Action::None | Action::Warn => assert_eq!(vehicle.mode(), before, "{cause:?} {action:?}"),
            Action::Disarm | Action::Terminate => assert!(!vehicle.is_armed(), "{cause:?} {action:?}"),
            // Nobody is there to take over.
            Action::Altitude | Action::Stabilize if !identity.is_ardupilot() => {
                assert_eq!(vehicle.mode(), Mode::Return, "{cause:?} {action:?}");
            }
            // There is no mission with a landing.
            Action::MissionLandingOrReturn => assert_eq!(vehicle.mode(), Mode::Return, "{cause:?}"),
            _ => assert_eq!(Some(vehicle.mode()), action.mode(), "{cause:?} {action:?}: {texts:?}"),
        }
        assert_eq!(state(&bench), expected_state(cause, action), "{cause:?} {action:?}");
    }
}

/// ArduPilot's names and numbers choose among the same actions.
#[test]
fn ardupilots_parameters() {
    for cause in [
        Cause::GroundStationLost,
        Cause::Fence,
        Cause::BatteryLow,
        Cause::BatteryCritical,
        Cause::BatteryEmergency,
        Cause::PositionLost,
    ] {
        assert!(choices(Identity::ArduPilot, cause).len() >= 4, "{cause:?}");
        every_action_as(Identity::ArduPilot, cause);
    }
}

#[test]
fn lost_set_points() {
    every_action_of(Cause::SetPointsLost);
}

#[test]
fn lost_ground_station() {
    every_action_of(Cause::GroundStationLost);
}

#[test]
fn high_wind() {
    every_action_of(Cause::HighWind);
}

#[test]
fn low_battery() {
    every_action_of(Cause::BatteryLow);
}

#[test]
fn critical_battery() {
    every_action_of(Cause::BatteryCritical);
}

#[test]
fn empty_battery() {
    every_action_of(Cause::BatteryEmergency);
}

#[test]
fn lost_position() {
    every_action_of(Cause::PositionLost);
}

#[test]
fn breached_fence() {
    every_action_of(Cause::Fence);
}

#[test]
fn failed_rotor() {
    every_action_of(Cause::RotorFailure);
}

#[test]
fn manual_control_lost() {
    every_action_of(Cause::PilotLost);
}

/// Ends of modes, which are no failures.
const ENDS: [(&str, &str); 5] = [
    ("Takeoff --> Hold", "height reached"),
    ("Mission --> Hold", "mission complete"),
    ("Mission --> Return", "item returns"),
    ("Return --> Disarmed", "landed"),
    ("Land --> Disarmed", "landed"),
];

#[test]
fn the_documentation_draws_what_the_parameters_can_choose() {
    let page = include_str!("../../../book/src/vehicle/failsafes.md");
    let (_, rest) = page.split_once("```mermaid").expect("a diagram");
    let (diagram, _) = rest.split_once("```").expect("its end");
    let mut drawn: Vec<&str> =
        diagram.lines().map(str::trim).filter(|line| line.contains("-->") && !line.contains("[*]")).collect();
    drawn.sort_unstable();
    let mut meant: Vec<String> = ENDS.iter().map(|(edge, why)| format!("{edge} : {why}")).collect();
    let goal = |action: Action| match action.mode() {
        Some(mode) => format!("{mode:?}"),
        None if action == Action::Disarm => "Disarmed".to_owned(),
        None => "Terminated".to_owned(),
    };
    let worse = || Action::ALL.into_iter().filter(|action| *action > Action::Warn);
    for to in worse().map(goal).collect::<BTreeSet<_>>() {
        let identities = [Identity::Px4, Identity::ArduPilot];
        let all = |cause: Cause| identities.into_iter().flat_map(move |identity| choices(identity, cause));
        let leads = |action: Action| action > Action::Warn && goal(action) == to;
        let by = |cause: &Cause| all(*cause).any(|(_, choice)| leads(choice));
        let causes: Vec<String> =
            Cause::ALL.into_iter().filter(by).map(|cause| cause.name().to_lowercase()).collect();
        meant.push(format!("Flying --> {to} : {}", causes.join(", ")));
    }
    meant.sort_unstable();
    assert_eq!(drawn, meant, "the diagram should be:\n{}", meant.join("\n"));
}
