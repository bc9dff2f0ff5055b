//! What is told for one vehicle of several: `ID:` in front of it names its system.

use std::ffi::OsString;
use std::fmt::Display;
use std::path::PathBuf;
use std::str::FromStr;

use vehicle::fault::ScheduledFault;

use crate::failure::Failure;

/// A value, and the system that it is for.
#[derive(Clone, Debug, PartialEq)]
pub struct Addressed<T> {
    /// `None`: all of them.
    pub system_id: Option<u8>,
    /// The value.
    pub value: T,
}

/// A system's number and the rest, if there is one.
fn split(text: &str) -> Option<(u8, &str)> {
    let (id, rest) = text.split_once(':')?;
    id.parse().ok().map(|id| (id, rest)).filter(|_| !rest.is_empty())
}

impl Addressed<PathBuf> {
    /// A path, with a system's id in front if it is for one system. Any path is one: it need not be text.
    pub fn of_path(given: OsString) -> Self {
        match given.to_str().map(split) {
            Some(Some((id, file))) => Self { system_id: Some(id), value: file.into() },
            Some(None) => Self { system_id: None, value: given.into() },
            None => Self::of_bytes(given),
        }
    }

    /// The same for a path that is not UTF-8.
    #[cfg(unix)]
    fn of_bytes(given: OsString) -> Self {
        use std::os::unix::ffi::{OsStrExt, OsStringExt};
        let bytes = given.as_bytes();
        let end = bytes.iter().position(|byte| *byte == b':');
        let own = end.and_then(|end| Some((bytes.get(..end)?, bytes.get(end + 1..)?)));
        let own =
            own.and_then(|(id, file)| Some((std::str::from_utf8(id).ok()?.parse().ok()?, file.to_vec())));
        match own.filter(|(_, file)| !file.is_empty()) {
            Some((id, file)) => Self { system_id: Some(id), value: OsString::from_vec(file).into() },
            None => Self { system_id: None, value: given.into() },
        }
    }

    #[cfg(not(unix))]
    fn of_bytes(given: OsString) -> Self {
        Self { system_id: None, value: given.into() }
    }
}

impl FromStr for Addressed<ScheduledFault> {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        // Whole seconds look like an id: it is one if seconds follow it.
        let head = text.split('=').next().unwrap_or_default();
        let own = split(text).filter(|_| head.matches(':').count() > 1);
        let (system_id, fault) = own.map_or((None, text), |(id, fault)| (Some(id), fault));
        Ok(Self { system_id, value: fault.parse()? })
    }
}

impl<T> Addressed<T> {
    /// Whether it is for a system.
    pub fn is_for(&self, system_id: u8) -> bool {
        self.system_id.is_none_or(|id| id == system_id)
    }

    /// Refuses what is for a system that there is not.
    pub(super) fn check(&self, name: &str, value: impl Display, systems: &[u8]) -> Result<(), Failure> {
        let Some(id) = self.system_id.filter(|id| !systems.contains(id)) else { return Ok(()) };
        let there = match systems {
            [first, .., last] => format!("{first} to {last}"),
            other => other.iter().map(u8::to_string).collect(),
        };
        let reason = format!("`{id}:{value}`: there is no system {id}; the systems of this run are {there}");
        Err(Failure::Value { name: name.to_owned(), reason })
    }
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::{Addressed, ScheduledFault};

    #[cfg(unix)]
    #[test]
    fn a_path_need_not_be_text() {
        use std::ffi::OsString;
        use std::os::unix::ffi::OsStringExt;
        for (given, system_id, file) in [
            (&b"h\xf6he.plan"[..], None, &b"h\xf6he.plan"[..]),
            (b"3:h\xf6he", Some(3), b"h\xf6he"),
            (b"x:\xff", None, b"x:\xff"),
        ] {
            let value = OsString::from_vec(file.to_vec()).into();
            assert_eq!(
                Addressed::of_path(OsString::from_vec(given.to_vec())),
                Addressed { system_id, value }
            );
        }
    }

    #[test]
    fn ids_are_told_from_drives_and_seconds() {
        for (text, system_id, file) in [
            ("flight.plan", None, "flight.plan"),
            ("3:flight.plan", Some(3), "flight.plan"),
            ("C:flight.plan", None, "C:flight.plan"),
            ("300:flight.plan", None, "300:flight.plan"),
        ] {
            assert_eq!(
                Addressed::of_path(text.into()),
                Addressed::<PathBuf> { system_id, value: file.into() }
            );
        }
        for (text, system_id, fault) in [
            ("12:rotor1=weak:0.5", None, "12:rotor1=weak:0.5"),
            ("2:12:rotor1=weak:0.5", Some(2), "12:rotor1=weak:0.5"),
        ] {
            let value: ScheduledFault = fault.parse().expect("a fault");
            assert_eq!(text.parse(), Ok(Addressed { system_id, value }));
        }
    }
}
