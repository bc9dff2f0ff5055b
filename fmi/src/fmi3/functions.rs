//! The functions of an FMI 3.0 library for co-simulation and model exchange, for the models of a library.
//!
//! [`export_fmi3`](crate::export_fmi3) gives them their C names.

use std::ffi::{CStr, c_char};

use super::guard::call;
use super::instantiate::free;
use super::lifecycle;
use super::types::*;
use super::values;
use crate::component::{Component, SavedState, write_bytes};
use crate::error::CallError;
use crate::exchange::same_count;
use crate::pointer::{array, array_mut, keep, reference, reference_mut, release, string};

const NO_CLOCKS: &str = "Clock";
const NO_STRUCTURAL_PARAMETERS: CallError =
    CallError::NotOffered("there is no configuration mode: this model has no structural parameters");
const NO_DEPENDENCIES: CallError = CallError::NotOffered(
    "dependencies of single elements are not available (providesPerElementDependencies = false); those of variables are in \
     the model description",
);

/// Functions of an instance: name and arguments, entry in the table of legal calls, what is done.
macro_rules! functions {
    ($($(#[$documentation:meta])*
    $name:ident($($argument:ident: $type:ty),* $(,)?), $function:ident => $body:expr;)*) => {$(
        $(#[$documentation])*
        ///
        /// # Safety
        /// As in the FMI 3.0 specification: `instance` is an instance or NULL and is not in use by another call;
        /// pointers are NULL or valid for as many elements as they are said to have.
        #[allow(clippy::too_many_arguments, reason = "those of the standard")]
        pub unsafe fn $name(instance: Instance, $($argument: $type),*) -> Status {
            // SAFETY: this function's contract is that of `call` and of the pointer conversions in `$body`.
            #[allow(unused_unsafe)]
            unsafe { call(instance, &lifecycle::$function, $body) }
        }
    )*};
}

/// Reading and setting variables of a type that variables have: functions and their entries in the table of legal calls.
macro_rules! values {
    ($($type:ident: $get:ident $GET:ident $set:ident $SET:ident;)*) => {functions! {$(
        #[doc = concat!("Reads ", stringify!($type), " variables.")]
        $get(references: *const ValueReference, count: usize, values: *mut $type, values_count: usize), $GET =>
            |instance, layout| {
                let references = array("valueReferences", references, count)?;
                values::$get(instance, layout, references, array_mut("values", values, values_count)?)
            };

        #[doc = concat!("Sets ", stringify!($type), " variables.")]
        $set(references: *const ValueReference, count: usize, values: *const $type, values_count: usize), $SET =>
            |instance, layout| {
                let references = array("valueReferences", references, count)?;
                values::$set(instance, layout, references, array("values", values, values_count)?)
            };
    )*}};
}

/// Reading and setting variables of a type that no variable has.
macro_rules! absent_values {
    ($($type:ident: $get:ident $GET:ident $set:ident $SET:ident;)*) => {functions! {$(
        #[doc = concat!("Reads ", stringify!($type), " variables, of which there are none.")]
        $get(references: *const ValueReference, count: usize, _values: *mut $type, _values_count: usize), $GET =>
            |_, layout| values::none_of(layout, stringify!($type), array("valueReferences", references, count)?);

        #[doc = concat!("Sets ", stringify!($type), " variables, of which there are none.")]
        $set(references: *const ValueReference, count: usize, _values: *const $type, _values_count: usize), $SET =>
            |_, layout| values::none_of(layout, stringify!($type), array("valueReferences", references, count)?);
    )*}};
}

/// Functions of clocks, of which there are none.
macro_rules! clocks {
    ($($(#[$documentation:meta])* $name:ident($($argument:ident: $type:ty),*), $function:ident;)*) => {functions! {$(
        $(#[$documentation])*
        $name(references: *const ValueReference, count: usize, $($argument: $type),*), $function =>
            |_, layout| values::none_of(layout, NO_CLOCKS, array("valueReferences", references, count)?);
    )*}};
}

/// Version of the interface.
pub fn get_version() -> *const c_char {
    c"3.0".as_ptr()
}

/// Frees an instance.
///
/// # Safety
/// `instance` is an instance or NULL, and is not used again.
pub unsafe fn free_instance(instance: Instance) {
    // SAFETY: this function's contract.
    unsafe { free(instance) }
}

functions! {
    /// Selects the log categories.
    set_debug_logging(logging_on: Boolean, count: usize, categories: *const String), SET_DEBUG_LOGGING =>
        |instance, _| {
            let names = array("categories", categories, count)?;
            let names: Result<Vec<&CStr>, CallError> =
                names.iter().map(|name| string("categories", *name)).collect();
            instance.logger().select(logging_on != FALSE, &names?)
        };

    /// Sets the time base and begins initialization. The integration step is fixed, so the tolerance is not used.
    enter_initialization_mode(
        _tolerance_defined: Boolean, _tolerance: Float64, start_time: Float64, stop_time_defined: Boolean,
        stop_time: Float64,
    ), ENTER_INITIALIZATION_MODE => |instance, _| {
        instance.setup_experiment(start_time, (stop_time_defined != FALSE).then_some(stop_time))?;
        instance.enter_initialization_mode()
    };

    /// Ends initialization: builds the run, which checks that the values are consistent.
    exit_initialization_mode(), EXIT_INITIALIZATION_MODE => |instance, _| instance.exit_initialization_mode();

    /// Model exchange: begins an event.
    enter_event_mode(), ENTER_EVENT_MODE => |instance, _| instance.enter_event_mode();

    /// Ends the run.
    terminate(), TERMINATE => |instance, _| instance.terminate();

    /// Goes back to the state after instantiation.
    reset(), RESET => |instance, _| instance.reset();
}

values! {
    Float64: get_float64 GET_FLOAT64 set_float64 SET_FLOAT64;
    Int32: get_int32 GET_INT32 set_int32 SET_INT32;
    Int64: get_int64 GET_INT64 set_int64 SET_INT64;
    Boolean: get_boolean GET_BOOLEAN set_boolean SET_BOOLEAN;
}

absent_values! {
    Float32: get_float32 GET_FLOAT32 set_float32 SET_FLOAT32;
    Int8: get_int8 GET_INT8 set_int8 SET_INT8;
    UInt8: get_uint8 GET_UINT8 set_uint8 SET_UINT8;
    Int16: get_int16 GET_INT16 set_int16 SET_INT16;
    UInt16: get_uint16 GET_UINT16 set_uint16 SET_UINT16;
    UInt32: get_uint32 GET_UINT32 set_uint32 SET_UINT32;
    UInt64: get_uint64 GET_UINT64 set_uint64 SET_UINT64;
    String: get_string GET_STRING set_string SET_STRING;
}

functions! {
    /// Reads Binary variables, of which there are none.
    get_binary(
        references: *const ValueReference, count: usize, _sizes: *mut usize, _values: *mut Binary, _values_count: usize,
    ), GET_BINARY => |_, layout| values::none_of(layout, "Binary", array("valueReferences", references, count)?);

    /// Sets Binary variables, of which there are none.
    set_binary(
        references: *const ValueReference, count: usize, _sizes: *const usize, _values: *const Binary,
        _values_count: usize,
    ), SET_BINARY => |_, layout| values::none_of(layout, "Binary", array("valueReferences", references, count)?);

    /// Dependencies of elements are not offered.
    get_number_of_variable_dependencies(_reference: ValueReference, _count: *mut usize), GET_NUMBER_OF_DEPENDENCIES =>
        |_, _| Err(NO_DEPENDENCIES);

    /// Dependencies of elements are not offered.
    get_variable_dependencies(
        _dependent: ValueReference, _elements_of_dependent: *mut usize, _independents: *mut ValueReference,
        _elements_of_independents: *mut usize, _kinds: *mut DependencyKind, _count: usize,
    ), GET_DEPENDENCIES => |_, _| Err(NO_DEPENDENCIES);

    /// Saves the state. A state that `state` holds already is overwritten.
    get_state(state: *mut FmuState), GET_STATE => |instance, _| {
        keep(reference_mut("FMUState", state)?, instance.saved_state());
        Ok(())
    };

    /// Sets a saved state of this instance or another.
    set_state(state: FmuState), SET_STATE => |instance, _| instance.restore(saved(state)?);

    /// Frees a saved state and leaves NULL in its place.
    free_state(state: *mut FmuState), FREE_STATE => |_, _| {
        release::<Box<dyn SavedState>>(state);
        Ok(())
    };

    /// Number of bytes of a saved state.
    serialized_state_size(state: FmuState, size: *mut usize), SERIALIZED_STATE_SIZE => |_, _| {
        let (state, size) = (saved(state)?, reference_mut("size", size)?);
        *size = state.bytes()?.len();
        Ok(())
    };

    /// Writes a saved state to a buffer of exactly its size.
    serialize_state(state: FmuState, bytes: *mut Byte, size: usize), SERIALIZE_STATE => |_, _| {
        let bytes = array_mut("serializedState", bytes, size)?;
        write_bytes(saved(state)?, bytes)
    };

    /// Reads a saved state from bytes, and checks it.
    deserialize_state(bytes: *const Byte, size: usize, state: *mut FmuState), DESERIALIZE_STATE => |instance, _| {
        let (bytes, state) = (array("serializedState", bytes, size)?, reference_mut("FMUState", state)?);
        keep(state, instance.deserialize(bytes)?);
        Ok(())
    };

    /// Derivatives of outputs and derivatives along a direction in inputs and states.
    get_directional_derivative(
        unknowns: *const ValueReference, unknowns_count: usize, knowns: *const ValueReference, knowns_count: usize,
        seed: *const Float64, seed_count: usize, sensitivity: *mut Float64, sensitivity_count: usize,
    ), GET_DIRECTIONAL_DERIVATIVE => |instance, layout| {
        let unknowns = array("unknowns", unknowns, unknowns_count)?;
        let knowns = array("knowns", knowns, knowns_count)?;
        let seed = array("seed", seed, seed_count)?;
        let sensitivity = array_mut("sensitivity", sensitivity, sensitivity_count)?;
        let unknowns = values::unknowns(layout, unknowns, "nSensitivity", sensitivity_count)?;
        let knowns = values::knowns(layout, knowns, "nSeed", seed_count)?;
        instance.directional_derivative(&unknowns, &knowns, seed, sensitivity)
    };

    /// Derivatives of a weighted sum of outputs and derivatives with respect to inputs and states.
    get_adjoint_derivative(
        unknowns: *const ValueReference, unknowns_count: usize, knowns: *const ValueReference, knowns_count: usize,
        seed: *const Float64, seed_count: usize, sensitivity: *mut Float64, sensitivity_count: usize,
    ), GET_ADJOINT_DERIVATIVE => |instance, layout| {
        let unknowns = array("unknowns", unknowns, unknowns_count)?;
        let knowns = array("knowns", knowns, knowns_count)?;
        let seed = array("seed", seed, seed_count)?;
        let sensitivity = array_mut("sensitivity", sensitivity, sensitivity_count)?;
        let unknowns = values::unknowns(layout, unknowns, "nSeed", seed_count)?;
        let knowns = values::knowns(layout, knowns, "nSensitivity", sensitivity_count)?;
        instance.adjoint_derivative(&unknowns, &knowns, seed, sensitivity)
    };

    /// Not to be called: there are no structural parameters.
    enter_configuration_mode(), ENTER_CONFIGURATION_MODE => |_, _| Err(NO_STRUCTURAL_PARAMETERS);

    /// Not to be called: there are no structural parameters.
    exit_configuration_mode(), EXIT_CONFIGURATION_MODE => |_, _| Err(NO_STRUCTURAL_PARAMETERS);
}

clocks! {
    /// Reads clocks.
    get_clock(_values: *mut Clock), GET_CLOCK;
    /// Sets clocks.
    set_clock(_values: *const Clock), SET_CLOCK;
    /// Reads intervals of clocks.
    get_interval_decimal(_intervals: *mut Float64, _qualifiers: *mut IntervalQualifier), GET_INTERVAL_DECIMAL;
    /// Reads intervals of clocks.
    get_interval_fraction(
        _counters: *mut UInt64, _resolutions: *mut UInt64, _qualifiers: *mut IntervalQualifier
    ), GET_INTERVAL_FRACTION;
    /// Reads shifts of clocks.
    get_shift_decimal(_shifts: *mut Float64), GET_SHIFT_DECIMAL;
    /// Reads shifts of clocks.
    get_shift_fraction(_counters: *mut UInt64, _resolutions: *mut UInt64), GET_SHIFT_FRACTION;
    /// Sets intervals of clocks.
    set_interval_decimal(_intervals: *const Float64), SET_INTERVAL_DECIMAL;
    /// Sets intervals of clocks.
    set_interval_fraction(_counters: *const UInt64, _resolutions: *const UInt64), SET_INTERVAL_FRACTION;
    /// Sets shifts of clocks.
    set_shift_decimal(_shifts: *const Float64), SET_SHIFT_DECIMAL;
    /// Sets shifts of clocks.
    set_shift_fraction(_counters: *const UInt64, _resolutions: *const UInt64), SET_SHIFT_FRACTION;
}

functions! {
    /// Not offered: discrete states are evaluated when they are updated.
    evaluate_discrete_states(), EVALUATE_DISCRETE_STATES => |_, _| Err(CallError::NotOffered(
        "fmi3UpdateDiscreteStates evaluates the discrete states, too (providesEvaluateDiscreteStates = false)",
    ));

    /// Model exchange: goes through an event.
    update_discrete_states(
        need_update: *mut Boolean, terminate: *mut Boolean, nominals_changed: *mut Boolean,
        states_changed: *mut Boolean, next_event_time_defined: *mut Boolean, next_event_time: *mut Float64,
    ), UPDATE_DISCRETE_STATES => |instance, _| {
        let need_update = reference_mut("discreteStatesNeedUpdate", need_update)?;
        let terminate = reference_mut("terminateSimulation", terminate)?;
        let nominals_changed = reference_mut("nominalsOfContinuousStatesChanged", nominals_changed)?;
        let states_changed = reference_mut("valuesOfContinuousStatesChanged", states_changed)?;
        let next_event_time_defined = reference_mut("nextEventTimeDefined", next_event_time_defined)?;
        let next_event_time = reference_mut("nextEventTime", next_event_time)?;
        let event = instance.new_discrete_states()?;
        (*need_update, *terminate, *nominals_changed) = (FALSE, FALSE, FALSE);
        *states_changed = values::boolean(event.states_changed);
        (*next_event_time_defined, *next_event_time) = (FALSE, 0.0);
        Ok(())
    };

    /// Model exchange: goes on behind an event.
    enter_continuous_time_mode(), ENTER_CONTINUOUS_TIME_MODE =>
        |instance, _| instance.enter_continuous_time_mode();

    /// Model exchange: whether an event is needed after a step of the solver.
    completed_integrator_step(
        _no_set_state_prior_to_point: Boolean, enter_event_mode: *mut Boolean, terminate: *mut Boolean,
    ), COMPLETED_INTEGRATOR_STEP => |instance, _| {
        let enter = reference_mut("enterEventMode", enter_event_mode)?;
        let terminate = reference_mut("terminateSimulation", terminate)?;
        (*enter, *terminate) = (values::boolean(instance.completed_integrator_step()?), FALSE);
        Ok(())
    };

    /// Model exchange: sets the time.
    set_time(time: Float64), SET_TIME => |instance, _| instance.set_time(time);

    /// Model exchange: sets the states.
    set_continuous_states(states: *const Float64, count: usize), SET_CONTINUOUS_STATES =>
        |instance, _| {
            check_states(instance, count)?;
            instance.set_continuous_states(array("continuousStates", states, count)?)
        };

    /// Model exchange: the derivatives of the states.
    get_continuous_state_derivatives(derivatives: *mut Float64, count: usize), GET_DERIVATIVES =>
        |instance, _| {
            check_states(instance, count)?;
            instance.derivatives(array_mut("derivatives", derivatives, count)?)
        };

    /// Model exchange: the event indicators.
    get_event_indicators(indicators: *mut Float64, count: usize), GET_EVENT_INDICATORS =>
        |instance, _| {
            check_indicators(instance, count)?;
            instance.event_indicators(array_mut("eventIndicators", indicators, count)?)
        };

    /// Model exchange: the states.
    get_continuous_states(states: *mut Float64, count: usize), GET_CONTINUOUS_STATES =>
        |instance, _| {
            check_states(instance, count)?;
            instance.continuous_states(array_mut("continuousStates", states, count)?)
        };

    /// Model exchange: typical magnitudes of the states.
    get_nominals_of_continuous_states(nominals: *mut Float64, count: usize), GET_NOMINALS =>
        |instance, _| {
            check_states(instance, count)?;
            instance.nominals_of_continuous_states(array_mut("nominals", nominals, count)?)
        };

    /// Model exchange: number of event indicators.
    get_number_of_event_indicators(count: *mut usize), GET_NUMBER_OF_EVENT_INDICATORS => |instance, _| {
        *reference_mut("nEventIndicators", count)? = instance.number_of_event_indicators()?;
        Ok(())
    };

    /// Model exchange: number of states.
    get_number_of_continuous_states(count: *mut usize), GET_NUMBER_OF_CONTINUOUS_STATES => |instance, _| {
        *reference_mut("nContinuousStates", count)? = instance.number_of_continuous_states()?;
        Ok(())
    };

    /// Not offered: there is no event mode in co-simulation.
    enter_step_mode(), ENTER_STEP_MODE => |_, _| Err(CallError::NotOffered(
        "there is no event mode in co-simulation (hasEventMode = false), so that an instance is always in step mode",
    ));

    /// Time derivatives of outputs.
    get_output_derivatives(
        references: *const ValueReference, count: usize, orders: *const Int32, values: *mut Float64,
        values_count: usize,
    ), GET_OUTPUT_DERIVATIVES => |instance, layout| {
        let references = array("valueReferences", references, count)?;
        let orders = array("orders", orders, count)?;
        let values = array_mut("values", values, values_count)?;
        let (references, orders) = values::with_orders(layout, references, orders, values_count)?;
        instance.output_derivatives(&references, &orders, values)
    };

    /// Advances from a communication point to the next.
    do_step(
        point: Float64, step: Float64, _no_set_state_prior_to_point: Boolean, event_handling_needed: *mut Boolean,
        terminate: *mut Boolean, early_return: *mut Boolean, last_successful_time: *mut Float64,
    ), DO_STEP => |instance, _| {
        let event_handling_needed = reference_mut("eventHandlingNeeded", event_handling_needed)?;
        let terminate = reference_mut("terminateSimulation", terminate)?;
        let early_return = reference_mut("earlyReturn", early_return)?;
        let last_successful_time = reference_mut("lastSuccessfulTime", last_successful_time)?;
        (*event_handling_needed, *terminate, *early_return) = (FALSE, FALSE, FALSE);
        let outcome = instance.do_step(point, step);
        *last_successful_time = instance.time_s();
        outcome
    };

    /// Not offered: there is no scheduled execution.
    activate_model_partition(_clock: ValueReference, _time: Float64), ACTIVATE_MODEL_PARTITION => |_, _| {
        Err(CallError::NotOffered("scheduled execution is not supported"))
    };
}

fn check_states(instance: &dyn Component, count: usize) -> Result<(), CallError> {
    same_count("nContinuousStates", count, instance.number_of_continuous_states()?)
}

fn check_indicators(instance: &dyn Component, count: usize) -> Result<(), CallError> {
    same_count("nEventIndicators", count, instance.number_of_event_indicators()?)
}

/// A saved state that the importer passes.
///
/// # Safety
/// `state` must be NULL or come from [`get_state`] or [`deserialize_state`], and not be freed.
unsafe fn saved<'a>(state: FmuState) -> Result<&'a dyn SavedState, CallError> {
    // SAFETY: the caller's promise.
    Ok(&**unsafe { reference("FMUState", state.cast::<Box<dyn SavedState>>()) }?)
}
