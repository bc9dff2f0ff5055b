//! The way that is followed where nobody can lean as far as the reference, or has as much or as little thrust.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::control::required_thrust::RequiredThrust;
use crate::{Configuration, PositionReference, RigidBody, commanded_tilt_rad};

/// Natural frequency, rad/s, with which the way comes back to its reference, and its damping. Faster, it would pull against a
/// reference that keeps turning, and end up in its opposite phase; slower, it would forget where the reference is.
const RETURN_RAD_S: f64 = 0.7;
const DAMPING: f64 = 0.7;
/// Rate, 1/s, at which the way gives way to the vehicle: what a disturbance, or the delay of the tilt, takes while the thrust is used up
/// could only be won back by more thrust. Faster, it would drift away with what a swing takes on one side and gives back on the other.
const YIELDING_1_S: f64 = 0.25;
/// A reference that has been within the limits for so long, µs, is one to return to: the controllers do that as fast as the limits allow.
const RELEASED_US: u64 = 2_000_000;
/// Share of the largest lean below which a reference leaves them the room for that, and how near to it, m and m/s, the way needs none: without
/// room, feedback that has more than that to close swings ever farther.
const ROOMY: f64 = 0.8;
const NEAR: f64 = 0.15;

/// How the way that is followed differs from its reference.
///
/// A reference that leans farther than the limits allow, or asks for more thrust than they give or for less, cannot be followed. Feedback
/// that pulled towards it with all of the thrust would pull against its turns, and end up metres away on the other side. Position, velocity
/// and acceleration give way together:
///
/// ```text
/// δ̈ = sat(r̈ − 2ζω δ̇ − ω² δ) − r̈
/// ```
///
/// with the offset δ from the reference r, and sat as in [`RequiredThrust::within`]. There is none where the limits allow the
/// reference.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct FollowedWay {
    /// `None` while the reference is followed itself.
    offset: Option<Offset>,
}

/// δ and its derivatives, NED.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Offset {
    position_m: Vector3<f64>,
    velocity_m_s: Vector3<f64>,
    acceleration_m_s2: Vector3<f64>,
    jerk_m_s3: Vector3<f64>,
    /// When it had these values, µs.
    time_us: u64,
    /// When the reference was beyond the limits last, or left no room to return to it, µs.
    beyond_us: u64,
    /// Whether it has been beyond the thrust: otherwise only the horizontal motion gives way, also to a vehicle that stands on the ground
    /// and is to go down.
    gives_height: bool,
}

impl FollowedWay {
    /// Whether it stands in for its reference.
    pub(crate) fn gives_way(&self) -> bool {
        self.offset.is_some()
    }

    /// Goes on to a reference at a time, µs. What is followed then, unless it is the reference itself.
    pub(crate) fn follow(
        &mut self,
        configuration: &Configuration,
        (reference, body): (&PositionReference, &RigidBody),
        time_us: u64,
    ) -> Option<PositionReference> {
        let whole = RequiredThrust::whole(configuration, reference);
        let is_beyond_thrust = whole.is_beyond_thrust(configuration);
        let is_beyond = is_beyond_thrust || !whole.leans_at_most(configuration, 1.0);
        let mut offset = match self.offset {
            None if is_beyond => Offset::none(time_us),
            None => return None,
            Some(offset) => offset.after(time_us, reference, body),
        };
        if is_beyond || !(offset.is_near() || whole.leans_at_most(configuration, ROOMY)) {
            offset.beyond_us = time_us;
            offset.gives_height |= is_beyond_thrust;
        }
        let is_released = time_us.saturating_sub(offset.beyond_us) > RELEASED_US;
        if is_released || reference.is_at_rest() || !offset.is_finite() {
            self.offset = None;
            return None;
        }
        let followed = offset.beside(configuration, reference);
        offset.acceleration_m_s2 = followed.acceleration_m_s2 - reference.acceleration_m_s2;
        offset.jerk_m_s3 = followed.jerk_m_s3 - reference.jerk_m_s3;
        self.offset = Some(offset);
        Some(followed)
    }
}

