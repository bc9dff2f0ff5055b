//! What the attitude controller keeps within: the thrusts of the four rotors.

use alloc::vec::Vec;

use lmpc::SignalLimit;
use nalgebra::{DMatrix, Vector2, Vector3};

use crate::design::attitude_design::AXIS_STATES;
use crate::design::capacities::{LEAN_BOUNDS, TURN_BOUNDS};
use crate::{Airframe, Mixer};

/// The commanded angular accelerations about roll and pitch, rad/s², at some samples: how far each rotor's thrust may differ
/// from the mean, N, up and down.
pub(crate) fn lean_limits(airframe: &Airframe, mixer: &Mixer, samples: &[usize]) -> [SignalLimit; 1] {
    let [roll, pitch, _] = airframe.inertia_kg_m2;
    let by_roll = mixer.tilting_thrusts_n(&Vector2::new(roll, 0.0));
    let by_pitch = mixer.tilting_thrusts_n(&Vector2::new(0.0, pitch));
    let directions = DMatrix::from_fn(LEAN_BOUNDS, 2, |bound, axis| {
        let rotor = bound % 4;
        let thrust_n = if axis == 0 { by_roll[rotor] } else { by_pitch[rotor] };
        if bound < 4 { thrust_n } else { -thrust_n }
    });
    let (weakest, strongest) = airframe.thrust_range_n();
    let limit = SignalLimit::of_inputs(2 * AXIS_STATES, 2, directions, samples.to_vec());
    [limit.giving_way_by((strongest - weakest) / 8.0)]
}

/// The commanded angular acceleration about yaw, rad/s²: at this sample what roll and pitch leave, and later on what the
/// rotors can do about yaw alone.
pub(crate) fn turn_limits(airframe: &Airframe, mixer: &Mixer, samples: &[usize]) -> [SignalLimit; 2] {
    let (present, later): (Vec<_>, Vec<_>) = samples.iter().copied().partition(|sample| *sample == 0);
    let (weakest, strongest) = airframe.thrust_range_n();
    let [_, _, yaw_n_m] = mixer.largest_torques_n_m((strongest - weakest) / 8.0);
    [present, later].map(|samples| {
        SignalLimit::of_inputs(AXIS_STATES, 1, SignalLimit::range(1), samples)
            .giving_way_by(yaw_n_m / airframe.inertia_kg_m2[2])
    })
}

/// What the rotors have room for at one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RotorRoom<'a> {
    pub(crate) mixer: &'a Mixer,
    /// Thrust asked for and the least that it may be reduced to for the torques, N.
    pub(crate) thrust_n: (f64, f64),
    /// Torque that is needed beside the commanded angular accelerations, FRD, N·m.
    pub(crate) other_n_m: Vector3<f64>,
    /// Inertia that the controllers believe in, kg·m².
    pub(crate) inertia_kg_m2: Vector3<f64>,
    /// That as a multiple of the airframe's.
    pub(crate) believed: f64,
}

impl RotorRoom<'_> {
    /// What of an answer about roll and pitch, rad/s², the rotors have room for beside what is planned, rad/s².
    pub(crate) fn lean_beside(
        &self,
        planned_rad_s2: &Vector2<f64>,
        answer_rad_s2: &Vector2<f64>,
    ) -> Vector2<f64> {
        // Mostly there is nothing to answer.
        if *answer_rad_s2 == Vector2::zeros() {
            return *answer_rad_s2;
        }
        let (down_n, up_n) = self.mixer.tilting_room_n(self.thrust_n);
        let taken_n = self.mixer.tilting_thrusts_n(&self.tilting_n_m(planned_rad_s2));
        let more_n = self.mixer.tilting_thrusts_n(&answer_rad_s2.component_mul(&self.inertia_kg_m2.xy()));
        let shares = taken_n.iter().zip(&more_n).map(|(taken, more)| {
            let room = if *more > 0.0 { up_n - taken } else { down_n + taken };
            let size = libm::fabs(*more);
            if size <= room { 1.0 } else { room.max(0.0) / size }
        });
        answer_rad_s2 * shares.fold(1.0, f64::min)
    }

    /// Torque about roll and pitch for commanded angular accelerations, rad/s², with what is needed beside them, N·m.
    fn tilting_n_m(&self, lean_rad_s2: &Vector2<f64>) -> Vector2<f64> {
        lean_rad_s2.component_mul(&self.inertia_kg_m2.xy()) + self.other_n_m.xy()
    }

    /// Values of [`lean_limits`]. Thrust gives way to roll and pitch.
    pub(crate) fn lean_bounds(&self) -> [f64; LEAN_BOUNDS] {
        let (down_n, up_n) = self.mixer.tilting_room_n(self.thrust_n);
        let taken = self.mixer.tilting_thrusts_n(&self.other_n_m.xy());
        core::array::from_fn(|bound| {
            let taken = taken[bound % 4];
            (if bound < 4 { up_n - taken } else { down_n + taken }) / self.believed
        })
    }

    /// Values of [`turn_limits`], beside the angular accelerations about roll and pitch that are commanded, rad/s².
    ///
    /// The angular acceleration that the reference requires of yaw, rad/s², is counted on to pass: it follows from leans that go to and
    /// fro. A plan that took it to last would see no room on one side, and not begin what it could not brake.
    pub(crate) fn turn_bounds(
        &self,
        lean_rad_s2: &Vector2<f64>,
        reference_rad_s2: f64,
    ) -> [f64; TURN_BOUNDS] {
        let present = self.mixer.turning_range_n_m(self.thrust_n, &self.tilting_n_m(lean_rad_s2));
        let alone = self.mixer.turning_range_alone_n_m(self.thrust_n);
        let acceleration = |torque_n_m: f64| (torque_n_m - self.other_n_m.z) / self.inertia_kg_m2.z;
        let later = (acceleration(alone.0) + reference_rad_s2, acceleration(alone.1) + reference_rad_s2);
        [acceleration(present.1), -acceleration(present.0), later.1, -later.0]
    }
}
