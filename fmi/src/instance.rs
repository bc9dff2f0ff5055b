//! One instance of the model: everything behind the interface, without a pointer.

use std::any::Any;

use crate::clock::Clock;
use crate::error::{CallError, SavedStateError};
use crate::finite_values::{check_calculated, check_outputs};
use crate::input_derivative::{Extrapolated, InputDerivative};
use crate::lifecycle::{Kind, Phase};
use crate::logger::Logger;
use crate::model::Model;
use crate::snapshot::{SettingsOf, Snapshot};

/// One instance.
///
/// Until initialization mode is left, the run is built when something is asked that needs it, and dropped
/// whenever a value is set. From then on it lives until the instance is reset.
pub(crate) struct Instance<M: Model> {
    pub logger: Logger,
    kind: Kind,
    phase: Phase,
    clock: Clock,
    pub(super) settings: SettingsOf<M>,
    pub(super) derivatives: Vec<InputDerivative>,
    /// The run; its parameters are those of `settings`.
    model: Option<Box<M>>,
    /// Outputs at the current time, if they were requested.
    pub(super) observed: Option<Observed<M::Outputs>>,
    last_step_failed: bool,
    /// Held as long as the instance is there.
    _share: Box<dyn Any>,
    /// Whether the length of a step has been warned of.
    warned_of_step: bool,
}

/// Outputs at the current time.
pub(super) struct Observed<O> {
    /// Those that take long may be missing: NaN.
    pub outputs: O,
    /// Whether none is missing.
    complete: bool,
}

impl<M: Model> Instance<M> {
    /// An instance with all values at their start values.
    pub fn new(kind: Kind, logger: Logger) -> Self {
        Self {
            logger,
            kind,
            phase: Phase::Instantiated,
            clock: Clock::default(),
            settings: SettingsOf::<M>::default(),
            derivatives: Vec::new(),
            model: None,
            observed: None,
            last_step_failed: false,
            _share: M::share(),
            warned_of_step: false,
        }
    }

    /// Its phase.
    pub fn phase(&self) -> Phase {
        self.phase
    }

    /// How its run is driven.
    pub(super) fn kind(&self) -> Kind {
        self.kind
    }

    /// Enters a phase of model exchange.
    pub(super) fn set_phase(&mut self, phase: Phase) {
        self.phase = phase;
    }

    /// Marks it as unusable after a panic.
    pub fn abandon(&mut self) {
        self.phase = Phase::Fatal;
    }

    /// The current time, s.
    pub fn time_s(&self) -> f64 {
        self.clock.communication_point_s()
    }

    pub fn setup_experiment(&mut self, start_s: f64, stop_s: Option<f64>) -> Result<(), CallError> {
        self.clock = Clock::new(start_s, stop_s)?;
        Ok(())
    }

    /// Sets the time, s, in model exchange.
    pub fn set_time(&mut self, time_s: f64) -> Result<(), CallError> {
        self.clock.set(time_s)
    }

    pub fn enter_initialization_mode(&mut self) -> Result<(), CallError> {
        self.phase = Phase::Initialization;
        Ok(())
    }

    /// Builds the run, which checks that the values are consistent. If it fails, initialization mode continues and other
    /// values can be set.
    pub fn exit_initialization_mode(&mut self) -> Result<(), CallError> {
        check_outputs::<M>(self.outputs()?)?;
        let model = self.model()?;
        let (message, warnings) = (model.initialized(), model.warnings());
        self.phase = match self.kind {
            Kind::CoSimulation => Phase::StepComplete,
            Kind::ModelExchange => Phase::EventMode,
        };
        self.logger.event(&message);
        warnings.iter().for_each(|warning| self.logger.warning(warning));
        Ok(())
    }

    pub fn terminate(&mut self) -> Result<(), CallError> {
        self.phase = Phase::Terminated;
        Ok(())
    }

    /// Returns to the state after instantiation; only the logger keeps its setting.
    pub fn reset(&mut self) -> Result<(), CallError> {
        self.phase = Phase::Instantiated;
        self.clock = Clock::default();
        self.settings = SettingsOf::<M>::default();
        self.derivatives.clear();
        self.model = None;
        self.observed = None;
        (self.last_step_failed, self.warned_of_step) = (false, false);
        self.logger.event("reset");
        Ok(())
    }

    /// Advances from one communication point to the next. Input derivatives apply to this step only.
    pub fn do_step(&mut self, point_s: f64, step_s: f64) -> Result<(), CallError> {
        let longest_s = M::IDENTITY.longest_step_s;
        let end =
            self.clock.step(point_s, step_s, longest_s).inspect_err(|_| self.last_step_failed = true)?;
        self.observed = None;
        let derivatives = std::mem::take(&mut self.derivatives);
        let model = built(&mut self.model, &self.settings)?;
        let step_us = end.time_us.saturating_sub(model.time_us());
        if !self.warned_of_step
            && let Some(warning) = model.warning_of_step(step_us)
        {
            self.logger.warning(&warning);
            self.warned_of_step = true;
        }
        let inputs = &self.settings.inputs;
        let outcome = if derivatives.is_empty() {
            model.advance_under(end.time_us, inputs)
        } else {
            let signal = Extrapolated::<M> { inputs, derivatives: &derivatives, begin_us: model.time_us() };
            model.advance_to(end.time_us, &|time_us| signal.at(time_us))
        };
        let outcome = outcome.map_err(|error| error.to_string()).and_then(|()| {
            if model.is_sound() {
                return Ok(());
            }
            let observed = self.observed.insert(Observed { outputs: model.outputs(), complete: true });
            check_outputs::<M>(&observed.outputs).map_err(|error| error.to_string())
        });
        match outcome {
            Ok(()) => {
                self.clock.advance_to(&end);
                self.last_step_failed = false;
                Ok(())
            }
            Err(error) => {
                self.phase = Phase::Error;
                self.last_step_failed = true;
                Err(CallError::of_step::<M>(error))
            }
        }
    }