impl Offset {
    fn none(time_us: u64) -> Self {
        let zero = Vector3::zeros();
        Self {
            position_m: zero,
            velocity_m_s: zero,
            acceleration_m_s2: zero,
            jerk_m_s3: zero,
            time_us,
            beyond_us: time_us,
            gives_height: false,
        }
    }

    /// Under constant jerk, and nearer to the offset that the vehicle has from its reference.
    fn after(&self, time_us: u64, reference: &PositionReference, body: &RigidBody) -> Self {
        let t = time_us.saturating_sub(self.time_us) as f64 / 1e6;
        let (v, a, j) = (self.velocity_m_s, self.acceleration_m_s2, self.jerk_m_s3);
        let position = self.position_m + (v + (a / 2.0 + j * (t / 6.0)) * t) * t;
        let velocity = v + (a + j * (t / 2.0)) * t;
        let share = (YIELDING_1_S * t).min(1.0);
        let nearer = |offset: Vector3<f64>, flown: Vector3<f64>| {
            let nearer = offset.lerp(&flown, share);
            if self.gives_height { nearer } else { Vector3::new(nearer.x, nearer.y, 0.0) }
        };
        Self {
            position_m: nearer(position, body.position_m - reference.position_m),
            velocity_m_s: nearer(velocity, body.velocity_m_s - reference.velocity_m_s),
            time_us,
            ..*self
        }
    }

    /// The way with this offset from a reference.
    fn beside(&self, configuration: &Configuration, reference: &PositionReference) -> PositionReference {
        const BACK: f64 = RETURN_RAD_S * RETURN_RAD_S;
        const SLOWER: f64 = 2.0 * DAMPING * RETURN_RAD_S;
        let drag_1_s = configuration.drag_1_s();
        let drag = |motion: &Vector3<f64>| drag_1_s.component_mul(motion);
        let velocity = reference.velocity_m_s + self.velocity_m_s;
        let lean_rad = commanded_tilt_rad(configuration);
        // What is wanted of each derivative depends on what the limits leave of the one before.
        let mut wanted = RequiredThrust {
            acceleration_m_s2: reference.acceleration_m_s2
                - self.velocity_m_s * SLOWER
                - self.position_m * BACK
                + drag(&velocity),
            jerk_m_s3: Vector3::zeros(),
            snap_m_s4: Vector3::zeros(),
        };
        let acceleration = wanted.within(configuration, lean_rad).acceleration_m_s2 - drag(&velocity);
        let change = acceleration - reference.acceleration_m_s2;
        wanted.jerk_m_s3 =
            reference.jerk_m_s3 - change * SLOWER - self.velocity_m_s * BACK + drag(&acceleration);
        let jerk = wanted.within(configuration, lean_rad).jerk_m_s3 - drag(&acceleration);
        wanted.snap_m_s4 =
            reference.snap_m_s4 - (jerk - reference.jerk_m_s3) * SLOWER - change * BACK + drag(&jerk);
        let snap = wanted.within(configuration, lean_rad).snap_m_s4 - drag(&jerk);
        PositionReference {
            position_m: reference.position_m + self.position_m,
            velocity_m_s: velocity,
            acceleration_m_s2: acceleration,
            jerk_m_s3: jerk,
            snap_m_s4: snap,
            ..*reference
        }
    }

    fn is_near(&self) -> bool {
        self.position_m.norm().max(self.velocity_m_s.norm()) < NEAR
    }

