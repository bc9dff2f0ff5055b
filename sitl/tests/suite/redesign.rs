//! Parameters that change in flight: all of them, what is left out, and what a record makes of it.

use crate::common::recording::Recording;
use crate::common::requests::set_parameter_as;
use crate::common::{Bench, command_long, settings};
use mavlink::dialects::ardupilotmega::{MavCmd, MavMessage, MavParamType};
use quadrotor::{Mutability, PARAMETERS};
use vehicle::identity::Identity;
use vehicle::parameters::{Description, Value};

fn set(id: &str, value: Value) -> MavMessage {
    let (param_value, param_type) = match value {
        Value::Real(value) => (value, MavParamType::MAV_PARAM_TYPE_REAL32),
        Value::Integer(value) => {
            (f32::from_le_bytes(value.to_le_bytes()), MavParamType::MAV_PARAM_TYPE_INT32)
        }
    };
    set_parameter_as(id, param_value, param_type)
}

/// Other values than the present one, the likelier ones first.
fn others(present: Value, description: &Description) -> Vec<Value> {
    let within = |value: f64| value.clamp(description.range.minimum, description.range.maximum);
    let values: Vec<Value> = match present {
        Value::Real(_) if !description.names.is_empty() => {
            description.names.iter().map(|named| Value::Real(named.value as f32)).collect()
        }
        Value::Integer(_) if !description.names.is_empty() => {
            description.names.iter().map(|named| Value::Integer(named.value)).collect()
        }
        Value::Real(0.0) => [0.01, 0.001, 1e-5].map(|value| Value::Real(within(value) as f32)).into(),
        Value::Real(present) => [0.97, 0.99, 1.1, 2.0, 0.5]
            .map(|factor| Value::Real(within(f64::from(present) * factor) as f32))
            .into(),
        Value::Integer(present) => {
            [1, -1, 2, -2, 3, -3].map(|step| Value::Integer(within(f64::from(present + step)) as i32)).into()
        }
    };
    values.into_iter().filter(|value| *value != present).collect()
}

/// In hover each parameter of the table is set by its message, and put back. Only the system id waits for the next start, as the
/// metadata tell.
#[test]
fn every_parameter_changes_in_flight_unless_it_needs_a_restart() {
    let mut bench = Bench::hovering(Identity::Px4);
    let table = vehicle::parameters::ParameterTable::new(Identity::Px4);
    let place = bench.position();
    let present = |bench: &Bench, index: usize| bench.autopilot.parameters().nth(index).expect("there").1;
    let mut refused = Vec::new();
    // Pausing and hurrying is not for a bench.
    for (index, entry) in table.entries().iter().enumerate().filter(|(_, entry)| entry.id != "SIM_SPEEDUP") {
        let before = present(&bench, index);
        let description = entry.describe();
        let mut changes = others(before, &description).into_iter();
        bench.heard.clear();
        let accepted = changes.any(|value| {
            bench.send(set(entry.id, value));
            present(&bench, index) == value
        });
        assert_eq!(accepted, !description.read_only, "{}: {:?}", entry.id, bench.texts());
        if !accepted {
            refused.push((entry.id, bench.texts().swap_remove(0)));
        }
        bench.fly(0.1);
        bench.send(set(entry.id, before));
        assert_eq!(present(&bench, index), before, "{}: {:?}", entry.id, bench.texts());
        bench.fly(0.1);
        let apart = nalgebra::Vector3::from(bench.position()) - nalgebra::Vector3::from(place);
        assert!(apart.norm() < 0.1, "{}: {apart:?}", entry.id);
    }
    let told = [
        ("MAV_SYS_ID", "MAV_SYS_ID is read-only: restart with --system-id"),
        ("MPC_THR_HOVER", "MPC_THR_HOVER is calculated from mass and rotors (read-only); set those instead"),
    ];
    assert_eq!(refused, told.map(|(id, text)| (id, text.to_owned())));
}

