//! The inverse of the rotor map (1), with saturation.

use nalgebra::{Matrix4, Vector2};

use crate::control::largest_share::{Bound, largest_share};
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
    /// One over its magnitude.
    per_turning: [f64; 4],
    /// The least of these among the rotors that turn the vehicle to the right by more thrust, and among the others.
    least_per_turning: [f64; 2],
}

/// A rotor with a smaller share in the yaw has none.
const NO_YAW: f64 = 1e-100;

/// Largest share of the rotors' range by which the thrust is reduced for the yaw torque. At full thrust the heading stays
/// controllable, and turning costs little of the climb.
const YAW_HEADROOM: f64 = 0.15;

/// A bound on the yaw y, N, under a share s of the tilt, while the mean thrust gives way by g:
/// y ≥ s·size − room − gain·g, or y ≤ room + gain·g − s·size.
type YawBound = Bound;

/// Bounds on the share of the tilt: what is left of those on the yaw.
const TILT_BOUNDS: usize = 24;

impl Mixer {
    /// For an airframe.
    ///
    /// # Errors
    /// [`ConfigurationError::Layout`] when the rotors cannot make every torque.
    pub fn new(airframe: &Airframe) -> Result<Self, ConfigurationError> {
        let inverse: Matrix4<f64> = airframe.layout.inverse_allocation()?;
        let (weakest, strongest) = airframe.thrust_range_n();
        let turning: [f64; 4] = core::array::from_fn(|rotor| 4.0 * inverse[(rotor, 3)]);
        let per_turning = turning.map(|turning| 1.0 / libm::fabs(turning).max(NO_YAW));
        let least = |right: bool| {
            let of_side = turning.iter().zip(per_turning).filter(|(turning, _)| (**turning > 0.0) == right);
            of_side.map(|(_, per)| per).fold(f64::INFINITY, f64::min)
        };
        Ok(Self {
            thrust_coefficient_n_s2: airframe.thrust_coefficient_n_s2,
            torque_coefficient_n_m_s2: airframe.torque_coefficient_n_m_s2,
            arm_length_m: airframe.arm_length_m,
            range_n: (weakest / 4.0, strongest / 4.0),
            tilting: core::array::from_fn(|rotor| [inverse[(rotor, 1)], inverse[(rotor, 2)]]),
            turning,
            per_turning,
            least_per_turning: [least(true), least(false)],
        })
    }

    /// The inverse of (1) within the rotors' speed limits: speeds in the order of the airframe's layout, rad/s.
    ///
    /// At the upper end of the rotors' range attitude comes before thrust. What does not fit is given up in this order:
    ///
    /// 1. Yaw torque, except for what fits when the thrust gives way by 15 % of the rotors' range.
    /// 2. Thrust, as far as the roll and pitch torques need it, down to the middle of the rotors' range, where they have the
    ///    most room, or down to `least_thrust_n` if that is more.
    /// 3. The roll and pitch torques together, so that their direction is kept.
    ///
    /// Below the middle the thrust is kept and the torques give way: thrust is never raised, except to the least that the rotors
    /// make. No rotor pulls backwards.
    pub fn rotor_speeds_rad_s(&self, wanted: &Wrench, least_thrust_n: f64) -> [f64; 4] {
        // ω = √(thrust / k₁)
        self.rotor_thrusts_n(wanted, least_thrust_n)
            .map(|thrust| libm::sqrt(thrust / self.thrust_coefficient_n_s2))
    }

    /// The thrusts, N, that [`Mixer::rotor_speeds_rad_s`] makes with those speeds.
    pub(crate) fn rotor_thrusts_n(&self, wanted: &Wrench, least_thrust_n: f64) -> [f64; 4] {
        let (weakest, strongest) = self.range_n;
        // Thrust of each rotor: F/4 + tilt ± yaw
        let tilt = self.tilting_thrusts_n(&wanted.torque_n_m.xy());
        let yaw = wanted.torque_n_m.z * self.thrust_coefficient_n_s2 / (4.0 * self.torque_coefficient_n_m_s2);
        let mean = (wanted.thrust_n / 4.0).clamp(weakest, strongest);
        let mean = mean - self.given(mean, self.most_given(mean, least_thrust_n), &tilt, yaw);

        let (least, most) = self.yaw_bounds(&tilt, mean);
        let (share, _) = tilt_share(&least, &most, yaw, 0.0);
        // What is left for yaw: all four rotors within their range. Rounding may cross the two bounds.
        let least =
            least.iter().map(|bound| share * bound.size - bound.room).fold(f64::NEG_INFINITY, f64::max);
        let most = most.iter().map(|bound| bound.room - share * bound.size).fold(f64::INFINITY, f64::min);
        let yaw = yaw.min(most).max(least.min(most));

        core::array::from_fn(|rotor| {
            (mean + share * tilt[rotor] + self.turning[rotor] * yaw).clamp(weakest, strongest)
        })
    }

