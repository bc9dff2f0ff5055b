//! Set-points from outside.

use super::attitude_flight::AttitudeFlight;
use super::failsafe::Cause;
use super::ground_flight::GroundFlight;
use super::guided_heading::Lead;
use super::notice::Severity;
use super::proposal::Proposal;
use super::set_point::{PositionSetPoint, SetPoint};
use super::situation::Situation;
use super::steering::{Steering, SteeringKind};
use super::streamed_motion::StreamedMotion;
use crate::mode::Mode;

/// What has come of set-points.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Offboard {
    /// The latest, and when it came, µs.
    latest: Option<(SetPoint, u64)>,
    /// Whether it has been steered to.
    applied: bool,
    /// How it leads the vehicle, and whether a heading has been asked for since it does (ArduPilot).
    lead: Option<Lead>,
    heading_is_asked: bool,
    /// Whether the nose points to what is looked at (ArduPilot).
    looks: bool,
    /// Whether it has run out (ArduPilot: it then holds its place until the next one).
    expired: bool,
    /// What a pause has interrupted, and where that led along the ground.
    paused: Option<Steering>,
    paused_way: Option<PositionSetPoint>,
    /// Attitudes whose thrust asks for a climb rate.
    attitude: AttitudeFlight,
    /// Trajectories whose acceleration is to be found.
    stream: StreamedMotion,
}

impl Offboard {
    /// Takes a set-point that came at a time, µs. Returns whether it leads the vehicle in another way than before.
    pub fn take(&mut self, set_point: SetPoint, time_us: u64) -> bool {
        let changed = self.lead_by(Lead::of(&set_point));
        self.heading_is_asked |= set_point.turns();
        if set_point.position().is_some() {
            self.attitude.forget();
        }
        (self.latest, self.applied, self.expired) = (Some((set_point, time_us)), false, false);
        changed
    }

    /// The vehicle is led in a way. Returns whether that is another one than before; then no heading is asked for any more, and the nose
    /// no longer looks.
    pub fn lead_by(&mut self, lead: Lead) -> bool {
        let changed = self.lead != Some(lead);
        self.lead = Some(lead);
        self.heading_is_asked &= !changed;
        self.looks &= !changed;
        changed
    }

    /// How the vehicle is led.
    pub fn lead(&self) -> Option<Lead> {
        self.lead
    }

    /// The nose points to what is looked at from now on.
    pub fn look(&mut self, at_something: bool) {
        (self.heading_is_asked, self.looks) = (false, at_something);
    }

    /// Whether the nose points to what is looked at.
    pub fn looks(&self) -> bool {
        self.looks
    }

    /// Holds the place until [`resume`](Self::resume), whatever set-points come.
    pub fn pause(&mut self, ground: &mut GroundFlight, situation: &Situation, proposal: &mut Proposal) {
        if self.paused.is_none() {
            self.straighten(situation, proposal);
            self.paused_way = ground.interrupt(proposal.steering());
            self.paused = Some(*proposal.steering());
            proposal.follow(situation, &PositionSetPoint::HOLD);
            proposal.say(Severity::Info, "Paused: holding");
        }
    }

    /// Goes on to where the pause has interrupted it, or with what was asked for meanwhile.
    pub fn resume(&mut self, ground: &mut GroundFlight, situation: &Situation, proposal: &mut Proposal) {
        let waits = self.latest.is_some() && !self.applied;
        match (self.paused.take(), self.paused_way.take()) {
            (Some(_), Some(way)) if !waits => ground.go(&way, situation, proposal),
            (paused, _) => Self::resume_steering(paused.filter(|_| !waits), situation, proposal),
        }
    }

    fn resume_steering(paused: Option<Steering>, situation: &Situation, proposal: &mut Proposal) {
        match paused {
            Some(Steering::Goal(goal)) => proposal.steer(Steering::Goal(goal)),
            Some(Steering::Motion(motion)) => proposal.follow(situation, &motion.set_point()),
            _ => {}
        }
    }

    /// Whether it is paused.
    pub fn is_paused(&self) -> bool {
        self.paused.is_some()
    }

    /// Forgets all set-points: something else has been asked for.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// Another mode begins: a set-point that is still young is steered to anew.
    pub fn begin(&mut self) {
        (self.applied, self.paused, self.paused_way) = (false, None, None);
        // ArduPilot's guided mode begins as if a velocity of zero led it.
        (self.lead, self.heading_is_asked, self.looks) = (Some(Lead::Velocity), false, false);
        self.attitude.forget();
        self.stream = StreamedMotion::default();
    }

    /// Whether the set-points that are steered to have asked for a heading.
    pub fn turns(&self) -> bool {
        self.applied && self.heading_is_asked
    }

