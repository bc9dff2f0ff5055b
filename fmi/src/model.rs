//! The model behind the interface.

use std::any::Any;
use std::borrow::Cow;
use std::fmt::{Debug, Display};

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::continuous::Continuous;
use crate::variables::{Array, Quantity, Terminal, Variable};

/// Plain data that can be copied, compared, saved and read again.
pub trait Data: Clone + Debug + PartialEq + Serialize + DeserializeOwned {}

impl<T: Clone + Debug + PartialEq + Serialize + DeserializeOwned> Data for T {}

/// A model: its name, its variables and its behaviour over time.
///
/// A value of the type is one run: built from parameters and initial inputs, and stepped from time 0. This crate implements
/// the rest of the interface: it sets and gets variables, saves, restores and resets, and checks the order of calls.
pub trait Model: Sized + 'static {
    /// Names and texts of the model.
    const IDENTITY: Identity;

    /// The table of variables, in groups. A variable's value reference is its index over all groups, from 0.
    const VARIABLES: &'static [&'static [Variable<Self>]];

    /// The arrays of FMI 3.0, in groups: variables of the table that it reads and sets together.
    const ARRAYS: &'static [&'static [Array]] = &[];

    /// Quantities that the description lists first, in this order; others follow in the order in which variables use them.
    const QUANTITIES: &'static [&'static Quantity] = &[];

    /// The equations, if the model has continuous states: with them it supports model exchange and directional derivatives.
    const CONTINUOUS: Option<&'static dyn Continuous<Self>> = None;

    /// Time derivatives of the outputs at the present, under inputs that stay as they are; `None` if they are not available.
    /// Reading a variable from the result must give its derivative, as for [`Continuous::tangent`].
    const OUTPUT_RATES: Option<fn(&Self) -> Self::Outputs> = None;

    /// Groups of inputs and outputs that plug into those of other models.
    const TERMINALS: &'static [Terminal] = &[];

    /// Parameters: set before the run; tunable ones also during the run. The default has the start values.
    type Parameters: Data + Default;

    /// Inputs: set at communication points. The default has the start values.
    type Inputs: Data + Default;

    /// Everything that changes during a run, without what is computed from the parameters.
    type State: Data;

    /// Outputs: can be read at communication points.
    type Outputs;

    /// Why parameters or a state are rejected, or a run fails. It is logged as it is displayed.
    type Error: Display;

    /// The parameters as an importer reads them. A model some of whose parameters stand for others, as a preset does, overrides this to
    /// show the values that it runs with.
    fn as_read(parameters: &Self::Parameters) -> Cow<'_, Self::Parameters> {
        Cow::Borrowed(parameters)
    }

    /// A number that a variable cannot have and the range that it must be in, as the message says them. A model whose ranges are told
    /// elsewhere, too, overrides this to tell them alike.
    fn out_of_range(variable: &Variable<Self>, value: f64, minimum: f64, maximum: f64) -> (String, String) {
        variable.out_of_range(value, minimum, maximum)
    }

    /// What an instance holds from its instantiation until it is freed, whatever becomes of its runs: a share in what instances have in
    /// common, as the results of long calculations. What nobody holds any more must go: a library can be unloaded then.
    fn share() -> Box<dyn Any> {
        Box::new(())
    }

    /// A run at time 0.
    ///
    /// # Errors
    /// When the parameters are inconsistent; each alone is within its range.
    fn new(parameters: &Self::Parameters, inputs: &Self::Inputs) -> Result<Self, Self::Error>;

    /// A run that continues from a state of a run with the same parameters.
    ///
    /// # Errors
    /// As for [`Model::new`], and when no run can have been in this state: saved bytes may come from anywhere.
    fn from_state(parameters: &Self::Parameters, state: &Self::State) -> Result<Self, Self::Error>;

    /// The current state.
    fn state(&self) -> Self::State;

    /// The current time, µs since the start of the run.
    fn time_us(&self) -> u64;

    /// Advances to `time_us`, which is never before [`Model::time_us`] and may be equal to it: steps shorter than a
    /// microsecond add up. `inputs` returns the inputs at a time in µs; call it for any time within the step.
    ///
    /// # Errors
    /// When the run fails: it cannot be continued, or a number is no longer finite. The instance is then in the state "error", in which
    /// outputs can still be read: they are those of the point where the run failed.
    fn advance_to(&mut self, time_us: u64, inputs: &impl Fn(u64) -> Self::Inputs) -> Result<(), Self::Error>;

    /// As [`Model::advance_to`], with inputs that are constant within the step, as most are. A model whose inputs take time to copy can
    /// override this to read them in place.
    ///
    /// # Errors
    /// As for [`Model::advance_to`].
    fn advance_under(&mut self, time_us: u64, inputs: &Self::Inputs) -> Result<(), Self::Error> {
        self.advance_to(time_us, &|_| inputs.clone())
    }

    /// The outputs at the current time. An output that is not finite ends the run.
    fn outputs(&self) -> Self::Outputs;

    /// The same, of which real numbers that take long may be NaN, until [`Model::complete`] has calculated them: that happens when one of
    /// them is read.
    fn prompt_outputs(&self) -> Self::Outputs {
        self.outputs()
    }

    /// Completes what [`Model::prompt_outputs`] has left out, at the same time.
    fn complete(&self, _outputs: &mut Self::Outputs) {}

    /// Whether all outputs are finite, if the model can tell faster than by checking the variables one by one, which happens after
    /// `false`.
    fn are_finite(_outputs: &Self::Outputs) -> bool {
        false
    }

    /// Whether the model knows that its outputs at the current time are finite without calculating them. Then a step leaves them until they
    /// are read, and whatever is read is checked.
    fn is_sound(&self) -> bool {
        false
    }

    /// Applies new values of tunable parameters during the run; the others are unchanged.
    ///
    /// # Errors
    /// As for [`Model::new`]; nothing has changed then.
    fn retune(&mut self, parameters: &Self::Parameters) -> Result<(), Self::Error> {
        *self = Self::from_state(parameters, &self.state())?;
        Ok(())
    }

    /// Sets a state of a run with the same parameters as this one. A model that is costly to build can override this to
    /// avoid building it again.
    ///
    /// # Errors
    /// As for [`Model::from_state`]; nothing has changed then.
    fn restore(&mut self, parameters: &Self::Parameters, state: &Self::State) -> Result<(), Self::Error> {
        *self = Self::from_state(parameters, state)?;
        Ok(())
    }

    /// What its user should know about the parameters, which are accepted: a sentence each. They are logged as warnings when
    /// initialization ends, and when a change of parameters adds some.
    fn warnings(&self) -> Vec<String> {
        Vec::new()
    }

    /// What its user should know about a communication step of so many µs, before the run advances over it: a sentence. It is logged as
    /// a warning, once in a run.
    fn warning_of_step(&self, _step_us: u64) -> Option<String> {
        None
    }

    /// The message that is logged when initialization ends.
    fn initialized(&self) -> String {
        "initialized".to_owned()
    }
}

