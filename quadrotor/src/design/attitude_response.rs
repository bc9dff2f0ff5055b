//! The closed attitude loop as the position controller sees it.

use lmpc::{DesignError, StateSpace};
use nalgebra::{DMatrix, DVector};

/// The closed attitude loop, from the commanded angle to the angle, as two states:
///
/// ```text
/// θ̈ = ω² (θ_c − θ) − 2 ζ ω θ̇
/// ```
///
/// ω and ζ match the first two moments of the error e after a step of the command, of the exact loop with its sampling and
/// the rotors' lag: ∫ e dt = 2ζ/ω and ∫ t e dt = (4ζ² − 1)/ω². So a slow command meets the same delay, to second order, as
/// in the loop itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AttitudeResponse {
    /// ω, rad/s.
    pub natural_frequency_rad_s: f64,
    /// ζ.
    pub damping: f64,
}

impl AttitudeResponse {
    /// Of one axis under the gain K, 1×(n+1) on \[Δx; θ − θ_c\], of a law that goes by the deviation from its reference:
    /// Δx is the motion which, by the model, leads to x under the last input.
    ///
    /// # Errors
    /// [`DesignError::NotFinite`] when the model's A cannot be inverted or the loop has no such response.
    pub fn new(plant: &StateSpace, gain: &DMatrix<f64>, sample_time_s: f64) -> Result<Self, DesignError> {
        let n = plant.states();
        let (a, b) = (plant.a(), plant.b());
        let inverse = a.clone().try_inverse().ok_or(DesignError::NotFinite { name: "A⁻¹" })?;
        // Δv = −K_x ((I − A⁻¹) x + A⁻¹ B v) − K_y C x
        let by_motion = gain.columns(0, n);
        let by_state = -(by_motion * (DMatrix::identity(n, n) - &inverse) + gain.columns(n, 1) * plant.c());
        let by_input = DMatrix::identity(1, 1) - by_motion * &inverse * b;
        // z = [x; v]: v⁺ = by_state x + by_input v, x⁺ = A x + B v⁺
        let mut transition = DMatrix::zeros(n + 1, n + 1);
        transition.view_mut((0, 0), (n, n)).copy_from(&(a + b * &by_state));
        transition.view_mut((0, n), (n, 1)).copy_from(&(b * &by_input));
        transition.view_mut((n, 0), (1, n)).copy_from(&by_state);
        transition.view_mut((n, n), (1, 1)).copy_from(&by_input);

        let (sum, weighted_sum) = sums_from_unit_error(&transition)?;
        let t = sample_time_s;
        // The trapezoidal rule, with Euler and Maclaurin's correction for the slope of t e at 0.
        let moment = t * (sum - 0.5);
        let weighted_moment = t * t * (weighted_sum + 1.0 / 12.0);
        let natural_frequency_rad_s = libm::sqrt(1.0 / (moment * moment - weighted_moment));
        let damping = moment * natural_frequency_rad_s / 2.0;
        if natural_frequency_rad_s.is_finite() && damping > 0.0 {
            Ok(Self { natural_frequency_rad_s, damping })
        } else {
            Err(DesignError::NotFinite { name: "the attitude's step response" })
        }
    }
}

/// Σ e_k and Σ k e_k of the first component of z, from z = e₁ on: (I − M)⁻¹ e₁ and M (I − M)⁻² e₁.
fn sums_from_unit_error(transition: &DMatrix<f64>) -> Result<(f64, f64), DesignError> {
    let size = transition.nrows();
    let singular = DesignError::NotFinite { name: "(I − M)⁻¹" };
    let factor = (DMatrix::identity(size, size) - transition).lu();
    let mut start = DVector::zeros(size);
    start[0] = 1.0;
    let sum = factor.solve(&start).ok_or(singular.clone())?;
    let weighted_sum = factor.solve(&(transition * &sum)).ok_or(singular)?;
    Ok((sum[0], weighted_sum[0]))
}

#[cfg(test)]
mod tests {
    use alloc::vec;
    use alloc::vec::Vec;

    use lmpc::{Augmented, Dlqr};
    use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

    use super::AttitudeResponse;
    use crate::design::linear_models::lagged_attitude_model;

    const SAMPLE_TIME_S: f64 = 0.01;
    /// Steps of the simulation between two samples.
    const FINE: usize = 50;