    /// Whether the latest set-point is not older than a timeout, s, at a time, µs.
    pub fn is_recent(&self, time_us: u64, timeout_s: f64) -> bool {
        let timeout_us = (timeout_s * 1e6) as u64;
        self.latest.is_some_and(|(_, taken_us)| time_us - taken_us <= timeout_us)
    }

    /// One tick of the offboard mode.
    pub fn step(&mut self, ground: &mut GroundFlight, situation: &Situation, proposal: &mut Proposal) {
        if self.is_paused() || situation.identity.is_ardupilot() && self.climbs_by_thrust(situation, proposal)
        {
            return;
        }
        if !situation.set_points_are_recent {
            match situation.identity.is_ardupilot() {
                true => self.guided_without_news(situation, proposal),
                false => proposal.see(Cause::SetPointsLost, true),
            }
            return;
        }
        if self.stream.is_overdue(situation.time_us) {
            self.straighten(situation, proposal);
        }
        if self.applied {
            return;
        }
        let Some((set_point, _)) = self.latest else { return };
        match set_point {
            SetPoint::Attitude(attitude) => {
                ground.forget();
                proposal.follow_attitude(situation, &attitude);
            }
            // On the ground it idles until it is led upwards, and looks again with the next tick.
            SetPoint::Position(position) | SetPoint::AboveGround(position)
                if proposal.steering().kind() == SteeringKind::Idle
                    && !position.leads_up(situation.outputs.position_m.z) =>
            {
                return;
            }
            SetPoint::AboveGround(position) => {
                self.stream = StreamedMotion::default();
                ground.go(&position, situation, proposal);
            }
            SetPoint::Position(position) => {
                ground.forget();
                let limits = situation.limits();
                let steered = self.stream.take(&position.within(limits), limits, situation.time_us);
                if let Some(set_point) = steered {
                    proposal.follow(situation, &set_point);
                }
            }
        }
        self.applied = true;
    }

    /// Goes on without the acceleration that was found for a streamed point, if that is still steered to.
    fn straighten(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let Some((bent, straight)) = self.stream.straighten(situation.time_us) else { return };
        if let Steering::Motion(motion) = proposal.steering() {
            let asked = motion.set_point();
            if asked.axes == bent.axes {
                let yaw = if asked.yaw == bent.yaw { straight.yaw } else { asked.yaw };
                proposal.follow(situation, &PositionSetPoint { axes: straight.axes, yaw });
            }
        }
    }

    /// ArduPilot: flies an attitude whose thrust asks for a climb rate, and in the mode that takes attitudes only what comes instead
    /// of one. Returns whether that is flown.
    fn climbs_by_thrust(&mut self, situation: &Situation, proposal: &mut Proposal) -> bool {
        let latest = self.latest.filter(|_| situation.set_points_are_recent);
        match latest {
            Some((SetPoint::Attitude(asked), _)) if !situation.conduct.thrust_is_asked_for() => {
                self.attitude.step(Some(&asked), situation, proposal);
                self.applied = true;
                true
            }
            Some((SetPoint::Attitude(_), _)) => false,
            _ if situation.mode == Mode::GuidedAttitude => {
                self.attitude.step(None, situation, proposal);
                true
            }
            _ => false,
        }
    }

    /// The failsafe has taken in that set-points have stopped. With an action that leaves the mode as it is, the vehicle holds
    /// its place there. Returns whether it begins to.
    pub fn hold_without_news(&mut self, situation: &Situation, proposal: &mut Proposal) -> bool {
        let follows = situation.mode == Mode::Offboard && situation.descends_without_rotor().is_none();
        let stopped = !situation.set_points_are_recent && !situation.identity.is_ardupilot();
        let begins = follows && stopped && !self.expired;
        if begins {
            self.expired = true;
            proposal.hold(situation);
        }
        begins
    }

    /// ArduPilot stays in its mode: a velocity, an acceleration or an attitude ends, a position stays.
    fn guided_without_news(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let ends = match self.latest {
            Some((set_point, _)) => set_point.position().is_none_or(PositionSetPoint::runs_on),
            None => false,
        };
        if ends && !self.expired && proposal.steering().kind() != SteeringKind::Idle {
            self.expired = true;
            proposal.say(Severity::Warning, "Set-points stopped: holding");
            proposal.follow(situation, &PositionSetPoint::HOLD);
        }
    }
}

#[cfg(test)]
mod tests {
    use quadrotor::PositionReference;

    use super::{Cause, GroundFlight, Mode, Offboard, PositionSetPoint, SetPoint};
    use crate::identity::Identity;
    use crate::vehicle::proposal::Request;
    use crate::vehicle::scene::{Scene, said};
    use crate::vehicle::set_point::{AxisTarget, YawTarget};
    use crate::vehicle::steering::{Steering, SteeringKind};