/// Names and texts of a model.
#[derive(Clone, Copy, Debug)]
pub struct Identity {
    /// `modelName`
    pub name: &'static str,
    /// `modelIdentifier`: the name that the library's file must have, without its extension.
    pub model_identifier: &'static str,
    /// Human-readable description.
    pub description: &'static str,
    /// Version of the model; part of the GUID.
    pub version: &'static str,
    /// `author`
    pub author: &'static str,
    /// `copyright`
    pub copyright: &'static str,
    /// Licence of the model.
    pub license: &'static str,
    /// `generationTool`
    pub generation_tool: &'static str,
    /// `generationDateAndTime`, ending in Z: a fixed one, so that the same sources give the same bytes.
    pub date: &'static str,
    /// The default experiment of the description.
    pub default_experiment: Experiment,
    /// The longest communication step that is accepted, s. A call of `DoStep` cannot be interrupted, so this bounds the
    /// time that it takes.
    pub longest_step_s: f64,
    /// How saved states begin.
    pub saved_state: SavedStateFormat,
    /// Terms for log messages about the model.
    pub words: Words,
}

/// A time span and the step in which it is simulated.
#[derive(Clone, Copy, Debug)]
pub struct Experiment {
    /// End, s; it starts at 0.
    pub stop_time_s: f64,
    /// Communication step, s.
    pub step_size_s: f64,
}

/// How serialized states of a model begin.
#[derive(Clone, Copy, Debug)]
pub struct SavedStateFormat {
    /// The first bytes.
    pub magic: [u8; 8],
    /// Raised whenever parameters, inputs or state change their layout; part of the GUID.
    pub version: u32,
}

/// Terms for log messages and log categories of a model.
#[derive(Clone, Copy, Debug)]
pub struct Words {
    /// A run: "simulation", "flight", …
    pub run: &'static str,
    /// Logged when a tunable parameter has changed.
    pub retuned: &'static str,
    /// Description of the log category of events.
    pub events: &'static str,
    /// Description of the log category of errors.
    pub errors: &'static str,
}

impl Words {
    /// Terms for any model.
    pub const GENERAL: Self = Self {
        run: "simulation",
        retuned: "parameters changed",
        events: "Initialization, changed parameters, reset",
        errors: "Rejected calls and failed simulations",
    };
}
