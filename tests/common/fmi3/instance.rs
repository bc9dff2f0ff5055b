//! One instance, with its log.

use std::ffi::CString;
use std::ptr;

use super::library::{ERROR, Instance as Pointer, OK, Reference, State, Status};
use super::log::{Log, record};
use super::subject::Subject;

/// What `fmi3DoStep` tells beside its status.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    pub event_handling_needed: bool,
    pub terminate_simulation: bool,
    pub early_return: bool,
    pub last_successful_time: f64,
}

/// What `fmi3UpdateDiscreteStates` tells.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Event {
    pub need_update: bool,
    pub terminate: bool,
    pub nominals_changed: bool,
    pub states_changed: bool,
    pub next_event_time_defined: bool,
    pub next_event_time: f64,
}

/// An instance that frees itself.
pub struct Instance {
    pub subject: &'static Subject,
    pub pointer: Pointer,
    pub log: Box<Log>,
}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: the pointer is this instance's and is not used again.
        unsafe { (self.subject.library.free_instance)(self.pointer) }
    }
}

/// The functions of the interface with slices for arrays.
///
/// SAFETY of every call below: the instance is alive, and slices are as long as they are said to be.
#[allow(clippy::undocumented_unsafe_blocks)]
impl Instance {
    /// A fresh instance for co-simulation that logs everything.
    pub fn new(subject: &'static Subject) -> Self {
        Self::with_logging(subject, true)
    }

    /// A fresh instance for co-simulation.
    pub fn with_logging(subject: &'static Subject, logging_on: bool) -> Self {
        let log = Box::new(Log::default());
        let token = CString::new(subject.description.token.as_str()).expect("a token has no NUL");
        let pointer = unsafe {
            (subject.library.instantiate_co_simulation)(
                c"instance".as_ptr(),
                token.as_ptr(),
                ptr::null(),
                false,
                logging_on,
                false,
                true,
                ptr::null(),
                0,
                log.environment(),
                Some(record),
                ptr::null(),
            )
        };
        assert!(!pointer.is_null(), "not instantiated: {:?}", log.take());
        Self { subject, pointer, log }
    }

    /// A fresh instance for model exchange that logs everything.
    pub fn for_model_exchange(subject: &'static Subject) -> Self {
        let log = Box::new(Log::default());
        let token = CString::new(subject.description.token.as_str()).expect("a token has no NUL");
        let pointer = unsafe {
            (subject.library.instantiate_model_exchange)(
                c"instance".as_ptr(),
                token.as_ptr(),
                ptr::null(),
                false,
                true,
                log.environment(),
                Some(record),
            )
        };
        assert!(!pointer.is_null(), "not instantiated: {:?}", log.take());
        Self { subject, pointer, log }
    }

    /// An instance for co-simulation that is ready to step from 0.
    pub fn initialized(subject: &'static Subject, values: &[(&str, &[f64])]) -> Self {
        let mut instance = Self::new(subject);
        for (name, values) in values {
            assert_eq!(instance.set(&[name], values), OK, "{:?}", instance.log.take());
        }
        instance.initialize();
        instance
    }

    /// Goes through initialization mode.
    pub fn initialize(&mut self) {
        assert_eq!(self.enter_initialization_mode(0.0, None), OK);
        assert_eq!(self.exit_initialization_mode(), OK, "{:?}", self.log.take());
        self.log.take();
    }

    pub fn enter_initialization_mode(&mut self, start: f64, stop: Option<f64>) -> Status {
        let (defined, stop) = (stop.is_some(), stop.unwrap_or(0.0));
        unsafe {
            (self.subject.library.enter_initialization_mode)(self.pointer, false, 0.0, start, defined, stop)
        }
    }

    pub fn exit_initialization_mode(&mut self) -> Status {
        unsafe { (self.subject.library.exit_initialization_mode)(self.pointer) }
    }

    pub fn terminate(&mut self) -> Status {
        unsafe { (self.subject.library.terminate)(self.pointer) }
    }

