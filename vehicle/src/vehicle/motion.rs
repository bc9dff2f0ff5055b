//! A reference that moves as its axes are asked to: velocities, accelerations and positions axis by axis, within
//! the limits of speed, acceleration and jerk.
//!
//! Places alone go through the shaper of the closed loop, which plans ahead. This generator has no plan; it can be
//! told something else on each axis at any time.

use libm::{cbrt, copysign, sqrt};
use nalgebra::{Vector2, Vector3};
use quadrotor::{Limits, PositionReference};

use super::set_point::{AxisTarget, PositionSetPoint, YawTarget};
use super::tick::TICK_S;

/// Speed per velocity error at which the acceleration closes a small one, 1/s.
const VELOCITY_RATE: f64 = 6.0;
/// Speed per position error at which a small one is closed, 1/s.
const POSITION_RATE: f64 = 0.8;
/// Share of the acceleration limit that braking before a position counts on; the jerk limit takes the rest.
const BRAKING_SHARE: f64 = 0.3;
/// By how much a velocity may be behind while it brakes, m/s: with deceleration a and jerk j it is a²/(2 j) behind.
const LATE_M_S: f64 = 0.1;
/// Jerk that closes a position error of this size, m, with a rate r is r³ times it.
const JERK_PER_RATE: f64 = 2.0;
/// An error below this, m or rad, counts as none once it rests.
const ARRIVED: f64 = 1e-6;

/// With less than this missing of a velocity, m/s, and less acceleration, m/s², it counts as reached.
const REACHED_M_S: f64 = 1e-6;
const REACHED_M_S2: f64 = 1e-5;

/// A difference of speed that does not matter, m/s, and one of the yaw rate, rad/s.
const SMALL_M_S: f64 = 0.05;
const SMALL_RAD_S: f64 = 0.02;
/// An acceleration that counts as none, m/s².
const SMALL_M_S2: f64 = 0.1;

/// The moving reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    state: PositionReference,
    set_point: PositionSetPoint,
    /// Since when the set-point holds, µs: its trajectory runs on from there.
    since_us: u64,
}

impl Motion {
    /// Takes a motion over, up to its acceleration.
    pub fn from(state: PositionReference, set_point: PositionSetPoint, time_us: u64) -> Self {
        let state = PositionReference {
            velocity_m_s: state.velocity_m_s,
            acceleration_m_s2: state.acceleration_m_s2,
            yaw_rate_rad_s: state.yaw_rate_rad_s,
            ..at_rest(state.position_m, state.yaw_rad)
        };
        Self { state, set_point, since_us: time_us }
    }

    /// Asks for something else.
    pub fn ask(&mut self, set_point: PositionSetPoint, time_us: u64) {
        (self.set_point, self.since_us) = (set_point, time_us);
    }

    /// What it is asked for.
    pub fn set_point(&self) -> PositionSetPoint {
        self.set_point
    }

    /// Whether it is asked to rise above z, m.
    pub fn leads_up(&self, z_m: f64) -> bool {
        self.set_point.leads_up(z_m)
    }

    /// Goes on elsewhere, m north and east: what is known of the place has changed, not the place.
    pub fn slide(&mut self, slid_m: &Vector2<f64>) {
        self.state.position_m.x += slid_m.x;
        self.state.position_m.y += slid_m.y;
    }

    /// Asks for another heading on the same way.
    pub fn turn_to(&mut self, yaw: YawTarget) {
        self.set_point.yaw = yaw;
    }

    /// The reference at `time_us`: points of trajectories run on, the rest is where [`Motion::step`] has brought it.
    pub fn reference(&mut self, time_us: u64) -> PositionReference {
        let t = time_us.saturating_sub(self.since_us) as f64 / 1e6;
        for (axis, target) in self.set_point.axes.iter().enumerate() {
            let AxisTarget::Track { position_m: p, velocity_m_s: v, acceleration_m_s2: a, jerk_m_s3: j } =
                *target
            else {
                continue;
            };
            self.state.position_m[axis] = p + (v + (a / 2.0 + j / 6.0 * t) * t) * t;
            self.state.velocity_m_s[axis] = v + (a + j / 2.0 * t) * t;
            self.state.acceleration_m_s2[axis] = a + j * t;
            self.state.jerk_m_s3[axis] = j;
        }
        if let YawTarget::Track(yaw_rad, rate_rad_s) = self.set_point.yaw {
            self.state.yaw_rad = yaw_rad + rate_rad_s * t;
            self.state.yaw_rate_rad_s = rate_rad_s;
        }
        self.state
    }

