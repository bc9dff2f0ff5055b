//! A short soak: what `cargo run --release -p sitl --example soak` does for an hour.

#[path = "../../examples/soak/run/mod.rs"]
mod run;

use crate::common;

#[test]
fn vehicles_hold_what_must_hold_under_clients_that_come_and_go() {
    let options = run::Options { vehicles: 5, end_us: 240_000_000, seed: 7, loss: 0.02 };
    let figures = run::run(&options);
    assert!(figures.violations.is_empty(), "{figures}");
    // It has done what it is for.
    assert!(figures.flights >= 3 && figures.clients >= 9 && figures.rests >= 3, "{figures}");
    assert!(figures.missions >= 1 && figures.uploads >= 2 && figures.downloads >= 2, "{figures}");
    assert!(figures.parameter_lists >= 3 && figures.parameters_set >= 3 && figures.lost > 1000, "{figures}");
}

/// The same seed is the same run.
#[test]
fn a_seed_repeats() {
    let run = |seed| {
        let figures = run::run(&run::Options { vehicles: 1, end_us: 60_000_000, seed, loss: 0.05 });
        (figures.sent, figures.received, figures.lost, figures.commands)
    };
    assert_eq!(run(3), run(3));
    assert_ne!(run(3), run(4));
}

/// A soak that finds nothing must be able to find something.
#[test]
fn what_goes_wrong_is_found() {
    let deaf = run::run(&run::Options { vehicles: 1, end_us: 40_000_000, seed: 1, loss: 1.0 });
    let found = |words: &str| deaf.violations.iter().any(|violation| violation.contains(words));
    assert!(found("was not answered in 10 times") && found("no heartbeat for six seconds"), "{deaf}");

    // A few pages more are none.
    let held = [10_100, 10_500, 10_520, 10_520, 10_460, 10_520, 10_550, 10_550, 10_550, 10_530];
    assert_eq!(run::leak(&held), None);
    let leaking: Vec<u64> = (1..=10).map(|tenth| 10_000 + 300 * tenth).collect();
    assert_eq!(run::leak(&leaking), Some("memory grew from 11800 to 13000 kB".to_owned()));

    // In gusts a vehicle does not stay within what it stays within in a calm.
    let mut figures = run::Figures::default();
    let mut gusty = common::settings(vehicle::identity::Identity::Px4);
    gusty.wind = vehicle::world::WindSettings { speed_m_s: 8.0, from_rad: 0.0, gusts_m_s: 3.0, seed: 1 };
    gusty.configuration.airframe.drag_n_s_m = [0.15; 3];
    let mut bench = common::Bench::of(&gusty);
    bench.arm();
    assert_eq!(
        bench.command(mavlink::dialects::ardupilotmega::MavCmd::MAV_CMD_NAV_TAKEOFF, [f32::NAN; 7]),
        0
    );
    let mut watch = run::Watch::default();
    for _ in 0..800 {
        bench.fly(0.05);
        watch.look(&bench.autopilot, run::Stays::Calm, &mut figures);
    }
    assert!(figures.violations.iter().any(|violation| violation.contains("drifted by")), "{figures}");
}
