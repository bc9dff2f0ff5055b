//! The linear models of the paper's three controllers, and of the attitude with its rotors.

use alloc::vec; // used by dmatrix!

use lmpc::{DesignError, Discretization, StateSpace};
use nalgebra::{DMatrix, dmatrix};

use crate::GRAVITY_M_S2;

/// Chains of two integrators, one per input: ẍ_i = gain_i u_i, y_i = x_i.
pub(crate) fn double_integrators(
    gains: &[f64],
    sample_time_s: f64,
    discretization: Discretization,
) -> Result<StateSpace, DesignError> {
    let count = gains.len();
    let mut a = DMatrix::zeros(2 * count, 2 * count);
    let mut b = DMatrix::zeros(2 * count, count);
    let mut c = DMatrix::zeros(count, 2 * count);
    for (i, gain) in gains.iter().enumerate() {
        a[(2 * i, 2 * i + 1)] = 1.0;
        b[(2 * i + 1, i)] = *gain;
        c[(i, 2 * i)] = 1.0;
    }
    StateSpace::from_continuous(&a, &b, &c, sample_time_s, discretization)
}

/// (9): states z, v_z; input G = z̈; output z.
///
/// # Errors
/// [`DesignError::SampleTime`] unless the sample time is positive.
pub fn altitude_model(sample_time_s: f64, discretization: Discretization) -> Result<StateSpace, DesignError> {
    double_integrators(&[1.0], sample_time_s, discretization)
}

/// (15): states x, v_x, y, v_y; inputs θ, φ; outputs x, y.
///
/// # Errors
/// [`DesignError::SampleTime`] unless the sample time is positive.
pub fn position_model(sample_time_s: f64, discretization: Discretization) -> Result<StateSpace, DesignError> {
    double_integrators(&[-GRAVITY_M_S2, GRAVITY_M_S2], sample_time_s, discretization)
}

/// (9) with the rotors' lag τ and a drag per mass, 1/s: states z, v_z and a, the acceleration by the thrust and gravity; input G;
/// output z.
///
/// ```text
/// z̈ = a − drag v_z
/// ȧ = (G − a)/τ
/// ```
///
/// # Errors
/// [`DesignError::SampleTime`] unless the sample time is positive, [`DesignError::ElementNotFinite`] for a time constant of 0.
pub fn altitude_model_with_lag(
    time_constant_s: f64,
    drag_1_s: f64,
    sample_time_s: f64,
) -> Result<StateSpace, DesignError> {
    let a = dmatrix![0.0, 1.0, 0.0; 0.0, -drag_1_s, 1.0; 0.0, 0.0, -1.0 / time_constant_s];
    let b = dmatrix![0.0; 0.0; 1.0 / time_constant_s];
    let c = dmatrix![1.0, 0.0, 0.0];
    StateSpace::from_continuous(&a, &b, &c, sample_time_s, Discretization::ZeroOrderHold)
}

/// (23), with τ_ψ where (21) misprints τ_θ and the output matrix whose ones were lost in print: states
/// φ, φ̇, θ, θ̇, ψ, ψ̇; inputs τ_φ, τ_θ, τ_ψ; outputs φ, θ, ψ.
///
/// # Errors
/// [`DesignError::SampleTime`] unless the sample time is positive, [`DesignError::ElementNotFinite`] when a
/// moment of inertia, kg·m², is 0.
pub fn attitude_model(
    inertia_kg_m2: &[f64; 3],
    sample_time_s: f64,
    discretization: Discretization,
) -> Result<StateSpace, DesignError> {
    double_integrators(&inertia_kg_m2.map(f64::recip), sample_time_s, discretization)
}