    fn is_finite(&self) -> bool {
        (self.position_m + self.velocity_m_s).iter().all(|value| value.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use nalgebra::Vector3;

    use super::FollowedWay;
    use crate::control::required_thrust::tests::dragged;
    use crate::guidance::known_motion;
    use crate::{Configuration, PlantState, PositionReference, RigidBody};

    const STEP_US: u64 = 1_000;

    /// A circle of 4 m at 1.5 rad/s: 9 m/s², of which the default limits allow 6.
    fn circle(time_us: u64) -> PositionReference {
        known_motion::circle(4.0, 1.5, 1e-6 * time_us as f64)
    }

    /// A vehicle that flies as a reference says.
    fn on(reference: &PositionReference) -> RigidBody {
        RigidBody {
            position_m: reference.position_m,
            velocity_m_s: reference.velocity_m_s,
            ..PlantState::at_rest(&Configuration::default().initial).body
        }
    }

    /// The ways of a flight that follows them, from rest on the circle's first point on.
    fn flown(configuration: &Configuration, steps: u64) -> Vec<PositionReference> {
        let mut way = FollowedWay::default();
        let mut at = circle(0);
        (0..steps)
            .map(|step| {
                let time_us = step * STEP_US;
                at = way
                    .follow(configuration, (&circle(time_us), &on(&at.after(1e-6 * STEP_US as f64))), time_us)
                    .unwrap();
                at
            })
            .collect()
    }

    /// Each derivative is that of the one before, and the thrust that it takes is within the lean.
    #[test]
    fn the_way_is_a_motion_within_the_lean() {
        let configuration = dragged();
        let largest = libm::tan(0.91 * configuration.limits.tilt_rad) * crate::GRAVITY_M_S2;
        let ways = flown(&configuration, 8_000);
        for of_three in ways.windows(3).skip(10).step_by(97) {
            let [before, now, after] = of_three else { unreachable!() };
            let slope = |of: fn(&PositionReference) -> Vector3<f64>| (of(after) - of(before)) / 2e-3;
            assert!((slope(|way| way.position_m) - now.velocity_m_s).norm() < 1e-3);
            assert!((slope(|way| way.velocity_m_s) - now.acceleration_m_s2).norm() < 1e-2);
            assert!((slope(|way| way.acceleration_m_s2) - now.jerk_m_s3).norm() < 3e-2);
            assert!((slope(|way| way.jerk_m_s3) - now.snap_m_s4).norm() < 0.1);
            let drag = Vector3::new(0.4, 0.25, 0.1).component_mul(&now.velocity_m_s);
            let thrust = now.acceleration_m_s2 + drag / configuration.airframe.mass_kg;
            assert!((thrust.norm() - largest).abs() < 1e-9, "{thrust}");
        }
    }

    /// At its largest lean a vehicle turns at 1.5 rad/s on 5.96/1.5² = 2.65 m: it cannot be nearer to the circle than 1.35 m for long, and
    /// is so but for a half.
    #[test]
    fn the_way_keeps_near_its_reference() {
        let ways = flown(&Configuration::default(), 40_000);
        for (step, way) in ways.iter().enumerate().skip(20_000) {
            let away_m = (way.position_m - circle(step as u64 * STEP_US).position_m).norm();
            assert!((1.3..2.0).contains(&away_m), "{step}: {away_m} m");
        }
    }

    /// What the limits allow is followed itself, also what comes after a way that they did not.
    #[test]
    fn a_reference_within_the_limits_is_followed_itself() {
        let configuration = Configuration::default();
        let mut way = FollowedWay::default();
        let slower = |share: f64, time_us: u64| PositionReference {
            acceleration_m_s2: circle(time_us).acceleration_m_s2 * share,
            ..circle(time_us)
        };
        let slow = |time_us: u64| slower(0.5, time_us);
        let mut followed = |reference: &PositionReference, time_us: u64| {
            way.follow(&configuration, (reference, &on(reference)), time_us)
        };
        assert_eq!(followed(&slow(0), 0), None);
        assert!(followed(&circle(10_000), 10_000).is_some());
        assert!(followed(&slow(2_000_000), 2_000_000).is_some());
        assert_eq!(followed(&slow(2_020_000), 2_020_000), None);
        assert!(followed(&circle(2_030_000), 2_030_000).is_some());
        // What leaves no room to return is returned to by the way itself.
        assert!(followed(&slower(0.65, 4_040_000), 4_040_000).is_some());
        assert_eq!(followed(&PositionReference::goal([1.0, 2.0, 3.0], 0.0), 4_050_000), None);
    }
}
