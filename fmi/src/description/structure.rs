//! `ModelStructure`

use std::io;

use super::Xml;
use crate::continuous::states;
use crate::model::Model;
use crate::variables::{Role, Variable, variables};

/// Index of a variable in the description counts from 1.
fn indexed<M: Model>() -> impl Iterator<Item = (usize, &'static Variable<M>)> {
    (1..).zip(variables::<M>().map(|(_, variable)| variable))
}

pub(super) fn write<M: Model>(xml: &mut Xml) -> io::Result<()> {
    xml.create_element("ModelStructure").write_inner_content(|xml| {
        xml.create_element("Outputs").write_inner_content(|xml| {
            let mut outputs =
                indexed::<M>().filter(|(_, variable)| matches!(variable.role, Role::Output { .. }));
            outputs.try_for_each(|(index, variable)| unknown(xml, index, &feed_through::<M>(variable)))
        })?;
        if states::<M>().next().is_some() {
            xml.create_element("Derivatives").write_inner_content(|xml| {
                let mut derivatives =
                    indexed::<M>().filter(|(_, variable)| matches!(variable.role, Role::Derivative { .. }));
                derivatives
                    .try_for_each(|(index, variable)| unknown(xml, index, &feed_through::<M>(variable)))
            })?;
        }
        xml.create_element("InitialUnknowns").write_inner_content(|xml| {
            indexed::<M>()
                .filter_map(|(index, variable)| Some((index, variable.initially_depends_on()?)))
                .try_for_each(|(index, names)| unknown(xml, index, &known::<M>(names)))
        })?;
        Ok(())
    })?;
    Ok(())
}

fn unknown(xml: &mut Xml, index: usize, dependencies: &str) -> io::Result<()> {
    xml.create_element("Unknown")
        .with_attributes([("index", index.to_string().as_str()), ("dependencies", dependencies)])
        .write_empty()?;
    Ok(())
}

/// Indices of the inputs and states that an output or a derivative depends on at the same instant. Without equations inputs act from a
/// communication point on, so that no output there depends on them.
fn feed_through<M: Model>(unknown: &Variable<M>) -> String {
    let names = M::CONTINUOUS.map_or(&[][..], |equations| equations.dependencies(unknown.name));
    let is_state = |variable: &Variable<M>| states::<M>().any(|state| state.name == variable.name);
    let known = |variable: &Variable<M>| matches!(variable.role, Role::Input(_)) || is_state(variable);
    indices(names, known)
}

/// Indices of the inputs and parameters whose names begin so.
fn known<M: Model>(names: &[&str]) -> String {
    indices::<M>(names, |variable| matches!(variable.role, Role::Input(_) | Role::Parameter { .. }))
}

/// Indices of the variables of a kind whose names begin so.
fn indices<M: Model>(names: &[&str], is_of_kind: impl Fn(&Variable<M>) -> bool) -> String {
    let indices: Vec<String> = indexed::<M>()
        .filter(|(_, variable)| is_of_kind(variable))
        .filter(|(_, variable)| names.iter().any(|name| variable.name.starts_with(name)))
        .map(|(index, _)| index.to_string())
        .collect();
    indices.join(" ")
}