    fn place([x, y, z]: [f64; 3]) -> SetPoint {
        let axes = [x, y, z].map(AxisTarget::Position);
        SetPoint::Position(PositionSetPoint { axes, yaw: YawTarget::Hold })
    }

    /// As the vehicle does it: the machine is asked how recent its set-points are.
    fn step(offboard: &mut Offboard, scene: &mut Scene) -> Vec<Request> {
        let timeout_s = scene.conduct.set_point_timeout_s;
        scene.set_points_are_recent = offboard.is_recent(scene.outputs.time_us, timeout_s);
        let mut requests = scene.show(|situation, proposal| {
            offboard.step(&mut GroundFlight::default(), situation, proposal);
        });
        requests.extend(scene.show(|situation, proposal| {
            offboard.hold_without_news(situation, proposal);
        }));
        requests
    }

    #[test]
    fn a_set_point_is_steered_to_once() {
        let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]);
        scene.mode = Mode::Offboard;
        let mut offboard = Offboard::default();
        offboard.take(place([5.0, 0.0, -10.0]), scene.outputs.time_us);
        assert!(step(&mut offboard, &mut scene).is_empty());
        assert!(offboard.applied && scene.goal_m() == Some([5.0, 0.0, -10.0]));
        // What another part does with the steering meanwhile stays.
        scene.show(|situation, proposal| proposal.follow(situation, &PositionSetPoint::HOLD));
        step(&mut offboard, &mut scene);
        assert_eq!(scene.goal_m(), None);
        // Until the mode begins anew.
        offboard.begin();
        step(&mut offboard, &mut scene);
        assert_eq!(scene.goal_m(), Some([5.0, 0.0, -10.0]));
    }

    #[test]
    fn on_the_ground_it_waits_until_it_is_led_upwards() {
        let mut scene = Scene::on_the_ground();
        scene.mode = Mode::Offboard;
        let mut offboard = Offboard::default();
        offboard.take(place([5.0, 0.0, 0.0]), scene.outputs.time_us);
        step(&mut offboard, &mut scene);
        assert!(!offboard.applied && scene.steering.kind() == SteeringKind::Idle);
        offboard.take(place([5.0, 0.0, -2.0]), scene.outputs.time_us);
        step(&mut offboard, &mut scene);
        assert_eq!(scene.goal_m(), Some([5.0, 0.0, -2.0]));
    }

    #[test]
    fn the_failsafe_is_told_when_set_points_stop_and_the_place_is_held_once() {
        let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]);
        scene.mode = Mode::Offboard;
        let mut offboard = Offboard::default();
        offboard.take(place([5.0, 0.0, -10.0]), scene.outputs.time_us);
        step(&mut offboard, &mut scene);
        scene.wait_us(1_000_001);
        assert_eq!(step(&mut offboard, &mut scene), [Request::See(Cause::SetPointsLost, true)]);
        assert!(matches!(scene.steering, Steering::Motion(_)), "{:?}", scene.steering);
        let elsewhere = Steering::Goal(PositionReference::goal([9.0, 0.0, -10.0], 0.0));
        scene.steering = elsewhere;
        assert_eq!(step(&mut offboard, &mut scene), [Request::See(Cause::SetPointsLost, true)]);
        assert_eq!(scene.steering, elsewhere, "held again");
    }

    #[test]
    fn ardupilot_keeps_a_place_and_ends_a_velocity() {
        let [to_a_place, at_rest] = [AxisTarget::Position(5.0), AxisTarget::Velocity(0.0)]
            .map(|axis| SetPoint::Position(PositionSetPoint { axes: [axis; 3], yaw: YawTarget::Rate(0.1) }));
        for (set_point, ends) in [
            (place([5.0, 0.0, -10.0]), false),
            (to_a_place, false),
            (at_rest, true),
            (
                SetPoint::Position(PositionSetPoint {
                    axes: [AxisTarget::Velocity(1.0); 3],
                    yaw: YawTarget::Hold,
                }),
                true,
            ),
        ] {
            let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]);
            (scene.identity, scene.mode) = (Identity::ArduPilot, Mode::Offboard);
            let mut offboard = Offboard::default();
            offboard.take(set_point, scene.outputs.time_us);
            step(&mut offboard, &mut scene);
            let steered = scene.steering;
            scene.wait_us(5_000_000);
            let requests = step(&mut offboard, &mut scene);
            assert_eq!(said(&requests).len(), usize::from(ends), "{requests:?}");
            assert_eq!(scene.steering == steered, !ends);
            assert!(step(&mut offboard, &mut scene).is_empty(), "said once");
        }
    }
}
