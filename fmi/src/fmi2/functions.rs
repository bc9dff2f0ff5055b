//! The 44 functions of an FMI 2.0 library for co-simulation and model exchange, for the models of a library.
//!
//! [`export_fmi2`](crate::export_fmi2) gives them their C names.

use std::ffi::{CStr, c_char, c_int};

use super::guard::call;
use super::instantiate::{Request, free, instantiate as make};
use super::lifecycle;
use super::status::{no_status, step_status};
use super::types::{
    Boolean, Byte, CallbackFunctions, Component, EventInfo, FALSE, FmuState, Integer, LAST_SUCCESSFUL_TIME,
    Real, Status, StatusKind, String, TERMINATED, TRUE, ValueReference,
};
use crate::component::{SavedState, write_bytes};
use crate::error::CallError;
use crate::library::LibraryModel;
use crate::pointer::{array, array_mut, keep, reference, reference_mut, release, string};
use crate::variables::{Type, Value};

/// Functions of an instance: name and arguments, entry in the table of legal calls, what is done.
macro_rules! functions {
    ($($(#[$documentation:meta])*
    $name:ident($($argument:ident: $type:ty),* $(,)?), $function:ident => $body:expr;)*) => {$(
        $(#[$documentation])*
        ///
        /// # Safety
        /// As in the FMI 2.0 specification: `c` is an instance or NULL and is not in use by another call;
        /// pointers are NULL or valid for as many elements as they are said to have.
        pub unsafe fn $name(c: Component, $($argument: $type),*) -> Status {
            // SAFETY: this function's contract is that of `call` and of the pointer conversions in `$body`.
            #[allow(unused_unsafe)]
            unsafe { call(c, &lifecycle::$function, $body) }
        }
    )*};
}

/// Name of the set of C types.
pub fn get_types_platform() -> *const c_char {
    c"default".as_ptr()
}

/// Version of the interface.
pub fn get_version() -> *const c_char {
    c"2.0".as_ptr()
}

/// Makes an instance of one of the `models`; NULL if it cannot.
///
/// # Safety
/// As in the FMI 2.0 specification: strings are NULL or end with NUL, `functions` is NULL or valid, its
/// logger stays valid as long as the instance.
#[expect(clippy::too_many_arguments, reason = "those of the standard, and the models")]
pub unsafe fn instantiate(
    models: &[LibraryModel],
    instance_name: String,
    fmu_type: c_int,
    guid: String,
    _resource_location: String,
    functions: *const CallbackFunctions,
    _visible: Boolean,
    logging_on: Boolean,
) -> Component {
    // SAFETY: this function's contract.
    let text = |text: String| (!text.is_null()).then(|| unsafe { CStr::from_ptr(text) });
    // SAFETY: this function's contract.
    let Some(functions) = (unsafe { functions.as_ref() }) else { return std::ptr::null_mut() };
    // Without a logger there is nobody to tell what is wrong.
    let Some(callback) = functions.logger else { return std::ptr::null_mut() };
    let (name, guid, logging_on) = (text(instance_name), text(guid), logging_on != FALSE);
    // SAFETY: this function's contract.
    unsafe { make(models, &Request { name, fmu_type, guid, functions, callback, logging_on }) }
}

/// Frees an instance.
///
/// # Safety
/// `c` is an instance or NULL, and is not used again.
pub unsafe fn free_instance(c: Component) {
    // SAFETY: this function's contract.
    unsafe { free(c) }
}

functions! {
    /// Selects the log categories.
    set_debug_logging(logging_on: Boolean, count: usize, categories: *const String), SET_DEBUG_LOGGING =>
        |instance| {
            let names = array("categories", categories, count)?;
            let names: Result<Vec<&CStr>, CallError> =
                names.iter().map(|name| string("categories", *name)).collect();
            instance.logger().select(logging_on != FALSE, &names?)
        };

    /// Sets the time base. A co-simulation FMU may ignore the tolerance (FMI 2.0.4, section 2.1.6): the integration step is fixed.
    setup_experiment(
        _tolerance_defined: Boolean, _tolerance: Real, start_time: Real, stop_time_defined: Boolean, stop_time: Real,
    ), SETUP_EXPERIMENT => |instance| {
        instance.setup_experiment(start_time, (stop_time_defined != FALSE).then_some(stop_time))
    };

    /// Begins initialization.
    enter_initialization_mode(), ENTER_INITIALIZATION_MODE => |instance| instance.enter_initialization_mode();

    /// Ends initialization: builds the run, which checks that the values are consistent.
    exit_initialization_mode(), EXIT_INITIALIZATION_MODE => |instance| instance.exit_initialization_mode();

    /// Ends the run.
    terminate(), TERMINATE => |instance| instance.terminate();

    /// Goes back to the state after instantiation.
    reset(), RESET => |instance| instance.reset();

    /// Reads Real variables.
    get_real(vr: *const ValueReference, count: usize, value: *mut Real), GET_REAL => |instance| {
        let (vr, value) = (array("vr", vr, count)?, array_mut("value", value, count)?);
        instance.get(Type::Real, vr, &mut |place, got| if let Value::Real(got) = got { value[place] = got })
    };

    /// Reads Integer variables.
    get_integer(vr: *const ValueReference, count: usize, value: *mut Integer), GET_INTEGER => |instance| {
        let (vr, value) = (array("vr", vr, count)?, array_mut("value", value, count)?);
        instance.get(Type::Integer, vr, &mut |place, got| if let Value::Integer(got) = got { value[place] = got })
    };

    /// Reads Boolean variables.
    get_boolean(vr: *const ValueReference, count: usize, value: *mut Boolean), GET_BOOLEAN => |instance| {
        let (vr, value) = (array("vr", vr, count)?, array_mut("value", value, count)?);
        instance.get(Type::Boolean, vr, &mut |place, got| {
            if let Value::Boolean(got) = got { value[place] = boolean(got) }
        })
    };

    /// Reads String variables, of which there are none.
    get_string(vr: *const ValueReference, count: usize, value: *mut String), GET_STRING => |instance| {
        let (vr, _) = (array("vr", vr, count)?, array_mut("value", value, count)?);
        instance.no_strings(vr)
    };

    /// Sets Real variables.
    set_real(vr: *const ValueReference, count: usize, value: *const Real), SET_REAL => |instance| {
        let (vr, value) = (array("vr", vr, count)?, array("value", value, count)?);
        instance.set(Type::Real, vr, &|place| Value::Real(value[place]))
    };

    /// Sets Integer variables.
    set_integer(vr: *const ValueReference, count: usize, value: *const Integer), SET_INTEGER => |instance| {
        let (vr, value) = (array("vr", vr, count)?, array("value", value, count)?);
        instance.set(Type::Integer, vr, &|place| Value::Integer(value[place]))
    };

    /// Sets Boolean variables.
    set_boolean(vr: *const ValueReference, count: usize, value: *const Boolean), SET_BOOLEAN => |instance| {
        let (vr, value) = (array("vr", vr, count)?, array("value", value, count)?);
        instance.set(Type::Boolean, vr, &|place| Value::Boolean(value[place] != FALSE))
    };

    /// Sets String variables, of which there are none.
    set_string(vr: *const ValueReference, count: usize, value: *const String), SET_STRING => |instance| {
        let (vr, _) = (array("vr", vr, count)?, array("value", value, count)?);
        instance.no_strings(vr)
    };

    /// Saves the state. A state that `state` holds already is overwritten.
    get_state(state: *mut FmuState), GET_STATE => |instance| {
        keep(reference_mut("FMUstate", state)?, instance.saved_state());
        Ok(())
    };

    /// Sets a saved state of this instance or another.
    set_state(state: FmuState), SET_STATE =>
        |instance| instance.restore(saved(state)?);

    /// Frees a saved state and leaves NULL in its place.
    free_state(state: *mut FmuState), FREE_STATE => |_| {
        release::<Box<dyn SavedState>>(state);
        Ok(())
    };

    /// Number of bytes of a saved state.
    serialized_state_size(state: FmuState, size: *mut usize), SERIALIZED_STATE_SIZE => |_| {
        let (state, size) = (saved(state)?, reference_mut("size", size)?);
        *size = state.bytes()?.len();
        Ok(())
    };

    /// Writes a saved state to a buffer of exactly its size.
    serialize_state(state: FmuState, bytes: *mut Byte, size: usize), SERIALIZE_STATE => |_| {
        let bytes = array_mut("serializedState", bytes, size)?;
        write_bytes(saved(state)?, bytes)
    };

    /// Reads a saved state from bytes, and checks it.
    deserialize_state(bytes: *const Byte, size: usize, state: *mut FmuState), DESERIALIZE_STATE => |instance| {
        let (bytes, state) = (array("serializedState", bytes, size)?, reference_mut("FMUstate", state)?);
        keep(state, instance.deserialize(bytes)?);
        Ok(())
    };

    /// Derivatives of outputs and derivatives along a direction in inputs and states.
    get_directional_derivative(
        unknown: *const ValueReference, unknowns: usize, known: *const ValueReference, knowns: usize,
        known_change: *const Real, unknown_change: *mut Real,
    ), GET_DIRECTIONAL_DERIVATIVE => |instance| {
        let (unknown, known) = (array("vUnknown_ref", unknown, unknowns)?, array("vKnown_ref", known, knowns)?);
        let direction = array("dvKnown", known_change, knowns)?;
        let into = array_mut("dvUnknown", unknown_change, unknowns)?;
        instance.directional_derivative(unknown, known, direction, into)
    };

    /// Sets derivatives of inputs for the next step.
    set_real_input_derivatives(
        vr: *const ValueReference, count: usize, order: *const Integer, value: *const Real,
    ), SET_INPUT_DERIVATIVES => |instance| {
        let (vr, order) = (array("vr", vr, count)?, array("order", order, count)?);
        instance.set_input_derivatives(vr, order, array("value", value, count)?)
    };

    /// Time derivatives of outputs.
    get_real_output_derivatives(
        vr: *const ValueReference, count: usize, order: *const Integer, value: *mut Real,
    ), GET_OUTPUT_DERIVATIVES => |instance| {
        let (vr, order) = (array("vr", vr, count)?, array("order", order, count)?);
        instance.output_derivatives(vr, order, array_mut("value", value, count)?)
    };

    /// Model exchange: begins an event.
    enter_event_mode(), ENTER_EVENT_MODE => |instance| instance.enter_event_mode();

    /// Model exchange: goes through an event.
    new_discrete_states(info: *mut EventInfo), NEW_DISCRETE_STATES => |instance| {
        let info = reference_mut("eventInfo", info)?;
        let event = instance.new_discrete_states()?;
        *info = EventInfo {
            new_discrete_states_needed: FALSE,
            terminate_simulation: FALSE,
            nominals_of_continuous_states_changed: FALSE,
            values_of_continuous_states_changed: boolean(event.states_changed),
            next_event_time_defined: FALSE,
            next_event_time: 0.0,
        };
        Ok(())
    };

    /// Model exchange: goes on behind an event.
    enter_continuous_time_mode(), ENTER_CONTINUOUS_TIME_MODE => |instance| instance.enter_continuous_time_mode();

    /// Model exchange: whether an event is needed after a step of the solver.
    completed_integrator_step(
        _no_set_state_prior_to_point: Boolean, enter_event_mode: *mut Boolean, terminate_simulation: *mut Boolean,
    ), COMPLETED_INTEGRATOR_STEP => |instance| {
        let enter = reference_mut("enterEventMode", enter_event_mode)?;
        let terminate = reference_mut("terminateSimulation", terminate_simulation)?;
        (*enter, *terminate) = (boolean(instance.completed_integrator_step()?), FALSE);
        Ok(())
    };

    /// Model exchange: sets the time.
    set_time(time: Real), SET_TIME => |instance| instance.set_time(time);

    /// Model exchange: sets the states.
    set_continuous_states(x: *const Real, count: usize), SET_CONTINUOUS_STATES =>
        |instance| instance.set_continuous_states(array("x", x, count)?);

    /// Model exchange: the derivatives of the states.
    get_derivatives(derivatives: *mut Real, count: usize), GET_DERIVATIVES =>
        |instance| instance.derivatives(array_mut("derivatives", derivatives, count)?);

    /// Model exchange: the event indicators.
    get_event_indicators(indicators: *mut Real, count: usize), GET_EVENT_INDICATORS =>
        |instance| instance.event_indicators(array_mut("eventIndicators", indicators, count)?);

    /// Model exchange: the states.
    get_continuous_states(x: *mut Real, count: usize), GET_CONTINUOUS_STATES =>
        |instance| instance.continuous_states(array_mut("x", x, count)?);

    /// Model exchange: typical magnitudes of the states.
    get_nominals_of_continuous_states(nominals: *mut Real, count: usize), GET_NOMINALS =>
        |instance| instance.nominals_of_continuous_states(array_mut("x_nominal", nominals, count)?);

    /// Advances from a communication point to the next.
    do_step(point: Real, step: Real, _no_set_state_prior_to_point: Boolean), DO_STEP =>
        |instance| instance.do_step(point, step);

    /// Never legal: no step is ever pending.
    cancel_step(), CANCEL_STEP => |_| Ok(());

    /// Status of the last step.
    get_status(kind: StatusKind, value: *mut c_int), GET_STATUS => |instance| {
        *reference_mut("value", value)? = step_status(instance, kind)? as c_int;
        Ok(())
    };

    /// Time that the last successful step reached.
    get_real_status(kind: StatusKind, value: *mut Real), GET_REAL_STATUS => |instance| {
        *reference_mut("value", value)? = match kind {
            LAST_SUCCESSFUL_TIME => instance.time_s(),
            _ => return Err(no_status(kind)),
        };
        Ok(())
    };

    /// No status is an Integer.
    get_integer_status(kind: StatusKind, _value: *mut Integer), GET_INTEGER_STATUS =>
        |_| Err(no_status(kind));

    /// Whether the model wants to end the simulation.
    get_boolean_status(kind: StatusKind, value: *mut Boolean), GET_BOOLEAN_STATUS => |_| {
        // No model wants to end the simulation.
        *reference_mut("value", value)? = if kind == TERMINATED { FALSE } else { return Err(no_status(kind)) };
        Ok(())
    };

    /// No status is a String: no step is ever pending.
    get_string_status(kind: StatusKind, _value: *mut String), GET_STRING_STATUS =>
        |_| Err(no_status(kind));
}

/// A saved state that the importer passes.
///
/// # Safety
/// `state` must be NULL or come from [`get_state`] or [`deserialize_state`], and not be freed.
unsafe fn saved<'a>(state: FmuState) -> Result<&'a dyn SavedState, CallError> {
    // SAFETY: the caller's promise.
    Ok(&**unsafe { reference("FMUstate", state.cast::<Box<dyn SavedState>>()) }?)
}

fn boolean(value: bool) -> Boolean {
    if value { TRUE } else { FALSE }
}
