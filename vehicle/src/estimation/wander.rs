//! Errors that wander: first-order Gauss–Markov processes and random walks.

use nalgebra::Vector3;

use super::noise::Noise;

/// A Gauss–Markov process of unit variance on three axes: ẋ = −x/τ + √(2/τ) w.
#[derive(Clone, Debug, PartialEq)]
pub struct GaussMarkov {
    correlation_s: f64,
    value: Vector3<f64>,
}

impl GaussMarkov {
    /// A process that has run for ever.
    pub fn new(correlation_s: f64, noise: &mut Noise) -> Self {
        Self { correlation_s, value: noise.vector(1.0) }
    }

    /// Goes on by `dt_s`: x⁺ = e^(−T/τ) x + √(1 − e^(−2T/τ)) w, exact for any step.
    pub fn step(&mut self, dt_s: f64, noise: &mut Noise) -> Vector3<f64> {
        let kept = libm::exp(-dt_s / self.correlation_s);
        self.value = self.value * kept + noise.vector(libm::sqrt(1.0 - kept * kept));
        self.value
    }
}

/// Rate at which something walks that drifts by `slope` per kelvin, per √s. Assumed: a vehicle that has been switched on
/// warms by 10 K within ten minutes; a random walk of that rate has come as far by then.
pub const fn warming_walk(slope: f64) -> f64 {
    const KELVIN: f64 = 10.0;
    /// √600 s
    const ROOT_S: f64 = 24.494_897_427_831_78;
    slope * KELVIN / ROOT_S
}
