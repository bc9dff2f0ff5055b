//! What has thrown a vehicle off its attitude of late.

use nalgebra::Vector2;
use serde::{Deserialize, Serialize};

use crate::control::answered::answer;
use crate::control::vehicle_motion::HorizontalMotion;
use crate::design::attitude_loop::AttitudeLoop;
use crate::design::position_limits::TurnUnderWay;

/// How many times more jerk than what has thrown it lately made, a body is brought back from.
const BRAKED: f64 = 5.0;

/// How many times as much snap as a lean that nobody has commanded would end with within a delay of the attitude loop, a body is brought back
/// with: past the reference, to take back the velocity that it has gained.
const TAKEN_BACK: f64 = 10.0;

/// By how much what turns the body beside its rotors has changed within the time in which the attitude loop answers. It is remembered in the
/// axes of the body: what lasts there, such as a centre of mass beside the rotors', turns with the vehicle, and so does what holds it.
///
/// The limits on the rate and the acceleration of the tilt are those of commands. A body that something else has thrown turns faster than
/// that, and so does its way back: a plan that had to keep the limits meanwhile would command it to lean as it was thrown.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Thrown {
    /// `None` before the first sample.
    latest: Option<Turning>,
    /// Sum of the changes of the snap by what turns the body, each of which fades, m/s⁴.
    thrown_m_s4: f64,
}

/// What turned the body beside its rotors at a sample.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Turning {
    /// Angular acceleration about roll and pitch, rad/s².
    turning_rad_s2: Vector2<f64>,
    /// The same as far as its changes have been answered.
    answered_rad_s2: Vector2<f64>,
    /// The snap by it, m/s⁴.
    turning_m_s4: Vector2<f64>,
    /// What of that the law saw, m/s⁴.
    seen_m_s4: Vector2<f64>,
}

impl Thrown {
    /// Of a vehicle that is taken over while it accelerates and jerks beside its reference, m/s² and m/s³: nobody has commanded that, and
    /// limits on commands do not bound the way back.
    pub(crate) fn taken_over(acceleration_m_s2: f64, jerk_m_s3: f64, attitude: Option<AttitudeLoop>) -> Self {
        let delay_s = attitude.map_or(0.0, |attitude| attitude.delay_s());
        if delay_s <= 0.0 {
            return Self::default();
        }
        let thrown_m_s3 = acceleration_m_s2 / delay_s + jerk_m_s3;
        Self { latest: None, thrown_m_s4: TAKEN_BACK * thrown_m_s3 / delay_s }
    }

    /// The snap by which the last sample's differs when it is seen as now, m/s⁴: by a law that sees what turns the body beside its rotors,
    /// or by one that sees the rotors alone, which hold against it. What is held has turned with the body since then.
    pub(crate) fn turned_m_s4(&self, seen: &HorizontalMotion, sees_it: bool) -> Vector2<f64> {
        let (held_m_s4, turned_m_s4) = match &self.latest {
            Some(latest) => {
                (latest.turning_m_s4 - latest.seen_m_s4, seen.snap_by_turning * latest.turning_rad_s2)
            }
            // It has been held before.
            None => (Vector2::zeros(), seen.disturbance_m_s4()),
        };
        if sees_it { held_m_s4 } else { held_m_s4 - turned_m_s4 }
    }

