//! The vehicle within its fence: refusing what leads out of it, and seeing a breach before it happens.

use std::collections::VecDeque;

use nalgebra::Vector3;

use super::motion::Motion;
use super::notice::{Refusal, Severity};
use super::set_point::{AxisTarget, PositionSetPoint};
use super::state::Vehicle;
use super::steering::{Steering, SteeringKind};
use crate::fence::{Breach, Fence, route_m};
use crate::plan::{MissionItem, PlanFault, zones};

/// An attitude that leads outside is left this late, s.
const REACTION_S: f64 = 0.5;
/// By so much more than its reference it may overshoot, m.
const MARGIN_M: f64 = 0.5;
/// How often the way to a stop is predicted, µs, and in which steps, s.
const PREDICTION_PERIOD_US: u64 = 20_000;
const STEP_S: f64 = 0.02;
/// Longest stop, s.
const LONGEST_STOP_S: f64 = 10.0;
/// Slower than this, m/s, it stands.
const STANDING_M_S: f64 = 0.1;

/// What has become of the fence, for clients.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct FenceRecord {
    /// The breach of now, if there is one.
    pub now: Option<Breach>,
    /// How many there were.
    pub count: u16,
    /// The latest, and when it began, µs.
    pub latest: Option<(Breach, u64)>,
}

