//! How the closed loop behaves about hover, and what that says of a flight.

use alloc::vec::Vec;
use core::f64::consts::LN_2;

use lmpc::DesignError;

use crate::control::observed_motion::MotionModel;
use crate::design::stability::linear_law::LinearLaw;
use crate::design::stability::loop_stability::{LoopStability, Seen};
use crate::design::stability::moving_axis::{Moving, MovingAxis};
use crate::design::stability::small_signal::Reading;
use crate::design::stability::stability_warning::StabilityWarning;
use crate::design::stability::tilting_loop::TiltingLoop;
use crate::design::stability::turning_axis::{Turning, TurningAxis};
use crate::design::stability::turning_loop::TurningLoop;
use crate::design::stability::verdict::judged;
use crate::design::stability::vertical_loop::{self, VerticalLoop};
use crate::{Airframe, CascadeDesign, Configuration, ConfigurationError, Sensors};

/// A loop whose least damped mode has less than this damping ratio swings: after a disturbance it takes seven oscillations
/// for one to fade to a hundredth.
const LEAST_DAMPING: f64 = 0.1;
/// A loop whose slowest mode takes longer than this, s, to fade to a third is slow.
const SLOW_S: f64 = 10.0;
/// Without the torque that the attitude reference needs, errors must take this long, s, to double at least. The attitude loop
/// of the defaults corrects with a time constant of 0.2 s: what doubles within about two of these grows faster than it is
/// caught after a saturation. Measured on random weights and rotor lags: of 12 flights with 0.25 to 0.5 s two are lost, of 72
/// with more none.
const UNAIDED_S: f64 = 0.5;
/// With fewer standard deviations of the tilt than this within limits.tilt the user is warned.
const WARNED_TILT_DEVIATIONS: f64 = 6.0;
/// Moments of inertia that miss the triangle inequality by no more than this share of the smallest one are taken for rounded.
/// A plate has none to spare, and moments are measured to a tenth or two.
const INERTIA_TOLERANCE: f64 = 0.5;

/// How the closed loop behaves about hover: with its sampled controllers at their two rates, the rotors' lag, and the
/// estimator that feeds them, each as it flies, without active limits.
///
/// A control loop is only made, or changed, with a configuration that has one: unstable loops and noise that no flight
/// survives are refused.
///
/// ```
/// use quadrotor::{Configuration, ConfigurationError, PredictionModel, StabilityReport};
///
/// let mut configuration = Configuration::default();
/// let report = StabilityReport::new(&configuration)?;
/// assert!(report.loops().iter().all(|each| each.is_stable()));
/// assert!(report.warnings().is_empty());
///
/// // The printed models do not know that the rotors answer late.
/// configuration.controllers.model = PredictionModel::Paper;
/// configuration.airframe.rotor_time_constant_s = 0.06;
/// let refused = StabilityReport::new(&configuration);
/// assert!(matches!(refused, Err(ConfigurationError::Unstable { name: "north", .. })));
/// # Ok::<(), ConfigurationError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct StabilityReport {
    loops: [LoopStability; 6],
    /// North and east once more, without the torque that the attitude reference needs.
    unaided: Option<[LoopStability; 2]>,
    warnings: Vec<StabilityWarning>,
}

impl StabilityReport {
    /// Checks a configuration, designs its controllers and judges the closed loop.
    ///
    /// # Errors
    /// Every variant of [`ConfigurationError`] but `Fixed`.
    pub fn new(configuration: &Configuration) -> Result<Self, ConfigurationError> {
        judged(configuration, &CascadeDesign::new(configuration)?, None)
    }

