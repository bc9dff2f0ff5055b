//! The closed attitude loop as the position controller predicts it.

use lmpc::{DesignError, Discretization, StateSpace};
use nalgebra::{DMatrix, DVector};

/// The closed loop of roll or pitch, from the commanded angle to the angle, under a law that goes by the deviation from its
/// reference:
///
/// ```text
/// v(k) = s (x(k) − [θ_c 0 0]ᵀ) + f v(k−1)        x = [θ θ̇ α], α the angular acceleration that the rotors make
/// ẋ    = [θ̇ α (v − α)/T]ᵀ                        T the rotors' lag
/// ```
///
/// All four of its states are known to the controllers: angle and rate are measured, α follows from the rotors' speeds, v was
/// commanded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AttitudeLoop {
    /// s.
    by_state: [f64; 3],
    /// f.
    by_input: f64,
    /// T, s.
    rotor_lag_s: f64,
    sample_time_s: f64,
    delay_s: f64,
}

impl AttitudeLoop {
    /// Of one axis, states θ, θ̇ and α, under the gain K, 1×4 on \[Δx; θ − θ_c\]: Δx is the motion which, by the model, leads to
    /// x under the last input.
    ///
    /// # Errors
    /// [`DesignError::NotFinite`] when the model's A cannot be inverted or the loop does not settle.
    pub(crate) fn new(
        plant: &StateSpace,
        gain: &DMatrix<f64>,
        rotor_lag_s: f64,
        sample_time_s: f64,
    ) -> Result<Self, DesignError> {
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
        // ∫ e dt after a step of the command, by the trapezoidal rule: T (Σ e_k − ½).
        let delay_s = sample_time_s * (sum_from_unit_error(&transition)? - 0.5);
        if !(delay_s > 0.0 && delay_s.is_finite()) {
            return Err(DesignError::NotFinite { name: "the attitude's step response" });
        }
        Ok(Self {
            by_state: [by_state[0], by_state[1], by_state[2]],
            by_input: by_input[(0, 0)],
            rotor_lag_s,
            sample_time_s,
            delay_s,
        })
    }

    /// By how much the angle lags behind a slow command, s: ∫ e dt of the error e after a unit step of the command.
    pub fn delay_s(&self) -> f64 {
        self.delay_s
    }

    /// A body with a drag per mass over this loop, sampled every `sample_time_s`, in units of acceleration: states x, ẋ, the
    /// acceleration a by the thrust, its derivative, the one after it that the rotors make, and the one that they are asked for; input
    /// the commanded a; output x.
    ///
    /// ```text
    /// ẍ = a − drag ẋ
    /// ```
    ///
    /// Between two samples the command is held and the attitude controller samples as often as it fits, rounded.
    ///
    /// # Errors
    /// [`DesignError::SampleTime`] unless the sample time is positive.
    pub(crate) fn under_position(
        &self,
        drag_1_s: f64,
        sample_time_s: f64,
    ) -> Result<StateSpace, DesignError> {
        const STATES: usize = 5;
        let samples = libm::round(sample_time_s / self.sample_time_s).max(1.0);
        let lag = 1.0 / self.rotor_lag_s;
        let mut a = DMatrix::zeros(STATES, STATES);
        for derivative in 0..STATES - 1 {
            a[(derivative, derivative + 1)] = 1.0;
        }
        a[(1, 1)] = -drag_1_s;
        a[(4, 4)] = -lag;
        let mut b = DMatrix::zeros(STATES, 1);
        b[(4, 0)] = lag;
        let held = StateSpace::from_continuous(
            &a,
            &b,
            &DMatrix::identity(STATES, STATES),
            sample_time_s / samples,
            Discretization::ZeroOrderHold,
        )?;
        // v⁺ = s [ẍ − u; x⃛; ẍ̈] + f v, then all but v move under v⁺.
        let mut law = DMatrix::zeros(1, STATES + 1);
        for (place, gain) in self.by_state.iter().enumerate() {
            law[(0, 2 + place)] = *gain;
        }
        law[(0, STATES)] = self.by_input;
        let by_command = -self.by_state[0];
        let mut step = DMatrix::zeros(STATES + 1, STATES + 1);
        step.view_mut((0, 0), (STATES, STATES)).copy_from(held.a());
        let moved = held.b() * &law;
        let mut states = step.view_mut((0, 0), (STATES, STATES + 1));
        states += &moved;
        step.view_mut((STATES, 0), (1, STATES + 1)).copy_from(&law);
        let mut input = DMatrix::zeros(STATES + 1, 1);
        input.view_mut((0, 0), (STATES, 1)).copy_from(&(held.b() * by_command));
        input[(STATES, 0)] = by_command;

        let mut transition = DMatrix::identity(STATES + 1, STATES + 1);
        let mut driven = DMatrix::zeros(STATES + 1, 1);
        for _ in 0..samples as usize {
            transition = &step * transition;
            driven = &step * driven + &input;
        }
        let mut output = DMatrix::zeros(1, STATES + 1);
        output[(0, 0)] = 1.0;
        StateSpace::new(transition, driven, output)
    }
}