    /// By how much the thrust of each rotor differs from the mean for roll and pitch torques, N·m.
    pub(crate) fn tilting_thrusts_n(&self, torque_n_m: &Vector2<f64>) -> [f64; 4] {
        let (roll, pitch) = (torque_n_m.x / self.arm_length_m, torque_n_m.y / self.arm_length_m);
        self.tilting.map(|[by_roll, by_pitch]| by_roll * roll + by_pitch * pitch)
    }

    /// By how much the thrust of each rotor may differ from the mean, N, down and up, for roll and pitch torques under a
    /// thrust that gives way to them, down to a least one.
    pub(crate) fn tilting_room_n(&self, (thrust_n, least_thrust_n): (f64, f64)) -> (f64, f64) {
        let (weakest, strongest) = self.range_n;
        let mean = (thrust_n / 4.0).clamp(weakest, strongest);
        let mean = mean - self.most_given(mean, least_thrust_n);
        (mean - weakest, strongest - mean)
    }

    /// Least and largest yaw torque, N·m, that these roll and pitch torques leave room for, under a thrust that gives way to
    /// all of them as far as the mixer lets it, down to a least one.
    pub(crate) fn turning_range_n_m(
        &self,
        (thrust_n, least_thrust_n): (f64, f64),
        tilting_n_m: &Vector2<f64>,
    ) -> (f64, f64) {
        let (weakest, strongest) = self.range_n;
        let tilt = self.tilting_thrusts_n(tilting_n_m);
        let mean = (thrust_n / 4.0).clamp(weakest, strongest);
        let most = self.most_given(mean, least_thrust_n);
        let whole = self.yaw_bounds(&tilt, mean);
        let (share, to_tilt) = tilt_share(&whole.0, &whole.1, 0.0, most);
        let headroom = (YAW_HEADROOM * (strongest - weakest)).min(most - to_tilt);
        let range = |left: f64| {
            // Mostly nothing gives way.
            let reduced;
            let (least, largest) = if left == mean {
                &whole
            } else {
                reduced = self.yaw_bounds(&tilt, left);
                &reduced
            };
            let ends = |bounds: &[YawBound; 4]| {
                bounds.iter().map(|bound| bound.room - share * bound.size).fold(f64::INFINITY, f64::min)
            };
            // Rounding may leave less than nothing.
            (-ends(least).max(0.0), ends(largest).max(0.0))
        };
        let ((low, high), (low_after, high_after)) =
            (range(mean - to_tilt), range(mean - to_tilt - headroom));
        let torque_n_m =
            |yaw_n: f64| yaw_n * 4.0 * self.torque_coefficient_n_m_s2 / self.thrust_coefficient_n_s2;
        (torque_n_m(low.min(low_after)), torque_n_m(high.max(high_after)))
    }

    /// The same beside no roll and pitch torques: thrust gives way by no more than the headroom.
    pub(crate) fn turning_range_alone_n_m(&self, (thrust_n, least_thrust_n): (f64, f64)) -> (f64, f64) {
        let (weakest, strongest) = self.range_n;
        let mean = (thrust_n / 4.0).clamp(weakest, strongest);
        let headroom = (YAW_HEADROOM * (strongest - weakest)).min(self.most_given(mean, least_thrust_n));
        let [right, left] = self.least_per_turning;
        let range = |mean: f64| {
            let (down, up) = ((mean - weakest).max(0.0), (strongest - mean).max(0.0));
            (-(down * right).min(up * left), (up * right).min(down * left))
        };
        let ((low, high), (low_after, high_after)) = (range(mean), range(mean - headroom));
        let torque_n_m =
            |yaw_n: f64| yaw_n * 4.0 * self.torque_coefficient_n_m_s2 / self.thrust_coefficient_n_s2;
        (torque_n_m(low.min(low_after)), torque_n_m(high.max(high_after)))
    }

