//! The limits of thrust and tilt commands in flight.

use serde::{Deserialize, Serialize};

use crate::guidance::eased_limits::EasedLimits;
use crate::guidance::reference_guidance::Guidance;
use crate::{Configuration, GRAVITY_M_S2, Limits, PositionReference, RigidBody};

/// Share of the acceleration limit with which a vehicle away from its reference is counted on to brake.
const BRAKING_SHARE: f64 = 0.25;
/// Share of the limits on the tilt command with which an error is counted on to be closed.
const TILT_SHARE: f64 = 0.5;
/// So near to its reference, m, a vehicle tracks it.
const TRACKING_M: f64 = 0.1;

/// How long a motion fits lower limits before they hold, µs: commands that are still on the move end within it.
const SETTLED_US: u64 = 1_000_000;

/// How many times the longest braking is waited for until a reference that is passed on fits as it moves.
const PATIENCE: u64 = 3;

/// The limits that commands keep.
///
/// Lower limits hold once the motion fits them: when the reference does, and the vehicle can come to its reference within them.
/// A reference that is passed on as it comes may never rest: after the time of the longest braking it is enough that it fits as it
/// moves, and after a multiple of that time they hold in any case.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct CommandLimits {
    limits: EasedLimits,
    /// From when on a reference that is passed on may fit while it moves, µs.
    moving_from_us: u64,
    /// When the wanted limits hold whatever reference is passed on, µs.
    latest_us: u64,
    /// Since when the motion has fitted the wanted limits, µs.
    fits_since_us: Option<u64>,
}

impl CommandLimits {
    /// Limits that hold.
    pub fn new(limits: &Limits) -> Self {
        Self { limits: EasedLimits::new(limits), moving_from_us: 0, latest_us: 0, fits_since_us: None }
    }

    /// Other limits are wanted from `time_us` on.
    pub fn change(&mut self, limits: &Limits, time_us: u64) {
        if self.limits.wanted() == limits {
            return;
        }
        self.limits.want(limits);
        self.fits_since_us = None;
        let kept = self.limits.kept();
        let fastest = kept.speed_horizontal_m_s.max(kept.speed_up_m_s).max(kept.speed_down_m_s);
        let weakest = kept.acceleration_horizontal_m_s2.min(kept.acceleration_vertical_m_s2);
        let braking_s = fastest / (BRAKING_SHARE * weakest);
        let braking_us = (braking_s * 1e6) as u64;
        self.moving_from_us = time_us.saturating_add(braking_us);
        self.latest_us = self.moving_from_us.saturating_add(PATIENCE.saturating_mul(braking_us));
    }

    /// Whether lower limits do not hold yet.
    pub fn is_eased(&self) -> bool {
        self.limits.is_eased()
    }

    /// Those that the reference keeps, and those that its motion began with.
    pub fn of_references(&self, configuration: &Configuration) -> EasedLimits {
        let kept = Configuration { limits: *self.limits.kept(), ..*configuration };
        let mut limits = EasedLimits::new(&kept.flyable_limits());
        limits.want(&configuration.flyable_limits());
        limits
    }

    /// Looks whether the motion fits the wanted limits.
    pub fn watch(
        &mut self,
        configuration: &Configuration,
        guidance: &Guidance,
        body: &RigidBody,
        time_us: u64,
    ) {
        if !self.is_eased() {
            return;
        }
        let flyable = configuration.flyable_limits();
        let fits = guidance.fits(&flyable, time_us >= self.moving_from_us, time_us);
        let reference = guidance.reference(time_us);
        let returns = || {
            can_brake(&reference, body, &flyable)
                && can_return(&reference, body, &flyable, position_bandwidth_rad_s(configuration))
        };
        self.fits_since_us = (fits && returns()).then(|| self.fits_since_us.unwrap_or(time_us));
        let settled = self.fits_since_us.is_some_and(|since_us| time_us - since_us >= SETTLED_US);
        let late = time_us >= self.latest_us && (fits || !guidance.is_shaped());
        if settled || late {
            self.limits.release();
            self.fits_since_us = None;
        }
    }

    /// The configuration with the limits that commands keep now. Speeds, and the accelerations with which large errors are
    /// closed, are those that are wanted: less of them never asks for more of thrust and tilt.
    pub fn in_force(&self, configuration: &Configuration) -> Configuration {
        let kept = self.limits.kept();
        let flyable = configuration.flyable_limits();
        let limits = Limits {
            tilt_rad: kept.tilt_rad,
            tilt_rate_rad_s: kept.tilt_rate_rad_s,
            tilt_acceleration_rad_s2: kept.tilt_acceleration_rad_s2,
            thrust_min: kept.thrust_min,
            thrust_max: kept.thrust_max,
            ..flyable
        };
        Configuration { limits, ..*configuration }
    }
}

/// Whether the speed relative to the reference can be braked on the way to it.
fn can_brake(reference: &PositionReference, body: &RigidBody, limits: &Limits) -> bool {
    let way_m = reference.position_m - body.position_m;
    let speed_m_s = body.velocity_m_s - reference.velocity_m_s;
    let brakes = |way_m: f64, speed_m_s: f64, acceleration_m_s2: f64| {
        speed_m_s * speed_m_s <= 2.0 * BRAKING_SHARE * acceleration_m_s2 * way_m.max(TRACKING_M)
    };
    brakes(way_m.xy().norm(), speed_m_s.xy().norm(), limits.acceleration_horizontal_m_s2)
        && brakes(way_m.z.abs(), speed_m_s.z.abs(), limits.acceleration_vertical_m_s2)
}

/// Whether tilt commands within the limits follow what the position controller asks for to close the present error. A linear
/// loop of bandwidth ω closes an error e with jerk ω³ e and snap ω⁴ e; the tilt command has g times its rate for the one, and g
/// times its acceleration for the other. A far error is closed by limits, not by the linear loop: see [`can_brake`].
fn can_return(
    reference: &PositionReference,
    body: &RigidBody,
    limits: &Limits,
    bandwidth_rad_s: f64,
) -> bool {
    let way_m = (reference.position_m - body.position_m).xy().norm();
    let speed_m_s = (body.velocity_m_s - reference.velocity_m_s).xy().norm();
    let jerk_m_s3 = bandwidth_rad_s * bandwidth_rad_s * (bandwidth_rad_s * way_m + speed_m_s);
    let most = TILT_SHARE * GRAVITY_M_S2;
    jerk_m_s3 <= most * limits.tilt_rate_rad_s
        && bandwidth_rad_s * jerk_m_s3 <= most * limits.tilt_acceleration_rad_s2
}

/// Bandwidth of the position controller, rad/s: three integrators from the increments of its input under weights Q and R close at
/// (g √(Q/R) / ΔT)^(1/3).
fn position_bandwidth_rad_s(configuration: &Configuration) -> f64 {
    let settings = &configuration.controllers.position;
    let ratio = settings.output_weight.component_div(&settings.increment_weight).max();
    libm::cbrt(GRAVITY_M_S2 * libm::sqrt(ratio) / settings.sample_time_s())
}
