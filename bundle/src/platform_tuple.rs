//! The platform tuples of FMI 3.0 that a library is for, by its own header: names of folders do not tell them, as that of FMI 2.0 may
//! hold a library for ARM.

use object::{FileKind, Object};

/// `<architecture>-<system>`: one, or two of a library for two architectures; none if it is not known.
pub fn of_library(bytes: &[u8]) -> Vec<String> {
    let system = match FileKind::parse(bytes) {
        Ok(FileKind::Elf32 | FileKind::Elf64) => "linux",
        Ok(FileKind::Pe32 | FileKind::Pe64) => "windows",
        Ok(FileKind::MachO32 | FileKind::MachO64) => "darwin",
        // A universal one has both architectures that this system runs on.
        Ok(FileKind::MachOFat32 | FileKind::MachOFat64) => {
            return ["x86_64-darwin", "aarch64-darwin"].map(str::to_owned).to_vec();
        }
        _ => return Vec::new(),
    };
    let architecture = match object::File::parse(bytes).map(|file| file.architecture()) {
        Ok(object::Architecture::X86_64) => "x86_64",
        Ok(object::Architecture::Aarch64) => "aarch64",
        Ok(object::Architecture::I386) => "x86",
        _ => return Vec::new(),
    };
    vec![format!("{architecture}-{system}")]
}

#[cfg(test)]
mod tests {
    use super::of_library;

    /// The least header of an ELF file of a machine.
    fn elf(machine: u8) -> Vec<u8> {
        let mut bytes = vec![0; 64];
        bytes[..7].copy_from_slice(&[0x7f, b'E', b'L', b'F', 2, 1, 1]);
        bytes[16] = 3;
        bytes[18] = machine;
        bytes[20] = 1;
        bytes[52] = 64;
        bytes
    }

    /// The least header of a PE file of a machine, with an optional header and no section.
    fn pe(machine: u16) -> Vec<u8> {
        let mut bytes = vec![0; 0x40 + 24 + 112];
        bytes[..2].copy_from_slice(b"MZ");
        bytes[0x3c] = 0x40;
        bytes[0x40..0x44].copy_from_slice(b"PE\0\0");
        bytes[0x44..0x46].copy_from_slice(&machine.to_le_bytes());
        bytes[0x54] = 112;
        bytes[0x58..0x5a].copy_from_slice(&0x20b_u16.to_le_bytes());
        bytes
    }

    /// The least header of a Mach-O file of a processor.
    fn mach_o(processor: u8) -> Vec<u8> {
        let mut bytes = vec![0; 32];
        bytes[..8].copy_from_slice(&[0xcf, 0xfa, 0xed, 0xfe, processor, 0, 0, 1]);
        bytes[12] = 6;
        bytes
    }

    /// Machine numbers from the specifications of the formats.
    #[test]
    fn the_header_tells_the_platform() {
        for (library, expected) in [
            (elf(62), "x86_64-linux"),
            (elf(183), "aarch64-linux"),
            (pe(0x8664), "x86_64-windows"),
            (pe(0xaa64), "aarch64-windows"),
            (mach_o(7), "x86_64-darwin"),
            (mach_o(12), "aarch64-darwin"),
        ] {
            assert_eq!(of_library(&library), [expected], "{expected}");
        }
        let mut universal = [0; 64];
        universal[..8].copy_from_slice(&[0xca, 0xfe, 0xba, 0xbe, 0, 0, 0, 2]);
        assert_eq!(of_library(&universal), ["x86_64-darwin", "aarch64-darwin"]);
        assert!(of_library(b"text").is_empty() && of_library(&[]).is_empty());
    }
}
