//! Why a parameter keeps its value.

use crate::ChangeError;

/// Why a parameter was not changed. Nothing has changed then. Names are those that were asked for.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SetError {
    /// There is none of this name.
    #[error("unknown parameter {name}{}", similar.map(|known| format!("; did you mean {known}?")).unwrap_or_default())]
    Unknown {
        /// Name asked for.
        name: String,
        /// The one that may be meant.
        similar: Option<&'static str>,
    },
    /// It cannot have this value.
    #[error("{name} = {value}; allowed {allowed}")]
    NotAllowed {
        /// Name asked for.
        name: String,
        /// Given value with its unit.
        value: String,
        /// Values that it can have, for a person.
        allowed: String,
    },
    /// It is set at the start.
    #[error("{0} is read-only: restart with --system-id")]
    ReadOnly(String),
    /// The vehicle counts it.
    #[error("{0} is counted by the vehicle (read-only); set STAT_RESET to 0 to begin anew")]
    Counted(String),
    /// It follows from other parameters.
    #[error("{0} is calculated from mass and rotors (read-only); set those instead")]
    Calculated(String),
    /// The closed loop cannot fly with it.
    #[error("{}", refusal(name, source))]
    Refused {
        /// Name asked for.
        name: String,
        /// Why.
        source: Box<ChangeError>,
    },
}

/// Why the closed loop refuses a parameter. Mostly the reason begins with its name.
fn refusal(name: &str, reason: &ChangeError) -> String {
    let reason = reason.to_string();
    let named = reason.strip_prefix(name).is_some_and(|rest| rest.starts_with(' '));
    if named { reason } else { format!("{name}: {reason}") }
}

impl SetError {
    /// The closed loop refuses the value of a parameter.
    pub fn refused(name: &str, source: impl Into<ChangeError>) -> Self {
        Self::Refused { name: name.to_owned(), source: Box::new(source.into()) }
    }
}
