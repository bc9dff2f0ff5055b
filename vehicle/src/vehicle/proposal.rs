//! What a machine asks for. The machine itself changes nothing but its own state.

use std::borrow::Cow;

use nalgebra::Vector3;
use quadrotor::{Heading, PositionReference};

use super::failsafe::Cause;
use super::heading_policy::HeadingPolicy;
use super::home::Home;
use super::notice::{Notice, Refusal, Severity};
use super::path_steering::PathSteering;
use super::region::RegionOfInterest;
use super::set_point::{AttitudeSetPoint, PositionSetPoint, YawTarget};
use super::situation::Situation;
use super::speeds::SpeedChange;
use super::steering::Steering;
use super::trajectory::PieceFlight;
use crate::equipment::Operation;
use crate::fence::FenceSwitch;
use crate::mode::Mode;
use crate::radio::Position;
use crate::world::FARTHEST_M;

/// What can be asked for besides steering, home and the region of interest.
#[derive(Clone, Debug, PartialEq)]
pub enum Request {
    /// A line for the pilot.
    Say(Notice),
    /// Another mode, whatever speaks against it.
    Enter(Mode),
    /// Another mode that goes on with what is done already; set-points from before it do not count in it.
    GoOnIn(Mode),
    /// Limits of speed.
    ChangeSpeeds(SpeedChange),
    /// The failsafe is to take in whether a cause is there.
    See(Cause, bool),
    /// Something is asked of the equipment.
    Operate(Operation),
    /// The landing of the mission, or without one the way home.
    JoinLanding,
    /// The fence is to be switched.
    SwitchFence(FenceSwitch),
    /// What a switch does, by ArduPilot's number, that comes to a position.
    MoveSwitch(u32, Position),
    /// The rotors are to stop; the text says why.
    StopRotors(String),
    /// The flight is to end at once.
    Terminate,
}

/// The result of a proposal.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// Other steering, if it has changed.
    pub steering: Option<Steering>,
    /// Home.
    pub home: Home,
    /// The region of interest.
    pub region: Option<RegionOfInterest>,
    /// The requests, in their order.
    pub requests: Vec<Request>,
}

/// What a machine asks for in one call.
///
/// Steering, home and region of interest are working copies: the machine may change them several times within the call, and reads
/// its own changes. Everything else is a list of requests. The decision takes over the three copies first and then carries out
/// the requests in order, so a mode that is asked for begins with whatever the machine steered in the same call.
///
/// The mission uses all of it: steering ([`Proposal::hold`], [`Proposal::follow`], [`Proposal::steer`]), a mode when it is done
/// ([`Proposal::enter`]; it is told when its own mode is left), notices, speeds, home ([`Proposal::set_home`]) and the region of
/// interest ([`Proposal::look_at`]). Changed speeds take effect after the call; the mission is told then, and plans its leg again.
#[derive(Clone, Debug, PartialEq)]
pub struct Proposal<'a> {
    /// Copied when they change.
    steering: Cow<'a, Steering>,
    home: Cow<'a, Home>,
    region: Option<RegionOfInterest>,
    requests: Vec<Request>,
}

impl<'a> Proposal<'a> {
    /// Everything as it is.
    pub fn new(situation: &Situation<'a>) -> Self {
        Self {
            steering: Cow::Borrowed(situation.steering),
            home: Cow::Borrowed(situation.home),
            region: situation.region,
            requests: Vec::new(),
        }
    }

    /// Whether everything is to stay as it is: most calls of most ticks.
    pub fn asks_nothing(&self, situation: &Situation) -> bool {
        matches!(self.steering, Cow::Borrowed(_))
            && self.requests.is_empty()
            && self.region == situation.region
            && (matches!(self.home, Cow::Borrowed(_)) || *self.home == *situation.home)
    }

    /// Ends the proposal.
    pub fn into_outcome(self) -> Outcome {
        let steering = match self.steering {
            Cow::Borrowed(_) => None,
            Cow::Owned(steering) => Some(steering),
        };
        let home = self.home.into_owned();
        Outcome { steering, home, region: self.region, requests: self.requests }
    }

    /// The working copy of the steering.
    pub fn steering(&self) -> &Steering {
        &self.steering
    }

    /// Steers like this.
    pub fn steer(&mut self, steering: Steering) {
        self.steering = Cow::Owned(steering);
    }

