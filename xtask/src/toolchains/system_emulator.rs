//! What emulates a whole microcontroller.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::progress::Progress;
use xtask::failure::Failure;
use xtask::process;
use xtask::workspace::Workspace;

use super::{debian, machine};

/// Its program, and Debian's package with it.
const QEMU: &str = "qemu-system-arm";
/// That package, and libraries of its own that other versions of it have no use for.
const UNPACKED: [&str; 11] = [
    QEMU,
    "libdaxctl1",
    "libfdt1",
    "libibverbs1",
    "libndctl6",
    "libnl-3-200",
    "libnl-route-3-200",
    "libpmem1",
    "librdmacm1",
    "libslirp0",
    "libvdeplug2",
];

/// The emulator.
pub struct SystemEmulator {
    program: PathBuf,
    /// Libraries beside it that the machine does not have.
    libraries: Vec<PathBuf>,
}

impl SystemEmulator {
    /// The one of this machine, or if that is asked for, one that is installed; where it would have to replace another version, it is
    /// unpacked below the target folder.
    pub fn provide(workspace: &Workspace, progress: &Progress, install: bool) -> Result<Self, Failure> {
        let folder = workspace.target("microcontroller").join("qemu");
        if let Some(found) = Self::find(&folder) {
            return Ok(found);
        }
        if install && debian::can_install() {
            if debian::install(progress, &[QEMU]).is_err() {
                debian::unpack(progress, &UNPACKED, &folder)?;
            }
            if let Some(installed) = Self::find(&folder) {
                return Ok(installed);
            }
        }
        let needs = format!("\n  {QEMU}, which runs the firmware: apt-get install {QEMU}");
        Err(Failure::Needs { needs })
    }

    fn find(folder: &Path) -> Option<Self> {
        if let Some(program) = machine::find(QEMU) {
            return Some(Self { program, libraries: Vec::new() });
        }
        let program = folder.join("usr").join("bin").join(QEMU);
        let architecture = format!("{}-linux-gnu", std::env::consts::ARCH);
        let libraries = ["lib", "usr/lib"].map(|below| folder.join(below).join(&architecture)).to_vec();
        program.is_file().then_some(Self { program, libraries })
    }

    /// Tells a command that runs it by itself where it is.
    pub fn tell(&self, command: &mut Command) {
        self.with_libraries(command.arg("--qemu").arg(&self.program));
    }

    fn with_libraries(&self, command: &mut Command) {
        if let Ok(path) = std::env::join_paths(&self.libraries)
            && !self.libraries.is_empty()
        {
            command.env("LD_LIBRARY_PATH", path);
        }
    }

    /// Runs a program on a machine whose clock goes by instructions, 64 ns each, and returns what it prints.
    pub fn output(&self, machine: &str, program: &Path, what: &str) -> Result<String, Failure> {
        let mut command = Command::new(&self.program);
        command.args(["-M", machine, "-icount", "shift=6", "-display", "none", "-monitor", "none"]);
        command.args(["-serial", "none", "-semihosting-config", "enable=on,target=native", "-kernel"]);
        self.with_libraries(command.arg(program));
        Ok(String::from_utf8_lossy(&process::output(&mut command, what)?).into_owned())
    }
}
