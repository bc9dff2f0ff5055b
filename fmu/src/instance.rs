//! One instance of the model: everything behind the interface, without a pointer.

use quadrotor::{CascadeDesign, Outputs, Simulation};

use crate::clock::Clock;
use crate::error::CallError;
use crate::input_derivative::{Extrapolated, InputDerivative};
use crate::lifecycle::State;
use crate::logger::Logger;
use crate::snapshot::{Settings, Snapshot};
use crate::types::{DO_STEP_STATUS, LAST_SUCCESSFUL_TIME, Status, StatusKind, TERMINATED};

/// One instance.
///
/// Until initialization mode is left, the flight is built when something is asked that needs it, and
/// dropped whenever a value is set. From then on it lives until `fmi2Reset`.
pub(crate) struct Instance {
    pub(crate) logger: Logger,
    state: State,
    clock: Clock,
    pub(super) settings: Settings,
    pub(super) derivatives: Vec<InputDerivative>,
    simulation: Option<Box<Simulation>>,
    /// Of the flight where it is, once they were asked for.
    outputs: Option<Outputs>,
    step_status: Status,
}

impl Instance {
    /// An instance with all values at their start values.
    pub fn new(logger: Logger) -> Self {
        Self {
            logger,
            state: State::Instantiated,
            clock: Clock::default(),
            settings: Settings::default(),
            derivatives: Vec::new(),
            simulation: None,
            outputs: None,
            step_status: Status::Ok,
        }
    }

    /// Where it is in its lifecycle.
    pub fn state(&self) -> State {
        self.state
    }

    /// Gives it up after a panic.
    pub fn abandon(&mut self) {
        self.state = State::Fatal;
    }

    /// The present, s.
    pub fn time_s(&self) -> f64 {
        self.clock.communication_point_s()
    }

    pub fn setup_experiment(
        &mut self,
        tolerance: Option<f64>,
        start_s: f64,
        stop_s: Option<f64>,
    ) -> Result<(), CallError> {
        self.clock = Clock::new(start_s, stop_s)?;
        if tolerance.is_some() {
            self.logger.warning("the tolerance is ignored: the integration step is fixed");
        }
        Ok(())
    }

    pub fn enter_initialization_mode(&mut self) -> Result<(), CallError> {
        self.state = State::Initialization;
        Ok(())
    }

    /// Checks the values against one another and designs the controllers. When that fails, initialization
    /// mode goes on and other values can be set.
    pub fn exit_initialization_mode(&mut self) -> Result<(), CallError> {
        let reports = self.design()?.reports();
        self.state = State::StepComplete;
        let radii = reports.map(|(name, report)| format!("{name} {:.4}", report.spectral_radius));
        self.logger.event(&format!("initialized; spectral radii of the closed loops: {}", radii.join(", ")));
        Ok(())
    }

    pub fn terminate(&mut self) -> Result<(), CallError> {
        self.state = State::Terminated;
        Ok(())
    }

    /// Back to where it was after instantiation; only the logger keeps its setting.
    pub fn reset(&mut self) -> Result<(), CallError> {
        self.state = State::Instantiated;
        self.clock = Clock::default();
        self.settings = Settings::default();
        self.derivatives.clear();
        self.simulation = None;
        self.outputs = None;
        self.step_status = Status::Ok;
        self.logger.event("reset");
        Ok(())
    }

    /// Flies from one communication point to the next. The derivatives of inputs hold for this one step.
    pub fn do_step(&mut self, point_s: f64, step_s: f64) -> Result<(), CallError> {
        let end = self.clock.step(point_s, step_s).inspect_err(|error| self.step_status = error.status())?;
        self.outputs = None;
        let (inputs, derivatives) = (self.settings.inputs, std::mem::take(&mut self.derivatives));
        let simulation = self.simulation()?;
        let flown = if derivatives.is_empty() {
            simulation.advance_to(end.time_us, &inputs)
        } else {
            let begin_us = simulation.time_us();
            let signal = Extrapolated { inputs: &inputs, derivatives: &derivatives, begin_us };
            simulation.advance_to(end.time_us, &signal)
        };
        match flown {
            Ok(()) => {
                self.clock.advance_to(&end);
                self.step_status = Status::Ok;
                Ok(())
            }
            Err(error) => {
                self.state = State::Error;
                self.step_status = Status::Error;
                Err(error.into())
            }
        }
    }