    /// Of the controllers of a configuration, whatever it says.
    ///
    /// # Errors
    /// [`DesignError::ElementNotFinite`], [`DesignError::Eigenvalues`].
    pub(crate) fn of(configuration: &Configuration, design: &CascadeDesign) -> Result<Self, DesignError> {
        let noise = reading(&configuration.sensors);
        let [roll, pitch] = LinearLaw::of(&design.attitude.lean);
        let [yaw] = LinearLaw::of(&design.attitude.turn);
        let spin_up_s = configuration.airframe.spin_up_lead_s();
        let turning = |name, axis, lead_s| {
            let seen = Seen { angle: Some(Turning::ANGLE), position: None, command: Turning::COMMAND };
            LoopStability::of(name, &TurningLoop::new(configuration, axis, lead_s)?, &noise, seen)
        };
        let [roll, pitch, yaw] =
            [(0, roll), (1, pitch), (2, yaw)].map(|law| TurningAxis::new(configuration, design, law));
        let tilting = |axes: [TurningAxis; 2]| horizontal(configuration, design, axes, &noise);
        let [north, east] = tilting([roll, pitch])?;
        let unaided = roll
            .has_feed_forward()
            .then(|| tilting([roll, pitch].map(|axis| axis.without_feed_forward())))
            .transpose()?;
        let [down] = LinearLaw::of(&design.altitude.law);
        let vertical = VerticalLoop::new(
            configuration,
            MovingAxis::new(configuration, design, (down, design.altitude.motion)),
        )?;
        let seen =
            Seen { angle: None, position: Some(vertical_loop::POSITION), command: vertical_loop::COMMAND };
        let altitude = LoopStability::of("altitude", &vertical, &noise, seen)?;
        let [roll, pitch, yaw] =
            [turning("roll", roll, 0.0)?, turning("pitch", pitch, 0.0)?, turning("yaw", yaw, spin_up_s)?];
        let loops = [roll, pitch, yaw, north, east, altitude];
        let mut report = Self { loops, unaided, warnings: Vec::new() };
        report.warnings = report.all_warnings(configuration, design);
        Ok(report)
    }

    /// Whether a report of one configuration is, but for limits, that of another one with the same controllers.
    pub(crate) fn is_same(one: &Configuration, other: &Configuration) -> bool {
        let dynamics = |configuration: &Configuration| {
            let sensors = Sensors { seed: 0, ..configuration.sensors };
            (configuration.airframe, configuration.controllers, sensors, configuration.limits.tilt_rad)
        };
        dynamics(one) == dynamics(other)
    }

    /// Roll, pitch, yaw, north, east, altitude.
    pub fn loops(&self) -> &[LoopStability; 6] {
        &self.loops
    }

    /// What the user should know of a configuration that flies.
    pub fn warnings(&self) -> &[StabilityWarning] {
        &self.warnings
    }

    /// The first loop that loses the vehicle, from the inner ones outwards: one that is unstable, or that is soon without the
    /// torque that its attitude reference needs, of which any saturation takes a part.
    pub(crate) fn unstable(&self) -> Option<&LoopStability> {
        let unaided = self.unaided.iter().flatten().filter(|each| each.decay_rate_1_s * UNAIDED_S < -LN_2);
        self.loops.iter().filter(|each| !each.is_stable()).chain(unaided).next()
    }

    /// Standard deviation of the tilt about one axis under the measurement noise, rad.
    pub(crate) fn tilt_spread_rad(&self) -> f64 {
        let [_, _, _, north, east, _] = &self.loops;
        [north, east]
            .into_iter()
            .filter_map(|each| each.spread)
            .map(|spread| spread.angle_rad)
            .fold(0.0, f64::max)
    }

