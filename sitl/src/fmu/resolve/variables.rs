//! Variables of signals: by the map, else by our names.

use importer::description::{Causality, Kind, ModelDescription, Unit, Variable};
use quadrotor::nearest_name;

use super::super::map::{Entry, Map};
use super::super::mapping::{Channel, Conversion};
use super::super::signals::Group;

/// Names that a message lists.
const MOST_NAMES: usize = 12;

/// A map and the FMU that it is for.
pub(super) struct Resolver<'a> {
    pub(super) map: &'a Map,
    pub(super) description: &'a ModelDescription,
}

/// Channels of a group, and its constants by their parts.
type Resolved = (Vec<Channel>, Vec<(usize, f64)>);

impl Resolver<'_> {
    /// The variables of a group, all or none.
    pub(super) fn group(
        &self,
        groups: &[Group],
        index: usize,
        causalities: &[Causality],
    ) -> Result<Resolved, String> {
        let Some(group) = groups.get(index) else { return Ok(Resolved::default()) };
        let entries: Vec<Option<&Entry>> =
            group.signals().map(|signal| self.map.entries.get(&signal)).collect();
        if entries.contains(&Some(&Entry::Nothing)) {
            return Ok(Resolved::default());
        }
        let mut resolved = Resolved::default();
        let mut absent = Vec::new();
        let explicit = entries.iter().any(Option::is_some);
        let default = self.default_names(group, causalities, explicit);
        for (part, entry) in entries.into_iter().enumerate() {
            let signal = group.signal(part);
            match (entry, default.get(part).cloned().flatten()) {
                (Some(Entry::Constant(_)), _) if causalities == [Causality::Input] => {
                    return Err(format!("{signal} is an input; it has no constant value"));
                }
                (Some(Entry::Constant(value)), _) => resolved.1.push((part, *value)),
                (Some(Entry::Variable { name, factor, offset, unit }), _) => {
                    let variable = self.variable(&signal, name, causalities)?;
                    let (unit_name, unit) = self.unit(&signal, group, variable, unit.as_deref())?;
                    let conversion =
                        Conversion { scale: factor * unit.factor, offset: factor * unit.offset + offset };
                    resolved.0.push(channel(index, part, variable, unit_name, conversion));
                }
                (_, Some(name)) => {
                    let variable = self.variable(&signal, &name, causalities)?;
                    let (unit_name, unit) = self.unit(&signal, group, variable, None)?;
                    let conversion = Conversion { scale: unit.factor, offset: unit.offset };
                    resolved.0.push(channel(index, part, variable, unit_name, conversion));
                }
                (_, None) => absent.push(signal),
            }
        }
        match absent.first() {
            Some(absent) if explicit => Err(format!(
                "{absent} is missing; the other variables of {} are mapped: map it, too, in [variables]",
                group.name
            )),
            Some(_) => Ok(Resolved::default()),
            None => Ok(resolved),
        }
    }

    /// Names of variables that are there by our names, part by part. If the map has some of the parts, any others will do; else all
    /// are there, or none counts.
    fn default_names(&self, group: &Group, causalities: &[Causality], any: bool) -> Vec<Option<String>> {
        let fits = |name: &String| {
            let variable = self.description.variable(name);
            variable.is_some_and(|variable| {
                matches!(variable.kind, Kind::Real { .. }) && causalities.contains(&variable.causality)
            })
        };
        let mut found = group.defaults.iter().map(|(beginning, ends)| {
            let names = ends.iter().take(group.count()).map(|end| format!("{beginning}{end}"));
            names.map(|name| Some(name).filter(fits)).collect::<Vec<_>>()
        });
        let enough = |names: &Vec<Option<String>>| {
            if any { names.iter().any(Option::is_some) } else { names.iter().all(Option::is_some) }
        };
        found.find(enough).unwrap_or_default()
    }

    /// A real variable by its name.
    fn variable(&self, signal: &str, name: &str, causalities: &[Causality]) -> Result<&Variable, String> {
        let variable =
            self.description.variable(name).ok_or_else(|| unknown(signal, name, self.description))?;
        if !matches!(variable.kind, Kind::Real { .. }) {
            return Err(format!(
                "{signal}: the variable `{name}` has the type {}; it must be Real",
                variable.kind
            ));
        }
        if !causalities.contains(&variable.causality) {
            let wanted = causalities.first().map(ToString::to_string).unwrap_or_default();
            return Err(format!(
                "{signal}: the variable `{name}` is of causality {}; it must be an {wanted}",
                variable.causality
            ));
        }
        Ok(variable)
    }

    /// The unit of a variable: the map's, else the FMU's, else SI. It must measure what the signal is.
    fn unit(
        &self,
        signal: &str,
        group: &Group,
        variable: &Variable,
        given: Option<&str>,
    ) -> Result<(Option<String>, Unit), String> {
        let declared = match &variable.kind {
            Kind::Real { unit } => unit.as_deref(),
            _ => None,
        };
        let si = || Unit {
            name: group.unit.to_owned(),
            dimension: Some(group.dimension),
            factor: 1.0,
            offset: 0.0,
        };
        let Some(name) = given.or(declared) else { return Ok((None, si())) };
        let defined = self.description.unit(name).filter(|unit| unit.dimension.is_some()).cloned();
        let unit = defined.or_else(|| Unit::known(name)).ok_or_else(|| {
            let of = &variable.name;
            let fitting = self.fitting_units(group);
            if given.is_some() {
                return format!("{signal}: the map gives `{of}` the unknown unit `{name}`; allowed are {fitting}");
            }
            format!(
                "{signal}: the FMU does not define the unit `{name}` of the variable `{of}`; say which one it is: {signal} = {{ \
                 variable = \"{of}\", unit = \"{}\" }}; allowed are {fitting}",
                group.unit
            )
        })?;
        if unit.dimension != Some(group.dimension) {
            return Err(format!(
                "{signal}: the variable `{}` has the unit `{name}`; it must be one that converts into {}: {}",
                variable.name,
                group.unit,
                self.fitting_units(group)
            ));
        }
        Ok((Some(name.to_owned()), unit))
    }

    /// Units that a group can have: those in common use, and those that the FMU defines.
    fn fitting_units(&self, group: &Group) -> String {
        let defined = self.description.units.iter().filter(|unit| unit.dimension == Some(group.dimension));
        let mut names: Vec<&str> = Unit::known_of(group.dimension).collect();
        for unit in defined {
            if !names.contains(&unit.name.as_str()) {
                names.push(&unit.name);
            }
        }
        names.truncate(MOST_NAMES);
        names.join(", ")
    }
}

