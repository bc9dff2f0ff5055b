//! Turning into the wind.

use super::flier::*;
use crate::common::settings;
use vehicle::identity::Identity;
use vehicle::plan::{PlanKind, command};

/// A pilot in a wind of 10 m/s from a direction, degrees, with a mission that stays where it takes off for a minute.
fn in_wind(from_deg: f64, parameters: &[(&str, f64)]) -> Flier {
    let mut start = settings(Identity::ArduPilot);
    let rows = [(command::NAV_TAKEOFF, 0.0, 0.0, 20.0), (command::NAV_LOITER_UNLIM, 0.0, 0.0, 20.0)];
    start.plans.set(PlanKind::Mission, mission(&start, &rows));
    vehicle::world::wind_drag::provide(&mut start.configuration);
    let mut flier = Flier::with(&start);
    flier.set_all(&[("SIM_WIND_SPD", 10.0), ("SIM_WIND_DIR", from_deg), ("WVANE_ENABLE", 1.0)]);
    flier.set_all(parameters);
    flier
}

/// Suite: Weathervane, GuidedWeatherVane.
#[test]
fn the_nose_turns_into_the_wind() {
    let mut flier = in_wind(100.0, &[("GUID_OPTIONS", 128.0), ("AUTO_OPTIONS", 131.0), ("WVANE_GAIN", 3.0)]);
    flier.change_mode(AUTO);
    flier.arm();
    flier.wait_text("Weathervane Active: nose in", 60.0);
    flier.wait("100 deg", 60.0, |flier| flier.heads(100.0, 8.0));
    flier.return_home();
    flier.take_off(15.0, GUIDED);
    flier.wait("100 deg", 100.0, |flier| flier.heads(100.0, 8.0));
    flier.set_all(&[("WVANE_GAIN", 1.0), ("SIM_WIND_DIR", 0.0)]);
    flier.wait("0 deg", 60.0, |flier| flier.heads(0.0, 5.0));
    flier.fly(10.0);
    assert!(flier.heads(0.0, 5.0), "{}", flier.heading_deg());
}
