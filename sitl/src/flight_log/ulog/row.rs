//! One sample of a topic, field behind field.

/// Bytes of a sample.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Row(pub(in crate::flight_log) Vec<u8>);

impl Row {
    /// uint64_t
    pub fn u64(&mut self, value: u64) -> &mut Self {
        self.put(&value.to_le_bytes())
    }

    /// uint32_t
    pub fn u32(&mut self, value: u32) -> &mut Self {
        self.put(&value.to_le_bytes())
    }

    /// uint16_t
    pub fn u16(&mut self, value: u16) -> &mut Self {
        self.put(&value.to_le_bytes())
    }

    /// uint8_t
    pub fn u8(&mut self, value: u8) -> &mut Self {
        self.put(&[value])
    }

    /// bool
    pub fn bool(&mut self, value: bool) -> &mut Self {
        self.u8(u8::from(value))
    }

    /// double
    pub fn f64(&mut self, value: f64) -> &mut Self {
        self.put(&value.to_le_bytes())
    }

    /// float
    pub fn f32(&mut self, value: f32) -> &mut Self {
        self.put(&value.to_le_bytes())
    }

    /// Some of type float.
    pub fn reals(&mut self, values: impl IntoIterator<Item = f64>) -> &mut Self {
        for value in values {
            self.f32(value as f32);
        }
        self
    }

    /// Some of type float.
    pub fn floats(&mut self, values: impl IntoIterator<Item = f32>) -> &mut Self {
        for value in values {
            self.f32(value);
        }
        self
    }

    fn put(&mut self, bytes: &[u8]) -> &mut Self {
        self.0.extend_from_slice(bytes);
        self
    }

    /// All of it.
    pub fn bytes(&self) -> &[u8] {
        &self.0
    }
}
