//! CRC-32 of MAVLink FTP and of component metadata.

/// The checksum while bytes go by. It begins with zero and is not inverted.
#[derive(Clone, Debug)]
pub struct Checksum(crc32fast::Hasher);

impl Default for Checksum {
    fn default() -> Self {
        Self(crc32fast::Hasher::new_with_initial(u32::MAX))
    }
}

impl Checksum {
    /// Takes the next bytes in.
    pub fn update(&mut self, bytes: &[u8]) {
        self.0.update(bytes);
    }

    /// The checksum of all of them.
    pub fn finish(self) -> u32 {
        !self.0.finalize()
    }
}

/// The checksum of bytes that are there at once.
pub fn checksum(bytes: &[u8]) -> u32 {
    let mut checksum = Checksum::default();
    checksum.update(bytes);
    checksum.finish()
}
