//! One instance, with its log.

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::ptr;
use std::sync::Mutex;

use super::description::Description;
use super::library::{Callbacks, Component, EventInfo, Library, OK, Reference, State, Status};
use super::subject::{Breaking, Subject};

/// One message that the library logged.
#[derive(Clone, Debug, PartialEq)]
pub struct Message {
    pub instance: String,
    pub status: Status,
    pub category: String,
    pub text: String,
}

/// The environment that is given to the library, and comes back with each message.
#[derive(Default)]
pub struct Log(Mutex<Vec<Message>>);

impl Log {
    /// The messages since the last call.
    pub fn take(&self) -> Vec<Message> {
        std::mem::take(&mut self.0.lock().expect("no test panics while it logs"))
    }

    /// The last message; it must be there.
    pub fn last(&self) -> Message {
        self.take().pop().expect("something was logged")
    }
}

/// Logger of the tests. The C type is variadic, which Rust can call but not define; on all platforms but
/// Apple's ARM a variadic argument lies where the sixth argument would.
pub unsafe extern "C" fn record(
    environment: *mut c_void,
    instance: *const c_char,
    status: Status,
    category: *const c_char,
    format: *const c_char,
    message: *const c_char,
) {
    let readable = !cfg!(all(target_vendor = "apple", target_arch = "aarch64"));
    // SAFETY: the environment is the `Log` that `callbacks` was given; the strings end with NUL.
    unsafe {
        let text = |text| CStr::from_ptr(text).to_string_lossy().into_owned();
        assert_eq!(CStr::from_ptr(format), c"%s");
        let message = Message {
            instance: text(instance),
            status,
            category: text(category),
            text: if readable { text(message) } else { String::new() },
        };
        (*environment.cast::<Log>()).0.lock().expect("no test panics while it logs").push(message);
    }
}

/// Callbacks with the logger above.
pub fn callbacks(log: &Log) -> Callbacks {
    Callbacks {
        logger: record as *const c_void,
        allocate: ptr::null(),
        free: ptr::null(),
        step_finished: ptr::null(),
        environment: ptr::from_ref(log).cast_mut().cast(),
    }
}

/// `fmi2ModelExchange`
const MODEL_EXCHANGE: c_int = 0;
/// `fmi2CoSimulation`
const CO_SIMULATION: c_int = 1;

/// An instance that frees itself.
pub struct Instance<'l> {
    pub library: &'l Library,
    pub description: &'l Description,
    pub component: Component,
    pub log: Box<Log>,
    _callbacks: Box<Callbacks>,
}

impl Drop for Instance<'_> {
    fn drop(&mut self) {
        // SAFETY: the component is this instance's and is not used again.
        unsafe { (self.library.free_instance)(self.component) }
    }
}

/// The functions of the interface with slices for arrays and names for value references.
impl<'l> Instance<'l> {
    /// A fresh instance that logs everything.
    pub fn new(subject: &'l Subject) -> Self {
        Self::with_logging(subject, true)
    }

    /// A fresh instance.
    pub fn with_logging(subject: &'l Subject, logging_on: bool) -> Self {
        Self::of_kind(subject, CO_SIMULATION, logging_on)
    }

    /// A fresh instance for model exchange, which logs everything.
    pub fn for_model_exchange(subject: &'l Subject) -> Self {
        Self::of_kind(subject, MODEL_EXCHANGE, true)
    }

    fn of_kind(subject: &'l Subject, fmu_type: c_int, logging_on: bool) -> Self {
        let log = Box::new(Log::default());
        let callbacks = Box::new(callbacks(&log));
        let guid = CString::new(subject.description.guid.as_str()).expect("a GUID has no NUL");
        // SAFETY: all pointers are valid; `log` and the library outlive the instance.
        let component = unsafe {
            (subject.library.instantiate)(
                c"instance".as_ptr(),
                fmu_type,
                guid.as_ptr(),
                ptr::null(),
                &*callbacks,
                0,
                c_int::from(logging_on),
            )
        };
        assert!(!component.is_null(), "not instantiated: {:?}", log.take());
        let Subject { library, description, .. } = subject;
        Self { library, description, component, log, _callbacks: callbacks }
    }

