//! Enumerations as plain integers, for importers that know no enumerations.

use serde::{Deserialize, Serialize};

use crate::model::Model;
use crate::snapshot::SettingsOf;
use crate::variables::{Field, Role, Value, ValueReference, Variable, named, variable};

/// An enumeration that an importer has chosen by a number instead. While it is there, what is set by name waits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct ChosenNumber {
    /// The variable with the number.
    pub reference: ValueReference,
    /// Number of the item, from 1.
    pub number: i32,
    /// The item that counts again when the number is 0.
    pub otherwise: i32,
}

/// The enumeration with this name: its place in the parameters.
fn enumeration<M: Model>(name: &str) -> Option<&'static Field<M::Parameters>> {
    match &named::<M>(name)?.1.role {
        Role::Parameter { field, .. } => Some(field),
        _ => None,
    }
}

/// Name of the enumeration that the variable with this reference is the number of.
fn enumeration_of<M: Model>(number: ValueReference) -> Option<&'static str> {
    match variable::<M>(number).ok()?.role {
        Role::Number { of } => Some(of),
        _ => None,
    }
}

/// Sets the number of an enumeration; 0 gives it back to its name.
pub(crate) fn set_number<M: Model>(
    settings: &mut SettingsOf<M>,
    reference: ValueReference,
    of: &str,
    number: i32,
) {
    let Some(field) = enumeration::<M>(of) else { return };
    let there = settings.numbers.iter().position(|chosen| chosen.reference == reference);
    let otherwise = match (there, field.get(&settings.parameters)) {
        (Some(place), _) => settings.numbers.remove(place).otherwise,
        (None, Value::Integer(item)) => item,
        (None, _) => return,
    };
    if number == 0 {
        field.set(&mut settings.parameters, Value::Integer(otherwise));
    } else {
        field.set(&mut settings.parameters, Value::Integer(number));
        settings.numbers.push(ChosenNumber { reference, number, otherwise });
    }
}

/// Sets a parameter. An enumeration that has been chosen by number keeps this item for later.
pub(crate) fn set_parameter<M: Model>(
    settings: &mut SettingsOf<M>,
    variable: &Variable<M>,
    field: &Field<M::Parameters>,
    value: Value,
) {
    let of_this = |chosen: &&mut ChosenNumber| enumeration_of::<M>(chosen.reference) == Some(variable.name);
    match (settings.numbers.iter_mut().find(of_this), value) {
        (Some(chosen), Value::Integer(item)) => chosen.otherwise = item,
        _ => field.set(&mut settings.parameters, value),
    }
}

/// The number that was set: 0 if there is none.
pub(crate) fn number<M: Model>(settings: &SettingsOf<M>, reference: ValueReference) -> i32 {
    let chosen = settings.numbers.iter().find(|chosen| chosen.reference == reference);
    chosen.map_or(0, |chosen| chosen.number)
}

/// Whether an instance can have these numbers: each belongs to an enumeration, once, and is what that has.
pub(crate) fn are_consistent<M: Model>(settings: &SettingsOf<M>) -> bool {
    settings.numbers.iter().enumerate().all(|(place, chosen)| {
        let Some(of) = enumeration_of::<M>(chosen.reference) else { return false };
        let Some(field) = enumeration::<M>(of) else { return false };
        let items = field.choice().map_or(0, |choice| choice.items.len());
        let is_item = |item: i32| usize::try_from(item).is_ok_and(|item| (1..=items).contains(&item));
        let once = settings.numbers[..place].iter().all(|other| other.reference != chosen.reference);
        let present = field.get(&settings.parameters) == Value::Integer(chosen.number);
        once && present && is_item(chosen.number) && is_item(chosen.otherwise)
    })
}
