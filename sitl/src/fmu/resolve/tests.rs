use importer::StartValue;
use importer::description::ModelDescription;
use quadrotor::{AirframePreset, Configuration};
use vehicle::foreign::ForeignRole;

use super::{Map, Mapping, input, output};
use crate::fmu::listing;

/// A variable: name, causality and type with unit.
type Row<'a> = (&'a str, &'a str, &'a str);

/// The description of a model with these variables, whose units are defined by hand.
fn model(rows: &[Row<'_>]) -> ModelDescription {
    let variables: String = (0..)
        .zip(rows)
        .map(|(reference, (name, causality, kind))| {
            let variability = if *causality == "parameter" { " variability=\"fixed\"" } else { "" };
            format!(
                "<ScalarVariable name=\"{name}\" valueReference=\"{reference}\" causality=\"{causality}\"{variability}><{kind}/>\
                 </ScalarVariable>"
            )
        })
        .collect();
    let text = format!(
        "<fmiModelDescription fmiVersion=\"2.0\" modelName=\"Model\" guid=\"g\"><CoSimulation modelIdentifier=\"m\"/>\
         <UnitDefinitions><Unit name=\"degree\"><BaseUnit rad=\"1\" factor=\"0.017453292519943295\"/></Unit>\
         <Unit name=\"kilometre\"><BaseUnit m=\"1\" factor=\"1000\"/></Unit><Unit name=\"odd\"/></UnitDefinitions>\
         <TypeDefinitions><SimpleType name=\"Actuation\"><Enumeration><Item name=\"rotor_speeds\" value=\"1\"/>\
         <Item name=\"wrench\" value=\"2\"/></Enumeration></SimpleType></TypeDefinitions>\
         <ModelVariables>{variables}</ModelVariables></fmiModelDescription>"
    );
    ModelDescription::parse(&text).expect("a description")
}

const METRE: &str = "Real unit=\"m\"";
const PLAIN: &str = "Real";

fn plant() -> Vec<Row<'static>> {
    let inputs = ["thrust", "torque.x", "torque.y", "torque.z"].map(|name| (name, "input", PLAIN));
    let positions = ["position.x", "position.y", "position.z"].map(|name| (name, "output", METRE));
    let rest = ["velocity.x", "velocity.y", "velocity.z", "body_rate.p", "body_rate.q", "body_rate.r"];
    let angles = ["attitude.phi", "attitude.theta", "attitude.psi"];
    let angles = angles.map(|name| (name, "output", "Real unit=\"degree\""));
    inputs
        .into_iter()
        .chain(positions)
        .chain(rest.map(|name| (name, "output", PLAIN)))
        .chain(angles)
        .collect()
}

