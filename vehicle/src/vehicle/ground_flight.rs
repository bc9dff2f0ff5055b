//! The flight to a place that is given above the ground, by a set-point or a command: it follows the ground on the way there.
//!
//! ```text
//!  go ─┬─ straight on, if that is as good ──────────────► the shaper's
//!      ├─ ease ─┬► piece by piece along the ground ─┬──► the shaper's, at the goal
//!      ├─ brake ┤   ▲            another goal       │
//!      └─ climb ┘   └── at rest ◄── stop on the way ┘    if it cannot go on to that one
//! ```

use nalgebra::Vector3;

use super::ground_way::GroundWay;
use super::proposal::Proposal;
use super::set_point::{AxisTarget, PositionSetPoint, YawTarget};
use super::situation::Situation;
use super::spline::{Bend, Onward, Spline};
use super::steering::{Steering, SteeringKind};
use super::tick::TICK_S;

/// A goal that moves by less than this, m, stays as it is.
const SMALL_M: f64 = 0.01;
/// Where a straight way is nowhere farther than this, m, above or below one along the ground, it is flown straight.
const AS_GOOD_M: f64 = 0.2;
/// At rest the reference is slower than this, m/s, and accelerates by less, m/s².
const RESTS: f64 = 1e-3;
/// Cosine of the largest turn from one way to another without a stop.
const LARGEST_TURN: f64 = 0.5;

/// The flight, if there is one.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct GroundFlight {
    flight: Option<Flight>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(clippy::large_enum_variant)] // There is one of it.
enum Phase {
    /// Straight up from the ground, to the height above it that is asked for.
    Climb,
    /// To an even speed, at which the way may begin.
    Ease,
    /// To rest, from which it always can.
    Brake,
    /// Along a piece of a way.
    Fly(GroundWay, Spline),
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Flight {
    /// Where to, NED, m.
    goal_m: Vector3<f64>,
    phase: Phase,
    /// What it has steered to last.
    axes: [AxisTarget; 3],
}

impl GroundFlight {
    /// Goes to a place along the ground, or goes on if it does so already. What is no place is steered to as it is.
    pub fn go(&mut self, set_point: &PositionSetPoint, situation: &Situation, proposal: &mut Proposal) {
        let goal_m = set_point.place();
        let led_to_m = self.goal_m(proposal.steering());
        let is_same =
            |place_m: Vector3<f64>| goal_m.is_some_and(|goal_m| (goal_m - place_m).norm() <= SMALL_M);
        if led_to_m.is_some_and(is_same) {
            turn(set_point.yaw, proposal);
            return;
        }
        let now = proposal.steering().present(situation.outputs);
        let is_led_straight =
            led_to_m.is_none() && proposal.steering().resting_place_m().is_some_and(is_same);
        let way = goal_m.map(|goal_m| GroundWay::new(now.position_m, goal_m));
        let way = way.filter(|way| !is_led_straight && !is_as_good_straight(way, situation));
        let (Some(way), Some(goal_m)) = (way, goal_m) else {
            self.flight = None;
            proposal.follow(situation, set_point);
            return;
        };
        if let Some(flight) = self.flight.as_mut().filter(|_| led_to_m.is_some()) {
            flight.goal_m = goal_m;
            turn(set_point.yaw, proposal);
            return;
        }
        let yaw = match (set_point.yaw, proposal.steering()) {
            // An unfinished turn goes on.
            (YawTarget::Hold, Steering::Goal(goal)) => YawTarget::Angle(goal.yaw_rad),
            (yaw, _) => yaw,
        };
        let (phase, axes) = if proposal.steering().kind() == SteeringKind::Idle {
            let above_m = situation.terrain.z_below_m(&goal_m) - goal_m.z;
            let z_m = situation.terrain.z_below_m(&now.position_m) - above_m;
            (Phase::Climb, [now.position_m.x, now.position_m.y, z_m].map(AxisTarget::Position))
        } else if leads_along(&now.velocity_m_s, &way) {
            (Phase::Ease, now.velocity_m_s.data.0[0].map(AxisTarget::Velocity))
        } else {
            (Phase::Brake, PositionSetPoint::HOLD.axes)
        };
        proposal.follow(situation, &PositionSetPoint { axes, yaw });
        self.flight = Some(Flight { goal_m, phase, axes });
    }

    /// The same after the mode has begun anew: that has not interrupted the flight before it.
    pub fn go_on(
        &mut self,
        (steering, flight): (Steering, Self),
        set_point: &PositionSetPoint,
        situation: &Situation,
        proposal: &mut Proposal,
    ) {
        *self = flight;
        proposal.steer(steering);
        self.go(set_point, situation, proposal);
    }

    /// Forgets it: something else is asked for.
    pub fn forget(&mut self) {
        self.flight = None;
    }

    /// Where it leads, NED, m, if the steering is its own.
    pub fn goal_m(&self, steering: &Steering) -> Option<Vector3<f64>> {
        let flight = self.flight.as_ref()?;
        steering.asked().filter(|asked| asked.axes == flight.axes).map(|_| flight.goal_m)
    }

    /// Ends it. Returns where it was to lead, if the steering is its own.
    pub fn interrupt(&mut self, steering: &Steering) -> Option<PositionSetPoint> {
        let goal_m = self.goal_m(steering);
        self.flight = None;
        let axes = goal_m?.data.0[0].map(AxisTarget::Position);
        Some(PositionSetPoint { axes, yaw: YawTarget::Hold })
    }

