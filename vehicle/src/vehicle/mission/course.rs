//! How a step is flown: its task from the beginning to the end.

mod curves;

use nalgebra::Vector3;

use super::super::descent::descend;
use super::super::fence_watch::stopping_place_m;
use super::super::motion::at_rest;
use super::super::notice::Severity;
use super::super::proposal::Proposal;
use super::super::set_point::{AxisTarget, PositionSetPoint, YawTarget};
use super::super::situation::Situation;
use super::super::spline::Onward;
use super::super::steering::{Steering, SteeringKind};
use super::super::takeoff::is_slow_near;
use super::super::tick::TICK_S;
use super::announcement;
use super::leg::{Guide, Leg, LegProgress, Turn, bearing_rad, is_settling};
use super::route::Route;
use super::takeoff_height::{climb_z_m, height_without_m, takeoff_z_m};
use super::task::{Lowering, Task, TaskProgress, Then, delay_end_us};
use crate::equipment::Operation;
use crate::plan::Place;
use crate::plan::step::Navigate;

/// What is being done for the present step.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Course {
    task: Option<Task>,
    /// Turn that the next leg takes over.
    turn: Option<Turn>,
    /// Where the next leg begins, NED, m.
    anchor_m: Vector3<f64>,
    /// Heading of the present step, rad.
    heading_rad: f64,
    /// Whether the step asks for that heading itself.
    heading_is_asked: bool,
    /// How the next piece of a curve begins.
    onward: Option<Onward>,
}

impl Course {
    /// Whether something is being done.
    pub fn is_busy(&self) -> bool {
        self.task.is_some()
    }

    /// Beginning and end of the way that is flown, NED, m, if one is.
    pub fn way_m(&self) -> Option<[Vector3<f64>; 2]> {
        match &self.task {
            Some(Task::Leg(leg, _)) => Some([leg.from_m, leg.to_m]),
            Some(Task::GroundWay(way, ..)) => Some(way.ends_m()),
            Some(Task::Spline(spline, _)) => Some(spline.ends_m()),
            _ => None,
        }
    }

    /// The line that is followed, two places on it, NED, m: of a curve that which touches it where the vehicle is led.
    pub fn line_m(&self) -> Option<[Vector3<f64>; 2]> {
        match &self.task {
            Some(Task::Spline(spline, _)) => Some(spline.touching_m()),
            _ => self.way_m(),
        }
    }

    /// Whether a curve is flown.
    pub fn is_curved(&self) -> bool {
        matches!(self.task, Some(Task::Spline(..) | Task::GroundWay(..)))
    }

    /// Whether the way home is flown.
    pub fn returns(&self) -> bool {
        matches!(self.task, Some(Task::Return))
    }

    /// Whether it climbs from the ground or descends to it.
    pub fn is_vertical(&self) -> (bool, bool) {
        (
            matches!(self.task, Some(Task::Climb { .. })),
            matches!(self.task, Some(Task::Descend(_) | Task::Lower(_))),
        )
    }

    /// Heading of the present step, rad.
    pub fn heading_rad(&self) -> f64 {
        self.heading_rad
    }

    /// Whether the step asks for that heading itself: otherwise it is that of its way.
    pub fn heading_is_asked(&self) -> bool {
        self.heading_is_asked
    }

    /// Gives up what is being done, to be begun again; the next leg may take a turn over.
    pub fn give_up(&mut self, turn: Option<Turn>) {
        (self.task, self.turn) = (None, turn);
    }

    /// Goes on from where the vehicle is.
    pub fn take_over(&mut self, situation: &Situation, proposal: &mut Proposal) {
        self.turn = None;
        self.anchor_m = proposal.steering().present(situation.outputs).position_m;
        self.heading_rad = situation.outputs.attitude_rad.z;
        self.heading_is_asked = true;
        proposal.hold(situation);
    }

    /// Plans the rest of the present leg again: limits of speed have changed. A corner that is being passed is passed as planned.
    pub fn replan(&mut self, route: &Route, situation: &Situation) {
        if let Some(Task::Leg(leg, _)) = &mut self.task
            && let Some(start) = leg.start(situation)
        {
            leg.replan(route.corner(&leg.from_m, &start), situation);
        }
    }

    /// One tick of a step: begins it, or goes on with it.
    pub fn step(
        &mut self,
        step: &Navigate,
        route: &Route,
        situation: &Situation,
        proposal: &mut Proposal,
    ) -> TaskProgress {
        match self.task {
            None => self.begin(step, route, situation, proposal),
            Some(task) => self.carry_on(task, step, route, situation, proposal),
        }
    }

