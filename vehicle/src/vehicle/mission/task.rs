//! What is done for a step that is flown.

use nalgebra::Vector3;

use super::super::flight::is_slow_near;
use super::super::notice::Severity;
use super::super::set_point::{AxisTarget, PositionSetPoint, YawTarget};
use super::super::state::{TICK_US, Vehicle};
use super::super::steering::{Steering, SteeringKind};
use super::circle::Circle;
use super::leg::{Carry, Leg, LegProgress};
use super::path::{Stop, first_corner};
use super::sequence::next_from;
use crate::plan::Place;
use crate::plan::step::{Delay, Navigate, Turns, Waypoint};

/// A task.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(clippy::large_enum_variant)] // There is one of it.
pub enum Task {
    /// Up to z, m, where it is.
    Climb {
        /// Goal, m.
        z_m: f64,
        /// Whether that is a takeoff, or the way up to another step.
        takeoff: bool,
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
    /// Acceptance radius of a step, m.
    fn acceptance_radius_m(&self, step: &Navigate) -> f64 {
        let own_m = match step {
            Navigate::Waypoint(waypoint) => waypoint.acceptance_radius_m,
            _ => None,
        };
        own_m.unwrap_or(self.conduct.acceptance_radius_m)
    }

    /// Where the leg of a step ends that begins at `from_m`; `None` if it has none.
    fn leg_end_m(&self, step: &Navigate, from_m: &Vector3<f64>) -> Option<Vector3<f64>> {
        match step {
            Navigate::Waypoint(Waypoint { place, .. })
            | Navigate::Loiter { place, .. }
            | Navigate::LoiterTime { place, .. } => Some(self.place_m(place, from_m)),
            Navigate::LoiterTurns(turns) => {
                Some(self.circle_of(turns, from_m, self.place_m(&turns.place, from_m).z).position_m())
            }
            // Down it goes only there.
            Navigate::Land { place, .. } => place.horizontal_m.map(|[x, y]| Vector3::new(x, y, from_m.z)),
            Navigate::Takeoff { .. } | Navigate::ReturnToLaunch | Navigate::Delay(_) => None,
        }
    }

    /// Turns at z, m, for a vehicle that comes from a place.
    fn circle_of(&self, turns: &Turns, from_m: &Vector3<f64>, z_m: f64) -> Circle {
        let [x, y] = turns.place.horizontal_m.unwrap_or([from_m.x, from_m.y]);
        Circle::new(Vector3::new(x, y, z_m), from_m, turns)
    }

    /// A place, NED, m; what it leaves open is that of another one.
    fn place_m(&self, place: &Place, open_m: &Vector3<f64>) -> Vector3<f64> {
        let [x, y] = place.horizontal_m.unwrap_or([open_m.x, open_m.y]);
        Vector3::new(x, y, place.down_m(self.home.position_m.z).unwrap_or(open_m.z))
    }

    /// Whether the vehicle comes to rest at a step.
    fn rests_at(&self, index: usize, step: &Navigate) -> bool {
        match step {
            Navigate::Waypoint(waypoint) => {
                waypoint.hold_s > 0.0 || !self.mission.program.continues_after(index)
            }
            _ => true,
        }
    }

    /// The places from step `index` on, as far as the vehicle goes from one to the next.
    fn places_ahead(&self, index: usize, from_m: &Vector3<f64>) -> Vec<Stop> {
        let program = &self.mission.program;
        let mut made = self.mission.jumps.clone();
        let (mut next, mut from_m) = (Some(index), *from_m);
        let mut stops = Vec::new();
        while let Some(index) = next.filter(|_| stops.len() < AHEAD) {
            let Some(step) = program.navigate(index) else { break };
            let Some(position_m) = self.leg_end_m(&step, &from_m) else { break };
            let rests = self.rests_at(index, &step);
            stops.push(Stop { position_m, radius_m: self.acceptance_radius_m(&step), rests });
            if rests {
                break;
            }
            next = next_from(program, index + 1, &mut made).navigation;
            from_m = position_m;
        }
        stops
    }

    /// A leg to an item, with its corner.
    fn plan_leg(&self, from_m: Vector3<f64>, to_m: Vector3<f64>, carry: Option<Carry>) -> Leg {
        let stops = self.places_ahead(self.mission.current, &from_m);
        let limits = self.simulation.configuration().limits;
        let (start_m, velocity_m_s) = match carry {
            Some(carry) => (carry.position_m, carry.velocity_m_s),
            None => (from_m, Vector3::zeros()),
        };
        let corner = first_corner(&start_m, velocity_m_s.norm(), &stops, &limits);
        let radius_m = stops.first().map_or(self.conduct.acceptance_radius_m, |stop| stop.radius_m);
        Leg::new(from_m, to_m, radius_m, carry, corner)
    }

    /// Plans the corner of the present leg again: limits of speed have changed, or what comes behind it.
    pub(in super::super) fn replan_leg(&mut self) {
        let Some(Task::Leg(leg, then)) = self.mission.task else { return };
        let again = self.plan_leg(leg.from_m, leg.to_m, None);
        self.mission.task = Some(Task::Leg(leg.with_corner(again.corner()), then));
    }

    /// Begins a step.
    pub(super) fn begin_step(&mut self, step: &Navigate) -> TaskProgress {
        let grounded = self.steering.kind() == SteeringKind::Idle;
        let task = match step {
            Navigate::Takeoff { place, .. } => return self.begin_takeoff(step, place),
            Navigate::ReturnToLaunch => return TaskProgress::Done(None),
            Navigate::Land { .. } if grounded => return TaskProgress::Done(None),
            Navigate::Delay(delay) => {
                self.hold();
                Task::Wait(Some(self.delay_end_us(delay)))
            }
            _ if grounded => self.climb_first(step),
            _ => match self.leg_end_m(step, &self.mission.anchor_m) {
                Some(end_m) => self.begin_leg(step, end_m),
                None => {
                    self.hold();
                    Task::Descend(None)
                }
            },
        };
        self.mission.task = Some(task);
        TaskProgress::Going
    }

    fn delay_end_us(&self, delay: &Delay) -> u64 {
        match delay {
            Delay::Until(time) => {
                self.time_us().saturating_add(time.wait_us(self.unix_start_us + self.time_us()))
            }
            Delay::For(time_s) => self.after_s(*time_s),
        }
    }

    /// So many seconds from now, µs.
    pub(super) fn after_s(&self, seconds: f64) -> u64 {
        self.time_us().saturating_add((seconds * 1e6) as u64)
    }

    /// On the ground a step above it begins with a climb: to its height, and at least to that of a takeoff.
    fn climb_first(&mut self, step: &Navigate) -> Task {
        let least_z_m = self.home.position_m.z - self.conduct.takeoff_height_m;
        let z_m = self.leg_end_m(step, &self.outputs.position_m).map_or(least_z_m, |end_m| end_m.z);
        self.begin_climb(z_m.min(least_z_m), false)
    }

    fn begin_climb(&mut self, z_m: f64, takeoff: bool) -> Task {
        let here = self.steering.present(&self.outputs).position_m;
        let axes = [AxisTarget::Position(here.x), AxisTarget::Position(here.y), AxisTarget::Position(z_m)];
        self.mission.heading_rad = match self.steering {
            Steering::Goal(goal) => goal.yaw_rad,
            _ => self.outputs.attitude_rad.z,
        };
        self.follow(&PositionSetPoint { axes, yaw: YawTarget::Angle(self.mission.heading_rad) });
        self.mission.anchor_m = Vector3::new(here.x, here.y, z_m);
        Task::Climb { z_m, takeoff }
    }

    /// Up where it is. Who is above already does not come down for a takeoff.
    fn begin_takeoff(&mut self, step: &Navigate, place: &Place) -> TaskProgress {
        const LEAST_M: f64 = 0.5;
        let home_z_m = self.home.position_m.z;
        let z_m = match place.down_m(home_z_m) {
            Some(z_m) if home_z_m - z_m >= LEAST_M => z_m,
            _ => home_z_m - self.conduct.takeoff_height_m,
        };
        if self.steering.kind() != SteeringKind::Idle && self.outputs.setpoint.position_m.z <= z_m {
            return self.leave_takeoff(step);
        }
        if self.steering.kind() == SteeringKind::Idle {
            self.say(Severity::Info, format!("Taking off to {:.1} m above home", home_z_m - z_m));
        }
        self.mission.task = Some(self.begin_climb(z_m, true));
        TaskProgress::Going
    }

    /// The climb is over.
    fn leave_takeoff(&mut self, step: &Navigate) -> TaskProgress {
        let here_m = self.mission.anchor_m;
        let Navigate::Takeoff { place: Place { horizontal_m: Some([x, y]), .. }, travels: true } = step
        else {
            return TaskProgress::Done(None);
        };
        let end_m = Vector3::new(*x, *y, here_m.z);
        if (end_m - here_m).norm() <= self.conduct.acceptance_radius_m {
            return TaskProgress::Done(None);
        }
        self.mission.task = Some(self.begin_leg(step, end_m));
        TaskProgress::Going
    }

    fn begin_leg(&mut self, step: &Navigate, end_m: Vector3<f64>) -> Task {
        let from_m = self.mission.anchor_m;
        let carry = self.mission.carry.take();
        let leg = self.plan_leg(from_m, end_m, carry);
        let (then, asked_rad) = match step {
            Navigate::Waypoint(waypoint) => (Then::Wait(waypoint.hold_s), waypoint.heading_rad),
            Navigate::Loiter { heading_rad, .. } => (Then::Stay, *heading_rad),
            Navigate::LoiterTime { time_s, .. } => (Then::Wait(*time_s), None),
            Navigate::LoiterTurns(turns) => (Then::Circle(self.circle_of(turns, &from_m, end_m.z)), None),
            Navigate::Land { heading_rad, .. } => (Then::Land([end_m.x, end_m.y]), *heading_rad),
            Navigate::Takeoff { .. } | Navigate::ReturnToLaunch | Navigate::Delay(_) => {
                (Then::Wait(0.0), None)
            }
        };
        let facing_rad = match then {
            Then::Circle(circle) => Some(circle.heading_rad()),
            _ => asked_rad.or_else(|| leg.bearing_rad()),
        };
        if let Some(heading_rad) = facing_rad {
            self.mission.heading_rad = heading_rad;
        }
        Task::Leg(leg, then)
    }

    /// One tick of the present task.
    pub(super) fn carry_on(&mut self, task: Task, step: &Navigate) -> TaskProgress {
        match task {
            Task::Climb { z_m, takeoff: false } if is_slow_near(&self.outputs, z_m) => TaskProgress::Again,
            Task::Climb { z_m, takeoff: true } if is_slow_near(&self.outputs, z_m) => {
                self.leave_takeoff(step)
            }
            Task::Leg(leg, then) => self.fly_leg(leg, then),
            Task::Wait(Some(until_us)) if self.time_us() >= until_us => TaskProgress::Done(None),
            Task::Circle(mut circle) => {
                let limits = self.simulation.configuration().limits;
                let Some(set_point) = circle.step(&limits, TICK_US as f64 / 1e6) else {
                    self.mission.anchor_m = circle.position_m();
                    self.mission.heading_rad = circle.heading_rad();
                    self.steering = Steering::Goal(super::super::motion::at_rest(
                        circle.position_m(),
                        circle.heading_rad(),
                    ));
                    return TaskProgress::Done(None);
                };
                self.follow(&set_point);
                self.mission.task = Some(Task::Circle(circle));
                TaskProgress::Going
            }
            Task::Descend(_) if self.landed.is_landed() => TaskProgress::Done(None),
            Task::Descend(above) => {
                self.descend(above);
                TaskProgress::Going
            }
            Task::Climb { .. } | Task::Wait(_) => TaskProgress::Going,
        }
    }

    fn fly_leg(&mut self, mut leg: Leg, then: Then) -> TaskProgress {
        let outputs = &self.outputs;
        let progress = leg.update(&outputs.setpoint, &outputs.position_m, &outputs.velocity_m_s);
        let yaw_rad = match self.steering {
            Steering::Goal(goal) => goal.yaw_rad,
            _ => outputs.setpoint.yaw_rad,
        };
        self.steering = Steering::Goal(leg.goal(yaw_rad));
        self.mission.task = Some(Task::Leg(leg, then));
        match progress {
            LegProgress::Flying => return TaskProgress::Going,
            LegProgress::Passed(carry) => {
                self.mission.anchor_m = leg.to_m;
                return TaskProgress::Done(Some(carry));
            }
            LegProgress::Arrived => self.mission.anchor_m = leg.to_m,
        }
        self.mission.task = Some(match then {
            Then::Wait(0.0) => return TaskProgress::Done(None),
            Then::Wait(seconds) => Task::Wait(Some(self.after_s(seconds))),
            Then::Stay => {
                self.reached_item(self.mission.current);
                Task::Wait(None)
            }
            Then::Circle(circle) => Task::Circle(circle),
            Then::Land(above) => Task::Descend(Some(above)),
        });
        TaskProgress::Going
    }

    /// Whether the mission climbs from the ground or descends to it.
    pub(in super::super) fn mission_task_is_vertical(&self) -> (bool, bool) {
        let task = self.mission.task.as_ref();
        (matches!(task, Some(Task::Climb { .. })), matches!(task, Some(Task::Descend(_))))
    }
}