/// Σ e_k of the first component of z, from z = e₁ on: the first component of (I − M)⁻¹ e₁.
fn sum_from_unit_error(transition: &DMatrix<f64>) -> Result<f64, DesignError> {
    let size = transition.nrows();
    let mut start = DVector::zeros(size);
    start[0] = 1.0;
    let sum = (DMatrix::identity(size, size) - transition).lu().solve(&start);
    Ok(sum.ok_or(DesignError::NotFinite { name: "(I − M)⁻¹" })?[0])
}

#[cfg(test)]
mod tests {
    use nalgebra::DVector;

    use crate::{CascadeDesign, Configuration};

    /// The lift to the position's samples is exact: as an integration of the motion in fine steps under a law that samples by itself.
    #[test]
    fn the_position_sees_what_the_sampled_loop_does() {
        const FINE: usize = 2_000;
        let design = CascadeDesign::new(&Configuration::default()).expect("a design");
        let attitude = design.attitude_loop().expect("a loop");
        let drag_1_s = 0.4;
        let model = attitude.under_position(drag_1_s, 0.05).expect("a model");
        for excited in 0..7 {
            let mut state = DVector::zeros(6);
            let command = if excited == 6 { 1.0 } else { 0.0 };
            if excited < 6 {
                state[excited] = 1.0;
            }
            let foreseen = model.a() * &state + model.b() * command;
            let [mut x, mut v, mut a, mut j, mut s, mut asked] = core::array::from_fn(|place| state[place]);
            let step_s = attitude.sample_time_s / FINE as f64;
            for _ in 0..5 {
                let [by_angle, by_rate, by_acceleration] = attitude.by_state;
                asked =
                    by_angle * (a - command) + by_rate * j + by_acceleration * s + attitude.by_input * asked;
                for _ in 0..FINE {
                    // The midpoint rule.
                    let rate = |s: f64| (asked - s) / attitude.rotor_lag_s;
                    let half = step_s / 2.0;
                    let [v_m, a_m, j_m] = [v + half * (a - drag_1_s * v), a + half * j, j + half * s];
                    let s_m = s + half * rate(s);
                    x += step_s * v_m;
                    v += step_s * (a_m - drag_1_s * v_m);
                    a += step_s * j_m;
                    j += step_s * s_m;
                    s += step_s * rate(s_m);
                }
            }
            let flown = DVector::from_column_slice(&[x, v, a, j, s, asked]);
            let size = 1.0 + flown.amax();
            assert!((&foreseen - &flown).amax() < 1e-6 * size, "{excited}: {foreseen} {flown}");
        }
    }

    /// A slow command is followed as late as the rotors answer and the loop closes: by more than the lag and less than a few times it.
    #[test]
    fn it_lags_by_more_than_its_rotors() {
        for lag_s in [0.02, 0.03, 0.1] {
            let mut configuration = Configuration::default();
            configuration.airframe.rotor_time_constant_s = lag_s;
            let design = CascadeDesign::new(&configuration).expect("a design");
            let delay_s = design.attitude_loop().expect("a loop").delay_s();
            assert!((lag_s..0.15 + 4.0 * lag_s).contains(&delay_s), "{lag_s}: {delay_s}");
        }
    }
}
