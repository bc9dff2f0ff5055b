//! Everything about a flight that does not change while it lasts: the settings, their table, and their checks.

pub(crate) mod error;
pub(crate) mod for_airframe;
pub(crate) mod nearest_name;
pub(crate) mod parameter;
pub(crate) mod parameters;
pub(crate) mod quantity;
mod remedy;
pub(crate) mod resolved;
pub(crate) mod settings;
pub(crate) mod unit;
pub(crate) mod validation;
