//! Units, quantities and enumerations of a model.

use std::io;

use super::document::Xml;
use crate::model::Model;
use crate::variables::{Choice, Quantity, Unit, Variable, variables};

/// `UnitDefinitions`
pub(super) fn write(xml: &mut Xml, units: &[&Unit]) -> io::Result<()> {
    xml.create_element("UnitDefinitions")
        .write_inner_content(|xml| units.iter().try_for_each(|definition| unit(xml, definition)))?;
    Ok(())
}

/// Those that the model lists, and then those of its variables; each once.
pub(super) fn quantities<M: Model>() -> Vec<&'static Quantity> {
    let used = variables::<M>().filter_map(|(_, variable)| variable.quantity());
    let mut quantities: Vec<&Quantity> = Vec::new();
    for quantity in M::QUANTITIES.iter().copied().chain(used) {
        if quantities.iter().all(|known| known.name != quantity.name) {
            quantities.push(quantity);
        }
    }
    quantities
}

/// The units of the quantities, each once.
pub(super) fn units(quantities: &[&Quantity]) -> Vec<&'static Unit> {
    let mut units: Vec<&Unit> = Vec::new();
    for unit in quantities.iter().filter_map(|quantity| quantity.unit) {
        if units.iter().all(|known| known.name != unit.name) {
            units.push(unit);
        }
    }
    units
}

fn unit(xml: &mut Xml, unit: &Unit) -> io::Result<()> {
    xml.create_element("Unit").with_attribute(("name", unit.name)).write_inner_content(|xml| {
        xml.create_element("BaseUnit").with_attributes(unit.base.iter().copied()).write_empty()?;
        for (name, factor) in unit.display {
            xml.create_element("DisplayUnit")
                .with_attributes([("name", *name), ("factor", &factor.to_string())])
                .write_empty()?;
        }
        Ok(())
    })?;
    Ok(())
}

/// Everything that is chosen from, once each.
pub(super) fn choices<M: Model>() -> Vec<&'static Choice> {
    let tabled = variables::<M>().map(|(_, variable)| variable);
    let mut choices: Vec<&Choice> = tabled.filter_map(Variable::choice).collect();
    choices.sort_by_key(|choice| choice.name);
    choices.dedup_by_key(|choice| choice.name);
    choices
}
