//! Modes: what they refuse, and what they tell.

use super::flier::*;
use mavlink::dialects::ardupilotmega::*;

const ACRO: u32 = 1;
const CIRCLE: u32 = 7;
const DRIFT: u32 = 11;
const BRAKE: u32 = 17;

/// Suite: ManualThrottleModeChange.
#[test]
fn a_high_throttle_keeps_from_modes_that_would_leap() {
    let mut flier = Flier::new();
    flier.change_mode(STABILIZE);
    flier.arm();
    for mode in [ACRO, STABILIZE, GUIDED] {
        flier.change_mode(mode);
    }
    flier.rc(3, 1700);
    flier.fly(2.0);
    assert!(flier.height_m() < 0.2);
    for mode in [ACRO, STABILIZE, DRIFT, 126] {
        assert_eq!(flier.ask_mode(mode), FAILED, "{mode}");
    }
    flier.rc(3, 1000);
    flier.fly(0.5);
    flier.change_mode(ACRO);
    flier.wait_disarmed(30.0);
}

/// Suite: MAV_CMD_NAV_LOITER_UNLIM, MAV_CMD_NAV_RETURN_TO_LAUNCH, MAV_CMD_NAV_VTOL_LAND.
#[test]
fn navigation_commands_change_modes_on_the_ground() {
    let mut flier = Flier::new();
    for (command, mode) in [
        (MavCmd::MAV_CMD_NAV_LOITER_UNLIM, LOITER),
        (MavCmd::MAV_CMD_NAV_RETURN_TO_LAUNCH, RTL),
        (MavCmd::MAV_CMD_NAV_VTOL_LAND, LAND),
        (MavCmd::MAV_CMD_NAV_LAND, LAND),
    ] {
        flier.change_mode(STABILIZE);
        assert_eq!(flier.command(command, [0.0; 7]), ACCEPTED, "{command:?}");
        assert_eq!(flier.mode(), mode);
    }
}

/// Suite: BrakeMode.
#[test]
fn brake_stops_whatever_the_sticks_say() {
    let mut flier = Flier::new();
    flier.take_off(10.0, LOITER);
    flier.change_mode(STABILIZE);
    flier.rc(3, 1500);
    flier.rc(2, 1200);
    flier.wait("5 m/s", 30.0, |flier| flier.speed_m_s() > 5.0);
    flier.change_mode(BRAKE);
    flier.wait("a stop", 30.0, |flier| flier.speed_m_s() < 1.0);
    flier.rc(2, 1500);
    flier.return_home();
}

/// Suite: ModeCircle.
#[test]
fn circle_is_flown_and_left() {
    let mut flier = Flier::new();
    flier.take_off(10.0, LOITER);
    flier.set("CIRCLE_RADIUS", 3000.0);
    flier.rc(2, 1100);
    flier.wait("100 m", 60.0, |flier| flier.distance_m() > 100.0);
    flier.rc(2, 1500);
    flier.change_mode(CIRCLE);
    flier.fly(36.0);
    assert_eq!(flier.mode(), CIRCLE);
    flier.return_home();
}

/// Suite: GuidedSubModeChange, PAUSE_CONTINUE_GUIDED. What Guided is asked for is told with the mask of what counts, and nothing is
/// told in Loiter.
#[test]
fn guided_tells_what_it_is_asked_for_and_loiter_nothing() {
    let mut flier = Flier::new();
    flier.take_off(10.0, GUIDED);
    flier.wait("10 m", 30.0, |flier| flier.height_m() > 9.8);
    flier.fly(2.0);
    let ask = |type_mask: u16, place: [f32; 3], velocity: [f32; 3]| {
        MavMessage::SET_POSITION_TARGET_LOCAL_NED(SET_POSITION_TARGET_LOCAL_NED_DATA {
            target_system: 1,
            target_component: 1,
            coordinate_frame: MavFrame::MAV_FRAME_LOCAL_NED,
            type_mask: PositionTargetTypemask::from_bits_retain(type_mask),
            x: place[0],
            y: place[1],
            z: place[2],
            vx: velocity[0],
            vy: velocity[1],
            vz: velocity[2],
            ..SET_POSITION_TARGET_LOCAL_NED_DATA::default()
        })
    };
    // Places alone; velocities and accelerations without places. LAST_BYTE is set, as the suite does.
    for (asked, told, place, velocity) in [
        (0xf000 | 3576, 3576, [5.0, 5.0, -10.0], [0.0; 3]),
        (0xf000 | 3079, 3079, [0.0; 3], [2.0, 2.0, -1.0]),
    ] {
        let message = ask(asked, place, velocity);
        flier.bench.send(message);
        flier.bench.heard.clear();
        flier.fly(1.0);
        let target = target(&flier).expect("told in Guided");
        assert_eq!(target.type_mask.bits(), told);
        if told == 3576 {
            assert_eq!([target.x, target.y, target.z], place);
        } else {
            assert_eq!([target.vx, target.vy, target.vz], velocity);
        }
    }
    flier.rc(3, 1500);
    flier.change_mode(LOITER);
    flier.bench.heard.clear();
    flier.fly(5.0);
    assert!(target(&flier).is_none());
    flier.return_home();
}

fn target(flier: &Flier) -> Option<POSITION_TARGET_LOCAL_NED_DATA> {
    flier.latest(|message| match message {
        MavMessage::POSITION_TARGET_LOCAL_NED(target) => Some(target.clone()),
        _ => None,
    })
}

/// SIM_SHOVE accelerates along the axes of the body while its time lasts, which is zero again afterwards.
#[test]
fn a_shove_lasts_its_time() {
    let mut flier = Flier::new();
    flier.take_off(20.0, GUIDED);
    flier.fly(5.0);
    flier.set_all(&[("SIM_SHOVE_Z", -5.0), ("SIM_SHOVE_TIME", 300.0)]);
    let before = flier.climb_m_s();
    flier.fly(0.3);
    let gained = flier.climb_m_s() - before;
    // Without control it would be 1.5 m/s.
    assert!((0.5..1.6).contains(&gained), "{gained}");
    flier.fly(5.0);
    assert!(flier.climb_m_s().abs() < 0.2 && flier.vehicle().conduct().simulated.pushes.shove.time_ms == 0);
}
