//! From the reference that was given to the set-point that the cascade tracks.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::design::response_times::ResponseTimes;
use crate::guidance::direct_reference::DirectReference;
use crate::guidance::eased_limits::EasedLimits;
use crate::guidance::heading::Heading;
use crate::guidance::reference_plan::ReferencePlan;
#[cfg(feature = "shaper")]
use crate::guidance::shaper::Shaper;
use crate::{Limits, PositionReference};

/// State of the reference: shaped towards a goal, or passed on as it comes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[allow(clippy::large_enum_variant)] // One of them lives in each simulation; boxing would allocate.
pub enum Guidance {
    /// Jerk-limited.
    #[cfg(feature = "shaper")]
    Shaped(Shaper),
    /// As given; the heading within its rate limit.
    Direct(DirectReference),
}

#[cfg_attr(not(feature = "shaper"), allow(unused_variables, irrefutable_let_patterns))]
impl Guidance {
    /// A reference that rests in one place.
    pub fn new(
        limits: &Limits,
        shaping: bool,
        position_m: &Vector3<f64>,
        yaw_rad: f64,
        time_us: u64,
    ) -> Self {
        #[cfg(feature = "shaper")]
        if shaping {
            return Self::Shaped(Shaper::at_rest(position_m, yaw_rad, limits, time_us));
        }
        let rest = PositionReference::goal((*position_m).into(), yaw_rad);
        Self::Direct(DirectReference::new(&rest, time_us))
    }

    /// Whether it is shaped.
    pub fn is_shaped(&self) -> bool {
        !matches!(self, Self::Direct(_))
    }

    /// A reference, shaped or not, that goes on from where this one is.
    pub fn switched(
        &self,
        (limits, times): (&EasedLimits, &ResponseTimes),
        shaping: bool,
        time_us: u64,
    ) -> Self {
        Self::moving(&self.reference(time_us), (limits, times), shaping, time_us)
    }

    /// A reference that goes on from a motion: shaped, it comes to rest.
    pub fn moving(
        now: &PositionReference,
        (limits, times): (&EasedLimits, &ResponseTimes),
        shaping: bool,
        time_us: u64,
    ) -> Self {
        #[cfg(feature = "shaper")]
        if shaping {
            return Self::Shaped(Shaper::moving(now, limits, times, time_us));
        }
        Self::Direct(DirectReference::new(now, time_us))
    }

    /// The input is elsewhere, m, and what is tracked as well: that is no motion.
    pub fn shift(&mut self, by_m: &Vector3<f64>) {
        match self {
            #[cfg(feature = "shaper")]
            Self::Shaped(shaper) => shaper.shift(by_m),
            Self::Direct(direct) => direct.shift(by_m),
        }
    }

    /// A look at the input between samples.
    pub fn watch(&mut self, reference: &PositionReference, limits: &Limits, time_us: u64) {
        if let Self::Direct(direct) = self {
            direct.watch(reference, limits, time_us);
        }
    }

    /// A sample of the reference of the position and altitude controllers.
    pub fn sample(
        &mut self,
        reference: &PositionReference,
        plan: Option<&ReferencePlan>,
        (limits, times): (&Limits, &ResponseTimes),
        time_us: u64,
    ) {
        match self {
            #[cfg(feature = "shaper")]
            Self::Shaped(shaper) => shaper.update(reference, (limits, times), time_us),
            Self::Direct(direct) => direct.sample(reference, plan, limits, time_us),
        }
    }

    /// A sample of the attitude controller's heading reference.
    pub fn sample_heading(
        &mut self,
        reference: &PositionReference,
        limits: &Limits,
        time_us: u64,
    ) -> Heading {
        if let Self::Direct(direct) = self {
            direct.sample_heading(reference, limits, time_us);
        }
        self.heading(time_us)
    }

    /// Whether the way that is tracked at `time_us` is within limits: a plan keeps them, and its acceleration fits them. A
    /// reference that is passed on is another's plan, which may brake as before until it rests, unless `moving` ones fit, too.
    pub fn fits(&self, limits: &Limits, moving: bool, time_us: u64) -> bool {
        /// What rounding makes of an acceleration at its limit.
        const ROUNDING: f64 = 1.0 + 1e-6;
        /// A reference slower than this, m/s, rests.
        const RESTS_M_S: f64 = 0.1;
        let now = self.reference(time_us);
        let acceleration = now.acceleration_m_s2;
        let small = acceleration.xy().norm() <= ROUNDING * limits.acceleration_horizontal_m_s2
            && acceleration.z.abs() <= ROUNDING * limits.acceleration_vertical_m_s2;
        match self {
            #[cfg(feature = "shaper")]
            Self::Shaped(shaper) => small && shaper.keeps_limits(),
            Self::Direct(_) => small && (moving || now.velocity_m_s.norm() <= RESTS_M_S),
        }
    }

    /// What is tracked at `time_us`.
    pub fn reference(&self, time_us: u64) -> PositionReference {
        match self {
            #[cfg(feature = "shaper")]
            Self::Shaped(shaper) => shaper.reference(time_us),
            Self::Direct(direct) => direct.reference(time_us),
        }
    }

    /// The heading of [`Guidance::preview`].
    pub fn heading(&self, time_us: u64) -> Heading {
        match self {
            #[cfg(feature = "shaper")]
            Self::Shaped(shaper) => shaper.heading(time_us),
            Self::Direct(direct) => direct.heading(time_us),
        }
    }

    /// Whether it is known what will be tracked unless the goal changes: it is shaped or comes with a plan.
    pub fn is_foretold(&self) -> bool {
        match self {
            #[cfg(feature = "shaper")]
            Self::Shaped(_) => true,
            Self::Direct(direct) => direct.is_planned(),
        }
    }

    /// What will be tracked at `time_us`, as far as it is known now: exactly if it is shaped or comes with a plan, unless the goal
    /// changes. Another one is carried on by its derivatives: it goes on turning if it turns, and else see
    /// [`PositionReference::expected_after`].
    pub fn preview(&self, time_us: u64) -> PositionReference {
        match self {
            #[cfg(feature = "shaper")]
            Self::Shaped(shaper) => shaper.reference(time_us),
            Self::Direct(direct) => direct.preview(time_us),
        }
    }
}
