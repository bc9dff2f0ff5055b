//! The torques that a turning body needs beside those of its controller.

use nalgebra::Vector3;

use crate::control::euler_equation::{angular_acceleration_rad_s2, gyroscopic_n_m};

/// Largest share of the torque about roll and pitch that is spent on them. What is not cancelled turns the angular velocity
/// and does no work, so that the loop stays damped whatever is left out.
const CANCELLED_SHARE: f64 = 0.5;

/// A turning body as its controller sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Spin {
    /// Believed moments of inertia, kg·m².
    pub(crate) inertia_kg_m2: Vector3<f64>,
    /// ω: p, q, r, rad/s.
    pub(crate) body_rate_rad_s: Vector3<f64>,
    /// That less the rate of the reference, rad/s.
    pub(crate) rate_error_rad_s: Vector3<f64>,
    /// Torque that turns it, N·m: the rotors' together with what disturbs it. What holds the body against that turns with the body.
    pub(crate) torque_n_m: Vector3<f64>,
    /// Delay of a commanded torque, s: the rotors' lag and half a sample.
    pub(crate) delay_s: f64,
}

/// What the controller's own torque J α is added to, N·m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Beside {
    /// The part of the torque that the rotors make which is not its own.
    pub(crate) made_n_m: Vector3<f64>,
    /// The torque to command beside the one that it commands.
    pub(crate) commanded_n_m: Vector3<f64>,
}

impl Spin {
    /// The largest rate of a lean, rad/s, at which the torque about roll and pitch, at most `most_n_m`, still cancels what turns
    /// it: τ = J_z r ω for a body of equal moments about roll and pitch.
    fn largest_rate_rad_s(&self, most_n_m: f64) -> f64 {
        let [roll, pitch, yaw]: [f64; 3] = self.inertia_kg_m2.into();
        let turned_kg_m2 = yaw + libm::fabs(roll - pitch);
        CANCELLED_SHARE * most_n_m / (turned_kg_m2 * libm::fabs(self.body_rate_rad_s.z))
    }

    /// The largest lean error, rad, that is closed with no more than that rate, by a loop that closes small errors at
    /// `closing_1_s` per error and turns from rest to rest over large ones: the angular momentum of a spin is turned slowly or not
    /// at all.
    pub(crate) fn largest_lean_rad(&self, most_n_m: f64, closing_1_s: f64) -> f64 {
        let rate = self.largest_rate_rad_s(most_n_m);
        let acceleration = most_n_m / self.inertia_kg_m2.xy().max();
        (rate / closing_1_s).max(rate * rate / acceleration)
    }

    /// The controller's model has a lean that stays where it is in the world while the body spins about its thrust axis.
    /// With the rate error δ and the spin r, a double integrator in axes that do not spin takes, in body axes,
    ///
    /// ```text
    /// τ = J α + g,   g = ω × Jω − J (r e₃ × δ)
    /// α̇ = (α_c − α)/T − r e₃ × α
    /// ```
    ///
    /// and rotors that answer with the lag T are there in time for τ_c = τ + T τ̇ = J α_c + g + T ġ − T J (r e₃ × α).
    ///
    /// About roll and pitch g is cut to a share of `most_n_m`, what the rotors can do about them: the angular momentum of a
    /// fast spin is more than they can turn, and holds the thrust axis still by itself.
    pub(crate) fn beside(&self, most_n_m: f64) -> Beside {
        let (inertia, rate) = (&self.inertia_kg_m2, &self.body_rate_rad_s);
        let spin = Vector3::z() * rate.z;
        let gyroscopic = |rate: &Vector3<f64>| gyroscopic_n_m(inertia, rate);
        let whole = gyroscopic(rate) - inertia.component_mul(&spin.cross(&self.rate_error_rad_s));
        let size = whole.xy().norm();
        let allowed = CANCELLED_SHARE * most_n_m;
        let share = if size > allowed { allowed / size } else { 1.0 };
        let lateral = Vector3::new(share, share, 1.0);
        let made_n_m = whole.component_mul(&lateral);

        let own = (self.torque_n_m - made_n_m).component_div(inertia);
        // It moves both ω and δ, if the reference keeps its rate.
        let turning = angular_acceleration_rad_s2(inertia, rate, &self.torque_n_m);
        let moved = gyroscopic(&(rate + turning * self.delay_s))
            - gyroscopic(rate)
            - inertia.component_mul(&spin.cross(&turning)) * self.delay_s;
        let led = moved.component_mul(&lateral) - inertia.component_mul(&spin.cross(&own)) * self.delay_s;
        Beside { made_n_m, commanded_n_m: made_n_m + Vector3::new(led.x, led.y, 0.0) }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Rotation3, Vector3};

