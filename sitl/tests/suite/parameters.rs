//! Parameters by every name, offline as in flight.

use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

use crate::common::Bench;
use crate::common::requests::{set_parameter, set_parameter_as};
use autopilot::Autopilot;
use autopilot::codec::Message;
use clap::Parser;
use mavlink::dialects::ardupilotmega::{
    MavMessage, MavParamType, PARAM_REQUEST_LIST_DATA, PARAM_REQUEST_READ_DATA, PARAM_VALUE_DATA,
};
use sitl::configuration::{Arguments, ListFormat, Settings, parameter_list};
use vehicle::identity::Identity;
use vehicle::parameters::{LOOP_NAMES, Value};

fn settings(line: &str) -> Result<Settings, String> {
    let words = std::iter::once("lmpc-sitl").chain(line.split_whitespace());
    let arguments = Arguments::try_parse_from(words).map_err(|error| error.to_string())?;
    Settings::resolve(&arguments).map_err(|failure| failure.to_string())
}

fn name_of(value: &PARAM_VALUE_DATA) -> String {
    value.param_id.to_str().unwrap_or("?").to_owned()
}

/// The answers to a request.
fn answers(bench: &mut Bench, message: MavMessage) -> Vec<PARAM_VALUE_DATA> {
    bench.heard.clear();
    bench.send(message);
    bench.parameters()
}

fn read(name: &str) -> MavMessage {
    MavMessage::PARAM_REQUEST_READ(PARAM_REQUEST_READ_DATA {
        param_index: -1,
        target_system: 1,
        target_component: 1,
        param_id: name.into(),
    })
}

/// Clients take an answer for theirs by the name that they have asked for; MAVSDK drops those without an index.
#[test]
fn former_names_are_answered_and_never_listed() {
    let mut bench = Bench::new(Identity::Px4);
    let list =
        MavMessage::PARAM_REQUEST_LIST(PARAM_REQUEST_LIST_DATA { target_system: 1, target_component: 1 });
    let mut listed = answers(&mut bench, list);
    listed.retain(|value| value.param_index != u16::MAX);
    for name in LOOP_NAMES {
        let of_list = listed.iter().find(|value| name_of(value) == name.id).expect(name.id);
        assert_eq!(answers(&mut bench, read(name.id)), std::slice::from_ref(of_list));
        let Some(former) = name.former else { continue };
        assert!(listed.iter().all(|value| name_of(value) != former), "{former}");
        let expected = PARAM_VALUE_DATA { param_id: former.into(), ..of_list.clone() };
        assert_eq!(answers(&mut bench, read(former)), [expected]);
    }
    // Whoever sets one hears its name; everyone hears the new one.
    for (former, present, value) in
        [("LIM_SPEED_H", "LIM_SPEED_HORIZ", 6.0), ("SNSR_BDY_RT_NS", "SENS_RATE_NOISE", 0.25)]
    {
        let heard = answers(&mut bench, set_parameter(former, value));
        let heard: Vec<_> = heard.iter().map(|told| (name_of(told), told.param_value)).collect();
        assert_eq!(heard, [(present.to_owned(), value), (former.to_owned(), value)]);
    }
    let heard = answers(&mut bench, set_parameter("LIM_TILT_A", -1.0));
    assert_eq!(heard.iter().map(name_of).collect::<Vec<_>>(), ["LIM_TILT_A"]);
    assert_eq!(bench.texts(), ["LIM_TILT_A = -1 rad/s^2; allowed 0.1 to 500 rad/s^2"]);
    answers(&mut bench, set_parameter("LIM_TILT", 45.0));
    assert_eq!(bench.texts(), ["LIM_TILT = 45 rad; allowed 0.05 to 1.2 rad (3 to 69 deg)"]);
    assert!(answers(&mut bench, set_parameter("FRAME_MAS", 1.0)).is_empty());
    assert_eq!(bench.texts(), ["unknown parameter FRAME_MAS; did you mean FRAME_MASS?"]);
    assert!(bench.heard.iter().all(|message| !matches!(message, Message::Typed(MavMessage::PARAM_VALUE(_)))));
}

