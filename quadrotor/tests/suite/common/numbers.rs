//! Numbers that look random.

use nalgebra::Vector3;

/// SplitMix64: the same numbers on every machine.
pub struct Numbers(pub u64);

impl Numbers {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Within ±most.
    pub fn within(&mut self, most: f64) -> f64 {
        most * (2.0 * (self.next() >> 11) as f64 / (1_u64 << 53) as f64 - 1.0)
    }

    pub fn vector(&mut self, most: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.within(most))
    }
}
