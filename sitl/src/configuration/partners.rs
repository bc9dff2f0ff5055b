//! Flags that mean nothing without another.

use super::Arguments;
use crate::failure::Failure;

/// Refuses what would be ignored in a run of so many vehicles.
///
/// # Errors
/// [`Failure::Value`] that names the flag and what it needs.
pub fn check(arguments: &Arguments, vehicles: usize) -> Result<(), Failure> {
    let waits = arguments.lockstep.is_some();
    let (logs, tlog) = (arguments.log_dir.is_some(), arguments.tlog.is_some());
    let lone = [
        ("--lockstep-period", arguments.lockstep_period.is_some(), "--lockstep", waits),
        ("--lockstep-timeout", arguments.lockstep_timeout.is_some(), "--lockstep", waits),
        ("--ftp-write", arguments.ftp_write == Some(true), "--ftp-root", arguments.ftp_root.is_some()),
        ("--record-size", arguments.record_size.is_some(), "--record", arguments.record.is_some()),
        ("--log-start", arguments.log_start.is_some(), "--log-dir", logs),
        ("--log-size", arguments.log_size.is_some(), "--log-dir or --tlog", logs || tlog),
        ("--log-count", arguments.log_count.is_some(), "--log-dir or --tlog", logs || tlog),
        ("--hil-mount", arguments.hil_mount.is_some(), "--hil", arguments.hil.is_some()),
        ("--traffic fleet", arguments.sees_fleet(), "--vehicles 2 or more", vehicles > 1),
    ]
    .into_iter()
    .find(|(_, given, _, has_partner)| *given && !has_partner);
    match lone {
        None => Ok(()),
        Some((name, _, partner, _)) => {
            Err(Failure::Value { name: name.to_owned(), reason: format!("needs {partner}") })
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::{Arguments, check};

    fn refusal(flags: &[&str], vehicles: usize) -> Option<String> {
        let line = ["lmpc-sitl"].iter().chain(flags);
        let arguments = Arguments::try_parse_from(line).expect("flags");
        check(&arguments, vehicles).err().map(|failure| failure.to_string())
    }

    #[test]
    fn a_flag_without_its_partner_is_refused_and_with_it_taken() {
        for (flag, partner, told) in [
            ("--lockstep-period=0.1", "--lockstep=always", "--lockstep-period: needs --lockstep"),
            ("--lockstep-timeout=1", "--lockstep=always", "--lockstep-timeout: needs --lockstep"),
            ("--ftp-write", "--ftp-root=files", "--ftp-write: needs --ftp-root"),
            ("--record-size=1", "--record=a", "--record-size: needs --record"),
            ("--log-start=boot", "--log-dir=logs", "--log-start: needs --log-dir"),
            ("--log-size=1", "--tlog=a.tlog", "--log-size: needs --log-dir or --tlog"),
            ("--log-count=1", "--log-dir=logs", "--log-count: needs --log-dir or --tlog"),
            ("--hil-mount=plus", "--hil=4560", "--hil-mount: needs --hil"),
        ] {
            assert_eq!(refusal(&[flag], 1).as_deref(), Some(told));
            assert_eq!(refusal(&[flag, partner], 1), None, "{flag}");
        }
        let told = "--traffic fleet: needs --vehicles 2 or more";
        assert_eq!(refusal(&["--traffic=fleet"], 1).as_deref(), Some(told));
        assert_eq!(refusal(&["--traffic=fleet"], 2), None);
    }
}
