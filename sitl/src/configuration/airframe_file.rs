//! A TOML file that describes an airframe, with the dotted names of the parameters.

use std::path::Path;

use quadrotor::{Airframe, AirframePreset, Configuration, Direction, Rotor, RotorLayout, nearest_name};
use toml::Spanned;
use toml::de::{DeTable, DeValue};
use vehicle::Conduct;
use vehicle::identity::Identity;
use vehicle::parameters::{ParameterTable, ParameterValues, Speed, Statistics};

use super::text_file::read_text;
use crate::failure::Failure;

/// What a file may set, by the beginnings of the names. Names without one of them are the airframe's.
const GROUPS: [&str; 3] = ["airframe", "controller", "limits"];
/// What describes no airframe without being set, unless a preset does.
const REQUIRED: [&str; 9] = [
    "airframe.mass",
    "airframe.arm_length",
    "airframe.inertia.x",
    "airframe.inertia.y",
    "airframe.inertia.z",
    "airframe.rotor.thrust_coefficient",
    "airframe.rotor.torque_coefficient",
    "airframe.rotor.speed_max",
    "airframe.rotor.time_constant",
];
const PRESET: &str = "airframe.preset";
const LAYOUT: &str = "airframe.layout";
const ARM_LENGTH: &str = "airframe.arm_length";
const SPEED_MIN: &str = "airframe.rotor.speed_min";
/// Thrust of idle rotors as a share of the weight, unless the file has their speed.
const IDLE_THRUST_SHARE: f64 = 0.04;

/// The configuration that flies the airframe of a file.
///
/// # Errors
/// [`Failure::File`], or [`Failure::Content`] that names the line, the name, the value and what is allowed.
pub(super) fn read(path: &Path) -> Result<Configuration, Failure> {
    parse(&read_text(path)?).map_err(|reason| Failure::Content { path: path.to_owned(), reason })
}

/// A value of the file by its full name.
struct Setting<'a> {
    name: String,
    value: &'a Spanned<DeValue<'a>>,
}

fn parse(text: &str) -> Result<Configuration, String> {
    let table = DeTable::parse(text).map_err(|error| {
        let reason = error.message().lines().collect::<Vec<_>>().join(" ");
        at(text, error.span().map_or(0, |span| span.start), &reason)
    })?;
    let mut settings = Vec::new();
    flatten("", table.get_ref(), &mut settings);
    let place = |setting: &Setting<'_>, reason: String| at(text, setting.value.span().start, &reason);

    let mut airframe = airframe_before(&settings, place)?;
    let mut rest = Vec::new();
    let mut values = values_of(&Configuration { airframe, ..Configuration::default() });
    for setting in &settings {
        match setting.name.as_str() {
            PRESET | LAYOUT => {}
            name if name.starts_with("airframe.") => {
                set(setting, &mut values).map_err(|reason| place(setting, reason))?;
            }
            _ => rest.push(setting),
        }
    }
    airframe = values.configuration.airframe;
    let has = |name: &str| settings.iter().any(|setting| setting.name == name);
    if let Some(setting) = settings.iter().find(|setting| setting.name == LAYOUT) {
        let arm_length_m = has(ARM_LENGTH).then_some(airframe.arm_length_m);
        (airframe.layout, airframe.arm_length_m) = layout(setting.value.get_ref(), arm_length_m)
            .ok_or_else(|| place(setting, LAYOUTS.to_owned()))?;
    }
    if !has(PRESET) {
        complete(&settings, has(LAYOUT))?;
        if !has(SPEED_MIN) {
            airframe.rotor_speed_min_rad_s = IDLE_THRUST_SHARE.sqrt() * airframe.hover_rotor_speed_rad_s();
        }
    }

    let configuration = Configuration::for_airframe(&airframe).map_err(|error| error.to_string())?;
    let mut values = values_of(&configuration);
    for setting in rest {
        set(setting, &mut values).map_err(|reason| place(setting, reason))?;
    }
    Ok(values.configuration)
}