    /// By how much the mean thrust, N, may give way: to the middle of the range, where the room for torques is largest, or to the
    /// least one.
    fn most_given(&self, mean: f64, least_thrust_n: f64) -> f64 {
        let (weakest, strongest) = self.range_n;
        (mean - f64::midpoint(weakest, strongest).max(least_thrust_n / 4.0)).max(0.0)
    }

    /// By how much of `most` the mean thrust, N, gives way to the torques: first to roll and pitch, then to yaw.
    fn given(&self, mean: f64, most: f64, tilt: &[f64; 4], yaw: f64) -> f64 {
        if most <= 0.0 {
            return 0.0;
        }
        let (weakest, strongest) = self.range_n;
        let (least_yaw, most_yaw) = self.yaw_bounds(tilt, mean);
        let (share, to_tilt) = tilt_share(&least_yaw, &most_yaw, yaw, most);
        // f_min ≤ mean − g + s·tilt + t·yaw ≤ f_max for every rotor, t the share of the yaw
        let mean = mean - to_tilt;
        let headroom = (YAW_HEADROOM * (strongest - weakest)).min(most - to_tilt);
        let bounds: [Bound; 8] = core::array::from_fn(|index| {
            let (rotor, above) = (index % 4, index < 4);
            let (level, turning) = (mean + share * tilt[rotor], self.turning[rotor] * yaw);
            if above {
                Bound { size: turning, room: strongest - level, gain: 1.0 }
            } else {
                Bound { size: -turning, room: level - weakest, gain: -1.0 }
            }
        });
        let (_, to_yaw) = largest_share(&bounds, headroom);
        to_tilt + to_yaw
    }

    /// Bounds that the rotors' ranges put on the yaw from below and from above, under a mean thrust, N. A rotor that makes no
    /// yaw bounds the tilt alone: its bounds are far away for any tilt that fits.
    fn yaw_bounds(&self, tilt: &[f64; 4], mean: f64) -> ([YawBound; 4], [YawBound; 4]) {
        let (weakest, strongest) = self.range_n;
        let bound = |rotor: usize, from_below: bool| {
            let (tilt, turning, per) = (tilt[rotor], self.turning[rotor], self.per_turning[rotor]);
            let (tilt, room, gain) = if (turning > 0.0) == from_below {
                (-tilt, mean - weakest, -1.0)
            } else {
                (tilt, strongest - mean, 1.0)
            };
            YawBound { size: tilt * per, room: room * per, gain: gain * per }
        };
        (core::array::from_fn(|rotor| bound(rotor, true)), core::array::from_fn(|rotor| bound(rotor, false)))
    }

    /// Largest roll, pitch and yaw torques, N·m, each for itself, when a thrust, N, is asked for that is reduced for them to
    /// the least one, N, if need be.
    pub(crate) fn available_torques_n_m(&self, thrust_n: f64, least_thrust_n: f64) -> [f64; 3] {
        let (weakest, strongest) = self.range_n;
        let mean = (thrust_n / 4.0).clamp(weakest, strongest);
        let room = |mean: f64| (mean - weakest).min(strongest - mean);
        let to_tilt = self.most_given(mean, least_thrust_n);
        let to_yaw = to_tilt.min(YAW_HEADROOM * (strongest - weakest));
        let [roll, pitch, _] = self.largest_torques_n_m(room(mean - to_tilt));
        let [_, _, yaw] = self.largest_torques_n_m(room(mean - to_yaw));
        [roll, pitch, yaw]
    }

