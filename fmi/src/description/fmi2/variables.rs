//! `ModelVariables`

use std::io;

use crate::description::document::{Xml, empty};
use crate::description::numbers::{initial, nominal, real, text};
use crate::model::Model;
use crate::variables::{Role, ValueReference, Variable, named, variables};

pub(super) fn write<M: Model>(xml: &mut Xml) -> io::Result<()> {
    xml.create_element("ModelVariables").write_inner_content(|xml| {
        variables::<M>().try_for_each(|(reference, variable)| scalar_variable(xml, reference, variable))
    })?;
    Ok(())
}

fn scalar_variable<M: Model>(
    xml: &mut Xml,
    reference: ValueReference,
    variable: &Variable<M>,
) -> io::Result<()> {
    let mut element = xml.create_element("ScalarVariable").with_attributes([
        ("name", variable.name),
        ("valueReference", reference.to_string().as_str()),
        ("description", variable.description),
        ("causality", variable.causality()),
        ("variability", variable.variability()),
    ]);
    if let Some(initial) = initial(variable) {
        element = element.with_attribute(("initial", initial));
    }
    element.write_inner_content(|xml| value_element(xml, variable))?;
    Ok(())
}

fn value_element<M: Model>(xml: &mut Xml, variable: &Variable<M>) -> io::Result<()> {
    let mut attributes = Vec::new();
    if let Some(quantity) = variable.quantity() {
        attributes.push(("declaredType", quantity.name.to_owned()));
        // The unit is written again: not every importer follows declaredType.
        attributes.extend(quantity.unit.map(|unit| ("unit", unit.name.to_owned())));
        attributes.extend(quantity.display_unit.map(|unit| ("displayUnit", unit.to_owned())));
    }
    if let Role::Derivative { of, .. } = variable.role {
        // Indices in the description count from 1.
        attributes.extend(named::<M>(of).map(|(state, _)| ("derivative", (state + 1).to_string())));
    }
    attributes.extend(variable.choice().map(|choice| ("declaredType", choice.name.to_owned())));
    let (minimum, maximum) = variable.range();
    attributes.extend(minimum.map(|value| ("min", text(value))));
    attributes.extend(maximum.map(|value| ("max", text(value))));
    attributes.extend(nominal(variable).map(|nominal| ("nominal", real(nominal))));
    attributes.extend(variable.start().map(|value| ("start", text(value))));
    empty(xml, variable.value_type().name(), &attributes)
}