    pub fn reset(&mut self) -> Status {
        unsafe { (self.subject.library.reset)(self.pointer) }
    }

    pub fn do_step(&mut self, point: f64, step: f64) -> (Status, Step) {
        let mut told = Step {
            event_handling_needed: true,
            terminate_simulation: true,
            early_return: true,
            last_successful_time: f64::NAN,
        };
        let status = unsafe {
            (self.subject.library.do_step)(
                self.pointer,
                point,
                step,
                true,
                &mut told.event_handling_needed,
                &mut told.terminate_simulation,
                &mut told.early_return,
                &mut told.last_successful_time,
            )
        };
        (status, told)
    }

    /// Steps of equal length.
    pub fn fly(&mut self, from: f64, step: f64, steps: u32) {
        for i in 0..steps {
            let (status, _) = self.do_step(from + f64::from(i) * step, step);
            assert_eq!(status, OK, "step {i}: {:?}", self.log.take());
        }
    }

    pub fn references(&self, names: &[&str]) -> Vec<Reference> {
        names.iter().map(|name| self.subject.description.reference(name)).collect()
    }

    /// Sets `Float64` variables, the elements of one after those of the other.
    pub fn set(&mut self, names: &[&str], values: &[f64]) -> Status {
        let references = self.references(names);
        self.set_references(&references, values)
    }

    pub fn set_references(&mut self, references: &[Reference], values: &[f64]) -> Status {
        let (count, length) = (references.len(), values.len());
        unsafe {
            (self.subject.library.set_float64)(
                self.pointer,
                references.as_ptr(),
                count,
                values.as_ptr(),
                length,
            )
        }
    }

    pub fn set_boolean(&mut self, name: &str, value: bool) -> Status {
        let reference = self.subject.description.reference(name);
        unsafe { (self.subject.library.set_boolean)(self.pointer, &reference, 1, &value, 1) }
    }

    pub fn set_int32(&mut self, name: &str, value: i32) -> Status {
        let reference = self.subject.description.reference(name);
        unsafe { (self.subject.library.set_int32)(self.pointer, &reference, 1, &value, 1) }
    }

    pub fn set_int64(&mut self, name: &str, value: i64) -> Status {
        let reference = self.subject.description.reference(name);
        unsafe { (self.subject.library.set_int64)(self.pointer, &reference, 1, &value, 1) }
    }

    /// `count` values of `Float64` variables.
    pub fn try_values(&mut self, references: &[Reference], count: usize) -> Result<Vec<f64>, Status> {
        let mut values = vec![f64::NAN; count];
        let status = unsafe {
            (self.subject.library.get_float64)(
                self.pointer,
                references.as_ptr(),
                references.len(),
                values.as_mut_ptr(),
                count,
            )
        };
        if status == OK { Ok(values) } else { Err(status) }
    }

    /// All elements of `Float64` variables.
    pub fn values(&mut self, names: &[&str]) -> Vec<f64> {
        let count = names.iter().map(|name| self.subject.description.variable(name).length()).sum();
        let references = self.references(names);
        self.try_values(&references, count).unwrap_or_else(|_| panic!("{names:?}: {:?}", self.log.take()))
    }

    pub fn value(&mut self, name: &str) -> f64 {
        self.values(&[name])[0]
    }

    pub fn int32(&mut self, name: &str) -> Result<i32, Status> {
        let (reference, mut value) = (self.subject.description.reference(name), -1);
        let status = unsafe { (self.subject.library.get_int32)(self.pointer, &reference, 1, &mut value, 1) };
        if status == OK { Ok(value) } else { Err(status) }
    }

    pub fn int64(&mut self, name: &str) -> Result<i64, Status> {
        let (reference, mut value) = (self.subject.description.reference(name), -1);
        let status = unsafe { (self.subject.library.get_int64)(self.pointer, &reference, 1, &mut value, 1) };
        if status == OK { Ok(value) } else { Err(status) }
    }

