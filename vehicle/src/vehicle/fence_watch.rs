//! The vehicle within its fence: refusing what leads out of it, and seeing a breach before it happens.

use nalgebra::Vector3;
use quadrotor::Limits;

use super::failsafe::{FenceParts, FenceStart};
use super::fence_keeping::keeps_sticks_inside;
use super::motion::Motion;
use super::notice::Refusal;
use super::set_point::{AxisTarget, PositionSetPoint};
use super::situation::Situation;
use super::steering::{Steering, SteeringKind};
use crate::fence::{Breach, FenceSwitch};
use crate::mode::Mode;

/// An attitude that leads outside is left this late, s.
const REACTION_S: f64 = 0.5;
/// By so much more than its reference it may overshoot, m.
const MARGIN_M: f64 = 0.5;
/// How often the way to a stop is predicted, µs, and in which steps, s.
const PREDICTION_PERIOD_US: u64 = 20_000;
const STEP_S: f64 = 0.02;
/// Longest stop that is predicted, s.
const LONGEST_STOP_S: f64 = 120.0;
/// Slower than this, m/s, it stands.
const STANDING_M_S: f64 = 0.1;

/// What has become of the fence, for clients.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct FenceRecord {
    /// The breach of now, if there is one.
    pub now: Option<Breach>,
    /// Whether it still lies ahead: the vehicle is inside, and could not stop before it.
    pub is_ahead: bool,
    /// How many there were.
    pub count: u16,
    /// The latest, and when it began, µs.
    pub latest: Option<(Breach, u64)>,
}

/// Whether the fence has switched itself on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
enum ByItself {
    /// Not yet.
    #[default]
    Waits,
    /// Until the vehicle stands.
    On,
    /// Somebody has switched it off in this flight.
    Off,
}

/// Looks for breaches.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct FenceWatch {
    record: FenceRecord,
    by_itself: ByItself,
    /// Whether the vehicle has been above the floor, and does not come down to land.
    floor_counts: bool,
    /// Whether somebody has switched the floor off.
    floor_is_off: bool,
    /// Parts that somebody has switched off, by the bits of ArduPilot's parameter; until the fence as a whole is off.
    parts_off: u8,
}

impl FenceWatch {
    /// What has become of the fence.
    pub fn record(&self) -> &FenceRecord {
        &self.record
    }

    /// Whether the fence has switched itself on.
    pub fn is_on_by_itself(&self) -> bool {
        self.by_itself == ByItself::On
    }

    /// Whether the floor counts: the vehicle has been above it, and does not come down to land.
    pub fn floor_counts(&self) -> bool {
        self.floor_counts
    }

    /// Parts that somebody has switched off, by the bits of ArduPilot's parameter.
    pub fn parts_off(&self) -> u8 {
        self.parts_off
    }

    /// Somebody switches a fence that is on or not, and consists of these parts. Returns whether it is on after that.
    pub fn switch(&mut self, switch: FenceSwitch, is_on: bool, parts: FenceParts) -> bool {
        self.floor_is_off = match switch {
            FenceSwitch::FloorOff => true,
            FenceSwitch::PartsOff(_) => self.floor_is_off,
            FenceSwitch::PartsOn(bits) => self.floor_is_off && !FenceParts::from_bits(bits).floor,
            FenceSwitch::On | FenceSwitch::Off => false,
        };
        let on = match switch {
            FenceSwitch::Off => false,
            FenceSwitch::On => {
                self.parts_off = 0;
                true
            }
            FenceSwitch::FloorOff => is_on,
            FenceSwitch::PartsOn(bits) => {
                self.parts_off = if is_on { self.parts_off & !bits } else { !bits };
                parts.bits() & !self.parts_off != 0
            }
            FenceSwitch::PartsOff(bits) => {
                self.parts_off |= bits;
                is_on && parts.bits() & !self.parts_off != 0
            }
        };
        if !on {
            self.parts_off = 0;
            if self.is_on_by_itself() {
                self.by_itself = ByItself::Off;
            }
        }
        on
    }

