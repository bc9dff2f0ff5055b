//! What is answered to a parameter that is not there, cannot be changed or cannot have a value: PARAM_ERROR.

use crate::common;
use crate::common::Bench;
use crate::common::requests::{set_parameter, set_parameter_as};
use autopilot::codec::Message;
use mavlink::dialects::ardupilotmega::*;
use vehicle::identity::Identity;

fn errors(bench: &mut Bench, message: MavMessage) -> Vec<(String, i16, MavParamError)> {
    bench.heard.clear();
    bench.send(message);
    let error = |message: &Message| match message {
        Message::Typed(MavMessage::PARAM_ERROR(error)) => {
            assert_eq!((error.target_system, error.target_component), common::GROUND_STATION);
            Some((error.param_id.to_str().unwrap_or("?").to_owned(), error.param_index, error.error))
        }
        _ => None,
    };
    bench.heard.iter().filter_map(error).collect()
}

fn read(name: &str, param_index: i16) -> MavMessage {
    MavMessage::PARAM_REQUEST_READ(PARAM_REQUEST_READ_DATA {
        param_index,
        target_system: 1,
        target_component: 1,
        param_id: name.into(),
    })
}

#[test]
fn every_refusal_is_answered_with_its_reason() {
    use MavParamError as Error;
    for (identity, hover) in [(Identity::Px4, "MPC_THR_HOVER"), (Identity::ArduPilot, "MOT_THST_HOVER")] {
        let mut bench = Bench::new(identity);
        let count = bench.autopilot.parameters().count();
        let told = |name: &str, index, error| vec![(name.to_owned(), index, error)];
        let unknown = Error::MAV_PARAM_ERROR_DOES_NOT_EXIST;
        let range = Error::MAV_PARAM_ERROR_VALUE_OUT_OF_RANGE;
        assert_eq!(errors(&mut bench, read("NO_SUCH_NAME", -1)), told("NO_SUCH_NAME", -1, unknown));
        assert_eq!(errors(&mut bench, read("", count as i16)), told("", count as i16, unknown));
        assert_eq!(errors(&mut bench, read("", count as i16 - 1)), []);
        assert_eq!(errors(&mut bench, set_parameter("NO_SUCH_NAME", 1.0)), told("NO_SUCH_NAME", -1, unknown));
        // What has no meaning here is not kept, either: it would be a lie.
        assert_eq!(
            errors(&mut bench, set_parameter("SIM_FLOAT_EXCEPT", 1.0)),
            told("SIM_FLOAT_EXCEPT", -1, unknown)
        );
        for value in [-1.0, 1e9, f32::NAN, f32::INFINITY] {
            assert_eq!(
                errors(&mut bench, set_parameter("FRAME_MASS", value)),
                told("FRAME_MASS", -1, range),
                "{value}"
            );
        }
        assert_eq!(
            errors(&mut bench, set_parameter(hover, 0.9)),
            told(hover, -1, Error::MAV_PARAM_ERROR_READ_ONLY)
        );
        assert_eq!(errors(&mut bench, set_parameter("FRAME_MASS", 0.75)), []);
        assert_eq!(errors(&mut bench, read("FRAME_MASS", -1)), []);
    }
}

/// MAVSDK takes the first answer for that to its request: why it was refused comes before what the value still is.
#[test]
fn a_refusal_is_told_before_the_present_value() {
    for identity in [Identity::Px4, Identity::ArduPilot] {
        let mut bench = Bench::new(identity);
        bench.heard.clear();
        bench.send(set_parameter("FRAME_MASS", 99.0));
        let answers = bench.heard.iter().filter_map(|message| match message {
            Message::Typed(MavMessage::PARAM_ERROR(_)) => Some("why"),
            Message::Typed(MavMessage::PARAM_VALUE(_)) => Some("value"),
            _ => None,
        });
        assert_eq!(answers.collect::<Vec<_>>(), ["why", "value"], "{identity:?}");
    }
}

/// The bytes of an integer are no real number; ArduPilot converts what it is sent.
#[test]
fn an_integer_does_not_change_a_real_parameter_of_px4() {
    let integer = MavParamType::MAV_PARAM_TYPE_INT32;
    let mut bench = Bench::new(Identity::Px4);
    let mass = |bench: &Bench| bench.autopilot.vehicle().kept_configuration().airframe.mass_kg;
    let before = mass(&bench);
    let sent = set_parameter_as("FRAME_MASS", f32::from_bits(1), integer);
    let mismatch = MavParamError::MAV_PARAM_ERROR_TYPE_MISMATCH;
    assert_eq!(errors(&mut bench, sent), [("FRAME_MASS".to_owned(), -1, mismatch)]);
    assert_eq!(mass(&bench), before);
    assert!(bench.texts().contains(&"FRAME_MASS is a real number: set it as REAL32".to_owned()));
    let mut bench = Bench::new(Identity::ArduPilot);
    assert_eq!(errors(&mut bench, set_parameter_as("FRAME_MASS", 1.0, integer)), []);
    assert_eq!(mass(&bench), 1.0);
}
