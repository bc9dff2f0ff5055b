//! The thrust axis of a quadrotor without one of its rotors, as a linear-quadratic problem about a steady spin.
//!
//! With three rotors the heading cannot be held; the direction of the thrust can, while the body spins (Mueller and
//! D'Andrea, ICRA 2014). Body axes are turned here so that the lost rotor is the front one, and mirrored, if need be, so
//! that the spin is positive: the two rotors beside the lost one turn the same way and drive it.
//!
//! With n the wanted thrust axis (unit, down) in these axes and p, q, r the body rates:
//!
//! ```text
//! ṅ₁ = r n₂ − q n₃     J_x ṗ = y (f_left − f_right) − (J_z − J_y) q r
//! ṅ₂ = p n₃ − r n₁     J_y q̇ = l (f_lost − f_opposite) − x (f_left − f_right) + (J_z − J_x) p r
//! ```
//!
//! l is the distance of the lost rotor and the opposite one from the centre of mass, (x, y) the place of the right one: (0, l)
//! but in an "H". Products of inertia, which an airframe with J_x ≠ J_y has in turned axes, are left out.
//!
//! A body that leans by β towards the lost rotor and turns about the wanted axis, ω ∥ n, is in equilibrium when the
//! opposite rotor makes f_opposite = f_lost + (J_z − J_x) r² tan β / l. Its drag torque brakes the spin, so that the rate
//! settles where the opposite rotor makes half of the thrust: this vehicle needs no drag of the air for that.

use alloc::vec::Vec;

use lmpc::{DesignError, Discretization, Dlqr, StateSpace};
use nalgebra::{DMatrix, DVector, Matrix2x6, RowVector5, Vector2, Vector6};

use crate::Airframe;
use crate::plant::rotor_layout::RotorsAround;

/// β, rad: the spin settles at 8 rad/s with the default airframe, and the vehicle touches down no more askew.
pub(crate) const LEAN_RAD: f64 = 0.14;
/// Spin rates that the gains are designed for, rad/s: from the first to the last, this far apart.
const FIRST_SPIN_RAD_S: f64 = -1.0;
const SPIN_STEP_RAD_S: f64 = 1.0;
const SPINS: usize = 14;
/// Weights of n, of the rates, rad/s, and of the thrusts, N.
const AXIS_WEIGHT: f64 = 20.0;
const RATE_WEIGHT: f64 = 2.0;
const THRUST_WEIGHT: f64 = 1.0;

/// Spin rates that the gains of two opposite rotors are designed for, rad/s. Without a spin they can push about one axis only.
const FIRST_PAIR_SPIN_RAD_S: f64 = 2.0;
const PAIR_SPIN_STEP_RAD_S: f64 = 4.0;
const PAIR_SPINS: usize = 10;
/// Weight of their difference, N: they share the weight of the vehicle and have less to give.
const PAIR_THRUST_WEIGHT: f64 = 4.0;
/// What the law of two rotors looks at, among the states of the law of three.
const PAIR_STATES: [usize; 5] = [0, 1, 2, 3, 5];

/// Gains from [n₁ n₂ p q f_opposite f_left − f_right], as deviations, to [f_opposite, f_left − f_right], by spin rate.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ReducedAttitudeDesign {
    gains: Vec<Matrix2x6<f64>>,
    /// To f_left − f_right alone, when the opposite rotor is lost, too: upright, by spin rate.
    pair_gains: Vec<RowVector5<f64>>,
}

impl ReducedAttitudeDesign {
    /// For an airframe, its moments of inertia in the turned axes, kg·m², and a sample time, s.
    ///
    /// # Errors
    /// [`DesignError`] when a regulator does not exist.
    pub(crate) fn new(
        airframe: &Airframe,
        rotors: &RotorsAround,
        inertia_kg_m2: [f64; 3],
        sample_time_s: f64,
    ) -> Result<Self, DesignError> {
        let q = DMatrix::from_diagonal(&DVector::from_column_slice(&[
            AXIS_WEIGHT,
            AXIS_WEIGHT,
            RATE_WEIGHT,
            RATE_WEIGHT,
            0.0,
            0.0,
        ]));
        let r = DMatrix::from_diagonal_element(2, 2, THRUST_WEIGHT);
        let gain = |index: usize| {
            let spin_rad_s = FIRST_SPIN_RAD_S + SPIN_STEP_RAD_S * index as f64;
            let model = model(airframe, rotors, inertia_kg_m2, (spin_rad_s, LEAN_RAD), sample_time_s)?;
            let regulator = Dlqr::new(model.a(), model.b(), &q, &r, 1.0)?;
            Ok(Matrix2x6::from_fn(|row, column| regulator.gain()[(row, column)]))
        };
        let pair_gain = |index: usize| {
            let spin_rad_s = FIRST_PAIR_SPIN_RAD_S + PAIR_SPIN_STEP_RAD_S * index as f64;
            pair_gain(airframe, rotors, inertia_kg_m2, spin_rad_s, sample_time_s)
        };
        Ok(Self {
            gains: (0..SPINS).map(gain).collect::<Result<_, _>>()?,
            pair_gains: (0..PAIR_SPINS).map(pair_gain).collect::<Result<_, _>>()?,
        })
    }

