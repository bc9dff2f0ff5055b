//! Everything about a flight that does not change while it lasts.

use nalgebra::{SVector, Vector3};
use serde::{Deserialize, Serialize};

use crate::{Airframe, AirframePreset};

/// The whole configuration: plain data, checked when a [`Simulation`](crate::Simulation) is made of it.
///
/// [`PARAMETERS`](crate::PARAMETERS) lists every field with its public name, unit and range.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Configuration {
    /// The airframe that values at their start values stand for. Only [`Configuration::resolved`] applies it; what flies must have
    /// [`AirframePreset::Paper`] here.
    #[serde(default)]
    pub preset: AirframePreset,
    /// The vehicle.
    pub airframe: Airframe,
    /// The world around it.
    pub environment: Environment,
    /// Where the flight begins.
    pub initial: InitialState,
    /// The three controllers.
    pub controllers: Controllers,
    /// What the controllers see of the vehicle.
    pub sensors: Sensors,
    /// What the controllers and the shaper keep within.
    pub limits: Limits,
    /// Whether references pass through the jerk-limited shaper.
    pub reference: ReferenceSettings,
}

impl Configuration {
    /// Mass that the controllers believe in, kg.
    pub(crate) fn believed_mass_kg(&self) -> f64 {
        self.airframe.mass_kg * self.controllers.mass_factor
    }

    /// The same with another belief in the mass, and so in the inertia.
    pub(crate) fn with_mass_factor(&self, mass_factor: f64) -> Self {
        Self { controllers: Controllers { mass_factor, ..self.controllers }, ..*self }
    }

    /// Believes in these moments of inertia, kg·m².
    pub(crate) fn believe_inertia_kg_m2(&mut self, inertia_kg_m2: &Vector3<f64>) {
        self.airframe.inertia_kg_m2 = (inertia_kg_m2 / self.controllers.mass_factor).into();
    }

    /// Drag per mass that the controllers believe in, along the world axes, 1/s.
    pub(crate) fn drag_1_s(&self) -> Vector3<f64> {
        Vector3::from(self.airframe.drag_n_s_m) / self.believed_mass_kg()
    }

    /// Moments of inertia that the controllers believe in, kg·m²: they grow with the mass.
    pub(crate) fn believed_inertia_kg_m2(&self) -> Vector3<f64> {
        Vector3::from(self.airframe.inertia_kg_m2) * self.controllers.mass_factor
    }
}

/// The world around the vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Environment {
    /// Whether there is ground at z = 0. Off by default: the paper flies in free space.
    pub ground_plane: bool,
}

/// State at the start of the flight.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct InitialState {
    /// Position in NED, m.
    pub position_m: [f64; 3],
    /// Velocity in NED, m/s.
    pub velocity_m_s: [f64; 3],
    /// Euler angles φ, θ, ψ (ZYX), rad.
    pub attitude_rad: [f64; 3],
    /// Body rates p, q, r in FRD, rad/s.
    pub body_rate_rad_s: [f64; 3],
    /// Drawn share of the battery's charge: 0 is full.
    #[serde(default)]
    pub discharge: f64,
}

/// How references are treated before the cascade sees them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReferenceSettings {
    /// On: a position reference is a goal, approached on a jerk-limited profile within the speed,
    /// acceleration and jerk limits. Off: position, velocity and acceleration go straight to the cascade.
    pub shaping: bool,
}

impl Default for ReferenceSettings {
    fn default() -> Self {
        Self { shaping: cfg!(feature = "shaper") }
    }
}

/// What the controllers see of the vehicle: the true state unless there is noise. All noise is white and
/// Gaussian, and drawn anew for each sample of a controller.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Sensors {
    /// Off: position, velocity, attitude and body rates are measured. On: position and attitude only, and a
    /// stationary Kalman predictor (26) estimates the rest. Off, it filters position and velocity when one of them is noisy.
    pub output_feedback: bool,
    /// Standard deviation of the position, per axis, m.
    pub position_noise_m: f64,
    /// Standard deviation of the velocity, per axis, m/s.
    pub velocity_noise_m_s: f64,
    /// Standard deviation of the attitude, per body axis, rad.
    pub attitude_noise_rad: f64,
    /// Standard deviation of the body rates, rad/s.
    pub body_rate_noise_rad_s: f64,
    /// Selects one of 2³² sequences of noise.
    pub seed: u32,
}

/// Which controller flies. All are designed on the same models with the same weights.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum ControllerKind {
    /// Laguerre MPC under limits (35)–(57).
    #[default]
    Lmpc,
    /// State-space MPC under the same limits (24)–(34), told of the disturbance that a Kalman predictor finds.
    StateSpaceMpc,
    /// The linear-quadratic regulator with integral action (54). It knows no limits: what exceeds them is cut
    /// off, and large errors are shortened to what the vehicle can brake.
    Dlqr,
}

/// Which models the controllers predict with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum PredictionModel {
    /// With the loop inside: the attitude with the rotors' lag.
    #[default]
    InnerLoops,
    /// As the paper prints them: (9), (15) and (23), whose inputs act at once.
    Paper,
}

