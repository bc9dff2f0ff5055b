//! `ModelStructure`

use std::io;

use super::Xml;
use crate::model::Model;
use crate::variables::{Role, Variable, variables};

/// Index of a variable in the description counts from 1.
fn indexed<M: Model>() -> impl Iterator<Item = (usize, &'static Variable<M>)> {
    (1..).zip(variables::<M>().map(|(_, variable)| variable))
}

pub(super) fn write<M: Model>(xml: &mut Xml) -> io::Result<()> {
    xml.create_element("ModelStructure").write_inner_content(|xml| {
        xml.create_element("Outputs").write_inner_content(|xml| {
            let outputs = indexed::<M>().filter(|(_, variable)| matches!(variable.role, Role::Output { .. }));
            // Inputs act from a communication point on, so no output there depends on them.
            outputs.map(|(index, _)| index).try_for_each(|index| unknown(xml, index, ""))
        })?;
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

/// Indices of the inputs and parameters whose names begin so.
fn known<M: Model>(names: &[&str]) -> String {
    let indices: Vec<String> = indexed::<M>()
        .filter(|(_, variable)| matches!(variable.role, Role::Input(_) | Role::Parameter { .. }))
        .filter(|(_, variable)| names.iter().any(|name| variable.name.starts_with(name)))
        .map(|(index, _)| index.to_string())
        .collect();
    indices.join(" ")
}