fn channel(
    group: usize,
    part: usize,
    variable: &Variable,
    unit: Option<String>,
    conversion: Conversion,
) -> Channel {
    Channel { group, part, variable: (variable.name.clone(), variable.reference), unit, conversion }
}

/// A variable that the FMU does not have.
pub(super) fn unknown(signal: &str, name: &str, description: &ModelDescription) -> String {
    let names = description.variables.iter().map(|variable| variable.name.as_str());
    match nearest_name(name, names.clone()) {
        Some(meant) => format!("{signal}: the FMU has no variable `{name}`; did you mean `{meant}`?"),
        None => format!("{signal}: the FMU has no variable `{name}`; it has {}", listed(names.collect())),
    }
}

/// Names, as many as a message bears.
fn listed(mut names: Vec<&str>) -> String {
    let rest = names.len().saturating_sub(MOST_NAMES);
    names.truncate(MOST_NAMES);
    match (names.is_empty(), rest) {
        (true, _) => "none".to_owned(),
        (_, 0) => names.join(", "),
        _ => format!("{} and {rest} more", names.join(", ")),
    }
}

/// A group that must be there and is not.
pub(super) fn missing(
    groups: &[Group],
    index: usize,
    causality: &str,
    description: &ModelDescription,
) -> String {
    let Some(group) = groups.get(index) else { return String::new() };
    let signals: Vec<String> = group.signals().collect();
    let wanted = Causality::Output;
    let outputs = description.variables.iter().filter(|variable| variable.causality == wanted);
    let names: Vec<&str> = outputs.map(|variable| variable.name.as_str()).collect();
    format!(
        "no {causality} for {} ({}, {}); map it in [variables] of a --map; its outputs are {}",
        signals.join(", "),
        group.description,
        group.unit,
        listed(names),
    )
}
