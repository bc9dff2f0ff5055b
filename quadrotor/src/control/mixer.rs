//! The inverse of the rotor map (1), with saturation.

use nalgebra::Matrix4;

use crate::{Airframe, ConfigurationError, Wrench};

/// From thrust and torques to rotor speeds, for one airframe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mixer {
    thrust_coefficient_n_s2: f64,
    torque_coefficient_n_m_s2: f64,
    arm_length_m: f64,
    /// Least and most thrust of a rotor, N.
    range_n: (f64, f64),
    /// Thrust of each rotor, N, per N·m of roll and of pitch torque, times the arm length.
    tilting: [[f64; 2]; 4],
    /// Thrust of each rotor per mean magnitude of the thrusts that make a yaw torque when the rotors share it evenly: ±1 if
    /// they do.
    turning: [f64; 4],
}

/// A rotor with a smaller share in the yaw has none.
const NO_YAW: f64 = 1e-100;

/// A bound on the yaw y, N, under a share s of the tilt: y ≥ s·size − room, or y ≤ room − s·size.
type Bound = (f64, f64);

impl Mixer {
    /// For an airframe.
    ///
    /// # Errors
    /// [`ConfigurationError::Layout`] when the rotors cannot make every torque.
    pub fn new(airframe: &Airframe) -> Result<Self, ConfigurationError> {
        let inverse: Matrix4<f64> = airframe.layout.inverse_allocation()?;
        let (weakest, strongest) = airframe.thrust_range_n();
        Ok(Self {
            thrust_coefficient_n_s2: airframe.thrust_coefficient_n_s2,
            torque_coefficient_n_m_s2: airframe.torque_coefficient_n_m_s2,
            arm_length_m: airframe.arm_length_m,
            range_n: (weakest / 4.0, strongest / 4.0),
            tilting: core::array::from_fn(|rotor| [inverse[(rotor, 1)], inverse[(rotor, 2)]]),
            turning: core::array::from_fn(|rotor| 4.0 * inverse[(rotor, 3)]),
        })
    }

    /// The inverse of (1) within the rotors' speed limits: speeds in the order of the airframe's layout, rad/s.
    ///
    /// What does not fit is given up in this order: the yaw torque first, then the roll and pitch torques
    /// together (their direction is kept). The thrust is kept, clamped to what the rotors can do; no rotor
    /// pulls backwards.
    pub fn rotor_speeds_rad_s(&self, wanted: &Wrench) -> [f64; 4] {
        let (weakest, strongest) = self.range_n;
        // Thrust of each rotor: F/4 + tilt ± yaw
        let mean = (wanted.thrust_n / 4.0).clamp(weakest, strongest);
        let roll = wanted.torque_n_m.x / self.arm_length_m;
        let pitch = wanted.torque_n_m.y / self.arm_length_m;
        let tilt = self.tilting.map(|[by_roll, by_pitch]| by_roll * roll + by_pitch * pitch);
        let yaw = wanted.torque_n_m.z * self.thrust_coefficient_n_s2 / (4.0 * self.torque_coefficient_n_m_s2);

        let (below, above) = (mean - weakest, strongest - mean);
        let (least, most) = self.bounds(&tilt, below, above);
        let share = tilting_share(&least, &most, (yaw.min(0.0), yaw.max(0.0)));
        // What is left for yaw: all four rotors within their range. Rounding may cross the two bounds.
        let least = least.iter().map(|(size, room)| share * size - room).fold(f64::NEG_INFINITY, f64::max);
        let most = most.iter().map(|(size, room)| room - share * size).fold(f64::INFINITY, f64::min);
        let yaw = yaw.min(most).max(least.min(most));

        // ω = √(thrust / k₁)
        core::array::from_fn(|rotor| {
            let thrust = mean + share * tilt[rotor] + self.turning[rotor] * yaw;
            libm::sqrt(thrust.clamp(weakest, strongest) / self.thrust_coefficient_n_s2)
        })
    }

    /// Bounds that the rotors' ranges put on the yaw from below and from above, when each may lose `below` and gain
    /// `above`. A rotor that makes no yaw bounds the tilt alone: its bounds are far away for any tilt that fits.
    fn bounds(&self, tilt: &[f64; 4], below: f64, above: f64) -> ([Bound; 4], [Bound; 4]) {
        let bound = |rotor: usize, from_below: bool| {
            let (tilt, turning) = (tilt[rotor], self.turning[rotor]);
            let size = libm::fabs(turning).max(NO_YAW);
            let (tilt, room) = if (turning > 0.0) == from_below { (-tilt, below) } else { (tilt, above) };
            (tilt / size, room / size)
        };
        (core::array::from_fn(|rotor| bound(rotor, true)), core::array::from_fn(|rotor| bound(rotor, false)))
    }

    /// Largest roll, pitch and yaw torques, N·m, each for itself, when each rotor may differ from the mean by `room_n`.
    pub(crate) fn largest_torques_n_m(&self, room_n: f64) -> [f64; 3] {
        let largest = |shares: [f64; 4]| shares.into_iter().map(libm::fabs).fold(0.0, f64::max);
        let tilting = |axis: usize| self.arm_length_m * room_n / largest(self.tilting.map(|by| by[axis]));
        let turning = 4.0 * self.torque_coefficient_n_m_s2 / self.thrust_coefficient_n_s2 * room_n;
        [tilting(0), tilting(1), turning / largest(self.turning)]
    }
}

