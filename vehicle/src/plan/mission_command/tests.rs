//! Each command with the step that it becomes.

use core::f64::consts::{FRAC_PI_2, PI};

use nalgebra::Vector3;

use super::*;
use crate::identity::Identity;
use crate::plan::{Altitude, PlanKind, SpeedKind, SpeedTarget, check, frame};
use crate::world::{Geodetic, LocalFrame};

const NAN: f64 = f64::NAN;
/// The place of an item.
const AT: [f64; 3] = [30.0, -40.0, -10.0];
/// That of the item before it.
const BEFORE: [f64; 3] = [7.0, 8.0, -9.0];

/// Command, parameters and position of an item, and the step that it becomes.
type Case = (u16, [f64; 4], [f64; 3], Step);

fn item(command: u16, parameters: [f64; 4], position: [f64; 3]) -> MissionItem {
    MissionItem { frame: frame::LOCAL_NED, command, parameters, position, autocontinue: true }
}

fn place([x, y, z]: [f64; 3]) -> Place {
    Place { horizontal_m: Some([x, y]), altitude: Some(Altitude::Down(z)) }
}

fn site() -> Site {
    let origin = Geodetic { latitude_deg: 47.0, longitude_deg: 8.0, altitude_m: 400.0 };
    Site {
        identity: Identity::Px4,
        frame: LocalFrame::new(origin),
        home_m: Vector3::new(1.0, 2.0, -3.0),
        terrain: crate::surroundings::Terrain::default(),
    }
}

/// The step of an item that is checked, behind one that it may name.
fn step(item: &MissionItem, site: &Site) -> Step {
    let items = [self::item(NAV_WAYPOINT, [0.0; 4], BEFORE), *item];
    check::plan(PlanKind::Mission, &items, site).unwrap();
    (mission_command(item.command).unwrap().step)(&Source { item, items: &items, site })
}

#[rustfmt::skip] // A line per case reads as the table that it is.
fn navigation() -> Vec<Case> {
    let place = place(AT);
    let waypoint = |hold_s, acceptance_radius_m, heading_rad| {
        Navigate::Waypoint(Waypoint { place, hold_s, acceptance_radius_m, heading_rad })
    };
    let turns = |turns, radius_m| Navigate::LoiterTurns(Turns { place, turns, radius_m });
    let until = Delay::Until(TimeOfDay([Some(13), None, Some(30)]));
    let navigation = [
        (NAV_WAYPOINT, [5.0, 2.5, 0.0, 90.0], AT, waypoint(5.0, Some(2.5), Some(FRAC_PI_2))),
        (NAV_WAYPOINT, [NAN; 4], AT, waypoint(0.0, None, None)),
        (NAV_WAYPOINT, [0.0; 4], AT, waypoint(0.0, None, Some(0.0))),
        (NAV_LOITER_UNLIM, [0.0, 0.0, 5.0, -180.0], AT, Navigate::Loiter { place, heading_rad: Some(-PI) }),
        (NAV_LOITER_TURNS, [1.5, 0.0, -20.0, NAN], AT, turns(1.5, Some(-20.0))),
        (NAV_LOITER_TURNS, [2.0, 0.0, 0.0, NAN], AT, turns(2.0, None)),
        (NAV_LOITER_TIME, [12.0, 0.0, 5.0, 0.0], AT, Navigate::LoiterTime { place, time_s: 12.0 }),
        (NAV_RETURN_TO_LAUNCH, [0.0; 4], [0.0; 3], Navigate::ReturnToLaunch),
        (NAV_LAND, [0.0, 0.0, 0.0, NAN], [NAN; 3], Navigate::Land { place: Place::default(), heading_rad: None }),
        (NAV_VTOL_LAND, [0.0, 0.0, 0.0, NAN], [NAN; 3], Navigate::Land { place: Place::default(), heading_rad: None }),
        (NAV_VTOL_TAKEOFF, [0.0, 0.0, 0.0, NAN], AT, Navigate::Takeoff { place, travels: true }),
        (NAV_TAKEOFF, [15.0, 0.0, 0.0, 10.0], AT, Navigate::Takeoff { place, travels: true }),
        (NAV_LOITER_TO_ALT, [0.0, 25.0, 0.0, 0.0], AT, Navigate::LoiterToAltitude { place }),
        (NAV_SPLINE_WAYPOINT, [3.0, 0.0, 0.0, 0.0], AT, Navigate::Spline { place, hold_s: 3.0 }),
        (NAV_PAYLOAD_PLACE, [4.0, 0.0, 0.0, 0.0], AT, Navigate::PlacePayload { place, descent_m: Some(4.0) }),
        (NAV_SCRIPT_TIME, [1.0, 20.0, 0.0, 0.0], [0.0; 3], Navigate::Delay(Delay::For(20.0))),
        (NAV_DELAY, [3.5, -1.0, -1.0, -1.0], [0.0; 3], Navigate::Delay(Delay::For(3.5))),
        (NAV_DELAY, [-1.0, 13.0, NAN, 30.0], [0.0; 3], Navigate::Delay(until)),
    ];
    navigation.map(|(command, parameters, position, navigate)| (command, parameters, position, Step::Navigate(navigate))).into()
}