    fn begin(
        &mut self,
        step: &Navigate,
        route: &Route,
        situation: &Situation,
        proposal: &mut Proposal,
    ) -> TaskProgress {
        let grounded = proposal.steering().kind() == SteeringKind::Idle;
        let task = match step {
            Navigate::Takeoff { place, .. } => {
                return self.begin_takeoff(step, place, route, situation, proposal);
            }
            // ArduPilot returns within the mission's mode, the others change to that of the return.
            Navigate::ReturnToLaunch if grounded || !situation.identity.is_ardupilot() => {
                return TaskProgress::Done(None);
            }
            Navigate::ReturnToLaunch => Task::Return,
            Navigate::Land { .. } if grounded => return TaskProgress::Done(None),
            Navigate::Delay(delay) => {
                proposal.hold(situation);
                Task::Wait(Some(delay_end_us(delay, situation)))
            }
            // On the ground a step above it begins with a climb.
            _ if grounded => {
                let end_m = route.leg_end_m(step, &situation.outputs.position_m);
                let z_m = climb_z_m(end_m, proposal.home().position_m.z, situation.conduct.takeoff_height_m);
                self.begin_climb(z_m, false, situation, proposal)
            }
            step if matches!(step, Navigate::Spline { .. }) || route.follows_ground(step) => {
                return self.begin_curve(step, route, situation, proposal);
            }
            // A leg begins at rest, after a turn or in full motion.
            _ if self.turn.is_none() && is_settling(&situation.outputs.setpoint) => {
                return TaskProgress::Going;
            }
            _ if route.faces_first() && self.turn.is_none() => {
                self.begin_facing(step, route, proposal, situation)
            }
            _ => self.begin_way(step, route, situation, proposal),
        };
        self.task = Some(task);
        TaskProgress::Going
    }

    /// The nose to where the leg leads, which begins then.
    fn begin_facing(
        &mut self,
        step: &Navigate,
        route: &Route,
        proposal: &mut Proposal,
        situation: &Situation,
    ) -> Task {
        let Some(end_m) = route.leg_end_m(step, &self.anchor_m) else {
            return self.begin_way(step, route, situation, proposal);
        };
        let (_, asked_rad) = self.then(step, &end_m, route);
        self.head_for(asked_rad, bearing_rad(&self.anchor_m, &end_m));
        Task::Face
    }

    /// To the step's place, or down where it has none.
    fn begin_way(
        &mut self,
        step: &Navigate,
        route: &Route,
        situation: &Situation,
        proposal: &mut Proposal,
    ) -> Task {
        match route.leg_end_m(step, &self.anchor_m) {
            Some(end_m) => self.begin_leg(step, end_m, route, situation),
            None => {
                proposal.hold(situation);
                Task::Descend(None)
            }
        }
    }

    /// The heading on a way: what is asked for, else its direction, if it has one.
    fn head_for(&mut self, asked_rad: Option<f64>, bearing_rad: Option<f64>) {
        self.heading_is_asked = asked_rad.is_some();
        if let Some(heading_rad) = asked_rad.or(bearing_rad) {
            self.heading_rad = heading_rad;
        }
    }

    /// Down with what the gripper holds: on the ground it is released, and without a ground it is taken back.
    fn lower(&mut self, lowering: Lowering, situation: &Situation, proposal: &mut Proposal) -> TaskProgress {
        // It sinks on while it turns.
        let ends_z_m = stopping_place_m(situation, situation.limits()).z;
        if situation.landed {
            proposal.say(Severity::Info, "Payload placed");
            proposal.operate(Operation::Grip { grabs: false });
        } else if ends_z_m >= lowering.lowest_z_m {
            proposal.say(Severity::Warning, "Payload not placed: no ground within the descent");
        } else {
            descend(situation, proposal, Some(lowering.above_m));
            return TaskProgress::Going;
        }
        self.task = Some(self.begin_rise(lowering.back_z_m, situation, proposal));
        TaskProgress::Going
    }

    /// To another height, with the present heading.
    fn begin_rise(&mut self, z_m: f64, situation: &Situation, proposal: &mut Proposal) -> Task {
        let [x, y] = [self.anchor_m.x, self.anchor_m.y];
        let axes = [x, y, z_m].map(AxisTarget::Position);
        proposal.follow(situation, &PositionSetPoint { axes, yaw: YawTarget::Angle(self.heading_rad) });
        self.anchor_m.z = z_m;
        Task::Rise(z_m)
    }