    /// An instance that is ready to step from 0 with the values that are set.
    pub fn initialized(subject: &'l Subject, reals: &[(&str, f64)], booleans: &[(&str, bool)]) -> Self {
        let mut instance = Self::new(subject);
        assert_eq!(instance.set_real(reals), OK, "{:?}", instance.log.take());
        assert_eq!(instance.set_boolean(booleans), OK, "{:?}", instance.log.take());
        instance.initialize();
        instance
    }

    /// Goes through initialization mode.
    pub fn initialize(&mut self) {
        assert_eq!(self.setup(0.0, None), OK);
        assert_eq!(self.enter_initialization_mode(), OK);
        assert_eq!(self.exit_initialization_mode(), OK, "{:?}", self.log.take());
        self.log.take();
    }

    /// Goes through initialization mode with values that a run breaks with.
    pub fn initialize_to_break(&mut self, subject: &Subject) {
        let Breaking { integers, start, in_the_run } = &subject.sample.breaking;
        assert_eq!(self.set_integer(integers), OK);
        assert_eq!(self.set_real(start), OK);
        self.initialize();
        assert_eq!(self.set_real(in_the_run), OK);
    }

    pub fn setup(&mut self, start: f64, stop: Option<f64>) -> Status {
        let (defined, stop) = (c_int::from(stop.is_some()), stop.unwrap_or(0.0));
        // SAFETY: the component is alive, here and below; slices are as long as they are said to be.
        unsafe { (self.library.setup_experiment)(self.component, 0, 0.0, start, defined, stop) }
    }

    pub fn enter_initialization_mode(&mut self) -> Status {
        // SAFETY: see `setup`.
        unsafe { (self.library.enter_initialization_mode)(self.component) }
    }

    pub fn exit_initialization_mode(&mut self) -> Status {
        // SAFETY: see `setup`.
        unsafe { (self.library.exit_initialization_mode)(self.component) }
    }

    pub fn terminate(&mut self) -> Status {
        // SAFETY: see `setup`.
        unsafe { (self.library.terminate)(self.component) }
    }

    pub fn reset(&mut self) -> Status {
        // SAFETY: see `setup`.
        unsafe { (self.library.reset)(self.component) }
    }

    pub fn do_step(&mut self, point: f64, step: f64) -> Status {
        // SAFETY: see `setup`.
        unsafe { (self.library.do_step)(self.component, point, step, 1) }
    }

    /// Steps of equal length; the communication points are multiples, as FMPy makes them.
    pub fn fly(&mut self, from: f64, step: f64, steps: u32) {
        for i in 0..steps {
            let status = self.do_step(from + f64::from(i) * step, step);
            assert_eq!(status, OK, "step {i}: {:?}", self.log.take());
        }
    }

    pub fn set_real(&mut self, values: &[(&str, f64)]) -> Status {
        let (references, values): (Vec<_>, Vec<_>) =
            values.iter().map(|(name, value)| (self.description.reference(name), *value)).unzip();
        self.set_real_references(&references, &values)
    }

    pub fn set_real_references(&mut self, references: &[Reference], values: &[f64]) -> Status {
        assert_eq!(references.len(), values.len());
        // SAFETY: see `setup`.
        unsafe {
            (self.library.set_real)(self.component, references.as_ptr(), references.len(), values.as_ptr())
        }
    }

    pub fn set_integer(&mut self, values: &[(&str, i32)]) -> Status {
        let (references, values): (Vec<_>, Vec<_>) =
            values.iter().map(|(name, value)| (self.description.reference(name), *value)).unzip();
        // SAFETY: see `setup`.
        unsafe {
            (self.library.set_integer)(self.component, references.as_ptr(), references.len(), values.as_ptr())
        }
    }

    pub fn set_boolean(&mut self, values: &[(&str, bool)]) -> Status {
        let (references, values): (Vec<_>, Vec<_>) = values
            .iter()
            .map(|(name, value)| (self.description.reference(name), c_int::from(*value)))
            .unzip();
        // SAFETY: see `setup`.
        unsafe {
            (self.library.set_boolean)(self.component, references.as_ptr(), references.len(), values.as_ptr())
        }
    }