/// The list before a flight is what the vehicle tells in it.
#[test]
fn the_list_offline_is_that_of_the_vehicle() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("vehicle.params");
    std::fs::write(&file, "1\t1\tAF_MASS\t0.800000011920928955\t9\n1\t1\tMAV_SYS_ID\t9\t6\n")
        .expect("written");
    let (file, own) = (file.display(), "--set controller.kind=dlqr --set limits.tilt=0.5");
    for (line, expected) in [
        (String::new(), vec![]),
        (
            format!("--parameters {file} {own}"),
            vec![("FRAME_MASS", "0.8"), ("CTRL_KIND", "3"), ("LIM_TILT", "0.5")],
        ),
        (
            "--autopilot ardupilot --system-id 7 --speed 4".to_owned(),
            vec![("SYSID_THISMAV", "7"), ("SIM_SPEEDUP", "4")],
        ),
        (
            "--wind 5 --set AF_DRAG_X=0.3 --kalman".to_owned(),
            vec![
                ("FRAME_DRAG_X", "0.3"),
                ("FRAME_DRAG_Y", "0.15"),
                ("SENS_KALMAN", "1"),
                ("SIM_WIND_SPD", "5"),
            ],
        ),
    ] {
        let settings = settings(&line).expect("valid");
        let own = &settings.vehicles[0];
        let autopilot =
            Autopilot::new(&own.vehicle, own.system_id, settings.speed, &[], 0).expect("it flies");
        let told: Vec<(String, Value)> =
            autopilot.parameters().map(|(name, value)| (name.to_owned(), value)).collect();
        let table = parameter_list(&settings, ListFormat::Table);
        let rows: Vec<Vec<&str>> =
            table.lines().skip(1).map(|line| line.split_whitespace().collect()).collect();
        let listed: Vec<_> = rows.iter().map(|row| (row[0].to_owned(), row[2].to_owned())).collect();
        let expected_rows: Vec<_> =
            told.iter().map(|(name, value)| (name.clone(), value.to_string())).collect();
        assert_eq!(listed, expected_rows, "{line}");
        for (name, value) in expected {
            assert!(listed.contains(&(name.to_owned(), value.to_owned())), "{line}: {name} = {value}");
        }
        let json: serde_json::Value =
            serde_json::from_str(&parameter_list(&settings, ListFormat::Json)).expect("JSON");
        let objects = json.as_array().expect("a list");
        assert_eq!(objects.len(), told.len());
        for (object, (name, value)) in objects.iter().zip(&told) {
            assert_eq!(object["name"], name.as_str());
            assert_eq!(object["system_id"], own.system_id, "{line}");
            assert_eq!(
                object["value"].as_f64().map(|value| value as f32),
                Some(value.number() as f32),
                "{name}"
            );
        }
    }
    let table = parameter_list(&settings("").expect("valid"), ListFormat::Table);
    let tilt = table.lines().find(|line| line.starts_with("LIM_TILT ")).expect("listed");
    let cells: Vec<&str> = tilt.split("  ").map(str::trim).filter(|cell| !cell.is_empty()).collect();
    assert_eq!(cells[..5], ["LIM_TILT", "limits.tilt", "0.6", "rad", "0.05–1.2"]);
    assert!(cells[5].starts_with("Largest angle"));
    let several = parameter_list(&settings("--vehicles 2").expect("valid"), ListFormat::Table);
    assert!(several.starts_with("System 1\nNAME") && several.contains("\n\nSystem 2\nNAME"), "{several}");
}

/// It needs no port, and a reader may leave: `| head`.
#[test]
fn the_list_is_printed_for_any_reader() {
    let mut program = Command::new(env!("CARGO_BIN_EXE_lmpc-sitl"));
    program.args(["--list-parameters", "--link", "serial:/dev/no-such-device"]);
    let mut child = program.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the program runs");
    let mut first = String::new();
    // The pipe ends here.
    BufReader::with_capacity(16, child.stdout.take().expect("piped")).read_line(&mut first).expect("a line");
    assert!(first.starts_with("NAME"), "{first}");
    let done = child.wait_with_output().expect("it ends");
    let told = String::from_utf8(done.stderr).expect("text");
    assert!(done.status.success() && told.is_empty(), "{told}");
}

