//! Start values: those of the map, and parameters with our names.

use importer::StartValue;
use importer::description::{Kind, ModelDescription, Unit, Variable};
use nalgebra::{UnitQuaternion, Vector3};
use quadrotor::{Access, Airframe, AirframePreset, Configuration, PARAMETERS, RotorLayout};
use vehicle::foreign::ForeignRole;

use super::super::map::{Entry, Map, Value};
use super::variables::unknown;

const PRESET: &str = "airframe.preset";
/// What drives a plant that takes rotor speeds as well as thrust and torques, as our plant calls it, and its choices.
const ACTUATION: &str = "actuation";
const WRENCH: &str = "wrench";
const ROTOR_SPEEDS: &str = "rotor_speeds";

/// All start values: what drives it; parameters that have our names, or are mapped to them, get the vehicle's; then those of
/// `[parameters]`.
///
/// # Errors
/// What is missing or does not fit.
pub(super) fn start_values(
    map: &Map,
    description: &ModelDescription,
    configuration: &Configuration,
    role: ForeignRole,
    by_wrench: bool,
) -> Result<Vec<(String, u32, StartValue)>, String> {
    let mut values: Vec<_> = actuation(description, role, by_wrench).into_iter().collect();
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
        let of = Asked { entry: map.entries.get(parameter.name), unit: parameter.unit.symbol() };
        match fitted(variable, value, description, &of) {
            Ok(value) => {
                refuse_other(&values, variable, &value)
                    .map_err(|reason| format!("{}: {reason}", parameter.name))?;
                values.push((variable.name.clone(), variable.reference, value));
            }
            Err(reason) if explicit => return Err(format!("{}: {reason}", parameter.name)),
            Err(_) => {}
        }
    }
    for (name, value) in &map.parameters {
        let variable =
            description.variable(name).ok_or_else(|| unknown("[parameters]", name, description))?;
        let value = written(variable, value).map_err(|reason| format!("[parameters] {name}: {reason}"))?;
        values.retain(|other| !is_of(other, variable, &value));
        values.push((variable.name.clone(), variable.reference, value));
    }
    Ok(values)
}

/// The choice of thrust and torques, or of rotor speeds, of a plant that has one by our names.
fn actuation(
    description: &ModelDescription,
    role: ForeignRole,
    by_wrench: bool,
) -> Option<(String, u32, StartValue)> {
    let variable = description.variable(ACTUATION).filter(|_| role == ForeignRole::Plant)?;
    let Kind::Enumeration { items } = &variable.kind else { return None };
    check_settable(variable).ok()?;
    let wanted = if by_wrench { WRENCH } else { ROTOR_SPEEDS };
    let (_, number) = items.iter().find(|(name, _)| name == wanted)?;
    Some((variable.name.clone(), variable.reference, StartValue::Integer(*number)))
}

/// Whether a start value is that of a variable. Each type has references of its own.
fn is_of(other: &(String, u32, StartValue), variable: &Variable, value: &StartValue) -> bool {
    other.1 == variable.reference && std::mem::discriminant(&other.2) == std::mem::discriminant(value)
}

/// Refuses a variable that one of our parameters has set to another value.
fn refuse_other(
    values: &[(String, u32, StartValue)],
    variable: &Variable,
    value: &StartValue,
) -> Result<(), String> {
    match values.iter().find(|other| is_of(other, variable, value)) {
        Some((_, _, other)) if other != value => Err(format!(
            "the variable `{}` is mapped to two of our parameters, which want {other} and {value} of it; map one of them to false, or \
             set it in [parameters]",
            variable.name
        )),
        _ => Ok(()),
    }
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

/// One of our parameters, as a map asks for it.
struct Asked<'a> {
    entry: Option<&'a Entry>,
    /// Its unit.
    unit: &'static str,
}