    /// Largest roll, pitch and yaw torques, N·m, each for itself, when each rotor may differ from the mean by `room_n`.
    pub(crate) fn largest_torques_n_m(&self, room_n: f64) -> [f64; 3] {
        let largest = |shares: [f64; 4]| shares.into_iter().map(libm::fabs).fold(0.0, f64::max);
        let tilting = |axis: usize| self.arm_length_m * room_n / largest(self.tilting.map(|by| by[axis]));
        let turning = 4.0 * self.torque_coefficient_n_m_s2 / self.thrust_coefficient_n_s2 * room_n;
        [tilting(0), tilting(1), turning / largest(self.turning)]
    }
}

/// The largest share of the tilt that fits together with some share of the yaw, N, and what the mean thrust gives of `most` for it, N.
fn tilt_share(least: &[YawBound; 4], largest: &[YawBound; 4], yaw: f64, most: f64) -> (f64, f64) {
    // Where each rotor has room for its part of the tilt, all bounds have room for all of it: they are sums of these with positive
    // factors, whose order rounding keeps.
    if least.iter().chain(largest).all(|bound| bound.size <= bound.room) {
        return (1.0, 0.0);
    }
    largest_share(&tilt_bounds(least, largest, yaw), most)
}

/// Bounds on the share of the tilt that fits together with some share of the yaw, N: no bound on the yaw from below may cross
/// one from above, nor the other end of the yaw.
fn tilt_bounds(least: &[YawBound; 4], most: &[YawBound; 4], yaw: f64) -> [Bound; TILT_BOUNDS] {
    core::array::from_fn(|index| match index {
        0..4 => Bound { room: least[index].room + yaw.max(0.0), ..least[index] },
        4..8 => Bound { room: most[index - 4].room - yaw.min(0.0), ..most[index - 4] },
        _ => least[(index - 8) / 4].joined(most[index % 4]),
    })
}

#[cfg(test)]
mod tests {
    use nalgebra::{Vector2, Vector3};
    use proptest::prelude::*;

    use super::Mixer;
    use crate::{Airframe, Direction, Rotor, RotorLayout, Wrench, wrench_of_rotors};