    /// Derivatives of inputs: name, order, value.
    pub fn set_input_derivatives(&mut self, derivatives: &[(&str, i32, f64)]) -> Status {
        let references: Vec<_> =
            derivatives.iter().map(|(name, ..)| self.description.reference(name)).collect();
        let orders: Vec<_> = derivatives.iter().map(|(_, order, _)| *order).collect();
        let values: Vec<_> = derivatives.iter().map(|(.., value)| *value).collect();
        let count = derivatives.len();
        // SAFETY: see `setup`.
        unsafe {
            (self.library.set_input_derivatives)(
                self.component,
                references.as_ptr(),
                count,
                orders.as_ptr(),
                values.as_ptr(),
            )
        }
    }

    pub fn try_reals(&mut self, references: &[Reference]) -> Result<Vec<f64>, Status> {
        let mut values = vec![0.0; references.len()];
        let (count, into) = (references.len(), values.as_mut_ptr());
        // SAFETY: see `setup`.
        let status = unsafe { (self.library.get_real)(self.component, references.as_ptr(), count, into) };
        if status == OK { Ok(values) } else { Err(status) }
    }

    pub fn reals<const N: usize>(&mut self, names: [&str; N]) -> [f64; N] {
        let references = names.map(|name| self.description.reference(name));
        let values =
            self.try_reals(&references).unwrap_or_else(|_| panic!("{names:?}: {:?}", self.log.take()));
        values.try_into().expect("as many values as names")
    }

    pub fn real(&mut self, name: &str) -> f64 {
        let [value] = self.reals([name]);
        value
    }

    /// `fmi2LastSuccessfulTime`
    pub fn time(&mut self) -> f64 {
        let mut time = f64::NAN;
        // SAFETY: see `setup`.
        assert_eq!(unsafe { (self.library.get_real_status)(self.component, 2, &mut time) }, OK);
        time
    }

    pub fn integer(&mut self, name: &str) -> i32 {
        let mut value = 0;
        let reference = self.description.reference(name);
        // SAFETY: see `setup`.
        let status = unsafe { (self.library.get_integer)(self.component, &reference, 1, &mut value) };
        assert_eq!(status, OK, "{name}");
        value
    }

    pub fn boolean(&mut self, name: &str) -> bool {
        let mut value = -1;
        let reference = self.description.reference(name);
        // SAFETY: see `setup`.
        let status = unsafe { (self.library.get_boolean)(self.component, &reference, 1, &mut value) };
        assert_eq!(status, OK, "{name}");
        assert!(value == 0 || value == 1, "{name} is the Boolean {value}");
        value == 1
    }

    /// All outputs as bits, so that equal means equal.
    pub fn outputs(&mut self) -> Vec<u64> {
        let description = self.description;
        let (reals, others): (Vec<_>, Vec<_>) = description.outputs().partition(|v| v.value_type == "Real");
        let references: Vec<_> = reals.iter().map(|variable| variable.reference).collect();
        let values = self.try_reals(&references).unwrap_or_else(|_| panic!("{:?}", self.log.take()));
        let mut bits: Vec<u64> = values.into_iter().map(f64::to_bits).collect();
        bits.extend(others.iter().map(|variable| match variable.value_type.as_str() {
            "Boolean" => u64::from(self.boolean(&variable.name)),
            _ => self.integer(&variable.name) as u64,
        }));
        bits
    }

    pub fn get_state(&mut self) -> State {
        let mut state = ptr::null_mut();
        // SAFETY: see `setup`.
        assert_eq!(unsafe { (self.library.get_state)(self.component, &mut state) }, OK);
        assert!(!state.is_null());
        state
    }

    pub fn set_state(&mut self, state: State) -> Status {
        // SAFETY: see `setup`; the tests only pass states that they got and did not free.
        unsafe { (self.library.set_state)(self.component, state) }
    }

    pub fn free_state(&mut self, mut state: State) {
        // SAFETY: see `set_state`.
        assert_eq!(unsafe { (self.library.free_state)(self.component, &mut state) }, OK);
        assert!(state.is_null());
    }

    pub fn serialize(&mut self, state: State) -> Vec<u8> {
        let mut size = 0;
        // SAFETY: see `set_state`.
        unsafe {
            assert_eq!((self.library.serialized_state_size)(self.component, state, &mut size), OK);
            let mut bytes = vec![0; size];
            assert_eq!((self.library.serialize_state)(self.component, state, bytes.as_mut_ptr(), size), OK);
            bytes
        }
    }