    /// Switches the fence on or off by itself, and its floor: a vehicle that starts or lands is below that.
    fn start(&mut self, situation: &Situation) {
        let settings = &situation.conduct.failsafe;
        if !situation.fence_is_on {
            self.parts_off = 0;
        }
        let in_the_air = situation.armed && !situation.landed;
        let wanted = match settings.fence_starts {
            FenceStart::Never => false,
            FenceStart::Armed => situation.armed,
            FenceStart::Takeoff | FenceStart::TakeoffExceptFloor => {
                in_the_air && situation.mode != Mode::Takeoff
            }
        };
        self.by_itself = match self.by_itself {
            ByItself::Waits if wanted => ByItself::On,
            _ if !situation.armed => ByItself::Waits,
            now => now,
        };
        let lands = matches!(situation.mode, Mode::Land | Mode::Return | Mode::SmartReturn);
        self.floor_is_off &= situation.armed;
        self.floor_counts = in_the_air
            && !lands
            && !self.floor_is_off
            && (self.floor_counts
                || height_m(situation) > situation.fence_floor_m() + settings.fence_margin_m);
    }

    /// The floor, if the vehicle is below it.
    fn below_floor(&self, situation: &Situation) -> Option<Breach> {
        let looked_at = situation.fence_is_on && situation.fence_parts().floor && self.floor_counts;
        let floor_m = situation.fence_floor_m();
        (looked_at && height_m(situation) < floor_m).then_some(Breach::Floor(floor_m))
    }

    /// Looks whether the vehicle is, or cannot help coming, where it must not be. Returns a breach that was ahead and is crossed now.
    pub fn watch(&mut self, situation: &Situation) -> Option<Breach> {
        self.start(situation);
        let here = situation.breach_at(&situation.outputs.position_m).or_else(|| self.below_floor(situation));
        if here.is_none() && !situation.time_us.is_multiple_of(PREDICTION_PERIOD_US) {
            return None;
        }
        let was_ahead = self.record.is_ahead;
        // The way to a stop is costly to predict: only for a fence that has bounds.
        let bounded = situation.fence().is_some_and(|fence| fence.bounds());
        // Sticks that do not lead over it may lead along it.
        let predicts = bounded && situation.conduct.failsafe.fence_ahead && !keeps_sticks_inside(situation);
        let ahead = || if predicts { breach_ahead(situation, &situation.braking_limits()) } else { None };
        self.record.now = here.or_else(ahead);
        self.record.is_ahead = here.is_none() && self.record.now.is_some();
        here.filter(|_| was_ahead)
    }

    /// Counts the breach of now, which has begun.
    pub fn count(&mut self, time_us: u64) {
        let Some(breach) = self.record.now else { return };
        self.record.count = self.record.count.saturating_add(1);
        self.record.latest = Some((breach, time_us));
    }
}

/// Height above home, m.
fn height_m(situation: &Situation) -> f64 {
    situation.home.position_m.z - situation.outputs.position_m.z
}

/// What of the fence the vehicle cannot help breaching when it brakes within limits.
pub(super) fn breach_ahead(situation: &Situation, limits: &Limits) -> Option<Breach> {
    let mut stopping_m = stopping_place_m(situation, limits);
    if situation.conduct.failsafe.fence.plans_a_way() {
        // What is planned turns later.
        stopping_m += situation.outputs.velocity_m_s * situation.configuration.shaping_delay_s();
    }
    let Steering::Path(path) = situation.steering else { return situation.breach_to(&stopping_m) };
    // It stops on its way, around the next corner if need be.
    let mut from_m = situation.outputs.position_m;
    let mut left_m = (stopping_m - from_m).norm();
    path.places_m(situation.time_us).find_map(|place_m| {
        let way = place_m - from_m;
        let to_m = from_m + way.cap_magnitude(left_m);
        left_m -= (to_m - from_m).norm();
        let fence = situation.fence()?;
        let breach = fence.breach_on_way(&from_m, &to_m);
        from_m = to_m;
        breach
    })
}

