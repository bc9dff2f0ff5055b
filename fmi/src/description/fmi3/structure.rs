//! `ModelStructure`

use std::collections::BTreeSet;
use std::io;

use super::variables::elements;
use crate::description::dependencies::{feed_through, initial};
use crate::description::document::{Xml, empty};
use crate::layout::{Content, Entry, Layout};
use crate::model::Model;
use crate::variables::{Role, ValueReference, Variable};

pub(super) fn write<M: Model>(xml: &mut Xml, layout: &Layout) -> io::Result<()> {
    xml.create_element("ModelStructure").write_inner_content(|xml| {
        let entries = layout.entries();
        let is_output = |variable: &Variable<M>| matches!(variable.role, Role::Output { .. });
        let is_derivative = |variable: &Variable<M>| matches!(variable.role, Role::Derivative { .. });
        unknowns(xml, "Output", layout, |variable| is_output(variable).then(|| feed_through(variable)))?;
        unknowns(xml, "ContinuousStateDerivative", layout, |variable| {
            is_derivative(variable).then(|| feed_through(variable))
        })?;
        unknowns::<M>(xml, "InitialUnknown", layout, initial)?;
        entries.iter().filter(|entry| entry.content == Content::EventIndicators).try_for_each(|entry| {
            empty(xml, "EventIndicator", &vec![("valueReference", entry.reference.to_string())])
        })
    })?;
    Ok(())
}

/// The variables for which there are dependencies. An array depends on what its elements depend on.
fn unknowns<M: Model>(
    xml: &mut Xml,
    name: &str,
    layout: &Layout,
    dependencies: impl Fn(&Variable<M>) -> Option<Vec<ValueReference>>,
) -> io::Result<()> {
    let known = |entry: &Entry| -> Option<Vec<ValueReference>> {
        let elements: Option<Vec<_>> = elements::<M>(entry).into_iter().map(&dependencies).collect();
        elements.filter(|elements| !elements.is_empty()).map(|elements| elements.concat())
    };
    for entry in layout.entries() {
        if let Some(known) = known(entry) {
            // By increasing reference, each once: elements of an array count as the array.
            let whole: BTreeSet<ValueReference> =
                known.iter().filter_map(|&reference| layout.whole(reference)).collect();
            let whole: Vec<String> = whole.iter().map(ToString::to_string).collect();
            let reference = entry.reference.to_string();
            empty(xml, name, &vec![("valueReference", reference), ("dependencies", whole.join(" "))])?;
        }
    }
    Ok(())
}
