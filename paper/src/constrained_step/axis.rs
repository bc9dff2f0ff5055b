//! One axis of the cascade: its linear model, weights and limits.

use lmpc::{Augmented, DesignError, Discretization, Limit, Quantity, StateSpace, Weights};
use nalgebra::{DMatrix, dmatrix, dvector};
use quadrotor::{Airframe, ControllerSettings, Controllers, GRAVITY_M_S2, Limits, limited_samples};

/// Share of the tilt limit that the cascade commands: a raw step overshoots the command.
const COMMANDED_TILT_SHARE: f64 = 0.6;

/// Samples of the altitude's limits: all of 1.5 s.
static ALTITUDE: &[usize] = &[
    0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28,
    29,
];
/// Samples of the position's limits: fifteen of 4.3 s, each gap a third longer than the one before.
static POSITION: &[usize] = &[0, 1, 2, 3, 4, 6, 8, 11, 15, 20, 27, 36, 48, 64, 85];

/// ÿ = gain · u with y m or rad, sampled with a zero-order hold, as the cascade has it.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// "position", "altitude", "roll" or "yaw".
    pub name: &'static str,
    /// Unit of the output, "m" or "rad".
    pub unit: &'static str,
    /// ÿ over u.
    pub gain: f64,
    /// ΔT, s.
    pub sample_time_s: f64,
    /// Q on y − r, on Δẏ, and R on Δu.
    pub output_weight: f64,
    /// See `output_weight`.
    pub rate_weight: f64,
    /// See `output_weight`.
    pub increment_weight: f64,
    /// Least and largest input.
    pub input: [f64; 2],
    /// Largest increment of the input per sample; infinite for none.
    pub increment: f64,
    /// Least and largest ẏ, soft; infinite for none.
    pub rate: [f64; 2],
    /// N_p.
    pub horizon: usize,
    /// a.
    pub scale: f64,
    /// Samples that limits are placed on.
    pub limited: &'static [usize],
    /// Set-points of the steps from rest at 0.
    pub steps: &'static [f64],
}

const NONE: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

impl Axis {
    /// The four axes of the cascade's defaults; pitch is roll and east is north.
    pub fn all() -> [Self; 4] {
        let (controllers, limits, airframe) =
            (Controllers::default(), Limits::default(), Airframe::default());
        [
            Self::position(&controllers, &limits),
            Self::altitude(&controllers, &limits),
            Self::roll(&controllers, &airframe),
            Self::yaw(&controllers, &airframe),
        ]
    }

    /// (10)–(11), north, with the tilt as u: ẍ = g u, the sign of θ turned.
    fn position(controllers: &Controllers, limits: &Limits) -> Self {
        let settings = &controllers.position;
        let tilt = (COMMANDED_TILT_SHARE * limits.tilt_rad).tan();
        let speed = limits.speed_horizontal_m_s;
        Self {
            input: [-tilt, tilt],
            increment: limits.tilt_rate_rad_s * settings.sample_time_s(),
            rate: [-speed, speed],
            limited: POSITION,
            steps: &[1.0, 5.0, 20.0],
            ..Self::of("position", "m", GRAVITY_M_S2, settings, 0)
        }
    }

    /// (7), z down: climbing is negative.
    fn altitude(controllers: &Controllers, limits: &Limits) -> Self {
        Self {
            input: [GRAVITY_M_S2 * (1.0 - limits.thrust_max), GRAVITY_M_S2 * (1.0 - limits.thrust_min)],
            rate: [-limits.speed_up_m_s, limits.speed_down_m_s],
            limited: ALTITUDE,
            steps: &[-1.0, -5.0, -20.0, 1.0, 5.0, 20.0],
            ..Self::of("altitude", "m", 1.0, &controllers.altitude, 0)
        }
    }

