//! Controllers and plant under a master of two steps: one after the other, or both at once.

use fmi::Model;
use fmu::{
    AttitudeMeasurement, Controller, ControllerInputs, ControllerParameters, MeasuredMotion, Measurements,
    RotorSpeedMeasurement,
};
use quadrotor::{Configuration, Inputs, PlantInputs, PlantSimulation, PlantState};

/// What makes a flight the closed loop's, bit for bit.
pub const EXACT: Measurements =
    Measurements { attitude: AttitudeMeasurement::Quaternion, rotor_speeds: RotorSpeedMeasurement::Measured };

/// Parameters with these measurements.
pub fn exact(configuration: Configuration) -> ControllerParameters {
    ControllerParameters { configuration, measurements: EXACT }
}

/// In which order a master steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Order {
    /// The controllers first: the plant gets the command of the same step.
    GaussSeidel,
    /// At once: the plant gets the command of the step before.
    Jacobi,
}

/// Controllers and a plant that know nothing of each other.
pub struct Pair {
    pub controller: Controller,
    plant: PlantSimulation,
    /// Of the plant; what is changed here changes there.
    pub state: PlantState,
    order: Order,
}

/// What sensors without noise measure.
pub fn measured(state: &PlantState) -> MeasuredMotion {
    let body = &state.body;
    let (phi, theta, psi) = body.rotation().euler_angles();
    let q = &body.attitude;
    MeasuredMotion {
        position_m: body.position_m.into(),
        velocity_m_s: body.velocity_m_s.into(),
        quaternion: [q.w, q.i, q.j, q.k],
        attitude_rad: [phi, theta, psi],
        body_rate_rad_s: body.body_rate_rad_s.into(),
        rotor_speed_rad_s: state.rotor_speed_rad_s,
    }
}

/// What the controllers get of the closed loop's inputs.
pub fn with_measured(inputs: &Inputs, measured: MeasuredMotion) -> ControllerInputs {
    let Inputs { reference, armed, ground_z_m, .. } = *inputs;
    ControllerInputs { reference, armed, measured, ground_z_m }
}

/// Where a plant begins by its configuration.
pub fn start_of(configuration: &Configuration, armed: bool) -> PlantState {
    let initial = &configuration.initial;
    if armed { PlantState::hovering(initial, &configuration.airframe) } else { PlantState::at_rest(initial) }
}

impl Pair {
    pub fn new(parameters: &ControllerParameters, inputs: &Inputs, order: Order) -> Self {
        let state = start_of(&parameters.configuration, inputs.armed);
        let plant = PlantSimulation::new(&parameters.configuration, &state, &PlantInputs::default()).unwrap();
        let controller = Controller::new(parameters, &with_measured(inputs, measured(&state))).unwrap();
        Self { controller, plant, state, order }
    }

    /// One communication step, with inputs that are held over it.
    pub fn step(&mut self, step_us: u64, inputs: &Inputs) {
        let (begin_us, before) = (self.controller.time_us(), self.controller.outputs());
        let held = with_measured(inputs, measured(&self.state));
        self.controller.advance_to(begin_us + step_us, &|_| held).unwrap();
        let outputs = if self.order == Order::Jacobi { before } else { self.controller.outputs() };
        self.drive(begin_us, step_us, inputs, outputs.rotor_command_rad_s);
    }

    /// A first step in which the plant has no command yet.
    pub fn step_without_command(&mut self, step_us: u64, inputs: &Inputs) {
        let held = with_measured(inputs, measured(&self.state));
        self.controller.advance_to(step_us, &|_| held).unwrap();
        self.drive(0, step_us, inputs, [0.0; 4]);
    }

    fn drive(&mut self, begin_us: u64, step_us: u64, inputs: &Inputs, command_rad_s: [f64; 4]) {
        let acting =
            PlantInputs { disturbance: inputs.disturbance, ..PlantInputs::rotor_speeds(command_rad_s) };
        if self.plant.plant_state() != self.state {
            self.plant.set_plant_state(&self.state);
        }
        self.plant.advance_to(begin_us + step_us, &|_| acting).unwrap();
        self.state = self.plant.plant_state();
    }
}