/// The airframe that single values change: the preset's, or one without drag.
fn airframe_before(
    settings: &[Setting<'_>],
    place: impl Fn(&Setting<'_>, String) -> String,
) -> Result<Airframe, String> {
    let Some(setting) = settings.iter().find(|setting| setting.name == PRESET) else {
        return Ok(Airframe::default());
    };
    let preset = setting.value.get_ref().as_str().and_then(AirframePreset::from_name);
    preset.map(AirframePreset::airframe).ok_or_else(|| {
        let allowed = AirframePreset::ALL.map(AirframePreset::name).join(", ");
        place(setting, format!("{PRESET} is the name of a preset: {allowed}"))
    })
}

/// Values of a table of parameters for a vehicle with this configuration.
fn values_of(configuration: &Configuration) -> ParameterValues {
    ParameterValues {
        configuration: *configuration,
        conduct: Conduct::new(false),
        system_id: 1,
        speed: Speed::Factor(1.0),
        statistics: Statistics::default(),
    }
}

/// Refuses a file that leaves something open.
fn complete(settings: &[Setting<'_>], laid_out: bool) -> Result<(), String> {
    let missing: Vec<&str> = REQUIRED
        .into_iter()
        .filter(|name| !(laid_out && *name == ARM_LENGTH))
        .filter(|name| settings.iter().all(|setting| setting.name != *name))
        .collect();
    if missing.is_empty() {
        return Ok(());
    }
    let presets = AirframePreset::ALL.map(AirframePreset::name).join(", ");
    Err(format!(
        "{} missing; add {}, or {PRESET} = one of {presets} to take the rest from",
        missing.join(", "),
        if missing.len() == 1 { "it" } else { "them" }
    ))
}

/// Every value with its name; tables are parts of names.
fn flatten<'a>(prefix: &str, table: &'a DeTable<'a>, settings: &mut Vec<Setting<'a>>) {
    for (key, value) in table {
        let key = key.get_ref();
        let name = if prefix.is_empty() && !GROUPS.contains(&key.as_ref()) {
            format!("airframe.{key}")
        } else if prefix.is_empty() {
            key.to_string()
        } else {
            format!("{prefix}.{key}")
        };
        match value.get_ref() {
            DeValue::Table(table) => flatten(&name, table, settings),
            _ => settings.push(Setting { name, value }),
        }
    }
}

/// Writes one value.
fn set(setting: &Setting<'_>, values: &mut ParameterValues) -> Result<(), String> {
    let table = ParameterTable::new(Identity::Px4);
    let name = setting.name.as_str();
    let entry = table.find(name).filter(|entry| entry.dotted() == Some(name));
    if entry.is_none() {
        let known = table.entries().iter().filter_map(|entry| entry.dotted());
        let ours = known.filter(|known| GROUPS.iter().any(|group| known.starts_with(group)));
        return Err(match nearest_name(name, ours.chain([PRESET, LAYOUT])) {
            Some(meant) => format!("unknown name {name}; did you mean {meant}?"),
            None => format!("unknown name {name}; allowed are the names of airframe, limits and controller"),
        });
    }
    let text = match setting.value.get_ref() {
        DeValue::String(text) => text.to_string(),
        DeValue::Integer(number) => number.to_string(),
        DeValue::Float(number) => number.to_string(),
        DeValue::Boolean(value) => value.to_string(),
        _ => return Err(format!("{name} is a number, a name, true or false")),
    };
    let number = table.number(name, &text).map_err(|error| error.to_string())?;
    table.set(name, number, values).map(|_| ()).map_err(|error| error.to_string())
}

const LAYOUTS: &str = "airframe.layout is \"plus\" or \"x\" (front, or front right, turns clockwise), \"plus reversed\" or \"x \
                       reversed\", or four rotors as [forward in m, right in m, \"cw\" or \"ccw\"]";

/// A layout, and its unit of length: that of the file, or the distance of the outermost rotor, m.
fn layout(value: &DeValue<'_>, arm_length_m: Option<f64>) -> Option<(RotorLayout, f64)> {
    if let DeValue::String(name) = value {
        let layout = match name.as_ref() {
            "plus" => RotorLayout::plus(),
            "x" => RotorLayout::x(),
            "plus reversed" => RotorLayout::plus().reversed(),
            "x reversed" => RotorLayout::x().reversed(),
            _ => return None,
        };
        return Some((layout, arm_length_m.unwrap_or(Airframe::default().arm_length_m)));
    }
    let rotors: Vec<Rotor> =
        value.as_array()?.iter().map(|rotor| placed(rotor.get_ref())).collect::<Option<_>>()?;
    let mut rotors: [Rotor; 4] = rotors.try_into().ok()?;
    let outermost_m = rotors.iter().map(|rotor| rotor.x.hypot(rotor.y)).fold(0.0, f64::max);
    let unit_m = arm_length_m.unwrap_or(outermost_m);
    for rotor in &mut rotors {
        (rotor.x, rotor.y) = (rotor.x / unit_m, rotor.y / unit_m);
    }
    Some((RotorLayout { rotors }, unit_m))
}

/// A rotor, with its place in m.
fn placed(value: &DeValue<'_>) -> Option<Rotor> {
    let values: Vec<_> = value.as_array()?.iter().map(Spanned::get_ref).collect();
    let [x, y, direction] = values.as_slice() else { return None };
    let direction = match direction.as_str()? {
        "cw" => Direction::Clockwise,
        "ccw" => Direction::Counterclockwise,
        _ => return None,
    };
    Some(Rotor { x: metres(x)?, y: metres(y)?, direction })
}

fn metres(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Float(number) => number.to_string().parse().ok(),
        DeValue::Integer(number) => number.to_string().parse().ok(),
        _ => None,
    }
}

/// The line of a place in the text, its content, and what is wrong with it.
fn at(text: &str, start: usize, reason: &str) -> String {
    let line = text.get(..start).unwrap_or_default().matches('\n').count();
    let content = text.lines().nth(line).unwrap_or_default().trim();
    format!("line {}, `{content}`: {reason}", line + 1)
}

#[cfg(test)]
mod tests {
    use quadrotor::{Airframe, AirframePreset, Configuration, RotorLayout};

    use super::parse;

    const OWN: &str = "# a vehicle of our own\n[airframe]\nmass = 1.2\narm_length = 0.25\nlayout = \"x reversed\"\n\
        inertia = { x = 0.02, y = 0.021, z = 0.035 }\nrotor.thrust_coefficient = 1.5e-5\nrotor.torque_coefficient = 2.5e-7\n\
        rotor.speed_max = 800\nrotor.time_constant = 0.03\ndrag.x = 0.1\n";

    #[test]
    fn a_file_describes_an_airframe_and_limits_follow() {
        let read = parse(OWN).expect("an airframe");
        let hover_rad_s = (1.2 * quadrotor::GRAVITY_M_S2 / (4.0 * 1.5e-5)).sqrt();
        let expected = Airframe {
            mass_kg: 1.2,
            arm_length_m: 0.25,
            layout: RotorLayout::x().reversed(),
            inertia_kg_m2: [0.02, 0.021, 0.035],
            thrust_coefficient_n_s2: 1.5e-5,
            torque_coefficient_n_m_s2: 2.5e-7,
            rotor_speed_min_rad_s: 0.2 * hover_rad_s,
            rotor_speed_max_rad_s: 800.0,
            rotor_time_constant_s: 0.03,
            drag_n_s_m: [0.1, 0.0, 0.0],
            ..Airframe::default()
        };
        assert!((read.airframe.rotor_speed_min_rad_s / expected.rotor_speed_min_rad_s - 1.0).abs() < 1e-12);
        let read_airframe =
            Airframe { rotor_speed_min_rad_s: expected.rotor_speed_min_rad_s, ..read.airframe };
        assert_eq!(read_airframe, expected);
        assert_eq!(read, Configuration::for_airframe(&read.airframe).expect("flies"));
    }

    /// With and without the group, tables and dots are one.
    #[test]
    fn a_preset_is_changed_by_single_values() {
        for text in [
            "preset = \"iris\"\nmass = 1.8\n[limits]\ntilt = 0.4\n[controller]\nkind = \"dlqr\"\n",
            "controller.kind = 3\nlimits.tilt = 0.4\nairframe.mass = 1.8\nairframe.preset = \"iris\"\n",
        ] {
            let heavier = Airframe { mass_kg: 1.8, ..AirframePreset::Iris.airframe() };
            let mut expected = Configuration::for_airframe(&heavier).expect("flies");
            expected.limits.tilt_rad = 0.4;
            expected.controllers.kind = quadrotor::ControllerKind::Dlqr;
            assert_eq!(parse(text), Ok(expected), "{text}");
        }
    }

    #[test]
    fn rotors_can_be_anywhere() {
        let text = OWN.replace(
            "layout = \"x reversed\"",
            "layout = [[0.13, 0.22, \"ccw\"], [-0.13, 0.2, \"cw\"], [-0.13, -0.2, \"ccw\"], [0.13, -0.22, \"cw\"]]",
        );
        let iris = AirframePreset::Iris.airframe();
        let near = |read: &Airframe| {
            for (rotor, expected) in read.layout.rotors.iter().zip(iris.layout.rotors) {
                assert_eq!(rotor.direction, expected.direction);
                let metres = [rotor.x * read.arm_length_m, rotor.y * read.arm_length_m];
                let wanted = [expected.x * iris.arm_length_m, expected.y * iris.arm_length_m];
                assert!(metres.iter().zip(wanted).all(|(one, other)| (one - other).abs() < 1e-12));
            }
        };
        near(&parse(&text).expect("an airframe").airframe);
        // The unit is then the outermost rotor's.
        let without = text.replace("arm_length = 0.25\n", "");
        let read = parse(&without).expect("an airframe").airframe;
        near(&read);
        assert!((read.arm_length_m - 0.22_f64.hypot(0.13)).abs() < 1e-12);
    }

    #[test]
    fn mistakes_are_named_with_line_name_value_and_what_is_allowed() {
        for (text, expected) in [
            (
                OWN.replace("mass = 1.2", "mass = 99"),
                "line 3, `mass = 99`: airframe.mass = 99 kg; allowed 0.005–50 kg",
            ),
            (
                OWN.replace("mass", "mas"),
                "line 3, `mas = 1.2`: unknown name airframe.mas; did you mean airframe.mass?",
            ),
            (OWN.replace("mass = 1.2", "mass = \"heavy\""), "airframe.mass = heavy; allowed 0.005–50 kg"),
            (OWN.replace("mass = 1.2", "mass = [1]"), "airframe.mass is a number"),
            (OWN.replace("mass = 1.2", "mass = 9"), "airframe.mass = 9 kg is too heavy; allowed up to"),
            (
                OWN.replace("mass = 1.2\n", ""),
                "airframe.mass missing; add it, or airframe.preset = one of paper, crazyflie",
            ),
            ("mass = 1".to_owned(), "airframe.arm_length, airframe.inertia.x, airframe.inertia.y"),
            (
                "preset = \"cessna\"".to_owned(),
                "line 1, `preset = \"cessna\"`: airframe.preset is the name of a preset: paper, crazyflie",
            ),
            (OWN.replace("x reversed", "y"), "airframe.layout is \"plus\" or \"x\""),
            (
                OWN.replace("\"x reversed\"", "[[1, 2, \"cw\"]]"),
                "line 5, `layout = [[1, 2, \"cw\"]]`: airframe.layout is",
            ),
            (
                "preset = \"iris\"\n[limits]\ntilt = 3".to_owned(),
                "line 3, `tilt = 3`: limits.tilt = 3 rad; allowed",
            ),
            ("preset = \"iris\"\n[sensor]\nseed = 3".to_owned(), "unknown name airframe.sensor.seed"),
            ("mass = = 3".to_owned(), "line 1, `mass = = 3`: "),
        ] {
            let reason = parse(&text).expect_err(&text);
            assert!(reason.contains(expected) && !reason.contains('\n'), "{text}: {reason}");
        }
    }
}
