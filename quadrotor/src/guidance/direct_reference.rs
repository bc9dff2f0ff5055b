//! A reference that is passed on as it comes.

use nalgebra::{Vector1, Vector3};
use serde::{Deserialize, Serialize};

use crate::attitude::wrapped;
use crate::guidance::consistent_way::ConsistentWay;
use crate::guidance::derivative_estimator::DerivativeEstimator;
use crate::guidance::found_derivatives::FoundDerivatives;
use crate::guidance::heading::Heading;
use crate::guidance::held_input::HeldInput;
use crate::guidance::reference_plan::ReferencePlan;
use crate::{Limits, PositionReference};

/// Multiple of the limit of yaw acceleration beyond which a change counts as a jump, not as motion.
const JUMP: f64 = 10.0;

/// Position, velocity and acceleration as given, carried on while an input is held; the heading within its rate limit. Derivatives
/// that are not given are estimated, and made consistent.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct DirectReference {
    /// The way as it was sampled at `time_us`, and the heading at `yaw_time_us`.
    latest: PositionReference,
    time_us: u64,
    yaw_time_us: u64,
    /// The way that it takes, if that is known.
    plan: Option<ReferencePlan>,
    input: HeldInput,
    found: FoundDerivatives,
    way: ConsistentWay,
    yaw_rates: DerivativeEstimator<1>,
}

impl DirectReference {
    /// Goes on from a reference.
    pub fn new(now: &PositionReference, time_us: u64) -> Self {
        Self {
            latest: *now,
            time_us,
            yaw_time_us: time_us,
            plan: None,
            input: HeldInput::new(time_us),
            found: FoundDerivatives::new(),
            way: ConsistentWay::default(),
            yaw_rates: DerivativeEstimator::new(),
        }
    }

    /// The reference as planned, or else the latest one, moved on by its derivatives since it was sampled.
    pub fn reference(&self, time_us: u64) -> PositionReference {
        if let Some(plan) = &self.plan {
            return plan.at(time_us);
        }
        self.held_heading(time_us).on(&self.latest.expected_after(elapsed_s(self.time_us, time_us)))
    }

    /// The heading of [`DirectReference::reference`].
    pub fn heading(&self, time_us: u64) -> Heading {
        match &self.plan {
            Some(plan) => Heading::of(&plan.at(time_us)),
            None => self.held_heading(time_us),
        }
    }

    /// The latest heading, moved on by its derivatives.
    fn held_heading(&self, time_us: u64) -> Heading {
        Heading::of(&self.latest.expected_after(elapsed_s(self.yaw_time_us, time_us)))
    }

    /// Whether its way is known.
    pub fn is_planned(&self) -> bool {
        self.plan.is_some()
    }

    /// What a plan counts on: see [`PositionReference::foreseen_after`].
    pub fn preview(&self, time_us: u64) -> PositionReference {
        if self.is_planned() {
            return self.reference(time_us);
        }
        self.held_heading(time_us).on(&self.latest.foreseen_after(elapsed_s(self.time_us, time_us)))
    }

    /// Looks at the input, more often than it is sampled: what is not given is found from the instants at which it changes.
    pub fn watch(&mut self, reference: &PositionReference, limits: &Limits, time_us: u64) {
        self.input.observe(reference, time_us);
        self.found.watch(reference, limits, time_us);
        if reference.yaw_acceleration_rad_s2 != 0.0 {
            self.yaw_rates = DerivativeEstimator::new();
        } else {
            let fastest = JUMP * limits.yaw_acceleration_rad_s2;
            self.yaw_rates.observe(&Vector1::new(reference.yaw_rate_rad_s), fastest, time_us);
        }
    }

    /// The points are elsewhere, m, but the motion is the same.
    pub fn shift(&mut self, by_m: &Vector3<f64>) {
        self.latest.position_m += by_m;
        self.plan.iter_mut().for_each(|plan| plan.shift(by_m));
        self.input.shift(by_m);
        self.found.shift(by_m);
        self.way.shift(by_m);
    }

    /// A sample of the way, and of the plan that it is a point of.
    pub fn sample(
        &mut self,
        reference: &PositionReference,
        plan: Option<&ReferencePlan>,
        limits: &Limits,
        time_us: u64,
    ) {
        self.plan = plan.map(|plan| plan.near_heading(self.latest.yaw_rad, time_us));
        let point = self.found.completed(reference, limits, self.input.since_us());
        // The point holds at the instant at which it was set.
        let age_s = self.input.age_s(time_us);
        let now = if age_s > 0.0 { point.after(age_s) } else { point };
        let way = if self.found.are_settled(reference) && !now.is_at_rest() {
            self.way.beside(&now, limits, time_us)
        } else {
            self.way.forget();
            now
        };
        self.latest = Heading::of(&self.latest).on(&way);
        self.time_us = time_us;
    }

    /// A sample of the heading.
    pub fn sample_heading(&mut self, reference: &PositionReference, limits: &Limits, time_us: u64) {
        let elapsed_s = elapsed_s(self.yaw_time_us, time_us);
        let most = limits.yaw_rate_rad_s * elapsed_s;
        let held = &mut self.latest;
        let turned = wrapped(reference.yaw_rad - held.yaw_rad).clamp(-most, most);
        held.yaw_rad += turned;
        // A heading that moves has a rate, also when none was given.
        let given = reference.yaw_rate_rad_s;
        // A microsecond is the shortest time: nowhere is a division by zero.
        let rate = if given == 0.0 && elapsed_s > 0.0 { turned / elapsed_s.max(1e-6) } else { given };
        held.yaw_rate_rad_s = rate.clamp(-limits.yaw_rate_rad_s, limits.yaw_rate_rad_s);
        let acceleration = match reference.yaw_acceleration_rad_s2 {
            0.0 => self.yaw_rates.at(time_us).first.x,
            given => given,
        };
        // A rate at its limit stays there.
        let is_free = held.yaw_rate_rad_s == rate;
        held.yaw_acceleration_rad_s2 = if is_free { acceleration } else { 0.0 };
        self.yaw_time_us = time_us;
    }
}

fn elapsed_s(since_us: u64, time_us: u64) -> f64 {
    time_us.saturating_sub(since_us) as f64 / 1e6
}
