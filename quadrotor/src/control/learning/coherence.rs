//! How much of the horizontal acceleration goes with the lean of the thrust.

use nalgebra::Vector2;
use serde::{Deserialize, Serialize};

/// Averages of thrust t and acceleration a, horizontal vectors as complex numbers.
///
/// |⟨t* a⟩|² / (⟨|t|²⟩ ⟨|a|²⟩) is 1 as long as the one is a multiple of the other, turned by a constant angle: no other force swings. A force
/// that swings in its own time makes it less.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Coherence {
    /// ⟨|t|²⟩ and ⟨|a|²⟩, m²/s⁴.
    squares_m2_s4: [f64; 2],
    /// ⟨t* a⟩, m²/s⁴.
    product_m2_s4: Vector2<f64>,
    /// How much of the averages is filled: 1 after a long time.
    filled: f64,
}

impl Coherence {
    /// Nothing was seen.
    pub(crate) fn new() -> Self {
        Self { squares_m2_s4: [0.0; 2], product_m2_s4: Vector2::zeros(), filled: 0.0 }
    }

    /// Takes a share of the present into the averages.
    pub(crate) fn see(&mut self, thrust_m_s2: &Vector2<f64>, acceleration_m_s2: &Vector2<f64>, share: f64) {
        let [t, a] = [thrust_m_s2, acceleration_m_s2];
        let product = Vector2::new(t.dot(a), t.x * a.y - t.y * a.x);
        for (average, vector) in self.squares_m2_s4.iter_mut().zip([t, a]) {
            *average += (vector.norm_squared() - *average) * share;
        }
        self.product_m2_s4 += (product - self.product_m2_s4) * share;
        self.filled += (1.0 - self.filled) * share;
    }

    /// How much of the averages is filled.
    pub(crate) fn filled(&self) -> f64 {
        self.filled
    }

    /// From 0 to 1: how much goes together. 0 if nothing was seen.
    pub(crate) fn squared(&self) -> f64 {
        let [thrust, acceleration] = self.squares_m2_s4;
        let most = thrust * acceleration;
        if most > 0.0 { self.product_m2_s4.norm_squared() / most } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Rotation2, Vector2};

    use super::Coherence;

    /// Of 20 s at 100 samples a second, averaged over 3 s.
    fn coherence(at: impl Fn(f64) -> (Vector2<f64>, Vector2<f64>)) -> f64 {
        let mut coherence = Coherence::new();
        for sample in 0..2_000 {
            let (thrust, acceleration) = at(0.01 * f64::from(sample));
            coherence.see(&thrust, &acceleration, 0.01 / 3.0);
        }
        assert!(coherence.filled() > 0.99);
        coherence.squared()
    }

    fn turning(time_s: f64) -> Vector2<f64> {
        Vector2::new((1.3 * time_s).cos(), (1.3 * time_s).sin())
    }

    #[test]
    fn what_is_turned_by_a_constant_angle_goes_together() {
        let turned = coherence(|time_s| (turning(time_s), Rotation2::new(0.4) * turning(time_s) * 0.7));
        assert!((turned - 1.0).abs() < 1e-12, "{turned}");
        let to_and_fro = coherence(|time_s| {
            let swing = Vector2::new(0.3, -2.0) * time_s.sin();
            (swing, swing * 1.7)
        });
        assert!((to_and_fro - 1.0).abs() < 1e-12, "{to_and_fro}");
    }

    /// A force of half of the amplitude at another rate: the share of the squares that goes together is 1/(1 + (1/2)²/2) = 8/9.
    #[test]
    fn a_force_that_swings_in_its_own_time_does_not() {
        let pushed = coherence(|time_s| {
            let force = Vector2::x() * (0.5 * f64::sin(9.0 * time_s));
            (turning(time_s) - force, turning(time_s))
        });
        assert!((pushed - 8.0 / 9.0).abs() < 0.02, "{pushed}");
        assert_eq!(Coherence::new().squared(), 0.0);
    }
}
