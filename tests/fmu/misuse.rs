//! Every function in every state, against the table of FMI 2.0.4, section 4.2.4, written down again here.

use std::ptr;

use crate::common::instance::Instance;
use crate::common::library::{Component, DISCARD, ERROR, EventInfo, Library, OK, State as Saved, Status};
use crate::common::subject::Subject;

/// A state of the table that can be reached.
#[derive(Clone, Copy, Debug, PartialEq)]
enum State {
    Instantiated,
    Initialization,
    StepComplete,
    Terminated,
    Error,
    /// Of model exchange, as those below.
    EventMode,
    ContinuousTimeMode,
}

const STATES: [State; 7] = [
    State::Instantiated,
    State::Initialization,
    State::StepComplete,
    State::Terminated,
    State::Error,
    State::EventMode,
    State::ContinuousTimeMode,
];

impl State {
    fn is_of_exchange(self) -> bool {
        matches!(self, Self::EventMode | Self::ContinuousTimeMode)
    }

    /// An instance in this state.
    fn reached(self, subject: &'static Subject) -> Instance<'static> {
        if self.is_of_exchange() {
            let mut instance = Instance::for_model_exchange(subject);
            instance.initialize();
            if self == State::ContinuousTimeMode {
                assert_eq!(instance.enter_continuous_time_mode(), OK);
            }
            return instance;
        }
        let mut instance = Instance::new(subject);
        assert_eq!(instance.setup(0.0, Some(10.0)), OK);
        if self == State::Error {
            diverge(subject, &mut instance);
        } else if self != State::Instantiated {
            assert_eq!(instance.enter_initialization_mode(), OK);
            if self != State::Initialization {
                assert_eq!(instance.exit_initialization_mode(), OK);
                assert_eq!(instance.do_step(0.0, 0.1), OK);
                if self == State::Terminated {
                    assert_eq!(instance.terminate(), OK);
                }
            }
        }
        instance.log.take();
        instance
    }

    /// Checks that an instance is still in this state, by what only this state allows.
    fn is_kept_by(self, instance: &mut Instance) {
        match self {
            State::Instantiated => {
                assert_eq!(instance.setup(0.0, None), OK);
                assert_eq!(instance.enter_initialization_mode(), OK);
            }
            State::Initialization => {
                assert_eq!(instance.exit_initialization_mode(), OK);
                assert_eq!(instance.do_step(0.0, 0.1), OK);
            }
            State::StepComplete => assert_eq!(instance.do_step(0.1, 0.1), OK),
            State::EventMode => assert_eq!(instance.enter_continuous_time_mode(), OK),
            State::ContinuousTimeMode => assert_eq!(instance.set_continuous_states(&[0.0]), OK),
            State::Terminated | State::Error => {
                assert_eq!(instance.terminate(), ERROR);
                assert!(instance.try_reals(&[0]).is_ok());
            }
        }
    }
}

/// Runs until the model breaks.
fn diverge(subject: &Subject, instance: &mut Instance) {
    let [before, during] = subject.sample.breaking;
    assert_eq!(instance.set_real(before), OK);
    instance.initialize();
    assert_eq!(instance.set_real(during), OK);
    assert_eq!(instance.do_step(0.0, 5.0), ERROR);
    let message = instance.log.last();
    assert!(
        message.text.contains(&format!("the {} cannot continue", subject.sample.run)),
        "{}",
        message.text
    );
}

/// A function: its name, the states in which it is legal, what it then returns, and a harmless call.
type Row = (&'static str, &'static [State], Status, fn(&Library, Component, Saved) -> Status);

/// Marks of the table.
mod mark {
    use super::State::{
        self, ContinuousTimeMode, Error, EventMode, Initialization, Instantiated, StepComplete, Terminated,
    };

