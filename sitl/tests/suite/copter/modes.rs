//! Modes: what they refuse, and what they tell.

use super::flier::*;
use crate::common::requests::local_target;
use crate::common::settings;
use mavlink::dialects::ardupilotmega::*;
use vehicle::identity::Identity;
use vehicle::plan::{Plan, PlanKind};

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
    // Places alone; velocities and accelerations without places. LAST_BYTE is set, as the suite does.
    for (asked, told, place, velocity) in [
        (0xf000 | 3576, 3576, [5.0, 5.0, -10.0], [0.0; 3]),
        (0xf000 | 3079, 3079, [0.0; 3], [2.0, 2.0, -1.0]),
    ] {
        let message = local_target(asked, place, velocity);
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

/// Flies until the sink rate, m/s, has been within some of a value for some seconds.
fn wait_sink_rate(flier: &mut Flier, rate_m_s: f64, within_m_s: f64, seconds: f64) {
    let mut steady = 0;
    for _ in 0..3000 {
        steady = if (-flier.climb_m_s() - rate_m_s).abs() <= within_m_s { steady + 1 } else { 0 };
        if f64::from(steady) * 0.02 >= seconds {
            return;
        }
        flier.fly(0.02);
    }
    panic!("not {rate_m_s} m/s down: {} m/s at {} m", -flier.climb_m_s(), flier.height_m());
}

/// Suite: Landing. It sinks with one speed down to a height and with another one below it. The first may be larger than the sink rate of
/// the rest of the flight, WP_SPD_DN.
#[test]
fn landings_have_a_speed_above_and_one_below_a_height() {
    let mut flier = Flier::new();
    let usual_m_s = flier.vehicle().simulation().configuration().limits.speed_down_m_s;
    for (fast_m_s, slow_m_s, low_m, within_m_s) in [(0.0, 0.5, 10.0, 0.1), (5.0, 1.0, 30.0, 0.5)] {
        flier.set_all(&[
            ("LAND_SPEED_HIGH", fast_m_s * 100.0),
            ("LAND_SPEED", slow_m_s * 100.0),
            ("LAND_ALT_LOW", low_m * 100.0),
        ]);
        let first_m_s = if fast_m_s > 0.0 { fast_m_s } else { usual_m_s };
        flier.take_off(5.0 * first_m_s + low_m + 20.0, GUIDED);
        flier.change_mode(LAND);
        wait_sink_rate(&mut flier, first_m_s, within_m_s, 5.0);
        wait_sink_rate(&mut flier, slow_m_s, 0.1, 0.02);
        assert!((flier.height_m() - low_m).abs() < 1.0, "{} m", flier.height_m());
        wait_sink_rate(&mut flier, slow_m_s, 0.1, low_m / slow_m_s / 2.0);
        flier.wait_disarmed(60.0);
    }
}

/// A landing that is given up leaves nothing of its speed behind.
#[test]
fn the_speed_of_a_landing_ends_with_it() {
    let mut flier = Flier::new();
    let down_m_s = |flier: &Flier| flier.vehicle().simulation().configuration().limits.speed_down_m_s;
    let usual_m_s = down_m_s(&flier);
    flier.set("LAND_SPEED_HIGH", 500.0);
    flier.take_off(60.0, LOITER);
    assert_eq!(down_m_s(&flier), usual_m_s);
    flier.change_mode(LAND);
    flier.wait("5 m/s", 10.0, |flier| flier.climb_m_s() < -4.5);
    flier.change_mode(LOITER);
    flier.wait("a stop", 10.0, |flier| flier.climb_m_s().abs() < 0.1);
    assert!(flier.height_m() > 20.0 && down_m_s(&flier) == usual_m_s, "{} m", flier.height_m());
    flier.change_mode(GUIDED);
    assert_eq!(flier.command(MavCmd::MAV_CMD_NAV_LAND, [0.0; 7]), ACCEPTED);
    flier.wait_disarmed(120.0);
    flier.fly(0.1);
    assert_eq!(down_m_s(&flier), usual_m_s);
}

/// ArduCopter shows the mode in which it has landed until somebody chooses another, and cannot be armed in it.
#[test]
fn the_mode_stays_after_the_landing() {
    for mode in [RTL, LAND] {
        let mut flier = Flier::new();
        flier.take_off(5.0, GUIDED);
        flier.change_mode(mode);
        flier.wait_disarmed(60.0);
        flier.fly(1.0);
        assert_eq!(flier.mode(), mode);
        let arming = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        assert_ne!(flier.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, arming), ACCEPTED);
        assert!(flier.has_said("mode not armable"), "{:?}", flier.bench.texts());
        flier.take_off(5.0, GUIDED);
    }
}

