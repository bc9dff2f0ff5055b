//! Flight on the three rotors that are left: the thrust axis is steered, the heading is given up.

use nalgebra::{RowVector5, Vector3, Vector6};

use crate::design::reduced_attitude::{LEAN_RAD, ReducedAttitudeDesign};
use crate::plant::rotor_layout::RotorsAround;
use crate::{Airframe, Configuration, ConfigurationError, GRAVITY_M_S2, PositionReference, RigidBody};

/// Feedback of position, 1/s², and velocity, 1/s, on the way to the wanted acceleration.
const POSITION_GAIN: f64 = 0.3;
const VELOCITY_GAIN: f64 = 1.2;
const SINK_GAIN: f64 = 2.0;
/// Farther than this, m, a place pulls no harder.
const FARTHEST_M: f64 = 3.0;
/// Largest accelerations asked for, horizontal and vertical, m/s².
const HORIZONTAL_M_S2: f64 = 2.5;
const VERTICAL_M_S2: f64 = 2.0;
/// Without spin an opposite rotor that idles can only push, so that there is no control about one axis. Up to the first
/// spin rate, rad/s, only the thrust axis is righted, from the second on places are flown to …
const STEERABLE_SPIN_RAD_S: [f64; 2] = [0.5, 1.5];
/// … or from where the opposite rotor has so much of the weight to take back.
const STEERABLE_THRUST: f64 = 0.1;
/// A rotor that makes less than this share of the least that it is ever commanded to make does not turn any more: this law always lets
/// rotors idle at least.
const STANDING_SHARE: f64 = 0.25;
/// Thrust carries the vehicle while the vertical part of its axis is more than this.
const UPRIGHT: f64 = 0.5;
/// Range of the whole thrust, as a multiple of the weight.
const THRUST_RANGE: [f64; 2] = [0.3, 1.5];

/// The controller for the loss of one rotor. It remembers nothing: what it needs of the past is in the measured speeds of
/// the rotors.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RotorLossLaw {
    rotors: RotorsAround,
    /// Moments of inertia in the axes of the design, kg·m².
    inertia_kg_m2: [f64; 3],
    design: ReducedAttitudeDesign,
}

impl RotorLossLaw {
    /// For the loss of one rotor, by its index in the airframe's layout. What is `known` for other rotors of this configuration is not
    /// designed again: airframes are symmetric.
    ///
    /// # Errors
    /// [`ConfigurationError::Layout`] when the rotors are not opposite in pairs that turn the same way,
    /// [`ConfigurationError::Design`] when the airframe has no regulator.
    pub(crate) fn new(
        configuration: &Configuration,
        lost: usize,
        known: &[Self],
    ) -> Result<Self, ConfigurationError> {
        let airframe = &configuration.airframe;
        let rotors = airframe.layout.around(lost)?;
        let [jx, jy, jz] = airframe.inertia_kg_m2;
        let (x, y) = (rotors.towards.x * rotors.towards.x, rotors.towards.y * rotors.towards.y);
        let inertia_kg_m2 = [jx * x + jy * y, jx * y + jy * x, jz];
        let sample_time_s = configuration.controllers.attitude.sample_time_s();
        // All that the designs for one airframe differ in, bit for bit.
        let problem = |rotors: &RotorsAround, [jx, jy, jz]: [f64; 3]| {
            [rotors.distance, rotors.right.x, rotors.right.y, jx, jy, jz].map(f64::to_bits)
        };
        let wanted = problem(&rotors, inertia_kg_m2);
        let design = match known.iter().find(|law| problem(&law.rotors, law.inertia_kg_m2) == wanted) {
            Some(law) => law.design.clone(),
            None => ReducedAttitudeDesign::new(airframe, &rotors, inertia_kg_m2, sample_time_s).map_err(
                |source| ConfigurationError::Design { part: "controller for a lost rotor", source },
            )?,
        };
        Ok(Self { rotors, inertia_kg_m2, design })
    }

    /// Commanded rotor speeds, rad/s, from the vehicle's motion, the measured speeds and where it is asked to be; the
    /// heading is not looked at.
    pub(crate) fn step(
        &self,
        configuration: &Configuration,
        body: &RigidBody,
        rotor_speed_rad_s: &[f64; 4],
        reference: &PositionReference,
    ) -> [f64; 4] {
        let airframe = &configuration.airframe;
        let k1 = airframe.thrust_coefficient_n_s2;
        let (weakest, strongest) = airframe.thrust_range_n();
        let (weakest, strongest) = (weakest / 4.0, strongest / 4.0);
        let rate = self.turned(&body.body_rate_rad_s, true);
        let spin = rate.z;

        let [lost, right, opposite, left] =
            self.turned_rotors(rotor_speed_rad_s).map(|speed| k1 * speed * speed);
        let weight = airframe.weight_n();
        let (_, hovering) = self.trim(airframe, weight, lost, spin);
        let takeable = (hovering - weakest) / (STEERABLE_THRUST * weight);
        let stands = |thrust: f64| thrust < STANDING_SHARE * weakest;
        if stands(right) || stands(left) {
            return self.body_rotors(&[0.0, weakest, weakest, weakest].map(|newton| libm::sqrt(newton / k1)));
        }
        if stands(opposite) {
            let thrusts = self.pair_n(airframe, body, &rate, reference, left - right);
            return self.body_rotors(&thrusts.map(|newton| libm::sqrt(newton / k1)));
        }
        let [from, to] = STEERABLE_SPIN_RAD_S;
        let steerable = ((libm::fabs(spin) - from) / (to - from)).max(takeable).clamp(0.0, 1.0);
        let wanted = wanted_acceleration_m_s2(body, reference, steerable);
        // −F/m R e₃ = a − g e₃
        let thrust_axis = Vector3::new(0.0, 0.0, GRAVITY_M_S2) - wanted;
        let axis = self.turned(&(body.rotation().inverse() * thrust_axis.normalize()), false);
        let [least, most] = THRUST_RANGE;
        // Leaning, the rotors' thrust falls short by the cosine.
        let thrust =
            (airframe.mass_kg * thrust_axis.norm() / axis.z.max(0.5)).clamp(least * weight, most * weight);

        let (lean, trim) = self.trim(airframe, thrust, lost, spin);
        let trim = trim.max(weakest);
        let state = Vector6::new(
            axis.x - libm::sin(lean),
            axis.y,
            rate.x - spin * libm::tan(lean),
            rate.y,
            opposite - trim,
            left - right,
        );
        let command = self.design.command_n(spin, &state);
        let opposite = (trim + command.x).clamp(weakest, strongest);
        let side = ((thrust - opposite - lost) / 2.0).clamp(weakest, strongest);
        let room = (side - weakest).min(strongest - side);
        let half = (command.y / 2.0).clamp(-room, room);
        let thrusts = [0.0, side - half, opposite, side + half];
        self.body_rotors(&thrusts.map(|newton| libm::sqrt(newton / k1)))
    }

