//! `TypeDefinitions`

use std::io;

use crate::description::document::Xml;
use crate::description::units::choices;
use crate::model::Model;
use crate::variables::{Choice, Quantity};

pub(super) fn write<M: Model>(xml: &mut Xml, quantities: &[&Quantity]) -> io::Result<()> {
    xml.create_element("TypeDefinitions").write_inner_content(|xml| {
        quantities.iter().try_for_each(|quantity| simple_type(xml, quantity))?;
        choices::<M>().into_iter().try_for_each(|choice| enumeration(xml, choice))
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