    pub fn boolean(&mut self, name: &str) -> Result<bool, Status> {
        let (reference, mut value) = (self.subject.description.reference(name), false);
        let status =
            unsafe { (self.subject.library.get_boolean)(self.pointer, &reference, 1, &mut value, 1) };
        if status == OK { Ok(value) } else { Err(status) }
    }

    /// All outputs as bits, in the order of the description: arrays element by element.
    pub fn outputs(&mut self) -> Vec<u64> {
        let mut bits = Vec::new();
        for variable in self.subject.description.variables.iter().filter(|v| v.causality() == "output") {
            let name = variable.name.as_str();
            match variable.value_type.as_str() {
                "Float64" => bits.extend(self.values(&[name]).into_iter().map(f64::to_bits)),
                "Int32" => bits.push(self.int32(name).expect("it can be read") as u64),
                "Enumeration" => bits.push(self.int64(name).expect("it can be read") as u64),
                "Boolean" => bits.push(u64::from(self.boolean(name).expect("it can be read"))),
                other => panic!("{name} is a {other}"),
            }
        }
        bits
    }

    pub fn get_state(&mut self) -> State {
        let mut state = ptr::null_mut();
        assert_eq!(unsafe { (self.subject.library.get_state)(self.pointer, &mut state) }, OK);
        assert!(!state.is_null());
        state
    }

    pub fn set_state(&mut self, state: State) -> Status {
        unsafe { (self.subject.library.set_state)(self.pointer, state) }
    }

    pub fn free_state(&mut self, mut state: State) {
        assert_eq!(unsafe { (self.subject.library.free_state)(self.pointer, &mut state) }, OK);
        assert!(state.is_null());
    }

    pub fn serialize(&mut self, state: State) -> Vec<u8> {
        let mut size = 0;
        unsafe {
            assert_eq!((self.subject.library.serialized_state_size)(self.pointer, state, &mut size), OK);
            let mut bytes = vec![0; size];
            let into = bytes.as_mut_ptr();
            assert_eq!((self.subject.library.serialize_state)(self.pointer, state, into, size), OK);
            bytes
        }
    }

    /// A state from bytes, or the status and NULL.
    pub fn deserialize(&mut self, bytes: &[u8]) -> Result<State, Status> {
        let mut state = ptr::null_mut();
        let status = unsafe {
            (self.subject.library.deserialize_state)(self.pointer, bytes.as_ptr(), bytes.len(), &mut state)
        };
        if status == OK {
            return Ok(state);
        }
        assert!(state.is_null(), "a refused state must not be handed out");
        Err(status)
    }

    /// The directional derivative of all elements of `unknowns` along a direction in the elements of `knowns`.
    pub fn directional(
        &mut self,
        unknowns: &[&str],
        knowns: &[&str],
        seed: &[f64],
        count: usize,
    ) -> Result<Vec<f64>, Status> {
        let function = self.subject.library.get_directional_derivative;
        self.derivative(function, unknowns, knowns, seed, count)
    }

    /// The adjoint derivative with respect to all elements of `knowns`.
    pub fn adjoint(
        &mut self,
        unknowns: &[&str],
        knowns: &[&str],
        seed: &[f64],
        count: usize,
    ) -> Result<Vec<f64>, Status> {
        let function = self.subject.library.get_adjoint_derivative;
        self.derivative(function, unknowns, knowns, seed, count)
    }

    #[allow(clippy::type_complexity)]
    fn derivative(
        &mut self,
        function: unsafe extern "C" fn(
            Pointer,
            *const Reference,
            usize,
            *const Reference,
            usize,
            *const f64,
            usize,
            *mut f64,
            usize,
        ) -> Status,
        unknowns: &[&str],
        knowns: &[&str],
        seed: &[f64],
        count: usize,
    ) -> Result<Vec<f64>, Status> {
        let (unknowns, knowns) = (self.references(unknowns), self.references(knowns));
        let mut sensitivity = vec![f64::NAN; count];
        let status = unsafe {
            function(
                self.pointer,
                unknowns.as_ptr(),
                unknowns.len(),
                knowns.as_ptr(),
                knowns.len(),
                seed.as_ptr(),
                seed.len(),
                sensitivity.as_mut_ptr(),
                count,
            )
        };
        if status == OK { Ok(sensitivity) } else { Err(status) }
    }

