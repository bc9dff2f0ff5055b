//! What is done for an item that navigates.

use nalgebra::Vector3;

use super::super::descent::descend;
use super::super::motion::at_rest;
use super::super::notice::Severity;
use super::super::set_point::{AxisTarget, PositionSetPoint, YawTarget};
use super::super::state::{TICK_US, Vehicle};
use super::super::steering::{Steering, SteeringKind};
use super::super::takeoff::is_slow_near;
use super::circle::Circle;
use super::leg::{Carry, Leg, LegProgress};
use super::path::{Stop, first_corner};
use super::sequence::next_from;
use super::time_of_day::TimeOfDay;
use crate::plan::{MissionItem, command};

/// A task.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(clippy::large_enum_variant)] // There is one of it.
pub enum Task {
    /// Up to z, m, where it is.
    Climb {
        /// Goal, m.
        z_m: f64,
        /// Whether that is a takeoff item, or the way up to another one.
        item: bool,
    },
    /// To a place.
    Leg(Leg, Then),
    /// Until a time, µs, or for ever.
    Wait(Option<u64>),
    /// Around a place.
    Circle(Circle),
    /// Down, above a place if there is one.
    Descend(Option<[f64; 2]>),
}

/// What comes at the end of a leg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Then {
    /// The next item, after so many seconds.
    Wait(f64),
    /// Nothing.
    Stay,
    /// Turns.
    Circle(Circle),
    /// A landing.
    Land([f64; 2]),
}

/// How a task goes on.
pub enum TaskProgress {
    /// As it is.
    Going,
    /// With the same item.
    Again,
    /// The item is done; the next leg may take a motion over.
    Done(Option<Carry>),
}

/// Places that are looked ahead.
const AHEAD: usize = 6;

impl Vehicle {
    /// Acceptance radius of an item, m.
    fn acceptance_radius_m(&self, item: &MissionItem) -> f64 {
        let own_m = if item.command == command::NAV_WAYPOINT { item.parameter_or(2, 0.0) } else { 0.0 };
        if own_m > 0.0 { own_m } else { self.setup.conduct().acceptance_radius_m }
    }

    /// Where the leg of an item ends that begins at `from_m`; `None` if it has none.
    fn leg_end_m(&self, item: &MissionItem, from_m: &Vector3<f64>) -> Option<Vector3<f64>> {
        let place = self.site().place(item);
        let horizontal_m = place.and_then(|place| place.horizontal_m);
        let [x, y] = horizontal_m.unwrap_or([from_m.x, from_m.y]);
        let z = place.and_then(|place| place.down_m).unwrap_or(from_m.z);
        match item.command {
            command::NAV_WAYPOINT | command::NAV_LOITER_UNLIM | command::NAV_LOITER_TIME => {
                Some(Vector3::new(x, y, z))
            }
            command::NAV_LOITER_TURNS => {
                Some(self.circle_of(item, Vector3::new(x, y, z), from_m).position_m())
            }
            // Down it goes only there.
            command::NAV_LAND => horizontal_m.map(|[x, y]| Vector3::new(x, y, from_m.z)),
            _ => None,
        }
    }

    fn circle_of(&self, item: &MissionItem, centre_m: Vector3<f64>, from_m: &Vector3<f64>) -> Circle {
        Circle::new(centre_m, from_m, item.parameter_or(1, 0.0), item.parameter_or(3, 0.0))
    }

    /// Whether the vehicle comes to rest at an item.
    fn rests_at(&self, item: &MissionItem) -> bool {
        item.command != command::NAV_WAYPOINT
            || item.parameter_or(1, 0.0) > 0.0
            || !self.continues_after(item)
    }

    /// Whether the next item follows by itself; ArduPilot has no other items.
    pub(super) fn continues_after(&self, item: &MissionItem) -> bool {
        item.autocontinue || self.setup.identity().is_ardupilot()
    }

    /// The places from item `index` on, as far as the vehicle goes from one to the next.
    fn places_ahead(&self, index: usize, from_m: &Vector3<f64>) -> Vec<Stop> {
        let items = self.mission_items();
        let mut made = self.machines.mission.jumps.clone();
        let (mut next, mut from_m) = (Some(index), *from_m);
        let mut stops = Vec::new();
        while let Some(item) = next.and_then(|index| items.get(index)).filter(|_| stops.len() < AHEAD) {
            let Some(position_m) = self.leg_end_m(item, &from_m) else { break };
            let rests = self.rests_at(item);
            stops.push(Stop { position_m, radius_m: self.acceptance_radius_m(item), rests });
            if rests {
                break;
            }
            next = next.and_then(|index| next_from(items, index + 1, &mut made).navigation);
            from_m = position_m;
        }
        stops
    }

    /// A leg to an item, with its corner.
    fn plan_leg(&self, from_m: Vector3<f64>, to_m: Vector3<f64>, carry: Option<Carry>) -> Leg {
        let stops = self.places_ahead(self.machines.mission.current, &from_m);
        let limits = self.closed_loop.simulation().configuration().limits;
        let (start_m, velocity_m_s) = match carry {
            Some(carry) => (carry.position_m, carry.velocity_m_s),
            None => (from_m, Vector3::zeros()),
        };
        let corner = first_corner(&start_m, velocity_m_s.norm(), &stops, &limits);
        let radius_m = stops.first().map_or(self.setup.conduct().acceptance_radius_m, |stop| stop.radius_m);
        Leg::new(from_m, to_m, radius_m, carry, corner)
    }

