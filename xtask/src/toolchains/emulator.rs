//! What runs the programs of a platform on this machine.

use std::path::PathBuf;

use xtask::platform::Platform;
use xtask::workspace::Workspace;

use super::machine::{self, ARM_LIBRARIES, QEMU};
use super::need::Need;

/// A program with arguments that runs programs of a platform; without a program they run as they are.
#[derive(Default)]
pub struct Emulator {
    /// The program and its first arguments.
    pub command: Vec<PathBuf>,
    /// Environment variables that it wants.
    pub environment: Vec<(&'static str, PathBuf)>,
}

impl Emulator {
    /// What runs programs of a platform here. None: nothing does, or the [`Emulator::needs`] are not met.
    pub fn of(workspace: &Workspace, platform: Platform) -> Option<Self> {
        if Platform::host() == Some(platform) {
            return Some(Self::default());
        }
        match platform {
            Platform::X86_64Windows => Some(Self {
                command: vec![machine::wine()?],
                environment: vec![
                    ("WINEPREFIX", workspace.platforms().join("wine")),
                    ("WINEDEBUG", PathBuf::from("-all")),
                ],
            }),
            Platform::Aarch64Linux => Some(Self {
                command: vec![machine::find(QEMU)?, PathBuf::from("-L"), PathBuf::from(ARM_LIBRARIES)],
                environment: Vec::new(),
            }),
            Platform::X86_64Linux | Platform::X86_64Darwin | Platform::Aarch64Darwin => None,
        }
    }

    /// What has to be on the machine so that programs of a platform run.
    pub fn needs(platform: Platform) -> Vec<Need> {
        let all: &[Need] = match platform {
            _ if Platform::host() == Some(platform) => &[],
            Platform::X86_64Windows => &[Need::Wine],
            Platform::Aarch64Linux => &[Need::Qemu, Need::ArmLibraries],
            Platform::X86_64Linux | Platform::X86_64Darwin | Platform::Aarch64Darwin => &[],
        };
        all.iter().copied().filter(|need| !need.is_met()).collect()
    }
}