    /// Standard deviations of the commanded roll and pitch torques as multiples of the largest ones in hover.
    pub(crate) fn torque_shares(
        &self,
        configuration: &Configuration,
        design: &CascadeDesign,
    ) -> [(&'static str, f64); 2] {
        let airframe = &configuration.airframe;
        let most = design.mixer.available_torques_n_m(airframe.weight_n(), airframe.weight_n());
        let [roll, pitch, _, north, east, _] = &self.loops;
        [(roll, east, 0), (pitch, north, 1)].map(|(turning, tilting, axis)| {
            let commands = [turning, tilting].into_iter().filter_map(|each| each.spread);
            let acceleration = commands.map(|spread| spread.command).fold(0.0, f64::max);
            (turning.name, acceleration * airframe.inertia_kg_m2[axis] / most[axis])
        })
    }

    /// The larger of these.
    pub(crate) fn torque_share(&self, configuration: &Configuration, design: &CascadeDesign) -> f64 {
        self.torque_shares(configuration, design).into_iter().map(|(_, share)| share).fold(0.0, f64::max)
    }

    fn all_warnings(&self, configuration: &Configuration, design: &CascadeDesign) -> Vec<StabilityWarning> {
        let mut warnings: Vec<_> =
            implausible_inertia(&configuration.airframe.inertia_kg_m2).into_iter().collect();
        warnings.extend(implausible_drag(&configuration.airframe));
        let unaided = self.unaided.iter().flatten().filter(|each| !each.is_stable());
        warnings.extend(unaided.map(|each| StabilityWarning::SlowAttitude { name: each.name }));
        for each in &self.loops {
            if each.damping_ratio < LEAST_DAMPING {
                warnings.push(StabilityWarning::Swings {
                    name: each.name,
                    damping_ratio: each.damping_ratio,
                    frequency_rad_s: each.frequency_rad_s,
                });
            } else if each.decay_rate_1_s * SLOW_S < 1.0 {
                warnings.push(StabilityWarning::Slow {
                    name: each.name,
                    time_constant_s: 1.0 / each.decay_rate_1_s,
                });
            }
        }
        let (tilt_rad, limit_rad) = (self.tilt_spread_rad(), configuration.limits.tilt_rad);
        if WARNED_TILT_DEVIATIONS * tilt_rad > limit_rad {
            warnings.push(StabilityWarning::Shaken { tilt_rad, limit_rad });
        }
        let saturated =
            self.torque_shares(configuration, design).into_iter().filter(|(_, share)| *share > 1.0);
        warnings.extend(saturated.map(|(name, share)| StabilityWarning::Saturated { name, share }));
        warnings
    }
}

/// Standard deviations of the readings of each axis.
fn reading(sensors: &Sensors) -> Reading {
    // Position and attitude are all that the Kalman predictor reads.
    let read = |deviation: f64| if sensors.output_feedback { 0.0 } else { deviation };
    Reading {
        position: sensors.position_noise_m,
        velocity: read(sensors.velocity_noise_m_s),
        angle: sensors.attitude_noise_rad,
        rate: read(sensors.body_rate_noise_rad_s),
    }
}

/// The position loops north and east, at any heading: each over the roll and the pitch axis.
fn horizontal(
    configuration: &Configuration,
    design: &CascadeDesign,
    [roll, pitch]: [TurningAxis; 2],
    noise: &Reading,
) -> Result<[LoopStability; 2], DesignError> {
    let [north, east] = LinearLaw::of(&design.position.law);
    // (14): ẍ = −g θ, ÿ = g φ
    let motion = design.position.motion.as_ref().map(MotionModel::first_channel);
    let north = MovingAxis::new(configuration, design, (north, motion));
    let east = MovingAxis::new(configuration, design, (east, motion));
    let seen = Seen {
        angle: Some(Turning::ANGLE),
        position: Some(Turning::SIZE + Moving::POSITION),
        command: Turning::COMMAND,
    };
    let over = |name, axis, moving, turning| {
        LoopStability::of(name, &TiltingLoop::new(configuration, axis, moving, turning)?, noise, seen)
    };
    let worst = |name, axis, moving| {
        let over_pitch = over(name, axis, moving, pitch)?;
        if roll == pitch { Ok(over_pitch) } else { Ok(over_pitch.worse(over(name, axis, moving, roll)?)) }
    };
    let [drag_x, drag_y, _] = configuration.airframe.hover_drag_n_s_m();
    let north_loop = worst("north", 0, north)?;
    let east_loop = if north == east && drag_x == drag_y {
        LoopStability { name: "east", ..north_loop }
    } else {
        worst("east", 1, east)?
    };
    Ok([north_loop, east_loop])
}

/// A warning about moments of inertia that no rigid body has: each is at most the sum of the other two.
fn implausible_inertia(inertia_kg_m2: &[f64; 3]) -> Option<StabilityWarning> {
    let [x, y, z] = *inertia_kg_m2;
    let (smallest, largest) = (x.min(y).min(z), x.max(y).max(z));
    let middle = x + y + z - smallest - largest;
    (largest - middle > (1.0 + INERTIA_TOLERANCE) * smallest).then_some(StabilityWarning::Inertia { x, y, z })
}

/// A warning about drag that no propeller has. Its torque is about a tenth of a diameter times the thrust, and rotors that do
/// not overlap have diameters of at most √2 arms. From about a thousand arms on flights spin up, by 85 rad/s, although all
/// loops are stable.
fn implausible_drag(airframe: &Airframe) -> Option<StabilityWarning> {
    let ratio_m = airframe.torque_coefficient_n_m_s2 / airframe.thrust_coefficient_n_s2;
    let arm_length_m = airframe.arm_length_m;
    (ratio_m > arm_length_m).then_some(StabilityWarning::RotorDrag { ratio_m, arm_length_m })
}
