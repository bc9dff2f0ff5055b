//! Start values: those of the map, and parameters with our names.

use importer::StartValue;
use importer::description::{Kind, ModelDescription, Unit, Variable};
use nalgebra::{UnitQuaternion, Vector3};
use quadrotor::{Access, Airframe, AirframePreset, Configuration, PARAMETERS, RotorLayout};
use vehicle::foreign::ForeignRole;

use super::super::map::{Entry, Map, Value};
use super::variables::unknown;

const PRESET: &str = "airframe.preset";

/// All start values: parameters that have our names, or are mapped to them, get the vehicle's; then those of `[parameters]`.
///
/// # Errors
/// What is missing or does not fit.
pub(super) fn start_values(
    map: &Map,
    description: &ModelDescription,
    configuration: &Configuration,
    role: ForeignRole,
) -> Result<Vec<(String, u32, StartValue)>, String> {
    let mut values = Vec::new();
    let told = told(map, configuration, role);
    for parameter in PARAMETERS.iter() {
        let (name, explicit) = match map.entries.get(parameter.name) {
            Some(Entry::Variable { name, .. }) => (name.as_str(), true),
            Some(Entry::Nothing) => continue,
            Some(Entry::Constant(_)) => {
                return Err(format!(
                    "{0} is set by --set {0}=VALUE; here it is the name of a variable",
                    parameter.name
                ));
            }
            None => (parameter.name, false),
        };
        let Some(variable) = description.variable(name) else {
            if explicit {
                return Err(unknown(parameter.name, name, description));
            }
            continue;
        };
        let value = match parameter.access {
            _ if parameter.name == PRESET => preset(&told, description)?,
            Access::Real { get, .. } => StartValue::Real(get(&told)),
            Access::Integer { get, .. } | Access::Enumeration { get, .. } => StartValue::Integer(get(&told)),
            Access::Boolean { get, .. } => StartValue::Boolean(get(&told)),
        };
        match fitted(variable, value, description) {
            Ok(value) => values.push((variable.name.clone(), variable.reference, value)),
            Err(reason) if explicit => return Err(format!("{}: {reason}", parameter.name)),
            Err(_) => {}
        }
    }
    for (name, value) in &map.parameters {
        let variable =
            description.variable(name).ok_or_else(|| unknown("[parameters]", name, description))?;
        let value = written(variable, value).map_err(|reason| format!("[parameters] {name}: {reason}"))?;
        values.retain(|(_, reference, _)| *reference != variable.reference);
        values.push((variable.name.clone(), variable.reference, value));
    }
    Ok(values)
}

/// The configuration as the FMU is told it: the start in its axes, and no shaper, since references move already.
fn told(map: &Map, configuration: &Configuration, role: ForeignRole) -> Configuration {
    let mut told = *configuration;
    let initial = &mut told.initial;
    let place = map.axes.their_place_m(Vector3::from(initial.position_m));
    let [phi, theta, psi] = initial.attitude_rad;
    let attitude = map.axes.their_attitude(UnitQuaternion::from_euler_angles(phi, theta, psi));
    if map.axes != Default::default() {
        initial.position_m = place.into();
        initial.attitude_rad = attitude.euler_angles().into();
    }
    if role == ForeignRole::ClosedLoop {
        told.reference.shaping = false;
    }
    told
}

/// The preset with which an FMU of ours has this airframe: a layout is no parameter.
fn preset(configuration: &Configuration, description: &ModelDescription) -> Result<StartValue, String> {
    let fits = |preset: AirframePreset| {
        if preset == AirframePreset::Paper {
            return configuration.airframe.layout == RotorLayout::plus();
        }
        // As the FMU sees it: the preset, and every other parameter.
        let airframe = Airframe { layout: RotorLayout::plus(), ..configuration.airframe };
        let with = Configuration { preset, airframe, ..*configuration };
        with.resolved().is_ok_and(|resolved| resolved.airframe == configuration.airframe)
    };
    let number = AirframePreset::ALL.into_iter().zip(1..).find(|(preset, _)| fits(*preset));
    number.map(|(_, number)| StartValue::Integer(number)).ok_or_else(|| {
        format!(
            "{} has the layouts of presets only: choose one of them with --airframe, or map {PRESET} to false if the rotors are \
             laid out alike",
            description.model_name
        )
    })
}

/// A value of ours as a variable takes it.
fn fitted(
    variable: &Variable,
    value: StartValue,
    description: &ModelDescription,
) -> Result<StartValue, String> {
    check_settable(variable)?;
    match (&variable.kind, value) {
        (Kind::Real { unit }, StartValue::Real(value)) => {
            let defined = unit.as_deref().and_then(|name| {
                description
                    .unit(name)
                    .filter(|unit| unit.dimension.is_some())
                    .cloned()
                    .or_else(|| Unit::known(name))
            });
            Ok(StartValue::Real(match defined {
                Some(unit) if unit.factor != 1.0 || unit.offset != 0.0 => unit.from_base(value),
                _ => value,
            }))
        }
        (Kind::Integer | Kind::Enumeration { .. }, StartValue::Integer(value)) => {
            Ok(StartValue::Integer(value))
        }
        (Kind::Boolean, StartValue::Boolean(value)) => Ok(StartValue::Boolean(value)),
        (kind, _) => Err(format!("the variable `{}` has the type {kind}, which does not fit", variable.name)),
    }
}

/// A value of the map as a variable takes it, in the variable's own unit.
fn written(variable: &Variable, value: &Value) -> Result<StartValue, String> {
    check_settable(variable)?;
    let whole = |number: f64| (number.fract() == 0.0 && number.abs() < 2e9).then_some(number as i32);
    match (&variable.kind, value) {
        (Kind::Real { .. }, Value::Number(number)) => Ok(StartValue::Real(*number)),
        (Kind::Boolean, Value::Boolean(value)) => Ok(StartValue::Boolean(*value)),
        (Kind::String, Value::Text(text)) => Ok(StartValue::Text(text.clone())),
        (Kind::Integer | Kind::Enumeration { .. }, Value::Number(number)) => {
            whole(*number).map(StartValue::Integer).ok_or_else(|| format!("{number} is no whole number"))
        }
        (Kind::Enumeration { items }, Value::Text(text)) => {
            let item = items.iter().find(|(name, _)| name == text);
            item.map(|(_, number)| StartValue::Integer(*number)).ok_or_else(|| {
                let names: Vec<&str> = items.iter().map(|(name, _)| name.as_str()).collect();
                format!("there is no item `{text}`; allowed {}", names.join(", "))
            })
        }
        (kind, _) => Err(format!("the variable has the type {kind}, which this value does not fit")),
    }
}

fn check_settable(variable: &Variable) -> Result<(), String> {
    if variable.can_be_started() {
        return Ok(());
    }
    let causality = variable.causality;
    Err(format!(
        "the variable `{}` is of causality {causality}; only parameters and inputs can be set",
        variable.name
    ))
}