/// (23) in angular accelerations, with the rotors that make them: each of `axes` has the angle, its rate and the angular
/// acceleration that the rotors have reached; inputs are the angular accelerations that they are asked for, outputs the angles.
///
/// ```text
/// φ̈ = α,  α̇ = (α_c − α)/T
/// ```
///
/// With a lag T of 0 the rotors answer at once, as in (23): α is then the last input.
///
/// # Errors
/// [`DesignError::SampleTime`] unless the sample time is positive.
pub fn lagged_attitude_model(
    axes: usize,
    rotor_lag_s: f64,
    sample_time_s: f64,
) -> Result<StateSpace, DesignError> {
    let axis = if rotor_lag_s > 0.0 {
        let a = dmatrix![0.0, 1.0, 0.0; 0.0, 0.0, 1.0; 0.0, 0.0, -1.0 / rotor_lag_s];
        let b = dmatrix![0.0; 0.0; 1.0 / rotor_lag_s];
        let c = dmatrix![1.0, 0.0, 0.0];
        StateSpace::from_continuous(&a, &b, &c, sample_time_s, Discretization::ZeroOrderHold)?
    } else {
        let prompt = double_integrators(&[1.0], sample_time_s, Discretization::ZeroOrderHold)?;
        let (mut a, mut b) = (prompt.a().clone().resize(3, 3, 0.0), prompt.b().clone().resize(3, 1, 0.0));
        (a[(2, 2)], b[(2, 0)]) = (0.0, 1.0);
        StateSpace::new(a, b, prompt.c().clone().resize(1, 3, 0.0))?
    };
    let blocks = |block: &DMatrix<f64>| DMatrix::<f64>::identity(axes, axes).kronecker(block);
    StateSpace::new(blocks(axis.a()), blocks(axis.b()), blocks(axis.c()))
}

#[cfg(test)]
mod tests {
    use super::{altitude_model_with_lag, lagged_attitude_model};

    /// α(t) = u (1 − e^(−t/T)), integrated once and twice; for T → 0 the double integrator.
    #[test]
    fn rotors_answer_a_held_command_exponentially() {
        let t = 0.02_f64;
        for lag in [0.005, 0.03, 0.2] {
            let plant = lagged_attitude_model(2, lag, t).expect("a model");
            assert_eq!((plant.states(), plant.inputs(), plant.outputs()), (6, 2, 2));
            let gone = 1.0 - (-t / lag).exp();
            let rate = t - lag * gone;
            let angle = t * t / 2.0 - lag * rate;
            for (row, expected) in [angle, rate, gone].into_iter().enumerate() {
                assert!((plant.b()[(3 + row, 1)] - expected).abs() < 1e-14, "{lag} s, row {row}");
                assert_eq!((plant.b()[(row, 1)], plant.b()[(3 + row, 0)]), (0.0, 0.0));
            }
        }
        let prompt = lagged_attitude_model(1, 0.0, t).expect("a model");
        let soon = lagged_attitude_model(1, 1e-6, t).expect("a model");
        assert!((prompt.a() - soon.a()).amax() < 1e-6 && (prompt.b() - soon.b()).amax() < 1e-4);
    }

    /// v̇ = G (1 − e^(−t/τ)) − d v from rest: v(t) = (1 − e^(−d t))/d + (e^(−t/τ) − e^(−d t))/(1/τ − d) for G of 1.
    #[test]
    fn drag_slows_a_climb() {
        let (t, drag, lag) = (0.5_f64, 0.8, 0.05);
        let plant = altitude_model_with_lag(lag, drag, t).expect("a model");
        let (coasting, answering) = ((-drag * t).exp(), (-t / lag).exp());
        let speed = (1.0 - coasting) / drag + (answering - coasting) / (1.0 / lag - drag);
        assert!((plant.b()[(1, 0)] - speed).abs() < 1e-12, "{} {speed}", plant.b());
        assert!((plant.a()[(1, 1)] - coasting).abs() < 1e-12, "{}", plant.a());
        assert!((plant.a()[(0, 1)] - (1.0 - coasting) / drag).abs() < 1e-12, "{}", plant.a());
    }
}