/// Where the vehicle comes to rest, NED, m, if it brakes now, within limits: the reference moves as that of the hold mode. On its way to a
/// goal that is not beyond the goal, where the shaper stops.
pub(super) fn stopping_place_m(situation: &Situation, limits: &Limits) -> Vector3<f64> {
    let position_m = situation.outputs.position_m;
    let steering = situation.steering;
    if !situation.armed || steering.kind() == SteeringKind::Idle {
        return position_m;
    }
    let mut motion = steering.present(situation.outputs);
    if !matches!(steering, Steering::Motion(_) | Steering::Goal(_) | Steering::Path(_)) {
        motion.position_m += motion.velocity_m_s * REACTION_S;
    }
    let Some(ahead) = motion.velocity_m_s.try_normalize(STANDING_M_S) else { return position_m };
    let mut braking = Motion::from(motion, PositionSetPoint::HOLD, 0);
    for _ in 0..(LONGEST_STOP_S / STEP_S) as usize {
        braking.step(limits, STEP_S);
        motion = braking.reference(0);
        if motion.velocity_m_s.norm() < STANDING_M_S {
            break;
        }
    }
    match steering {
        Steering::Goal(goal) => {
            let left_m = (goal.position_m - position_m).norm();
            position_m + ahead * (motion.position_m - position_m).norm().min(left_m)
        }
        // A planned way ends where it is to.
        Steering::Path(_) => motion.position_m,
        _ => motion.position_m + ahead * MARGIN_M,
    }
}

/// Refuses a goal, NED, m, that the fence forbids, or the straight way to it.
///
/// # Errors
/// [`Refusal::Denied`] that says what of it.
pub fn check_goal(situation: &Situation, what: &str, goal_m: &Vector3<f64>) -> Result<(), Refusal> {
    match situation.breach_to(goal_m) {
        Some(breach) => Err(Refusal::denied(format!("{what} rejected: {breach}"))),
        None => Ok(()),
    }
}