#[test]
fn every_name_and_the_names_of_values_are_taken_at_the_start() {
    for name in LOOP_NAMES {
        let Some(former) = name.former else { continue };
        let list = parameter_list(&settings("").expect("valid"), ListFormat::Table);
        let row = list.lines().find(|line| line.split_whitespace().next() == Some(name.id)).expect(name.id);
        let value = row.split_whitespace().nth(2).expect("a value");
        settings(&format!("--set {former}={value} --set {}={value}", name.dotted)).expect(former);
    }
    for (line, kind) in [
        ("--set controller.kind=ssmpc", quadrotor::ControllerKind::StateSpaceMpc),
        ("--set CTRL_KIND=DLQR", quadrotor::ControllerKind::Dlqr),
        ("--set C_KIND=1", quadrotor::ControllerKind::Lmpc),
    ] {
        let settings = settings(line).expect(line);
        assert_eq!(settings.vehicles[0].vehicle.configuration.controllers.kind, kind, "{line}");
    }
}

/// What would lose the vehicle is refused with its cause, in flight and on the ground, and leaves it as it is; what flies badly
/// is warned about once. The models of the paper do not know that the rotors answer late; those that do are stable with any lag.
#[test]
fn a_value_that_would_lose_the_vehicle_is_refused_in_flight() {
    let mut bench = Bench::hovering(Identity::Px4);
    let before = answers(&mut bench, read("ROTOR_TIME_CONST"));
    // 2 is the paper's; integers travel as their bytes.
    let paper = set_parameter_as("CTRL_MODEL", f32::from_bits(2), MavParamType::MAV_PARAM_TYPE_INT32);
    answers(&mut bench, paper);
    bench.heard.clear();
    let heard = answers(&mut bench, set_parameter("ROTOR_TIME_CONST", 0.3));
    assert_eq!(heard.iter().map(|told| told.param_value).collect::<Vec<_>>(), [before[0].param_value]);
    let text = bench.texts().concat();
    assert!(text.starts_with("ROTOR_TIME_CONST: the north loop is unstable: errors double every"), "{text}");
    assert!(
        text.contains("airframe.rotor.time_constant = 0.3") && text.contains("stable with 0.03 s"),
        "{text}"
    );
    let text = {
        answers(&mut bench, set_parameter("FRAME_INERTIA_X", 1e-5));
        bench.texts().concat()
    };
    assert!(text.contains("airframe.inertia.x") && text.contains("must be at least"), "{text}");
    bench.fly(3.0);
    assert!(bench.is_near([0.0, 0.0, bench.position()[2]]), "{:?}", bench.position());

    // Accepted, and told why it is doubtful.
    answers(&mut bench, set_parameter("SENS_RATE_NOISE", 0.9));
    let text = bench.texts().concat();
    // The paper's models swing, and say so again where the noise is another.
    assert!(text.starts_with("SENS_RATE_NOISE: the north loop swings"), "{text}");
    assert!(text.contains("SENS_RATE_NOISE: measurement noise"), "{text}");
    bench.heard.clear();
    answers(&mut bench, set_parameter("LIM_SPEED_HORIZ", 5.0));
    assert_eq!(bench.texts(), Vec::<String>::new());
}

/// Settings of the command line and of a file are judged together, in any order; what does not fly names its place.
#[test]
fn settings_at_the_start_are_judged_as_a_whole() {
    let small = "--set airframe.inertia.x=0.002 --set airframe.inertia.y=0.002 --set airframe.inertia.z=0.004 \
                 --set controller.attitude.increment_weight.phi=8000 --set controller.attitude.increment_weight.theta=8000 \
                 --set controller.attitude.increment_weight.psi=200000";
    let resolved = settings(small).expect("together they fly");
    assert_eq!(resolved.vehicles[0].vehicle.configuration.airframe.inertia_kg_m2, [0.002, 0.002, 0.004]);

    settings("--set airframe.rotor.time_constant=0.3").expect("a lag that is in the model flies");
    let refused = settings("--set controller.model=paper --set airframe.rotor.time_constant=0.3");
    let refused = refused.expect_err("a lag that is not in the model");
    assert!(
        refused.starts_with("--set: airframe.rotor.time_constant: the north loop is unstable"),
        "{refused}"
    );

    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.params");
    std::fs::write(&path, "LIM_TILT 0.5\nFRAME_INERTIA_X 0.00001\n").expect("written");
    let refused = settings(&format!("--parameters {}", path.display())).expect_err("lost");
    assert!(refused.contains("a.params: line 2: FRAME_INERTIA_X: airframe.inertia.x"), "{refused}");
    assert!(refused.contains("must be at least"), "{refused}");

    let warned = settings("--set sensor.attitude_noise=0.3").expect("flies");
    assert!(warned.notes.iter().any(|note| note.text.contains("measurement noise")), "{:?}", warned.notes);
}
