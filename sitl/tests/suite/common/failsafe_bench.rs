//! Making things go wrong, and what the vehicle tells then.

use super::requests::{local_target, set_parameter_as};
use autopilot::codec::Message;
use mavlink::dialects::ardupilotmega::*;
use vehicle::identity::Identity;
use vehicle::parameters::{
    ARDUPILOT_PARAMETERS, ARDUPILOT_SURROUNDINGS, CONDUCT_PARAMETERS, ConductParameter, PX4_PARAMETERS,
    PX4_SURROUNDINGS, radio_parameters,
};
use vehicle::{Action, Cause, Conduct, Mode};

use super::{Bench, settings};

pub const TEMPORARILY_REJECTED: u8 = 1;

pub fn set(bench: &mut Bench, id: &str, value: f64) {
    let table = bench.autopilot.parameter_table();
    let integer = table.find(id).is_some_and(|known| known.describe().whole);
    let ardupilot = bench.autopilot.identity().is_ardupilot();
    // PX4's integers travel bytewise.
    let (param_value, param_type) = if integer && !ardupilot {
        (f32::from_bits(value as i32 as u32), MavParamType::MAV_PARAM_TYPE_INT32)
    } else {
        (value as f32, MavParamType::MAV_PARAM_TYPE_REAL32)
    };
    bench.heard.clear();
    bench.send(set_parameter_as(id, param_value, param_type));
    let now = bench.parameters().pop().expect("an answer").param_value;
    assert_eq!(now.to_bits(), param_value.to_bits(), "{id}: {:?}", bench.texts());
}

/// Those of both identities.
fn known_parameters() -> impl Iterator<Item = &'static ConductParameter> {
    let radio = radio_parameters(false).chain(radio_parameters(true));
    CONDUCT_PARAMETERS
        .iter()
        .chain(PX4_PARAMETERS)
        .chain(ARDUPILOT_PARAMETERS)
        .chain(PX4_SURROUNDINGS)
        .chain(ARDUPILOT_SURROUNDINGS)
        .chain(radio)
}

/// The parameter of a cause.
pub fn parameter(identity: Identity, cause: Cause) -> &'static str {
    match cause {
        Cause::GroundStationLost if identity.is_ardupilot() => "FS_GCS_ENABLE",
        Cause::Fence if identity.is_ardupilot() => "FENCE_ACTION",
        Cause::BatteryLow if identity.is_ardupilot() => "BATT_FS_LOW_ACT",
        Cause::BatteryCritical | Cause::BatteryEmergency if identity.is_ardupilot() => "BATT_FS_CRT_ACT",
        Cause::SetPointsLost => "COM_OBL_RC_ACT",
        Cause::PilotLost if identity.is_ardupilot() => "FS_THR_ENABLE",
        Cause::PilotLost => "NAV_RCL_ACT",
        Cause::GroundStationLost => "NAV_DLL_ACT",
        Cause::HighWind => "COM_WIND_MAX_ACT",
        Cause::Fence => "GF_ACTION",
        Cause::BatteryLow | Cause::BatteryCritical | Cause::BatteryEmergency => "COM_LOW_BAT_ACT",
        Cause::PositionLost if identity.is_ardupilot() => "FS_EKF_ACTION",
        Cause::PositionLost => "COM_POSCTL_NAVL",
        Cause::RotorFailure => "COM_ACT_FAIL_ACT",
    }
}

/// A vehicle that hovers 10 m up, in a wind if that is what is wrong.
pub fn hovering(cause: Cause) -> Bench {
    hovering_as(Identity::Px4, cause)
}

pub fn hovering_as(identity: Identity, cause: Cause) -> Bench {
    let mut start = settings(identity);
    if cause == Cause::HighWind {
        start.wind = vehicle::world::WindSettings { speed_m_s: 6.0, ..start.wind };
    }
    Bench::hovering_with(&start)
}

pub fn stand_still() -> MavMessage {
    local_target(0b1101_1111_1000, [0.0, 0.0, -10.0], [0.0; 3])
}