    /// Lets the rotors idle.
    pub fn idle(&mut self, situation: &Situation) {
        self.steer(Steering::Idle { yaw_rad: situation.outputs.attitude_rad.z });
    }

    /// Steers by position, unless it comes down without a rotor.
    pub fn follow(&mut self, situation: &Situation, set_point: &PositionSetPoint) {
        if situation.descends_without_rotor().is_none() {
            self.steering.to_mut().follow(set_point, situation.outputs);
        }
    }

    /// Steers by attitude.
    pub fn follow_attitude(&mut self, situation: &Situation, set_point: &AttitudeSetPoint) {
        self.steering.to_mut().follow_attitude(set_point, situation.outputs);
    }

    /// Brakes and holds the place. A vehicle that rests at its goal stays steered to it; one that has not set out yet does
    /// not.
    pub fn hold(&mut self, situation: &Situation) {
        const NEAR_M: f64 = 0.01;
        const SLOW_M_S: f64 = 0.01;
        let now = &situation.outputs.setpoint;
        let rests_at = |place_m: Vector3<f64>| {
            (place_m - now.position_m).norm() < NEAR_M && now.velocity_m_s.norm() < SLOW_M_S
        };
        match self.steering() {
            Steering::Idle { .. } => {}
            steering if steering.resting_place_m().is_some_and(rests_at) => {}
            _ => self.follow(situation, &PositionSetPoint::HOLD),
        }
    }

    /// Steers along a piece of a way, with the next piece if it is known and the corners of the way after it, NED, m. The heading goes on.
    pub fn fly_along(
        &mut self,
        situation: &Situation,
        flight: PieceFlight,
        next: Option<PieceFlight>,
        after_m: [Vector3<f64>; 2],
    ) {
        let now = &situation.outputs.setpoint;
        let (limits, time_us) = (situation.limits(), situation.time_us);
        let begin = |yaw_rad| PathSteering::new(flight, next, after_m, now, yaw_rad, limits, time_us);
        let path = match self.steering() {
            Steering::Path(path) => path.onto(flight, next, after_m),
            Steering::Goal(goal) => begin(goal.yaw_rad),
            _ => begin(now.yaw_rad),
        };
        self.steer(Steering::Path(path));
    }

    /// Steers through a place with a velocity, through the shaper. The heading goes on.
    pub fn go_through(&mut self, situation: &Situation, goal: &PositionReference) {
        let (yaw_rad, yaw_rate_rad_s) = match self.steering() {
            Steering::Goal(before) => (before.yaw_rad, before.yaw_rate_rad_s),
            Steering::Path(path) => (path.goal().yaw_rad, path.goal().yaw_rate_rad_s),
            _ => (situation.outputs.setpoint.yaw_rad, 0.0),
        };
        self.steer(Steering::Goal(PositionReference { yaw_rad, yaw_rate_rad_s, ..*goal }));
    }

    /// Turns on to a heading, rad, that changes at a rate, rad/s; without one it stays.
    pub fn turn_on(&mut self, heading: Option<(f64, f64)>) {
        // Steering is large: what is asked for again, tick by tick, does not copy it.
        if self.steering.turns_to(heading) {
            return;
        }
        match (self.steering.to_mut(), heading) {
            (Steering::Goal(goal), Some((heading_rad, rate_rad_s))) => {
                (goal.yaw_rad, goal.yaw_rate_rad_s) = (heading_rad, rate_rad_s);
            }
            (Steering::Goal(goal), None) => goal.yaw_rate_rad_s = 0.0,
            (Steering::Path(path), Some((yaw_rad, yaw_rate_rad_s))) => {
                path.turn_to(Heading { yaw_rate_rad_s, ..Heading::fixed(yaw_rad) });
            }
            (Steering::Path(path), None) => {
                path.turn_to(Heading { yaw_rate_rad_s: 0.0, ..path.goal() });
            }
            (Steering::Motion(motion), Some((heading_rad, rate_rad_s))) => {
                motion.turn_to(YawTarget::Follow(heading_rad, rate_rad_s));
            }
            (Steering::Motion(motion), None) => motion.turn_to(YawTarget::Hold),
            (Steering::Idle { .. } | Steering::Attitude { .. } | Steering::Descent { .. }, _) => {}
        }
    }

