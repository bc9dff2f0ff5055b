//! The allowed values of a variable, for a person who has given another one.

use super::{Choice, Quantity, Variable};
use crate::model::Model;

impl<M: Model> Variable<M> {
    /// A number with its unit, and the numbers from `minimum` to `maximum`: "45 rad", "0.05 to 1.2 rad (2.9 to 68.8 deg)".
    pub(crate) fn out_of_range(&self, value: f64, minimum: f64, maximum: f64) -> (String, String) {
        let quantity = self.quantity();
        let unit = quantity
            .and_then(|quantity| quantity.unit)
            .map_or(String::new(), |unit| format!(" {}", unit.name));
        let mut allowed = format!("{} to {}{unit}", short(minimum), short(maximum));
        if let Some((unit, factor)) = quantity.and_then(displayed) {
            allowed += &format!(" ({:.1} to {:.1} {unit})", factor * minimum, factor * maximum);
        }
        (format!("{}{unit}", short(value)), allowed)
    }
}

/// A number in the fewest digits that read back as the same.
fn short(number: f64) -> String {
    let digits = format!("{number:?}");
    digits.strip_suffix(".0").map_or(digits.clone(), str::to_owned)
}

/// The items of an enumeration: "1 (lmpc), 2 (ssmpc)".
pub(super) fn items(choice: &Choice) -> String {
    let named = (1..).zip(choice.items).map(|(number, (name, _)): (i32, _)| format!("{number} ({name})"));
    named.collect::<Vec<_>>().join(", ")
}

/// The display unit of a quantity, and how many of them make one unit.
fn displayed(quantity: &Quantity) -> Option<(&'static str, f64)> {
    let wanted = quantity.display_unit?;
    quantity.unit?.display.iter().copied().find(|(name, _)| *name == wanted)
}
