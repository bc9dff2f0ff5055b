//! The vehicle within its fence: refusing what leads out of it, and seeing a breach before it happens.

use std::collections::VecDeque;

use nalgebra::Vector3;

use super::notice::{Refusal, Severity};
use super::set_point::{AxisTarget, PositionSetPoint};
use super::state::Vehicle;
use super::steering::Steering;
use crate::fence::{Breach, Fence, route_m, zones};
use crate::plan::{MissionItem, PlanFault, PlanKind};

/// Between seeing a breach ahead and braking fully, s: the attitude has to lean back first.
const REACTION_S: f64 = 0.4;
/// By so much more it may overshoot, m.
const MARGIN_M: f64 = 0.3;

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
    /// The fence.
    pub fn fence(&self) -> &Fence {
        &self.fence
    }

    /// What has become of it.
    pub fn fence_record(&self) -> &FenceRecord {
        &self.fence_record
    }

    /// Switches the fence on or off.
    pub fn enable_fence(&mut self, enabled: bool) {
        if self.fence.enabled != enabled {
            self.fence.enabled = enabled;
            self.say(Severity::Info, if enabled { "Fence enabled" } else { "Fence disabled" });
        }
    }

    /// Takes the zones of a fence plan.
    ///
    /// # Errors
    /// [`PlanFault`]; the old ones stay then.
    pub(super) fn take_fence(&mut self, items: &[MissionItem]) -> Result<(), PlanFault> {
        self.fence.zones = zones(items, &self.site())?;
        Ok(())
    }

    /// Looks whether the vehicle is, or cannot help coming, where it must not be.
    pub(super) fn watch_fence(&mut self) {
        let now =
            self.breach_at(&self.outputs.position_m).or_else(|| self.breach_at(&self.stopping_place_m()));
        if let (Some(breach), None) = (now, self.fence_record.now) {
            self.fence_record.count = self.fence_record.count.saturating_add(1);
            self.fence_record.latest = Some((breach, self.time_us()));
        }
        self.fence_record.now = now;
    }

    /// What of the fence forbids a place, NED, m.
    pub fn breach_at(&self, place_m: &Vector3<f64>) -> Option<Breach> {
        let settings = &self.conduct.failsafe;
        self.fence.breach(place_m, &self.home.position_m, settings.fence_radius_m, settings.fence_height_m)
    }

    /// Where it comes to rest if it brakes now. On its way to a goal it is where it is: the shaper stops at the goal, which
    /// was looked at before.
    fn stopping_place_m(&self) -> Vector3<f64> {
        let position_m = self.outputs.position_m;
        if !self.armed || matches!(self.steering, Steering::Goal(_) | Steering::Idle { .. }) {
            return position_m;
        }
        let limits = &self.simulation.configuration().limits;
        // v² / 2a, with the time that the jerk takes to build the deceleration up.
        let way_m = |speed: f64, acceleration: f64, jerk: f64| {
            if speed < 0.1 {
                return 0.0;
            }
            speed * speed / (2.0 * acceleration) + speed * (acceleration / jerk / 2.0 + REACTION_S) + MARGIN_M
        };
        let velocity = self.outputs.velocity_m_s;
        let speed = velocity.xy().norm();
        let horizontal =
            way_m(speed, limits.acceleration_horizontal_m_s2, limits.jerk_horizontal_m_s3) / speed.max(1e-9);
        let vertical = libm::copysign(
            way_m(velocity.z.abs(), limits.acceleration_vertical_m_s2, limits.jerk_vertical_m_s3),
            velocity.z,
        );
        position_m + Vector3::new(velocity.x * horizontal, velocity.y * horizontal, vertical)
    }

    /// Refuses a goal, NED, m, that the fence forbids.
    ///
    /// # Errors
    /// [`Refusal::Denied`] that says what of it.
    pub(super) fn check_fence(&self, what: &str, goal_m: &Vector3<f64>) -> Result<(), Refusal> {
        match self.breach_at(goal_m) {
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
        let site = self.site();
        let rally = self.plans.get(PlanKind::Rally).items().iter();
        let rally = rally.filter_map(|item| site.place(item)?.horizontal_m);
        let here = self.outputs.position_m.xy();
        let distance = |[x, y]: &[f64; 2]| libm::hypot(x - here.x, y - here.y);
        core::iter::once([home.x, home.y])
            .chain(rally)
            .chain(self.fence.zones.return_m)
            .filter(|[x, y]| self.breach_at(&Vector3::new(*x, *y, home.z)).is_none())
            .min_by(|one, other| distance(one).total_cmp(&distance(other)))
            .unwrap_or([home.x, home.y])
    }

    /// The way to a place, north and east, m, around what the fence forbids; straight if there is none.
    pub(super) fn way_m(&mut self, goal: [f64; 2]) -> VecDeque<[f64; 2]> {
        let here = self.outputs.setpoint.position_m;
        let way = if self.fence.enabled {
            route_m(&self.fence.zones, [here.x, here.y], goal)
        } else {
            Some(vec![goal])
        };
        if way.is_none() {
            self.say(Severity::Warning, "No way around the fence: returning straight");
        }
        way.unwrap_or_else(|| vec![goal]).into()
    }
}
