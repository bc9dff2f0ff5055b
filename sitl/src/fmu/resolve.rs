//! From a map and a description to a mapping.

mod duplicates;
mod parameters;
mod variables;

use std::time::Duration;

use importer::description::{Causality, Kind, ModelDescription};
use quadrotor::Configuration;
use vehicle::foreign::ForeignRole;

use self::duplicates::refuse_duplicates;
use self::parameters::start_values;
use self::variables::{Resolver, missing};
use super::map::{Entry, Map};
use super::mapping::{Channel, Mapping};
use super::signals::{ARMED, Group, INPUTS, OUTPUTS, input, output};

/// Input groups that only a closed loop, or only a plant, is told.
const OF_CLOSED_LOOPS: [usize; 5] = [
    input::REFERENCE_POSITION,
    input::REFERENCE_VELOCITY,
    input::REFERENCE_ACCELERATION,
    input::REFERENCE_YAW,
    input::REFERENCE_YAW_RATE,
];
const OF_PLANTS: [usize; 3] = [input::ROTOR_COMMAND, input::THRUST, input::TORQUE];

impl Mapping {
    /// Finds the variables of an FMU that a map names, or that have our names.
    ///
    /// # Errors
    /// What is missing or does not fit, and how it is mapped.
    pub fn new(
        map: &Map,
        description: &ModelDescription,
        configuration: &Configuration,
    ) -> Result<Self, String> {
        let resolver = Resolver { map, description };
        let mut inputs = Vec::new();
        for group in 0..INPUTS.len() {
            inputs.push(resolver.group(&INPUTS, group, &[Causality::Input])?.0);
        }
        let role = role(map, &inputs)?;
        check_explicit(map, role)?;
        choose_inputs(map, role, &mut inputs)?;
        let by_wrench = inputs.get(input::THRUST).is_some_and(|channels| !channels.is_empty());
        let (mut outputs, mut constants) = (Vec::new(), Vec::new());
        for group in 0..OUTPUTS.len() {
            let readable = [Causality::Output, Causality::Local, Causality::CalculatedParameter];
            let (channels, given) = resolver.group(&OUTPUTS, group, &readable)?;
            outputs.extend(channels);
            constants.extend(given.into_iter().map(|(part, value)| (group, part, value)));
        }
        let mut mapping = Self {
            model_name: description.model_name.clone(),
            role,
            axes: map.axes,
            inputs: inputs.into_iter().flatten().collect(),
            armed: armed(map, description)?,
            outputs,
            constants,
            values: start_values(map, description, configuration, role, by_wrench)?,
            preload: map.preload.clone(),
            longest_step: Duration::from_secs_f64(map.step_timeout_s),
        };
        mapping.choose_outputs(map, description)?;
        refuse_duplicates(&mapping)?;
        Ok(mapping)
    }

    /// Refuses what lacks a motion, and drops what says the same twice.
    fn choose_outputs(&mut self, map: &Map, description: &ModelDescription) -> Result<(), String> {
        if self.takes(input::THRUST) {
            // The rotors are ours: what has our names for theirs does not turn.
            for group in [output::ROTOR_SPEED, output::ROTOR_THRUST] {
                if !is_mapped(map, &OUTPUTS, group) {
                    self.outputs.retain(|channel| channel.group != group);
                }
            }
        }
        for (first, second) in
            [(output::VELOCITY, output::BODY_VELOCITY), (output::QUATERNION, output::ATTITUDE)]
        {
            if self.shows(first) {
                self.outputs.retain(|channel| channel.group != second);
                self.constants.retain(|(group, _, _)| *group != second);
            } else if !self.shows(second) {
                return Err(missing(&OUTPUTS, first, "output", description));
            }
        }
        for group in [output::POSITION, output::BODY_RATE] {
            if !self.shows(group) {
                return Err(missing(&OUTPUTS, group, "output", description));
            }
        }
        Ok(())
    }
}