    fn begin_climb(
        &mut self,
        z_m: f64,
        takeoff: bool,
        situation: &Situation,
        proposal: &mut Proposal,
    ) -> Task {
        let here = proposal.steering().present(situation.outputs).position_m;
        let axes = [AxisTarget::Position(here.x), AxisTarget::Position(here.y), AxisTarget::Position(z_m)];
        self.heading_rad = match proposal.steering() {
            Steering::Goal(goal) => goal.yaw_rad,
            _ => situation.outputs.attitude_rad.z,
        };
        self.heading_is_asked = true;
        proposal.follow(situation, &PositionSetPoint { axes, yaw: YawTarget::Angle(self.heading_rad) });
        self.anchor_m = Vector3::new(here.x, here.y, z_m);
        Task::Climb { z_m, takeoff }
    }

    /// Up where it is. Who is above already does not come down for a takeoff.
    fn begin_takeoff(
        &mut self,
        step: &Navigate,
        place: &Place,
        route: &Route,
        situation: &Situation,
        proposal: &mut Proposal,
    ) -> TaskProgress {
        let home_z_m = proposal.home().position_m.z;
        let z_m = takeoff_z_m(place, home_z_m, height_without_m(situation));
        let grounded = proposal.steering().kind() == SteeringKind::Idle;
        if !grounded && situation.outputs.setpoint.position_m.z <= z_m {
            return self.leave_takeoff(step, route, situation);
        }
        if grounded {
            proposal.say(Severity::Info, format!("Taking off to {:.1} m above home", home_z_m - z_m));
        }
        self.task = Some(self.begin_climb(z_m, true, situation, proposal));
        TaskProgress::Going
    }

    /// The climb is over.
    fn leave_takeoff(&mut self, step: &Navigate, route: &Route, situation: &Situation) -> TaskProgress {
        let Navigate::Takeoff { place: Place { horizontal_m: Some([x, y]), .. }, travels: true } = step
        else {
            return TaskProgress::Done(None);
        };
        let end_m = Vector3::new(*x, *y, self.anchor_m.z);
        if (end_m - self.anchor_m).norm() <= situation.conduct.acceptance_radius_m {
            return TaskProgress::Done(None);
        }
        self.task = Some(self.begin_leg(step, end_m, route, situation));
        TaskProgress::Going
    }

    fn begin_leg(
        &mut self,
        step: &Navigate,
        end_m: Vector3<f64>,
        route: &Route,
        situation: &Situation,
    ) -> Task {
        let (from_m, turn) = (self.anchor_m, self.turn.take());
        let leg = route.leg([from_m, end_m], turn, situation);
        let (then, asked_rad) = self.then(step, &end_m, route);
        self.head_for(asked_rad, leg.bearing_rad());
        Task::Leg(leg, then)
    }

    /// What comes at the end of a step's way, and the heading that it asks for on the way, rad.
    fn then(&self, step: &Navigate, end_m: &Vector3<f64>, route: &Route) -> (Then, Option<f64>) {
        match step {
            Navigate::Waypoint(waypoint) => (Then::Wait(waypoint.hold_s), waypoint.heading_rad),
            Navigate::Loiter { heading_rad, .. } => (Then::Stay, *heading_rad),
            Navigate::LoiterTime { time_s, .. } => (Then::Wait(*time_s), None),
            Navigate::LoiterTurns(turns) => {
                let circle = route.circle(turns, &self.anchor_m);
                (Then::Circle(circle), Some(circle.heading_rad()))
            }
            Navigate::Land { heading_rad, .. } => (Then::Land([end_m.x, end_m.y]), *heading_rad),
            Navigate::LoiterToAltitude { place } => (Then::Rise(route.down_m(place, end_m.z)), None),
            Navigate::PlacePayload { descent_m, .. } => {
                (Then::Lower(descent_m.unwrap_or(f64::INFINITY)), None)
            }
            Navigate::Takeoff { .. }
            | Navigate::ReturnToLaunch
            | Navigate::Spline { .. }
            | Navigate::Delay(_) => (Then::Wait(0.0), None),
        }
    }