    /// Moves on by `dt_s`.
    pub fn step(&mut self, limits: &Limits, dt_s: f64) {
        let before_m_s2 = self.state.acceleration_m_s2;
        self.accelerate_horizontally(limits, dt_s);
        self.accelerate_vertically(limits, dt_s);
        // Told, it need not be found from a few accelerations, which change it at once where they reach what is wanted.
        self.state.jerk_m_s3 = (self.state.acceleration_m_s2 - before_m_s2) / dt_s;
        for axis in 0..3 {
            if matches!(self.set_point.axes[axis], AxisTarget::Track { .. }) {
                continue;
            }
            let (v, a) = (self.state.velocity_m_s[axis], self.state.acceleration_m_s2[axis]);
            self.state.position_m[axis] += (v + a / 2.0 * dt_s) * dt_s;
            self.state.velocity_m_s[axis] += a * dt_s;
            match self.set_point.axes[axis] {
                AxisTarget::Position(goal) => self.settle(axis, goal),
                AxisTarget::Velocity(wanted) => self.keep(axis, wanted),
                AxisTarget::Acceleration(_) | AxisTarget::Track { .. } => {}
            }
        }
        self.turn(limits, dt_s);
    }

    /// Whether it stays where it is until it is asked for something else.
    pub fn rests(&self, limits: &Limits) -> bool {
        let runs = |target: &AxisTarget| matches!(target, AxisTarget::Track { .. });
        let turns = matches!(self.set_point.yaw, YawTarget::Track(..));
        if turns || self.set_point.axes.iter().any(runs) {
            return false;
        }
        let mut later = *self;
        later.step(limits, TICK_S);
        later == *self
    }

    /// Whether it can go on within lower limits and neither run past a place nor past a velocity that it is asked for. What is
    /// under way ends within the limits that it began with.
    pub fn fits(&self, limits: &Limits) -> bool {
        self.fits_horizontally(limits) && self.fits_vertically(limits) && self.turn_fits(limits)
    }

    fn fits_horizontally(&self, limits: &Limits) -> bool {
        let speed = limits.speed_horizontal_m_s;
        let strongest = limits.acceleration_horizontal_m_s2;
        let velocity = self.state.velocity_m_s.xy();
        let wanted = Vector2::from_fn(|axis, _| {
            self.wanted_m_s(axis, (speed, speed), (strongest, limits.jerk_horizontal_m_s3))
                .unwrap_or(velocity[axis])
        });
        let missing = wanted.cap_magnitude(speed) - velocity;
        let acceleration = self.state.acceleration_m_s2.xy();
        let stopping = (0..2).any(|axis| self.set_point.axes[axis] == AxisTarget::HOLD)
            && acceleration.norm() > SMALL_M_S2
            && velocity.norm() > SMALL_M_S;
        let towards = acceleration.try_normalize(0.0).map_or(0.0, |direction| missing.dot(&direction));
        !stopping
            && acceleration_fits(acceleration.norm(), towards, strongest, limits.jerk_horizontal_m_s3)
            && (0..2).all(|axis| self.can_brake(axis, wanted[axis]))
    }

    fn fits_vertically(&self, limits: &Limits) -> bool {
        const DOWN: usize = 2;
        let (fastest, strongest) =
            ((limits.speed_up_m_s, limits.speed_down_m_s), limits.acceleration_vertical_m_s2);
        let velocity = self.state.velocity_m_s[DOWN];
        let wanted =
            self.wanted_m_s(DOWN, fastest, (strongest, limits.jerk_vertical_m_s3)).unwrap_or(velocity);
        let acceleration = self.state.acceleration_m_s2[DOWN];
        let missing = wanted.clamp(-fastest.0, fastest.1) - velocity;
        let towards = missing * acceleration.signum();
        acceleration_fits(acceleration.abs(), towards, strongest, limits.jerk_vertical_m_s3)
            && self.can_brake(DOWN, wanted)
    }

    /// Whether an axis is no faster on its way to a place than it would come to it, m/s.
    fn can_brake(&self, axis: usize, wanted_m_s: f64) -> bool {
        let velocity = self.state.velocity_m_s[axis];
        let to_a_place = matches!(self.set_point.axes[axis], AxisTarget::Position(_));
        !to_a_place || velocity.abs() <= wanted_m_s.abs() + SMALL_M_S && velocity * wanted_m_s >= -SMALL_M_S
    }