    /// What is under way at a sample of a law that sees `seen_m_s4` of what turns the body beside the rotors: that is answered within the
    /// delay of the attitude loop. `jump_m_s3` is the jump of the reference's jerk. And by how much more that has surely changed than was
    /// answered, which it then is, m/s⁴.
    pub(crate) fn turn_under_way(
        &mut self,
        seen: &HorizontalMotion,
        seen_m_s4: &Vector2<f64>,
        (attitude, sample_time_s): (Option<AttitudeLoop>, f64),
        jump_m_s3: &Vector2<f64>,
    ) -> (TurnUnderWay, Vector2<f64>) {
        let turning_rad_s2 = seen.disturbance_rad_s2;
        let (before_rad_s2, mut answered_rad_s2) =
            self.latest.map_or((turning_rad_s2, turning_rad_s2), |latest| {
                (latest.turning_rad_s2, latest.answered_rad_s2)
            });
        let change_rad_s2 = answer(&mut answered_rad_s2, &turning_rad_s2, &seen.unsure_rad_s2);
        let turning_m_s4 = seen.disturbance_m_s4();
        self.latest = Some(Turning { turning_rad_s2, answered_rad_s2, turning_m_s4, seen_m_s4: *seen_m_s4 });
        // Without a loop the attitude is taken for instantaneous.
        let delay_s = attitude.map_or(0.0, |attitude| attitude.delay_s());
        let kept = if delay_s > 0.0 { libm::exp(-sample_time_s / delay_s) } else { 0.0 };
        let thrown_m_s4 = (seen.snap_by_turning * (turning_rad_s2 - before_rad_s2)).norm();
        self.thrown_m_s4 = self.thrown_m_s4 * kept + thrown_m_s4;
        let made_m_s4 = (seen.snap_m_s4 + seen_m_s4).norm();
        let asked_m_s4 = (seen.asked_snap_m_s4 + seen_m_s4).norm();
        let thrown_m_s3 = self.thrown_m_s4 * delay_s;
        let under_way = TurnUnderWay {
            snap_m_s4: made_m_s4.max(asked_m_s4) + self.thrown_m_s4,
            jump_m_s3: jump_m_s3.norm(),
            jerk_m_s3: seen.jerk_m_s3.norm().min(BRAKED * thrown_m_s3) + thrown_m_s3,
        };
        (under_way, seen.snap_by_turning * change_rad_s2)
    }

    /// Expresses accelerations in other terms.
    pub(crate) fn translate(&mut self, term: impl Fn(&Vector2<f64>) -> Vector2<f64>) {
        if let Some(latest) = &mut self.latest {
            (latest.turning_m_s4, latest.seen_m_s4) = (term(&latest.turning_m_s4), term(&latest.seen_m_s4));
        }
    }