#[rustfmt::skip]
fn conditions_and_jumps() -> Vec<Case> {
    let turn = |to, rate_rad_s| Step::Condition(Condition::Yaw(Turn { to, rate_rad_s }));
    let counter_clockwise = TurnTo::Heading(PI, TurnDirection::CounterClockwise);
    let shortest = TurnTo::Heading(FRAC_PI_2, TurnDirection::Shortest);
    vec![
        (CONDITION_DELAY, [4.0, NAN, NAN, NAN], [NAN; 3], Step::Condition(Condition::Delay(4.0))),
        (CONDITION_DISTANCE, [15.0, NAN, NAN, NAN], [NAN; 3], Step::Condition(Condition::Distance(15.0))),
        (CONDITION_GATE, [0.0; 4], AT, Step::Condition(Condition::Gate(place(AT).horizontal_m.unwrap()))),
        (CONDITION_YAW, [180.0, 90.0, -1.0, 0.0], [0.0; 3], turn(counter_clockwise, Some(FRAC_PI_2))),
        (CONDITION_YAW, [90.0, NAN, NAN, NAN], [0.0; 3], turn(shortest, None)),
        (CONDITION_YAW, [90.0, 0.0, -1.0, 1.0], [0.0; 3], turn(TurnTo::By(-FRAC_PI_2), None)),
        (CONDITION_YAW, [90.0, 0.0, 0.0, 1.0], [0.0; 3], turn(TurnTo::By(FRAC_PI_2), None)),
        (DO_JUMP, [0.0, 3.0, NAN, NAN], [0.0; 3], Step::Jump(Jump { to: 0, repeats: Some(3) })),
        (DO_JUMP, [1.0, -1.0, NAN, NAN], [0.0; 3], Step::Jump(Jump { to: 1, repeats: None })),
    ]
}

#[rustfmt::skip]
fn actions() -> Vec<Case> {
    let speed = |kind, target| Do::ChangeSpeed(ChangeSpeed { kind, target });
    let ahead = |offset_rad| Do::Look(Some(Look::NextWaypoint { offset_rad }));
    let at = |position| Do::Look(Some(Look::At(place(position))));
    let actions = [
        (NAV_GUIDED_ENABLE, [0.0; 4], [0.0; 3], Do::Mark),
        (DO_CHANGE_SPEED, [1.0, 3.5, -1.0, 0.0], [0.0; 3], speed(SpeedKind::Horizontal, SpeedTarget::Limit(3.5))),
        (DO_CHANGE_SPEED, [0.0, -1.0, 0.0, 0.0], [0.0; 3], speed(SpeedKind::Horizontal, SpeedTarget::Keep)),
        (DO_CHANGE_SPEED, [2.0, -2.0, 0.0, 0.0], [0.0; 3], speed(SpeedKind::Up, SpeedTarget::Default)),
        (DO_CHANGE_SPEED, [3.0, 1.0, 0.0, 0.0], [0.0; 3], speed(SpeedKind::Down, SpeedTarget::Limit(1.0))),
        (DO_SET_HOME, [0.0, 0.0, 0.0, NAN], AT, Do::SetHome(Some(place(AT)))),
        (DO_SET_HOME, [1.0, 0.0, 0.0, NAN], AT, Do::SetHome(None)),
        (DO_SET_ROI_LOCATION, [0.0; 4], AT, at(AT)),
        (DO_SET_ROI_WPNEXT_OFFSET, [0.0; 4], [0.0, 0.0, 90.0], ahead(FRAC_PI_2)),
        (DO_SET_ROI_NONE, [0.0; 4], AT, Do::Look(None)),
        (DO_SET_ROI, [0.0; 4], AT, at(AT)),
        (DO_SET_ROI, [0.0; 4], [0.0; 3], Do::Look(None)),
        (DO_SET_ROI, [1.0, 0.0, 0.0, 0.0], AT, ahead(0.0)),
        (DO_SET_ROI, [2.0, 0.0, 0.0, 0.0], AT, at(BEFORE)),
        (DO_SET_ROI, [3.0, 0.0, 0.0, 0.0], AT, at(AT)),
        (NAV_ROI, [3.0, 0.0, 0.0, 0.0], AT, at(AT)),
        (NAV_ROI, [1.0, 0.0, 0.0, 0.0], AT, ahead(0.0)),
    ];
    actions.map(|(command, parameters, position, action)| (command, parameters, position, Step::Do(action))).into()
}

#[test]
fn every_command_becomes_its_step() {
    let (site, cases) = (site(), [navigation(), conditions_and_jumps(), actions()].concat());
    for (command, parameters, position, expected) in &cases {
        let item = item(*command, *parameters, *position);
        assert_eq!(step(&item, &site), *expected, "{item:?}");
    }
    let tested = |number| number == DO_JUMP_TAG || cases.iter().any(|(command, ..)| *command == number);
    let known = MISSION_COMMANDS.iter().map(|command| command.number);
    let untested: Vec<u16> = known.filter(|number| !tested(*number)).collect();
    assert!(untested.is_empty(), "commands without a case: {untested:?}");
}

#[test]
fn a_jump_to_a_tag_leads_to_its_item() {
    let site = site();
    let items = [item(JUMP_TAG, [7.0, 0.0, 0.0, 0.0], AT), item(DO_JUMP_TAG, [7.0, 2.0, 0.0, 0.0], AT)];
    check::plan(PlanKind::Mission, &items, &site).unwrap();
    let source = Source { item: &items[1], items: &items, site: &site };
    assert_eq!(jump_to_tag(&source), Step::Jump(Jump { to: 0, repeats: Some(2) }));
    let fault = check::plan(PlanKind::Mission, &items[1..], &site).unwrap_err();
    assert_eq!(fault.reason, "no item has tag 7");
}
