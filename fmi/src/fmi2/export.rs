//! The C names of the functions.

/// Exports a [`Model`](crate::Model) as an FMI 2.0 co-simulation library: the 34 functions of the interface under their
/// C names. For the root of a crate of type `cdylib`, once.
#[macro_export]
macro_rules! export_fmi2 {
    ($model:ty) => {
        const _: () = {
            use $crate::fmi2::types::*;

            $crate::export_fmi2! { $model;
                fmi2SetDebugLogging = set_debug_logging(logging_on: Boolean, count: usize, categories: *const String);
                fmi2SetupExperiment = setup_experiment(tolerance_defined: Boolean, tolerance: Real, start_time: Real, stop_time_defined: Boolean, stop_time: Real);
                fmi2EnterInitializationMode = enter_initialization_mode();
                fmi2ExitInitializationMode = exit_initialization_mode();
                fmi2Terminate = terminate();
                fmi2Reset = reset();
                fmi2GetReal = get_real(vr: *const ValueReference, count: usize, value: *mut Real);
                fmi2GetInteger = get_integer(vr: *const ValueReference, count: usize, value: *mut Integer);
                fmi2GetBoolean = get_boolean(vr: *const ValueReference, count: usize, value: *mut Boolean);
                fmi2GetString = get_string(vr: *const ValueReference, count: usize, value: *mut String);
                fmi2SetReal = set_real(vr: *const ValueReference, count: usize, value: *const Real);
                fmi2SetInteger = set_integer(vr: *const ValueReference, count: usize, value: *const Integer);
                fmi2SetBoolean = set_boolean(vr: *const ValueReference, count: usize, value: *const Boolean);
                fmi2SetString = set_string(vr: *const ValueReference, count: usize, value: *const String);
                fmi2GetFMUstate = get_state(state: *mut FmuState);
                fmi2SetFMUstate = set_state(state: FmuState);
                fmi2FreeFMUstate = free_state(state: *mut FmuState);
                fmi2SerializedFMUstateSize = serialized_state_size(state: FmuState, size: *mut usize);
                fmi2SerializeFMUstate = serialize_state(state: FmuState, bytes: *mut Byte, size: usize);
                fmi2DeSerializeFMUstate = deserialize_state(bytes: *const Byte, size: usize, state: *mut FmuState);
                fmi2GetDirectionalDerivative = get_directional_derivative(unknown: *const ValueReference, unknowns: usize, known: *const ValueReference, knowns: usize, known_change: *const Real, unknown_change: *mut Real);
                fmi2SetRealInputDerivatives = set_real_input_derivatives(vr: *const ValueReference, count: usize, order: *const Integer, value: *const Real);
                fmi2GetRealOutputDerivatives = get_real_output_derivatives(vr: *const ValueReference, count: usize, order: *const Integer, value: *mut Real);
                fmi2DoStep = do_step(point: Real, step: Real, no_set_state_prior_to_point: Boolean);
                fmi2CancelStep = cancel_step();
                fmi2GetStatus = get_status(kind: StatusKind, value: *mut Integer);
                fmi2GetRealStatus = get_real_status(kind: StatusKind, value: *mut Real);
                fmi2GetIntegerStatus = get_integer_status(kind: StatusKind, value: *mut Integer);
                fmi2GetBooleanStatus = get_boolean_status(kind: StatusKind, value: *mut Boolean);
                fmi2GetStringStatus = get_string_status(kind: StatusKind, value: *mut String);
            }

            #[unsafe(no_mangle)]
            extern "C" fn fmi2GetTypesPlatform() -> String {
                $crate::fmi2::functions::get_types_platform()
            }

            #[unsafe(no_mangle)]
            extern "C" fn fmi2GetVersion() -> String {
                $crate::fmi2::functions::get_version()
            }

            #[unsafe(no_mangle)]
            unsafe extern "C" fn fmi2Instantiate(
                instance_name: String,
                fmu_type: Integer,
                guid: String,
                resource_location: String,
                functions: *const CallbackFunctions,
                visible: Boolean,
                logging_on: Boolean,
            ) -> Component {
                // SAFETY: the importer keeps the contract of the specification.
                unsafe {
                    $crate::fmi2::functions::instantiate::<$model>(
                        instance_name,
                        fmu_type,
                        guid,
                        resource_location,
                        functions,
                        visible,
                        logging_on,
                    )
                }
            }

            #[unsafe(no_mangle)]
            unsafe extern "C" fn fmi2FreeInstance(c: Component) {
                // SAFETY: the importer keeps the contract of the specification.
                unsafe { $crate::fmi2::functions::free_instance::<$model>(c) }
            }
        };
    };
    // Functions of an instance.
    ($model:ty; $($symbol:ident = $function:ident($($argument:ident: $type:ty),*);)*) => {$(
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $symbol(c: Component, $($argument: $type),*) -> Status {
            // SAFETY: the importer keeps the contract of the specification.
            unsafe { $crate::fmi2::functions::$function::<$model>(c, $($argument),*) }
        }
    )*};
}