/// Refuses a set-point whose place the fence forbids. Speeds are looked at in flight.
///
/// # Errors
/// [`Refusal::Denied`] that says what of it.
pub fn check_set_point(situation: &Situation, set_point: &PositionSetPoint) -> Result<(), Refusal> {
    let now = situation.outputs.position_m;
    let mut placed = false;
    let goal = Vector3::from_fn(|axis, _| match set_point.axes[axis] {
        AxisTarget::Position(position_m) | AxisTarget::Track { position_m, .. } => {
            placed = true;
            position_m
        }
        _ => now[axis],
    });
    if placed { check_goal(situation, "Set-point", &goal) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::{
        AxisTarget, Breach, FenceParts, FenceStart, FenceSwitch, FenceWatch, Mode, PositionSetPoint,
        check_goal, check_set_point,
    };
    use crate::identity::Identity;
    use crate::vehicle::failsafe::Action;
    use crate::vehicle::scene::Scene;
    use crate::vehicle::set_point::YawTarget;
    use crate::vehicle::sticks::Sticks;

    fn scene() -> Scene {
        let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]);
        scene.conduct.failsafe.fence_radius_m = 50.0;
        scene
    }

    #[test]
    fn a_breach_is_seen_before_it_happens_and_counted_when_told() {
        let mut scene = scene();
        let mut watch = FenceWatch::default();
        let mut at = |x: f64, speed_m_s: f64, ahead: bool| {
            scene.come_to([x, 0.0, -10.0], [speed_m_s, 0.0, 0.0]);
            scene.show(|situation, proposal| proposal.follow(situation, &PositionSetPoint::HOLD));
            scene.conduct.failsafe.fence_ahead = ahead;
            watch.watch(&scene.situation());
            watch.record().now
        };
        assert_eq!(at(40.0, 0.0, true), None);
        assert_eq!(at(40.0, 1.0, true), None, "it can stop");
        assert_eq!(at(48.0, 5.0, true), Some(Breach::Distance(50.0)));
        assert_eq!(at(48.0, 5.0, false), None, "not beyond it yet");
        assert_eq!(at(50.5, 0.0, false), Some(Breach::Distance(50.0)));
        assert_eq!(watch.record().count, 0);
        watch.count(7);
        assert_eq!((watch.record().count, watch.record().latest), (1, Some((Breach::Distance(50.0), 7))));
    }

    /// What is planned turns later, wherever it leads: its breach is seen sooner than that of a vehicle that brakes.
    #[test]
    fn a_way_that_is_planned_needs_more_room() {
        let mut scene = scene();
        scene.conduct.failsafe.fence_ahead = true;
        let mut first_m = |action: Action| {
            let sees = |x: &f64| {
                scene.come_to([*x, 0.0, -10.0], [5.0, 0.0, 0.0]);
                scene.show(|situation, proposal| proposal.follow(situation, &PositionSetPoint::HOLD));
                scene.conduct.failsafe.fence = action;
                let mut watch = FenceWatch::default();
                watch.watch(&scene.situation());
                watch.record().now.is_some()
            };
            (300..500).map(|tenths| 0.1 * f64::from(tenths)).find(sees).expect("it cannot stop")
        };
        let braked_m = first_m(Action::Hold);
        for action in
            [Action::Return, Action::TraceOrReturn, Action::TraceOrLand, Action::MissionLandingOrReturn]
        {
            assert!(first_m(action) < braked_m - 0.15, "{action:?}");
        }
        assert_eq!(first_m(Action::Land), braked_m);
    }

    /// Sticks are kept inside as they lead; a way to a place is predicted, and so is a flight without a pilot.
    #[test]
    fn only_where_sticks_lead_nothing_is_predicted() {
        let mut scene = scene();
        (scene.identity, scene.mode) = (Identity::ArduPilot, Mode::ZigZag);
        scene.conduct.failsafe.fence_ahead = true;
        let mut ahead = |sticks: Option<Sticks>, set_point: PositionSetPoint| {
            scene.come_to([48.0, 0.0, -10.0], [8.0, 0.0, 0.0]);
            scene.pilot.sticks = sticks;
            scene.show(|situation, proposal| proposal.follow(situation, &set_point));
            let mut watch = FenceWatch::default();
            watch.watch(&scene.situation());
            watch.record().now
        };
        let axes = [70.0, 0.0, -10.0].map(AxisTarget::Position);
        let across = PositionSetPoint { axes, yaw: YawTarget::Hold };
        let breach = Some(Breach::Distance(50.0));
        assert_eq!(ahead(Some(Sticks::default()), PositionSetPoint::HOLD), None);
        assert_eq!(ahead(Some(Sticks::default()), across), breach);
        assert_eq!(ahead(None, PositionSetPoint::HOLD), breach);
    }

    #[test]
    fn a_fence_that_is_switched_off_is_not_looked_at() {
        let mut scene = scene();
        scene.come_to([60.0, 0.0, -10.0], [0.0; 3]);
        scene.conduct.failsafe.fence_enabled = false;
        let mut watch = FenceWatch::default();
        watch.watch(&scene.situation());
        assert_eq!(watch.record().now, None);
        assert_eq!(check_goal(&scene.situation(), "Takeoff", &Vector3::new(80.0, 0.0, -10.0)), Ok(()));
    }

    /// A floor begins to count above it, and a landing may pass it.
    #[test]
    fn the_floor_counts_once_it_has_been_left_below() {
        let mut scene = scene();
        let settings = &mut scene.conduct.failsafe;
        (settings.fence_parts.floor, settings.fence_floor_m, settings.fence_ahead) = (true, 20.0, false);
        let mut watch = FenceWatch::default();
        let mut at = |height_m: f64, mode: Mode| {
            scene.come_to([0.0, 0.0, -height_m], [0.0; 3]);
            scene.mode = mode;
            watch.watch(&scene.situation());
            watch.record().now
        };
        assert_eq!(at(10.0, Mode::Position), None, "it climbs");
        assert_eq!(at(25.0, Mode::Position), None);
        assert_eq!(at(19.0, Mode::Position), Some(Breach::Floor(20.0)));
        assert_eq!(at(19.0, Mode::Return), None, "it lands");
        assert_eq!(at(10.0, Mode::Position), None, "it is below by right");
    }

    #[test]
    fn a_floor_that_is_switched_off_does_not_count_until_the_fence_is_switched_on() {
        let mut scene = scene();
        let settings = &mut scene.conduct.failsafe;
        (settings.fence_parts.floor, settings.fence_floor_m, settings.fence_ahead) = (true, 20.0, false);
        let mut watch = FenceWatch::default();
        let mut at = |height_m: f64, switch: Option<FenceSwitch>| {
            let parts = scene.conduct.failsafe.fence_parts;
            switch.into_iter().for_each(|switch| assert!(watch.switch(switch, true, parts)));
            scene.come_to([0.0, 0.0, -height_m], [0.0; 3]);
            watch.watch(&scene.situation());
            watch.record().now
        };
        assert_eq!((at(25.0, None), at(19.0, None)), (None, Some(Breach::Floor(20.0))));
        assert_eq!(at(19.0, Some(FenceSwitch::FloorOff)), None);
        assert_eq!((at(25.0, None), at(19.0, None)), (None, None));
        assert_eq!((at(25.0, Some(FenceSwitch::PartsOff(1))), at(19.0, None)), (None, None));
        assert_eq!((at(25.0, Some(FenceSwitch::On)), at(19.0, None)), (None, Some(Breach::Floor(20.0))));
    }

    /// ArduPilot's mask of parts: what is named is switched, the rest stays, and a fence without a part is off.
    #[test]
    fn parts_are_switched_one_by_one() {
        let parts = FenceParts::from_bits(7);
        let mut watch = FenceWatch::default();
        for (switch, was_on, is_on, off) in [
            (FenceSwitch::PartsOff(1), true, true, 1),
            (FenceSwitch::PartsOff(2), true, true, 3),
            (FenceSwitch::PartsOn(1), true, true, 2),
            (FenceSwitch::On, true, true, 0),
            (FenceSwitch::PartsOff(7), true, false, 0),
            (FenceSwitch::PartsOn(2), false, true, !2),
            (FenceSwitch::PartsOff(2), true, false, 0),
            (FenceSwitch::PartsOn(8), false, false, 0),
        ] {
            assert_eq!(watch.switch(switch, was_on, parts), is_on, "{switch:?}");
            assert_eq!(watch.parts_off(), off, "{switch:?}");
        }
    }

    #[test]
    fn a_fence_that_starts_with_arming_ends_with_it_and_can_be_switched_off() {
        let mut scene = Scene::on_the_ground();
        scene.conduct.failsafe.fence_starts = FenceStart::Armed;
        let mut watch = FenceWatch::default();
        let mut is_on = |armed: bool, switched_off: bool| {
            scene.armed = armed;
            if switched_off {
                assert!(!watch.switch(FenceSwitch::Off, true, scene.conduct.failsafe.fence_parts));
            }
            watch.watch(&scene.situation());
            watch.is_on_by_itself()
        };
        assert_eq!([is_on(false, false), is_on(true, false), is_on(true, true)], [false, true, false]);
        assert_eq!([is_on(true, false), is_on(false, false), is_on(true, false)], [false, false, true]);
    }

    #[test]
    fn goals_beyond_are_refused_and_speeds_are_not() {
        let scene = scene();
        let refusal = check_goal(&scene.situation(), "Takeoff", &Vector3::new(80.0, 0.0, -10.0)).unwrap_err();
        assert_eq!(refusal.to_string(), "Takeoff rejected: farther than 50 m from home");
        let set_point = |north| PositionSetPoint {
            axes: [north, AxisTarget::HOLD, AxisTarget::HOLD],
            yaw: YawTarget::Hold,
        };
        assert!(check_set_point(&scene.situation(), &set_point(AxisTarget::Position(80.0))).is_err());
        assert!(check_set_point(&scene.situation(), &set_point(AxisTarget::Velocity(80.0))).is_ok());
    }
}