    /// Plans the corner of the present leg again: limits of speed have changed, or what comes behind it.
    pub(in super::super) fn replan_leg(&mut self) {
        let Some(Task::Leg(leg, then)) = self.machines.mission.task else { return };
        let again = self.plan_leg(leg.from_m, leg.to_m, None);
        self.machines.mission.task = Some(Task::Leg(leg.with_corner(again.corner()), then));
    }

    /// Begins an item that navigates.
    pub(super) fn begin_item(&mut self, item: &MissionItem) -> TaskProgress {
        let grounded = self.decided.steering().kind() == SteeringKind::Idle;
        let task = match item.command {
            command::NAV_TAKEOFF => return self.begin_takeoff(item),
            command::NAV_RETURN_TO_LAUNCH => return TaskProgress::Done(None),
            command::NAV_LAND if grounded => return TaskProgress::Done(None),
            command::NAV_DELAY => {
                self.consult(|_, situation, proposal| proposal.hold(situation));
                Task::Wait(Some(self.delay_end_us(item)))
            }
            _ if grounded => self.climb_first(item),
            _ => match self.leg_end_m(item, &self.machines.mission.anchor_m) {
                Some(end_m) => self.begin_leg(item, end_m),
                None => {
                    self.consult(|_, situation, proposal| proposal.hold(situation));
                    Task::Descend(None)
                }
            },
        };
        self.machines.mission.task = Some(task);
        TaskProgress::Going
    }

    fn delay_end_us(&self, item: &MissionItem) -> u64 {
        match TimeOfDay::of(item) {
            Some(time) => {
                self.time_us().saturating_add(time.wait_us(self.setup.unix_start_us() + self.time_us()))
            }
            None => self.after_s(item.parameter_or(1, 0.0)),
        }
    }

    /// So many seconds from now, µs.
    pub(super) fn after_s(&self, seconds: f64) -> u64 {
        self.time_us().saturating_add((seconds * 1e6) as u64)
    }

    /// On the ground an item above it begins with a climb: to its height, and at least to that of a takeoff.
    fn climb_first(&mut self, item: &MissionItem) -> Task {
        let least_z_m = self.decided.home().position_m.z - self.setup.conduct().takeoff_height_m;
        let z_m =
            self.leg_end_m(item, &self.perception.outputs().position_m).map_or(least_z_m, |end_m| end_m.z);
        self.begin_climb(z_m.min(least_z_m), false)
    }

    fn begin_climb(&mut self, z_m: f64, item: bool) -> Task {
        let here = self.decided.steering().present(self.perception.outputs()).position_m;
        let axes = [AxisTarget::Position(here.x), AxisTarget::Position(here.y), AxisTarget::Position(z_m)];
        self.machines.mission.heading_rad = match *self.decided.steering() {
            Steering::Goal(goal) => goal.yaw_rad,
            _ => self.perception.outputs().attitude_rad.z,
        };
        let yaw = YawTarget::Angle(self.machines.mission.heading_rad);
        self.consult(|_, situation, proposal| {
            proposal.follow(situation, &PositionSetPoint { axes, yaw });
        });
        self.machines.mission.anchor_m = Vector3::new(here.x, here.y, z_m);
        Task::Climb { z_m, item }
    }

    /// Up where it is. Who is above already does not come down for a takeoff.
    fn begin_takeoff(&mut self, item: &MissionItem) -> TaskProgress {
        const LEAST_M: f64 = 0.5;
        let home_z_m = self.decided.home().position_m.z;
        let asked_m = self.site().place(item).and_then(|place| place.down_m);
        let z_m = match asked_m {
            Some(z_m) if home_z_m - z_m >= LEAST_M => z_m,
            _ => home_z_m - self.setup.conduct().takeoff_height_m,
        };
        if self.decided.steering().kind() != SteeringKind::Idle
            && self.perception.outputs().setpoint.position_m.z <= z_m
        {
            return self.leave_takeoff(item);
        }
        if self.decided.steering().kind() == SteeringKind::Idle {
            self.decided.say(Severity::Info, format!("Taking off to {:.1} m above home", home_z_m - z_m));
        }
        self.machines.mission.task = Some(self.begin_climb(z_m, true));
        TaskProgress::Going
    }

    /// The climb is over. PX4 goes on to the place that a takeoff names; ArduPilot's has none.
    fn leave_takeoff(&mut self, item: &MissionItem) -> TaskProgress {
        let place_m = self.site().place(item).and_then(|place| place.horizontal_m);
        let here_m = self.machines.mission.anchor_m;
        match place_m {
            Some([x, y]) if !self.setup.identity().is_ardupilot() => {
                let end_m = Vector3::new(x, y, here_m.z);
                if (end_m - here_m).norm() <= self.setup.conduct().acceptance_radius_m {
                    return TaskProgress::Done(None);
                }
                self.machines.mission.task = Some(self.begin_leg(item, end_m));
                TaskProgress::Going
            }
            _ => TaskProgress::Done(None),
        }
    }

