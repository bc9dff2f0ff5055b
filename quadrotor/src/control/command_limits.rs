//! The limits of thrust and tilt commands in flight.

use serde::{Deserialize, Serialize};

use crate::design::attitude_loop::AttitudeLoop;
use crate::design::translation_design;
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
        attitude: Option<&AttitudeLoop>,
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
                && can_return(&reference, body, &flyable, position_bandwidth_rad_s(configuration, attitude))
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

/// Bandwidth of the position controller, rad/s: with weights Q and R of its output and its increments, which are relative to the
/// bandwidth ω of the design, three integrators close at ω (Q/R)^(1/6).
pub(crate) fn position_bandwidth_rad_s(
    configuration: &Configuration,
    attitude: Option<&AttitudeLoop>,
) -> f64 {
    let settings = &configuration.controllers.position;
    let ratio = settings.output_weight.component_div(&settings.increment_weight).max();
    translation_design::position_bandwidth_rad_s(configuration, attitude) * libm::cbrt(libm::sqrt(ratio))
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::{CommandLimits, can_brake, can_return, position_bandwidth_rad_s};
    use crate::{Configuration, GRAVITY_M_S2, Limits, PlantState, PositionReference, RigidBody};

    fn limits() -> Limits {
        Limits {
            acceleration_horizontal_m_s2: 2.0,
            acceleration_vertical_m_s2: 3.0,
            tilt_rate_rad_s: 1.0,
            tilt_acceleration_rad_s2: 4.0,
            ..Limits::default()
        }
    }

    fn body(position_m: [f64; 3], velocity_m_s: [f64; 3]) -> RigidBody {
        let at_rest = PlantState::at_rest(&Configuration::default().initial).body;
        RigidBody { position_m: position_m.into(), velocity_m_s: velocity_m_s.into(), ..at_rest }
    }

    fn reference() -> PositionReference {
        PositionReference {
            velocity_m_s: Vector3::new(1.0, 0.0, -1.0),
            ..PositionReference::goal([10.0, -5.0, -20.0], 0.3)
        }
    }

    /// Until they are released, commands keep the tilt and the thrust of the larger limits, and the rest of the wanted ones.
    #[test]
    fn commands_keep_the_tilt_and_thrust_of_the_larger_limits() {
        let before = Configuration::default();
        let mut wanted = before;
        wanted.limits.tilt_rad *= 0.8;
        wanted.limits.tilt_rate_rad_s *= 0.7;
        wanted.limits.tilt_acceleration_rad_s2 *= 0.6;
        (wanted.limits.thrust_min, wanted.limits.thrust_max) = (0.9, 1.2);
        wanted.limits.speed_horizontal_m_s *= 0.5;
        let mut commands = CommandLimits::new(&before.limits);
        assert_eq!(commands.in_force(&before).limits, before.flyable_limits());
        commands.change(&wanted.limits, 0);
        assert!(commands.is_eased());
        let kept = Limits {
            tilt_rad: before.limits.tilt_rad,
            tilt_rate_rad_s: before.limits.tilt_rate_rad_s,
            tilt_acceleration_rad_s2: before.limits.tilt_acceleration_rad_s2,
            thrust_max: before.limits.thrust_max,
            ..wanted.flyable_limits()
        };
        let in_force = commands.in_force(&wanted).limits;
        // The least thrust is combined by its distance from the weight, which rounds.
        assert!((in_force.thrust_min - before.limits.thrust_min).abs() < 1e-12);
        assert_eq!(Limits { thrust_min: wanted.limits.thrust_min, ..in_force }, kept);
    }

    /// v² = 2 a s, with a quarter of the acceleration limit, of the speed relative to the reference; the way is 0.1 m at least.
    #[test]
    fn a_speed_is_braked_on_the_way() {
        let brakes = |away: [f64; 3], slower: f64, velocity: [f64; 3]| {
            let position = reference().position_m + Vector3::from(away);
            let velocity = reference().velocity_m_s + Vector3::from(velocity) * slower;
            can_brake(&reference(), &body(position.into(), velocity.into()), &limits())
        };
        for (away, velocity) in [
            ([3.0, 4.0, 0.0], [3.0 / 5.0 * f64::sqrt(5.0), -4.0 / 5.0 * f64::sqrt(5.0), 0.0]),
            ([0.0, 0.0, 6.0], [0.0, 0.0, -3.0]),
            ([0.0, 0.0, -6.0], [0.0, 0.0, -3.0]),
            ([0.03, 0.0, 0.0], [f64::sqrt(0.1), 0.0, 0.0]),
            ([0.0, 0.0, 0.0], [0.0, 0.0, f64::sqrt(0.15)]),
        ] {
            assert!(brakes(away, 0.999, velocity), "{away:?} {velocity:?}");
            assert!(!brakes(away, 1.001, velocity), "{away:?} {velocity:?}");
        }
    }

    /// Jerk ω³ e + ω² v within half of g times the tilt's rate, ω times that within half of g times its acceleration.
    #[test]
    fn an_error_is_closed_within_the_limits_of_the_tilt() {
        let returns = |way_m: f64, speed_m_s: f64, bandwidth_rad_s: f64| {
            let position = reference().position_m + Vector3::new(0.6, -0.8, 0.0) * way_m;
            let velocity = reference().velocity_m_s + Vector3::new(0.8, 0.6, 0.0) * speed_m_s;
            can_return(&reference(), &body(position.into(), velocity.into()), &limits(), bandwidth_rad_s)
        };
        // Up to ω = 4 the rate is the closer limit, g/2, beyond the acceleration, 2g/ω.
        for (bandwidth, jerk) in [(2.0, GRAVITY_M_S2 / 2.0), (8.0, GRAVITY_M_S2 / 4.0)] {
            for (share, within) in [(0.999, true), (1.001, false)] {
                let jerk = share * jerk;
                let squared = bandwidth * bandwidth;
                assert_eq!(
                    returns(jerk / (squared * bandwidth), 0.0, bandwidth),
                    within,
                    "{bandwidth} rad/s"
                );
                assert_eq!(returns(0.0, jerk / squared, bandwidth), within, "{bandwidth} rad/s");
                assert_eq!(
                    returns(0.5 * jerk / (squared * bandwidth), 0.5 * jerk / squared, bandwidth),
                    within
                );
            }
        }
    }

    /// |ω|⁶ = Q/R of that with weights of 1, by the faster axis.
    #[test]
    fn the_bandwidth_is_that_of_three_integrators() {
        let mut configuration = Configuration::default();
        let with_ones = position_bandwidth_rad_s(&configuration, None);
        let position = &mut configuration.controllers.position;
        position.output_weight = [2.0, 256.0].into();
        position.increment_weight = [0.5, 4.0].into();
        let bandwidth = position_bandwidth_rad_s(&configuration, None);
        assert!((bandwidth / with_ones - 2.0).abs() < 1e-12, "{bandwidth} {with_ones}");
    }
}
