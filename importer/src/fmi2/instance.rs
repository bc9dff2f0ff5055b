//! One instance of an FMU.

use std::ffi::{CString, c_int, c_void};
use std::path::Path;
use std::ptr::NonNull;

use super::functions::Functions;
use super::logger::{Message, Receiver, importer_logger};
use super::types::{CO_SIMULATION, Call, Callbacks, FALSE, Status, TRUE, Text};
use crate::error::{CallError, ImportError};

unsafe extern "C" fn allocate(count: usize, size: usize) -> *mut c_void {
    // SAFETY: any sizes are allowed; too large ones give null.
    unsafe { libc::calloc(count, size) }
}

unsafe extern "C" fn free(memory: *mut c_void) {
    // SAFETY: the FMU frees what it has allocated, or null.
    unsafe { libc::free(memory) }
}

/// What may still be called.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Life {
    /// Everything.
    Sound,
    /// After fmi2Error: only that it is freed.
    Failed,
    /// After fmi2Fatal: nothing.
    Dead,
}

/// An instance for co-simulation. Calls go in the order of the standard: [`set_up`](Self::set_up),
/// [`enter_initialization`](Self::enter_initialization), [`exit_initialization`](Self::exit_initialization), steps,
/// [`terminate`](Self::terminate). It is freed with the value.
pub struct Instance {
    functions: Functions,
    component: NonNull<c_void>,
    life: Life,
    /// Told before each call.
    announce: Box<dyn FnMut(Call) + Send>,
    /// Where the FMU has been told they are, for as long as it lives.
    _callbacks: Box<Callbacks>,
    _receiver: Receiver,
}

/// What an instance is made from.
pub(crate) struct Birth<'a> {
    /// The library.
    pub(crate) library: &'a Path,
    /// The model's identification.
    pub(crate) guid: &'a str,
    /// URI of its resources.
    pub(crate) resources: &'a str,
    /// Name of the instance.
    pub(crate) name: &'a str,
    /// Whether it tells more than warnings.
    pub(crate) debug: bool,
}

// SAFETY: the standard allows calls from any thread, one at a time; `&mut self` sees to the latter.
unsafe impl Send for Instance {}

impl std::fmt::Debug for Instance {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("Instance").field("life", &self.life).finish_non_exhaustive()
    }
}

impl Instance {
    /// Loads the library and makes an instance. `take` receives what the FMU logs, `announce` each call before it is made.
    ///
    /// # Errors
    /// [`ImportError`]
    pub(crate) fn new(
        birth: &Birth<'_>,
        take: impl FnMut(Message) + Send + 'static,
        mut announce: Box<dyn FnMut(Call) + Send>,
    ) -> Result<Self, ImportError> {
        announce(Call::Load);
        let functions = Functions::load(birth.library)?;
        let receiver = Receiver::new(take);
        let callbacks = Box::new(Callbacks {
            logger: importer_logger,
            allocate,
            free,
            step_finished: None,
            environment: receiver.environment(),
        });
        let [name, guid, resources] = [c_text(birth.name)?, c_text(birth.guid)?, c_text(birth.resources)?];
        announce(Call::Instantiate);
        // SAFETY: the texts end with a zero and are copied by the FMU; the callbacks are boxed and outlive it.
        let component = unsafe {
            (functions.instantiate)(
                name.as_ptr(),
                CO_SIMULATION,
                guid.as_ptr(),
                resources.as_ptr(),
                &raw const *callbacks,
                FALSE,
                c_int::from(birth.debug),
            )
        };
        announce(Call::Nothing);
        let component = NonNull::new(component).ok_or(ImportError::Instantiate)?;
        Ok(Self {
            functions,
            component,
            life: Life::Sound,
            announce,
            _callbacks: callbacks,
            _receiver: receiver,
        })
    }

    /// Says when the experiment begins, s, and when it ends, if that is known.
    ///
    /// # Errors
    /// [`CallError`]
    pub fn set_up(&mut self, start_s: f64, stop_s: Option<f64>) -> Result<(), CallError> {
        let function = self.functions.setup_experiment;
        let (defined, stop_s) = (c_int::from(stop_s.is_some()), stop_s.unwrap_or(0.0));
        // SAFETY: the component is alive, see `call`.
        self.call(Call::SetupExperiment, |component| unsafe {
            function(component, FALSE, 0.0, start_s, defined, stop_s)
        })
    }

    /// Begins the initialization.
    ///
    /// # Errors
    /// [`CallError`]
    pub fn enter_initialization(&mut self) -> Result<(), CallError> {
        let function = self.functions.enter_initialization;
        // SAFETY: the component is alive, see `call`.
        self.call(Call::EnterInitializationMode, |component| unsafe { function(component) })
    }

    /// Ends the initialization: steps can follow.
    ///
    /// # Errors
    /// [`CallError`]
    pub fn exit_initialization(&mut self) -> Result<(), CallError> {
        let function = self.functions.exit_initialization;
        // SAFETY: the component is alive, see `call`.
        self.call(Call::ExitInitializationMode, |component| unsafe { function(component) })
    }

    /// Ends the simulation.
    ///
    /// # Errors
    /// [`CallError`]
    pub fn terminate(&mut self) -> Result<(), CallError> {
        let function = self.functions.terminate;
        // SAFETY: the component is alive, see `call`.
        self.call(Call::Terminate, |component| unsafe { function(component) })
    }