    /// Whether the last step was rejected or failed.
    pub fn last_step_failed(&self) -> bool {
        self.last_step_failed
    }

    /// A copy of everything that changes.
    pub fn snapshot(&self) -> Snapshot<M> {
        Snapshot {
            kind: self.kind,
            phase: self.phase,
            clock: self.clock,
            settings: self.settings.clone(),
            derivatives: self.derivatives.clone(),
            run: self.model.as_ref().map(|model| model.state()),
        }
    }

    /// Restores a snapshot of this instance or another.
    pub fn restore(&mut self, snapshot: &Snapshot<M>) -> Result<(), CallError> {
        if snapshot.kind != self.kind {
            return Err(SavedStateError::OtherKind.into());
        }
        let parameters = &snapshot.settings.parameters;
        match (&snapshot.run, &mut self.model) {
            (None, model) => *model = None,
            // Nothing that follows from the parameters has to be built again.
            (Some(state), Some(model)) if self.settings.parameters == *parameters => {
                model.restore(parameters, state).map_err(CallError::of_model)?;
            }
            (Some(state), model) => {
                let restored = M::from_state(parameters, state).map_err(CallError::of_model)?;
                *model = Some(Box::new(restored));
            }
        }
        self.phase = snapshot.phase;
        self.clock = snapshot.clock;
        self.settings.clone_from(&snapshot.settings);
        self.derivatives.clone_from(&snapshot.derivatives);
        self.observed = None;
        self.last_step_failed = false;
        Ok(())
    }

    /// Applies new settings: all of them or, on an error, none.
    pub(super) fn commit(&mut self, settings: SettingsOf<M>) -> Result<(), CallError> {
        if self.phase.is_running() {
            if settings.parameters != self.settings.parameters {
                let known = self.model()?.warnings();
                let model = built(&mut self.model, &self.settings)?;
                retune(model, &self.settings.parameters, &settings.parameters)?;
                let warnings = model.warnings();
                self.observed = None;
                self.logger.event(M::IDENTITY.words.retuned);
                let new = warnings.iter().filter(|warning| !known.contains(warning));
                new.for_each(|warning| self.logger.warning(warning));
            }
            if self.kind == Kind::ModelExchange {
                self.observed = None;
            }
        } else {
            self.model = None;
            self.observed = None;
        }
        self.settings = settings;
        Ok(())
    }

    /// The run with the present settings.
    pub(super) fn model(&mut self) -> Result<&mut M, CallError> {
        built(&mut self.model, &self.settings)
    }

    /// Whether there is a run already.
    pub(super) fn has_run(&self) -> bool {
        self.model.is_some()
    }

    /// The outputs at the present.
    pub(super) fn outputs(&mut self) -> Result<&M::Outputs, CallError> {
        let (model, observed) = self.observe()?;
        if !observed.complete {
            model.complete(&mut observed.outputs);
            observed.complete = true;
        }
        Ok(&observed.outputs)
    }

    /// The same, of which those that take long may be missing, unless they have been asked for.
    pub(super) fn prompt_outputs(&mut self) -> Result<&M::Outputs, CallError> {
        Ok(&self.observe()?.1.outputs)
    }

    fn observe(&mut self) -> Result<(&M, &mut Observed<M::Outputs>), CallError> {
        let model = built(&mut self.model, &self.settings)?;
        let observed = self.observed.get_or_insert_with(|| match (self.kind, M::CONTINUOUS) {
            (Kind::ModelExchange, Some(equations)) => {
                Observed { outputs: equations.outputs(model, &self.settings.inputs), complete: true }
            }
            _ => Observed { outputs: model.prompt_outputs(), complete: false },
        });
        Ok((model, observed))
    }

    /// The run and its inputs.
    pub(super) fn run(&mut self) -> Result<(&mut M, &M::Inputs), CallError> {
        Ok((built(&mut self.model, &self.settings)?, &self.settings.inputs))
    }

    /// Outputs are calculated again when they are asked for.
    pub(super) fn forget_outputs(&mut self) {
        self.observed = None;
    }
}

/// The existing run, or a new one.
fn built<'a, M: Model>(
    model: &'a mut Option<Box<M>>,
    settings: &SettingsOf<M>,
) -> Result<&'a mut M, CallError> {
    let there = match model.take() {
        Some(there) => there,
        None => begun(settings)?,
    };
    Ok(model.insert(there))
}

/// A new run.
// Not within a step: the run is made on the stack, and each step would touch every page of the room for it.
#[cold]
#[inline(never)]
fn begun<M: Model>(settings: &SettingsOf<M>) -> Result<Box<M>, CallError> {
    let new = M::new(&settings.parameters, &settings.inputs).map_err(CallError::of_model)?;
    check_calculated(&new)?;
    Ok(Box::new(new))
}

/// Applies tunable parameters: all of them or, on an error, none.
fn retune<M: Model>(model: &mut M, old: &M::Parameters, new: &M::Parameters) -> Result<(), CallError> {
    let before = model.state();
    model.retune(new).map_err(CallError::of_model)?;
    check_calculated(model).or_else(|error| {
        *model = M::from_state(old, &before).map_err(CallError::of_model)?;
        Err(error)
    })
}
