//! The 34 functions of an FMI 2.0 co-simulation library, and nothing else.

use std::ffi::{CStr, c_char, c_int};

use crate::error::CallError;
use crate::guard::call;
use crate::instance::Instance;
use crate::instantiate::{Request, free, instantiate};
use crate::lifecycle::Function;
use crate::pointer::{array, array_mut, keep, reference, reference_mut, release, string};
use crate::serialized::{deserialize, serialize};
use crate::snapshot::Snapshot;
use crate::types::{
    Boolean, Byte, CallbackFunctions, Component, FALSE, FmuState, Integer, Real, Status, StatusKind, String,
    TRUE, ValueReference,
};
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
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(c: Component, $($argument: $type),*) -> Status {
            // SAFETY: this function's contract is that of `call` and of the pointer conversions in `$body`.
            #[allow(unused_unsafe)]
            unsafe { call(c, &Function::$function, $body) }
        }
    )*};
}

/// Name of the set of C types.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

/// Version of the interface.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

/// Makes an instance; NULL if it cannot.
///
/// # Safety
/// As in the FMI 2.0 specification: strings are NULL or end with NUL, `functions` is NULL or valid, its
/// logger stays valid as long as the instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Instantiate(
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
    instantiate(&Request { name, fmu_type, guid, functions, callback, logging_on })
}

/// Frees an instance.
///
/// # Safety
/// `c` is an instance or NULL, and is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeInstance(c: Component) {
    // SAFETY: this function's contract.
    unsafe { free(c) }
}

