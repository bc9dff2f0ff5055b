//! What can be read of the plant.

use nalgebra::Vector3;
use quadrotor::{BatteryOutput, Dual, Plant, PlantInputs, PlantMode, PlantOutputs, PlantState, Valued};

use crate::tables::motion::Moving;

/// All outputs, and the time derivatives of the states; with [`Dual`] numbers, the derivatives of all that.
pub struct Observed<T: Valued = f64> {
    pub(super) outputs: PlantOutputs<T>,
    /// Drawn share of the battery's charge.
    pub(super) discharge: T,
    /// ẋ = f(x, u)
    pub(super) derivative: PlantState<T>,
}

impl<T: Valued> Observed<T> {
    /// In a mode.
    pub(super) fn in_mode(
        plant: &Plant,
        mode: PlantMode,
        state: &PlantState<T>,
        inputs: &PlantInputs<T>,
    ) -> Self {
        Self {
            outputs: plant.outputs_in(mode, state, inputs),
            discharge: state.discharge,
            derivative: plant.derivative_in(mode, state, inputs),
        }
    }

    /// In the mode that the state is in.
    pub(super) fn by_steps(
        plant: &Plant,
        mode: PlantMode,
        state: &PlantState<T>,
        inputs: &PlantInputs<T>,
    ) -> Self {
        Self { outputs: plant.outputs(state, inputs), ..Self::in_mode(plant, mode, state, inputs) }
    }
}

impl Observed<Dual> {
    /// The derivatives.
    pub(super) fn tangent(&self) -> Observed {
        Observed {
            outputs: self.outputs.tangent(),
            discharge: self.discharge.tangent,
            derivative: self.derivative.tangent(),
        }
    }
}

impl Moving for Observed {
    fn position_m(&self) -> Vector3<f64> {
        self.outputs.position_m
    }

    fn velocity_m_s(&self) -> Vector3<f64> {
        self.outputs.velocity_m_s
    }

    fn acceleration_m_s2(&self) -> Vector3<f64> {
        self.outputs.acceleration_m_s2
    }

    fn body_velocity_m_s(&self) -> Vector3<f64> {
        self.outputs.body_velocity_m_s
    }

    fn attitude_rad(&self) -> Vector3<f64> {
        self.outputs.attitude_rad
    }

    fn quaternion(&self) -> [f64; 4] {
        self.outputs.quaternion
    }

    fn body_rate_rad_s(&self) -> Vector3<f64> {
        self.outputs.body_rate_rad_s
    }

    fn thrust_n(&self) -> f64 {
        self.outputs.wrench.thrust_n
    }

    fn torque_n_m(&self) -> Vector3<f64> {
        self.outputs.wrench.torque_n_m
    }

    fn rotor_speed_rad_s(&self) -> [f64; 4] {
        self.outputs.rotor_speed_rad_s
    }

    fn battery(&self) -> BatteryOutput {
        self.outputs.battery
    }
}
