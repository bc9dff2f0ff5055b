//! Units and simple types of quantities and enumerations.

use std::io;

use super::Xml;
use crate::model::Model;
use crate::variables::{Choice, Quantity, Unit, Variable, variables};

pub(super) fn write<M: Model>(xml: &mut Xml) -> io::Result<()> {
    let quantities = quantities::<M>();
    xml.create_element("UnitDefinitions")
        .write_inner_content(|xml| units(&quantities).into_iter().try_for_each(|u| unit(xml, u)))?;
    xml.create_element("TypeDefinitions").write_inner_content(|xml| {
        quantities.iter().try_for_each(|quantity| simple_type(xml, quantity))?;
        choices::<M>().into_iter().try_for_each(|choice| enumeration(xml, choice))
    })?;
    Ok(())
}

/// Those that the model lists, and then those of its variables; each once.
fn quantities<M: Model>() -> Vec<&'static Quantity> {
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
fn units(quantities: &[&Quantity]) -> Vec<&'static Unit> {
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

fn simple_type(xml: &mut Xml, definition: &Quantity) -> io::Result<()> {
    let names = [("name", definition.name), ("description", definition.description)];
    xml.create_element("SimpleType").with_attributes(names).write_inner_content(|xml| {
        let mut real = xml.create_element("Real").with_attribute(("quantity", definition.name));
        if let Some(unit) = definition.unit {
            real = real.with_attribute(("unit", unit.name));
        }
        if let Some(unit) = definition.display_unit {
            real = real.with_attribute(("displayUnit", unit));
        }
        real.write_empty()?;
        Ok(())
    })?;
    Ok(())
}

/// Everything that is chosen from, once each.
fn choices<M: Model>() -> Vec<&'static Choice> {
    let tabled = variables::<M>().map(|(_, variable)| variable);
    let mut choices: Vec<&Choice> = tabled.filter_map(Variable::choice).collect();
    choices.sort_by_key(|choice| choice.name);
    choices.dedup_by_key(|choice| choice.name);
    choices
}

fn enumeration(xml: &mut Xml, choice: &Choice) -> io::Result<()> {
    let names = [("name", choice.name), ("description", choice.description)];
    xml.create_element("SimpleType").with_attributes(names).write_inner_content(|xml| {
        xml.create_element("Enumeration").write_inner_content(|xml| {
            for (value, (name, description)) in (1..).zip(choice.items) {
                xml.create_element("Item")
                    .with_attributes([
                        ("name", *name),
                        ("value", i32::to_string(&value).as_str()),
                        ("description", *description),
                    ])
                    .write_empty()?;
            }
            Ok(())
        })?;
        Ok(())
    })?;
    Ok(())
}