    /// Time derivatives of all elements of outputs.
    pub fn output_derivatives(
        &mut self,
        names: &[&str],
        orders: &[i32],
        count: usize,
    ) -> Result<Vec<f64>, Status> {
        let (references, mut values) = (self.references(names), vec![f64::NAN; count]);
        let status = unsafe {
            (self.subject.library.get_output_derivatives)(
                self.pointer,
                references.as_ptr(),
                references.len(),
                orders.as_ptr(),
                values.as_mut_ptr(),
                count,
            )
        };
        if status == OK { Ok(values) } else { Err(status) }
    }

    pub fn enter_event_mode(&mut self) -> Status {
        unsafe { (self.subject.library.enter_event_mode)(self.pointer) }
    }

    pub fn enter_continuous_time_mode(&mut self) -> Status {
        unsafe { (self.subject.library.enter_continuous_time_mode)(self.pointer) }
    }

    pub fn update_discrete_states(&mut self) -> (Status, Event) {
        let mut event = Event::default();
        let status = unsafe {
            (self.subject.library.update_discrete_states)(
                self.pointer,
                &mut event.need_update,
                &mut event.terminate,
                &mut event.nominals_changed,
                &mut event.states_changed,
                &mut event.next_event_time_defined,
                &mut event.next_event_time,
            )
        };
        (status, event)
    }

    pub fn set_time(&mut self, time: f64) -> Status {
        unsafe { (self.subject.library.set_time)(self.pointer, time) }
    }

    pub fn set_continuous_states(&mut self, states: &[f64]) -> Status {
        unsafe { (self.subject.library.set_continuous_states)(self.pointer, states.as_ptr(), states.len()) }
    }

    pub fn number_of_continuous_states(&mut self) -> usize {
        let mut count = usize::MAX;
        let function = self.subject.library.get_number_of_continuous_states;
        assert_eq!(unsafe { function(self.pointer, &mut count) }, OK);
        count
    }

    pub fn number_of_event_indicators(&mut self) -> usize {
        let mut count = usize::MAX;
        let function = self.subject.library.get_number_of_event_indicators;
        assert_eq!(unsafe { function(self.pointer, &mut count) }, OK);
        count
    }

    pub fn continuous_states(&mut self) -> Vec<f64> {
        self.vector(self.subject.library.get_continuous_states, self.number_of_states())
    }

    pub fn nominals(&mut self) -> Vec<f64> {
        self.vector(self.subject.library.get_nominals_of_continuous_states, self.number_of_states())
    }

    pub fn derivatives(&mut self) -> Vec<f64> {
        self.vector(self.subject.library.get_continuous_state_derivatives, self.number_of_states())
    }

    pub fn event_indicators(&mut self) -> Vec<f64> {
        let count = self.number_of_event_indicators();
        self.vector(self.subject.library.get_event_indicators, count)
    }

    /// By the description.
    fn number_of_states(&self) -> usize {
        let description = &self.subject.description;
        let derivatives = description.unknowns("ContinuousStateDerivative");
        derivatives.iter().map(|(reference, _)| description.containing(*reference).length()).sum()
    }

    fn vector(
        &mut self,
        function: unsafe extern "C" fn(Pointer, *mut f64, usize) -> Status,
        count: usize,
    ) -> Vec<f64> {
        let mut values = vec![f64::NAN; count];
        assert_eq!(
            unsafe { function(self.pointer, values.as_mut_ptr(), count) },
            OK,
            "{:?}",
            self.log.take()
        );
        values
    }

    /// Whether a call was refused with a message that has this text.
    #[track_caller]
    pub fn is_refused(&mut self, status: Status, text: &str) {
        assert_eq!(status, ERROR);
        let message = self.log.last();
        assert_eq!((message.status, message.category.as_str()), (ERROR, "logStatusError"));
        assert!(message.text.contains(text), "{text:?} is not in {:?}", message.text);
    }
}
