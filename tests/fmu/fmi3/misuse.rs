//! Every function in every state, against the states of FMI 3.0.2, sections 2.3, 3.2 and 4.2, written down again here.
//!
//! The oscillator is the model: it has both kinds and derivatives.

use std::collections::BTreeSet;
use std::ptr;

use super::oscillator;
use crate::common::fmi3::instance::Instance;
use crate::common::fmi3::library::{
    ERROR, Instance as Pointer, Library, OK, SYMBOLS, State as Saved, Status,
};

/// A state of an instance.
#[derive(Clone, Copy, Debug, PartialEq)]
enum State {
    Instantiated,
    Initialization,
    StepMode,
    Terminated,
    /// Of model exchange, as those below.
    ExchangeInstantiated,
    ExchangeInitialization,
    EventMode,
    ContinuousTimeMode,
    ExchangeTerminated,
}

use State::*;

const STATES: [State; 9] = [
    Instantiated,
    Initialization,
    StepMode,
    Terminated,
    ExchangeInstantiated,
    ExchangeInitialization,
    EventMode,
    ContinuousTimeMode,
    ExchangeTerminated,
];

impl State {
    fn is_of_exchange(self) -> bool {
        !matches!(self, Instantiated | Initialization | StepMode | Terminated)
    }

    /// An instance in this state.
    fn reached(self) -> Instance {
        let subject = oscillator();
        let exchanged = self.is_of_exchange();
        let mut instance =
            if exchanged { Instance::for_model_exchange(subject) } else { Instance::new(subject) };
        if !matches!(self, Instantiated | ExchangeInstantiated) {
            assert_eq!(instance.enter_initialization_mode(0.0, Some(10.0)), OK);
        }
        if matches!(self, StepMode | Terminated | EventMode | ContinuousTimeMode | ExchangeTerminated) {
            assert_eq!(instance.exit_initialization_mode(), OK);
        }
        match self {
            StepMode => assert_eq!(instance.do_step(0.0, 0.1).0, OK),
            ContinuousTimeMode => assert_eq!(instance.enter_continuous_time_mode(), OK),
            Terminated | ExchangeTerminated => assert_eq!(instance.terminate(), OK),
            _ => {}
        }
        instance.log.take();
        instance
    }

    /// Checks that an instance is still in this state, by what only this state allows.
    fn is_kept_by(self, instance: &mut Instance) {
        match self {
            Instantiated | ExchangeInstantiated => {
                assert_eq!(instance.enter_initialization_mode(0.0, None), OK);
            }
            Initialization | ExchangeInitialization => assert_eq!(instance.exit_initialization_mode(), OK),
            StepMode => assert_eq!(instance.do_step(0.1, 0.1).0, OK),
            EventMode => assert_eq!(instance.enter_continuous_time_mode(), OK),
            ContinuousTimeMode => assert_eq!(instance.set_continuous_states(&[0.0, 0.0]), OK),
            Terminated | ExchangeTerminated => {
                assert_eq!((instance.terminate(), instance.set(&[], &[])), (ERROR, ERROR));
                assert_eq!(instance.try_values(&[], 0), Ok(vec![]));
            }
        }
    }
}

/// A function: its name, the states in which it is legal, what it then returns, and a harmless call.
type Row = (&'static str, &'static [State], Status, fn(&Library, Pointer, Saved) -> Status);

/// Marks of the table.
mod mark {
    use super::State::{self, *};

    pub const ALIVE: &[State] = &super::STATES;
    pub const BEFORE: &[State] = &[Instantiated, ExchangeInstantiated];
    pub const DURING: &[State] = &[Initialization, ExchangeInitialization];
    pub const STEPPING: &[State] = &[StepMode];
    pub const ENDED: &[State] = &[StepMode, EventMode, ContinuousTimeMode];
    pub const SET: &[State] = &[
        Instantiated,
        Initialization,
        StepMode,
        ExchangeInstantiated,
        ExchangeInitialization,
        EventMode,
        ContinuousTimeMode,
    ];
    pub const GET: &[State] = ALIVE;
    pub const EVALUATED: &[State] = &[
        Initialization,
        StepMode,
        Terminated,
        ExchangeInitialization,
        EventMode,
        ContinuousTimeMode,
        ExchangeTerminated,
    ];
    pub const EXCHANGE: &[State] = &[EventMode, ContinuousTimeMode];
    pub const EVENT: &[State] = &[EventMode];
    pub const CONTINUOUS: &[State] = &[ContinuousTimeMode];
    pub const SOLVED: &[State] = &[ExchangeInitialization, EventMode, ContinuousTimeMode, ExchangeTerminated];
    pub const COUNTED: &[State] =
        &[ExchangeInstantiated, ExchangeInitialization, EventMode, ContinuousTimeMode, ExchangeTerminated];
    pub const STEPPED: &[State] = &[StepMode, Terminated, ExchangeTerminated];
}