    /// Goes on under a belief in another inertia: `ratio` is the one before over the one now.
    pub(crate) fn believe(&mut self, ratio: f64) {
        if let Some(latest) = &mut self.latest {
            latest.turning_rad_s2 *= ratio;
            latest.answered_rad_s2 *= ratio;
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix2, Rotation2, Vector2};

    use super::Thrown;
    use crate::control::vehicle_motion::HorizontalMotion;
    use crate::{CascadeDesign, Configuration};

    fn still() -> HorizontalMotion {
        let zero = Vector2::zeros();
        HorizontalMotion {
            position_m: zero,
            velocity_m_s: zero,
            acceleration_m_s2: zero,
            jerk_m_s3: zero,
            snap_m_s4: zero,
            asked_snap_m_s4: zero,
            disturbance_m_s2: zero,
            disturbance_lag_s: 0.0,
            disturbance_rad_s2: zero,
            unsure_rad_s2: zero,
            snap_by_turning: Matrix2::new(0.0, 10.0, -10.0, 0.0),
        }
    }

    /// A torque that begins counts in full, and after one, two and three delays as e⁻¹, e⁻² and e⁻³; that it lasts does not.
    #[test]
    fn a_torque_throws_when_it_begins() {
        let design = CascadeDesign::new(&Configuration::default()).expect("a design");
        let attitude = design.attitude_loop().expect("a loop");
        let delay_s = attitude.delay_s();
        let turning = Vector2::new(60.0, -80.0);
        // The rotors hold against it.
        let held = HorizontalMotion {
            snap_m_s4: -turning,
            asked_snap_m_s4: -turning,
            disturbance_rad_s2: Vector2::new(8.0, 6.0),
            ..still()
        };
        assert_eq!(held.disturbance_m_s4(), turning);
        let zero = Vector2::zeros();
        let mut thrown = Thrown::default();
        thrown.turn_under_way(&still(), &zero, (Some(attitude), delay_s), &zero);
        for delays in 0..4 {
            let (under_way, change) =
                thrown.turn_under_way(&held, &turning, (Some(attitude), delay_s), &zero);
            assert_eq!(change, if delays == 0 { turning } else { zero });
            let expected = 100.0 * f64::exp(-f64::from(delays));
            assert!((under_way.snap_m_s4 - expected).abs() < 1e-9, "{under_way:?}");
            assert!((under_way.jerk_m_s3 - expected * delay_s).abs() < 1e-9, "{under_way:?}");
        }
    }

    /// Nothing that turns the body: the limits hold, but for a turn that is under way.
    #[test]
    fn without_a_torque_there_is_what_is_seen() {
        let seen = HorizontalMotion {
            jerk_m_s3: Vector2::new(3.0, 4.0),
            snap_m_s4: Vector2::new(0.0, 7.0),
            asked_snap_m_s4: Vector2::new(6.0, 8.0),
            ..still()
        };
        let zero = Vector2::zeros();
        let jump = Vector2::new(0.0, 2.0);
        let (under_way, _) = Thrown::default().turn_under_way(&seen, &zero, (None, 0.05), &jump);
        assert_eq!((under_way.snap_m_s4, under_way.jump_m_s3, under_way.jerk_m_s3), (10.0, 2.0, 0.0));
    }

    /// A vehicle that is taken over at rest has no more room than its limits; one that leans and rolls has ten times what it takes to bring
    /// that to an end within a delay.
    #[test]
    fn a_lean_that_nobody_has_commanded_may_come_back() {
        let design = CascadeDesign::new(&Configuration::default()).expect("a design");
        let attitude = design.attitude_loop().expect("a loop");
        let (zero, delay_s) = (Vector2::zeros(), attitude.delay_s());
        assert_eq!(Thrown::taken_over(0.0, 0.0, Some(attitude)), Thrown::default());
        assert_eq!(Thrown::taken_over(1.0, 1.0, None), Thrown::default());
        let mut thrown = Thrown::taken_over(delay_s, 2.0, Some(attitude));
        let (under_way, _) = thrown.turn_under_way(&still(), &zero, (Some(attitude), delay_s), &zero);
        let expected_m_s3 = 10.0 * 3.0 / 1_f64.exp();
        assert!((under_way.jerk_m_s3 - expected_m_s3).abs() < 1e-9, "{under_way:?}");
        assert!((under_way.snap_m_s4 * delay_s - expected_m_s3).abs() < 1e-9, "{under_way:?}");
    }

    /// A torque that is held while the body spins changes nothing, with both kinds of laws: neither sees what turns with the body.
    #[test]
    fn what_is_held_turns_with_the_body() {
        let zero = Vector2::zeros();
        let of_heading = |heading_rad: f64| HorizontalMotion {
            disturbance_rad_s2: Vector2::new(3.0, -4.0),
            snap_by_turning: *Rotation2::new(heading_rad).matrix() * still().snap_by_turning,
            ..still()
        };
        for sees_it in [true, false] {
            let mut thrown = Thrown::default();
            // What the rotors make, and what the law sees of it.
            let mut before = zero;
            for sample in 0..5 {
                let seen = of_heading(0.4 * f64::from(sample));
                let seen_m_s4 = if sees_it { seen.disturbance_m_s4() } else { zero };
                let state = -seen.disturbance_m_s4() + seen_m_s4;
                let change = state - (before + thrown.turned_m_s4(&seen, sees_it));
                let (under_way, answered) = thrown.turn_under_way(&seen, &seen_m_s4, (None, 0.05), &zero);
                assert!(change.norm() < 1e-12 && answered == zero, "{sample}: {change} {answered}");
                assert_eq!(under_way.jerk_m_s3, 0.0);
                before = state;
            }
        }
    }

    /// A regulator takes over from a law that sees torques, and hands back.
    #[test]
    fn takeovers_know_what_the_law_before_saw() {
        let (zero, seen) =
            (Vector2::zeros(), HorizontalMotion { disturbance_rad_s2: Vector2::x(), ..still() });
        let held_m_s4 = seen.disturbance_m_s4();
        let mut thrown = Thrown::default();
        thrown.turn_under_way(&seen, &held_m_s4, (None, 0.05), &zero);
        assert_eq!(thrown.turned_m_s4(&seen, false), -held_m_s4);
        thrown.turn_under_way(&seen, &zero, (None, 0.05), &zero);
        assert_eq!(thrown.turned_m_s4(&seen, true), held_m_s4);
    }
}