/// Controllers, sample times and mass change in the middle of a cruise: replayed, it is the same flight.
#[test]
fn a_record_with_changes_of_structure_replays_bit_for_bit() {
    let mut vehicle = settings(Identity::Px4);
    vehicle.wind = vehicle::world::WindSettings { speed_m_s: 4.0, from_rad: 1.0, gusts_m_s: 1.0, seed: 5 };
    vehicle.configuration.airframe.drag_n_s_m = [0.15; 3];
    let mut recording = Recording::of(&vehicle);
    let arm = command_long(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], 0);
    let takeoff =
        command_long(MavCmd::MAV_CMD_NAV_TAKEOFF, [0.0, 0.0, 0.0, f32::NAN, f32::NAN, f32::NAN, 498.0], 0);
    let away = command_long(
        MavCmd::MAV_CMD_DO_REPOSITION,
        [-1.0, 1.0, 0.0, f32::NAN, 47.398_9, 8.545_594, 498.0],
        0,
    );
    let (mut before, mut after) = (0.0, 0.0);
    for millisecond in 0..22_000_u32 {
        match millisecond {
            1_000 => recording.send(arm.clone()),
            1_100 => recording.send(takeoff.clone()),
            12_000 => recording.send(away.clone()),
            16_003 => {
                before = recording.bench.velocity()[0];
                recording.send(set("CTRL_KIND", Value::Integer(2)));
                recording.send(set("ATT_SAMPLE_TIME", Value::Real(0.007)));
                recording.send(set("FRAME_MASS", Value::Real(0.6)));
            }
            18_000 => recording.send(set("POS_SAMPLE_TIME", Value::Real(0.04))),
            20_000 => after = recording.bench.velocity()[0],
            _ => {}
        }
        recording.step();
    }
    // It cruised before and went on.
    assert!(before > 3.0 && after > 3.0, "{before} and {after} m/s");
    let flown = recording.bench.autopilot.vehicle().simulation().configuration();
    assert_eq!((flown.controllers.attitude.sample_time_us, flown.airframe.mass_kg as f32), (7_000, 0.6));
    assert!(
        recording.bench.texts().iter().all(|text| !text.contains("; allowed") && !text.contains("cannot")),
        "{:?}",
        recording.bench.texts()
    );
    let record = recording.finish();
    record.assert_same();
    // The instant of a change belongs to the flight.
    let text = record.text();
    // The last of the three, because entries are in order.
    let line = text.lines().rfind(|line| line.starts_with("frame 16003")).expect("a frame at 16.003 s");
    let time = line.split(' ').nth(1).expect("a time");
    let later = line.replacen(time, &(time.parse::<u64>().expect("a time") + 20_000).to_string(), 1);
    record.assert_depends_on(line, &later);
}

/// The part of a page between two marks.
fn part<'a>(page: &'a str, mark: &str) -> &'a str {
    let (_, rest) = page.split_once(&format!("<!-- {mark} -->\n")).expect("the mark");
    rest.split_once("<!-- end -->").expect("its end").0
}

/// The page names each parameter that changes by a hand-over, and each that waits.
#[test]
fn the_documentation_lists_what_is_handed_over_and_what_waits() {
    let page = include_str!("../../../book/src/vehicle/parameters-in-flight.md");
    for (mark, mutability) in [("structural", Mutability::Structural), ("start", Mutability::Start)] {
        let named = PARAMETERS.iter().filter(|parameter| parameter.mutability == mutability);
        let rows = named.map(|parameter| format!("| `{}` | {} |\n", parameter.name, parameter.description));
        let mut meant = format!("| parameter | what it is |\n| --- | --- |\n{}", rows.collect::<String>());
        if mutability == Mutability::Start {
            meant.push_str("| `MAV_SYS_ID` (ArduPilot: `SYSID_THISMAV`) | System id, from `--system-id` |\n");
        }
        assert_eq!(part(page, mark), meant, "the part `{mark}` of the page should be:\n{meant}");
    }
}
