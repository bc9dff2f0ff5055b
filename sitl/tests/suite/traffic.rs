//! Other aircraft: heard, told and avoided, with the numbers of ArduPilot's AVD_* and PX4's NAV_TRAFF_*.

use crate::common;
use crate::common::Bench;
use crate::common::failsafe_bench::set;
use crate::common::mission_flight::waypoint;
use crate::common::plan_client::{result, upload};
use autopilot::codec::Message;
use mavlink::dialects::ardupilotmega::*;
use vehicle::Mode;
use vehicle::identity::Identity;
use vehicle::plan::PlanKind;
use vehicle::surroundings::{ScriptedAircraft, Way};
use vehicle::world::LocalFrame;

/// An aircraft at a place, NED, m, that flies south, as ADSB_VEHICLE of a receiver.
fn adsb(bench: &Bench, position_m: [f64; 3], south_m_s: f64) -> MavMessage {
    let frame: &LocalFrame = bench.autopilot.vehicle().frame();
    let place = frame.to_geodetic(&position_m.into());
    MavMessage::ADSB_VEHICLE(ADSB_VEHICLE_DATA {
        ICAO_address: 37,
        lat: (place.latitude_deg * 1e7).round() as i32,
        lon: (place.longitude_deg * 1e7).round() as i32,
        altitude: (place.altitude_m * 1e3).round() as i32,
        heading: 18_000,
        hor_velocity: (south_m_s * 100.0) as u16,
        flags: AdsbFlags::from_bits_truncate(0x1f),
        callsign: (*b"bob\0\0\0\0\0\0").into(),
        ..ADSB_VEHICLE_DATA::default()
    })
}

fn told<T>(bench: &Bench, of: impl Fn(&MavMessage) -> Option<T>) -> Vec<T> {
    let typed = |message: &Message| match message {
        Message::Typed(message) => of(message),
        _ => None,
    };
    bench.heard.iter().filter_map(typed).collect()
}

fn collisions(bench: &Bench) -> Vec<COLLISION_DATA> {
    told(bench, |message| match message {
        MavMessage::COLLISION(collision) => Some(collision.clone()),
        _ => None,
    })
}

/// As ArduPilot's own test of ADSB_VEHICLE does it: a threat makes it return, and COLLISION tells why.
#[test]
fn ardupilot_returns_from_what_comes_too_near_and_resumes() {
    let mut bench = Bench::hovering(Identity::ArduPilot);
    for (name, value) in [("AVD_ENABLE", 1.0), ("AVD_F_ACTION", 5.0), ("AVD_F_RCVRY", 1.0)] {
        set(&mut bench, name, value);
    }
    bench.heard.clear();
    let far = adsb(&bench, [4000.0, 0.0, -10.0], 10.0);
    bench.send(far);
    bench.fly(1.0);
    assert!(collisions(&bench).is_empty() && bench.mode() == Mode::Offboard);
    let near = adsb(&bench, [80.0, 0.0, -10.0], 0.0);
    bench.send(near);
    bench.fly(0.5);
    assert_eq!(bench.mode(), Mode::Return);
    let [collision] = &collisions(&bench)[..] else { panic!("{:?}", collisions(&bench)) };
    assert_eq!(collision.id, 37);
    assert_eq!(collision.threat_level, MavCollisionThreatLevel::MAV_COLLISION_THREAT_LEVEL_HIGH);
    assert_eq!(collision.action, MavCollisionAction::MAV_COLLISION_ACTION_RTL);
    assert!((collision.horizontal_minimum_delta - 80.0).abs() < 1.0, "{collision:?}");
    let alert = bench.texts().into_iter().find(|text| text.starts_with("Traffic alert: bob, 80 m away, "));
    assert!(alert.is_some_and(|text| text.ends_with(": returning")), "{:?}", bench.texts());
    // Nothing is heard of it for five seconds, and two more pass.
    bench.fly(7.5);
    assert_eq!(bench.mode(), Mode::Offboard, "{:?}", bench.texts());
}

/// 300 m within 30 s are reported, and nothing is done by default (AVD_F_ACTION = 1).
#[test]
fn ardupilot_reports_what_may_come_near() {
    let mut bench = Bench::hovering(Identity::ArduPilot);
    set(&mut bench, "AVD_ENABLE", 1.0);
    bench.heard.clear();
    let message = adsb(&bench, [0.0, 200.0, -10.0], 0.0);
    bench.send(message);
    bench.fly(3.0);
    let levels: Vec<_> = collisions(&bench).into_iter().map(|collision| collision.threat_level).collect();
    assert_eq!(levels, [MavCollisionThreatLevel::MAV_COLLISION_THREAT_LEVEL_LOW; 3], "once a second");
    assert_eq!(bench.mode(), Mode::Offboard);
}

/// NAV_TRAFF_AVOID: 1 warns, 2 returns, 3 lands, 4 holds; an aircraft on the way to the vehicle within 60 s.
#[test]
fn px4_does_what_its_parameter_says() {
    for (value, mode) in [
        (0.0, Mode::Mission),
        (1.0, Mode::Mission),
        (2.0, Mode::Return),
        (3.0, Mode::Land),
        (4.0, Mode::Hold),
    ] {
        let mut settings = common::settings(Identity::Px4);
        let way = Way::Straight { from_m: [2400.0, 0.0, -10.0], velocity_m_s: [-20.0, 0.0, 0.0] };
        settings.surroundings.aircraft =
            vec![ScriptedAircraft { id: 0xabcdef, callsign: "HB-XYZ".to_owned(), category: 1, way }];
        let mut bench = Bench::hovering_with(&settings);
        set(&mut bench, "NAV_TRAFF_AVOID", value);
        let heard = upload(&mut bench, PlanKind::Mission, &[waypoint([600.0, 0.0, -10.0])]);
        assert_eq!(result(&heard), Some(0));
        assert_eq!(bench.set_mode(Mode::Mission), 0);
        bench.heard.clear();
        bench.fly(6.0);
        assert_eq!(bench.mode(), mode, "{value}: {:?}", bench.texts());
        let alerts =
            bench.texts().into_iter().filter(|text| text.starts_with("Traffic alert: HB-XYZ")).count();
        assert_eq!(alerts, usize::from(value > 0.0), "{value}: {:?}", bench.texts());
    }
}

/// What MAVSDK's transponder plugin reads.
#[test]
fn scripted_aircraft_are_told_to_clients_once_a_second() {
    let mut settings = common::settings(Identity::Px4);
    let way = Way::Straight { from_m: [9000.0, 100.0, -300.0], velocity_m_s: [0.0, 30.0, -2.0] };
    settings.surroundings.aircraft =
        vec![ScriptedAircraft { id: 0x123456, callsign: "TEST1".to_owned(), category: 3, way }];
    let mut bench = Bench::of(&settings);
    bench.heard.clear();
    bench.fly(10.05);
    let reports = told(&bench, |message| match message {
        MavMessage::ADSB_VEHICLE(report) => Some(report.clone()),
        _ => None,
    });
    assert!((9..=11).contains(&reports.len()), "{}", reports.len());
    let last = reports.last().expect("reports");
    assert_eq!(
        (last.ICAO_address, last.heading, last.hor_velocity, last.ver_velocity),
        (0x123456, 9000, 3000, 200)
    );
    assert_eq!(last.callsign.to_str().expect("a name"), "TEST1");
    assert!((f64::from(last.altitude) / 1e3 - (488.0 + 320.0)).abs() < 3.0, "{}", last.altitude);
}