    /// Thrusts, N, when the opposite rotor is lost, too: the two that are left carry the vehicle down. Both drive the spin, which nothing
    /// brakes but the air; the thrust axis is righted by their difference, which the spin turns about all axes (Mueller and D'Andrea
    /// 2014), and places are given up.
    fn pair_n(
        &self,
        airframe: &Airframe,
        body: &RigidBody,
        rate_rad_s: &Vector3<f64>,
        reference: &PositionReference,
        difference_n: f64,
    ) -> [f64; 4] {
        let (weakest, strongest) = airframe.thrust_range_n();
        let (weakest, strongest) = (weakest / 4.0, strongest / 4.0);
        let up = self.turned(&(body.rotation().inverse() * Vector3::z()), false);
        let wanted = GRAVITY_M_S2 - wanted_acceleration_m_s2(body, reference, 0.0).z;
        // Lying on its side or on its back it is not carried.
        let share = if up.z > UPRIGHT { 1.0 / up.z } else { 0.0 };
        let side = (airframe.mass_kg * wanted * share / 2.0).clamp(weakest, strongest);
        let state = RowVector5::new(up.x, up.y, rate_rad_s.x, rate_rad_s.y, difference_n);
        let room = (side - weakest).min(strongest - side);
        let half = (self.design.pair_command_n(rate_rad_s.z, &state) / 2.0).clamp(-room, room);
        [0.0, side - half, 0.0, side + half]
    }

    /// Lean towards the lost rotor, rad, and thrust of the opposite one, N, in equilibrium: it leans so that the opposite
    /// rotor brakes the spin, or drives it if the lost one, stuck, brakes it more than it should.
    fn trim(&self, airframe: &Airframe, thrust_n: f64, lost_n: f64, spin_rad_s: f64) -> (f64, f64) {
        let [jx, _, jz] = self.inertia_kg_m2;
        let gyroscopic = jz - jx;
        let towards = ((thrust_n / 2.0 - 2.0 * lost_n) / (thrust_n / 8.0)).clamp(-1.0, 1.0);
        let lean = LEAN_RAD * towards * if gyroscopic < 0.0 { -1.0 } else { 1.0 };
        let distance_m = airframe.arm_length_m * self.rotors.distance;
        let trim = lost_n + gyroscopic * spin_rad_s * spin_rad_s * libm::tan(lean) / distance_m;
        (lean, trim)
    }

    /// A vector of body axes in the axes of the design; rates (`true`) are mirrored as such.
    fn turned(&self, vector: &Vector3<f64>, is_rate: bool) -> Vector3<f64> {
        let plane = self.rotors.turned(&vector.xy());
        match (self.rotors.mirrored, is_rate) {
            (true, true) => Vector3::new(-plane.x, -plane.y, -vector.z),
            _ => Vector3::new(plane.x, plane.y, vector.z),
        }
    }

    /// Values of the rotors in the order of the design: lost, right, opposite, left.
    fn turned_rotors(&self, rotors: &[f64; 4]) -> [f64; 4] {
        self.rotors.places.map(|place| rotors.get(place).copied().unwrap_or(0.0))
    }

    /// The inverse.
    fn body_rotors(&self, turned: &[f64; 4]) -> [f64; 4] {
        let mut rotors = [0.0; 4];
        for (place, value) in self.rotors.places.into_iter().zip(turned) {
            if let Some(rotor) = rotors.get_mut(place) {
                *rotor = *value;
            }
        }
        rotors
    }
}

/// Acceleration towards the reference, NED, m/s²; sideways the share that can be steered.
fn wanted_acceleration_m_s2(body: &RigidBody, reference: &PositionReference, steerable: f64) -> Vector3<f64> {
    let away = (reference.position_m - body.position_m).xy().cap_magnitude(FARTHEST_M);
    let error = (reference.velocity_m_s - body.velocity_m_s).xy();
    let horizontal = away * POSITION_GAIN + error * VELOCITY_GAIN;
    let horizontal = horizontal.cap_magnitude(steerable * HORIZONTAL_M_S2);
    let down = (reference.position_m.z - body.position_m.z) * POSITION_GAIN
        + (reference.velocity_m_s.z - body.velocity_m_s.z) * SINK_GAIN;
    Vector3::new(horizontal.x, horizontal.y, down.clamp(-VERTICAL_M_S2, VERTICAL_M_S2))
}
