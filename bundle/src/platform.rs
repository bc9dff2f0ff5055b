//! The place of a library in an FMU, which depends on the platform.

use xtask::platform::Platform;

use crate::archive::Archive;
use crate::product::Version;

/// Platforms of ARM, each with the one of x86 in whose folder importers on ARM look all the same: FMPy, OpenModelica and FMI
/// Library take `linux64` on every 64-bit Linux, and FMPy `darwin64` on every Mac.
const STAND_INS: [(Platform, Platform); 2] =
    [(Platform::Aarch64Linux, Platform::X86_64Linux), (Platform::Aarch64Darwin, Platform::X86_64Darwin)];

/// `binaries/<platform>` of FMI 2.0.
fn folder(platform: Platform) -> String {
    format!("binaries/{}", platform.fmi2_folder())
}

/// `binaries/<platform>/<identifier>.<extension>` of the model with this identifier.
pub fn entry(version: Version, platform: Platform, identifier: &str) -> String {
    let folder = match version {
        Version::Two => platform.fmi2_folder(),
        Version::Three => platform.fmi3_folder(),
    };
    format!("binaries/{folder}/{identifier}.{}", platform.library_extension())
}

/// Puts the libraries of ARM also where importers on ARM look, if the archive has none of x86 there.
pub fn add_stand_ins(archive: &mut Archive) {
    for (arm, x86) in STAND_INS {
        if archive.has_folder(&folder(x86)) {
            continue;
        }
        let there: Vec<(String, Vec<u8>)> = archive
            .below(&folder(arm))
            .map(|(path, bytes)| (path.replacen(&folder(arm), &folder(x86), 1), bytes.to_vec()))
            .collect();
        for (path, bytes) in there {
            archive.add_binary(&path, bytes);
        }
    }
}

/// If an entry may be a stand-in, the entry that it then stands for.
pub fn stands_for(entry: &str) -> Option<String> {
    STAND_INS.iter().find_map(|(arm, x86)| {
        let rest = entry.strip_prefix(&folder(*x86))?;
        rest.starts_with('/').then(|| format!("{}{rest}", folder(*arm)))
    })
}

#[cfg(test)]
mod tests {
    use xtask::platform::Platform;

    use super::{add_stand_ins, entry, stands_for};
    use crate::archive::Archive;
    use crate::product::Version;

    fn with(platforms: &[Platform]) -> Archive {
        let mut archive = Archive::default();
        for platform in platforms {
            archive
                .add_binary(&entry(Version::Two, *platform, "Model"), platform.target().as_bytes().to_vec());
        }
        add_stand_ins(&mut archive);
        archive
    }

    fn library(archive: &Archive, folder: &str) -> Vec<u8> {
        archive.below(folder).next().map(|(_, bytes)| bytes.to_vec()).unwrap_or_default()
    }

    #[test]
    fn arm_stands_in_where_x86_is_not() {
        let archive = with(&[Platform::Aarch64Linux, Platform::X86_64Windows]);
        assert_eq!(library(&archive, "binaries/linux64"), b"aarch64-unknown-linux-gnu");
        assert_eq!(library(&archive, "binaries/aarch64-linux"), b"aarch64-unknown-linux-gnu");
        assert!(!archive.has_folder("binaries/darwin64"));

        let archive = with(&[Platform::Aarch64Linux, Platform::X86_64Linux]);
        assert_eq!(library(&archive, "binaries/linux64"), b"x86_64-unknown-linux-gnu");
    }

    #[test]
    fn a_stand_in_is_known_by_its_folder() {
        assert_eq!(stands_for("binaries/linux64/a.so").as_deref(), Some("binaries/aarch64-linux/a.so"));
        assert_eq!(stands_for("binaries/linux64x/a.so"), None);
        assert_eq!(stands_for("binaries/win64/a.dll"), None);
    }
}
