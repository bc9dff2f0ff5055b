//! Time-optimal motion of some axes from state to state under limits of speed, acceleration and jerk.
//!
//! The profiles are Ruckig's (Berscheid and Kröger 2021). This file keeps the result as plain data.

use rsruckig::prelude::{
    ControlInterface, DataArrayOrVec, InputParameter, Ruckig, Synchronization, ThrowErrorHandler, Trajectory,
};

use crate::guidance::motion_profile::{Motion, MotionProfile};

/// Limits of the motion along one axis, in SI units of the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisLimits {
    /// Largest speed.
    pub speed: f64,
    /// Largest acceleration.
    pub acceleration: f64,
    /// Largest jerk.
    pub jerk: f64,
}

impl MotionProfile {
    /// The fastest motion from a state to a position that is passed with a velocity; it goes on with that velocity. `None` if the
    /// solver finds none, as for limits that are not positive.
    pub fn fastest(from: &Motion, position: f64, velocity: f64, limits: &AxisLimits) -> Option<Self> {
        let [profile] = StateToState {
            interface: ControlInterface::Position,
            from: [*from],
            target_position: [position],
            target_velocity: [velocity],
            max_velocity: [limits.speed],
            min_velocity: [-limits.speed],
            max_acceleration: [limits.acceleration],
            max_jerk: [limits.jerk],
        }
        .solve()?;
        Some(profile)
    }
}

/// Ways, speeds and accelerations below this are what rounding leaves of rest, in SI units of the axis.
const ROUNDING: f64 = 1e-6;
/// Axes that the solver is compiled for: once, as it is large. Fewer are filled up with copies of the last one, which change nothing.
const SOLVED: usize = 3;
/// Shares of the limits of acceleration and jerk that are tried one after the other.
const SHARES: [f64; 5] = [1.0, 0.999, 0.99, 0.95, 0.9];

/// A state-to-state problem for `DOF` axes that arrive together.
#[derive(Clone, Copy)]
pub(crate) struct StateToState<const DOF: usize> {
    /// Whether they arrive at positions with velocities, or only at velocities.
    pub interface: ControlInterface,
    /// Where they start.
    pub from: [Motion; DOF],
    /// Where they arrive; ignored if they arrive only at velocities.
    pub target_position: [f64; DOF],
    /// How fast they arrive.
    pub target_velocity: [f64; DOF],
    /// Limits.
    pub max_velocity: [f64; DOF],
    /// Negative.
    pub min_velocity: [f64; DOF],
    pub max_acceleration: [f64; DOF],
    pub max_jerk: [f64; DOF],
}

impl<const DOF: usize> StateToState<DOF> {
    /// The fastest profiles that arrive together; `None` if the solver finds none, as for limits that are not positive.
    ///
    /// One in a thousand problems that begin with what rounding has left of an earlier plan is beyond the solver: 4·10⁻¹⁶ m/s beside a
    /// way of metres. Those begin at exact rest instead, then with limits that are a little lower, and at last axis by axis, which then
    /// arrive one after the other.
    pub fn solve(&self) -> Option<[MotionProfile; DOF]> {
        self.solve_exactly()
            .or_else(|| self.at_rest().solve_within_shares())
            .or_else(|| self.solve_one_by_one())
    }

    /// The same problem without what rounding has left of rest.
    fn at_rest(&self) -> Self {
        let exact = |value: f64| if value.abs() < ROUNDING { 0.0 } else { value };
        let mut problem = *self;
        for (from, target) in problem.from.iter_mut().zip(self.target_position) {
            from.velocity = exact(from.velocity);
            from.acceleration = exact(from.acceleration);
            if exact(target - from.position) == 0.0 {
                from.position = target;
            }
        }
        problem.target_velocity = self.target_velocity.map(exact);
        problem
    }

    fn solve_within_shares(&self) -> Option<[MotionProfile; DOF]> {
        SHARES.into_iter().find_map(|share| {
            let lower = |limits: [f64; DOF]| limits.map(|limit| share * limit);
            let max_acceleration = lower(self.max_acceleration);
            Self { max_acceleration, max_jerk: lower(self.max_jerk), ..*self }.solve_exactly()
        })
    }

    /// Each axis as fast as it can, whenever the others arrive.
    fn solve_one_by_one(&self) -> Option<[MotionProfile; DOF]> {
        let mut profiles = [MotionProfile::constant(Motion::at(0.0)); DOF];
        for (axis, profile) in profiles.iter_mut().enumerate() {
            let alone = StateToState {
                interface: self.interface,
                from: [self.from[axis]],
                target_position: [self.target_position[axis]],
                target_velocity: [self.target_velocity[axis]],
                max_velocity: [self.max_velocity[axis]],
                min_velocity: [self.min_velocity[axis]],
                max_acceleration: [self.max_acceleration[axis]],
                max_jerk: [self.max_jerk[axis]],
            };
            [*profile] = alone.solve_within_shares().or_else(|| alone.at_rest().solve_within_shares())?;
        }
        Some(profiles)
    }

