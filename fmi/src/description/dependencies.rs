//! What outputs and derivatives depend on.

use crate::continuous::state_place;
use crate::model::Model;
use crate::variables::{Role, ValueReference, Variable, variables};

/// The inputs and states that an output or a derivative depends on at the same instant. Without equations inputs act from a
/// communication point on, so that no output there depends on them.
pub(super) fn feed_through<M: Model>(unknown: &Variable<M>) -> Vec<ValueReference> {
    let names = M::CONTINUOUS.map_or(&[][..], |equations| equations.dependencies(unknown.name));
    references::<M>(names, |variable| {
        matches!(variable.role, Role::Input(_)) || state_place(variable).is_some()
    })
}

/// The inputs and parameters that the initial value of an unknown depends on; `None` if it is not an unknown.
pub(super) fn initial<M: Model>(unknown: &Variable<M>) -> Option<Vec<ValueReference>> {
    let names = unknown.initially_depends_on()?;
    Some(references::<M>(names, |variable| {
        matches!(variable.role, Role::Input(_) | Role::Parameter { .. } | Role::Number { .. })
    }))
}

/// The variables of a kind whose names begin so.
fn references<M: Model>(names: &[&str], is_of_kind: impl Fn(&Variable<M>) -> bool) -> Vec<ValueReference> {
    variables::<M>()
        .filter(|(_, variable)| is_of_kind(variable))
        .filter(|(_, variable)| names.iter().any(|name| variable.name.starts_with(name)))
        .map(|(reference, _)| reference)
        .collect()
}
