//! Knobs of the radio.

use super::flier::*;
use vehicle::identity::Identity;

/// Flies on with the knob of channel 6 at some pulses, µs, and sees that the speed over the ground becomes that which is expected, m/s.
fn check_speeds(flier: &mut Flier) {
    for (pulse, expected_m_s) in [(2000, 10.0), (1500, 5.1), (2000, 10.0), (1300, 3.1)] {
        flier.rc(6, pulse);
        flier.wait(&format!("{expected_m_s} m/s"), 60.0, |flier| {
            (flier.speed_m_s() - expected_m_s).abs() < 0.5
        });
        flier.fly(2.0);
        for _ in 0..5 {
            flier.fly(1.0);
            let speed_m_s = flier.speed_m_s();
            assert!((speed_m_s - expected_m_s).abs() < 0.5, "{pulse} us: {speed_m_s} m/s");
        }
    }
}

fn with_knob(flier: &mut Flier, target: f64) {
    flier.set_all(&[("RC6_OPTION", 219.0), ("TUNE", target), ("TUNE_MIN", 0.2), ("TUNE_MAX", 10.0)]);
    flier.rc(6, 2000);
    flier.reboot();
}

/// Suite: Ch6TuningWPSpeed.
#[test]
fn a_knob_sets_the_speed_of_a_mission() {
    let mut flier = with_mission(&[(22, 0.0, 0.0, 20.0), (16, 2000.0, 0.0, 20.0), (20, 0.0, 0.0, 0.0)]);
    with_knob(&mut flier, 61.0);
    flier.change_mode(AUTO);
    flier.arm();
    check_speeds(&mut flier);
}

/// Suite: Ch6TuningLoitMaxXYSpeed. The speed of missions, 8 m/s here, does not bound that of a pilot.
#[test]
fn a_knob_sets_the_speed_of_loiter() {
    let mut flier = Flier::with(&crate::common::settings(Identity::ArduPilot));
    with_knob(&mut flier, 60.0);
    flier.take_off(20.0, LOITER);
    flier.rc(2, 1000);
    check_speeds(&mut flier);
}

/// Suite: DualTuningChannels.
#[test]
fn two_knobs_change_two_parameters() {
    let mut flier = Flier::new();
    flier.set_all(&[
        ("RC6_OPTION", 219.0),
        ("RC6_MIN", 1100.0),
        ("RC6_MAX", 1200.0),
        ("TUNE", 60.0),
        ("TUNE_MIN", 0.25),
        ("TUNE_MAX", 10.0),
        ("RC7_OPTION", 220.0),
        ("TUNE2", 28.0),
        ("TUNE2_MIN", 100.0),
        ("TUNE2_MAX", 500.0),
    ]);
    flier.reboot();
    let value = |flier: &mut Flier, name: &str| {
        flier.fly(1.0);
        let mut parameters = flier.bench.autopilot.parameters();
        parameters.find(|(id, _)| *id == name).map(|(_, value)| value.number()).expect(name)
    };
    for (pulse, expected) in [(1100, 0.25), (1200, 10.0), (1100, 0.25), (1150, 5.125)] {
        flier.rc(6, pulse);
        assert!((value(&mut flier, "LOIT_SPEED_MS") - expected).abs() < 1e-5, "{pulse} us");
    }
    for (pulse, expected) in [(1000, 100.0), (2000, 500.0), (1500, 300.0)] {
        flier.rc(7, pulse);
        assert!((value(&mut flier, "PSC_NE_VEL_I") - expected).abs() < 1e-3, "{pulse} us");
        assert!((value(&mut flier, "LOIT_SPEED_MS") - 5.125).abs() < 1e-5);
    }
    // A knob that rests leaves what a ground station sets.
    flier.set("LOIT_SPEED_MS", 3.0);
    assert!((value(&mut flier, "LOIT_SPEED_MS") - 3.0).abs() < 1e-6);
    assert!(!flier.has_said("Tuning knob") && !flier.has_said("RC switch function"));
}