    /// This problem as it is.
    fn solve_exactly(&self) -> Option<[MotionProfile; DOF]> {
        let mut input = InputParameter::<SOLVED>::new(None);
        input.synchronization = Synchronization::Time;
        input.control_interface = self.interface;
        input.current_position = filled(self.from.map(|motion| motion.position));
        input.current_velocity = filled(self.from.map(|motion| motion.velocity));
        input.current_acceleration = filled(self.from.map(|motion| motion.acceleration));
        input.target_position = filled(self.target_position);
        input.target_velocity = filled(self.target_velocity);
        input.max_velocity = filled(self.max_velocity);
        input.min_velocity = Some(filled(self.min_velocity));
        input.max_acceleration = filled(self.max_acceleration);
        input.max_jerk = filled(self.max_jerk);

        let mut trajectory = Trajectory::<SOLVED>::new(None);
        // The cycle time matters only for discrete durations, which are not asked for.
        let mut ruckig = Ruckig::<SOLVED, ThrowErrorHandler>::new(None, 0.01);
        ruckig.calculate(&input, &mut trajectory).ok()?;
        let profiles = trajectory.profiles.first()?;
        Some(core::array::from_fn(|axis| {
            let profile = &profiles[axis];
            let (mut start_s, mut pieces) = (0.0, None);
            let brake = &profile.brake;
            let parts = (0..2).map(|i| (brake.t[i], brake.p[i], brake.v[i], brake.a[i], brake.j[i])).chain(
                (0..7).map(|i| (profile.t[i], profile.p[i], profile.v[i], profile.a[i], profile.j[i])),
            );
            for (duration_s, position, velocity, acceleration, jerk) in parts {
                if duration_s > 0.0 {
                    add(&mut pieces, start_s, Motion { position, velocity, acceleration, jerk });
                    start_s += duration_s;
                }
            }
            // What rounding leaves of the speed that was asked for would go on for ever, and look like a reference that moves.
            let velocity = self.target_velocity[axis];
            let last = Motion { position: profile.p[7], velocity, acceleration: 0.0, jerk: 0.0 };
            add(&mut pieces, start_s, last);
            pieces.unwrap_or_else(|| MotionProfile::constant(last))
        }))
    }
}

fn add(pieces: &mut Option<MotionProfile>, start_s: f64, motion: Motion) {
    match pieces {
        Some(profile) => profile.push(start_s, motion),
        None => *pieces = Some(MotionProfile::constant(motion)),
    }
}

/// One to three values.
fn filled<const DOF: usize>(values: [f64; DOF]) -> DataArrayOrVec<f64, SOLVED> {
    const { assert!(0 < DOF && DOF <= SOLVED) };
    DataArrayOrVec::Stack(core::array::from_fn(|axis| values[axis.min(DOF - 1)]))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::AxisLimits;
    use crate::guidance::motion_profile::{Motion, MotionProfile};

    /// From rest to rest where neither speed nor acceleration is reached: four pieces of the full jerk, each ∛(d/2j) long.
    #[test]
    fn a_short_way_takes_four_pieces_of_full_jerk() {
        let limits = AxisLimits { speed: 100.0, acceleration: 100.0, jerk: 4.0 };
        for way in [3.0, -3.0] {
            let profile = MotionProfile::fastest(&Motion::at(1.0), 1.0 + way, 0.0, &limits).unwrap();
            let piece_s = libm::cbrt(3.0 / 8.0);
            assert!((profile.duration_s() - 4.0 * piece_s).abs() < 1e-9, "{}", profile.duration_s());
            assert!((profile.at(2.0 * piece_s).position - 1.0 - way / 2.0).abs() < 1e-9);
        }
    }

    proptest! {
        /// A plan starts as the motion is, continues without a jump, keeps its limits, ends where and as fast as asked, and goes on so.
        #[test]
        fn plans_lead_from_state_to_state_within_their_limits(
            p in -20.0..20.0, v in -1.0..1.0, to in -20.0..20.0, passing in -1.0..1.0,
            speed in 1.5..6.0, acceleration in 0.5..4.0, jerk in 0.5..8.0,
        ) {
            let from = Motion { velocity: v, ..Motion::at(p) };
            let limits = AxisLimits { speed, acceleration, jerk };
            let profile = MotionProfile::fastest(&from, to, passing, &limits).unwrap();
            let end_s = profile.duration_s();
            prop_assert_eq!((profile.at(0.0).position, profile.at(0.0).velocity), (p, v));
            let later = profile.at(end_s + 2.0);
            prop_assert!((profile.end().position - to).abs() < 1e-6 && (later.position - to - 2.0 * passing).abs() < 1e-6);
            // To the bit: a goal at rest is reached for good.
            prop_assert_eq!((later.velocity, later.acceleration), (passing, 0.0));
            let interval_s = end_s / 2000.0;
            for step in 0..2000 {
                let (now, next) = (profile.at(f64::from(step) * interval_s), profile.at(f64::from(step + 1) * interval_s));
                prop_assert!(now.velocity.abs() < speed + 1e-8 && now.acceleration.abs() < acceleration + 1e-8);
                prop_assert!((next.acceleration - now.acceleration).abs() < jerk * interval_s + 1e-8);
                prop_assert!((next.position - now.position).abs() < (speed + 1e-6) * interval_s + 1e-8);
            }
        }
    }

    #[test]
    fn limits_that_are_not_positive_have_no_plan() {
        let limits = AxisLimits { speed: 1.0, acceleration: 0.0, jerk: 1.0 };
        assert_eq!(MotionProfile::fastest(&Motion::at(0.0), 1.0, 0.0, &limits), None);
    }
}