    /// (17).
    fn roll(controllers: &Controllers, airframe: &Airframe) -> Self {
        let torque = 2.0 * airframe.arm_length_m * rotor_room_n(airframe);
        Self {
            input: [-torque, torque],
            limited: limited_samples::ATTITUDE,
            steps: &[0.3, 1.0],
            ..Self::of("roll", "rad", airframe.inertia_kg_m2[0].recip(), &controllers.attitude, 0)
        }
    }

    /// (21), with τ_ψ.
    fn yaw(controllers: &Controllers, airframe: &Airframe) -> Self {
        let lever_m = airframe.torque_coefficient_n_m_s2 / airframe.thrust_coefficient_n_s2;
        let torque = 4.0 * lever_m * rotor_room_n(airframe);
        Self {
            input: [-torque, torque],
            limited: limited_samples::ATTITUDE,
            steps: &[0.3, 1.0],
            ..Self::of("yaw", "rad", airframe.inertia_kg_m2[2].recip(), &controllers.attitude, 2)
        }
    }

    fn of<const P: usize>(
        name: &'static str,
        unit: &'static str,
        gain: f64,
        settings: &ControllerSettings<P>,
        channel: usize,
    ) -> Self {
        Self {
            name,
            unit,
            gain,
            sample_time_s: settings.sample_time_s(),
            output_weight: settings.output_weight[channel],
            rate_weight: settings.rate_weight[channel],
            increment_weight: settings.increment_weight[channel],
            input: NONE,
            increment: f64::INFINITY,
            rate: NONE,
            horizon: settings.prediction_horizon as usize,
            scale: settings.scale,
            limited: &[],
            steps: &[],
        }
    }

    /// The model.
    ///
    /// # Errors
    /// [`DesignError::SampleTime`].
    pub fn model(&self) -> Result<StateSpace, DesignError> {
        let (a, b, c) = (dmatrix![0.0, 1.0; 0.0, 0.0], dmatrix![0.0; self.gain], dmatrix![1.0, 0.0]);
        StateSpace::from_continuous(&a, &b, &c, self.sample_time_s, Discretization::ZeroOrderHold)
    }

    /// Q on \[Δy, Δẏ, y − r\] and R.
    ///
    /// # Errors
    /// As [`Weights::new`].
    pub fn weights(&self, model: &Augmented) -> Result<Weights, DesignError> {
        let q = DMatrix::from_diagonal(&dvector![0.0, self.rate_weight, self.output_weight]);
        Weights::new(model, q, dmatrix![self.increment_weight])
    }

    /// Limits on the given samples, and their bounds; increments only within the first `moves`, as there are none
    /// later.
    pub fn limits(&self, samples: &[usize], moves: usize) -> (Vec<Limit>, Vec<f64>) {
        let mut limits = vec![Limit::range(Quantity::Input, 1, samples.iter().copied())];
        let mut bounds = vec![self.input[1], -self.input[0]];
        if self.increment.is_finite() {
            let moving = samples.iter().copied().filter(|&sample| sample < moves);
            limits.push(Limit::range(Quantity::Increment, 1, moving));
            bounds.extend([self.increment; 2]);
        }
        if self.rate[1].is_finite() {
            // The input at sample m shows in the state at m + 1.
            let samples = samples.iter().map(|sample| sample + 1).collect();
            let directions = dmatrix![0.0, 1.0; 0.0, -1.0];
            limits.push(Limit { quantity: Quantity::State, directions, samples, soft: true });
            bounds.extend([self.rate[1], -self.rate[0]]);
        }
        (limits, bounds)
    }

    /// The name of a step: "altitude step of 5 m down".
    pub fn problem(&self, step: f64) -> String {
        let direction = match self.name {
            "altitude" if step < 0.0 => " up",
            "altitude" => " down",
            _ => "",
        };
        format!("{} step of {} {}{direction}", self.name, step.abs(), self.unit)
    }
}

/// By how much the thrust of each rotor can differ from that in hover without changing the sum, N.
fn rotor_room_n(airframe: &Airframe) -> f64 {
    (airframe.weight_n() - airframe.thrust_range_n().0) / 4.0
}
