//! Instruments that mislead the estimator.

use super::flier::*;
use mavlink::dialects::ardupilotmega::*;
use vehicle::estimation::{SensorModel, SensorSettings};
use vehicle::identity::Identity;
use vehicle::plan::PlanKind;

/// With instruments that have errors, once the estimator has aligned.
fn with_instruments() -> Flier {
    let mut start = crate::common::settings(Identity::ArduPilot);
    start.sensors = SensorSettings { model: SensorModel::Realistic, seed: 1 };
    let mut flier = Flier::with(&start);
    flier.fly(4.0);
    flier
}

/// True height, m.
fn true_height_m(flier: &Flier) -> f64 {
    -flier.vehicle().truth().position_m.z
}

/// Suite: VibrationFailsafe.
#[test]
fn accelerometers_that_mislead_are_told_and_the_vehicle_comes_down() {
    let mut flier = with_instruments();
    flier.take_off(20.0, LOITER);
    flier.fly(3.0);
    flier.bench.heard.clear();
    flier.set("SIM_ACC1_BIAS_Z", 2.0);
    flier.wait_text("Vibration compensation ON", 30.0);
    flier.change_mode(LAND);
    flier.wait("2 m", 50.0, |flier| true_height_m(flier) < 2.0);
}

/// The same with FS_VIBE_ENABLE = 0: the estimator goes on by the accelerometers.
#[test]
fn compensation_of_vibrations_can_be_switched_off() {
    let mut flier = with_instruments();
    flier.set("FS_VIBE_ENABLE", 0.0);
    flier.take_off(20.0, LOITER);
    flier.fly(3.0);
    flier.bench.heard.clear();
    flier.set("SIM_ACC1_BIAS_Z", 2.0);
    flier.fly(10.0);
    assert!(!flier.has_said("Vibration compensation"));
}