impl Vehicle {
    /// The fence as it is looked at; `None` while it is switched off.
    pub fn fence(&self) -> Option<Fence<'_>> {
        self.conduct.failsafe.fence_enabled.then(|| self.whole_fence())
    }

    /// Switched on or off.
    fn whole_fence(&self) -> Fence<'_> {
        let settings = &self.conduct.failsafe;
        let parts = settings.fence_parts;
        let of = |looked_at: bool, limit_m: f64| if looked_at { limit_m } else { 0.0 };
        Fence {
            zones: parts.zones.then_some(&self.fence_zones),
            home_m: self.home.position_m,
            radius_m: of(parts.distance, settings.fence_radius_m),
            height_m: of(parts.height, settings.fence_height_m),
        }
    }

    /// What has become of it.
    pub fn fence_record(&self) -> &FenceRecord {
        &self.fence_record
    }

    /// Whether there is anything that it must keep to: zones, a greatest distance or height.
    pub fn has_fence(&self) -> bool {
        self.whole_fence().bounds()
    }

    /// Switches the fence on or off.
    pub fn enable_fence(&mut self, enabled: bool) {
        if self.conduct.failsafe.fence_enabled != enabled {
            self.conduct.failsafe.fence_enabled = enabled;
            self.say(Severity::Info, if enabled { "Fence enabled" } else { "Fence disabled" });
        }
    }

    /// The highest that the fence allows, z, m, if it bounds the height.
    pub(super) fn fence_ceiling_z_m(&self) -> Option<f64> {
        let fence = self.fence().filter(|fence| fence.height_m > 0.0)?;
        Some(fence.home_m.z - fence.height_m)
    }

    /// Takes the zones of a fence plan.
    ///
    /// # Errors
    /// [`PlanFault`]; the old ones stay then.
    pub(super) fn take_fence(&mut self, items: &[MissionItem]) -> Result<(), PlanFault> {
        self.fence_zones = zones(items, &self.site())?;
        Ok(())
    }

    /// Looks whether the vehicle is, or cannot help coming, where it must not be.
    pub(super) fn watch_fence(&mut self) {
        let here = self.breach_at(&self.outputs.position_m);
        if here.is_none() && !self.time_us().is_multiple_of(PREDICTION_PERIOD_US) {
            return;
        }
        let ahead = || self.breach_to(&self.stopping_place_m());
        self.fence_record.now =
            here.or_else(|| if self.conduct.failsafe.fence_ahead { ahead() } else { None });
    }

    /// Counts the breach of now, which has begun.
    pub(super) fn count_breach(&mut self) {
        let Some(breach) = self.fence_record.now else { return };
        self.fence_record.count = self.fence_record.count.saturating_add(1);
        self.fence_record.latest = Some((breach, self.time_us()));
    }

    /// What of the fence forbids a place, NED, m.
    pub fn breach_at(&self, place_m: &Vector3<f64>) -> Option<Breach> {
        self.fence()?.breach(place_m)
    }

    /// What of the fence forbids a place or the straight way to it.
    fn breach_to(&self, place_m: &Vector3<f64>) -> Option<Breach> {
        let fence = self.fence()?;
        fence.breach(place_m).or_else(|| fence.breach_between(&self.outputs.position_m, place_m))
    }

    /// Where it comes to rest if it brakes now: the reference moves as that of the hold mode. On its way to a goal that is not
    /// beyond the goal, where the shaper stops.
    fn stopping_place_m(&self) -> Vector3<f64> {
        let position_m = self.outputs.position_m;
        if !self.armed || self.steering.kind() == SteeringKind::Idle {
            return position_m;
        }
        let mut motion = self.steering.present(&self.outputs);
        if !matches!(self.steering, Steering::Motion(_) | Steering::Goal(_)) {
            motion.position_m += motion.velocity_m_s * REACTION_S;
        }
        let Some(ahead) = motion.velocity_m_s.try_normalize(STANDING_M_S) else { return position_m };
        let limits = &self.simulation.configuration().limits;
        let mut braking = Motion::from(motion, PositionSetPoint::HOLD, 0);
        for _ in 0..(LONGEST_STOP_S / STEP_S) as usize {
            braking.step(limits, STEP_S);
            motion = braking.reference(0);
            if motion.velocity_m_s.norm() < STANDING_M_S {
                break;
            }
        }
        match &self.steering {
            Steering::Goal(goal) => {
                let left_m = (goal.position_m - position_m).norm();
                position_m + ahead * (motion.position_m - position_m).norm().min(left_m)
            }
            _ => motion.position_m + ahead * MARGIN_M,
        }
    }

    /// Refuses a goal, NED, m, that the fence forbids, or the straight way to it.
    ///
    /// # Errors
    /// [`Refusal::Denied`] that says what of it.
    pub(super) fn check_fence(&self, what: &str, goal_m: &Vector3<f64>) -> Result<(), Refusal> {
        match self.breach_to(goal_m) {
            Some(breach) => Err(Refusal::denied(format!("{what} denied: {breach}"))),
            None => Ok(()),
        }
    }

    /// Refuses a set-point whose place the fence forbids. Speeds are looked at in flight.
    pub(super) fn check_set_point(&self, set_point: &PositionSetPoint) -> Result<(), Refusal> {
        let now = self.outputs.position_m;
        let mut placed = false;
        let goal = Vector3::from_fn(|axis, _| match set_point.axes[axis] {
            AxisTarget::Position(position_m) | AxisTarget::Track { position_m, .. } => {
                placed = true;
                position_m
            }
            _ => now[axis],
        });
        if placed { self.check_fence("Set-point", &goal) } else { Ok(()) }
    }

    /// Where a return goes: to the nearest of home, the rally points and the fence's return point that the fence allows; home if
    /// it allows none. North and east, m.
    pub(super) fn nearest_safe_point_m(&self) -> [f64; 2] {
        let home = self.home.position_m;
        let rally = self.rally_points.iter().filter_map(|place| place.horizontal_m);
        let here = self.outputs.position_m.xy();
        let distance = |[x, y]: &[f64; 2]| libm::hypot(x - here.x, y - here.y);
        core::iter::once([home.x, home.y])
            .chain(rally)
            .chain(self.fence_zones.return_m)
            .filter(|[x, y]| self.breach_at(&Vector3::new(*x, *y, home.z)).is_none())
            .min_by(|one, other| distance(one).total_cmp(&distance(other)))
            .unwrap_or([home.x, home.y])
    }

    /// The way to a place, north and east, m, around what the fence forbids; straight if there is none.
    pub(super) fn way_m(&mut self, goal: [f64; 2]) -> VecDeque<[f64; 2]> {
        let here = self.outputs.setpoint.position_m;
        let way = match self.fence().and_then(|fence| fence.zones) {
            Some(zones) => route_m(zones, [here.x, here.y], goal),
            None => Some(vec![goal]),
        };
        if way.is_none() {
            self.say(Severity::Warning, "No way around the fence: returning straight");
        }
        way.unwrap_or_else(|| vec![goal]).into()
    }
}