/// What the FMU is in place of: as the map says, or as its inputs do.
fn role(map: &Map, inputs: &[Vec<Channel>]) -> Result<ForeignRole, String> {
    let has = |group: usize| inputs.get(group).is_some_and(|channels| !channels.is_empty());
    let follows = has(input::REFERENCE_POSITION);
    let moves = has(input::ROTOR_COMMAND) || has(input::THRUST) && has(input::TORQUE);
    let of_plant = "rotor.command.1 to .4, or thrust and torque.x to .z";
    match (map.role, follows, moves) {
        (Some(ForeignRole::ClosedLoop), true, _) | (None, true, false) => Ok(ForeignRole::ClosedLoop),
        (Some(ForeignRole::Plant), _, true) | (None, false, true) => Ok(ForeignRole::Plant),
        (None, true, true) => Err(format!(
            "it has inputs of a closed loop (reference.position) and of a plant ({of_plant}); choose with role = \"closed-loop\" or \
             role = \"plant\" in a --map"
        )),
        (Some(ForeignRole::ClosedLoop), false, _) => Err(
            "a closed loop needs the inputs reference.position.x to .z; map them in [variables] of a --map"
                .to_owned(),
        ),
        (Some(ForeignRole::Plant), _, false) => {
            Err(format!("a plant needs the inputs {of_plant}; map them in [variables] of a --map"))
        }
        (None, false, false) => Err(format!(
            "no inputs to fly it by: a closed loop has reference.position.x to .z, a plant {of_plant}; map them in [variables] of a \
             --map"
        )),
    }
}

/// Refuses entries for the other role.
fn check_explicit(map: &Map, role: ForeignRole) -> Result<(), String> {
    let others: &[usize] = if role == ForeignRole::Plant { &OF_CLOSED_LOOPS } else { &OF_PLANTS };
    let groups = others.iter().filter_map(|group| INPUTS.get(*group));
    for signal in groups.flat_map(Group::signals) {
        if matches!(map.entries.get(&signal), Some(Entry::Variable { .. })) {
            return Err(format!(
                "[variables] maps {signal}, but a {role} does not get it; remove it from the map"
            ));
        }
    }
    Ok(())
}

/// Keeps the groups that the role has; of a plant rotor speeds, or thrust and torques if those are mapped or all there is.
fn choose_inputs(map: &Map, role: ForeignRole, inputs: &mut [Vec<Channel>]) -> Result<(), String> {
    let explicit = |group: usize| is_mapped(map, &INPUTS, group);
    let has = |group: usize| inputs.get(group).is_some_and(|channels| !channels.is_empty());
    let wrench = explicit(input::THRUST) || explicit(input::TORQUE);
    let rotors = has(input::ROTOR_COMMAND) && (explicit(input::ROTOR_COMMAND) || !wrench);
    if role == ForeignRole::Plant && rotors && wrench {
        return Err(
            "[variables] maps rotor.command, and thrust or torque; a plant is driven by one of the two; remove the other"
                .to_owned(),
        );
    }
    let dropped: Vec<usize> = match role {
        ForeignRole::ClosedLoop => OF_PLANTS.to_vec(),
        ForeignRole::Plant if rotors => {
            OF_CLOSED_LOOPS.iter().chain(&[input::THRUST, input::TORQUE]).copied().collect()
        }
        ForeignRole::Plant => OF_CLOSED_LOOPS.iter().chain(&[input::ROTOR_COMMAND]).copied().collect(),
    };
    for group in dropped {
        if let Some(channels) = inputs.get_mut(group) {
            channels.clear();
        }
    }
    Ok(())
}

/// Whether a map names variables of a group.
fn is_mapped(map: &Map, groups: &[Group], group: usize) -> bool {
    let is_variable = |name: &String| matches!(map.entries.get(name), Some(Entry::Variable { .. }));
    groups.get(group).is_some_and(|group| group.signals().any(|name| is_variable(&name)))
}

/// The Boolean input.
fn armed(map: &Map, description: &ModelDescription) -> Result<Option<(String, u32)>, String> {
    let fits = |name: &str| {
        let variable = description.variable(name)?;
        let fits = variable.kind == Kind::Boolean && variable.causality == Causality::Input;
        Some((variable, fits))
    };
    match map.entries.get(ARMED) {
        None => Ok(fits(ARMED)
            .filter(|(_, fits)| *fits)
            .map(|(variable, _)| (variable.name.clone(), variable.reference))),
        Some(Entry::Nothing) => Ok(None),
        Some(Entry::Variable { name, .. }) => match fits(name) {
            Some((variable, true)) => Ok(Some((variable.name.clone(), variable.reference))),
            Some((variable, false)) => Err(format!(
                "{ARMED}: the variable `{name}` is a {} {}; it must be a Boolean input",
                variable.kind, variable.causality
            )),
            None => Err(variables::unknown(ARMED, name, description)),
        },
        Some(Entry::Constant(_)) => Err(format!("{ARMED} is an input; it has no constant value")),
    }
}

#[cfg(test)]
mod tests;
