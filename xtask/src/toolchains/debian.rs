//! Packages of Debian and Ubuntu.

use std::path::Path;
use std::process::{Command, Stdio};

use crate::progress::Progress;
use xtask::failure::Failure;
use xtask::files;
use xtask::process;

use super::machine;

/// Whether packages can be installed here: there is apt, and this is root.
pub fn can_install() -> bool {
    let root = Command::new("id").arg("-u").stderr(Stdio::null()).output();
    machine::find("apt-get").is_some() && root.is_ok_and(|output| output.stdout.trim_ascii() == b"0")
}

/// Installs packages, after saying which. None is removed for them.
pub fn install(progress: &Progress, packages: &[&str]) -> Result<(), Failure> {
    let what = format!("Installing Debian packages: {}", packages.join(" "));
    progress.timed(&what, || {
        apt(&["update", "--quiet=2"], &[])?;
        apt(&["install", "--quiet=2", "--yes", "--no-install-recommends", "--no-remove"], packages)
    })
}

/// Unpacks packages below a folder, which changes nothing of the system, after saying which.
pub fn unpack(progress: &Progress, packages: &[&str], folder: &Path) -> Result<(), Failure> {
    let archives = folder.join("archives");
    files::create_folder(&archives)?;
    progress.timed(&format!("Unpacking Debian packages: {}", packages.join(" ")), || {
        let mut download = Command::new("apt-get");
        // Its own user may not write here.
        download.args(["download", "--quiet=2", "--option", "APT::Sandbox::User=root"]).args(packages);
        process::output(download.current_dir(&archives), "apt-get download")?;
        for archive in files::names_in(&archives)? {
            process::output(Command::new("dpkg").arg("--extract").arg(&archive).arg(folder), "dpkg")?;
        }
        Ok(())
    })
}

fn apt(arguments: &[&str], packages: &[&str]) -> Result<(), Failure> {
    // Two of --quiet hide each package; what apt complains about is shown.
    let mut command = Command::new("apt-get");
    command.args(arguments).args(packages).env("DEBIAN_FRONTEND", "noninteractive").stdout(Stdio::null());
    let status = process::status(&mut command)?;
    if status.success() { Ok(()) } else { Err(Failure::Ended { what: "apt-get".to_owned(), status }) }
}
