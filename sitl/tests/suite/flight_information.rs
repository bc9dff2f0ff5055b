//! What FLIGHT_INFORMATION, WIND and WIND_COV tell, and where home is when a command names no place.

#![allow(deprecated)] // Clients still use what the dialect calls deprecated.

use crate::common::{self, Bench};
use autopilot::codec::Message;
use mavlink::dialects::ardupilotmega::*;
use vehicle::identity::Identity;

/// What a choice takes of the latest message that answers a request.
fn requested<T>(bench: &mut Bench, id: u32, choose: impl Fn(&MavMessage) -> Option<T>) -> T {
    let parameters = [id as f32, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_REQUEST_MESSAGE, parameters), 0, "{id}");
    let typed = |message: &Message| match message {
        Message::Typed(message) => choose(message),
        _ => None,
    };
    bench.heard.iter().rev().find_map(typed).unwrap_or_else(|| panic!("no message {id}"))
}

fn flight(bench: &mut Bench) -> FLIGHT_INFORMATION_DATA {
    requested(bench, 264, |message| match message {
        MavMessage::FLIGHT_INFORMATION(flight) => Some(flight.clone()),
        _ => None,
    })
}

/// The protocol: times since the boot, zero until they happen, and the number of the flight.
#[test]
fn a_flight_has_a_number_and_times_since_the_boot() {
    for identity in [Identity::Px4, Identity::ArduPilot] {
        let mut bench = Bench::of(&common::settings(identity));
        let before = flight(&mut bench);
        let times = (before.arming_time_utc, before.takeoff_time_utc, before.landing_time);
        assert_eq!((times, before.flight_uuid), ((0, 0, 0), 0), "{identity:?}");
        if identity == Identity::ArduPilot {
            assert_eq!(bench.set_mode(vehicle::Mode::Offboard), 0);
        }
        bench.arm();
        let armed_us = bench.autopilot.vehicle().time_us();
        let height_m = if identity == Identity::ArduPilot { 3.0 } else { f32::NAN };
        bench.command(MavCmd::MAV_CMD_NAV_TAKEOFF, [0.0, 0.0, 0.0, f32::NAN, f32::NAN, f32::NAN, height_m]);
        bench.fly(6.0);
        let flying = flight(&mut bench);
        assert_eq!((flying.flight_uuid, flying.landing_time), (1, 0), "{identity:?}");
        assert!(flying.arming_time_utc.abs_diff(armed_us) < 100_000, "{flying:?}");
        assert!(flying.takeoff_time_utc > flying.arming_time_utc, "{flying:?}");
        bench.command(MavCmd::MAV_CMD_NAV_LAND, [0.0; 7]);
        bench.fly(20.0);
        let landed = flight(&mut bench);
        assert!(u64::from(landed.landing_time) * 1_000 > landed.takeoff_time_utc, "{landed:?}");
    }
}

/// PX4 tells where the air moves to, ArduPilot where it comes from.
#[test]
fn the_wind_is_told() {
    for identity in [Identity::Px4, Identity::ArduPilot] {
        let mut settings = common::settings(identity);
        // 3 m/s from the west.
        (settings.wind.speed_m_s, settings.wind.from_rad) = (3.0, 270_f64.to_radians());
        let mut bench = Bench::of(&settings);
        bench.fly(0.1);
        if identity == Identity::ArduPilot {
            let wind = requested(&mut bench, 168, |message| match message {
                MavMessage::WIND(wind) => Some(wind.clone()),
                _ => None,
            });
            assert!((wind.direction - 270.0).abs() < 0.1 && (wind.speed - 3.0).abs() < 0.1, "{wind:?}");
        } else {
            let wind = requested(&mut bench, 231, |message| match message {
                MavMessage::WIND_COV(wind) => Some(wind.clone()),
                _ => None,
            });
            assert!(wind.wind_x.abs() < 0.1 && (wind.wind_y - 3.0).abs() < 0.1, "{wind:?}");
        }
    }
}

/// ArduPilot takes zeros for the present place, as its own suite does; for PX4 they are a place, too far away.
#[test]
fn home_without_a_place_is_here_with_ardupilot() {
    for (identity, result) in [(Identity::ArduPilot, 0), (Identity::Px4, 2)] {
        let mut bench = Bench::of(&common::settings(identity));
        assert_eq!(bench.command(MavCmd::MAV_CMD_DO_SET_HOME, [0.0; 7]), result, "{:?}", bench.texts());
    }
}

/// ArduPilot's old message moves home; PX4 does not know it.
#[test]
fn home_is_moved_by_its_old_message_with_ardupilot() {
    for (identity, moved_m) in [(Identity::ArduPilot, 5.0), (Identity::Px4, 0.0)] {
        let mut bench = Bench::of(&common::settings(identity));
        let origin = bench.autopilot.vehicle().frame().origin();
        bench.send(MavMessage::SET_HOME_POSITION(SET_HOME_POSITION_DATA {
            latitude: (origin.latitude_deg * 1e7).round() as i32,
            longitude: (origin.longitude_deg * 1e7).round() as i32,
            altitude: ((origin.altitude_m + 5.0) * 1e3).round() as i32,
            target_system: 1,
            ..SET_HOME_POSITION_DATA::default()
        }));
        bench.fly(0.01);
        let home_m = bench.autopilot.vehicle().home().position_m;
        assert!((home_m.z + moved_m).abs() < 1e-3 && home_m.xy().norm() < 0.02, "{identity:?}: {home_m}");
    }
}