// SAFETY of every call below: the instance is alive, arrays of length 0 may be NULL, other pointers are
// valid, and the saved state is one.
#[rustfmt::skip]
#[allow(clippy::undocumented_unsafe_blocks)]
const TABLE: [Row; 70] = [
    ("fmi3SetDebugLogging", mark::ALIVE, OK, |l, c, _| unsafe { (l.set_debug_logging)(c, true, 0, ptr::null()) }),
    ("fmi3EnterInitializationMode", mark::BEFORE, OK, |l, c, _| unsafe { (l.enter_initialization_mode)(c, false, 0.0, 0.0, false, 0.0) }),
    ("fmi3ExitInitializationMode", mark::DURING, OK, |l, c, _| unsafe { (l.exit_initialization_mode)(c) }),
    ("fmi3EnterEventMode", mark::EXCHANGE, OK, |l, c, _| unsafe { (l.enter_event_mode)(c) }),
    ("fmi3Terminate", mark::ENDED, OK, |l, c, _| unsafe { (l.terminate)(c) }),
    ("fmi3Reset", mark::ALIVE, OK, |l, c, _| unsafe { (l.reset)(c) }),
    ("fmi3GetFloat32", mark::GET, OK, |l, c, _| unsafe { (l.get_float32)(c, ptr::null(), 0, ptr::null_mut(), 0) }),
    ("fmi3SetFloat32", mark::SET, OK, |l, c, _| unsafe { (l.set_float32)(c, ptr::null(), 0, ptr::null(), 0) }),
    ("fmi3GetFloat64", mark::GET, OK, |l, c, _| unsafe { (l.get_float64)(c, ptr::null(), 0, ptr::null_mut(), 0) }),
    ("fmi3SetFloat64", mark::SET, OK, |l, c, _| unsafe { (l.set_float64)(c, ptr::null(), 0, ptr::null(), 0) }),
    ("fmi3GetInt8", mark::GET, OK, |l, c, _| unsafe { (l.get_int8)(c, ptr::null(), 0, ptr::null_mut(), 0) }),
    ("fmi3SetInt8", mark::SET, OK, |l, c, _| unsafe { (l.set_int8)(c, ptr::null(), 0, ptr::null(), 0) }),
    ("fmi3GetUInt8", mark::GET, OK, |l, c, _| unsafe { (l.get_uint8)(c, ptr::null(), 0, ptr::null_mut(), 0) }),
    ("fmi3SetUInt8", mark::SET, OK, |l, c, _| unsafe { (l.set_uint8)(c, ptr::null(), 0, ptr::null(), 0) }),
    ("fmi3GetInt16", mark::GET, OK, |l, c, _| unsafe { (l.get_int16)(c, ptr::null(), 0, ptr::null_mut(), 0) }),
    ("fmi3SetInt16", mark::SET, OK, |l, c, _| unsafe { (l.set_int16)(c, ptr::null(), 0, ptr::null(), 0) }),
    ("fmi3GetUInt16", mark::GET, OK, |l, c, _| unsafe { (l.get_uint16)(c, ptr::null(), 0, ptr::null_mut(), 0) }),
    ("fmi3SetUInt16", mark::SET, OK, |l, c, _| unsafe { (l.set_uint16)(c, ptr::null(), 0, ptr::null(), 0) }),
    ("fmi3GetInt32", mark::GET, OK, |l, c, _| unsafe { (l.get_int32)(c, ptr::null(), 0, ptr::null_mut(), 0) }),
    ("fmi3SetInt32", mark::SET, OK, |l, c, _| unsafe { (l.set_int32)(c, ptr::null(), 0, ptr::null(), 0) }),
    ("fmi3GetUInt32", mark::GET, OK, |l, c, _| unsafe { (l.get_uint32)(c, ptr::null(), 0, ptr::null_mut(), 0) }),
    ("fmi3SetUInt32", mark::SET, OK, |l, c, _| unsafe { (l.set_uint32)(c, ptr::null(), 0, ptr::null(), 0) }),
    ("fmi3GetInt64", mark::GET, OK, |l, c, _| unsafe { (l.get_int64)(c, ptr::null(), 0, ptr::null_mut(), 0) }),
    ("fmi3SetInt64", mark::SET, OK, |l, c, _| unsafe { (l.set_int64)(c, ptr::null(), 0, ptr::null(), 0) }),
    ("fmi3GetUInt64", mark::GET, OK, |l, c, _| unsafe { (l.get_uint64)(c, ptr::null(), 0, ptr::null_mut(), 0) }),
    ("fmi3SetUInt64", mark::SET, OK, |l, c, _| unsafe { (l.set_uint64)(c, ptr::null(), 0, ptr::null(), 0) }),
    ("fmi3GetBoolean", mark::GET, OK, |l, c, _| unsafe { (l.get_boolean)(c, ptr::null(), 0, ptr::null_mut(), 0) }),
    ("fmi3SetBoolean", mark::SET, OK, |l, c, _| unsafe { (l.set_boolean)(c, ptr::null(), 0, ptr::null(), 0) }),
    ("fmi3GetString", mark::GET, OK, |l, c, _| unsafe { (l.get_string)(c, ptr::null(), 0, ptr::null_mut(), 0) }),
    ("fmi3SetString", mark::SET, OK, |l, c, _| unsafe { (l.set_string)(c, ptr::null(), 0, ptr::null(), 0) }),
    ("fmi3GetBinary", mark::GET, OK, |l, c, _| unsafe { (l.get_binary)(c, ptr::null(), 0, ptr::null_mut(), ptr::null_mut(), 0) }),
    ("fmi3SetBinary", mark::SET, OK, |l, c, _| unsafe { (l.set_binary)(c, ptr::null(), 0, ptr::null(), ptr::null(), 0) }),
    ("fmi3GetClock", mark::ALIVE, OK, |l, c, _| unsafe { (l.get_clock)(c, ptr::null(), 0, ptr::null_mut()) }),
    ("fmi3SetClock", mark::ALIVE, OK, |l, c, _| unsafe { (l.set_clock)(c, ptr::null(), 0, ptr::null()) }),
    ("fmi3GetNumberOfVariableDependencies", mark::ALIVE, ERROR, |l, c, _| unsafe { (l.get_number_of_variable_dependencies)(c, 0, &mut 0) }),
    ("fmi3GetVariableDependencies", mark::ALIVE, ERROR, |l, c, _| unsafe { (l.get_variable_dependencies)(c, 0, ptr::null_mut(), ptr::null_mut(), ptr::null_mut(), ptr::null_mut(), 0) }),
    ("fmi3GetFMUState", mark::ALIVE, OK, |l, c, _| unsafe { saved(l, c) }),
    ("fmi3SetFMUState", mark::ALIVE, OK, |l, c, s| unsafe { (l.set_state)(c, s) }),
    ("fmi3FreeFMUState", mark::ALIVE, OK, |l, c, _| unsafe { (l.free_state)(c, &mut ptr::null_mut()) }),
    ("fmi3SerializedFMUStateSize", mark::ALIVE, OK, |l, c, s| unsafe { (l.serialized_state_size)(c, s, &mut 0) }),
    ("fmi3SerializeFMUState", mark::ALIVE, OK, |l, c, s| unsafe { serialized(l, c, s) }),
    ("fmi3DeserializeFMUState", mark::ALIVE, OK, |l, c, s| unsafe { deserialized(l, c, s) }),
    ("fmi3GetDirectionalDerivative", mark::EVALUATED, OK, |l, c, _| unsafe { (l.get_directional_derivative)(c, ptr::null(), 0, ptr::null(), 0, ptr::null(), 0, ptr::null_mut(), 0) }),
    ("fmi3GetAdjointDerivative", mark::EVALUATED, OK, |l, c, _| unsafe { (l.get_adjoint_derivative)(c, ptr::null(), 0, ptr::null(), 0, ptr::null(), 0, ptr::null_mut(), 0) }),
    ("fmi3EnterConfigurationMode", mark::ALIVE, ERROR, |l, c, _| unsafe { (l.enter_configuration_mode)(c) }),
    ("fmi3ExitConfigurationMode", mark::ALIVE, ERROR, |l, c, _| unsafe { (l.exit_configuration_mode)(c) }),
    ("fmi3GetIntervalDecimal", mark::ALIVE, OK, |l, c, _| unsafe { (l.get_interval_decimal)(c, ptr::null(), 0, ptr::null_mut(), ptr::null_mut()) }),
    ("fmi3GetIntervalFraction", mark::ALIVE, OK, |l, c, _| unsafe { (l.get_interval_fraction)(c, ptr::null(), 0, ptr::null_mut(), ptr::null_mut(), ptr::null_mut()) }),
    ("fmi3GetShiftDecimal", mark::ALIVE, OK, |l, c, _| unsafe { (l.get_shift_decimal)(c, ptr::null(), 0, ptr::null_mut()) }),
    ("fmi3GetShiftFraction", mark::ALIVE, OK, |l, c, _| unsafe { (l.get_shift_fraction)(c, ptr::null(), 0, ptr::null_mut(), ptr::null_mut()) }),
    ("fmi3SetIntervalDecimal", mark::ALIVE, OK, |l, c, _| unsafe { (l.set_interval_decimal)(c, ptr::null(), 0, ptr::null()) }),
    ("fmi3SetIntervalFraction", mark::ALIVE, OK, |l, c, _| unsafe { (l.set_interval_fraction)(c, ptr::null(), 0, ptr::null(), ptr::null()) }),
    ("fmi3SetShiftDecimal", mark::ALIVE, OK, |l, c, _| unsafe { (l.set_shift_decimal)(c, ptr::null(), 0, ptr::null()) }),
    ("fmi3SetShiftFraction", mark::ALIVE, OK, |l, c, _| unsafe { (l.set_shift_fraction)(c, ptr::null(), 0, ptr::null(), ptr::null()) }),
    ("fmi3EvaluateDiscreteStates", mark::ALIVE, ERROR, |l, c, _| unsafe { (l.evaluate_discrete_states)(c) }),
    ("fmi3UpdateDiscreteStates", mark::EVENT, OK, |l, c, _| unsafe { (l.update_discrete_states)(c, &mut false, &mut false, &mut false, &mut false, &mut false, &mut 0.0) }),
    ("fmi3EnterContinuousTimeMode", mark::EVENT, OK, |l, c, _| unsafe { (l.enter_continuous_time_mode)(c) }),
    ("fmi3CompletedIntegratorStep", mark::CONTINUOUS, OK, |l, c, _| unsafe { (l.completed_integrator_step)(c, true, &mut false, &mut false) }),
    ("fmi3SetTime", mark::EXCHANGE, OK, |l, c, _| unsafe { (l.set_time)(c, 0.0) }),
    ("fmi3SetContinuousStates", mark::CONTINUOUS, OK, |l, c, _| unsafe { (l.set_continuous_states)(c, [0.0, 0.0].as_ptr(), 2) }),
    ("fmi3GetContinuousStateDerivatives", mark::SOLVED, OK, |l, c, _| unsafe { (l.get_continuous_state_derivatives)(c, [0.0, 0.0].as_mut_ptr(), 2) }),
    ("fmi3GetEventIndicators", mark::SOLVED, OK, |l, c, _| unsafe { (l.get_event_indicators)(c, [0.0, 0.0].as_mut_ptr(), 2) }),
    ("fmi3GetContinuousStates", mark::SOLVED, OK, |l, c, _| unsafe { (l.get_continuous_states)(c, [0.0, 0.0].as_mut_ptr(), 2) }),
    ("fmi3GetNominalsOfContinuousStates", mark::COUNTED, OK, |l, c, _| unsafe { (l.get_nominals_of_continuous_states)(c, [0.0, 0.0].as_mut_ptr(), 2) }),
    ("fmi3GetNumberOfEventIndicators", mark::COUNTED, OK, |l, c, _| unsafe { (l.get_number_of_event_indicators)(c, &mut 0) }),
    ("fmi3GetNumberOfContinuousStates", mark::COUNTED, OK, |l, c, _| unsafe { (l.get_number_of_continuous_states)(c, &mut 0) }),
    ("fmi3EnterStepMode", mark::ALIVE, ERROR, |l, c, _| unsafe { (l.enter_step_mode)(c) }),
    ("fmi3GetOutputDerivatives", mark::STEPPED, OK, |l, c, _| unsafe { (l.get_output_derivatives)(c, ptr::null(), 0, ptr::null(), ptr::null_mut(), 0) }),
    ("fmi3DoStep", mark::STEPPING, OK, |l, c, _| unsafe { stepped(l, c) }),
    ("fmi3ActivateModelPartition", mark::ALIVE, ERROR, |l, c, _| unsafe { (l.activate_model_partition)(c, 0, 0.0) }),
];

