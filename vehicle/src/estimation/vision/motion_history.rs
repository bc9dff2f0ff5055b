//! Where the vehicle has been lately: estimates from outside are of a moment that has passed.

use nalgebra::{UnitQuaternion, Vector3};

/// As many moments, one every 5 ms, as reach back farther than any delay of 0.3 s.
const MOMENTS: usize = 64;

/// The estimate of a moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// When, µs.
    pub time_us: u64,
    /// Where, NED, m.
    pub position_m: Vector3<f64>,
    /// NED, m/s.
    pub velocity_m_s: Vector3<f64>,
    /// FRD into NED.
    pub attitude: UnitQuaternion<f64>,
}

/// The latest moments.
#[derive(Clone, Debug)]
pub struct MotionHistory {
    moments: [Option<Moment>; MOMENTS],
    next: usize,
}

impl Default for MotionHistory {
    fn default() -> Self {
        Self { moments: [None; MOMENTS], next: 0 }
    }
}

impl MotionHistory {
    /// Remembers a moment.
    pub fn remember(&mut self, moment: Moment) {
        if let Some(place) = self.moments.get_mut(self.next) {
            *place = Some(moment);
        }
        self.next = (self.next + 1) % MOMENTS;
    }

    /// The remembered moment nearest to a time, µs.
    pub fn nearest(&self, time_us: u64) -> Option<&Moment> {
        self.moments.iter().flatten().min_by_key(|moment| moment.time_us.abs_diff(time_us))
    }

    /// Moves and turns all moments, as the estimate was: by a shift, m, and a turn about the vertical axis, rad.
    pub fn move_by(&mut self, shift_m: &Vector3<f64>, turn_rad: f64) {
        let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), turn_rad);
        for moment in self.moments.iter_mut().flatten() {
            moment.position_m += shift_m;
            moment.attitude = turn * moment.attitude;
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{UnitQuaternion, Vector3};

    use super::{MOMENTS, Moment, MotionHistory};

    #[test]
    fn the_nearest_moment_is_found_and_old_ones_are_forgotten() {
        let mut history = MotionHistory::default();
        assert_eq!(history.nearest(0), None);
        for step in 0..200_u64 {
            let position_m = Vector3::new(step as f64, 0.0, 0.0);
            let (velocity_m_s, attitude) = (Vector3::zeros(), UnitQuaternion::identity());
            history.remember(Moment { time_us: step * 5_000, position_m, velocity_m_s, attitude });
        }
        let north = |time_us: u64| history.nearest(time_us).map(|moment| moment.position_m.x);
        assert_eq!(
            [north(900_000), north(902_400), north(2_000_000)],
            [Some(180.0), Some(180.0), Some(199.0)]
        );
        assert_eq!(north(0), Some((200 - MOMENTS) as f64));
        let mut moved = history.clone();
        moved.move_by(&Vector3::new(1.0, 2.0, 3.0), 0.5);
        let moment = moved.nearest(900_000).expect("remembered");
        assert_eq!(moment.position_m, Vector3::new(181.0, 2.0, 3.0));
        assert!((moment.attitude.euler_angles().2 - 0.5).abs() < 1e-12);
    }
}
