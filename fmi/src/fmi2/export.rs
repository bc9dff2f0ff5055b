//! The C names of the functions.

/// Exports one or more [`Model`](crate::Model)s as an FMI 2.0 library: the 44 functions of the interface under
/// their C names. For the root of a crate of type `cdylib`, once. `fmi2Instantiate` finds the model by its GUID.
#[macro_export]
macro_rules! export_fmi2 {
    ($($model:ty),+ $(,)?) => {
        const _: () = {
            // Under a name that no type of the model is likely to begin with.
            use $crate::fmi2::types as fmi2_types;

            $crate::export_fmi2! { functions
                fmi2SetDebugLogging = set_debug_logging(logging_on: fmi2_types::Boolean, count: usize, categories: *const fmi2_types::String);
                fmi2SetupExperiment = setup_experiment(tolerance_defined: fmi2_types::Boolean, tolerance: fmi2_types::Real, start_time: fmi2_types::Real, stop_time_defined: fmi2_types::Boolean, stop_time: fmi2_types::Real);
                fmi2EnterInitializationMode = enter_initialization_mode();
                fmi2ExitInitializationMode = exit_initialization_mode();
                fmi2Terminate = terminate();
                fmi2Reset = reset();
                fmi2GetReal = get_real(vr: *const fmi2_types::ValueReference, count: usize, value: *mut fmi2_types::Real);
                fmi2GetInteger = get_integer(vr: *const fmi2_types::ValueReference, count: usize, value: *mut fmi2_types::Integer);
                fmi2GetBoolean = get_boolean(vr: *const fmi2_types::ValueReference, count: usize, value: *mut fmi2_types::Boolean);
                fmi2GetString = get_string(vr: *const fmi2_types::ValueReference, count: usize, value: *mut fmi2_types::String);
                fmi2SetReal = set_real(vr: *const fmi2_types::ValueReference, count: usize, value: *const fmi2_types::Real);
                fmi2SetInteger = set_integer(vr: *const fmi2_types::ValueReference, count: usize, value: *const fmi2_types::Integer);
                fmi2SetBoolean = set_boolean(vr: *const fmi2_types::ValueReference, count: usize, value: *const fmi2_types::Boolean);
                fmi2SetString = set_string(vr: *const fmi2_types::ValueReference, count: usize, value: *const fmi2_types::String);
                fmi2GetFMUstate = get_state(state: *mut fmi2_types::FmuState);
                fmi2SetFMUstate = set_state(state: fmi2_types::FmuState);
                fmi2FreeFMUstate = free_state(state: *mut fmi2_types::FmuState);
                fmi2SerializedFMUstateSize = serialized_state_size(state: fmi2_types::FmuState, size: *mut usize);
                fmi2SerializeFMUstate = serialize_state(state: fmi2_types::FmuState, bytes: *mut fmi2_types::Byte, size: usize);
                fmi2DeSerializeFMUstate = deserialize_state(bytes: *const fmi2_types::Byte, size: usize, state: *mut fmi2_types::FmuState);
                fmi2GetDirectionalDerivative = get_directional_derivative(unknown: *const fmi2_types::ValueReference, unknowns: usize, known: *const fmi2_types::ValueReference, knowns: usize, known_change: *const fmi2_types::Real, unknown_change: *mut fmi2_types::Real);
                fmi2SetRealInputDerivatives = set_real_input_derivatives(vr: *const fmi2_types::ValueReference, count: usize, order: *const fmi2_types::Integer, value: *const fmi2_types::Real);
                fmi2GetRealOutputDerivatives = get_real_output_derivatives(vr: *const fmi2_types::ValueReference, count: usize, order: *const fmi2_types::Integer, value: *mut fmi2_types::Real);
                fmi2EnterEventMode = enter_event_mode();
                fmi2NewDiscreteStates = new_discrete_states(info: *mut fmi2_types::EventInfo);
                fmi2EnterContinuousTimeMode = enter_continuous_time_mode();
                fmi2CompletedIntegratorStep = completed_integrator_step(no_set_state_prior_to_point: fmi2_types::Boolean, enter_event_mode: *mut fmi2_types::Boolean, terminate_simulation: *mut fmi2_types::Boolean);
                fmi2SetTime = set_time(time: fmi2_types::Real);
                fmi2SetContinuousStates = set_continuous_states(x: *const fmi2_types::Real, count: usize);
                fmi2GetDerivatives = get_derivatives(derivatives: *mut fmi2_types::Real, count: usize);
                fmi2GetEventIndicators = get_event_indicators(indicators: *mut fmi2_types::Real, count: usize);
                fmi2GetContinuousStates = get_continuous_states(x: *mut fmi2_types::Real, count: usize);
                fmi2GetNominalsOfContinuousStates = get_nominals_of_continuous_states(nominals: *mut fmi2_types::Real, count: usize);
                fmi2DoStep = do_step(point: fmi2_types::Real, step: fmi2_types::Real, no_set_state_prior_to_point: fmi2_types::Boolean);
                fmi2CancelStep = cancel_step();
                fmi2GetStatus = get_status(kind: fmi2_types::StatusKind, value: *mut fmi2_types::Integer);
                fmi2GetRealStatus = get_real_status(kind: fmi2_types::StatusKind, value: *mut fmi2_types::Real);
                fmi2GetIntegerStatus = get_integer_status(kind: fmi2_types::StatusKind, value: *mut fmi2_types::Integer);
                fmi2GetBooleanStatus = get_boolean_status(kind: fmi2_types::StatusKind, value: *mut fmi2_types::Boolean);
                fmi2GetStringStatus = get_string_status(kind: fmi2_types::StatusKind, value: *mut fmi2_types::String);
            }

            #[unsafe(no_mangle)]
            extern "C" fn fmi2GetTypesPlatform() -> fmi2_types::String {
                $crate::fmi2::functions::get_types_platform()
            }

            #[unsafe(no_mangle)]
            extern "C" fn fmi2GetVersion() -> fmi2_types::String {
                $crate::fmi2::functions::get_version()
            }

            #[unsafe(no_mangle)]
            unsafe extern "C" fn fmi2Instantiate(
                instance_name: fmi2_types::String,
                fmu_type: fmi2_types::Integer,
                guid: fmi2_types::String,
                resource_location: fmi2_types::String,
                functions: *const fmi2_types::CallbackFunctions,
                visible: fmi2_types::Boolean,
                logging_on: fmi2_types::Boolean,
            ) -> fmi2_types::Component {
                // SAFETY: the importer keeps the contract of the specification.
                unsafe {
                    $crate::fmi2::functions::instantiate(
                        &const { [$($crate::LibraryModel::of::<$model>()),+] },
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
            unsafe extern "C" fn fmi2FreeInstance(c: fmi2_types::Component) {
                // SAFETY: the importer keeps the contract of the specification.
                unsafe { $crate::fmi2::functions::free_instance(c) }
            }
        };
    };
    // Functions of an instance.
    (functions $($symbol:ident = $function:ident($($argument:ident: $type:ty),*);)*) => {$(
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $symbol(c: fmi2_types::Component, $($argument: $type),*) -> fmi2_types::Status {
            // SAFETY: the importer keeps the contract of the specification.
            unsafe { $crate::fmi2::functions::$function(c, $($argument),*) }
        }
    )*};
}