fn resolve(map: &str, rows: &[Row<'_>]) -> Result<Mapping, String> {
    Mapping::new(&Map::parse(map).expect("a map"), &model(rows), &Configuration::default())
}

#[test]
fn our_names_are_found_with_their_units() {
    let mapping = resolve("", &plant()).expect("a mapping");
    assert_eq!(mapping.role, ForeignRole::Plant);
    assert_eq!((mapping.inputs.len(), mapping.outputs.len()), (4, 12));
    let angle = mapping.outputs.iter().find(|channel| channel.variable.0 == "attitude.psi").expect("heading");
    assert!((angle.conversion.ours(180.0) - std::f64::consts::PI).abs() < 1e-12);
    let text = listing(&mapping);
    assert!(text.contains("flies as the plant") && text.contains("degree"), "{text}");
}

/// A plant that takes both is driven by rotor speeds, unless the map names thrust and torques; rotors that it shows then are none.
#[test]
fn rotors_go_before_thrust_and_torques_unless_the_map_names_those() {
    let rotors = ["rotor.command[1]", "rotor.command[2]", "rotor.command[3]", "rotor.command[4]"];
    let speeds = ["rotor.speed[1]", "rotor.speed[2]", "rotor.speed[3]", "rotor.speed[4]"];
    let rows: Vec<Row<'_>> = plant()
        .into_iter()
        .chain(rotors.map(|name| (name, "input", PLAIN)))
        .chain(speeds.map(|name| (name, "output", PLAIN)))
        .collect();
    let by_rotors = resolve("", &rows).expect("a mapping");
    assert!(by_rotors.takes(input::ROTOR_COMMAND) && !by_rotors.takes(input::THRUST));
    assert!(by_rotors.shows(output::ROTOR_SPEED));
    let by_wrench = resolve("[variables]\nthrust = \"thrust\"\n", &rows).expect("a mapping");
    assert!(!by_wrench.takes(input::ROTOR_COMMAND) && by_wrench.takes(input::TORQUE));
    assert!(!by_wrench.shows(output::ROTOR_SPEED));
    let both = "[variables]\nthrust = \"thrust\"\nrotor.command.1 = \"rotor.command[1]\"\n";
    assert!(resolve(both, &rows).expect_err("both").contains("driven by one of the two"));
}

#[test]
fn other_names_units_and_constants_come_from_the_map() {
    let rows = plant();
    let renamed: Vec<Row<'_>> = rows
        .into_iter()
        .filter(|(name, ..)| !name.starts_with("body_rate"))
        .map(|(name, causality, kind)| match name {
            "position.z" => ("height", "local", "Real unit=\"kilometre\""),
            "thrust" => ("F", causality, "Real unit=\"odd\""),
            _ => (name, causality, kind),
        })
        .collect();
    let map = "[variables]\nposition.z = { variable = \"height\", factor = -1 }\n\
               thrust = { variable = \"F\", unit = \"N\" }\nbody_rate = { p = 0.0, q = 0.0, r = 0 }\n";
    let mapping = resolve(map, &renamed).expect("a mapping");
    let down = mapping.outputs.iter().find(|channel| channel.variable.0 == "height").expect("down");
    assert_eq!(down.conversion.ours(0.01), -10.0);
    assert_eq!(mapping.constants.len(), 3);
    let without = map.replace(", unit = \"N\"", "");
    let error = resolve(&without, &renamed).expect_err("no unit");
    assert!(
        error.contains("thrust: the FMU does not define the unit `odd` of the variable `F`; say which one it is: thrust = {")
            && error.ends_with("allowed are N"),
        "{error}"
    );
}

#[test]
fn mistakes_are_named_with_their_remedy() {
    let without =
        |gone: &str| plant().into_iter().filter(|(name, ..)| !name.starts_with(gone)).collect::<Vec<_>>();
    let with = |row: Row<'static>| plant().into_iter().chain([row]).collect::<Vec<_>>();
    for (map, rows, expected) in [
        ("", without("position"), "no output for position.x, position.y, position.z (place of the vehicle"),
        (
            "",
            without("attitude"),
            "no output for quaternion.w, quaternion.x, quaternion.y, quaternion.z (attitude: body into world",
        ),
        (
            "",
            without("velocity"),
            "no output for velocity.x, velocity.y, velocity.z (velocity along the world's axes; or body_velocity",
        ),
        ("", without("thrust"), "no inputs to fly it by: a closed loop has reference.position.x to .z"),
        ("role = \"closed-loop\"", plant(), "a closed loop needs the inputs reference.position.x to .z"),
        (
            "[variables]\nposition.x = \"positon.x\"",
            plant(),
            "the FMU has no variable `positon.x`; did you mean `position.x`?",
        ),
        (
            "[variables]\nposition.x = \"thrust\"",
            plant(),
            "`thrust` is of causality input; it must be an output",
        ),
        (
            "[variables]\nposition.x = \"on\"",
            with(("on", "output", "Boolean")),
            "`on` has the type Boolean; it must be Real",
        ),
        (
            "[variables]\nvelocity.x = \"position.x\"",
            plant(),
            "`position.x` has the unit `m`; it must be one that converts into m/s",
        ),
        (
            "[variables]\nposition.x = { variable = \"position.x\", unit = \"furlong\" }",
            plant(),
            "position.x: the map gives `position.x` the unknown unit `furlong`; allowed are m, cm, mm, ft, kilometre",
        ),
        (
            "[variables]\ntorque.y = \"torque.x\"",
            plant(),
            "torque.x and torque.y are both mapped to the variable `torque.x`; give each its own input",
        ),
        (
            "[variables]\nvelocity.y = \"velocity.x\"",
            plant(),
            "velocity.x and velocity.y are both mapped to the variable `velocity.x`; give each its own output",
        ),
        (
            "[variables]\nacceleration.x = \"velocity.x\"",
            plant(),
            "acceleration.y is missing; the other variables of acceleration",
        ),
        (
            "[variables]\narmed = \"thrust\"",
            plant(),
            "armed: the variable `thrust` is a Real input; it must be a Boolean input",
        ),
        (
            "[variables]\nposition.x = \"banana\"",
            plant(),
            "position.x: the FMU has no variable `banana`; it has thrust, torque.x, torque.y, torque.z, position.x",
        ),
        (
            "[variables]\nairframe.mass = \"gain\"\nairframe.arm_length = \"gain\"",
            with(("gain", "parameter", PLAIN)),
            "the variable `gain` is mapped to two of our parameters, which want 0.7 and 0.275 of it",
        ),
        ("[variables]\nthrust = 3.0", plant(), "thrust is an input; it has no constant value"),
        ("[variables]\nairframe.mass = \"m\"", plant(), "airframe.mass: the FMU has no variable `m`"),
        ("[variables]\nairframe.mass = \"position.x\"", plant(), "only parameters and inputs can be set"),
        (
            "[variables]\nairframe.mass = { variable = \"gain\", unit = \"stone\" }",
            with(("gain", "parameter", PLAIN)),
            "airframe.mass: the map gives `gain` the unknown unit `stone`; allowed are kg, g",
        ),
        (
            "[variables]\nairframe.mass = { variable = \"gain\", unit = \"ft\" }",
            with(("gain", "parameter", PLAIN)),
            "airframe.mass: the variable `gain` has the unit `ft`; it must be one that converts into kg: kg, g",
        ),
        (
            "[variables]\nenvironment.ground_plane = { variable = \"on\", factor = 2 }",
            with(("on", "parameter", "Boolean")),
            "only Real variables have a factor, an offset or a unit",
        ),
        (
            "[parameters]\nactuation = 3",
            with(("actuation", "parameter", "Enumeration declaredType=\"Actuation\"")),
            "[parameters] actuation: there is no item with the number 3; allowed are rotor_speeds (1), wrench (2)",
        ),
        (
            "[parameters]\ngain = true",
            with(("gain", "parameter", PLAIN)),
            "[parameters] gain: the variable has the type Real, which this value does not fit; give a number",
        ),
        (
            "[parameters]\ngin = 1",
            with(("gain", "parameter", PLAIN)),
            "[parameters]: the FMU has no variable `gin`; did you mean `gain`?",
        ),
    ] {
        let error = resolve(map, &rows).expect_err(map);
        assert!(error.contains(expected) && !error.contains('\n'), "{map}: {error}");
    }
}

#[test]
fn parameters_with_our_names_get_the_vehicles_values() {
    let rows: Vec<Row<'_>> = plant()
        .into_iter()
        .chain([
            ("airframe.mass", "parameter", PLAIN),
            ("initial.position.x", "parameter", "Real unit=\"kilometre\""),
            ("environment.ground_plane", "parameter", "Boolean"),
            ("airframe.preset", "parameter", "Enumeration"),
            ("m2", "parameter", PLAIN),
        ])
        .collect();
    let mut configuration =
        Configuration::for_airframe(&AirframePreset::Iris.airframe()).expect("an airframe that flies");
    configuration.initial.position_m = [500.0, 0.0, 0.0];
    let map = Map::parse("[variables]\nairframe.drag.x = \"m2\"\n[parameters]\nairframe.mass = 1.25\n")
        .expect("a map");
    let mapping = Mapping::new(&map, &model(&rows), &configuration).expect("a mapping");
    let value =
        |name: &str| mapping.values.iter().find(|(known, ..)| known == name).map(|(.., value)| value.clone());
    assert_eq!(value("airframe.mass"), Some(StartValue::Real(1.25)), "[parameters] go first");
    assert_eq!(value("initial.position.x"), Some(StartValue::Real(0.5)));
    assert_eq!(value("environment.ground_plane"), Some(StartValue::Boolean(false)));
    assert_eq!(value("m2"), Some(StartValue::Real(configuration.airframe.drag_n_s_m[0])));
    let number = AirframePreset::ALL.iter().position(|preset| *preset == AirframePreset::Iris);
    let number = i32::try_from(number.expect("a preset") + 1).expect("a number");
    assert_eq!(value("airframe.preset"), Some(StartValue::Integer(number)));
}

/// A plant that can be driven in two ways is told which one, unless the map says it.
#[test]
fn a_plant_is_told_what_drives_it() {
    let rotors = ["rotor.command[1]", "rotor.command[2]", "rotor.command[3]", "rotor.command[4]"];
    let choice = "Enumeration declaredType=\"Actuation\"";
    let rows: Vec<Row<'_>> = plant()
        .into_iter()
        .chain(rotors.map(|name| (name, "input", PLAIN)))
        .chain([("actuation", "parameter", choice)])
        .collect();
    let told = |map: &str| {
        let mapping = resolve(map, &rows).expect("a mapping");
        mapping.values.into_iter().find(|(name, ..)| name == "actuation").map(|(.., value)| value)
    };
    assert_eq!(told(""), Some(StartValue::Integer(1)));
    assert_eq!(told("[variables]\nthrust = \"thrust\"\n"), Some(StartValue::Integer(2)));
    let contrary = "[variables]\nthrust = \"thrust\"\n[parameters]\nactuation = \"rotor_speeds\"\n";
    assert_eq!(told(contrary), Some(StartValue::Integer(1)));
}

/// A parameter is written in the unit of its variable, which the map may say; a text has another reference than a number of the same
/// number.
#[test]
fn parameters_are_converted_as_the_map_says() {
    let rows: Vec<Row<'_>> = plant()
        .into_iter()
        .chain([("m", "parameter", PLAIN), ("arm", "parameter", METRE), ("note", "parameter", "String")])
        .collect();
    let map = "[variables]\nairframe.mass = { variable = \"m\", unit = \"g\" }\n\
               airframe.arm_length = { variable = \"arm\", factor = 0.5, offset = 0.075 }\n[parameters]\nnote = \"odd\"\n";
    let mut description = model(&rows);
    let number = description.variable("m").expect("a variable").reference;
    let note = description.variables.iter_mut().find(|variable| variable.name == "note").expect("a variable");
    note.reference = number;
    let map = Map::parse(map).expect("a map");
    let mapping = Mapping::new(&map, &description, &Configuration::default()).expect("a mapping");
    let value =
        |name: &str| mapping.values.iter().find(|(known, ..)| known == name).map(|(.., value)| value.clone());
    assert_eq!(value("m"), Some(StartValue::Real(0.7 / 0.001)));
    assert_eq!(value("arm"), Some(StartValue::Real((0.275 - 0.075) / 0.5)));
    assert_eq!(value("note"), Some(StartValue::Text("odd".to_owned())));
}