/// The cascade: position → tilt, altitude → thrust, attitude → torques (Figure 2).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Controllers {
    /// Which controller flies.
    pub kind: ControllerKind,
    /// Which models it predicts with.
    pub model: PredictionModel,
    /// Whether the regulator sees a distant set-point only as far away as the vehicle can brake from the speed that it calls for:
    /// it knows no limits. The predictive controllers foresee theirs and are never governed.
    pub governor: bool,
    /// Mass that the controllers believe in, as a multiple of the true one: a way to fly with a wrong
    /// model.
    pub mass_factor: f64,
    /// Whether mass and drag are learned in flight: what was learned then takes the place of `mass_factor` and the
    /// airframe's drag, which it begins with.
    pub learning: bool,
    /// Altitude controller on (9), input G.
    pub altitude: ControllerSettings<1>,
    /// Position controller on (15), inputs θ, φ for outputs x, y. Below it is the closed attitude loop.
    pub position: ControllerSettings<2>,
    /// Attitude controller on (23) with the rotors' lag, outputs φ, θ, ψ. Its inputs are angular accelerations, J⁻¹ τ, so that
    /// its weights do not depend on the vehicle. Roll and pitch share one bandwidth ω, yaw has its own; a, N_p, α and λ are those of
    /// roll and pitch, and yaw has them on its own time scale.
    pub attitude: ControllerSettings<3>,
}

/// One controller with P inputs and P outputs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ControllerSettings<const P: usize> {
    /// ΔT, µs.
    pub sample_time_us: u64,
    /// N, Laguerre terms per input.
    pub terms: u32,
    /// a, Laguerre scaling factor.
    pub scale: f64,
    /// N_p, prediction horizon in samples.
    pub prediction_horizon: u32,
    /// N_c, moves per input of the state-space MPC.
    pub control_horizon: u32,
    /// α > 1: exponential data weighting with transformed weights; α = 1: the Riccati solution as
    /// terminal weight.
    pub alpha: f64,
    /// λ, degree of stability.
    pub lambda: f64,
    /// Diagonal of Q on y − r, per output. This and the other weights are relative to the bandwidth ω of the loop: the stage cost of
    /// an error e and an input u is w_output e² + w_damping (ė/ω)² + w_rate (ë/ω²)² + w_increment (u̇/ω³)².
    pub output_weight: SVector<f64, P>,
    /// Weight of each output's rate over the bandwidth (damping).
    pub damping_weight: SVector<f64, P>,
    /// Weight of each output's acceleration over the squared bandwidth; the paper has 0.
    pub rate_weight: SVector<f64, P>,
    /// Weight of each input's rate of change over the cubed bandwidth.
    pub increment_weight: SVector<f64, P>,
}

/// The paper's N_c = 25 and Q = CᵀC, and our choice of what it leaves out:
///
/// | setting | default | reason |
/// | --- | --- | --- |
/// | ΔT | 0.05 s position and altitude, 0.01 s attitude | each a tenth of its loop's time constant or less |
/// | α | 1, the Riccati solution as terminal weight | α = 1.2 discounts the future, which costs once limits are active |
/// | N, a | 7 and 0.55 altitude, 8 and 0.59 position, 8 and 0.63 attitude | a search over closed-loop costs on steps that saturate: within 1 % of the best |
/// | N_p | 60 altitude, 150 position, 120 attitude | for the state-space MPC, and the paper's models |
/// | weights | 1, 0.5 of the acceleration; of the horizontal speed 1.25, of its rate 1 | relative to the bandwidth: deviations of one size count alike; diagonal goals far below overshoot by 2 % instead of 5 % |
/// | position bandwidth | from the attitude loop | 0.62/(its delay + ΔT/2) |
/// | attitude bandwidth | from the airframe | at most 0.8/(rotor lag + ΔT/2), and √(α/0.06) rad/s of the angular acceleration α in hover: 11.9 rad/s for the paper's roll and pitch, 3.4 for its yaw |
impl Default for Controllers {
    fn default() -> Self {
        let altitude = ControllerSettings {
            sample_time_us: 50_000,
            terms: 7,
            scale: 0.55,
            prediction_horizon: 60,
            control_horizon: 25,
            alpha: 1.0,
            lambda: 1.0,
            output_weight: SVector::from([1.0]),
            damping_weight: SVector::from([1.0]),
            rate_weight: SVector::from([0.5]),
            increment_weight: SVector::from([1.0]),
        };
        let position = ControllerSettings { terms: 8, scale: 0.59, prediction_horizon: 150, ..altitude };
        let attitude = ControllerSettings {
            sample_time_us: 10_000,
            terms: 8,
            scale: 0.63,
            prediction_horizon: 120,
            ..altitude
        };
        Self {
            kind: ControllerKind::default(),
            model: PredictionModel::default(),
            governor: true,
            mass_factor: 1.0,
            learning: true,
            altitude,
            position: ControllerSettings {
                damping_weight: [1.25; 2].into(),
                ..position.with_weights([1.0; 2], [1.0; 2], [1.0; 2])
            },
            attitude: attitude.with_weights([1.0; 3], [0.5; 3], [1.0; 3]),
        }
    }
}

