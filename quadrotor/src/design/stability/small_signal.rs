//! A periodic linear system: its eigenvalues, and how far noise spreads it.

use lmpc::{DesignError, eigenvalues, solve_stein};
use nalgebra::{DMatrix, SMatrix, SVector};

/// Standard deviations, or one reading, of the measurements of an axis: position, velocity, angle and angular rate.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub(crate) struct Reading {
    /// m.
    pub(crate) position: f64,
    /// m/s.
    pub(crate) velocity: f64,
    /// rad.
    pub(crate) angle: f64,
    /// rad/s.
    pub(crate) rate: f64,
}

impl Reading {
    /// One reading per source of noise.
    fn each(&self) -> [Self; 4] {
        let none = Self::default();
        [
            Self { position: self.position, ..none },
            Self { velocity: self.velocity, ..none },
            Self { angle: self.angle, ..none },
            Self { rate: self.rate, ..none },
        ]
    }
}

/// A loop of S states that does the same in each period, for small signals.
pub(crate) trait SmallSignal<const S: usize> {
    /// Number of samples in a period.
    fn events(&self) -> usize;

    /// Length of a period, s.
    fn period_s(&self) -> f64;

    /// The state before the next sample, from the one before sample `event` and the errors of its reading.
    fn after(&self, state: &SVector<f64, S>, event: usize, noise: &Reading) -> SVector<f64, S>;
}

/// How fast the slowest deviation decays, and the least damped one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Modes {
    /// Largest magnitude of the eigenvalues over a period.
    pub(crate) spectral_radius: f64,
    /// Rate at which the slowest deviation decays, 1/s: −ln of that over the period.
    pub(crate) decay_rate_1_s: f64,
    /// Least damping ratio of a mode; 1 when none oscillates. Of modes faster than half the period's sampling, that of
    /// their slower alias.
    pub(crate) damping_ratio: f64,
    /// Angular frequency of that mode, rad/s.
    pub(crate) frequency_rad_s: f64,
}

/// x(k+1) = Φ x(k), from one period to the next.
pub(crate) fn transition<const S: usize>(signal: &impl SmallSignal<S>) -> DMatrix<f64> {
    let mut transition = DMatrix::zeros(S, S);
    for column in 0..S {
        let mut state = SVector::zeros();
        state[column] = 1.0;
        for event in 0..signal.events() {
            state = signal.after(&state, event, &Reading::default());
        }
        transition.set_column(column, &state);
    }
    transition
}

/// The modes of Φ over `period_s`.
///
/// # Errors
/// [`DesignError::ElementNotFinite`], [`DesignError::Eigenvalues`].
pub(crate) fn modes(transition: &DMatrix<f64>, period_s: f64) -> Result<Modes, DesignError> {
    let mut modes =
        Modes { spectral_radius: 0.0, decay_rate_1_s: f64::MAX, damping_ratio: 1.0, frequency_rad_s: 0.0 };
    for value in eigenvalues("the closed loop", transition)? {
        let magnitude = libm::hypot(value.re, value.im);
        modes.spectral_radius = modes.spectral_radius.max(magnitude);
        if magnitude == 0.0 {
            continue;
        }
        // z = e^(sT)
        let (decay, frequency) =
            (-libm::log(magnitude) / period_s, libm::atan2(value.im, value.re) / period_s);
        let damping_ratio = decay / libm::hypot(decay, frequency);
        if frequency != 0.0 && damping_ratio < modes.damping_ratio {
            (modes.damping_ratio, modes.frequency_rad_s) = (damping_ratio, libm::fabs(frequency));
        }
    }
    if modes.spectral_radius > 0.0 {
        modes.decay_rate_1_s = -libm::log(modes.spectral_radius) / period_s;
    }
    Ok(modes)
}

/// The stationary covariance of the state before the first sample of a period, when readings have errors of these
/// standard deviations: P = Φ P Φᵀ + W. `None` when Φ is not stable.
pub(crate) fn covariance<const S: usize>(
    signal: &impl SmallSignal<S>,
    transition: &DMatrix<f64>,
    deviations: &Reading,
) -> Option<DMatrix<f64>> {
    // W is what one period adds: event by event P ← A P Aᵀ + Σ b bᵀ.
    let mut added = SMatrix::<f64, S, S>::zeros();
    for event in 0..signal.events() {
        for _ in 0..2 {
            for column in 0..S {
                let moved = signal.after(&added.column(column).into_owned(), event, &Reading::default());
                added.set_column(column, &moved);
            }
            added.transpose_mut();
        }
        for reading in deviations.each() {
            let noise = signal.after(&SVector::zeros(), event, &reading);
            added += noise * noise.transpose();
        }
    }
    let added = DMatrix::from_fn(S, S, |row, column| added[(row, column)]);
    solve_stein(transition, transition, &added)
}

#[cfg(test)]
mod tests {
    use alloc::vec; // used by dmatrix!

    use nalgebra::{DMatrix, SVector, dmatrix};