    use super::{CANCELLED_SHARE, Spin};

    const INERTIA_KG_M2: Vector3<f64> = Vector3::new(0.1, 0.13, 0.2);
    const SPIN_RAD_S: f64 = 3.0;
    const DELAY_S: f64 = 0.03;
    /// More than any torque here.
    const STRONG_N_M: f64 = 1e3;
    const STEP_S: f64 = 1e-5;

    /// A body that spins about its thrust axis and leans at a rate, the reference of which only spins.
    fn spinning(lean_rad_s: Vector3<f64>, torque_n_m: Vector3<f64>) -> Spin {
        let rate_error_rad_s = Vector3::new(lean_rad_s.x, lean_rad_s.y, 0.0);
        Spin {
            inertia_kg_m2: INERTIA_KG_M2,
            body_rate_rad_s: rate_error_rad_s + Vector3::z() * SPIN_RAD_S,
            rate_error_rad_s,
            torque_n_m,
            delay_s: DELAY_S,
        }
    }

    /// Euler's equations, J ω̇ = τ − ω × Jω, for 0.2 s: the error at the end less the one that kept its direction in the world. `turn` tells
    /// what the torque, N·m, is next, from the spin.
    fn strays_rad_s(turn: impl Fn(&Spin) -> Vector3<f64>) -> f64 {
        let start = Vector3::new(0.2, -0.1, 0.0);
        let mut rate = start + Vector3::z() * SPIN_RAD_S;
        let mut torque_n_m = spinning(start, Vector3::zeros()).beside(STRONG_N_M).made_n_m;
        let mut time_s = 0.0;
        while time_s < 0.2 {
            torque_n_m = turn(&spinning(rate, torque_n_m));
            let gyroscopic = rate.cross(&INERTIA_KG_M2.component_mul(&rate));
            rate += (torque_n_m - gyroscopic).component_div(&INERTIA_KG_M2) * STEP_S;
            // The heading is another law's.
            rate.z = SPIN_RAD_S;
            time_s += STEP_S;
        }
        let kept = Rotation3::from_scaled_axis(Vector3::z() * (-SPIN_RAD_S * time_s)) * start;
        (rate - Vector3::z() * SPIN_RAD_S - kept).norm()
    }

    /// A lean that nothing changes goes on in its direction in the world while the body spins under it.
    #[test]
    fn without_commands_a_lean_keeps_its_direction_in_the_world() {
        let made = strays_rad_s(|spin| spin.beside(STRONG_N_M).made_n_m);
        assert!(made < 1e-4, "{made} rad/s");
        assert!(strays_rad_s(|_| Vector3::zeros()) > 0.05);
    }

    /// Behind rotors that answer with a lag the commanded torque is there in time; the one of now would come too late.
    #[test]
    fn commands_lead_the_rotors() {
        let answering = |spin: &Spin, commanded: Vector3<f64>| {
            spin.torque_n_m + (commanded - spin.torque_n_m) * (STEP_S / DELAY_S)
        };
        let led = strays_rad_s(|spin| answering(spin, spin.beside(STRONG_N_M).commanded_n_m));
        let late = strays_rad_s(|spin| answering(spin, spin.beside(STRONG_N_M).made_n_m));
        assert!(led < late / 5.0, "{led} {late} rad/s");
    }

    /// A spin that is more than the rotors can turn takes half of what they can do about roll and pitch.
    #[test]
    fn weak_rotors_spend_half_of_their_torque() {
        let spin = spinning(Vector3::new(2.0, 1.0, 0.0), Vector3::zeros());
        let whole = spin.beside(STRONG_N_M).made_n_m;
        let most_n_m = whole.xy().norm() / 2.0;
        let cut = spin.beside(most_n_m).made_n_m;
        assert!((cut.xy().norm() - CANCELLED_SHARE * most_n_m).abs() < 1e-12);
        assert!(cut.xy().normalize().dot(&whole.xy().normalize()) > 1.0 - 1e-12);
        assert_eq!(cut.z, whole.z);
    }
}
