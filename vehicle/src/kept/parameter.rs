//! One parameter of PX4 or ArduPilot that is kept, and changes nothing here.

/// Whose parameter it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Owner {
    /// PX4's: it is there unless the vehicle presents itself as ArduPilot.
    Px4,
    /// ArduPilot's.
    ArduPilot,
}

/// A parameter that scripts set and ground stations show, without anything here that it could change. Its text says so.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KeptParameter {
    /// Whose it is.
    pub owner: Owner,
    /// Its name.
    pub id: &'static str,
    /// Its value until it is set: the original's.
    pub default: f32,
    /// Smallest value.
    pub minimum: f64,
    /// Largest value.
    pub maximum: f64,
    /// Whether only whole numbers are allowed.
    pub integer: bool,
    /// Its unit.
    pub unit: &'static str,
    /// What it is where it has an effect.
    pub text: &'static str,
    /// Why it has none here.
    pub reason: &'static str,
}

/// Rows of a table: an owner, a reason, then the parameters that it holds for: `id, default, range, unit, text`, whole numbers
/// behind `whole`.
macro_rules! kept {
    ($owner:ident, $reason:literal, real [$($real:tt),* $(,)?], whole [$($whole:tt),* $(,)?]) => {
        &[
            $(kept!(@row $owner, $reason, false, $real),)*
            $(kept!(@row $owner, $reason, true, $whole),)*
        ]
    };
    (@row $owner:ident, $reason:literal, $integer:literal, ($id:literal, $default:literal, $minimum:literal..=$maximum:literal, $unit:literal, $text:literal)) => {
        $crate::kept::KeptParameter {
            owner: $crate::kept::Owner::$owner,
            id: $id,
            default: $default as f32,
            minimum: $minimum as f64,
            maximum: $maximum as f64,
            integer: $integer,
            unit: $unit,
            text: $text,
            reason: $reason,
        }
    };
}

pub(super) use kept;
