//! What can be observed of the plant.

use nalgebra::{Scalar, Vector3};

use crate::plant::differentiation::real::Valued;
use crate::plant::events::branches::{Branches, ByValue};
use crate::plant::plant_state::zipped;
use crate::{BatteryOutput, Plant, PlantInputs, PlantState, Wrench};

/// The observable state of a plant under its inputs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlantOutputs<T = f64> {
    /// x, y, z in NED, m.
    pub position_m: Vector3<T>,
    /// Velocity in NED, m/s.
    pub velocity_m_s: Vector3<T>,
    /// Acceleration in NED, m/s².
    pub acceleration_m_s2: Vector3<T>,
    /// u, v, w: velocity in FRD, m/s.
    pub body_velocity_m_s: Vector3<T>,
    /// φ, θ, ψ (ZYX), rad; φ and ψ within ±π, θ within ±π/2. Their derivatives have no bound where θ approaches ±π/2.
    pub attitude_rad: Vector3<T>,
    /// Hamilton quaternion q₀ … q₃, scalar first, FRD into NED, as it was integrated: unit but for rounding after a step. It is not normalized
    /// once more, so that controllers which measure it go by the doubles of the state.
    pub quaternion: [T; 4],
    /// p, q, r in FRD, rad/s.
    pub body_rate_rad_s: Vector3<T>,
    /// F, τ_φ, τ_θ, τ_ψ of the four rotors about the centre of mass, without the torques of their spin; or those in their
    /// place.
    pub wrench: Wrench<T>,
    /// Speeds of the rotors in the order of the airframe's layout, rad/s.
    pub rotor_speed_rad_s: [T; 4],
    /// Voltage, current and charge of the battery.
    pub battery: BatteryOutput<T>,
}

impl<T: Scalar + Copy> PlantOutputs<T> {
    /// Made of each of its numbers.
    pub(crate) fn map<V: Scalar>(&self, f: impl Fn(T) -> V) -> PlantOutputs<V> {
        PlantOutputs {
            position_m: self.position_m.map(&f),
            velocity_m_s: self.velocity_m_s.map(&f),
            acceleration_m_s2: self.acceleration_m_s2.map(&f),
            body_velocity_m_s: self.body_velocity_m_s.map(&f),
            attitude_rad: self.attitude_rad.map(&f),
            quaternion: self.quaternion.map(&f),
            body_rate_rad_s: self.body_rate_rad_s.map(&f),
            wrench: self.wrench.zip_map(&self.wrench, |number, _| f(number)),
            rotor_speed_rad_s: zipped(&self.rotor_speed_rad_s, &self.rotor_speed_rad_s, |speed, _| f(speed)),
            battery: BatteryOutput {
                voltage_v: f(self.battery.voltage_v),
                current_a: f(self.battery.current_a),
                remaining: f(self.battery.remaining),
            },
        }
    }
}

impl Plant {
    /// What can be observed now. On the ground the vehicle does not accelerate along it while static friction holds it.
    pub fn outputs<T: Valued>(&self, state: &PlantState<T>, inputs: &PlantInputs<T>) -> PlantOutputs<T> {
        self.observed(state, inputs, self.is_held(state, inputs), &mut ByValue)
    }

    /// What can be observed, with the branches and the static friction chosen.
    pub(crate) fn observed<T: Valued>(
        &self,
        state: &PlantState<T>,
        inputs: &PlantInputs<T>,
        held: bool,
        branches: &mut impl Branches<T>,
    ) -> PlantOutputs<T> {
        let (body, airframe) = (&state.body, self.airframe());
        let forces = self.forces(state, inputs, branches);
        let mut acceleration_m_s2 = forces.acceleration_m_s2(self.mass(), state);
        if held {
            (acceleration_m_s2.x, acceleration_m_s2.y) = (T::zero(), T::zero());
        }
        let orientation = body.orientation();
        let [i, j, k, w] = body.attitude.coords.into();
        let power_w = airframe.electric_power_w(&state.rotor_speed_rad_s);
        PlantOutputs {
            position_m: body.position_m,
            velocity_m_s: body.velocity_m_s,
            acceleration_m_s2,
            body_velocity_m_s: orientation.in_body(&body.velocity_m_s),
            attitude_rad: orientation.euler_angles(),
            quaternion: [w, i, j, k],
            body_rate_rad_s: body.body_rate_rad_s,
            wrench: forces.wrench,
            rotor_speed_rad_s: state.rotor_speed_rad_s,
            battery: airframe.battery.output_in(power_w, state.discharge, branches),
        }
    }

    /// Thrust and torques about the centre of mass that drive the body now: those of the rotors, or the ones in their place.
    /// The torques of spinning rotors ([`RotorSpin`](crate::RotorSpin)) are not among them.
    pub fn wrench<T: Valued>(&self, state: &PlantState<T>, inputs: &PlantInputs<T>) -> Wrench<T> {
        self.loads(state, inputs, &mut ByValue).wrench
    }

    /// What the battery gives now.
    pub fn battery<T: Valued>(&self, state: &PlantState<T>) -> BatteryOutput<T> {
        let airframe = self.airframe();
        airframe.battery.output(airframe.electric_power_w(&state.rotor_speed_rad_s), state.discharge)
    }

    /// Acceleration in NED, m/s²; none along the ground while static friction holds the vehicle.
    pub fn acceleration_m_s2<T: Valued>(&self, state: &PlantState<T>, inputs: &PlantInputs<T>) -> Vector3<T> {
        let forces = self.forces(state, inputs, &mut ByValue);
        let acceleration = forces.acceleration_m_s2(self.mass(), state);
        if self.is_held(state, inputs) {
            Vector3::new(T::zero(), T::zero(), acceleration.z)
        } else {
            acceleration
        }
    }
}
