//! The reference of a closed loop from elsewhere: moving, whatever is asked for, since nothing is known of a shaper in it.

use quadrotor::{Inputs, Limits, PositionReference};

use super::motion::{Motion, wrapped};
use super::set_point::{AxisTarget, PositionSetPoint, YawTarget};

/// Where the closed loop is to be now, and how that goes on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferenceGuide {
    now: PositionReference,
    /// The way to a place, while one is asked for, and that place.
    way: Option<(PositionReference, Motion)>,
}

impl ReferenceGuide {
    /// At rest where it starts.
    pub fn new(start: PositionReference) -> Self {
        Self { now: start, way: None }
    }

    /// The present reference. Its heading goes on over ±π.
    pub fn now(&self) -> &PositionReference {
        &self.now
    }

    /// Takes in what is asked for at `time_us`: a place is gone to within the limits, anything else moves by itself, and what is no
    /// reference rests where that is.
    pub fn ask(&mut self, asked: &Inputs, time_us: u64) {
        if asked.attitude_target.is_some() || asked.shaping != Some(true) {
            self.way = None;
            self.turn_on(asked.reference);
            return;
        }
        let goal = asked.reference;
        if self.way.as_ref().is_some_and(|(towards, _)| *towards == goal) {
            return;
        }
        let axes = goal.position_m.data.0[0].map(AxisTarget::Position);
        let set_point = PositionSetPoint { axes, yaw: YawTarget::Angle(wrapped(goal.yaw_rad)) };
        match &mut self.way {
            Some((towards, motion)) => {
                *towards = goal;
                motion.ask(set_point, time_us);
            }
            None => {
                let now = PositionReference { yaw_rad: wrapped(self.now.yaw_rad), ..self.now };
                self.way = Some((goal, Motion::from(now, set_point, time_us)));
            }
        }
    }

    /// Goes on its way by `dt_s`, until `time_us`.
    pub fn step(&mut self, limits: &Limits, dt_s: f64, time_us: u64) {
        let Some((_, motion)) = &mut self.way else { return };
        motion.step(limits, dt_s);
        let reference = motion.reference(time_us);
        self.turn_on(reference);
    }

    /// Another reference, with the heading that is nearest to the last one.
    fn turn_on(&mut self, reference: PositionReference) {
        let yaw_rad = self.now.yaw_rad + wrapped(reference.yaw_rad - self.now.yaw_rad);
        self.now = PositionReference { yaw_rad, ..reference };
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use nalgebra::Vector3;
    use quadrotor::{Inputs, Limits};

    use super::ReferenceGuide;
    use crate::vehicle::motion::at_rest as resting;

    #[test]
    fn a_place_is_gone_to_within_the_limits_and_by_the_shorter_turn() {
        let mut guide = ReferenceGuide::new(resting(Vector3::zeros(), 3.0));
        let goal = resting(Vector3::new(4.0, 0.0, -3.0), -3.0);
        let asked = Inputs { reference: goal, shaping: Some(true), ..Inputs::default() };
        let limits = Limits::default();
        for tick in 0..20_000_u64 {
            guide.ask(&asked, tick * 1000);
            let before = *guide.now();
            guide.step(&limits, 0.001, (tick + 1) * 1000);
            let speed = (guide.now().position_m - before.position_m).norm() / 0.001;
            assert!(speed <= limits.speed_horizontal_m_s.hypot(limits.speed_up_m_s) * 1.001);
            assert!((guide.now().yaw_rad - before.yaw_rad).abs() < 0.01, "a turn goes on over ±π");
        }
        assert!((guide.now().position_m - goal.position_m).norm() < 1e-3, "{:?}", guide.now());
        assert!((guide.now().yaw_rad - (2.0 * PI - 3.0)).abs() < 1e-3, "{:?}", guide.now());
    }

    #[test]
    fn a_moving_reference_is_passed_on() {
        let mut guide = ReferenceGuide::new(resting(Vector3::zeros(), 0.0));
        let mut reference = resting(Vector3::new(1.0, 2.0, -3.0), 0.1);
        reference.velocity_m_s = Vector3::new(0.5, 0.0, 0.0);
        guide.ask(&Inputs { reference, shaping: Some(false), ..Inputs::default() }, 0);
        assert_eq!(*guide.now(), reference);
    }
}
