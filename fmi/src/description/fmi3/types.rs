//! `TypeDefinitions`

use std::io;

use crate::description::document::{Xml, empty};
use crate::description::units::choices;
use crate::model::Model;
use crate::variables::{Choice, Quantity};

pub(super) fn write<M: Model>(xml: &mut Xml, quantities: &[&Quantity]) -> io::Result<()> {
    let choices = choices::<M>();
    if quantities.is_empty() && choices.is_empty() {
        return Ok(());
    }
    xml.create_element("TypeDefinitions").write_inner_content(|xml| {
        quantities.iter().try_for_each(|quantity| float64_type(xml, quantity))?;
        choices.into_iter().try_for_each(|choice| enumeration_type(xml, choice))
    })?;
    Ok(())
}

fn float64_type(xml: &mut Xml, definition: &Quantity) -> io::Result<()> {
    let mut attributes = vec![
        ("name", definition.name.to_owned()),
        ("description", definition.description.to_owned()),
        ("quantity", definition.name.to_owned()),
    ];
    attributes.extend(definition.unit.map(|unit| ("unit", unit.name.to_owned())));
    attributes.extend(definition.display_unit.map(|unit| ("displayUnit", unit.to_owned())));
    empty(xml, "Float64Type", &attributes)
}

fn enumeration_type(xml: &mut Xml, choice: &Choice) -> io::Result<()> {
    let names = [("name", choice.name), ("description", choice.description)];
    xml.create_element("EnumerationType").with_attributes(names).write_inner_content(|xml| {
        (1..).zip(choice.items).try_for_each(|(value, (name, description)): (u32, _)| {
            let (name, description) = ((*name).to_owned(), (*description).to_owned());
            empty(
                xml,
                "Item",
                &vec![("name", name), ("value", value.to_string()), ("description", description)],
            )
        })
    })?;
    Ok(())
}