    use super::{Reading, SmallSignal, covariance, modes, transition};

    /// A double integrator sampled every 0.1 s under u = −k₁ (x + noise) − k₂ v.
    struct DoubleIntegrator {
        gains: [f64; 2],
    }

    const PERIOD_S: f64 = 0.1;

    impl SmallSignal<2> for DoubleIntegrator {
        fn events(&self) -> usize {
            1
        }

        fn period_s(&self) -> f64 {
            PERIOD_S
        }

        fn after(&self, state: &SVector<f64, 2>, _event: usize, noise: &Reading) -> SVector<f64, 2> {
            let input = -self.gains[0] * (state[0] + noise.position) - self.gains[1] * state[1];
            let (x, v) = (state[0], state[1]);
            [x + PERIOD_S * v + PERIOD_S * PERIOD_S / 2.0 * input, v + PERIOD_S * input].into()
        }
    }

    /// Gains that put the eigenvalues where r e^(±iφ) is, by the coefficients of z² − 2 r cos φ z + r².
    fn placed(magnitude: f64, angle: f64) -> DoubleIntegrator {
        let (sum, product) = (2.0 * magnitude * libm::cos(angle), magnitude * magnitude);
        // 2 − T²k₁/2 − T k₂ = sum,  1 + T²k₁/2 − T k₂ = product
        let position = (1.0 + product - sum) / (PERIOD_S * PERIOD_S);
        let velocity = (3.0 - sum - product) / (2.0 * PERIOD_S);
        DoubleIntegrator { gains: [position, velocity] }
    }

    #[test]
    fn a_double_integrator_has_the_poles_that_it_was_given() {
        for (magnitude, angle) in [(0.9, 0.2), (0.5, 1.0), (1.02, 0.4)] {
            let signal = placed(magnitude, angle);
            let modes = modes(&transition(&signal), PERIOD_S).expect("eigenvalues");
            assert!((modes.spectral_radius - magnitude).abs() < 1e-12);
            assert!((modes.decay_rate_1_s + magnitude.ln() / PERIOD_S).abs() < 1e-9);
            assert!((modes.frequency_rad_s - angle / PERIOD_S).abs() < 1e-9);
            let damping = -magnitude.ln() / libm::hypot(magnitude.ln(), angle);
            assert!((modes.damping_ratio - damping).abs() < 1e-12);
        }
    }

    /// An integrator under u = −K x that acts one sample late: x⁺ = x − K T x₋₁. Its poles z² − z + K T = 0 leave the unit
    /// circle at K T = 1.
    struct LateIntegrator {
        gain: f64,
    }

    impl SmallSignal<2> for LateIntegrator {
        fn events(&self) -> usize {
            2
        }

        fn period_s(&self) -> f64 {
            2.0 * PERIOD_S
        }

        fn after(&self, state: &SVector<f64, 2>, _event: usize, _noise: &Reading) -> SVector<f64, 2> {
            [state[0] - self.gain * PERIOD_S * state[1], state[0]].into()
        }
    }

    /// Two samples make a period: its spectral radius is that of one sample, squared.
    #[test]
    fn a_late_loop_is_stable_up_to_its_delay_margin() {
        for (product, stable) in [(0.5, true), (0.99, true), (1.01, false), (2.0, false)] {
            let signal = LateIntegrator { gain: product / PERIOD_S };
            let modes = modes(&transition(&signal), signal.period_s()).expect("eigenvalues");
            assert_eq!(modes.spectral_radius < 1.0, stable, "K T = {product}");
            // Complex poles: their magnitude squared is their product.
            assert!((modes.spectral_radius - product).abs() < 1e-9);
        }
    }

    /// P = Φ P Φᵀ + b bᵀ, checked by its residual with Φ and b written down.
    #[test]
    fn noise_spreads_as_the_stein_equation_says() {
        let signal = placed(0.8, 0.3);
        let deviation = 0.4;
        let phi = transition(&signal);
        let noise = Reading { position: deviation, ..Reading::default() };
        let covariance = covariance(&signal, &phi, &noise).expect("stable");
        let [position, velocity] = signal.gains;
        let (half, whole) = (PERIOD_S * PERIOD_S / 2.0, PERIOD_S);
        let known: DMatrix<f64> = dmatrix![
            1.0 - half * position, whole - half * velocity;
            -whole * position, 1.0 - whole * velocity
        ];
        assert!((&phi - &known).amax() < 1e-14);
        let b = dmatrix![-half * position * deviation; -whole * position * deviation];
        let residual = &known * &covariance * known.transpose() + &b * b.transpose() - &covariance;
        assert!(residual.amax() < 1e-12 * covariance.amax(), "{residual}");
        assert!(covariance[(0, 0)] > 0.0);
    }

    #[test]
    fn an_unstable_loop_has_no_stationary_spread() {
        let signal = placed(1.01, 0.3);
        let noise = Reading { position: 1.0, ..Reading::default() };
        assert_eq!(covariance(&signal, &transition(&signal), &noise), None);
    }
}
