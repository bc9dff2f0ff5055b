//! `ModelStructure`

use std::io;

use crate::continuous::state_count;
use crate::description::dependencies::{feed_through, initial};
use crate::description::document::{Xml, empty};
use crate::model::Model;
use crate::variables::{Role, ValueReference, variables};

pub(super) fn write<M: Model>(xml: &mut Xml) -> io::Result<()> {
    xml.create_element("ModelStructure").write_inner_content(|xml| {
        xml.create_element("Outputs").write_inner_content(|xml| {
            let mut outputs =
                variables::<M>().filter(|(_, variable)| matches!(variable.role, Role::Output { .. }));
            outputs.try_for_each(|(reference, variable)| unknown(xml, reference, &feed_through(variable)))
        })?;
        if state_count::<M>() > 0 {
            xml.create_element("Derivatives").write_inner_content(|xml| {
                let mut derivatives =
                    variables::<M>().filter(|(_, variable)| matches!(variable.role, Role::Derivative { .. }));
                derivatives
                    .try_for_each(|(reference, variable)| unknown(xml, reference, &feed_through(variable)))
            })?;
        }
        xml.create_element("InitialUnknowns").write_inner_content(|xml| {
            variables::<M>()
                .filter_map(|(reference, variable)| Some((reference, initial(variable)?)))
                .try_for_each(|(reference, dependencies)| unknown(xml, reference, &dependencies))
        })?;
        Ok(())
    })?;
    Ok(())
}

/// An unknown with what it depends on. Indices in the description count from 1.
fn unknown(xml: &mut Xml, reference: ValueReference, dependencies: &[ValueReference]) -> io::Result<()> {
    let index = |reference: &ValueReference| (reference + 1).to_string();
    let dependencies: Vec<String> = dependencies.iter().map(index).collect();
    empty(xml, "Unknown", &vec![("index", index(&reference)), ("dependencies", dependencies.join(" "))])
}