    /// One tick.
    pub fn step(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let is_own = self.goal_m(proposal.steering()).is_some();
        let Some(mut flight) = self.flight.take().filter(|_| is_own) else { return };
        let Some(axes) = flight.advance(situation) else {
            // The last of the way, and short ways, are the shaper's.
            let axes = flight.goal_m.data.0[0].map(AxisTarget::Position);
            let yaw = match own_yaw(proposal) {
                YawTarget::Follow(angle_rad, _) => YawTarget::Angle(angle_rad),
                yaw => yaw,
            };
            proposal.follow(situation, &PositionSetPoint { axes, yaw });
            return;
        };
        flight.axes = axes;
        proposal.follow(situation, &PositionSetPoint { axes, yaw: own_yaw(proposal) });
        self.flight = Some(flight);
    }
}

impl Flight {
    /// Moves on by a tick. `None`: what is left of it is to be flown straight.
    fn advance(&mut self, situation: &Situation) -> Option<[AxisTarget; 3]> {
        let now = &situation.outputs.setpoint;
        let mut from_m = now.position_m;
        let is_climbed = || {
            let climbs_to = PositionSetPoint { axes: self.axes, yaw: YawTarget::Hold }.place();
            climbs_to.is_none_or(|place_m| (place_m - now.position_m).norm() <= SMALL_M)
        };
        if self.phase == Phase::Climb && !is_climbed() {
            return Some(self.axes);
        }
        if let Phase::Ease = self.phase {
            let Some(onward) = Onward::of(now, situation.time_us) else { return Some(self.axes) };
            let way = GroundWay::new(from_m, self.goal_m);
            self.phase = match piece_onward(&way, onward, situation) {
                Some(spline) => Phase::Fly(way, spline),
                None => Phase::Brake,
            };
        }
        if let Phase::Fly(way, spline) = &mut self.phase {
            if let Some(set_point) = spline.step(TICK_S) {
                return Some(set_point.axes);
            }
            let way = *way;
            if let Some(onward) = spline.onward(situation.time_us) {
                let (way, mut spline) = self.piece_after(way, onward, situation)?;
                let set_point = spline.step(TICK_S);
                self.phase = Phase::Fly(way, spline);
                return set_point.map(|set_point| set_point.axes);
            }
            from_m = spline.end_m();
        } else if now.velocity_m_s.norm() > RESTS || now.acceleration_m_s2.norm() > RESTS {
            return Some(PositionSetPoint::HOLD.axes);
        }
        let way = GroundWay::new(from_m, self.goal_m);
        if is_as_good_straight(&way, situation) {
            return None;
        }
        let mut spline = way.piece(from_m, None, situation)?;
        let set_point = spline.step(TICK_S)?;
        self.phase = Phase::Fly(way, spline);
        Some(set_point.axes)
    }

    /// The piece behind one that has been flown: on the same way, on one to another goal, or on the same way to an early stop.
    fn piece_after(
        &self,
        way: GroundWay,
        onward: Onward,
        situation: &Situation,
    ) -> Option<(GroundWay, Spline)> {
        let here_m = onward.position_m;
        if (way.end_m() - self.goal_m).norm() <= SMALL_M {
            return Some((way, way.piece(here_m, Some(onward), situation)?));
        }
        let other = GroundWay::new(here_m, self.goal_m);
        if let Some(spline) = piece_onward(&other, onward, situation) {
            return Some((other, spline));
        }
        let places_m = way.places_ahead_m(&here_m, situation);
        let stop = |count: usize| {
            let places_m = places_m.get(..count)?;
            Spline::new(here_m, Some(onward), places_m, Bend::Close, situation.limits())
        };
        let early = (1..places_m.len()).filter_map(stop).find(Spline::can_be_kept);
        Some((way, early.or_else(|| stop(places_m.len()))?))
    }
}

/// The first piece of a way, if a motion can go on with it.
fn piece_onward(way: &GroundWay, onward: Onward, situation: &Situation) -> Option<Spline> {
    let piece = || way.piece(onward.position_m, Some(onward), situation);
    leads_along(&onward.direction(), way).then(piece).flatten().filter(Spline::can_be_kept)
}

/// Whether a motion leads about where a way does.
fn leads_along(velocity: &Vector3<f64>, way: &GroundWay) -> bool {
    let [from_m, to_m] = way.ends_m();
    let [moves, leads] = [*velocity, to_m - from_m].map(|vector| vector.xy().try_normalize(SMALL_M));
    moves.zip(leads).is_some_and(|(moves, leads)| moves.dot(&leads) > LARGEST_TURN)
}

/// Whether a way is as good flown straight.
fn is_as_good_straight(way: &GroundWay, situation: &Situation) -> bool {
    let [from_m, to_m] = way.ends_m();
    let length_m = (to_m - from_m).xy().norm();
    if situation.terrain.is_flat() || length_m <= SMALL_M {
        return true;
    }
    way.sketch_m(situation.terrain).all(|place_m| {
        let share = (place_m - from_m).xy().norm() / length_m;
        (from_m.z + (to_m.z - from_m.z) * share - place_m.z).abs() <= AS_GOOD_M
    })
}

/// Turns as it is asked to, if it is.
fn turn(yaw: YawTarget, proposal: &mut Proposal) {
    match (*proposal.steering(), yaw) {
        (_, YawTarget::Hold) => {}
        (Steering::Motion(mut motion), _) if motion.set_point().yaw != yaw => {
            motion.turn_to(yaw);
            proposal.steer(Steering::Motion(motion));
        }
        (Steering::Goal(goal), YawTarget::Angle(yaw_rad)) if goal.yaw_rad != yaw_rad => {
            proposal.turn_on(Some((yaw_rad, 0.0)));
        }
        _ => {}
    }
}

/// The heading that the steering asks for already.
fn own_yaw(proposal: &Proposal) -> YawTarget {
    proposal.steering().asked().map_or(YawTarget::Hold, |asked| asked.yaw)
}
