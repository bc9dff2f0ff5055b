//! What has thrown a vehicle off its attitude of late.

use nalgebra::Vector2;
use serde::{Deserialize, Serialize};

use crate::control::answered::answer;
use crate::control::vehicle_motion::HorizontalMotion;
use crate::design::attitude_loop::AttitudeLoop;
use crate::design::position_limits::TurnUnderWay;

/// How many times more jerk than what has thrown it lately made, a body is brought back from.
const BRAKED: f64 = 5.0;

/// By how much what turns the body beside its rotors has changed within the time in which the attitude loop answers.
///
/// The limits on the rate and the acceleration of the tilt are those of commands. A body that something else has thrown turns faster than
/// that, and so does its way back: a plan that had to keep the limits meanwhile would command it to lean as it was thrown.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Thrown {
    /// Snap by what turns the body beside the rotors, at the last sample, m/s⁴.
    turning_m_s4: Vector2<f64>,
    /// The same as far as its changes have been answered, m/s⁴.
    answered_m_s4: Vector2<f64>,
    /// Sum of its changes, each of which fades, m/s⁴.
    thrown_m_s4: f64,
}

impl Thrown {
    /// By how much more what turns the body beside the rotors has surely changed than was answered, which it then is, m/s⁴.
    pub(crate) fn answer_m_s4(&mut self, seen: &HorizontalMotion) -> Vector2<f64> {
        let unsure_m_s4 = Vector2::repeat(seen.unsure_m_s4);
        answer(&mut self.answered_m_s4, &seen.disturbance_m_s4, &unsure_m_s4)
    }

    /// What turned the body beside the rotors at the last sample, m/s⁴.
    pub(crate) fn turning_m_s4(&self) -> Vector2<f64> {
        self.turning_m_s4
    }

    /// What is under way at a sample, `turning_m_s4` of it by what turns the body beside the rotors: it is answered within the delay of the
    /// attitude loop. `jump_m_s3` is the jump of the reference's jerk.
    pub(crate) fn turn_under_way(
        &mut self,
        seen: &HorizontalMotion,
        turning_m_s4: &Vector2<f64>,
        (attitude, sample_time_s): (Option<AttitudeLoop>, f64),
        jump_m_s3: &Vector2<f64>,
    ) -> TurnUnderWay {
        // Without a loop the attitude is taken for instantaneous.
        let delay_s = attitude.map_or(0.0, |attitude| attitude.delay_s());
        let kept = if delay_s > 0.0 { libm::exp(-sample_time_s / delay_s) } else { 0.0 };
        self.thrown_m_s4 = self.thrown_m_s4 * kept + (turning_m_s4 - self.turning_m_s4).norm();
        self.turning_m_s4 = *turning_m_s4;
        let made_m_s4 = (seen.snap_m_s4 + turning_m_s4).norm();
        let asked_m_s4 = (seen.asked_snap_m_s4 + turning_m_s4).norm();
        let thrown_m_s3 = self.thrown_m_s4 * delay_s;
        TurnUnderWay {
            snap_m_s4: made_m_s4.max(asked_m_s4) + self.thrown_m_s4,
            jump_m_s3: jump_m_s3.norm(),
            jerk_m_s3: seen.jerk_m_s3.norm().min(BRAKED * thrown_m_s3) + thrown_m_s3,
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector2;

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
            disturbance_m_s4: zero,
            unsure_m_s4: 0.0,
            disturbance_lag_s: 0.0,
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
        let held = HorizontalMotion { snap_m_s4: -turning, asked_snap_m_s4: -turning, ..still() };
        let mut thrown = Thrown::default();
        for delays in 0..4 {
            let zero = Vector2::zeros();
            let under_way = thrown.turn_under_way(&held, &turning, (Some(attitude), delay_s), &zero);
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
        let under_way = Thrown::default().turn_under_way(&seen, &zero, (None, 0.05), &jump);
        assert_eq!((under_way.snap_m_s4, under_way.jump_m_s3, under_way.jerk_m_s3), (10.0, 2.0, 0.0));
    }
}