/// # Safety
/// As for the table; so for those below.
unsafe fn saved(l: &Library, c: Pointer) -> Status {
    let mut state = ptr::null_mut();
    // SAFETY: as for the table.
    unsafe {
        let status = (l.get_state)(c, &mut state);
        assert_eq!((l.free_state)(c, &mut state), OK);
        status
    }
}

unsafe fn bytes(l: &Library, c: Pointer, s: Saved) -> (Status, Vec<u8>) {
    let mut size = 0;
    // SAFETY: as for the table.
    unsafe {
        assert_eq!((l.serialized_state_size)(c, s, &mut size), OK);
        let mut bytes = vec![0; size];
        ((l.serialize_state)(c, s, bytes.as_mut_ptr(), size), bytes)
    }
}

unsafe fn serialized(l: &Library, c: Pointer, s: Saved) -> Status {
    // SAFETY: as for the table.
    unsafe { bytes(l, c, s) }.0
}

unsafe fn deserialized(l: &Library, c: Pointer, s: Saved) -> Status {
    let mut state = ptr::null_mut();
    // SAFETY: as for the table.
    unsafe {
        let (_, bytes) = bytes(l, c, s);
        let status = (l.deserialize_state)(c, bytes.as_ptr(), bytes.len(), &mut state);
        assert_eq!((l.free_state)(c, &mut state), OK);
        status
    }
}

