//! Fields of a raw payload.

/// A payload whose fields are read at the offsets of its wire format.
///
/// MAVLink 2 cuts trailing zeros off, and MAVLink 1 has no extensions: what lies beyond the end reads as zero.
#[derive(Clone, Copy, Debug)]
pub struct Payload<'a>(&'a [u8]);

impl<'a> Payload<'a> {
    /// A payload as it came.
    pub fn new(bytes: &'a [u8]) -> Self {
        Self(bytes)
    }

    /// `N` bytes at an offset.
    pub fn bytes<const N: usize>(&self, offset: usize) -> [u8; N] {
        let mut field = [0; N];
        for (byte, given) in field.iter_mut().zip(self.0.iter().skip(offset)) {
            *byte = *given;
        }
        field
    }

    /// A number at an offset.
    pub fn u8(&self, offset: usize) -> u8 {
        u8::from_le_bytes(self.bytes(offset))
    }

    /// A number at an offset.
    pub fn u16(&self, offset: usize) -> u16 {
        u16::from_le_bytes(self.bytes(offset))
    }

    /// A number at an offset.
    pub fn i16(&self, offset: usize) -> i16 {
        i16::from_le_bytes(self.bytes(offset))
    }

    /// A number at an offset.
    pub fn u32(&self, offset: usize) -> u32 {
        u32::from_le_bytes(self.bytes(offset))
    }

    /// A number at an offset.
    pub fn i32(&self, offset: usize) -> i32 {
        i32::from_le_bytes(self.bytes(offset))
    }

    /// A number at an offset.
    pub fn u64(&self, offset: usize) -> u64 {
        u64::from_le_bytes(self.bytes(offset))
    }

    /// A number at an offset.
    pub fn i64(&self, offset: usize) -> i64 {
        i64::from_le_bytes(self.bytes(offset))
    }

    /// A number at an offset.
    pub fn f32(&self, offset: usize) -> f32 {
        f32::from_le_bytes(self.bytes(offset))
    }

    /// `N` numbers from an offset on, in double precision.
    pub fn reals<const N: usize>(&self, offset: usize) -> [f64; N] {
        core::array::from_fn(|index| f64::from(self.f32(offset + 4 * index)))
    }

    /// A name of up to 16 characters that a zero ends unless it has all 16; empty if it is no ASCII.
    pub fn name(&self, offset: usize) -> String {
        let bytes: [u8; 16] = self.bytes(offset);
        let used = bytes.iter().take_while(|byte| **byte != 0).copied().collect::<Vec<_>>();
        String::from_utf8(used).ok().filter(|name| name.is_ascii()).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::Payload;

    #[test]
    fn what_was_cut_off_reads_as_zero() {
        let payload = Payload::new(&[1, 2, 3]);
        assert_eq!(payload.u16(0), 0x0201);
        assert_eq!(payload.u32(1), 0x0302);
        assert_eq!(payload.u64(3), 0);
        assert_eq!(payload.f32(usize::MAX - 8), 0.0);
        assert_eq!(Payload::new(b"NAME\0rest").name(0), "NAME");
        assert_eq!(Payload::new(b"SIXTEEN_LONG_ID!x").name(0), "SIXTEEN_LONG_ID!");
        assert_eq!(Payload::new(&[0xff, 0xfe]).name(0), "");
    }
}