    /// Simulates from one time, s, on by a step, s.
    ///
    /// # Errors
    /// [`CallError`]: a discarded or pending step is one, too.
    pub fn step(&mut self, time_s: f64, step_s: f64) -> Result<(), CallError> {
        let function = self.functions.do_step;
        // SAFETY: the component is alive, see `call`. No state before the step will be asked for again.
        self.call(Call::DoStep, |component| unsafe { function(component, time_s, step_s, TRUE) })
    }

    /// Sets real variables; as many values as references.
    ///
    /// # Errors
    /// [`CallError`]
    pub fn set_reals(&mut self, references: &[u32], values: &[f64]) -> Result<(), CallError> {
        let function = self.functions.set_real;
        self.set(Call::SetReal, function, references, values)
    }

    /// Sets integer and enumeration variables; as many values as references.
    ///
    /// # Errors
    /// [`CallError`]
    pub fn set_integers(&mut self, references: &[u32], values: &[i32]) -> Result<(), CallError> {
        let function = self.functions.set_integer;
        self.set(Call::SetInteger, function, references, values)
    }

    /// Sets boolean variables; as many values as references.
    ///
    /// # Errors
    /// [`CallError`]
    pub fn set_booleans(&mut self, references: &[u32], values: &[bool]) -> Result<(), CallError> {
        let values: Vec<c_int> = values.iter().copied().map(c_int::from).collect();
        let function = self.functions.set_boolean;
        self.set(Call::SetBoolean, function, references, &values)
    }

    /// Sets a string variable. Nothing is set if the text has a zero in it, which no C text can have.
    ///
    /// # Errors
    /// [`CallError`]
    pub fn set_string(&mut self, reference: u32, value: &str) -> Result<(), CallError> {
        let wrong = CallError { call: Call::SetString, status: Status::Error };
        let value = CString::new(value).map_err(|_| wrong)?;
        let function = self.functions.set_string;
        self.set(Call::SetString, function, &[reference], &[value.as_ptr()])
    }

    /// Reads real variables; as many values as references.
    ///
    /// # Errors
    /// [`CallError`]
    pub fn reals(&mut self, references: &[u32], values: &mut [f64]) -> Result<(), CallError> {
        let function = self.functions.get_real;
        self.get(Call::GetReal, function, references, values)
    }

    /// Reads integer and enumeration variables; as many values as references.
    ///
    /// # Errors
    /// [`CallError`]
    pub fn integers(&mut self, references: &[u32], values: &mut [i32]) -> Result<(), CallError> {
        let function = self.functions.get_integer;
        self.get(Call::GetInteger, function, references, values)
    }

    /// Reads boolean variables.
    ///
    /// # Errors
    /// [`CallError`]
    pub fn booleans(&mut self, references: &[u32]) -> Result<Vec<bool>, CallError> {
        let mut values = vec![FALSE; references.len()];
        let function = self.functions.get_boolean;
        self.get(Call::GetBoolean, function, references, &mut values)?;
        Ok(values.into_iter().map(|value| value != FALSE).collect())
    }

    fn set<T>(
        &mut self,
        call: Call,
        function: super::types::Set<T>,
        references: &[u32],
        values: &[T],
    ) -> Result<(), CallError> {
        let count = references.len().min(values.len());
        if count == 0 {
            return Ok(());
        }
        // SAFETY: the component is alive, see `call`; both slices have at least `count` elements.
        self.call(call, |component| unsafe {
            function(component, references.as_ptr(), count, values.as_ptr())
        })
    }

    fn get<T>(
        &mut self,
        call: Call,
        function: super::types::Get<T>,
        references: &[u32],
        values: &mut [T],
    ) -> Result<(), CallError> {
        let count = references.len().min(values.len());
        if count == 0 {
            return Ok(());
        }
        // SAFETY: the component is alive, see `call`; both slices have at least `count` elements.
        self.call(call, |component| unsafe {
            function(component, references.as_ptr(), count, values.as_mut_ptr())
        })
    }

    /// Makes a call unless an earlier one has ended the instance.
    fn call(&mut self, call: Call, make: impl FnOnce(*mut c_void) -> c_int) -> Result<(), CallError> {
        if self.life != Life::Sound {
            return Err(CallError { call, status: Status::Error });
        }
        (self.announce)(call);
        let status = Status::from(make(self.component.as_ptr()));
        (self.announce)(Call::Nothing);
        match status {
            Status::Ok | Status::Warning => return Ok(()),
            Status::Discard => {}
            Status::Error | Status::Pending | Status::Unknown(_) => self.life = Life::Failed,
            Status::Fatal => self.life = Life::Dead,
        }
        Err(CallError { call, status })
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        if self.life != Life::Dead {
            (self.announce)(Call::FreeInstance);
            // SAFETY: the component is alive and nobody has it after this.
            unsafe { (self.functions.free_instance)(self.component.as_ptr()) };
            (self.announce)(Call::Nothing);
        }
    }
}

fn c_text(text: &str) -> Result<CString, ImportError> {
    CString::new(text).map_err(|_| ImportError::Text(text.to_owned()))
}

/// `fmi2SetString` takes pointers to texts.
const _: () = assert!(size_of::<Text>() == size_of::<*const c_void>());
