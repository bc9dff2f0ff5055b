//! The identity of the interface.

use crate::model::Model;
use crate::variables::{Value, arrays, variables};

/// A 128-bit hash of the table of variables and the version, by which a description or a saved state of another build of
/// the model is recognised.
///
/// FNV-1a is the same on every platform; resistance to attacks is not needed.
pub(crate) fn identity<M: Model>() -> u128 {
    let mut hash = Fnv1a::new();
    hash.text(M::IDENTITY.name);
    hash.text(M::IDENTITY.version);
    hash.bytes(&M::IDENTITY.saved_state.version.to_le_bytes());
    for (reference, variable) in variables::<M>() {
        hash.bytes(&reference.to_le_bytes());
        hash.text(variable.name);
        hash.text(variable.description);
        hash.text(variable.causality());
        hash.text(variable.variability());
        hash.text(&variable.value_type().to_string());
        hash.text(variable.quantity().map_or("", |quantity| quantity.name));
        for (name, description) in variable.choice().map_or(&[][..], |choice| choice.items) {
            hash.text(name);
            hash.text(description);
        }
        let (minimum, maximum) = variable.range();
        for value in [minimum, maximum, variable.start()] {
            hash.value(value);
        }
    }
    for array in arrays::<M>() {
        hash.text(array.name);
        array.components.iter().for_each(|name| hash.text(name));
    }
    hash.0
}

/// The GUID that `modelDescription.xml` and the library must agree on; FMI 3.0 calls it the instantiation token.
pub fn guid<M: Model>() -> String {
    let digits = format!("{:032x}", identity::<M>());
    let (a, rest) = digits.split_at(8);
    let (b, rest) = rest.split_at(4);
    let (c, rest) = rest.split_at(4);
    let (d, e) = rest.split_at(4);
    format!("{{{a}-{b}-{c}-{d}-{e}}}")
}

/// FNV-1a with 128 bits (Fowler, Noll, Vo).
struct Fnv1a(u128);

impl Fnv1a {
    const PRIME: u128 = 0x0000_0000_0100_0000_0000_0000_0000_013b;

    fn new() -> Self {
        Self(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d)
    }

    fn bytes(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u128::from(*byte)).wrapping_mul(Self::PRIME);
        }
    }

    /// With its length, so that adjacent texts cannot be confused.
    fn text(&mut self, text: &str) {
        self.bytes(&(text.len() as u64).to_le_bytes());
        self.bytes(text.as_bytes());
    }

    fn value(&mut self, value: Option<Value>) {
        match value {
            None => self.bytes(&[0]),
            Some(Value::Real(value)) => self.bytes(&value.to_bits().to_le_bytes()),
            Some(Value::Integer(value)) => self.bytes(&value.to_le_bytes()),
            Some(Value::Boolean(value)) => self.bytes(&[1 + u8::from(value)]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Fnv1a, guid};
    use crate::lag::Lag;

    /// Test vectors of draft-eastlake-fnv.
    #[test]
    fn hash_has_the_published_values() {
        for (text, expected) in [
            ("", 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d_u128),
            ("a", 0xd228_cb69_6f1a_8caf_7891_2b70_4e4a_8964),
            ("foobar", 0x343e_1662_793c_64bf_6f0d_3597_ba44_6f18),
        ] {
            let mut hash = Fnv1a::new();
            hash.bytes(text.as_bytes());
            assert_eq!(hash.0, expected, "{text:?}");
        }
    }

    #[test]
    fn guid_has_the_usual_form() {
        let guid = guid::<Lag>();
        let groups: Vec<&str> = guid.trim_matches(['{', '}']).split('-').collect();
        assert_eq!(groups.iter().map(|group| group.len()).collect::<Vec<_>>(), [8, 4, 4, 4, 12]);
        assert!(groups.iter().all(|group| group.chars().all(|digit| digit.is_ascii_hexdigit())));
    }
}
