//! The way back along the trail: ArduPilot's SMART_RTL. The trail is flown as a mission would be.

use nalgebra::Vector3;

use super::descent::descend;
use super::heading_policy::{HeadingPolicy, Purpose};
use super::mission::{Course, Jumps, Route, TaskProgress};
use super::notice::{Refusal, Severity};
use super::proposal::Proposal;
use super::set_point::{AxisTarget, PositionSetPoint, YawTarget};
use super::situation::Situation;
use super::steering::SteeringKind;
use super::trail::Trail;
use crate::plan::step::{Navigate, Step, Waypoint};
use crate::plan::{Altitude, Place, Program, ProgramStep};

/// The trail ends so high above its first place, m.
const ABOVE_START_M: f64 = 2.0;
/// Legs that are begun within one tick.
const LEGS_PER_TICK: usize = 4;

/// The trail, and the way back on it.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct SmartReturn {
    trail: Trail,
    /// The trail from its end to its beginning.
    program: Program,
    current: usize,
    jumps: Jumps,
    course: Course,
    phase: Phase,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
enum Phase {
    /// Back along the trail.
    #[default]
    Back,
    /// Down to where it stays.
    Stay,
    /// Down.
    Descend,
}

impl SmartReturn {
    /// The vehicle is armed: the trail begins.
    pub fn arm(&mut self, situation: &Situation) {
        self.trail.begin(situation.outputs.position_m, situation.time_us);
    }

    /// Leaves the place of now behind, in every mode but its own.
    pub fn watch(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let settings = &situation.conduct.trail;
        if !situation.knows_its_place() {
            if self.trail.starve(situation.time_us) {
                proposal.say(Severity::Critical, "SmartRTL deactivated: bad position");
            }
        } else if self.trail.leave(situation.outputs.position_m, settings, situation.time_us) {
            proposal.say(Severity::Critical, "SmartRTL deactivated: buffer full");
        }
    }

    /// Whether there is a trail.
    pub fn has_trail(&self) -> bool {
        self.trail.is_active()
    }

    /// Whether there is a way back.
    ///
    /// # Errors
    /// [`Refusal::Failed`] without a trail.
    pub fn may_begin(&self) -> Result<(), Refusal> {
        if self.has_trail() {
            return Ok(());
        }
        Err(Refusal::Failed("Smart RTL mode rejected: no recorded path; use RTL".to_owned()))
    }

    /// Begins the way back.
    pub fn begin(&mut self, situation: &Situation, proposal: &mut Proposal) {
        self.trail.clean(&situation.conduct.trail);
        let places_m: Vec<Vector3<f64>> = self.trail.places_m().iter().rev().copied().collect();
        self.program = back_along(&places_m);
        (self.current, self.phase, self.jumps) = (0, Phase::Back, Jumps::default());
        self.course.give_up(None);
        self.course.take_over(situation, proposal);
    }

    /// Whether it descends to the ground.
    pub fn descends(&self) -> bool {
        self.phase == Phase::Descend
    }

    /// One tick of the mode.
    pub fn step(&mut self, situation: &Situation, proposal: &mut Proposal) {
        if proposal.steering().kind() == SteeringKind::Idle {
            return;
        }
        match self.phase {
            Phase::Back => self.fly(situation, proposal),
            Phase::Stay => {}
            Phase::Descend => {
                let place_m = self.trail.places_m().first().map(|place_m| [place_m.x, place_m.y]);
                descend(situation, proposal, place_m);
            }
        }
    }

    fn fly(&mut self, situation: &Situation, proposal: &mut Proposal) {
        if proposal.steering().kind() == SteeringKind::Attitude {
            proposal.follow(situation, &PositionSetPoint::HOLD);
        }
        for _ in 0..LEGS_PER_TICK {
            let Some(leg) = self.program.navigate(self.current) else {
                self.arrive(situation, proposal);
                return;
            };
            let route = Route::new(&self.program, self.current, &self.jumps, situation, proposal);
            match self.course.step(&leg, &route, situation, proposal) {
                TaskProgress::Going | TaskProgress::Staying => break,
                TaskProgress::Again => {}
                TaskProgress::Done(turn) => {
                    self.course.give_up(turn);
                    self.current += 1;
                    self.trail.cut((self.program.len() - self.current).max(1));
                }
            }
        }
        let purpose = Purpose::Return;
        let policy = HeadingPolicy::of(situation);
        if let Some(heading_rad) = policy.heading_rad(purpose, self.course.heading_rad(), situation) {
            proposal.turn_on(Some((heading_rad, 0.0)));
        }
    }

    /// Above its start it lands, or goes down to where it is to stay.
    fn arrive(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let final_m = situation.conduct.return_home.final_height_m;
        if final_m <= 0.0 {
            self.phase = Phase::Descend;
            proposal.say(Severity::Info, "Above the start: landing");
            return;
        }
        self.phase = Phase::Stay;
        let z_m = situation.home.position_m.z - final_m;
        let axes = [AxisTarget::HOLD, AxisTarget::HOLD, AxisTarget::Position(z_m)];
        proposal.follow(situation, &PositionSetPoint { axes, yaw: YawTarget::Hold });
    }
}

/// Places, NED, m, as a mission; the last one is flown above.
fn back_along(places_m: &[Vector3<f64>]) -> Program {
    let last = places_m.len().saturating_sub(1);
    let step = |(index, place_m): (usize, &Vector3<f64>)| {
        let is_last = index == last;
        let z_m = if is_last { place_m.z - ABOVE_START_M } else { place_m.z };
        let place = Place { horizontal_m: Some([place_m.x, place_m.y]), altitude: Some(Altitude::Down(z_m)) };
        let waypoint = Waypoint { place, hold_s: 0.0, acceptance_radius_m: None, heading_rad: None };
        ProgramStep { step: Step::Navigate(Navigate::Waypoint(waypoint)), continues: !is_last }
    };
    Program::new(places_m.iter().enumerate().map(step).collect(), 0)
}