impl Controllers {
    /// Whether all controllers sample as often as others.
    pub(crate) fn has_sample_times_of(&self, other: &Self) -> bool {
        self.position.sample_time_us == other.position.sample_time_us
            && self.altitude.sample_time_us == other.altitude.sample_time_us
            && self.attitude.sample_time_us == other.attitude.sample_time_us
    }
}

impl<const P: usize> ControllerSettings<P> {
    /// The same settings for another number of inputs.
    pub fn with_weights<const R: usize>(
        &self,
        output: [f64; R],
        rate: [f64; R],
        increment: [f64; R],
    ) -> ControllerSettings<R> {
        ControllerSettings {
            sample_time_us: self.sample_time_us,
            terms: self.terms,
            scale: self.scale,
            prediction_horizon: self.prediction_horizon,
            control_horizon: self.control_horizon,
            alpha: self.alpha,
            lambda: self.lambda,
            output_weight: SVector::from(output),
            damping_weight: SVector::from([1.0; R]),
            rate_weight: SVector::from(rate),
            increment_weight: SVector::from(increment),
        }
    }

    /// ΔT, s.
    pub fn sample_time_s(&self) -> f64 {
        self.sample_time_us as f64 / 1e6
    }
}

/// Limits of the cascade and of the shaper.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Limits {
    /// Largest angle between the thrust axis and the vertical, rad.
    pub tilt_rad: f64,
    /// Largest rate of the tilt command, rad/s.
    pub tilt_rate_rad_s: f64,
    /// Largest angular acceleration of the tilt command, rad/s².
    pub tilt_acceleration_rad_s2: f64,
    /// Smallest thrust that the altitude controller asks for, as a multiple of the weight.
    pub thrust_min: f64,
    /// Largest thrust that the altitude controller asks for, as a multiple of the weight; never more than
    /// four fifths of what the rotors can do.
    pub thrust_max: f64,
    /// Largest horizontal speed of shaped references, m/s.
    pub speed_horizontal_m_s: f64,
    /// Whether a straight shaped way is flown at that speed itself, as a commanded speed is. Otherwise it is flown at 98 % of it: the rest
    /// is for the controllers to overshoot, so that the vehicle, too, keeps the limit.
    pub full_speed: bool,
    /// Largest climb rate of shaped references, m/s.
    pub speed_up_m_s: f64,
    /// Largest sink rate of shaped references, m/s.
    pub speed_down_m_s: f64,
    /// Largest horizontal acceleration of shaped references, m/s².
    pub acceleration_horizontal_m_s2: f64,
    /// Largest vertical acceleration of shaped references, m/s².
    pub acceleration_vertical_m_s2: f64,
    /// Largest horizontal jerk of shaped references, m/s³.
    pub jerk_horizontal_m_s3: f64,
    /// Largest vertical jerk of shaped references, m/s³.
    pub jerk_vertical_m_s3: f64,
    /// Largest rate of the yaw reference, rad/s.
    pub yaw_rate_rad_s: f64,
    /// Largest angular acceleration of the shaped yaw reference, rad/s².
    pub yaw_acceleration_rad_s2: f64,
    /// Largest angular jerk of the shaped yaw reference, rad/s³.
    pub yaw_jerk_rad_s3: f64,
}

/// Our choice; the paper names no limit.
///
/// | limit | default | reason |
/// | --- | --- | --- |
/// | tilt | 0.6 rad | thrust to hold altitude grows by 21 % |
/// | tilt command | 2 rad/s, 8 rad/s² | 0.85 N·m, nine tenths of the torque in hover |
/// | thrust | 0.6 to 2 weights | leaves the mixer room for torques at both ends |
/// | speed | 8, up 4, down 3 m/s | an inspection flight |
/// | acceleration | 2.5 and 2 m/s² | a tilt of 0.25 rad, 0.31 while sinking: leaves the feedback room |
/// | jerk | 4 m/s³ | a jump of the tilt rate by 0.4 rad/s is the kick that the torques just follow |
/// | yaw | 0.8 rad/s, 0.3 rad/s², 0.6 rad/s³ | half of the yaw torque in hover |
impl Default for Limits {
    fn default() -> Self {
        Self {
            tilt_rad: 0.6,
            tilt_rate_rad_s: 2.0,
            tilt_acceleration_rad_s2: 8.0,
            thrust_min: 0.6,
            thrust_max: 2.0,
            speed_horizontal_m_s: 8.0,
            full_speed: false,
            speed_up_m_s: 4.0,
            speed_down_m_s: 3.0,
            acceleration_horizontal_m_s2: 2.5,
            acceleration_vertical_m_s2: 2.0,
            jerk_horizontal_m_s3: 4.0,
            jerk_vertical_m_s3: 4.0,
            yaw_rate_rad_s: 0.8,
            yaw_acceleration_rad_s2: 0.3,
            yaw_jerk_rad_s3: 0.6,
        }
    }
}