    fn turn_fits(&self, limits: &Limits) -> bool {
        let rate = self.state.yaw_rate_rad_s;
        let left = |angle: f64| wrapped(angle - self.state.yaw_rad);
        let coming = |angle: f64| {
            approach(left(angle), POSITION_RATE, BRAKING_SHARE * limits.yaw_acceleration_rad_s2).abs()
        };
        match self.set_point.yaw {
            YawTarget::Track(..) => true,
            YawTarget::Hold => rate.abs() <= SMALL_RAD_S,
            YawTarget::Rate(wanted) => (rate - wanted).abs() <= SMALL_RAD_S,
            YawTarget::Angle(angle) => rate.abs() <= coming(angle) + SMALL_RAD_S,
            YawTarget::Follow(angle, wanted) => (rate - wanted).abs() <= coming(angle) + SMALL_RAD_S,
        }
    }

    fn settle(&mut self, axis: usize, goal: f64) {
        let rests = self.state.velocity_m_s[axis].abs() < 1e-4;
        if rests && (goal - self.state.position_m[axis]).abs() < ARRIVED {
            self.state.position_m[axis] = goal;
            self.state.velocity_m_s[axis] = 0.0;
            self.state.acceleration_m_s2[axis] = 0.0;
            self.state.jerk_m_s3[axis] = 0.0;
        }
    }

    /// A velocity that is as good as reached is kept exactly, so that what has stopped rests.
    fn keep(&mut self, axis: usize, wanted: f64) {
        let is_near = (wanted - self.state.velocity_m_s[axis]).abs() < REACHED_M_S;
        if is_near && self.state.acceleration_m_s2[axis].abs() < REACHED_M_S2 {
            self.state.velocity_m_s[axis] = wanted;
            self.state.acceleration_m_s2[axis] = 0.0;
            self.state.jerk_m_s3[axis] = 0.0;
        }
    }

    /// Velocity that an axis wants, m/s, one that is given as it is; `None` if its acceleration is given or it follows a trajectory.
    fn wanted_m_s(&self, axis: usize, fastest: (f64, f64), (acceleration, jerk): (f64, f64)) -> Option<f64> {
        Some(match self.set_point.axes[axis] {
            AxisTarget::Position(goal) => {
                let deceleration = (BRAKING_SHARE * acceleration).min(sqrt(2.0 * jerk * LATE_M_S));
                let rate = POSITION_RATE.min(cbrt(jerk / JERK_PER_RATE));
                approach(goal - self.state.position_m[axis], rate, deceleration).clamp(-fastest.0, fastest.1)
            }
            AxisTarget::Velocity(velocity) => velocity,
            AxisTarget::Acceleration(_) | AxisTarget::Track { .. } => return None,
        })
    }

    fn accelerate_horizontally(&mut self, limits: &Limits, dt_s: f64) {
        let fastest = limits.speed_horizontal_m_s;
        let strongest = limits.acceleration_horizontal_m_s2;
        let wanted: [Option<f64>; 2] = core::array::from_fn(|axis| {
            self.wanted_m_s(axis, (fastest, fastest), (strongest, limits.jerk_horizontal_m_s3))
        });
        let velocity = self.state.velocity_m_s.xy();
        // The limits are those of the vehicle in its plane, not of an axis: it goes slower, not elsewhere.
        let target =
            Vector2::from_fn(|axis, _| wanted[axis].unwrap_or(velocity[axis])).cap_magnitude(fastest);
        let missing = Vector2::from_fn(|axis, _| wanted[axis].map_or(0.0, |_| target[axis] - velocity[axis]));
        let size = missing.norm();
        let jerk = limits.jerk_horizontal_m_s3;
        let goal = if size > 0.0 { missing * (closing(size, strongest, jerk) / size) } else { missing };
        let now = self.state.acceleration_m_s2.xy();
        let change = (goal - now).cap_magnitude(jerk * dt_s);
        for axis in 0..2 {
            if wanted[axis].is_some() {
                self.state.acceleration_m_s2[axis] += change[axis];
            } else {
                self.push(axis, (fastest, fastest), strongest, jerk, dt_s);
            }
        }
    }

