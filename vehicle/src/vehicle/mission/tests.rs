//! The mission by itself, in situations that are made by hand.

use super::Mission;
use super::status::MissionState;
use crate::identity::Identity;
use crate::mode::Mode;
use crate::plan::step::{Condition, Do, Jump, Navigate, Step, Waypoint};
use crate::plan::{Altitude, ChangeSpeed, Place, Program, ProgramStep};
use crate::vehicle::proposal::{Proposal, Request};
use crate::vehicle::scene::{Scene, said};
use crate::vehicle::speeds::SpeedChange;
use crate::vehicle::steering::Steering;
use crate::vehicle::tick::TICK_US;

fn place([x, y, z]: [f64; 3]) -> Place {
    Place { horizontal_m: Some([x, y]), altitude: Some(Altitude::Down(z)) }
}

/// A place to stay at for a moment.
fn waypoint(position_m: [f64; 3]) -> Step {
    Step::Navigate(Navigate::Waypoint(Waypoint {
        place: place(position_m),
        hold_s: 0.01,
        acceptance_radius_m: None,
        heading_rad: None,
    }))
}

fn takeoff(height_m: f64) -> Step {
    let altitude = Some(Altitude::AboveHome(height_m));
    Step::Navigate(Navigate::Takeoff { place: Place { horizontal_m: None, altitude }, travels: true })
}

fn slow_down() -> Step {
    Step::Do(Do::ChangeSpeed(ChangeSpeed::of(1.0, 3.0).unwrap()))
}

fn mission(steps: &[Step]) -> Mission {
    let steps = steps.iter().map(|step| ProgramStep { step: *step, continues: true });
    Mission::new(Program::new(steps.collect(), 0))
}

/// A mission that is entered in flight.
fn entered(steps: &[Step], scene: &mut Scene) -> Mission {
    let mut mission = mission(steps);
    scene.mode = Mode::Mission;
    scene.show(|situation, proposal| mission.enter(situation, proposal));
    mission
}

/// One tick, after which the vehicle is where it was led.
fn tick(mission: &mut Mission, scene: &mut Scene) -> Vec<Request> {
    scene.wait_us(TICK_US);
    let requests = scene.show(|situation, proposal| mission.step(situation, proposal));
    if let Some(goal_m) = scene.goal_m() {
        scene.come_to(goal_m, [0.0; 3]);
        scene.landed = false;
    }
    requests
}

/// Ticks until something was reached.
fn next_reached(mission: &mut Mission, scene: &mut Scene) -> Vec<u16> {
    for _ in 0..100 {
        tick(mission, scene);
        let reached = mission.take_reached();
        if !reached.is_empty() {
            return reached;
        }
    }
    panic!("nothing is reached: {mission:?}");
}

#[test]
fn it_takes_off_flies_and_lands() {
    let land = Step::Navigate(Navigate::Land { place: place([20.0, 0.0, 0.0]), heading_rad: None });
    let mut mission = mission(&[takeoff(10.0), waypoint([20.0, 0.0, -10.0]), land]);
    let mut scene = Scene::on_the_ground();
    let requests = scene.show(|situation, proposal| mission.start(situation, proposal, None).unwrap());
    assert_eq!(requests, [Request::Enter(Mode::Mission)]);
    scene.mode = Mode::Mission;
    let requests = scene.show(|situation, proposal| mission.enter(situation, proposal));
    assert_eq!(requests, [Request::ChangeSpeeds(SpeedChange::InMission(true))]);

    assert_eq!(said(&tick(&mut mission, &mut scene)), ["Taking off to 10.0 m above home"]);
    assert_eq!((scene.goal_m(), mission.is_vertical()), (Some([0.0, 0.0, -10.0]), (true, false)));
    assert_eq!(mission.status(Mode::Mission).state, MissionState::Active);
    assert_eq!(next_reached(&mut mission, &mut scene), [0]);
    assert_eq!(next_reached(&mut mission, &mut scene), [1]);
    assert_eq!(scene.goal_m(), Some([20.0, 0.0, -10.0]));
    while mission.is_vertical() != (false, true) {
        assert_eq!(tick(&mut mission, &mut scene), []);
    }
    tick(&mut mission, &mut scene);
    assert_eq!(scene.goal_m(), None, "it sinks");
    (scene.landed, scene.steering) = (true, Steering::Idle { yaw_rad: 0.0 });
    assert_eq!(said(&tick(&mut mission, &mut scene)), ["Mission complete"]);
    assert_eq!(mission.take_reached(), [2]);
    assert_eq!(mission.status(Mode::Mission).state, MissionState::Complete);
}

#[test]
fn jumps_are_made_as_often_as_asked_and_count_as_reached() {
    let (one, other) = (waypoint([20.0, 0.0, -10.0]), waypoint([20.0, 20.0, -10.0]));
    let jump = Step::Jump(Jump { to: 0, repeats: Some(2) });
    let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]);
    let mut mission = entered(&[one, other, jump, one], &mut scene);
    let mut order = Vec::new();
    while mission.status(Mode::Mission).state == MissionState::Active || order.is_empty() {
        order.extend(next_reached(&mut mission, &mut scene));
    }
    assert_eq!(order, [0, 1, 2, 0, 1, 2, 0, 1, 3]);
}