unsafe fn stepped(l: &Library, c: Pointer) -> Status {
    let (mut flags, mut time) = ([false; 3], 0.0);
    let [event, terminate, early] = &mut flags;
    // SAFETY: as for the table.
    unsafe { (l.do_step)(c, 0.1, 0.1, true, event, terminate, early, &mut time) }
}

#[test]
fn the_table_has_all_functions_of_an_instance() {
    let rows: BTreeSet<&str> = TABLE.iter().map(|(name, ..)| *name).collect();
    let others = [
        "fmi3GetVersion",
        "fmi3InstantiateModelExchange",
        "fmi3InstantiateCoSimulation",
        "fmi3InstantiateScheduledExecution",
        "fmi3FreeInstance",
    ];
    let expected: BTreeSet<&str> = SYMBOLS.iter().copied().filter(|name| !others.contains(name)).collect();
    assert_eq!(rows, expected);
}

#[test]
fn every_function_in_every_state() {
    for state in STATES {
        for (name, legal, answer, call) in TABLE {
            let mut instance = state.reached();
            let saved = instance.get_state();
            let status = call(&instance.subject.library, instance.pointer, saved);
            if legal.contains(&state) {
                assert_eq!(status, answer, "{name} in {state:?}: {:?}", instance.log.take());
            } else {
                assert_eq!(status, ERROR, "{name} in {state:?}");
            }
            if status == ERROR {
                let text = instance.log.last().text;
                assert!(text.starts_with(&format!("{name}: ")), "{name} in {state:?}: {text}");
                state.is_kept_by(&mut instance);
            }
            instance.free_state(saved);
        }
    }
}