/// Largest s ≤ 1 for which s times the tilt fits together with some share of the yaw, whose thrusts lie between
/// `yaw.0` ≤ 0 and `yaw.1` ≥ 0: no bound from below may cross one from above, nor the other end of the yaw.
fn tilting_share(least: &[Bound; 4], most: &[Bound; 4], yaw: (f64, f64)) -> f64 {
    let mut share: f64 = 1.0;
    let mut keep = |size: f64, room: f64| {
        if size > 0.0 {
            share = share.min(room / size);
        }
    };
    for (size, room) in least {
        keep(*size, room + yaw.1);
    }
    for (size, room) in most {
        keep(*size, room - yaw.0);
    }
    for (size, room) in least {
        for (other_size, other_room) in most {
            keep(size + other_size, room + other_room);
        }
    }
    share
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;
    use proptest::prelude::*;

    use super::Mixer;
    use crate::{Airframe, Direction, Rotor, RotorLayout, Wrench, wrench_of_rotors};

    proptest! {
        /// (1) and its inverse agree wherever nothing saturates.
        #[test]
        fn map_and_inverse_agree_inside_the_limits(speeds in prop::array::uniform4(50.0..450.0)) {
            let airframe = Airframe::default();
            let wrench = wrench_of_rotors(&airframe, &speeds);
            let again = Mixer::new(&airframe).expect("a mixer").rotor_speeds_rad_s(&wrench);
            for (speed, repeated) in speeds.iter().zip(again) {
                prop_assert!((speed - repeated).abs() < 1e-6, "{speeds:?} became {again:?}");
            }
        }

        /// Whatever is asked, no rotor leaves its range, the thrust is kept as far as it exists, and the
        /// roll and pitch torques keep their direction.
        #[test]
        fn saturation_gives_up_yaw_then_roll_and_pitch(
            thrust in -50.0..60.0, x in -5.0..5.0, y in -5.0..5.0, z in -2.0..2.0, layout in 0..3_usize,
        ) {
            let layout = [RotorLayout::plus(), RotorLayout::x(), RotorLayout::h(1.5)][layout];
            let airframe = Airframe { layout, ..Airframe::default() };
            let (weakest, strongest) = airframe.thrust_range_n();
            let wanted = Wrench { thrust_n: thrust, torque_n_m: Vector3::new(x, y, z) };
            let mixer = Mixer::new(&airframe).expect("a mixer");
            let speeds = mixer.rotor_speeds_rad_s(&wanted);
            for speed in speeds {
                prop_assert!((50.0 - 1e-9..=450.0 + 1e-9).contains(&speed));
            }
            let made = wrench_of_rotors(&airframe, &speeds);
            prop_assert!((made.thrust_n - thrust.clamp(weakest, strongest)).abs() < 1e-9);

            // Yaw never costs roll and pitch anything.
            let level = Wrench { torque_n_m: Vector3::new(x, y, 0.0), ..wanted };
            let without_yaw = wrench_of_rotors(&airframe, &mixer.rotor_speeds_rad_s(&level));
            prop_assert!(made.torque_n_m.xy().norm() >= without_yaw.torque_n_m.xy().norm() - 1e-9);
            // Roll and pitch are scaled by one factor in [0, 1].
            let share = made.torque_n_m.xy().norm() / wanted.torque_n_m.xy().norm();
            prop_assert!(share <= 1.0 + 1e-9);
            prop_assert!((made.torque_n_m.xy() - wanted.torque_n_m.xy() * share).norm() < 1e-9);
            // Yaw is never reversed nor exceeded.
            prop_assert!(made.torque_n_m.z * z >= -1e-12 && made.torque_n_m.z.abs() <= z.abs() + 1e-9);
            // Nothing is given up while there is room: some rotor is at a limit, or all is delivered.
            let at_limit = speeds.iter().any(|speed| (speed - 50.0).abs() < 1e-6 || (speed - 450.0).abs() < 1e-6);
            prop_assert!(at_limit || (made.torque_n_m - wanted.torque_n_m).norm() < 1e-9);
        }

        /// The map and its inverse agree for whatever layout is balanced and can make every torque.
        #[test]
        fn map_and_inverse_agree_for_any_layout(
            places in prop::array::uniform3(prop::array::uniform2(-1.0..1.0)), order in 0..3_usize,
            speeds in prop::array::uniform4(50.0..450.0),
        ) {
            let last = [0, 1].map(|axis| -places.iter().map(|place| place[axis]).sum::<f64>());
            let places = [places[0], places[1], places[2], last];
            let (c, a) = (Direction::Clockwise, Direction::Counterclockwise);
            let directions = [[c, a, c, a], [c, c, a, a], [c, a, a, c]][order];
            let rotors = core::array::from_fn(|rotor| {
                Rotor { x: places[rotor][0], y: places[rotor][1], direction: directions[rotor] }
            });
            let airframe = Airframe { layout: RotorLayout { rotors }, ..Airframe::default() };
            if let Ok(mixer) = Mixer::new(&airframe) {
                let wrench = wrench_of_rotors(&airframe, &speeds);
                let again = mixer.rotor_speeds_rad_s(&wrench);
                for (speed, repeated) in speeds.iter().zip(again) {
                    prop_assert!((speed - repeated).abs() < 1e-6, "{speeds:?} became {again:?}");
                }
            }
        }
    }
}
