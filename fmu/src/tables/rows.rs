//! Outputs of each kind.

use fmi::Model;
use fmi::variables::{Choice, Quantity, Role, Signal, Variable};

/// A real output.
pub(crate) const fn output<M: Model>(
    name: &'static str,
    quantity: &'static Quantity,
    initially_depends_on: &'static [&'static str],
    get: fn(&M::Outputs) -> f64,
    description: &'static str,
) -> Variable<M> {
    let signal = Signal::Real { quantity, minimum: None, maximum: None, get };
    Variable::output(name, description, initially_depends_on, signal)
}

/// A figure of a controller's last step: known from its first sample on.
const fn figure<M: Model>(
    name: &'static str,
    signal: Signal<M::Outputs>,
    description: &'static str,
) -> Variable<M> {
    Variable::output(name, description, &[], signal)
}

/// A count of a controller's last step.
pub(crate) const fn count<M: Model>(
    name: &'static str,
    get: fn(&M::Outputs) -> u32,
    description: &'static str,
) -> Variable<M> {
    figure(name, Signal::Count { get }, description)
}

/// One of several outcomes of a controller's last step.
pub(crate) const fn outcome<M: Model>(
    name: &'static str,
    choice: Choice,
    get: fn(&M::Outputs) -> i32,
    description: &'static str,
) -> Variable<M> {
    figure(name, Signal::Enumeration { choice, get }, description)
}

/// The same output, within [minimum, maximum].
pub(crate) const fn within<M: Model>(mut output: Variable<M>, minimum: f64, maximum: f64) -> Variable<M> {
    if let Role::Output { signal: Signal::Real { maximum: most, .. }, .. } = &mut output.role {
        *most = Some(maximum);
    }
    at_least(output, minimum)
}

/// The same output, not below a minimum.
pub(crate) const fn at_least<M: Model>(mut output: Variable<M>, minimum: f64) -> Variable<M> {
    if let Role::Output { signal: Signal::Real { minimum: least, .. }, .. } = &mut output.role {
        *least = Some(minimum);
    }
    output
}

/// A real input within ±limit of a model `M`, at a field of a part of its inputs that two methods of theirs lead to.
macro_rules! symmetric_input {
    ($part:ident, $part_mut:ident, $name:literal, $quantity:ident, $limit:literal, $($field:ident).+, $description:literal) => {
        Variable::input(
            $name,
            $description,
            Field::Real {
                quantity: &$quantity,
                minimum: -$limit,
                maximum: $limit,
                get: |inputs: &M::Inputs| inputs.$part().$($field).+,
                set: |inputs: &mut M::Inputs, value| inputs.$part_mut().$($field).+ = value,
            },
        )
    };
}
pub(super) use symmetric_input;
