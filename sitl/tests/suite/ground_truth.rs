//! What simulations tell of the true motion, and what the rotors do, in the messages of PX4 and ArduPilot.

use crate::common::Bench;
use autopilot::codec::Message;
use mavlink::dialects::ardupilotmega::*;
use vehicle::identity::Identity;

/// The messages of a kind that MAV_CMD_SET_MESSAGE_INTERVAL brings within a second at 20 Hz.
fn streamed<T>(bench: &mut Bench, id: u32, pick: impl Fn(&MavMessage) -> Option<T>) -> Vec<T> {
    let parameters = [id as f32, 50_000.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, parameters), 0);
    bench.heard.clear();
    bench.fly(1.0);
    let typed = bench.heard.iter().filter_map(|message| match message {
        Message::Typed(message) => pick(message),
        _ => None,
    });
    typed.collect()
}

/// As MAVSDK's `set_rate_ground_truth` asks for it: the truth, not the estimate, in the units of the message.
#[test]
fn px4s_ground_truth_is_the_true_motion() {
    let mut bench = Bench::hovering(Identity::Px4);
    let states = streamed(&mut bench, 115, |message| match message {
        MavMessage::HIL_STATE_QUATERNION(state) => Some(state.clone()),
        _ => None,
    });
    assert!((19..=21).contains(&states.len()), "{}", states.len());
    let vehicle = bench.autopilot.vehicle();
    let place = vehicle.frame().to_geodetic(&vehicle.truth().position_m);
    let state = states.last().expect("one");
    assert!((f64::from(state.lat) / 1e7 - place.latitude_deg).abs() < 1e-6);
    assert!((f64::from(state.lon) / 1e7 - place.longitude_deg).abs() < 1e-6);
    // Ten metres above Zurich's 488 m, in mm.
    assert!((f64::from(state.alt) / 1e3 - place.altitude_m).abs() < 0.05, "{}", state.alt);
    let norm: f32 = state.attitude_quaternion.iter().map(|part| part * part).sum();
    assert!((norm - 1.0).abs() < 1e-5);
    assert!(state.zacc.abs() < 20 && state.vz.abs() < 10, "{state:?}");
}

/// pymavlink's and autotest's `sim_location` read SIMSTATE; the group of attitudes brings it, as MAVProxy asks for groups.
#[test]
#[allow(deprecated)] // MAVProxy sends it.
fn ardupilots_simstate_comes_with_the_attitudes() {
    let mut bench = Bench::hovering(Identity::ArduPilot);
    bench.send(MavMessage::REQUEST_DATA_STREAM(REQUEST_DATA_STREAM_DATA {
        req_message_rate: 10,
        target_system: 1,
        target_component: 1,
        req_stream_id: MavDataStream::MAV_DATA_STREAM_EXTRA1,
        start_stop: 1,
    }));
    bench.heard.clear();
    bench.fly(1.0);
    let states: Vec<_> = bench
        .heard
        .iter()
        .filter_map(|message| match message {
            Message::Typed(MavMessage::SIMSTATE(state)) => Some(state.clone()),
            _ => None,
        })
        .collect();
    assert!((9..=11).contains(&states.len()), "{}", states.len());
    let place = {
        let vehicle = bench.autopilot.vehicle();
        vehicle.frame().to_geodetic(&vehicle.truth().position_m)
    };
    let state = states.last().expect("one");
    assert!((f64::from(state.lat) / 1e7 - place.latitude_deg).abs() < 1e-6, "{state:?}");
    assert!((f64::from(state.lng) / 1e7 - place.longitude_deg).abs() < 1e-6, "{state:?}");
    // The accelerometers of a hovering vehicle feel its weight, upwards.
    assert!((state.zacc + 9.81).abs() < 0.3, "{state:?}");
}

/// A hovering vehicle turns its four rotors alike, with the share of thrust that carries its weight.
#[test]
fn rotors_are_told_as_outputs_and_as_controls() {
    let mut bench = Bench::hovering(Identity::Px4);
    let status = streamed(&mut bench, 375, |message| match message {
        MavMessage::ACTUATOR_OUTPUT_STATUS(status) => Some(status.clone()),
        _ => None,
    });
    let status = status.last().expect("one");
    assert_eq!(status.active, 0b1111);
    let configuration = *bench.autopilot.vehicle().simulation().configuration();
    let hover =
        configuration.airframe.hover_rotor_speed_rad_s() / configuration.airframe.rotor_speed_max_rad_s;
    for share in &status.actuator[..4] {
        assert!((f64::from(*share) - hover).abs() < 0.02, "{share} {hover}");
    }
    assert!(status.actuator[4..].iter().all(|share| *share == 0.0));
    let controls = streamed(&mut bench, 140, |message| match message {
        MavMessage::ACTUATOR_CONTROL_TARGET(target) => Some(target.controls),
        _ => None,
    });
    let [roll, pitch, yaw, thrust, rest @ ..] = controls.last().copied().expect("one");
    assert!([roll, pitch, yaw].iter().all(|part| part.abs() < 0.01), "{roll} {pitch} {yaw}");
    assert!((f64::from(thrust) - hover * hover).abs() < 0.02, "{thrust} {hover}");
    assert_eq!(rest, [0.0; 4]);
}
