//! Functions of time with their first four derivatives.

use std::ops::{Add, Mul, Sub};

/// Most derivatives.
const ORDER: usize = 4;

/// Taylor coefficients of a function about an instant: the k-th is its k-th derivative over k!.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Taylor([f64; ORDER + 1]);

impl Taylor {
    /// c + v (t − t₀) about t₀.
    pub fn line(value: f64, rate: f64) -> Self {
        let mut coefficients = [0.0; ORDER + 1];
        (coefficients[0], coefficients[1]) = (value, rate);
        Self(coefficients)
    }

    /// The `order`-th derivative, up to the fourth.
    pub fn derivative(&self, order: usize) -> f64 {
        let factorial: usize = (1..=order).product();
        self.0[order] * factorial as f64
    }

    /// Sine and cosine of it.
    pub fn sine_and_cosine(&self) -> (Self, Self) {
        let (mut sine, mut cosine) = ([0.0; ORDER + 1], [0.0; ORDER + 1]);
        (sine[0], cosine[0]) = self.0[0].sin_cos();
        for order in 1..=ORDER {
            // (sin f)′ = f′ cos f and (cos f)′ = −f′ sin f, coefficient by coefficient.
            for inner in 1..=order {
                let slope = inner as f64 * self.0[inner] / order as f64;
                sine[order] += slope * cosine[order - inner];
                cosine[order] -= slope * sine[order - inner];
            }
        }
        (Self(sine), Self(cosine))
    }

    /// It to a power.
    pub fn power(self, exponent: usize) -> Self {
        (0..exponent).fold(Self::line(1.0, 0.0), |product, _| product * self)
    }
}

impl Add for Taylor {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|order| self.0[order] + other.0[order]))
    }
}

impl Sub for Taylor {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + other * -1.0
    }
}

impl Mul<f64> for Taylor {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Self(self.0.map(|coefficient| coefficient * factor))
    }
}

impl Mul for Taylor {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self(std::array::from_fn(|order| {
            (0..=order).map(|inner| self.0[inner] * other.0[order - inner]).sum()
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::Taylor;

    /// f = sin 3t about t = 0.7: 3ᵏ times sine or cosine.
    #[test]
    fn derivatives_of_a_sine_are_the_known_ones() {
        let (sine, cosine) = Taylor::line(2.1, 3.0).sine_and_cosine();
        let (s, c) = 2.1_f64.sin_cos();
        for (order, [of_sine, of_cosine]) in
            [[s, c], [3.0 * c, -3.0 * s], [-9.0 * s, -9.0 * c], [-27.0 * c, 27.0 * s], [81.0 * s, 81.0 * c]]
                .into_iter()
                .enumerate()
        {
            assert!((sine.derivative(order) - of_sine).abs() < 1e-12, "{order}");
            assert!((cosine.derivative(order) - of_cosine).abs() < 1e-12, "{order}");
        }
    }

    /// t⁵ about t = 2: 32, 80, 160, 240, 240.
    #[test]
    fn derivatives_of_a_power_are_the_known_ones() {
        let fifth = Taylor::line(2.0, 1.0).power(5);
        let derivatives: Vec<f64> = (0..=4).map(|order| fifth.derivative(order)).collect();
        assert_eq!(derivatives, [32.0, 80.0, 160.0, 240.0, 240.0]);
    }
}
