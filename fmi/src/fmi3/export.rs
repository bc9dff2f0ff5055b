//! The C names of the functions.

/// Exports one or more [`Model`](crate::Model)s as an FMI 3.0 library: the functions of the interface under
/// their C names. Call it once in the root of a crate of type `cdylib`, beside [`export_fmi2`](crate::export_fmi2) if the library is to
/// serve both versions. The functions that make an instance find the model by its instantiation token.
#[macro_export]
macro_rules! export_fmi3 {
    ($($model:ty),+ $(,)?) => {
        const _: () = {
            // Under a name that no type of the model is likely to begin with.
            use $crate::fmi3::types as fmi3_types;

            const MODELS: &[$crate::LibraryModel] = &[$($crate::LibraryModel::of::<$model>()),+];

            $crate::export_fmi3! { functions
                fmi3SetDebugLogging = set_debug_logging(logging_on: fmi3_types::Boolean, n_categories: usize, categories: *const fmi3_types::String);
                fmi3EnterInitializationMode = enter_initialization_mode(tolerance_defined: fmi3_types::Boolean, tolerance: fmi3_types::Float64, start_time: fmi3_types::Float64, stop_time_defined: fmi3_types::Boolean, stop_time: fmi3_types::Float64);
                fmi3ExitInitializationMode = exit_initialization_mode();
                fmi3EnterEventMode = enter_event_mode();
                fmi3Terminate = terminate();
                fmi3Reset = reset();
                fmi3GetFloat32 = get_float32(value_references: *const fmi3_types::ValueReference, n_value_references: usize, values: *mut fmi3_types::Float32, n_values: usize);
                fmi3GetFloat64 = get_float64(value_references: *const fmi3_types::ValueReference, n_value_references: usize, values: *mut fmi3_types::Float64, n_values: usize);
                fmi3GetInt8 = get_int8(value_references: *const fmi3_types::ValueReference, n_value_references: usize, values: *mut fmi3_types::Int8, n_values: usize);
                fmi3GetUInt8 = get_uint8(value_references: *const fmi3_types::ValueReference, n_value_references: usize, values: *mut fmi3_types::UInt8, n_values: usize);
                fmi3GetInt16 = get_int16(value_references: *const fmi3_types::ValueReference, n_value_references: usize, values: *mut fmi3_types::Int16, n_values: usize);
                fmi3GetUInt16 = get_uint16(value_references: *const fmi3_types::ValueReference, n_value_references: usize, values: *mut fmi3_types::UInt16, n_values: usize);
                fmi3GetInt32 = get_int32(value_references: *const fmi3_types::ValueReference, n_value_references: usize, values: *mut fmi3_types::Int32, n_values: usize);
                fmi3GetUInt32 = get_uint32(value_references: *const fmi3_types::ValueReference, n_value_references: usize, values: *mut fmi3_types::UInt32, n_values: usize);
                fmi3GetInt64 = get_int64(value_references: *const fmi3_types::ValueReference, n_value_references: usize, values: *mut fmi3_types::Int64, n_values: usize);
                fmi3GetUInt64 = get_uint64(value_references: *const fmi3_types::ValueReference, n_value_references: usize, values: *mut fmi3_types::UInt64, n_values: usize);
                fmi3GetBoolean = get_boolean(value_references: *const fmi3_types::ValueReference, n_value_references: usize, values: *mut fmi3_types::Boolean, n_values: usize);
                fmi3GetString = get_string(value_references: *const fmi3_types::ValueReference, n_value_references: usize, values: *mut fmi3_types::String, n_values: usize);
                fmi3GetBinary = get_binary(value_references: *const fmi3_types::ValueReference, n_value_references: usize, value_sizes: *mut usize, values: *mut fmi3_types::Binary, n_values: usize);
                fmi3GetClock = get_clock(value_references: *const fmi3_types::ValueReference, n_value_references: usize, values: *mut fmi3_types::Clock);
                fmi3SetFloat32 = set_float32(value_references: *const fmi3_types::ValueReference, n_value_references: usize, values: *const fmi3_types::Float32, n_values: usize);
                fmi3SetFloat64 = set_float64(value_references: *const fmi3_types::ValueReference, n_value_references: usize, values: *const fmi3_types::Float64, n_values: usize);
                fmi3SetInt8 = set_int8(value_references: *const fmi3_types::ValueReference, n_value_references: usize, values: *const fmi3_types::Int8, n_values: usize);
                fmi3SetUInt8 = set_uint8(value_references: *const fmi3_types::ValueReference, n_value_references: usize, values: *const fmi3_types::UInt8, n_values: usize);
                fmi3SetInt16 = set_int16(value_references: *const fmi3_types::ValueReference, n_value_references: usize, values: *const fmi3_types::Int16, n_values: usize);
                fmi3SetUInt16 = set_uint16(value_references: *const fmi3_types::ValueReference, n_value_references: usize, values: *const fmi3_types::UInt16, n_values: usize);
                fmi3SetInt32 = set_int32(value_references: *const fmi3_types::ValueReference, n_value_references: usize, values: *const fmi3_types::Int32, n_values: usize);
                fmi3SetUInt32 = set_uint32(value_references: *const fmi3_types::ValueReference, n_value_references: usize, values: *const fmi3_types::UInt32, n_values: usize);
                fmi3SetInt64 = set_int64(value_references: *const fmi3_types::ValueReference, n_value_references: usize, values: *const fmi3_types::Int64, n_values: usize);
                fmi3SetUInt64 = set_uint64(value_references: *const fmi3_types::ValueReference, n_value_references: usize, values: *const fmi3_types::UInt64, n_values: usize);
                fmi3SetBoolean = set_boolean(value_references: *const fmi3_types::ValueReference, n_value_references: usize, values: *const fmi3_types::Boolean, n_values: usize);
                fmi3SetString = set_string(value_references: *const fmi3_types::ValueReference, n_value_references: usize, values: *const fmi3_types::String, n_values: usize);
                fmi3SetBinary = set_binary(value_references: *const fmi3_types::ValueReference, n_value_references: usize, value_sizes: *const usize, values: *const fmi3_types::Binary, n_values: usize);
                fmi3SetClock = set_clock(value_references: *const fmi3_types::ValueReference, n_value_references: usize, values: *const fmi3_types::Clock);
                fmi3GetNumberOfVariableDependencies = get_number_of_variable_dependencies(value_reference: fmi3_types::ValueReference, n_dependencies: *mut usize);
                fmi3GetVariableDependencies = get_variable_dependencies(dependent: fmi3_types::ValueReference, element_indices_of_dependent: *mut usize, independents: *mut fmi3_types::ValueReference, element_indices_of_independents: *mut usize, dependency_kinds: *mut fmi3_types::DependencyKind, n_dependencies: usize);
                fmi3GetFMUState = get_state(fmu_state: *mut fmi3_types::FmuState);
                fmi3SetFMUState = set_state(fmu_state: fmi3_types::FmuState);
                fmi3FreeFMUState = free_state(fmu_state: *mut fmi3_types::FmuState);
                fmi3SerializedFMUStateSize = serialized_state_size(fmu_state: fmi3_types::FmuState, size: *mut usize);
                fmi3SerializeFMUState = serialize_state(fmu_state: fmi3_types::FmuState, serialized_state: *mut fmi3_types::Byte, size: usize);
                fmi3DeserializeFMUState = deserialize_state(serialized_state: *const fmi3_types::Byte, size: usize, fmu_state: *mut fmi3_types::FmuState);
                fmi3GetDirectionalDerivative = get_directional_derivative(unknowns: *const fmi3_types::ValueReference, n_unknowns: usize, knowns: *const fmi3_types::ValueReference, n_knowns: usize, seed: *const fmi3_types::Float64, n_seed: usize, sensitivity: *mut fmi3_types::Float64, n_sensitivity: usize);
                fmi3GetAdjointDerivative = get_adjoint_derivative(unknowns: *const fmi3_types::ValueReference, n_unknowns: usize, knowns: *const fmi3_types::ValueReference, n_knowns: usize, seed: *const fmi3_types::Float64, n_seed: usize, sensitivity: *mut fmi3_types::Float64, n_sensitivity: usize);
                fmi3EnterConfigurationMode = enter_configuration_mode();
                fmi3ExitConfigurationMode = exit_configuration_mode();
                fmi3GetIntervalDecimal = get_interval_decimal(value_references: *const fmi3_types::ValueReference, n_value_references: usize, intervals: *mut fmi3_types::Float64, qualifiers: *mut fmi3_types::IntervalQualifier);
                fmi3GetIntervalFraction = get_interval_fraction(value_references: *const fmi3_types::ValueReference, n_value_references: usize, counters: *mut fmi3_types::UInt64, resolutions: *mut fmi3_types::UInt64, qualifiers: *mut fmi3_types::IntervalQualifier);
                fmi3GetShiftDecimal = get_shift_decimal(value_references: *const fmi3_types::ValueReference, n_value_references: usize, shifts: *mut fmi3_types::Float64);
                fmi3GetShiftFraction = get_shift_fraction(value_references: *const fmi3_types::ValueReference, n_value_references: usize, counters: *mut fmi3_types::UInt64, resolutions: *mut fmi3_types::UInt64);
                fmi3SetIntervalDecimal = set_interval_decimal(value_references: *const fmi3_types::ValueReference, n_value_references: usize, intervals: *const fmi3_types::Float64);
                fmi3SetIntervalFraction = set_interval_fraction(value_references: *const fmi3_types::ValueReference, n_value_references: usize, counters: *const fmi3_types::UInt64, resolutions: *const fmi3_types::UInt64);
                fmi3SetShiftDecimal = set_shift_decimal(value_references: *const fmi3_types::ValueReference, n_value_references: usize, shifts: *const fmi3_types::Float64);
                fmi3SetShiftFraction = set_shift_fraction(value_references: *const fmi3_types::ValueReference, n_value_references: usize, counters: *const fmi3_types::UInt64, resolutions: *const fmi3_types::UInt64);
                fmi3EvaluateDiscreteStates = evaluate_discrete_states();
                fmi3UpdateDiscreteStates = update_discrete_states(discrete_states_need_update: *mut fmi3_types::Boolean, terminate_simulation: *mut fmi3_types::Boolean, nominals_of_continuous_states_changed: *mut fmi3_types::Boolean, values_of_continuous_states_changed: *mut fmi3_types::Boolean, next_event_time_defined: *mut fmi3_types::Boolean, next_event_time: *mut fmi3_types::Float64);
                fmi3EnterContinuousTimeMode = enter_continuous_time_mode();
                fmi3CompletedIntegratorStep = completed_integrator_step(no_set_fmu_state_prior_to_current_point: fmi3_types::Boolean, enter_event_mode: *mut fmi3_types::Boolean, terminate_simulation: *mut fmi3_types::Boolean);
                fmi3SetTime = set_time(time: fmi3_types::Float64);
                fmi3SetContinuousStates = set_continuous_states(continuous_states: *const fmi3_types::Float64, n_continuous_states: usize);
                fmi3GetContinuousStateDerivatives = get_continuous_state_derivatives(derivatives: *mut fmi3_types::Float64, n_continuous_states: usize);
                fmi3GetEventIndicators = get_event_indicators(event_indicators: *mut fmi3_types::Float64, n_event_indicators: usize);
                fmi3GetContinuousStates = get_continuous_states(continuous_states: *mut fmi3_types::Float64, n_continuous_states: usize);
                fmi3GetNominalsOfContinuousStates = get_nominals_of_continuous_states(nominals: *mut fmi3_types::Float64, n_continuous_states: usize);
                fmi3GetNumberOfEventIndicators = get_number_of_event_indicators(n_event_indicators: *mut usize);
                fmi3GetNumberOfContinuousStates = get_number_of_continuous_states(n_continuous_states: *mut usize);
                fmi3EnterStepMode = enter_step_mode();
                fmi3GetOutputDerivatives = get_output_derivatives(value_references: *const fmi3_types::ValueReference, n_value_references: usize, orders: *const fmi3_types::Int32, values: *mut fmi3_types::Float64, n_values: usize);
                fmi3DoStep = do_step(current_communication_point: fmi3_types::Float64, communication_step_size: fmi3_types::Float64, no_set_fmu_state_prior_to_current_point: fmi3_types::Boolean, event_handling_needed: *mut fmi3_types::Boolean, terminate_simulation: *mut fmi3_types::Boolean, early_return: *mut fmi3_types::Boolean, last_successful_time: *mut fmi3_types::Float64);
                fmi3ActivateModelPartition = activate_model_partition(clock_reference: fmi3_types::ValueReference, activation_time: fmi3_types::Float64);
            }

            #[unsafe(no_mangle)]
            extern "C" fn fmi3GetVersion() -> fmi3_types::String {
                $crate::fmi3::functions::get_version()
            }

            #[unsafe(no_mangle)]
            unsafe extern "C" fn fmi3InstantiateModelExchange(
                instance_name: fmi3_types::String,
                instantiation_token: fmi3_types::String,
                resource_path: fmi3_types::String,
                visible: fmi3_types::Boolean,
                logging_on: fmi3_types::Boolean,
                instance_environment: fmi3_types::InstanceEnvironment,
                log_message: Option<fmi3_types::LogMessageCallback>,
            ) -> fmi3_types::Instance {
                // SAFETY: the importer keeps the contract of the specification.
                unsafe {
                    $crate::fmi3::instantiate::model_exchange(
                        MODELS,
                        instance_name,
                        instantiation_token,
                        resource_path,
                        visible,
                        logging_on,
                        instance_environment,
                        log_message,
                    )
                }
            }

            #[unsafe(no_mangle)]
            unsafe extern "C" fn fmi3InstantiateCoSimulation(
                instance_name: fmi3_types::String,
                instantiation_token: fmi3_types::String,
                resource_path: fmi3_types::String,
                visible: fmi3_types::Boolean,
                logging_on: fmi3_types::Boolean,
                event_mode_used: fmi3_types::Boolean,
                early_return_allowed: fmi3_types::Boolean,
                required_intermediate_variables: *const fmi3_types::ValueReference,
                n_required_intermediate_variables: usize,
                instance_environment: fmi3_types::InstanceEnvironment,
                log_message: Option<fmi3_types::LogMessageCallback>,
                intermediate_update: Option<fmi3_types::IntermediateUpdateCallback>,
            ) -> fmi3_types::Instance {
                // SAFETY: the importer keeps the contract of the specification.
                unsafe {
                    $crate::fmi3::instantiate::co_simulation(
                        MODELS,
                        instance_name,
                        instantiation_token,
                        resource_path,
                        visible,
                        logging_on,
                        event_mode_used,
                        early_return_allowed,
                        required_intermediate_variables,
                        n_required_intermediate_variables,
                        instance_environment,
                        log_message,
                        intermediate_update,
                    )
                }
            }

            #[unsafe(no_mangle)]
            unsafe extern "C" fn fmi3InstantiateScheduledExecution(
                instance_name: fmi3_types::String,
                instantiation_token: fmi3_types::String,
                resource_path: fmi3_types::String,
                visible: fmi3_types::Boolean,
                logging_on: fmi3_types::Boolean,
                instance_environment: fmi3_types::InstanceEnvironment,
                log_message: Option<fmi3_types::LogMessageCallback>,
                clock_update: Option<fmi3_types::ClockUpdateCallback>,
                lock_preemption: Option<fmi3_types::PreemptionCallback>,
                unlock_preemption: Option<fmi3_types::PreemptionCallback>,
            ) -> fmi3_types::Instance {
                // SAFETY: the importer keeps the contract of the specification.
                unsafe {
                    $crate::fmi3::instantiate::scheduled_execution(
                        MODELS,
                        instance_name,
                        instantiation_token,
                        resource_path,
                        visible,
                        logging_on,
                        instance_environment,
                        log_message,
                        clock_update,
                        lock_preemption,
                        unlock_preemption,
                    )
                }
            }

            #[unsafe(no_mangle)]
            unsafe extern "C" fn fmi3FreeInstance(instance: fmi3_types::Instance) {
                // SAFETY: the importer keeps the contract of the specification.
                unsafe { $crate::fmi3::functions::free_instance(instance) }
            }
        };
    };
    // Functions of an instance.
    (functions $($symbol:ident = $function:ident($($argument:ident: $type:ty),*);)*) => {$(
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $symbol(instance: fmi3_types::Instance, $($argument: $type),*) -> fmi3_types::Status {
            // SAFETY: the importer keeps the contract of the specification.
            unsafe { $crate::fmi3::functions::$function(instance, $($argument),*) }
        }
    )*};
}