/// Whether EKF_STATUS_REPORT of now shows that the place on the map is known.
fn knows_place(flier: &mut Flier) -> bool {
    const EKF_STATUS_REPORT: f32 = 193.0;
    let parameters = [EKF_STATUS_REPORT, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(flier.command(MavCmd::MAV_CMD_REQUEST_MESSAGE, parameters), ACCEPTED);
    let flags = flier.latest(|message| match message {
        MavMessage::EKF_STATUS_REPORT(report) => Some(report.flags),
        _ => None,
    });
    flags.expect("a report").contains(EkfStatusFlags::EKF_POS_HORIZ_ABS)
}

/// Suite: GPSGlitchAuto: two seconds without the receiver, then its jumps on the way of a mission.
#[test]
fn a_mission_is_flown_through_an_outage_and_jumps_of_the_receiver() {
    let rows = [(22, 0.0, 0.0, 20.0), (16, 200.0, 0.0, 40.0), (16, 200.0, 60.0, 40.0), (20, 0.0, 0.0, 0.0)];
    let mut start = crate::common::settings(Identity::ArduPilot);
    start.sensors = SensorSettings { model: SensorModel::Realistic, seed: 1 };
    start.plans.set(PlanKind::Mission, mission(&start, &rows));
    let mut flier = Flier::with(&start);
    flier.fly(4.0);
    flier.change_mode(STABILIZE);
    flier.arm();
    flier.change_mode(AUTO);
    flier.rc(3, 1500);
    flier.wait("100 m", 90.0, |flier| flier.distance_m() > 100.0);
    flier.change_mode(LOITER);
    flier.set("SIM_GPS_DISABLE", 1.0);
    flier.fly(2.0);
    flier.set("SIM_GPS_DISABLE", 0.0);
    flier.fly(0.5);
    assert!(knows_place(&mut flier) && flier.mode() == LOITER);
    flier.fly(10.0);
    assert!(knows_place(&mut flier) && flier.mode() == LOITER);
    flier.change_mode(AUTO);
    for (north_deg, east_deg) in
        [(3.0, 0.7), (7.0, 0.9), (9.4, 2.8), (10.0, 2.6), (9.4, 2.8), (7.7, 2.0), (6.2, 1.3)]
    {
        flier.set_all(&[("SIM_GPS_GLITCH_X", north_deg * 1e-4), ("SIM_GPS_GLITCH_Y", east_deg * 1e-4)]);
        flier.fly(0.45);
    }
    flier.set_all(&[("SIM_GPS_GLITCH_X", 0.0), ("SIM_GPS_GLITCH_Y", 0.0)]);
    flier.wait("the corner", 120.0, |flier| {
        let place_m = flier.vehicle().truth().position_m;
        (place_m.x - 200.0).hypot(place_m.y - 60.0) < 10.0
    });
    assert_eq!(flier.mode(), AUTO);
    flier.wait_disarmed(180.0);
    assert!(flier.vehicle().truth().position_m.xy().norm() < 10.0);
}

/// How far north of the truth the estimate is after some seconds at eight metres per second, m, with fixes that come so late.
fn leads_m(late_ms: f64) -> f64 {
    let mut flier = with_instruments();
    flier.set_all(&[("SIM_GPS1_HZ", 5.0), ("SIM_GPS1_LAG_MS", late_ms)]);
    flier.take_off(20.0, LOITER);
    flier.rc(2, 1100);
    flier.fly(10.0);
    assert!(flier.vehicle().truth().velocity_m_s.x > 7.0, "{}", flier.vehicle().truth().velocity_m_s);
    flier.vehicle().outputs().position_m.x - flier.vehicle().truth().position_m.x
}

/// The estimator knows when a fix was taken: 0.3 s later, it would be 2 m behind. The receivers' noise is the same.
#[test]
fn fixes_that_come_late_are_taken_for_the_time_at_which_they_were_taken() {
    let [early_m, late_m] = [0.0, 300.0].map(leads_m);
    assert!((early_m - late_m).abs() < 0.7, "{early_m} m, {late_m} m");
}

/// Suite: GPSGlitchLoiter: jumps of the receiver, 30 to 110 m, each for less than half a second.
#[test]
fn jumps_of_the_receiver_do_not_lead_away_a_vehicle_that_loiters() {
    let mut flier = with_instruments();
    flier.take_off(10.0, LOITER);
    flier.rc(2, 1100);
    flier.wait("60 m", 60.0, |flier| flier.distance_m() > 60.0);
    flier.rc(2, 1500);
    flier.wait("a stop", 30.0, |flier| flier.speed_m_s() < 0.3);
    let from_m = flier.vehicle().truth().position_m;
    for (north_deg, east_deg) in [(3, 7), (7, 10), (10, 2), (4, -6), (-5, -8), (-9, 3), (6, 6)] {
        flier.set_all(&[
            ("SIM_GPS1_GLTCH_X", f64::from(north_deg) * 1e-4),
            ("SIM_GPS1_GLTCH_Y", f64::from(east_deg) * 1e-4),
        ]);
        flier.fly(0.45);
    }
    flier.set_all(&[("SIM_GPS1_GLTCH_X", 0.0), ("SIM_GPS1_GLTCH_Y", 0.0)]);
    for _ in 0..27 {
        flier.fly(1.0);
        let moved_m = (flier.vehicle().truth().position_m - from_m).xy().norm();
        assert!(moved_m < 20.0 && flier.mode() == LOITER, "{moved_m} m, mode {}", flier.mode());
    }
    flier.change_mode(RTL);
    flier.wait_disarmed(200.0);
    assert!(flier.vehicle().truth().position_m.xy().norm() < 10.0);
}

/// Suite: GPSGlitchLoiter2: the receiver leaps by 111 m and stays there. The vehicle takes the place over without leaning towards it.
#[test]
fn a_leap_of_the_receiver_is_taken_over_level() {
    // Whether it has just stopped or rested for long.
    for rested_s in [5.0, 200.0] {
        let mut flier = with_instruments();
        flier.take_off(10.0, LOITER);
        flier.fly(rested_s);
        let (known_m, true_m) = (flier.vehicle().outputs().position_m, flier.vehicle().truth().position_m);
        flier.set("SIM_GPS1_GLTCH_X", 0.001);
        let mut lean_deg = 0.0_f64;
        for _ in 0..2000 {
            flier.fly(0.02);
            let attitude_rad = flier.vehicle().truth().attitude_rad;
            lean_deg = lean_deg.max(attitude_rad.xy().amax().to_degrees());
        }
        assert!(lean_deg < 2.0, "after {rested_s} s: {lean_deg} deg");
        let leapt_m = (flier.vehicle().outputs().position_m - known_m).x;
        let flown_m = (flier.vehicle().truth().position_m - true_m).xy().norm();
        assert!(leapt_m > 90.0 && flown_m < 10.0 && flier.mode() == LOITER, "{leapt_m} m, {flown_m} m");
    }
}

/// How far the estimate is from the receiver's place, m, over the ground.
fn off_receiver_m(flier: &Flier) -> f64 {
    let fix = flier.vehicle().readings().gps.expect("a fix");
    (fix.position_m - flier.vehicle().outputs().position_m).xy().norm()
}

/// A leap so short that the filter may take it for the receiver's usual error is followed, too, whatever that error is. PX4's EKF2 and
/// ArduPilot's EKF3 are at the receiver's place again after some seconds.
#[test]
fn a_small_leap_of_the_receiver_is_followed_as_well() {
    for seed in 1..=8 {
        for leap_m in [7.0, 10.0] {
            let mut start = crate::common::settings(Identity::ArduPilot);
            start.sensors = SensorSettings { model: SensorModel::Realistic, seed };
            let mut flier = Flier::with(&start);
            flier.fly(4.0);
            flier.take_off(10.0, LOITER);
            flier.fly(5.0);
            let before_m = flier.vehicle().outputs().position_m - flier.vehicle().truth().position_m;
            flier.set("SIM_GPS1_GLTCH_X", leap_m / 111_194.9);
            flier.fly(6.0);
            let early_m = flier.vehicle().outputs().position_m - flier.vehicle().truth().position_m;
            assert!((early_m - before_m).xy().norm() < 1.0, "seed {seed}: a leap is not believed at once");
            flier.fly(24.0);
            let off_m = off_receiver_m(&flier);
            assert!(off_m < 4.0 && flier.mode() == LOITER, "seed {seed}, {leap_m} m: {off_m} m off");
        }
    }
}

/// SIM_GPS1_JAM in Loiter: the place is lost, and the failsafe of the estimator lands the vehicle near where it was.
#[test]
fn a_jammed_receiver_is_not_believed() {
    let mut flier = with_instruments();
    flier.take_off(10.0, LOITER);
    flier.fly(5.0);
    let from_m = flier.vehicle().truth().position_m;
    flier.set("SIM_GPS1_JAM", 1.0);
    flier.wait("the failsafe", 40.0, |flier| flier.mode() == LAND);
    assert!(!knows_place(&mut flier));
    flier.wait_disarmed(60.0);
    let drifted_m = (flier.vehicle().truth().position_m - from_m).xy().norm();
    assert!(drifted_m < 25.0, "{drifted_m} m");
}

/// Jammed for two seconds: it dead reckons, and knows its place again afterwards.
#[test]
fn a_short_jam_is_flown_through() {
    let mut flier = with_instruments();
    flier.take_off(10.0, LOITER);
    flier.fly(5.0);
    let from_m = flier.vehicle().truth().position_m;
    flier.set("SIM_GPS1_JAM", 1.0);
    flier.fly(2.0);
    flier.set("SIM_GPS1_JAM", 0.0);
    flier.fly(10.0);
    let drifted_m = (flier.vehicle().truth().position_m - from_m).xy().norm();
    assert!(knows_place(&mut flier) && flier.mode() == LOITER && drifted_m < 8.0, "{drifted_m} m");
}

/// Each of the three sets of sources can be used; there is no other.
#[test]
fn the_estimator_has_three_sets_of_sources() {
    let mut flier = Flier::new();
    let (accepted, denied) = (MavResult::MAV_RESULT_ACCEPTED, MavResult::MAV_RESULT_DENIED);
    for (set, result) in [(2.0, accepted), (3.0, accepted), (1.0, accepted), (4.0, denied), (0.5, denied)] {
        let parameters = [set, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        assert_eq!(flier.command(MavCmd::MAV_CMD_SET_EKF_SOURCE_SET, parameters), result as u8, "{set}");
    }
}

/// Suite: GPSFixTypes. The receiver tells the kind of its fix; one without a height is no place.
#[test]
fn the_receiver_tells_the_kind_of_its_fix() {
    let mut flier = with_instruments();
    flier.fly(10.0);
    flier.change_mode(LOITER);
    for fix in (0..=6).rev() {
        flier.set("SIM_GPS1_FIXTYPE", f64::from(fix));
        flier.bench.heard.clear();
        flier.fly(2.0);
        let told = flier.latest(|message| match message {
            MavMessage::GPS_RAW_INT(gps) => Some((gps.fix_type as u32, gps.lat != 0)),
            _ => None,
        });
        assert_eq!(told, Some((fix, fix >= 3)));
    }
    flier.fly(10.0);
    assert!(flier.obstacles().iter().any(|text| text.contains("GPS")), "{:?}", flier.obstacles());
    flier.set("SIM_GPS1_FIXTYPE", 6.0);
    flier.fly(10.0);
    flier.arm();
}

/// Suite: CompassHealthArming. A compass that fails forbids arming, unless its check is left out.
#[test]
fn a_single_check_can_be_left_out() {
    let mut flier = with_instruments();
    flier.fly(10.0);
    flier.set("SIM_MAG1_FAIL", 1.0);
    flier.fly(3.0);
    assert_eq!(flier.obstacles(), ["PreArm: Compass 1 not healthy"]);
    let arming = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(flier.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, arming), FAILED);
    flier.set("ARMING_SKIPCHK", 4.0);
    assert!(flier.obstacles().is_empty());
    flier.arm();
}
