//! `--mission` says what was read, and `--autostart` flies it.

use crate::common::{Bench, settings};
use nalgebra::Vector3;
use vehicle::VehicleSettings;
use vehicle::estimation::{SensorModel, SensorSettings};
use vehicle::identity::Identity;
use vehicle::plan::{Site, file};
use vehicle::world::LocalFrame;

/// Up to 3 m, 5 m north, and down.
const PLAN: &str = "QGC WPL 110\n\
    0\t0\t0\t16\t0\t0\t0\t0\t47.397742\t8.545594\t488\t1\n\
    1\t0\t3\t22\t0\t0\t0\t0\t47.397742\t8.545594\t3\t1\n\
    2\t0\t3\t16\t0\t0\t0\t0\t47.397787\t8.545594\t3\t1\n\
    3\t0\t3\t21\t0\t0\t0\t0\t47.397787\t8.545594\t0\t1\n";

fn with_plan(identity: Identity, autostart: bool) -> VehicleSettings {
    let mut settings = settings(identity);
    let site = Site {
        identity,
        frame: LocalFrame::new(settings.origin),
        home_m: Vector3::zeros(),
        terrain: vehicle::surroundings::Terrain::default(),
    };
    settings.plans = file::parse(PLAN, &site).expect("a plan");
    settings.autostart = autostart;
    settings
}

#[test]
fn a_plan_is_announced_and_waits_for_the_pilot() {
    for (identity, mode) in [(Identity::Px4, "Mission"), (Identity::ArduPilot, "Auto")] {
        let mut bench = Bench::of(&with_plan(identity, false));
        bench.fly(5.0);
        let told = format!("Mission: 3 items; arm in {mode} mode to start");
        assert!(bench.texts().contains(&told), "{:?}", bench.texts());
        assert!(!bench.autopilot.vehicle().is_armed());
    }
}

#[test]
fn a_mission_starts_by_itself_and_ends_disarmed() {
    for identity in [Identity::Px4, Identity::ArduPilot] {
        for model in [SensorModel::Ideal, SensorModel::Realistic] {
            let sensors = SensorSettings { model, seed: 1 };
            let mut bench = Bench::of(&VehicleSettings { sensors, ..with_plan(identity, true) });
            bench.fly(40.0);
            let texts = bench.texts();
            assert!(texts.iter().any(|text| text == "Mission: 3 items; starting when ready"), "{texts:?}");
            assert!(texts.iter().any(|text| text == "Mission complete"), "{identity:?} {model:?} {texts:?}");
            assert!(!bench.autopilot.vehicle().is_armed(), "{texts:?}");
            let at = bench.position();
            assert!((at[0] - 5.0).abs() < 1.0 && at[1].abs() < 1.0, "{at:?}");
        }
    }
}

/// What speaks against arming is told in a log that would otherwise end with "starting when ready".
#[test]
fn what_keeps_a_mission_from_starting_is_told_now_and_then() {
    for identity in [Identity::Px4, Identity::ArduPilot] {
        let mut start = with_plan(identity, true);
        start.sensors = SensorSettings { model: SensorModel::Realistic, seed: 1 };
        start.faults = vec!["0:gps=off".parse().expect("a fault")];
        let mut bench = Bench::of(&start);
        bench.fly(30.0);
        let told: Vec<String> =
            bench.texts().into_iter().filter(|text| text.starts_with("Mission not started: ")).collect();
        assert!((5..=8).contains(&told.len()), "{identity:?} {:?}", bench.texts());
        assert!(told.iter().all(|text| text.contains("GPS")), "{told:?}");
        assert!(!bench.autopilot.vehicle().is_armed());
    }
}
