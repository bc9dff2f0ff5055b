//! The allowed values of a variable, for a person who has given another one.

use super::{Choice, Quantity, Value, Variable};
use crate::model::Model;

impl<M: Model> Variable<M> {
    /// A value with its unit: "0.5 rad".
    pub(super) fn with_unit(&self, value: Value) -> String {
        match self.quantity().and_then(|quantity| quantity.unit) {
            Some(unit) => format!("{value} {}", unit.name),
            None => value.to_string(),
        }
    }

    /// The allowed values between `minimum` and `maximum`: "0.05 to 1.2 rad (2.9 to 68.8 deg)", "1 (lmpc), 2 (ssmpc)".
    pub(super) fn allowed(&self, minimum: Value, maximum: Value) -> String {
        if let Some(choice) = self.choice() {
            return items(choice);
        }
        let range = format!("{minimum} to {}", self.with_unit(maximum));
        match (self.quantity().and_then(displayed), minimum, maximum) {
            (Some((unit, factor)), Value::Real(minimum), Value::Real(maximum)) => {
                format!("{range} ({:.1} to {:.1} {unit})", factor * minimum, factor * maximum)
            }
            _ => range,
        }
    }
}

fn items(choice: &Choice) -> String {
    let named = (1..).zip(choice.items).map(|(number, (name, _)): (i32, _)| format!("{number} ({name})"));
    named.collect::<Vec<_>>().join(", ")
}

/// The display unit of a quantity, and how many of them make one unit.
fn displayed(quantity: &Quantity) -> Option<(&'static str, f64)> {
    let wanted = quantity.display_unit?;
    quantity.unit?.display.iter().copied().find(|(name, _)| *name == wanted)
}