    pub fn enter_event_mode(&mut self) -> Status {
        // SAFETY: see `setup`.
        unsafe { (self.library.enter_event_mode)(self.component) }
    }

    pub fn new_discrete_states(&mut self) -> EventInfo {
        let mut info = EventInfo::default();
        // SAFETY: see `setup`.
        assert_eq!(unsafe { (self.library.new_discrete_states)(self.component, &mut info) }, OK);
        info
    }

    pub fn enter_continuous_time_mode(&mut self) -> Status {
        // SAFETY: see `setup`.
        unsafe { (self.library.enter_continuous_time_mode)(self.component) }
    }

    pub fn set_time(&mut self, time: f64) -> Status {
        // SAFETY: see `setup`.
        unsafe { (self.library.set_time)(self.component, time) }
    }

    pub fn set_continuous_states(&mut self, states: &[f64]) -> Status {
        // SAFETY: see `setup`.
        unsafe { (self.library.set_continuous_states)(self.component, states.as_ptr(), states.len()) }
    }

    pub fn continuous_states(&mut self) -> Vec<f64> {
        self.numbers(self.description.derivatives.len(), self.library.get_continuous_states)
    }

    pub fn derivatives(&mut self) -> Vec<f64> {
        self.numbers(self.description.derivatives.len(), self.library.get_derivatives)
    }

    pub fn nominals(&mut self) -> Vec<f64> {
        self.numbers(self.description.derivatives.len(), self.library.get_nominals)
    }

    pub fn event_indicators(&mut self) -> Vec<f64> {
        self.numbers(self.description.event_indicators, self.library.get_event_indicators)
    }

    fn numbers(
        &mut self,
        count: usize,
        get: unsafe extern "C" fn(Component, *mut f64, usize) -> Status,
    ) -> Vec<f64> {
        let mut numbers = vec![f64::NAN; count];
        // SAFETY: see `setup`.
        assert_eq!(unsafe { get(self.component, numbers.as_mut_ptr(), count) }, OK, "{:?}", self.log.take());
        numbers
    }

    /// Derivatives of `unknowns` along a direction in `knowns`.
    pub fn directional_derivative(
        &mut self,
        unknowns: &[&str],
        direction: &[(&str, f64)],
    ) -> Result<Vec<f64>, Status> {
        let reference = |name: &&str| self.description.reference(name);
        let unknowns: Vec<_> = unknowns.iter().map(reference).collect();
        let knowns: Vec<_> = direction.iter().map(|(name, _)| reference(name)).collect();
        let direction: Vec<_> = direction.iter().map(|(_, value)| *value).collect();
        let mut values = vec![f64::NAN; unknowns.len()];
        // SAFETY: see `setup`.
        let status = unsafe {
            (self.library.get_directional_derivative)(
                self.component,
                unknowns.as_ptr(),
                unknowns.len(),
                knowns.as_ptr(),
                knowns.len(),
                direction.as_ptr(),
                values.as_mut_ptr(),
            )
        };
        if status == OK { Ok(values) } else { Err(status) }
    }

    /// First time derivatives of outputs.
    pub fn output_derivatives(&mut self, names: &[&str], order: c_int) -> Result<Vec<f64>, Status> {
        let references: Vec<_> = names.iter().map(|name| self.description.reference(name)).collect();
        let (orders, mut values) = (vec![order; names.len()], vec![f64::NAN; names.len()]);
        // SAFETY: see `setup`.
        let status = unsafe {
            (self.library.get_output_derivatives)(
                self.component,
                references.as_ptr(),
                names.len(),
                orders.as_ptr(),
                values.as_mut_ptr(),
            )
        };
        if status == OK { Ok(values) } else { Err(status) }
    }

    /// A state from bytes, or the status and NULL.
    pub fn deserialize(&mut self, bytes: &[u8]) -> Result<State, Status> {
        let mut state = ptr::null_mut();
        // SAFETY: see `setup`.
        let status = unsafe {
            (self.library.deserialize_state)(self.component, bytes.as_ptr(), bytes.len(), &mut state)
        };
        if status == OK {
            return Ok(state);
        }
        assert!(state.is_null(), "a refused state must not be handed out");
        Err(status)
    }
}