    /// Turns to the region of interest where nothing else asks for a heading.
    pub fn turn_to_region(&mut self, situation: &Situation) {
        if let Some(region) = self.region {
            self.turn_on(region.heading(&situation.outputs.setpoint, None));
        }
    }

    /// The same; but ArduPilot's guided mode has a choice of its own unless the nose is to look.
    pub fn choose_heading(&mut self, situation: &Situation, looks: bool) {
        let guided = situation.mode == Mode::Offboard && situation.identity.is_ardupilot();
        if !guided || looks && self.region.is_some() {
            self.turn_to_region(situation);
            return;
        }
        let heading = HeadingPolicy::of(situation).guided(situation);
        if heading.is_some() || self.steering.follows_heading() {
            self.turn_on(heading);
        }
    }

    /// The working copy of the region of interest.
    pub fn region(&self) -> Option<RegionOfInterest> {
        self.region
    }

    /// Looks at something else, or at nothing.
    pub fn look_at(&mut self, region: Option<RegionOfInterest>) {
        self.region = region;
    }

    /// The working copy of home.
    pub fn home(&self) -> &Home {
        &self.home
    }

    /// Moves home, NED, m, with a heading, rad, or the present one.
    ///
    /// # Errors
    /// [`Refusal`] too far away.
    pub fn set_home(
        &mut self,
        situation: &Situation,
        position_m: Vector3<f64>,
        yaw_rad: Option<f64>,
    ) -> Result<(), Refusal> {
        check_distance(&position_m)?;
        let yaw_rad = yaw_rad.unwrap_or(situation.outputs.attitude_rad.z);
        self.home = Cow::Owned(Home { position_m, yaw_rad, set_by_user: true });
        self.say(Severity::Info, "Home set");
        Ok(())
    }

    /// Moves home here, as arming does.
    pub fn move_home_here(&mut self, situation: &Situation) {
        let home = self.home.to_mut();
        home.position_m = situation.outputs.position_m;
        home.yaw_rad = situation.outputs.attitude_rad.z;
    }

    /// Tells the pilot.
    pub fn say(&mut self, severity: Severity, text: impl Into<String>) {
        self.requests.push(Request::Say(Notice { severity, text: text.into() }));
    }

    /// Asks for a mode.
    pub fn enter(&mut self, mode: Mode) {
        self.requests.push(Request::Enter(mode));
    }

    /// Asks for a mode that goes on with what is done already.
    pub fn go_on_in(&mut self, mode: Mode) {
        self.requests.push(Request::GoOnIn(mode));
    }

    /// Asks for other limits of speed.
    pub fn change_speeds(&mut self, change: SpeedChange) {
        self.requests.push(Request::ChangeSpeeds(change));
    }

    /// Tells the failsafe whether a cause is there.
    pub fn see(&mut self, cause: Cause, present: bool) {
        self.requests.push(Request::See(cause, present));
    }

    /// Asks something of the equipment.
    pub fn operate(&mut self, operation: Operation) {
        self.requests.push(Request::Operate(operation));
    }

    /// Asks that the fence is switched.
    pub fn switch_fence(&mut self, switch: FenceSwitch) {
        self.requests.push(Request::SwitchFence(switch));
    }

    /// Asks for what a switch of the pilot does, by ArduPilot's number, that comes to a position.
    pub fn move_switch(&mut self, number: u32, position: Position) {
        self.requests.push(Request::MoveSwitch(number, position));
    }

    /// Asks that the rotors stop and says why.
    pub fn stop_rotors(&mut self, why: impl Into<String>) {
        self.requests.push(Request::StopRotors(why.into()));
    }

    /// Flies to the landing of the mission, or without one home.
    pub fn join_landing(&mut self) {
        self.requests.push(Request::JoinLanding);
    }

    /// Asks that the flight ends at once.
    pub fn terminate(&mut self) {
        self.requests.push(Request::Terminate);
    }
}

/// Refuses what is too far away, or no number.
///
/// # Errors
/// [`Refusal::Denied`] with the distance.
pub fn check_distance(target_m: &Vector3<f64>) -> Result<(), Refusal> {
    let distance_m = target_m.norm();
    // NaN is not below.
    if distance_m <= FARTHEST_M {
        Ok(())
    } else {
        Err(Refusal::denied(format!("Target rejected: {distance_m:.0} m away; allowed {FARTHEST_M:.0} m")))
    }
}
