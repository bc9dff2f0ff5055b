//! Protocols over a channel that loses, duplicates and reorders, with the clients' retries, in simulation time.

use crate::common::requests::set_parameter;
use std::collections::BTreeMap;

use crate::common::Bench;
use crate::common::channel::Lossy;
use mavlink::dialects::ardupilotmega::{
    MavCmd, MavMessage, PARAM_REQUEST_LIST_DATA, PARAM_REQUEST_READ_DATA,
};
use vehicle::identity::Identity;

fn request(index: i16) -> MavMessage {
    let request = PARAM_REQUEST_READ_DATA {
        param_index: index,
        target_system: 1,
        target_component: 1,
        ..Default::default()
    };
    MavMessage::PARAM_REQUEST_READ(request)
}

#[test]
fn all_parameters_arrive_right() {
    for seed in 1..=5 {
        let mut lossy = Lossy::new(seed);
        let list = PARAM_REQUEST_LIST_DATA { target_system: 1, target_component: 1 };
        let expected: BTreeMap<u16, (String, u32)> = {
            let mut bench = Bench::new(Identity::Px4);
            bench.heard.clear();
            bench.send(MavMessage::PARAM_REQUEST_LIST(list.clone()));
            let mut all = BTreeMap::new();
            for value in bench.parameters().into_iter().filter(|value| value.param_index != u16::MAX) {
                all.insert(
                    value.param_index,
                    (value.param_id.to_str().unwrap().to_owned(), value.param_value.to_bits()),
                );
            }
            all
        };
        let mut got = BTreeMap::new();
        lossy.send(MavMessage::PARAM_REQUEST_LIST(list.clone()));
        // As clients do: after a silence, ask for what is missing by its index.
        let mut silent_ms = 0;
        while got.len() < expected.len() {
            assert!(lossy.now_ms < 60_000, "seed {seed}: {} of {}", got.len(), expected.len());
            let values = Lossy::parameters_of(lossy.step());
            silent_ms = if values.is_empty() { silent_ms + 1 } else { 0 };
            for value in values.into_iter().filter(|value| value.param_index != u16::MAX) {
                let name = value.param_id.to_str().unwrap().to_owned();
                got.insert(value.param_index, (name, value.param_value.to_bits()));
            }
            if silent_ms > 200 {
                silent_ms = 0;
                if got.is_empty() {
                    lossy.send(MavMessage::PARAM_REQUEST_LIST(list.clone()));
                }
                for index in expected.keys().filter(|index| !got.contains_key(index)) {
                    lossy.send(request(*index as i16));
                }
            }
        }
        assert_eq!(got, expected);
        assert!(lossy.down.lost > 0, "the channel was a good one");
    }
}

#[test]
fn a_parameter_is_set_and_read_back() {
    for seed in 10..=20 {
        let mut lossy = Lossy::new(seed);
        let set = set_parameter("LIM_SPEED_HORIZ", 3.25);
        let mut confirmed = false;
        for _ in 0..10 {
            lossy.send(set.clone());
            for _ in 0..300 {
                let values = Lossy::parameters_of(lossy.step());
                confirmed |= values.iter().any(|value| value.param_value == 3.25);
            }
            if confirmed {
                break;
            }
        }
        assert!(confirmed, "seed {seed}");
        let limits = lossy.bench.autopilot.vehicle().simulation().configuration().limits;
        assert_eq!(limits.speed_horizontal_m_s, 3.25);
    }
}

/// A whole flight by commands: each takes effect once, and the vehicle ends where it should.
#[test]
fn a_flight_by_commands_ends_as_it_should() {
    for seed in 30..=40 {
        let mut lossy = Lossy::new(seed);
        let arm = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        assert_eq!(lossy.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, arm), 0, "seed {seed}");
        assert_eq!(lossy.command(MavCmd::MAV_CMD_NAV_TAKEOFF, [f32::NAN; 7]), 0, "seed {seed}");
        for _ in 0..8_000 {
            lossy.step();
        }
        // Relative: a repetition that were carried out again would turn further.
        let turn = [45.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0];
        assert_eq!(lossy.command(MavCmd::MAV_CMD_CONDITION_YAW, turn), 0, "seed {seed}");
        for _ in 0..8_000 {
            lossy.step();
        }
        let yaw = lossy.bench.autopilot.vehicle().outputs().attitude_rad.z;
        assert!((yaw - core::f64::consts::FRAC_PI_4).abs() < 0.02, "seed {seed}: {yaw}");
        assert_eq!(lossy.command(MavCmd::MAV_CMD_NAV_LAND, [0.0; 7]), 0, "seed {seed}");
        for _ in 0..15_000 {
            lossy.step();
        }
        assert!(!lossy.bench.autopilot.vehicle().is_armed(), "seed {seed}");
        assert!(lossy.up.lost + lossy.down.lost > 0);
    }
}