/// So does Auto after its last item; chosen again, the mission begins anew.
#[test]
fn auto_stays_after_its_landing() {
    for last in [20, 21] {
        let mut flier = with_mission(&[(22, 0.0, 0.0, 8.0), (16, 20.0, 0.0, 8.0), (last, 0.0, 0.0, 0.0)]);
        for _ in 0..2 {
            flier.change_mode(GUIDED);
            flier.arm();
            flier.change_mode(AUTO);
            flier.wait("the waypoint", 60.0, |flier| flier.distance_m() > 15.0);
            flier.wait_disarmed(90.0);
            flier.fly(1.0);
            assert_eq!(flier.mode(), AUTO, "after {last}");
        }
    }
}

/// A mission that is flown anew without leaving its mode keeps to the speeds of its items.
#[test]
fn speeds_of_a_mission_hold_when_auto_is_armed_again() {
    let mut start = settings(Identity::ArduPilot);
    let rows = [(22, 0.0, 0.0, 8.0), (178, 0.0, 0.0, 0.0), (16, 60.0, 0.0, 8.0)];
    let mut items = mission(&start, &rows).items().to_vec();
    items[2].parameters = [1.0, 2.0, -1.0, 0.0];
    start.plans.set(PlanKind::Mission, Plan::new(items));
    let mut flier = Flier::with(&start);
    flier.set("AUTO_OPTIONS", 3.0);
    flier.change_mode(AUTO);
    flier.arm();
    let by_force = [0.0, 21196.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(flier.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, by_force), ACCEPTED);
    flier.fly(1.0);
    assert_eq!(flier.mode(), AUTO);
    flier.arm();
    flier.wait("the way", 60.0, |flier| flier.distance_m() > 20.0);
    assert!((flier.speed_m_s() - 2.0).abs() < 0.1, "{} m/s", flier.speed_m_s());
}

/// Suite: ModeAllowsEntryWhenNoPilotInput.
#[test]
fn a_lost_pilot_gets_no_mode_that_only_he_could_fly() {
    let mut flier = Flier::new();
    flier.set("FS_THR_ENABLE", 4.0);
    flier.take_off(20.0, GUIDED);
    flier.rc(3, 200);
    flier.wait_text("Radio Failsafe", 5.0);
    flier.change_mode(GUIDED);
    for mode in [STABILIZE, ACRO] {
        assert_eq!(flier.ask_mode(mode), FAILED, "{mode}");
        assert!(flier.has_said("in RC failsafe"), "{:?}", flier.bench.texts());
    }
    flier.rc(3, 1500);
    flier.wait_text("Radio Failsafe Cleared", 5.0);
    flier.change_mode(STABILIZE);
    flier.change_mode(LOITER);
    flier.return_home();
}

/// Suite: ArmFeatures: an armed vehicle enters no mode that needs a place where it knows none, also on the ground; a disarmed one may.
#[test]
fn an_armed_vehicle_without_a_place_enters_no_mode_that_needs_one() {
    let mut flier = Flier::new();
    flier.set("SIM_GPS1_ENABLE", 0.0);
    flier.fly(8.0);
    flier.change_mode(LOITER);
    flier.change_mode(STABILIZE);
    flier.arm();
    assert_eq!(flier.ask_mode(LOITER), FAILED);
    assert!(flier.has_said("requires position"), "{:?}", flier.bench.texts());
    flier.change_mode(ALT_HOLD);
}

/// Suite: HomeAltResetTest, its speeds: down with WP_SPD_DN to LAND_ALT_LOW_M, and from there with LAND_SPD_MS, by the defaults of
/// ArduCopter.
#[test]
fn a_landing_is_slow_from_ten_metres_on() {
    let mut flier = Flier::new();
    flier.take_off(30.0, LOITER);
    flier.change_mode(LAND);
    flier.wait("14 m", 30.0, |flier| flier.height_m() < 14.0);
    assert!(flier.climb_m_s() < -2.0, "{}", flier.climb_m_s());
    flier.wait("9 m", 20.0, |flier| flier.height_m() < 9.0);
    for _ in 0..10 {
        assert!((flier.climb_m_s() + 0.5).abs() < 0.1, "{}", flier.climb_m_s());
        flier.fly(1.0);
    }
    flier.wait_disarmed(60.0);
}
