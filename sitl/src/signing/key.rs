//! The secret that signatures are made with.

use std::fmt;

use sha2::{Digest, Sha256};
use subtle::ConstantTimeEq;

/// Bytes of a key.
const LENGTH: usize = 32;

/// A key. Nothing prints it.
#[derive(Clone)]
pub struct SecretKey([u8; LENGTH]);

impl SecretKey {
    /// A key of its bytes; all zero stands for none.
    pub fn new(bytes: [u8; LENGTH]) -> Option<Self> {
        (!bool::from(bytes.ct_eq(&[0; LENGTH]))).then_some(Self(bytes))
    }

    /// A key as a file has it: 32 bytes, or 64 hexadecimal digits with white space around them.
    pub fn read(content: &[u8]) -> Option<Self> {
        if let Ok(bytes) = content.try_into() {
            return Self::new(bytes);
        }
        let digits = std::str::from_utf8(content).ok()?.trim();
        if digits.len() != 2 * LENGTH || !digits.bytes().all(|digit| digit.is_ascii_hexdigit()) {
            return None;
        }
        let mut bytes = [0; LENGTH];
        for (byte, at) in bytes.iter_mut().zip((0..).step_by(2)) {
            *byte = u8::from_str_radix(digits.get(at..at + 2)?, 16).ok()?;
        }
        Self::new(bytes)
    }

    /// As it is written into a file.
    pub(super) fn to_digits(&self) -> String {
        let digits: String = self.0.iter().map(|byte| format!("{byte:02x}")).collect();
        digits + "\n"
    }

    /// Beginning of SHA-256 over key and bytes.
    pub fn tag(&self, bytes: &[u8]) -> [u8; 6] {
        let hash = Sha256::new().chain_update(self.0).chain_update(bytes).finalize();
        let mut tag = [0; 6];
        for (byte, given) in tag.iter_mut().zip(hash) {
            *byte = given;
        }
        tag
    }

    /// Whether a tag is that of the bytes. Takes as long for a wrong one as for a right one.
    pub fn made(&self, tag: &[u8; 6], bytes: &[u8]) -> bool {
        self.tag(bytes).ct_eq(tag).into()
    }
}

impl PartialEq for SecretKey {
    fn eq(&self, other: &Self) -> bool {
        self.0.ct_eq(&other.0).into()
    }
}

impl fmt::Debug for SecretKey {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("SecretKey(..)")
    }
}

#[cfg(test)]
mod tests {
    use super::SecretKey;

    #[test]
    fn a_key_is_bytes_or_digits_and_is_not_printed() {
        let key = SecretKey::read(&[0x5a; 32]).expect("bytes");
        let digits = format!(" {}\n", "5a".repeat(32));
        assert_eq!(SecretKey::read(digits.as_bytes()), Some(key.clone()));
        assert_eq!(SecretKey::read(key.to_digits().as_bytes()), Some(key.clone()));
        for wrong in [&b""[..], &[0; 32], &[1; 31], "5a".repeat(31).as_bytes(), "+a".repeat(32).as_bytes()] {
            assert_eq!(SecretKey::read(wrong), None);
        }
        assert!(!format!("{key:?}").contains("5a") && !format!("{key:?}").contains("90"));
    }
}