    pub const ALIVE: &[State] =
        &[Instantiated, Initialization, StepComplete, Terminated, Error, EventMode, ContinuousTimeMode];
    pub const BEFORE: &[State] = &[Instantiated];
    pub const DURING: &[State] = &[Initialization];
    pub const STEPPING: &[State] = &[StepComplete];
    pub const ENDED: &[State] = &[StepComplete, EventMode, ContinuousTimeMode];
    pub const SET: &[State] = &[Instantiated, Initialization, StepComplete, EventMode, ContinuousTimeMode];
    pub const GET: &[State] =
        &[Initialization, StepComplete, Terminated, Error, EventMode, ContinuousTimeMode];
    pub const EXCHANGE: &[State] = &[EventMode, ContinuousTimeMode];
    pub const EVENT: &[State] = &[EventMode];
    pub const CONTINUOUS: &[State] = &[ContinuousTimeMode];
    pub const STATUS: &[State] = &[StepComplete, Terminated, Error];
    pub const NEVER: &[State] = &[];
}

// SAFETY of every call below: the component is alive, arrays of length 0 may be NULL, other pointers are
// valid, and the saved state is one.
#[rustfmt::skip]
#[allow(clippy::undocumented_unsafe_blocks)]
const TABLE: [Row; 40] = [
    ("fmi2SetDebugLogging", mark::ALIVE, OK, |l, c, _| unsafe { (l.set_debug_logging)(c, 1, 0, ptr::null()) }),
    ("fmi2SetupExperiment", mark::BEFORE, OK, |l, c, _| unsafe { (l.setup_experiment)(c, 0, 0.0, 0.0, 0, 0.0) }),
    ("fmi2EnterInitializationMode", mark::BEFORE, OK, |l, c, _| unsafe { (l.enter_initialization_mode)(c) }),
    ("fmi2ExitInitializationMode", mark::DURING, OK, |l, c, _| unsafe { (l.exit_initialization_mode)(c) }),
    ("fmi2Terminate", mark::ENDED, OK, |l, c, _| unsafe { (l.terminate)(c) }),
    ("fmi2Reset", mark::ALIVE, OK, |l, c, _| unsafe { (l.reset)(c) }),
    ("fmi2GetReal", mark::GET, OK, |l, c, _| unsafe { (l.get_real)(c, ptr::null(), 0, ptr::null_mut()) }),
    ("fmi2GetInteger", mark::GET, OK, |l, c, _| unsafe { (l.get_integer)(c, ptr::null(), 0, ptr::null_mut()) }),
    ("fmi2GetBoolean", mark::GET, OK, |l, c, _| unsafe { (l.get_boolean)(c, ptr::null(), 0, ptr::null_mut()) }),
    ("fmi2GetString", mark::GET, OK, |l, c, _| unsafe { (l.get_string)(c, ptr::null(), 0, ptr::null_mut()) }),
    ("fmi2SetReal", mark::SET, OK, |l, c, _| unsafe { (l.set_real)(c, ptr::null(), 0, ptr::null()) }),
    ("fmi2SetInteger", mark::SET, OK, |l, c, _| unsafe { (l.set_integer)(c, ptr::null(), 0, ptr::null()) }),
    ("fmi2SetBoolean", mark::SET, OK, |l, c, _| unsafe { (l.set_boolean)(c, ptr::null(), 0, ptr::null()) }),
    ("fmi2SetString", mark::SET, OK, |l, c, _| unsafe { (l.set_string)(c, ptr::null(), 0, ptr::null()) }),
    ("fmi2GetFMUstate", mark::ALIVE, OK, |l, c, _| unsafe {
        let mut state = ptr::null_mut();
        let status = (l.get_state)(c, &mut state);
        (l.free_state)(c, &mut state);
        status
    }),
    ("fmi2SetFMUstate", mark::ALIVE, OK, |l, c, saved| unsafe { (l.set_state)(c, saved) }),
    ("fmi2FreeFMUstate", mark::ALIVE, OK, |l, c, _| unsafe { (l.free_state)(c, &mut ptr::null_mut()) }),
    ("fmi2SerializedFMUstateSize", mark::ALIVE, OK, |l, c, saved| unsafe { (l.serialized_state_size)(c, saved, &mut 0) }),
    ("fmi2SerializeFMUstate", mark::ALIVE, OK, |l, c, saved| unsafe {
        let mut size = 0;
        (l.serialized_state_size)(c, saved, &mut size);
        (l.serialize_state)(c, saved, vec![0; size].as_mut_ptr(), size)
    }),
    ("fmi2DeSerializeFMUstate", mark::ALIVE, OK, |l, c, saved| unsafe {
        let mut size = 0;
        (l.serialized_state_size)(c, saved, &mut size);
        let mut bytes = vec![0; size];
        (l.serialize_state)(c, saved, bytes.as_mut_ptr(), size);
        let mut state = ptr::null_mut();
        let status = (l.deserialize_state)(c, bytes.as_ptr(), size, &mut state);
        (l.free_state)(c, &mut state);
        status
    }),
    ("fmi2GetDirectionalDerivative", mark::GET, OK, |l, c, _| unsafe { (l.get_directional_derivative)(c, ptr::null(), 0, ptr::null(), 0, ptr::null(), ptr::null_mut()) }),
    ("fmi2SetRealInputDerivatives", mark::SET, OK, |l, c, _| unsafe { (l.set_input_derivatives)(c, ptr::null(), 0, ptr::null(), ptr::null()) }),
    ("fmi2GetRealOutputDerivatives", mark::STATUS, OK, |l, c, _| unsafe { (l.get_output_derivatives)(c, ptr::null(), 0, ptr::null(), ptr::null_mut()) }),
    ("fmi2EnterEventMode", mark::EXCHANGE, OK, |l, c, _| unsafe { (l.enter_event_mode)(c) }),
    ("fmi2NewDiscreteStates", mark::EVENT, OK, |l, c, _| unsafe { (l.new_discrete_states)(c, &mut EventInfo::default()) }),
    ("fmi2EnterContinuousTimeMode", mark::EVENT, OK, |l, c, _| unsafe { (l.enter_continuous_time_mode)(c) }),
    ("fmi2CompletedIntegratorStep", mark::CONTINUOUS, OK, |l, c, _| unsafe { (l.completed_integrator_step)(c, 1, &mut 0, &mut 0) }),
    ("fmi2SetTime", mark::EXCHANGE, OK, |l, c, _| unsafe { (l.set_time)(c, 0.5) }),
    ("fmi2SetContinuousStates", mark::CONTINUOUS, OK, |l, c, _| unsafe { (l.set_continuous_states)(c, &0.0, 1) }),
    ("fmi2GetDerivatives", mark::EXCHANGE, OK, |l, c, _| unsafe { (l.get_derivatives)(c, &mut 0.0, 1) }),
    ("fmi2GetEventIndicators", mark::EXCHANGE, OK, |l, c, _| unsafe { (l.get_event_indicators)(c, &mut 0.0, 1) }),
    ("fmi2GetContinuousStates", mark::EXCHANGE, OK, |l, c, _| unsafe { (l.get_continuous_states)(c, &mut 0.0, 1) }),
    ("fmi2GetNominalsOfContinuousStates", mark::EXCHANGE, OK, |l, c, _| unsafe { (l.get_nominals)(c, &mut 0.0, 1) }),
    ("fmi2DoStep", mark::STEPPING, OK, |l, c, _| unsafe { (l.do_step)(c, 0.1, 0.1, 1) }),
    ("fmi2CancelStep", mark::NEVER, OK, |l, c, _| unsafe { (l.cancel_step)(c) }),
    ("fmi2GetStatus", mark::STATUS, OK, |l, c, _| unsafe { (l.get_status)(c, 0, &mut 0) }),
    ("fmi2GetRealStatus", mark::STATUS, OK, |l, c, _| unsafe { (l.get_real_status)(c, 2, &mut 0.0) }),
    ("fmi2GetIntegerStatus", mark::STATUS, DISCARD, |l, c, _| unsafe { (l.get_integer_status)(c, 2, &mut 0) }),
    ("fmi2GetBooleanStatus", mark::STATUS, OK, |l, c, _| unsafe { (l.get_boolean_status)(c, 3, &mut 0) }),
    ("fmi2GetStringStatus", mark::STATUS, DISCARD, |l, c, _| unsafe { (l.get_string_status)(c, 1, &mut ptr::null()) }),
];

fn every_function_in_every_state(subject: &'static Subject) {
    // One state makes the table of functions good for any model: the lag has it.
    let exchanges = subject.description.derivatives.len() == 1;
    for state in STATES.into_iter().filter(|state| exchanges || !state.is_of_exchange()) {
        for (name, legal, answer, call) in TABLE {
            let differentiates =
                !subject.description.derivatives.is_empty() || name != "fmi2GetDirectionalDerivative";
            let legal = if differentiates { legal } else { mark::NEVER };
            let mut instance = state.reached(subject);
            let saved = instance.get_state();
            let status = call(instance.library, instance.component, saved);
            let log = instance.log.take();
            if legal.contains(&state) {
                assert_eq!(status, answer, "{name} in {state:?}: {log:?}");
            } else {
                assert_eq!(status, ERROR, "{name} in {state:?}");
                let [message] = log.as_slice() else { panic!("{name} in {state:?}: {log:?}") };
                assert!(message.text.starts_with(&format!("{name}: ")), "{}", message.text);
                state.is_kept_by(&mut instance);
            }
            // A lost state can be got back from a saved one, in whichever state it is set.
            assert_eq!(instance.set_state(saved), OK);
            state.is_kept_by(&mut instance);
            instance.free_state(saved);
        }
    }
}

fn no_instance_is_an_error(subject: &'static Subject) {
    for (name, _, _, call) in TABLE {
        // The calls that need a saved state ask the instance for it, and get nothing.
        assert_eq!(call(&subject.library, ptr::null_mut(), ptr::null_mut()), ERROR, "{name}");
    }
}

fn null_pointers_are_refused(subject: &'static Subject) {
    let mut instance = State::StepComplete.reached(subject);
    let (l, c) = (&subject.library, instance.component);
    let (n, nm) = (ptr::null(), ptr::null_mut());
    let saved = instance.get_state();
    // SAFETY: the instance is alive; NULL is what is tested.
    let statuses = unsafe {
        [
            (l.get_real)(c, ptr::null(), 1, &mut 0.0),
            (l.get_real)(c, &0, 1, ptr::null_mut()),
            (l.get_integer)(c, ptr::null(), 1, &mut 0),
            (l.get_integer)(c, &0, 1, ptr::null_mut()),
            (l.get_boolean)(c, ptr::null(), 1, &mut 0),
            (l.get_boolean)(c, &0, 1, ptr::null_mut()),
            (l.get_string)(c, ptr::null(), 1, &mut ptr::null()),
            (l.get_string)(c, &0, 1, ptr::null_mut()),
            (l.set_real)(c, ptr::null(), 1, &0.0),
            (l.set_real)(c, &1, 1, ptr::null()),
            (l.set_integer)(c, ptr::null(), 1, &0),
            (l.set_integer)(c, &1, 1, ptr::null()),
            (l.set_boolean)(c, ptr::null(), 1, &0),
            (l.set_boolean)(c, &1, 1, ptr::null()),
            (l.set_string)(c, ptr::null(), 1, &ptr::null()),
            (l.set_string)(c, &1, 1, ptr::null()),
            (l.get_state)(c, ptr::null_mut()),
            (l.set_state)(c, nm),
            (l.serialized_state_size)(c, nm, &mut 0),
            (l.serialized_state_size)(c, saved, ptr::null_mut()),
            (l.serialize_state)(c, nm, &mut 0, 1),
            (l.serialize_state)(c, saved, ptr::null_mut(), 1),
            (l.deserialize_state)(c, ptr::null(), 1, &mut ptr::null_mut()),
            (l.deserialize_state)(c, &0, 1, ptr::null_mut()),
            (l.set_input_derivatives)(c, ptr::null(), 1, &1, &0.0),
            (l.set_input_derivatives)(c, &1, 1, ptr::null(), &0.0),
            (l.set_input_derivatives)(c, &1, 1, &1, ptr::null()),
            (l.get_output_derivatives)(c, &9_999, 1, &1, &mut 0.0),
            (l.set_debug_logging)(c, 1, 1, ptr::null()),
            (l.set_debug_logging)(c, 1, 1, &n),
            (l.get_status)(c, 0, ptr::null_mut()),
            (l.get_real_status)(c, 2, ptr::null_mut()),
            (l.get_boolean_status)(c, 3, ptr::null_mut()),
        ]
    };
    for (place, status) in statuses.into_iter().enumerate() {
        assert_eq!(status, ERROR, "call {place}");
    }
    assert_eq!(instance.log.take().len(), statuses.len());
    // SAFETY: freeing nothing is allowed, both ways of saying it.
    unsafe {
        assert_eq!((l.free_state)(c, ptr::null_mut()), OK);
        assert_eq!((l.free_state)(c, &mut ptr::null_mut()), OK);
    }
    instance.free_state(saved);
    State::StepComplete.is_kept_by(&mut instance);
}

fn impossible_lengths_are_refused(subject: &'static Subject) {
    let mut instance = State::StepComplete.reached(subject);
    for count in [usize::MAX, usize::MAX / 8 + 1] {
        // SAFETY: the length is what is tested; it is refused before anything is read.
        let status = unsafe { (subject.library.get_real)(instance.component, &0, count, &mut 0.0) };
        assert_eq!(status, ERROR);
    }
    State::StepComplete.is_kept_by(&mut instance);
}

fn after_a_failed_run_only_reset_and_saved_states_help(subject: &'static Subject) {
    let mut instance = Instance::new(subject);
    let saved = instance.get_state();
    diverge(subject, &mut instance);
    assert_eq!(instance.do_step(0.0, 0.1), ERROR);
    assert_eq!(instance.set_state(saved), OK);
    instance.initialize();
    instance.fly(0.0, 0.1, 2);
    instance.free_state(saved);

    let mut instance = Instance::new(subject);
    diverge(subject, &mut instance);
    assert_eq!(instance.reset(), OK);
    instance.initialize();
    instance.fly(0.0, 0.1, 2);
}

for_each_model! {
    every_function_in_every_state,
    no_instance_is_an_error,
    null_pointers_are_refused,
    impossible_lengths_are_refused,
    after_a_failed_run_only_reset_and_saved_states_help,
}