/// A value of ours as a variable takes it.
fn fitted(
    variable: &Variable,
    value: StartValue,
    description: &ModelDescription,
    asked: &Asked<'_>,
) -> Result<StartValue, String> {
    check_settable(variable)?;
    let (factor, offset, given) = match asked.entry {
        Some(Entry::Variable { factor, offset, unit, .. }) => (*factor, *offset, unit.as_deref()),
        _ => (1.0, 0.0, None),
    };
    let as_it_is = factor == 1.0 && offset == 0.0;
    match (&variable.kind, value) {
        (Kind::Real { unit }, StartValue::Real(value)) => {
            let value = if as_it_is { value } else { (value - offset) / factor };
            let unit = unit_of(variable, given, unit.as_deref(), description, asked.unit)?;
            Ok(StartValue::Real(match unit {
                Some(unit) if unit.factor != 1.0 || unit.offset != 0.0 => unit.from_base(value),
                _ => value,
            }))
        }
        (kind, _) if given.is_some() || !as_it_is => Err(format!(
            "the variable `{}` has the type {kind}; only Real variables have a factor, an offset or a unit",
            variable.name
        )),
        (Kind::Integer | Kind::Enumeration { .. }, StartValue::Integer(value)) => {
            Ok(StartValue::Integer(value))
        }
        (Kind::Boolean, StartValue::Boolean(value)) => Ok(StartValue::Boolean(value)),
        (kind, _) => Err(format!("the variable `{}` has the type {kind}, which does not fit", variable.name)),
    }
}

/// The unit of a variable: the map's, else the FMU's, if it is known. It must measure what the parameter's, `ours`, does.
fn unit_of(
    variable: &Variable,
    given: Option<&str>,
    declared: Option<&str>,
    description: &ModelDescription,
    ours: &str,
) -> Result<Option<Unit>, String> {
    let Some(name) = given.or(declared) else { return Ok(None) };
    let defined = description.unit(name).filter(|unit| unit.dimension.is_some()).cloned();
    let unit = defined.or_else(|| Unit::known(name));
    let of = &variable.name;
    let measured = Unit::known(ours).and_then(|unit| unit.dimension);
    let allowed = || {
        let names: Vec<&str> = measured.into_iter().flat_map(Unit::known_of).collect();
        if names.is_empty() { ours.to_owned() } else { names.join(", ") }
    };
    match unit {
        None if given.is_some() => {
            Err(format!("the map gives `{of}` the unknown unit `{name}`; allowed are {}", allowed()))
        }
        Some(unit) if measured.is_some() && unit.dimension != measured => Err(format!(
            "the variable `{of}` has the unit `{name}`; it must be one that converts into {ours}: {}",
            allowed()
        )),
        unit => Ok(unit),
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
        (Kind::Enumeration { items }, Value::Number(number))
            if !items.is_empty() && !items.iter().any(|(_, item)| f64::from(*item) == *number) =>
        {
            Err(format!("there is no item with the number {number}; allowed are {}", listed(items)))
        }
        (Kind::Integer | Kind::Enumeration { .. }, Value::Number(number)) => {
            whole(*number).map(StartValue::Integer).ok_or_else(|| format!("{number} is not a whole number"))
        }
        (Kind::Enumeration { items }, Value::Text(text)) => {
            let item = items.iter().find(|(name, _)| name == text);
            item.map(|(_, number)| StartValue::Integer(*number))
                .ok_or_else(|| format!("there is no item `{text}`; allowed are {}", listed(items)))
        }
        (kind, _) => {
            let allowed = match kind {
                Kind::Real { .. } => "a number",
                Kind::Integer => "a whole number",
                Kind::Boolean => "true or false",
                Kind::String => "a text in quotes",
                Kind::Enumeration { .. } => "the name of an item in quotes, or its number",
            };
            Err(format!("the variable has the type {kind}, which this value does not fit; give {allowed}"))
        }
    }
}

/// Items of an enumeration with their numbers.
fn listed(items: &[(String, i32)]) -> String {
    items.iter().map(|(name, number)| format!("{name} ({number})")).collect::<Vec<_>>().join(", ")
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