    fn carry_on(
        &mut self,
        task: Task,
        step: &Navigate,
        route: &Route,
        situation: &Situation,
        proposal: &mut Proposal,
    ) -> TaskProgress {
        match task {
            Task::Climb { z_m, takeoff } if is_slow_near(situation.outputs, z_m) => {
                if takeoff {
                    return self.leave_takeoff(step, route, situation);
                }
                self.task = None;
                TaskProgress::Again
            }
            Task::Face => {
                if faces(situation, proposal) {
                    self.task = Some(self.begin_way(step, route, situation, proposal));
                }
                TaskProgress::Going
            }
            Task::Leg(leg, then) => self.fly_leg(leg, then, situation, proposal),
            Task::Wait(Some(until_us)) if situation.time_us >= until_us => TaskProgress::Done(None),
            Task::Circle(mut circle) => {
                let Some(set_point) = circle.step(situation.limits(), TICK_S) else {
                    (self.anchor_m, self.heading_rad) = (circle.position_m(), circle.heading_rad());
                    proposal.steer(Steering::Goal(at_rest(self.anchor_m, self.heading_rad)));
                    return TaskProgress::Done(None);
                };
                proposal.follow(situation, &set_point);
                self.task = Some(Task::Circle(circle));
                TaskProgress::Going
            }
            Task::Descend(_) | Task::Return if situation.landed => TaskProgress::Done(None),
            Task::Descend(above) => {
                descend(situation, proposal, above);
                TaskProgress::Going
            }
            Task::Rise(z_m) if is_slow_near(situation.outputs, z_m) => TaskProgress::Done(None),
            Task::GroundWay(way, spline, then) => self.fly_ground_way(way, spline, then, situation, proposal),
            Task::Spline(spline, hold_s) => self.fly_spline(spline, hold_s, situation, proposal),
            Task::Lower(lowering) => self.lower(lowering, situation, proposal),
            Task::Climb { .. } | Task::Rise(_) | Task::Wait(_) | Task::Return => TaskProgress::Going,
        }
    }

    fn fly_leg(
        &mut self,
        mut leg: Leg,
        then: Then,
        situation: &Situation,
        proposal: &mut Proposal,
    ) -> TaskProgress {
        let progress = leg.update(situation);
        match leg.guide() {
            Guide::Goal(goal) => proposal.go_through(situation, &goal),
            Guide::Path { flight, next, after_m } => {
                proposal.fly_along(situation, flight, next, after_m);
            }
        }
        self.task = Some(Task::Leg(leg, then));
        match progress {
            LegProgress::Flying => return TaskProgress::Going,
            LegProgress::Passed(turn) => {
                self.anchor_m = leg.to_m;
                return TaskProgress::Done(Some(turn));
            }
            LegProgress::Arrived if self.waits_for_heading(then, situation, proposal) => {
                return TaskProgress::Going;
            }
            LegProgress::Arrived => self.anchor_m = leg.to_m,
        }
        self.arrive(then, situation, proposal)
    }

    /// Whether a waypoint is not left yet, as the nose does not point where that asks for.
    fn waits_for_heading(&self, then: Then, situation: &Situation, proposal: &Proposal) -> bool {
        matches!(then, Then::Wait(_))
            && self.heading_is_asked
            && !situation.identity.is_ardupilot()
            && situation.conduct.mission_heading.waits()
            && !faces(situation, proposal)
    }

    /// What comes at the end of a way at which the vehicle rests.
    fn arrive(&mut self, then: Then, situation: &Situation, proposal: &mut Proposal) -> TaskProgress {
        let (task, progress) = match then {
            Then::Wait(0.0) => return TaskProgress::Done(None),
            Then::Wait(time_s) => (Task::Wait(Some(situation.after_us(time_s))), TaskProgress::Going),
            Then::Stay => (Task::Wait(None), TaskProgress::Staying),
            Then::Circle(circle) => {
                announcement::circling(situation, proposal);
                (Task::Circle(circle), TaskProgress::Going)
            }
            Then::Land(above) => (Task::Descend(Some(above)), TaskProgress::Going),
            Then::Rise(z_m) => (self.begin_rise(z_m, situation, proposal), TaskProgress::Going),
            Then::Lower(descent_m) => {
                let [x, y, z] = self.anchor_m.data.0[0];
                let (above_m, lowest_z_m) = ([x, y], z + descent_m);
                (Task::Lower(Lowering { above_m, lowest_z_m, back_z_m: z }), TaskProgress::Going)
            }
        };
        self.task = Some(task);
        progress
    }
}

/// Whether the nose is where it is turned to, by whomever.
fn faces(situation: &Situation, proposal: &Proposal) -> bool {
    let wanted_rad = match proposal.steering() {
        Steering::Goal(goal) => goal.yaw_rad,
        Steering::Path(path) => path.goal().yaw_rad,
        _ => return true,
    };
    situation.conduct.mission_heading.is_met(wanted_rad, situation.outputs.attitude_rad.z)
}