/// Drains the battery down to a share by making it smaller.
pub fn drain_to(bench: &mut Bench, share: f64) {
    // So much that the rest lasts for a while.
    bench
        .fly_until("some charge drawn", 300.0, |bench| bench.autopilot.vehicle().battery().drawn_ah() > 0.15);
    let drawn_mah = 1000.0 * bench.autopilot.vehicle().battery().drawn_ah();
    let capacity = if bench.autopilot.identity().is_ardupilot() { "BATT_CAPACITY" } else { "BAT1_CAPACITY" };
    set(bench, capacity, (drawn_mah / (1.0 - share)).max(10.0));
}

/// Makes something go wrong.
pub fn spoil(bench: &mut Bench, cause: Cause) {
    match cause {
        Cause::SetPointsLost => {
            bench.send(stand_still());
            assert_eq!(bench.set_mode(Mode::Offboard), 0);
            bench.fly(1.1);
        }
        Cause::GroundStationLost => lose_ground_station(bench),
        Cause::HighWind => set(bench, "COM_WIND_MAX", 3.0),
        Cause::BatteryLow => drain_to(bench, 0.12),
        Cause::BatteryCritical => drain_to(bench, 0.065),
        Cause::BatteryEmergency => drain_to(bench, 0.03),
        Cause::PositionLost => {
            inject(bench, FailureUnit::FAILURE_UNIT_SENSOR_GPS);
            // As long as its last position is believed.
            bench.fly(5.5);
        }
        Cause::Fence if bench.autopilot.identity().is_ardupilot() => {
            set(bench, "FENCE_ALT_MAX", 8.0);
            set(bench, "FENCE_ENABLE", 1.0);
        }
        Cause::Fence => set(bench, "GF_MAX_VER_DIST", 8.0),
        Cause::RotorFailure => inject(bench, FailureUnit::FAILURE_UNIT_SYSTEM_MOTOR),
        Cause::PilotLost => {
            bench.send(MavMessage::MANUAL_CONTROL(MANUAL_CONTROL_DATA {
                target: 1,
                z: 500,
                ..MANUAL_CONTROL_DATA::default()
            }));
            bench.fly(0.6);
        }
    }
}

/// Of all units of a kind, the first one.
pub fn inject(bench: &mut Bench, unit: FailureUnit) {
    break_unit(bench, unit, FailureType::FAILURE_TYPE_OFF);
}

pub fn break_unit(bench: &mut Bench, unit: FailureUnit, kind: FailureType) {
    let parameters = [unit as u32 as f32, kind as u32 as f32, 1.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_INJECT_FAILURE, parameters), 0);
}

pub fn lose_ground_station(bench: &mut Bench) {
    bench.autopilot.hear_ground_station(true);
    bench.autopilot.hear_ground_station(false);
}

/// The numbers that a cause's parameter takes, and what it does then.
pub fn choices(identity: Identity, cause: Cause) -> Vec<(u8, Action)> {
    let name = parameter(identity, cause);
    let parameter = known_parameters().find(|known| known.id == name).expect("there is one");
    let choice = |number: u8| {
        let mut conduct = Conduct::new(identity.is_ardupilot());
        (parameter.set)(&mut conduct, f64::from(number)).then(|| (number, conduct.failsafe.action(cause)))
    };
    let named = (parameter.names)();
    (0..=10)
        .filter(|number| named.iter().any(|name| name.value == i32::from(*number)))
        .filter_map(choice)
        .collect()
}

/// The state that the latest HEARTBEAT tells.
pub fn state(bench: &Bench) -> MavState {
    let told = bench.heard.iter().rev().find_map(|message| match message {
        Message::Typed(MavMessage::HEARTBEAT(beat)) => Some(beat.system_status),
        _ => None,
    });
    told.expect("a heartbeat")
}

/// What HEARTBEAT tells while something is done about a cause.
pub fn expected_state(cause: Cause, action: Action) -> MavState {
    match action {
        Action::None | Action::Warn => MavState::MAV_STATE_ACTIVE,
        Action::Disarm => MavState::MAV_STATE_STANDBY,
        Action::Terminate => MavState::MAV_STATE_FLIGHT_TERMINATION,
        _ if matches!(cause, Cause::RotorFailure | Cause::BatteryEmergency) => MavState::MAV_STATE_EMERGENCY,
        _ => MavState::MAV_STATE_CRITICAL,
    }
}