    fn accelerate_vertically(&mut self, limits: &Limits, dt_s: f64) {
        const DOWN: usize = 2;
        let fastest = (limits.speed_up_m_s, limits.speed_down_m_s);
        let (strongest, jerk) = (limits.acceleration_vertical_m_s2, limits.jerk_vertical_m_s3);
        let Some(wanted) = self.wanted_m_s(DOWN, fastest, (strongest, limits.jerk_vertical_m_s3)) else {
            self.push(DOWN, fastest, strongest, jerk, dt_s);
            return;
        };
        let missing = wanted.clamp(-fastest.0, fastest.1) - self.state.velocity_m_s[DOWN];
        let goal = copysign(closing(missing.abs(), strongest, jerk), missing);
        let change = goal - self.state.acceleration_m_s2[DOWN];
        self.state.acceleration_m_s2[DOWN] += change.clamp(-jerk * dt_s, jerk * dt_s);
    }

    /// An acceleration that is asked for as such, as long as the speed allows.
    fn push(&mut self, axis: usize, fastest: (f64, f64), strongest: f64, jerk: f64, dt_s: f64) {
        let AxisTarget::Acceleration(wanted) = self.set_point.axes[axis] else { return };
        let velocity = self.state.velocity_m_s[axis];
        // The acceleration that comes to rest at the limit of speed, from either side.
        let most = closing((fastest.1 - velocity).max(0.0), strongest, jerk);
        let least = -closing((fastest.0 + velocity).max(0.0), strongest, jerk);
        let change =
            wanted.clamp(-strongest, strongest).clamp(least, most) - self.state.acceleration_m_s2[axis];
        self.state.acceleration_m_s2[axis] += change.clamp(-jerk * dt_s, jerk * dt_s);
    }

    fn turn(&mut self, limits: &Limits, dt_s: f64) {
        let fastest = limits.yaw_rate_rad_s;
        let strongest = limits.yaw_acceleration_rad_s2;
        let state = &mut self.state;
        let wanted = match self.set_point.yaw {
            YawTarget::Track(..) => return,
            YawTarget::Hold => 0.0,
            YawTarget::Rate(rate) => rate,
            YawTarget::Angle(angle) | YawTarget::Follow(angle, _) => {
                approach(wrapped(angle - state.yaw_rad), POSITION_RATE, BRAKING_SHARE * strongest)
            }
        };
        let wanted = match self.set_point.yaw {
            YawTarget::Follow(_, rate) => wanted + rate,
            _ => wanted,
        };
        let change = wanted.clamp(-fastest, fastest) - state.yaw_rate_rad_s;
        let before = state.yaw_rate_rad_s;
        state.yaw_rate_rad_s += change.clamp(-strongest * dt_s, strongest * dt_s);
        state.yaw_rad = wrapped(state.yaw_rad + (before + state.yaw_rate_rad_s) / 2.0 * dt_s);
        if let YawTarget::Angle(angle) = self.set_point.yaw {
            let error = wrapped(angle - state.yaw_rad);
            if error.abs() < ARRIVED && state.yaw_rate_rad_s.abs() < 1e-4 {
                (state.yaw_rad, state.yaw_rate_rad_s) = (angle, 0.0);
            }
        }
    }
}

/// An angle brought into [−π, π), rad.
pub fn wrapped(angle_rad: f64) -> f64 {
    const TURN: f64 = core::f64::consts::TAU;
    angle_rad - TURN * libm::floor(angle_rad / TURN + 0.5)
}

/// Whether an acceleration is within its limit, and can be taken out with a jerk before the velocity changes by more than is
/// missing in its direction.
pub fn acceleration_fits(acceleration: f64, missing: f64, strongest: f64, jerk: f64) -> bool {
    acceleration <= strongest && acceleration * acceleration / (2.0 * jerk) <= missing.max(SMALL_M_S)
}

/// Speed towards a goal at a distance: proportional when near, what a deceleration brakes in time when far.
pub fn approach(way: f64, rate: f64, deceleration: f64) -> f64 {
    let linear_end = deceleration / (rate * rate);
    let distance = way.abs();
    let speed = if distance <= linear_end {
        rate * distance
    } else {
        sqrt(2.0 * deceleration * (distance - linear_end / 2.0))
    };
    copysign(speed, way)
}

/// Acceleration that closes a velocity error: what the jerk can still take back, and gentle at the end.
fn closing(missing: f64, strongest: f64, jerk: f64) -> f64 {
    sqrt(2.0 * jerk * missing).min(VELOCITY_RATE * missing).min(strongest)
}