    pub fn status(&self, kind: StatusKind) -> Result<Status, CallError> {
        if kind == DO_STEP_STATUS { Ok(self.step_status) } else { Err(CallError::NoStatus { kind }) }
    }

    pub fn real_status(&self, kind: StatusKind) -> Result<f64, CallError> {
        if kind == LAST_SUCCESSFUL_TIME { Ok(self.time_s()) } else { Err(CallError::NoStatus { kind }) }
    }

    /// `fmi2Terminated`: whether the model wants to end the simulation. It never does.
    pub fn boolean_status(&self, kind: StatusKind) -> Result<bool, CallError> {
        if kind == TERMINATED { Ok(false) } else { Err(CallError::NoStatus { kind }) }
    }

    /// A copy of everything that changes.
    pub fn snapshot(&self) -> Snapshot {
        Snapshot {
            state: self.state,
            clock: self.clock,
            settings: self.settings,
            derivatives: self.derivatives.clone(),
            simulation: self.simulation.as_ref().map(|simulation| simulation.state()),
        }
    }

    /// Goes to where the snapshot was taken, in this instance or another.
    pub fn restore(&mut self, snapshot: &Snapshot) -> Result<(), CallError> {
        let configuration = &snapshot.settings.configuration;
        match (snapshot.simulation, &mut self.simulation) {
            (None, simulation) => *simulation = None,
            // The controllers are the same: no need to design them again.
            (Some(flight), Some(simulation)) if simulation.configuration() == configuration => {
                simulation.restore(flight)?;
            }
            (Some(flight), simulation) => {
                *simulation = Some(Box::new(Simulation::from_state(configuration, flight)?));
            }
        }
        self.state = snapshot.state;
        self.clock = snapshot.clock;
        self.settings = snapshot.settings;
        self.derivatives.clone_from(&snapshot.derivatives);
        self.outputs = None;
        self.step_status = Status::Ok;
        Ok(())
    }

    /// Makes new settings the present ones; all of them or, on an error, none.
    pub(super) fn commit(&mut self, settings: &Settings) -> Result<(), CallError> {
        if self.state == State::StepComplete {
            if settings.configuration != self.settings.configuration {
                self.simulation()?.reconfigure(&settings.configuration)?;
                self.outputs = None;
                self.logger.event("parameters changed, controllers redesigned");
            }
        } else {
            self.simulation = None;
            self.outputs = None;
        }
        self.settings = *settings;
        Ok(())
    }

    /// The controllers of the present settings.
    pub(super) fn design(&mut self) -> Result<&CascadeDesign, CallError> {
        Ok(self.simulation()?.design())
    }

    /// The outputs at the present.
    pub(super) fn outputs(&mut self) -> Result<&Outputs, CallError> {
        let simulation = built(&mut self.simulation, &self.settings)?;
        Ok(self.outputs.get_or_insert_with(|| simulation.outputs()))
    }

    fn simulation(&mut self) -> Result<&mut Simulation, CallError> {
        built(&mut self.simulation, &self.settings)
    }
}

/// The flight that is there, or a new one.
fn built<'a>(
    simulation: &'a mut Option<Box<Simulation>>,
    settings: &Settings,
) -> Result<&'a mut Simulation, CallError> {
    let there = match simulation.take() {
        Some(there) => there,
        None => Box::new(Simulation::new(&settings.configuration, &settings.inputs)?),
    };
    Ok(simulation.insert(there))
}
