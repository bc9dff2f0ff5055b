//! Values of parameters that have names.

use std::fmt::{self, Display, Formatter};

/// A value that has a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NamedValue {
    /// The value.
    pub value: i32,
    /// Its name.
    pub name: &'static str,
    /// What it means, if the name alone does not say that.
    pub meaning: Option<&'static str>,
}

/// Values of a switch.
pub(super) const SWITCH: [NamedValue; 2] = [NamedValue::new(0, "Off"), NamedValue::new(1, "On")];

impl NamedValue {
    /// A value whose name says all.
    pub const fn new(value: i32, name: &'static str) -> Self {
        Self { value, name, meaning: None }
    }

    /// Whether a text names it. Case does not count, and spaces, hyphens and underscores are alike.
    pub fn is_named(&self, text: &str) -> bool {
        let plain = |text: &str| text.to_lowercase().replace(['-', '_'], " ");
        plain(self.name) == plain(text)
    }
}

impl Display for NamedValue {
    fn fmt(&self, to: &mut Formatter<'_>) -> fmt::Result {
        match self.meaning {
            Some(meaning) => write!(to, "{}: {meaning}", self.name),
            None => to.write_str(self.name),
        }
    }
}