functions! {
    /// Selects what is logged.
    fmi2SetDebugLogging(logging_on: Boolean, count: usize, categories: *const String), SET_DEBUG_LOGGING =>
        |instance| {
            let names = array("categories", categories, count)?;
            let names: Result<Vec<&CStr>, CallError> =
                names.iter().map(|name| string("categories", *name)).collect();
            instance.logger.select(logging_on != FALSE, &names?)
        };

    /// Sets the time base.
    fmi2SetupExperiment(
        tolerance_defined: Boolean, tolerance: Real, start_time: Real, stop_time_defined: Boolean, stop_time: Real,
    ), SETUP_EXPERIMENT => |instance| {
        let tolerance = (tolerance_defined != FALSE).then_some(tolerance);
        instance.setup_experiment(tolerance, start_time, (stop_time_defined != FALSE).then_some(stop_time))
    };

    /// Begins initialization.
    fmi2EnterInitializationMode(), ENTER_INITIALIZATION_MODE => Instance::enter_initialization_mode;

    /// Ends initialization: checks the values against one another and designs the controllers.
    fmi2ExitInitializationMode(), EXIT_INITIALIZATION_MODE => Instance::exit_initialization_mode;

    /// Ends the flight.
    fmi2Terminate(), TERMINATE => Instance::terminate;

    /// Goes back to the state after instantiation.
    fmi2Reset(), RESET => Instance::reset;

    /// Reads Real variables.
    fmi2GetReal(vr: *const ValueReference, count: usize, value: *mut Real), GET_REAL => |instance| {
        let (vr, value) = (array("vr", vr, count)?, array_mut("value", value, count)?);
        instance.get(Type::Real, vr, |place, got| if let Value::Real(got) = got { value[place] = got })
    };

    /// Reads Integer variables.
    fmi2GetInteger(vr: *const ValueReference, count: usize, value: *mut Integer), GET_INTEGER => |instance| {
        let (vr, value) = (array("vr", vr, count)?, array_mut("value", value, count)?);
        instance.get(Type::Integer, vr, |place, got| if let Value::Integer(got) = got { value[place] = got })
    };

    /// Reads Boolean variables.
    fmi2GetBoolean(vr: *const ValueReference, count: usize, value: *mut Boolean), GET_BOOLEAN => |instance| {
        let (vr, value) = (array("vr", vr, count)?, array_mut("value", value, count)?);
        instance.get(Type::Boolean, vr, |place, got| {
            if let Value::Boolean(got) = got { value[place] = boolean(got) }
        })
    };

    /// Reads String variables, of which there are none.
    fmi2GetString(vr: *const ValueReference, count: usize, value: *mut String), GET_STRING => |instance| {
        let (vr, _) = (array("vr", vr, count)?, array_mut("value", value, count)?);
        instance.no_strings(vr)
    };

    /// Sets Real variables.
    fmi2SetReal(vr: *const ValueReference, count: usize, value: *const Real), SET_REAL => |instance| {
        let (vr, value) = (array("vr", vr, count)?, array("value", value, count)?);
        instance.set(Type::Real, vr, |place| Value::Real(value[place]))
    };

    /// Sets Integer variables.
    fmi2SetInteger(vr: *const ValueReference, count: usize, value: *const Integer), SET_INTEGER => |instance| {
        let (vr, value) = (array("vr", vr, count)?, array("value", value, count)?);
        instance.set(Type::Integer, vr, |place| Value::Integer(value[place]))
    };

    /// Sets Boolean variables.
    fmi2SetBoolean(vr: *const ValueReference, count: usize, value: *const Boolean), SET_BOOLEAN => |instance| {
        let (vr, value) = (array("vr", vr, count)?, array("value", value, count)?);
        instance.set(Type::Boolean, vr, |place| Value::Boolean(value[place] != FALSE))
    };

    /// Sets String variables, of which there are none.
    fmi2SetString(vr: *const ValueReference, count: usize, value: *const String), SET_STRING => |instance| {
        let (vr, _) = (array("vr", vr, count)?, array("value", value, count)?);
        instance.no_strings(vr)
    };

    /// Saves the state. A state that `state` holds already is overwritten.
    fmi2GetFMUstate(state: *mut FmuState), GET_STATE => |instance| {
        keep(reference_mut("FMUstate", state)?, instance.snapshot());
        Ok(())
    };

    /// Goes to a saved state, of this instance or another.
    fmi2SetFMUstate(state: FmuState), SET_STATE =>
        |instance| instance.restore(reference("FMUstate", state.cast::<Snapshot>())?);

    /// Frees a saved state and leaves NULL in its place.
    fmi2FreeFMUstate(state: *mut FmuState), FREE_STATE => |_| {
        release::<Snapshot>(state);
        Ok(())
    };

    /// Number of bytes of a saved state.
    fmi2SerializedFMUstateSize(state: FmuState, size: *mut usize), SERIALIZED_STATE_SIZE => |_| {
        let (state, size) = (reference("FMUstate", state.cast::<Snapshot>())?, reference_mut("size", size)?);
        *size = serialize(state)?.len();
        Ok(())
    };

    /// Writes a saved state into exactly as many bytes as it has.
    fmi2SerializeFMUstate(state: FmuState, bytes: *mut Byte, size: usize), SERIALIZE_STATE => |_| {
        let state = reference("FMUstate", state.cast::<Snapshot>())?;
        let bytes = array_mut("serializedState", bytes, size)?;
        copy(&serialize(state)?, bytes)
    };

    /// Reads a saved state from bytes, and checks it.
    fmi2DeSerializeFMUstate(bytes: *const Byte, size: usize, state: *mut FmuState), DESERIALIZE_STATE => |_| {
        let (bytes, state) = (array("serializedState", bytes, size)?, reference_mut("FMUstate", state)?);
        keep(state, deserialize(bytes)?);
        Ok(())
    };

    /// Not available: `providesDirectionalDerivative` is false.
    fmi2GetDirectionalDerivative(
        _unknown: *const ValueReference, _unknowns: usize, _known: *const ValueReference, _knowns: usize,
        _known_change: *const Real, _unknown_change: *mut Real,
    ), GET_DIRECTIONAL_DERIVATIVE => |_| Err(CallError::NoDirectionalDerivative);

    /// Sets derivatives of inputs for the next step.
    fmi2SetRealInputDerivatives(
        vr: *const ValueReference, count: usize, order: *const Integer, value: *const Real,
    ), SET_INPUT_DERIVATIVES => |instance| {
        let (vr, order) = (array("vr", vr, count)?, array("order", order, count)?);
        instance.set_input_derivatives(vr, order, array("value", value, count)?)
    };

    /// Not available: `maxOutputDerivativeOrder` is 0.
    fmi2GetRealOutputDerivatives(
        _vr: *const ValueReference, count: usize, _order: *const Integer, _value: *mut Real,
    ), GET_OUTPUT_DERIVATIVES =>
        |_| if count == 0 { Ok(()) } else { Err(CallError::NoOutputDerivatives) };

    /// Flies from a communication point to the next.
    fmi2DoStep(point: Real, step: Real, _no_set_state_prior_to_point: Boolean), DO_STEP =>
        |instance| instance.do_step(point, step);

    /// Never legal: no step is ever pending.
    fmi2CancelStep(), CANCEL_STEP => |_| Ok(());

    /// Status of the last step.
    fmi2GetStatus(kind: StatusKind, value: *mut c_int), GET_STATUS => |instance| {
        *reference_mut("value", value)? = instance.status(kind)? as c_int;
        Ok(())
    };

    /// Time that the last successful step reached.
    fmi2GetRealStatus(kind: StatusKind, value: *mut Real), GET_REAL_STATUS => |instance| {
        *reference_mut("value", value)? = instance.real_status(kind)?;
        Ok(())
    };

    /// No status is an Integer.
    fmi2GetIntegerStatus(kind: StatusKind, _value: *mut Integer), GET_INTEGER_STATUS =>
        |_| Err(CallError::NoStatus { kind });

    /// Whether the model wants to end the simulation.
    fmi2GetBooleanStatus(kind: StatusKind, value: *mut Boolean), GET_BOOLEAN_STATUS => |instance| {
        *reference_mut("value", value)? = boolean(instance.boolean_status(kind)?);
        Ok(())
    };

    /// No status is a String: no step is ever pending.
    fmi2GetStringStatus(kind: StatusKind, _value: *mut String), GET_STRING_STATUS =>
        |_| Err(CallError::NoStatus { kind });
}

fn boolean(value: bool) -> Boolean {
    if value { TRUE } else { FALSE }
}

fn copy(from: &[u8], to: &mut [u8]) -> Result<(), CallError> {
    if from.len() != to.len() {
        let (actual, expected) = (to.len(), from.len());
        return Err(crate::error::SavedStateError::Length { actual, expected }.into());
    }
    to.copy_from_slice(from);
    Ok(())
}
