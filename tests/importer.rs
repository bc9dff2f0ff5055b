//! Our FMU under our importer, a second master: from the archive to the last double of a flight.

use std::env::consts::{DLL_EXTENSION, DLL_PREFIX, DLL_SUFFIX};
use std::io::Write;
use std::path::Path;
use std::sync::mpsc;

use importer::description::Causality;
use importer::{Fmu, ImportError, Instance};
use quadrotor::{Configuration, Inputs, PositionReference, Simulation};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

const STEP_S: f64 = 0.01;

/// The platform's folder of the standard.
fn platform() -> &'static str {
    match (std::env::consts::OS, std::env::consts::ARCH) {
        ("linux", "x86_64") => "linux64",
        ("linux", "aarch64") => "aarch64-linux",
        ("windows", _) => "win64",
        _ => "darwin64",
    }
}

/// The closed loop as an FMU file, with a model identifier of its description's.
fn closed_loop(folder: &Path) -> std::path::PathBuf {
    let description = fmi::description::model_description::<fmu::ClosedLoop>();
    let test = std::env::current_exe().expect("a test knows where it is");
    let library = test.with_file_name(format!("{DLL_PREFIX}fmu{DLL_SUFFIX}"));
    let file = folder.join("LmpcQuadrotor.fmu");
    let mut archive = ZipWriter::new(std::fs::File::create(&file).expect("a file"));
    let library = std::fs::read(library).expect("the library that was built with this test");
    let binary = format!("binaries/{}/LmpcQuadrotor.{DLL_EXTENSION}", platform());
    for (name, content) in [("modelDescription.xml", description.as_bytes()), (&binary, &library)] {
        archive.start_file(name, SimpleFileOptions::default()).expect("an entry");
        archive.write_all(content).expect("its content");
    }
    archive.finish().expect("an archive");
    file
}

fn reference(fmu: &Fmu, name: &str) -> u32 {
    fmu.description().variable(name).unwrap_or_else(|| panic!("{name}")).reference
}

fn read(instance: &mut Instance, references: &[u32]) -> Vec<f64> {
    let mut values = vec![0.0; references.len()];
    instance.reals(references, &mut values).expect("outputs");
    values
}

#[test]
fn the_closed_loop_flies_bit_for_bit_as_the_engine() {
    let folder = tempfile::tempdir().expect("a folder");
    let fmu = Fmu::open(&closed_loop(folder.path())).expect("an FMU");
    assert_eq!(fmu.description().model_name, "LmpcQuadrotor");
    let outputs = ["position.x", "position.y", "position.z", "attitude.phi", "body_rate.q", "rotor.speed[1]"];
    let outputs = outputs.map(|name| reference(&fmu, name));
    let goal = ["reference.position.x", "reference.position.y", "reference.position.z"];
    let goal = goal.map(|name| reference(&fmu, name));
    let mut instance = fmu.instantiate("one", |_| {}).expect("an instance");
    instance.set_up(0.0, Some(10.0)).expect("set up");
    instance.enter_initialization().expect("initializing");
    instance.set_reals(&goal, &[1.0, -2.0, -3.0]).expect("inputs");
    instance.exit_initialization().expect("initialized");

    let inputs = Inputs { reference: PositionReference::goal([1.0, -2.0, -3.0], 0.0), ..Inputs::default() };
    let mut engine = Simulation::new(&Configuration::default(), &inputs).expect("an engine");
    for step in 0..500_u32 {
        instance.step(f64::from(step) * STEP_S, STEP_S).expect("a step");
        engine.advance_to(u64::from(step + 1) * 10_000, &inputs).expect("a step");
        let ours = engine.outputs();
        let expected = [
            ours.position_m.x,
            ours.position_m.y,
            ours.position_m.z,
            ours.attitude_rad.x,
            ours.body_rate_rad_s.y,
            ours.rotor_speed_rad_s[0],
        ];
        assert_eq!(read(&mut instance, &outputs), expected, "after step {step}");
    }
    instance.terminate().expect("the end");
}

#[test]
fn values_of_every_type_go_in_and_units_and_causalities_are_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let fmu = Fmu::open(&closed_loop(folder.path())).expect("an FMU");
    let mut instance = fmu.instantiate("one", |_| {}).expect("an instance");
    let (armed, kind) = (reference(&fmu, "armed"), reference(&fmu, "controller.kind"));
    instance.set_booleans(&[armed], &[false]).expect("a Boolean");
    instance.set_integers(&[kind], &[2]).expect("an enumeration");
    instance.set_up(0.0, None).expect("set up");
    instance.enter_initialization().expect("initializing");
    assert_eq!(instance.booleans(&[armed]), Ok(vec![false]));
    let mut read_kind = [0];
    instance.integers(&[kind], &mut read_kind).expect("an enumeration");
    assert_eq!(read_kind, [2]);
    let yaw = fmu.description().variable("reference.yaw").expect("a variable");
    assert_eq!(yaw.causality, Causality::Input);
    let volt = fmu.description().unit("V").expect("a unit");
    assert_eq!(volt.dimension.map(|dimension| dimension.0), Some([1, 2, -3, -1, 0, 0, 0]));
}

/// A refused value is an error of the call, its reason comes through the logger, and nothing more is called after it.
#[test]
fn an_error_is_told_with_its_message_and_ends_the_instance() {
    let folder = tempfile::tempdir().expect("a folder");
    let fmu = Fmu::open(&closed_loop(folder.path())).expect("an FMU");
    let (sender, messages) = mpsc::channel();
    let mut instance = fmu
        .instantiate("one", move |message| sender.send(message).expect("the test listens"))
        .expect("an instance");
    let mass = reference(&fmu, "airframe.mass");
    let error = instance.set_reals(&[mass], &[f64::NAN]).expect_err("no mass");
    assert_eq!(error.to_string(), "fmi2SetReal returned fmi2Error");
    let said: Vec<_> = messages.try_iter().collect();
    assert!(said.iter().any(|message| message.text.contains("airframe.mass")), "{said:?}");
    assert!(instance.set_up(0.0, None).is_err(), "nothing may follow an error");
}

#[test]
fn an_instance_of_another_guid_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = closed_loop(folder.path());
    let description = fmi::description::model_description::<fmu::ClosedLoop>();
    let guid = description.split("guid=\"").nth(1).and_then(|text| text.split('"').next()).expect("a GUID");
    let other = description.replace(guid, "{another}");
    let mut archive = zip::ZipArchive::new(std::fs::File::open(&file).expect("a file")).expect("an archive");
    let changed = folder.path().join("changed.fmu");
    let mut writer = ZipWriter::new(std::fs::File::create(&changed).expect("a file"));
    for index in 0..archive.len() {
        let entry = archive.by_index_raw(index).expect("an entry");
        if index > 0 {
            writer.raw_copy_file(entry).expect("a copy");
        }
    }
    writer.start_file("modelDescription.xml", SimpleFileOptions::default()).expect("an entry");
    writer.write_all(other.as_bytes()).expect("its content");
    writer.finish().expect("an archive");
    let fmu = Fmu::open(&changed).expect("an FMU");
    assert!(matches!(fmu.instantiate("one", |_| {}), Err(ImportError::Instantiate)));
}