    /// K of the regulator that closes the chain of integrators at `bandwidth`, rad/s.
    fn regulator(lag_s: f64, bandwidth: f64) -> DMatrix<f64> {
        let plant = lagged_attitude_model(1, lag_s, SAMPLE_TIME_S).unwrap();
        let augmented = Augmented::new(&plant);
        let damping = 2.0 / (SAMPLE_TIME_S * bandwidth.powi(2)).powi(2);
        let q = DMatrix::from_diagonal(&DVector::from_vec(vec![0.0, damping, 0.0, 1.0]));
        let r = DMatrix::from_element(1, 1, 1.0 / (SAMPLE_TIME_S * bandwidth.powi(3)).powi(2));
        Dlqr::new(augmented.a(), augmented.b(), &q, &r, 1.0).unwrap().gain().clone()
    }

    /// Angle over time after a unit step of the command, every `SAMPLE_TIME_S / FINE`: the continuous plant, integrated by the
    /// midpoint rule, under the sampled law.
    fn simulated(lag_s: f64, gain: &DMatrix<f64>, duration_s: f64) -> Vec<f64> {
        let plant = lagged_attitude_model(1, lag_s, SAMPLE_TIME_S).unwrap();
        let a = Matrix3::from_fn(|i, j| plant.a()[(i, j)]);
        let b = Vector3::from_fn(|i, _| plant.b()[(i, 0)]);
        let inverse = a.try_inverse().unwrap();
        let k = Vector3::from_fn(|i, _| gain[(0, i)]);
        let fine_s = SAMPLE_TIME_S / FINE as f64;
        let (mut x, mut v) = (Vector3::new(-1.0, 0.0, 0.0), 0.0);
        let mut angles = Vec::new();
        for _ in 0..(duration_s / SAMPLE_TIME_S) as usize {
            let motion = x - inverse * (x - b * v);
            v += -k.dot(&motion) - gain[(0, 3)] * x[0];
            for _ in 0..FINE {
                angles.push(1.0 + x[0]);
                let rate = |x: &Vector3<f64>| Vector3::new(x[1], x[2], (v - x[2]) / lag_s);
                let middle = x + rate(&x) * (fine_s / 2.0);
                x += rate(&middle) * fine_s;
            }
        }
        angles
    }

    /// Step response of the two states.
    fn second_order(response: &AttitudeResponse, time_s: f64) -> f64 {
        let AttitudeResponse { natural_frequency_rad_s: w, damping: z } = *response;
        assert!(z < 1.0, "overdamped: {response:?}");
        let damped = w * (1.0 - z * z).sqrt();
        let decay = (-z * w * time_s).exp();
        1.0 - decay * ((damped * time_s).cos() + z * w / damped * (damped * time_s).sin())
    }

    /// The two states are as late as the simulated loop, and nowhere differ from it by more than an eighth of the step.
    #[test]
    fn two_states_answer_a_step_as_the_sampled_loop_does() {
        for lag_s in [0.005, 0.01, 0.03, 0.06, 0.1, 0.15, 0.2] {
            let bandwidth = (0.6 / (lag_s + SAMPLE_TIME_S / 2.0)).min(12.0);
            let gain = regulator(lag_s, bandwidth);
            let plant = lagged_attitude_model(1, lag_s, SAMPLE_TIME_S).unwrap();
            let response = AttitudeResponse::new(&plant, &gain, SAMPLE_TIME_S).unwrap();
            assert!((0.5..0.9).contains(&response.damping), "{lag_s} s: {response:?}");

            let angles = simulated(lag_s, &gain, 30.0 / bandwidth);
            let fine_s = SAMPLE_TIME_S / FINE as f64;
            let (mut moment, mut worst) = (0.0, 0.0_f64);
            for (index, angle) in angles.iter().enumerate() {
                let time_s = index as f64 * fine_s;
                moment += (1.0 - angle) * fine_s;
                worst = worst.max((angle - second_order(&response, time_s)).abs());
            }
            let delay = 2.0 * response.damping / response.natural_frequency_rad_s;
            assert!((moment - fine_s / 2.0 - delay).abs() < 2e-3 * delay, "{lag_s} s: {moment} {delay}");
            assert!(worst < 0.12, "{lag_s} s: {worst} off");
        }
    }
}
