//! Several platforms in one FMU.

use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

use zip::ZipArchive;

use crate::archive::{Archive, MODEL_DESCRIPTION};
use crate::failure::Failure;
use crate::platform;
use xtask::files;

/// The text of the `modelDescription.xml` of an FMU.
pub fn description(fmu: &Path) -> Result<String, Failure> {
    let unreadable = |source| Failure::Archive { path: fmu.to_owned(), source };
    let bytes = entry(&mut opened(fmu)?, MODEL_DESCRIPTION).map_err(unreadable)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

fn opened(fmu: &Path) -> Result<ZipArchive<BufReader<File>>, Failure> {
    let file = BufReader::new(files::open(fmu)?);
    ZipArchive::new(file).map_err(|source| Failure::Archive { path: fmu.to_owned(), source })
}

/// Takes over the binaries of an FMU with the same description that was built on another platform. Platforms
/// that the archive already has stay as they are.
pub fn binaries(archive: &mut Archive, other: &Path) -> Result<(), Failure> {
    let unreadable = |source| Failure::Archive { path: other.to_owned(), source };
    let mut read = opened(other)?;
    let names = read.file_names().map(|name| name.map(|name| name.into_owned()));
    let names = names.collect::<Result<Vec<String>, _>>().map_err(unreadable)?;
    let further: Vec<&String> = names
        .iter()
        .filter(|name| platform_folder(name).is_some_and(|folder| !archive.has_folder(&folder)))
        .collect();
    if further.is_empty() {
        return Err(Failure::NothingToMerge { path: other.to_owned() });
    }
    for name in further {
        let bytes = entry(&mut read, name).map_err(unreadable)?;
        // A library of ARM in a folder of x86 is no library of x86.
        let original = platform::stands_for(name).filter(|original| names.contains(original));
        let is_stand_in = match original {
            Some(original) => entry(&mut read, &original).map_err(unreadable)? == bytes,
            None => false,
        };
        if !is_stand_in {
            archive.add_binary(name, bytes);
        }
    }
    Ok(())
}

fn entry(archive: &mut ZipArchive<BufReader<File>>, name: &str) -> Result<Vec<u8>, zip::result::ZipError> {
    let mut bytes = Vec::new();
    archive.by_name(name)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// `binaries/<platform>` of a file that lies there, and of nothing else: the name of an entry comes from
/// outside.
fn platform_folder(name: &str) -> Option<String> {
    let mut parts = name.split('/');
    let (Some("binaries"), Some(platform), Some(file), None) =
        (parts.next(), parts.next(), parts.next(), parts.next())
    else {
        return None;
    };
    let plain = |part: &str| !part.is_empty() && part != ".." && !part.contains('\\');
    (plain(platform) && plain(file)).then(|| format!("binaries/{platform}"))
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::{Archive, binaries, platform_folder};
    use crate::failure::Failure;
    use xtask::files;

    const DESCRIPTION: &str = "<fmiModelDescription/>";

    /// An FMU with one binary, in a file of its own.
    fn fmu(name: &str, binary: &str) -> PathBuf {
        let mut archive = Archive::default();
        archive.add("modelDescription.xml", DESCRIPTION.into());
        archive.add("documentation/index.html", b"other".to_vec());
        archive.add_binary(binary, b"library".to_vec());
        let path = std::env::temp_dir().join(format!("xtask-merge-{}-{name}.fmu", std::process::id()));
        files::write(&path, &archive.into_bytes().expect("writes to memory")).expect("writes to a file");
        path
    }

    fn merged(name: &str, binary: &str) -> Result<Archive, Failure> {
        let path = fmu(name, binary);
        let mut archive = Archive::default();
        archive.add_binary("binaries/linux64/LmpcQuadrotor.so", b"ours".to_vec());
        let result = binaries(&mut archive, &path);
        std::fs::remove_file(&path).expect("removes its own file");
        result.map(|()| archive)
    }

    #[test]
    fn takes_over_a_further_platform_and_nothing_else() {
        let archive = merged("further", "binaries/win64/LmpcQuadrotor.dll").expect("merges");
        assert!(archive.has_folder("binaries/linux64"));
        assert!(archive.has_folder("binaries/win64"));
        assert!(!archive.has_folder("documentation"));
    }

    #[test]
    fn a_library_that_stands_in_is_left_behind() {
        let mut arm = Archive::default();
        arm.add("modelDescription.xml", DESCRIPTION.into());
        for folder in ["linux64", "aarch64-linux"] {
            arm.add_binary(&format!("binaries/{folder}/LmpcQuadrotor.so"), b"ARM".to_vec());
        }
        let path = std::env::temp_dir().join(format!("xtask-merge-{}-arm.fmu", std::process::id()));
        files::write(&path, &arm.into_bytes().expect("writes to memory")).expect("writes to a file");
        let mut archive = Archive::default();
        archive.add_binary("binaries/win64/LmpcQuadrotor.dll", b"ours".to_vec());
        let merged = binaries(&mut archive, &path);
        std::fs::remove_file(&path).expect("removes its own file");
        merged.expect("merges");
        assert!(archive.has_folder("binaries/aarch64-linux"));
        assert!(!archive.has_folder("binaries/linux64"));
    }

    #[test]
    fn refuses_a_platform_that_is_there() {
        let same = merged("platform", "binaries/linux64/LmpcQuadrotor.so");
        assert!(matches!(same, Err(Failure::NothingToMerge { .. })));
    }

    #[test]
    fn entries_outside_of_a_platform_folder_are_left_out() {
        assert_eq!(platform_folder("binaries/win64/a.dll").as_deref(), Some("binaries/win64"));
        for name in
            ["binaries/a.dll", "binaries/../a.dll", "binaries//a", "resources/win64/a", "binaries/a/b/c"]
        {
            assert_eq!(platform_folder(name), None, "{name}");
        }
    }
}