#[test]
fn what_is_on_the_way_waits_for_its_condition() {
    let steps = [
        waypoint([0.0, 0.0, -10.0]),
        Step::Condition(Condition::Delay(0.5)),
        slow_down(),
        waypoint([50.0, 0.0, -10.0]),
    ];
    let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]);
    let mut mission = entered(&steps, &mut scene);
    assert_eq!(next_reached(&mut mission, &mut scene), [0]);
    let step = |mission: &mut Mission, scene: &mut Scene| {
        scene.show(|situation, proposal| mission.step(situation, proposal))
    };
    assert_eq!(step(&mut mission, &mut scene), []);
    scene.wait_us(500_000);
    let requests = step(&mut mission, &mut scene);
    assert!(matches!(requests[..], [Request::ChangeSpeeds(SpeedChange::Mission(_))]), "{requests:?}");
    assert_eq!(mission.take_reached(), [1, 2]);
}

#[test]
fn a_condition_ends_with_its_leg() {
    let never = Step::Condition(Condition::Delay(1000.0));
    let steps = [waypoint([20.0, 0.0, -10.0]), never, slow_down(), waypoint([0.0, 0.0, -10.0])];
    let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]);
    let mut mission = entered(&steps, &mut scene);
    assert_eq!(next_reached(&mut mission, &mut scene), [0]);
    assert_eq!(next_reached(&mut mission, &mut scene), [3]);
}

#[test]
fn ardupilot_pauses_in_its_mode() {
    let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]);
    scene.identity = Identity::ArduPilot;
    let mut mission = entered(&[waypoint([20.0, 0.0, -10.0])], &mut scene);
    scene.show(|situation, proposal| mission.step(situation, proposal));
    let requests = scene.show(|situation, proposal| mission.pause(situation, proposal));
    assert_eq!(said(&requests), ["Mission paused"]);
    let steering = scene.steering;
    assert_eq!(scene.show(|situation, proposal| mission.step(situation, proposal)), []);
    assert_eq!((scene.steering, mission.status(Mode::Mission).state), (steering, MissionState::Paused));
    assert_eq!(mission.may_continue(), Ok(()));
    scene.show(|situation, proposal| mission.start(situation, proposal, None).unwrap());
    assert_eq!(next_reached(&mut mission, &mut scene), [0]);
}

/// MIS_RESTART is of missions that are entered, not of an item that is asked for, such as the landing.
#[test]
fn an_item_that_is_asked_for_is_flown_where_missions_begin_anew() {
    let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]);
    scene.conduct.mission_restarts = true;
    let steps = [10.0, 20.0, 30.0].map(|north_m| waypoint([north_m, 0.0, -10.0]));
    let mut mission = entered(&steps, &mut scene);
    assert_eq!(next_reached(&mut mission, &mut scene), [0]);
    scene.show(|_, proposal| mission.leave(proposal));
    scene.mode = Mode::Hold;
    scene.show(|situation, proposal| mission.start(situation, proposal, Some(2)).unwrap());
    scene.mode = Mode::Mission;
    scene.show(|situation, proposal| mission.enter(situation, proposal));
    assert_eq!(mission.current(), 2);
    tick(&mut mission, &mut scene);
    scene.show(|_, proposal| mission.leave(proposal));
    scene.show(|situation, proposal| mission.enter(situation, proposal));
    assert_eq!(mission.current(), 0);
}

#[test]
fn a_last_action_completes_it_once() {
    let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]);
    let mut mission = entered(&[waypoint([20.0, 0.0, -10.0]), slow_down()], &mut scene);
    scene.show(|situation, proposal| mission.set_current(situation, proposal, 1, false).unwrap());
    let requests = scene.show(|situation, proposal| mission.step(situation, proposal));
    let [Request::ChangeSpeeds(_), Request::Say(notice), Request::Enter(Mode::Hold)] = &requests[..] else {
        panic!("{requests:?}");
    };
    assert_eq!((notice.text.as_str(), mission.take_reached()), ("Mission complete", vec![1]));
}

#[test]
fn it_starts_with_what_there_is() {
    let scene = Scene::hovering_at([0.0, 0.0, -10.0]);
    let refusal = |mission: &mut Mission, first| {
        let situation = scene.situation();
        let mut proposal = Proposal::new(&situation);
        mission.start(&situation, &mut proposal, first).unwrap_err().to_string()
    };
    assert_eq!(refusal(&mut mission(&[slow_down()]), None), "Mission rejected: no mission uploaded");
    let mut one = mission(&[waypoint([20.0, 0.0, -10.0])]);
    assert_eq!(refusal(&mut one, Some(1)), "Mission item 1 does not exist; the mission has 1");
    assert_eq!(one, mission(&[waypoint([20.0, 0.0, -10.0])]), "nothing has changed");
}