/// A reference that rests at a place.
pub fn at_rest(position_m: Vector3<f64>, yaw_rad: f64) -> PositionReference {
    PositionReference::goal(position_m.into(), yaw_rad)
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;
    use proptest::prelude::*;
    use quadrotor::Limits;

    use super::{AxisTarget, Motion, PositionSetPoint, YawTarget, at_rest};

    const DT_S: f64 = 0.001;

    fn fly(set_point: PositionSetPoint, seconds: f64, mut look: impl FnMut(&Motion)) -> Motion {
        let mut motion = Motion::from(at_rest(Vector3::zeros(), 0.0), set_point, 0);
        for _ in 0..(seconds / DT_S) as usize {
            motion.step(&Limits::default(), DT_S);
            look(&motion);
        }
        motion
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]
        /// Positions and velocities on any mix of axes are reached within the limits and without overshoot.
        #[test]
        fn any_mix_of_axes_arrives_within_the_limits(
            kinds in prop::array::uniform3(any::<bool>()), values in prop::array::uniform3(-20.0..20.0),
            yaw in -3.0..3.0,
        ) {
            let limits = Limits::default();
            let axes: [AxisTarget; 3] = core::array::from_fn(|axis| {
                if kinds[axis] { AxisTarget::Position(values[axis]) } else { AxisTarget::Velocity(values[axis] / 10.0) }
            });
            let mut worst: Result<(), String> = Ok(());
            let mut before = Vector3::zeros();
            let set_point = PositionSetPoint { axes, yaw: YawTarget::Angle(yaw) };
            let mut motion = fly(set_point, 60.0, |motion| {
                let (v, a) = (motion.state.velocity_m_s, motion.state.acceleration_m_s2);
                let jerk = (a - before) / DT_S;
                before = a;
                let fits = v.xy().norm() <= limits.speed_horizontal_m_s * 1.001
                    && v.z <= limits.speed_down_m_s * 1.001 && v.z >= -limits.speed_up_m_s * 1.001
                    && a.xy().norm() <= limits.acceleration_horizontal_m_s2 * 1.001
                    && a.z.abs() <= limits.acceleration_vertical_m_s2 * 1.001
                    && jerk.xy().norm() <= limits.jerk_horizontal_m_s3 * 1.01
                    && jerk.z.abs() <= limits.jerk_vertical_m_s3 * 1.01;
                let overshoot = (0..3).any(|axis| matches!(axes[axis], AxisTarget::Position(goal)
                    if motion.state.position_m[axis] * goal.signum() > goal.abs() + 0.03));
                if !fits || overshoot { worst = Err(format!("{:?} jerk {jerk}", motion.state)); }
            });
            prop_assert!(worst.is_ok(), "{worst:?}");
            let end = motion.reference(60_000_000);
            for (axis, target) in axes.iter().enumerate() {
                match *target {
                    AxisTarget::Position(goal) => prop_assert!((end.position_m[axis] - goal).abs() < 1e-3, "{end:?}"),
                    AxisTarget::Velocity(v) => prop_assert!((end.velocity_m_s[axis] - v).abs() < 1e-6, "{end:?}"),
                    _ => unreachable!("not asked for"),
                }
            }
            prop_assert!((end.yaw_rad - yaw).abs() < 1e-3, "{end:?}");
        }
    }

    #[test]
    fn an_acceleration_ends_at_the_limit_of_speed() {
        let axes = [AxisTarget::Acceleration(1.0), AxisTarget::HOLD, AxisTarget::HOLD];
        let motion = fly(PositionSetPoint { axes, yaw: YawTarget::Hold }, 2.0, |_| {});
        assert!((motion.state.velocity_m_s.x - 1.87).abs() < 0.05, "{:?}", motion.state);
        let motion = fly(PositionSetPoint { axes, yaw: YawTarget::Hold }, 30.0, |_| {});
        assert!((motion.state.velocity_m_s.x - Limits::default().speed_horizontal_m_s).abs() < 1e-3);
    }

    #[test]
    fn a_trajectory_runs_on_between_its_points() {
        let track =
            AxisTarget::Track { position_m: 1.0, velocity_m_s: 2.0, acceleration_m_s2: -1.0, jerk_m_s3: 0.0 };
        let set_point = PositionSetPoint { axes: [track; 3], yaw: YawTarget::Track(0.5, 0.1) };
        let mut motion = Motion::from(at_rest(Vector3::zeros(), 0.0), set_point, 1_000_000);
        let reference = motion.reference(1_200_000);
        assert!(
            (reference.position_m.x - 1.38).abs() < 1e-12 && (reference.velocity_m_s.y - 1.8).abs() < 1e-12
        );
        assert!((reference.yaw_rad - 0.52).abs() < 1e-12);
    }
}