    proptest! {
        /// (1) and its inverse agree wherever nothing saturates.
        #[test]
        fn map_and_inverse_agree_inside_the_limits(speeds in prop::array::uniform4(50.0..450.0)) {
            let airframe = Airframe::default();
            let wrench = wrench_of_rotors(&airframe, &speeds);
            let again = Mixer::new(&airframe).expect("a mixer").rotor_speeds_rad_s(&wrench, 0.0);
            for (speed, repeated) in speeds.iter().zip(again) {
                prop_assert!((speed - repeated).abs() < 1e-6, "{speeds:?} became {again:?}");
            }
        }

        /// Whatever is asked, no rotor leaves its range, thrust gives way at the upper end only, and the roll and pitch
        /// torques keep their direction.
        #[test]
        fn saturation_gives_up_yaw_then_thrust_then_roll_and_pitch(
            thrust in -50.0..60.0, least in 0.0..25.0, x in -5.0..5.0, y in -5.0..5.0, z in -2.0..2.0,
            layout in 0..3_usize,
        ) {
            let layout = [RotorLayout::plus(), RotorLayout::x(), RotorLayout::h(1.5)][layout];
            let airframe = Airframe { layout, ..Airframe::default() };
            let (weakest, strongest) = airframe.thrust_range_n();
            let wanted = Wrench { thrust_n: thrust, torque_n_m: Vector3::new(x, y, z) };
            let mixer = Mixer::new(&airframe).expect("a mixer");
            let made_of = |wanted: &Wrench, least: f64| {
                wrench_of_rotors(&airframe, &mixer.rotor_speeds_rad_s(wanted, least))
            };
            let speeds = mixer.rotor_speeds_rad_s(&wanted, least);
            for speed in speeds {
                prop_assert!((50.0 - 1e-9..=450.0 + 1e-9).contains(&speed));
            }
            let made = wrench_of_rotors(&airframe, &speeds);
            // Thrust is never raised, and reduced no further than allowed.
            let middle = f64::midpoint(weakest, strongest);
            let asked = thrust.clamp(weakest, strongest);
            prop_assert!(made.thrust_n <= asked + 1e-9);
            prop_assert!(made.thrust_n >= asked.min(middle.max(least)) - 1e-9);
            // What is asked for above the middle costs no roll or pitch that there would be at the least thrust.
            let level = |thrust_n: f64| Wrench { thrust_n, torque_n_m: Vector3::new(x, y, 0.0) };
            let roomiest = made_of(&level(asked.min(middle.max(least))), least);
            prop_assert!(made.torque_n_m.xy().norm() >= roomiest.torque_n_m.xy().norm() - 1e-9);
            // Without roll and pitch, yaw costs no more than its headroom.
            let turning = made_of(&Wrench { torque_n_m: Vector3::new(0.0, 0.0, z), ..wanted }, least);
            prop_assert!(turning.thrust_n >= asked - 0.15 * (strongest - weakest) - 1e-9);

            // Yaw never costs roll and pitch anything.
            let without_yaw = made_of(&level(thrust), least);
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
            prop_assert!(at_limit || (made.thrust_n - asked).abs() < 1e-9);
        }

        /// The torques that are said to be available are made, each for itself, and no more of yaw and thrust is lost.
        #[test]
        fn available_torques_are_made(thrust in 0.0..25.0, least in 0.0..25.0, axis in 0..3_usize) {
            let airframe = Airframe::default();
            let mixer = Mixer::new(&airframe).expect("a mixer");
            let available = mixer.available_torques_n_m(thrust, least);
            let mut torque_n_m = Vector3::zeros();
            torque_n_m[axis] = 100.0;
            let speeds = mixer.rotor_speeds_rad_s(&Wrench { thrust_n: thrust, torque_n_m }, least);
            let made = wrench_of_rotors(&airframe, &speeds).torque_n_m[axis];
            prop_assert!((made - available[axis]).abs() < 1e-9, "{made} {available:?}");
        }

        /// The room that is told is the room that the mixer makes: each end of the yaw range is made whole, beside the roll
        /// and pitch torques that it was told for, and nothing beyond, while the thrust is kept.
        #[test]
        fn the_yaw_range_is_made(
            thrust in 0.0..25.0, x in -2.0..2.0, y in -2.0..2.0, upper in prop::bool::ANY,
        ) {
            let airframe = Airframe::default();
            let mixer = Mixer::new(&airframe).expect("a mixer");
            // Roll and pitch that fit: those that do not take a part of the yaw with them.
            let tilt = mixer.tilting_thrusts_n(&Vector2::new(x, y)).map(f64::abs);
            let (down, up) = mixer.tilting_room_n((thrust, thrust));
            let fits = (0.9 * down.min(up) / tilt.into_iter().fold(0.0, f64::max)).min(1.0);
            let (x, y) = (fits * x, fits * y);
            let (low, high) = mixer.turning_range_n_m((thrust, thrust), &Vector2::new(x, y));
            prop_assert!(low <= 0.0 && high >= 0.0);
            let z = if upper { high } else { low };
            let made = |z: f64| {
                let wanted = Wrench { thrust_n: thrust, torque_n_m: Vector3::new(x, y, z) };
                wrench_of_rotors(&airframe, &mixer.rotor_speeds_rad_s(&wanted, thrust)).torque_n_m
            };
            prop_assert!((made(z).z - z).abs() < 1e-9, "{z}: {}", made(z));
            prop_assert!(made(100.0 * z.signum()).z.abs() <= z.abs() + 1e-9, "{z}: {}", made(100.0 * z.signum()));
        }

        /// What yaw has alone is what it has beside no roll and pitch.
        #[test]
        fn the_yaw_range_alone_is_that_beside_nothing(
            thrust in -5.0..30.0, least in 0.0..25.0, layout in 0..3_usize,
        ) {
            let layout = [RotorLayout::plus(), RotorLayout::x(), RotorLayout::h(1.5)][layout];
            let mixer = Mixer::new(&Airframe { layout, ..Airframe::default() }).expect("a mixer");
            let beside_nothing = mixer.turning_range_n_m((thrust, least), &Vector2::zeros());
            prop_assert_eq!(mixer.turning_range_alone_n_m((thrust, least)), beside_nothing);
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
                let again = mixer.rotor_speeds_rad_s(&wrench, 0.0);
                for (speed, repeated) in speeds.iter().zip(again) {
                    prop_assert!((speed - repeated).abs() < 1e-6, "{speeds:?} became {again:?}");
                }
            }
        }
    }
}