    /// Deviation of f_left − f_right, N, when only these two are left. Faster than the last spin rate the gains fade: the rotors are too
    /// slow for it, and the spin holds the thrust axis by itself.
    pub(crate) fn pair_command_n(&self, spin_rad_s: f64, state: &RowVector5<f64>) -> f64 {
        let last = (PAIR_SPINS - 1) as f64;
        let place = (spin_rad_s - FIRST_PAIR_SPIN_RAD_S) / PAIR_SPIN_STEP_RAD_S;
        let fading = (1.0 - (place - last) / last).clamp(0.0, 1.0);
        let place = place.clamp(0.0, last);
        let below = place as usize;
        let share = place - below as f64;
        let command = |index: usize| self.pair_gains.get(index).map_or(0.0, |gain| -gain.dot(state));
        fading * (command(below) * (1.0 - share) + command((below + 1).min(PAIR_SPINS - 1)) * share)
    }

    /// Deviations of the commanded thrusts, N, from a deviation of the state at a spin rate, rad/s.
    pub(crate) fn command_n(&self, spin_rad_s: f64, state: &Vector6<f64>) -> Vector2<f64> {
        let place = ((spin_rad_s - FIRST_SPIN_RAD_S) / SPIN_STEP_RAD_S).clamp(0.0, (SPINS - 1) as f64);
        let below = place as usize;
        let share = place - below as f64;
        let command =
            |index: usize| self.gains.get(index).map_or_else(Vector2::zeros, |gain| -(gain * state));
        command(below) * (1.0 - share) + command((below + 1).min(SPINS - 1)) * share
    }
}

/// The regulator of two opposite rotors, upright at a spin rate.
fn pair_gain(
    airframe: &Airframe,
    rotors: &RotorsAround,
    inertia_kg_m2: [f64; 3],
    spin_rad_s: f64,
    sample_time_s: f64,
) -> Result<RowVector5<f64>, DesignError> {
    let whole = model(airframe, rotors, inertia_kg_m2, (spin_rad_s, 0.0), sample_time_s)?;
    let a = whole.a().select_rows(&PAIR_STATES).select_columns(&PAIR_STATES);
    let b = whole.b().select_rows(&PAIR_STATES).columns(1, 1).into_owned();
    let weights = [AXIS_WEIGHT, AXIS_WEIGHT, RATE_WEIGHT, RATE_WEIGHT, 0.0];
    let q = DMatrix::from_diagonal(&DVector::from_column_slice(&weights));
    let r = DMatrix::from_diagonal_element(1, 1, PAIR_THRUST_WEIGHT);
    let regulator = Dlqr::new(&a, &b, &q, &r, 1.0)?;
    Ok(RowVector5::from_fn(|_, column| regulator.gain()[(0, column)]))
}

/// The linear model about a steady spin, with the rotors' lag.
fn model(
    airframe: &Airframe,
    rotors: &RotorsAround,
    [jx, jy, jz]: [f64; 3],
    (spin_rad_s, lean_rad): (f64, f64),
    sample_time_s: f64,
) -> Result<StateSpace, DesignError> {
    let (l, lag) = (airframe.arm_length_m, 1.0 / airframe.mean_rotor_lag_s());
    // l_o of the lost and the opposite rotor, and the place of the right one.
    let (opposite, right) = (l * rotors.distance, rotors.right * l);
    let (n1, n3) = (libm::sin(lean_rad), libm::cos(lean_rad));
    let r = spin_rad_s;
    let p = r * n1 / n3;
    let mut a = DMatrix::zeros(6, 6);
    // n₃ = √(1 − n₁² − n₂²) moves with n₁.
    (a[(0, 1)], a[(0, 3)]) = (r, -n3);
    (a[(1, 0)], a[(1, 2)]) = (-r - p * n1 / n3, n3);
    (a[(2, 3)], a[(2, 5)]) = (-(jz - jy) * r / jx, right.y / jx);
    (a[(3, 2)], a[(3, 4)], a[(3, 5)]) = ((jz - jx) * r / jy, -opposite / jy, -right.x / jy);
    (a[(4, 4)], a[(5, 5)]) = (-lag, -lag);
    let mut b = DMatrix::zeros(6, 2);
    (b[(4, 0)], b[(5, 1)]) = (lag, lag);
    let c = DMatrix::identity(2, 6);
    StateSpace::from_continuous(&a, &b, &c, sample_time_s, Discretization::ZeroOrderHold)
}

#[cfg(test)]
mod tests {
    use lmpc::spectral_radius;
    use nalgebra::{DMatrix, Vector6};

    use super::{FIRST_SPIN_RAD_S, ReducedAttitudeDesign, SPIN_STEP_RAD_S, SPINS, model};
    use crate::Airframe;

    /// At the spin rates of the design and between them.
    #[test]
    fn the_thrust_axis_is_stable_at_every_spin_rate() {
        let airframe = Airframe::default();
        let rotors = airframe.layout.around(0).expect("opposite rotors");
        let design =
            ReducedAttitudeDesign::new(&airframe, &rotors, airframe.inertia_kg_m2, 0.01).expect("regulators");
        for step in 0..4 * (SPINS - 1) {
            let spin_rad_s = FIRST_SPIN_RAD_S + SPIN_STEP_RAD_S * step as f64 / 4.0;
            let model =
                model(&airframe, &rotors, airframe.inertia_kg_m2, (spin_rad_s, super::LEAN_RAD), 0.01)
                    .expect("a model");
            let gain = DMatrix::from_fn(2, 6, |row, column| {
                let mut state = Vector6::zeros();
                state[column] = 1.0;
                -design.command_n(spin_rad_s, &state)[row]
            });
            let radius = spectral_radius("A − BK", &(model.a() - model.b() * gain)).expect("finite");
            assert!(radius < 0.997, "{radius} at {spin_rad_s} rad/s");
        }
    }
}
