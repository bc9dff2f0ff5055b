//! Platforms that the FMU and the vehicle are built for, by the names of FMI.

use clap::ValueEnum;
use clap::builder::PossibleValue;

/// An operating system on a processor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Platform {
    /// Linux on 64-bit x86.
    X86_64Linux,
    /// Linux on 64-bit ARM.
    Aarch64Linux,
    /// Windows on 64-bit x86.
    X86_64Windows,
    /// macOS on 64-bit x86.
    X86_64Darwin,
    /// macOS on Apple silicon.
    Aarch64Darwin,
}

/// What is known of a platform.
struct Facts {
    fmi2: &'static str,
    fmi3: &'static str,
    target: &'static str,
    architecture: &'static str,
    system: &'static str,
    library_extension: &'static str,
    program_suffix: &'static str,
}

impl Platform {
    /// All of them.
    pub const ALL: [Self; 5] =
        [Self::X86_64Linux, Self::Aarch64Linux, Self::X86_64Windows, Self::X86_64Darwin, Self::Aarch64Darwin];

    const fn facts(self) -> Facts {
        match self {
            Self::X86_64Linux => Facts {
                fmi2: "linux64",
                fmi3: "x86_64-linux",
                target: "x86_64-unknown-linux-gnu",
                architecture: "x86_64",
                system: "linux",
                library_extension: "so",
                program_suffix: "",
            },
            Self::Aarch64Linux => Facts {
                fmi2: "aarch64-linux",
                fmi3: "aarch64-linux",
                target: "aarch64-unknown-linux-gnu",
                architecture: "aarch64",
                system: "linux",
                library_extension: "so",
                program_suffix: "",
            },
            Self::X86_64Windows => Facts {
                fmi2: "win64",
                fmi3: "x86_64-windows",
                target: "x86_64-pc-windows-gnu",
                architecture: "x86_64",
                system: "windows",
                library_extension: "dll",
                program_suffix: ".exe",
            },
            Self::X86_64Darwin => Facts {
                fmi2: "darwin64",
                fmi3: "x86_64-darwin",
                target: "x86_64-apple-darwin",
                architecture: "x86_64",
                system: "macos",
                library_extension: "dylib",
                program_suffix: "",
            },
            Self::Aarch64Darwin => Facts {
                fmi2: "aarch64-darwin",
                fmi3: "aarch64-darwin",
                target: "aarch64-apple-darwin",
                architecture: "aarch64",
                system: "macos",
                library_extension: "dylib",
                program_suffix: "",
            },
        }
    }

    /// The platform of this machine, if it is one of them.
    #[must_use]
    pub fn host() -> Option<Self> {
        use std::env::consts::{ARCH, OS};
        Self::ALL.into_iter().find(|platform| {
            let facts = platform.facts();
            (facts.architecture, facts.system) == (ARCH, OS)
        })
    }

    /// Folder of its binaries in an FMU of FMI 2.0. The standard has names for x86; of other processors it says (2.0.5, section
    /// 2.3) that the platform tuples of FMI 3.0 should be used.
    #[must_use]
    pub fn fmi2_folder(self) -> &'static str {
        self.facts().fmi2
    }

    /// Folder of its binaries in an FMU of FMI 3.0: the platform tuple.
    #[must_use]
    pub fn fmi3_folder(self) -> &'static str {
        self.facts().fmi3
    }

    /// What rustc calls it.
    #[must_use]
    pub fn target(self) -> &'static str {
        self.facts().target
    }

    /// What rustc calls it with a C library that is linked into the program; Linux only.
    #[must_use]
    pub fn static_target(self) -> Option<&'static str> {
        match self {
            Self::X86_64Linux => Some("x86_64-unknown-linux-musl"),
            Self::Aarch64Linux => Some("aarch64-unknown-linux-musl"),
            _ => None,
        }
    }

    /// What container images call its processor.
    #[must_use]
    pub fn container_architecture(self) -> &'static str {
        match self.facts().architecture {
            "x86_64" => "amd64",
            _ => "arm64",
        }
    }

    /// Extension of its libraries, without a dot.
    #[must_use]
    pub fn library_extension(self) -> &'static str {
        self.facts().library_extension
    }

    /// What names of its programs end with.
    #[must_use]
    pub fn program_suffix(self) -> &'static str {
        self.facts().program_suffix
    }

    /// Whether it is Linux.
    #[must_use]
    pub fn is_linux(self) -> bool {
        self.facts().system == "linux"
    }

    /// Whether it is macOS.
    #[must_use]
    pub fn is_darwin(self) -> bool {
        self.facts().system == "macos"
    }
}

/// The names of FMI 2.0, and the tuples of FMI 3.0 as well.
impl ValueEnum for Platform {
    fn value_variants<'a>() -> &'a [Self] {
        &Self::ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.fmi2_folder()).alias(self.fmi3_folder()))
    }
}

impl std::fmt::Display for Platform {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.fmi2_folder())
    }
}

#[cfg(test)]
mod tests {
    use clap::ValueEnum;

    use super::Platform;

    /// The names that the two standards give.
    #[test]
    fn names_of_both_standards_are_understood() {
        for (name, platform) in [
            ("linux64", Platform::X86_64Linux),
            ("x86_64-linux", Platform::X86_64Linux),
            ("aarch64-linux", Platform::Aarch64Linux),
            ("win64", Platform::X86_64Windows),
            ("x86_64-windows", Platform::X86_64Windows),
            ("darwin64", Platform::X86_64Darwin),
            ("aarch64-darwin", Platform::Aarch64Darwin),
        ] {
            assert_eq!(Platform::from_str(name, false), Ok(platform));
        }
        assert!(Platform::from_str("linux", false).is_err());
    }

    #[test]
    fn a_target_begins_with_its_processor() {
        for platform in Platform::ALL {
            let (architecture, _) = platform.fmi3_folder().split_once('-').expect("a tuple");
            assert!(platform.target().starts_with(architecture), "{platform}");
            assert!(
                platform.static_target().is_none_or(|target| target.starts_with(architecture)),
                "{platform}"
            );
            assert_eq!(platform.static_target().is_some(), platform.is_linux(), "{platform}");
        }
    }
}