    fn begin_leg(&mut self, item: &MissionItem, end_m: Vector3<f64>) -> Task {
        let from_m = self.machines.mission.anchor_m;
        let carry = self.machines.mission.carry.take();
        let leg = self.plan_leg(from_m, end_m, carry);
        let then = match item.command {
            command::NAV_LOITER_UNLIM => Then::Stay,
            command::NAV_LOITER_TIME | command::NAV_WAYPOINT => Then::Wait(item.parameter_or(1, 0.0)),
            command::NAV_LOITER_TURNS => {
                let place = self.site().place(item);
                let [x, y] = place.and_then(|place| place.horizontal_m).unwrap_or([from_m.x, from_m.y]);
                Then::Circle(self.circle_of(item, Vector3::new(x, y, end_m.z), &from_m))
            }
            command::NAV_LAND => Then::Land([end_m.x, end_m.y]),
            _ => Then::Wait(0.0),
        };
        let asked_rad = match item.command {
            // ArduPilot's waypoints have no heading, and clients leave zeros there.
            _ if self.setup.identity().is_ardupilot() => None,
            command::NAV_WAYPOINT | command::NAV_LOITER_UNLIM | command::NAV_LAND => {
                Some(item.parameter(4).to_radians()).filter(|yaw| yaw.is_finite())
            }
            _ => None,
        };
        let facing_rad = match then {
            Then::Circle(circle) => Some(circle.heading_rad()),
            _ => asked_rad.or_else(|| leg.bearing_rad()),
        };
        if let Some(heading_rad) = facing_rad {
            self.machines.mission.heading_rad = heading_rad;
        }
        Task::Leg(leg, then)
    }

    /// One tick of the present task.
    pub(super) fn carry_on(&mut self, task: Task, item: &MissionItem) -> TaskProgress {
        match task {
            Task::Climb { z_m, item: false } if is_slow_near(self.perception.outputs(), z_m) => {
                TaskProgress::Again
            }
            Task::Climb { z_m, item: true } if is_slow_near(self.perception.outputs(), z_m) => {
                self.leave_takeoff(item)
            }
            Task::Leg(leg, then) => self.fly_leg(leg, then),
            Task::Wait(Some(until_us)) if self.time_us() >= until_us => TaskProgress::Done(None),
            Task::Circle(mut circle) => {
                let limits = self.closed_loop.simulation().configuration().limits;
                let Some(set_point) = circle.step(&limits, TICK_US as f64 / 1e6) else {
                    self.machines.mission.anchor_m = circle.position_m();
                    self.machines.mission.heading_rad = circle.heading_rad();
                    self.decided.steer(Steering::Goal(at_rest(circle.position_m(), circle.heading_rad())));
                    return TaskProgress::Done(None);
                };
                self.consult(|_, situation, proposal| proposal.follow(situation, &set_point));
                self.machines.mission.task = Some(Task::Circle(circle));
                TaskProgress::Going
            }
            Task::Descend(_) if self.machines.landing.is_landed() => TaskProgress::Done(None),
            Task::Descend(above) => {
                self.consult(|_, situation, proposal| descend(situation, proposal, above));
                TaskProgress::Going
            }
            Task::Climb { .. } | Task::Wait(_) => TaskProgress::Going,
        }
    }

    fn fly_leg(&mut self, mut leg: Leg, then: Then) -> TaskProgress {
        let outputs = self.perception.outputs();
        let progress = leg.update(&outputs.setpoint, &outputs.position_m, &outputs.velocity_m_s);
        let yaw_rad = match *self.decided.steering() {
            Steering::Goal(goal) => goal.yaw_rad,
            _ => outputs.setpoint.yaw_rad,
        };
        self.decided.steer(Steering::Goal(leg.goal(yaw_rad)));
        self.machines.mission.task = Some(Task::Leg(leg, then));
        match progress {
            LegProgress::Flying => return TaskProgress::Going,
            LegProgress::Passed(carry) => {
                self.machines.mission.anchor_m = leg.to_m;
                return TaskProgress::Done(Some(carry));
            }
            LegProgress::Arrived => self.machines.mission.anchor_m = leg.to_m,
        }
        self.machines.mission.task = Some(match then {
            Then::Wait(0.0) => return TaskProgress::Done(None),
            Then::Wait(seconds) => Task::Wait(Some(self.after_s(seconds))),
            Then::Stay => {
                self.reached_item(self.machines.mission.current);
                Task::Wait(None)
            }
            Then::Circle(circle) => Task::Circle(circle),
            Then::Land(above) => Task::Descend(Some(above)),
        });
        TaskProgress::Going
    }

    /// Whether the mission climbs from the ground or descends to it.
    pub(in super::super) fn mission_task_is_vertical(&self) -> (bool, bool) {
        let task = self.machines.mission.task.as_ref();
        (matches!(task, Some(Task::Climb { .. })), matches!(task, Some(Task::Descend(_))))
    }
}
