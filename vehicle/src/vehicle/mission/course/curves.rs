//! Steps that are flown along curves: splines, and ways that follow the ground.

use nalgebra::Vector3;

use super::super::leg::is_at_rest;
use super::super::route::Route;
use super::super::task::{Task, TaskProgress, Then};
use super::Course;
use crate::plan::step::Navigate;
use crate::vehicle::ground_way::{GroundWay, headed};
use crate::vehicle::heading_policy::Purpose;
use crate::vehicle::motion::at_rest;
use crate::vehicle::proposal::Proposal;
use crate::vehicle::set_point::{AxisTarget, PositionSetPoint, YawTarget};
use crate::vehicle::situation::Situation;
use crate::vehicle::spline::{Bend, Onward, Spline, is_near};
use crate::vehicle::steering::Steering;
use crate::vehicle::tick::TICK_S;

impl Course {
    /// A piece of a curve goes on within the same tick from the piece before it, or begins at rest.
    pub(super) fn begin_curve(
        &mut self,
        step: &Navigate,
        route: &Route,
        situation: &Situation,
        proposal: &mut Proposal,
    ) -> TaskProgress {
        let onward = self.onward.take().filter(|onward| onward.time_us == situation.time_us);
        if onward.is_none() && !is_at_rest(&situation.outputs.setpoint) {
            return TaskProgress::Going;
        }
        let here_m = onward.map_or(situation.outputs.setpoint.position_m, |onward| onward.position_m);
        let from_m = if matches!(step, Navigate::Spline { .. }) { here_m } else { self.anchor_m };
        if route.leg_end_m(step, &from_m).is_some_and(|end_m| is_near(&here_m, &end_m)) {
            return self.be_there(step, here_m, onward, route, situation, proposal);
        }
        self.task = match step {
            Navigate::Spline { hold_s, .. } => Self::begin_spline(*hold_s, here_m, onward, route, situation),
            _ => self.begin_ground_way(step, here_m, onward, route, situation),
        };
        if self.task.is_some() && onward.is_some() { TaskProgress::Again } else { TaskProgress::Going }
    }

    /// The place of a step is where the vehicle is already: a curve that goes on does so with the step behind it.
    fn be_there(
        &mut self,
        step: &Navigate,
        here_m: Vector3<f64>,
        onward: Option<Onward>,
        route: &Route,
        situation: &Situation,
        proposal: &mut Proposal,
    ) -> TaskProgress {
        self.anchor_m = here_m;
        if onward.is_some() {
            self.onward = onward;
            return TaskProgress::Done(None);
        }
        let (then, asked_rad) = match step {
            Navigate::Spline { hold_s, .. } => (Then::Wait(*hold_s), None),
            _ => self.then(step, &here_m, route),
        };
        self.head_for(asked_rad, None);
        proposal.steer(Steering::Goal(at_rest(here_m, self.heading_rad)));
        self.arrive(then, situation, proposal)
    }

    fn begin_spline(
        hold_s: f64,
        from_m: Vector3<f64>,
        onward: Option<Onward>,
        route: &Route,
        situation: &Situation,
    ) -> Option<Task> {
        let spline = Spline::new(from_m, onward, &route.curve_m(&from_m), Bend::Wide, situation.limits())?;
        Some(Task::Spline(spline, hold_s))
    }

    /// The next piece of a way that follows the ground.
    fn begin_ground_way(
        &mut self,
        step: &Navigate,
        here_m: Vector3<f64>,
        onward: Option<Onward>,
        route: &Route,
        situation: &Situation,
    ) -> Option<Task> {
        let way = GroundWay::new(self.anchor_m, route.leg_end_m(step, &self.anchor_m)?);
        let places_m = route.ground_places_m(&self.anchor_m, &here_m);
        let spline = Spline::new(here_m, onward, &places_m, Bend::Close, situation.limits())?;
        let (then, asked_rad) = self.then(step, &way.end_m(), route);
        self.turn = None;
        self.head_for(asked_rad, way.bearing_rad());
        Some(Task::GroundWay(way, spline, then))
    }

    pub(super) fn fly_ground_way(
        &mut self,
        way: GroundWay,
        mut spline: Spline,
        then: Then,
        situation: &Situation,
        proposal: &mut Proposal,
    ) -> TaskProgress {
        if let Some(set_point) = spline.step(TICK_S) {
            let set_point = if self.heading_is_asked {
                PositionSetPoint { yaw: YawTarget::Angle(self.heading_rad), ..set_point }
            } else {
                headed(set_point, Purpose::Mission, self.heading_rad, situation)
            };
            proposal.follow(situation, &set_point);
            self.task = Some(Task::GroundWay(way, spline, then));
            return TaskProgress::Going;
        }
        self.onward = spline.onward(situation.time_us);
        if spline.end_m() != way.end_m() {
            self.task = None;
            return TaskProgress::Again;
        }
        self.anchor_m = way.end_m();
        if self.onward.is_some() {
            return TaskProgress::Done(None);
        }
        let yaw = if self.heading_is_asked { YawTarget::Angle(self.heading_rad) } else { YawTarget::Hold };
        let axes = self.anchor_m.data.0[0].map(AxisTarget::Position);
        proposal.follow(situation, &PositionSetPoint { axes, yaw });
        self.arrive(then, situation, proposal)
    }

    pub(super) fn fly_spline(
        &mut self,
        mut spline: Spline,
        hold_s: f64,
        situation: &Situation,
        proposal: &mut Proposal,
    ) -> TaskProgress {
        if let Some(set_point) = spline.step(TICK_S) {
            proposal.follow(situation, &set_point);
            self.task = Some(Task::Spline(spline, hold_s));
            return TaskProgress::Going;
        }
        self.anchor_m = spline.end_m();
        self.heading_rad = spline.end_heading_rad().unwrap_or(self.heading_rad);
        self.onward = spline.onward(situation.time_us);
        if self.onward.is_some() {
            return TaskProgress::Done(None);
        }
        proposal.steer(Steering::Goal(at_rest(self.anchor_m, self.heading_rad)));
        if hold_s == 0.0 {
            return TaskProgress::Done(None);
        }
        self.task = Some(Task::Wait(Some(situation.after_us(hold_s))));
        TaskProgress::Going
    }
}
