//! A step of the FMU, through the C interface of FMI 2.0.

use std::ffi::{CString, c_void};
use std::hint::black_box;
use std::ptr;

use fmi::fmi2::functions;
use fmi::fmi2::types::{
    CO_SIMULATION, CallbackFunctions, CallbackLogger, Component, ComponentEnvironment, FALSE, Status,
    String as Text,
};
use fmi::{LibraryModel, Model, guid};
use fmu::ClosedLoop;

const STEP_S: f64 = 1e-3;
/// Steps before those that are counted: the vehicle is under way.
const STEPS_BEFORE: u32 = 1_000;
/// What is read after each step.
const READ: [&str; 12] = [
    "position.x",
    "position.y",
    "position.z",
    "velocity.x",
    "velocity.y",
    "velocity.z",
    "attitude.phi",
    "attitude.theta",
    "attitude.psi",
    "body_rate.p",
    "body_rate.q",
    "body_rate.r",
];

/// Steps of a millisecond.
pub fn run(times: u32) {
    let mut instance = Instance::new();
    for _ in 0..times {
        instance.step();
    }
}

/// The same with twelve outputs read after each.
pub fn run_and_read(times: u32) {
    let mut instance = Instance::new();
    let references = READ.map(reference);
    for _ in 0..times {
        instance.step();
        black_box(instance.read(&references));
    }
}

/// The value reference of a variable: its index in the table.
fn reference(name: &str) -> u32 {
    let mut variables = ClosedLoop::VARIABLES.iter().flat_map(|group| group.iter());
    let place = variables.position(|variable| variable.name == name);
    place.and_then(|place| u32::try_from(place).ok()).unwrap_or_else(|| panic!("there is no variable {name}"))
}

/// An instance that is under way.
struct Instance {
    component: Component,
    steps: u32,
}

/// Takes no message: nothing is logged, and nothing fails.
unsafe extern "C" fn ignore(
    _environment: ComponentEnvironment,
    _instance: Text,
    _status: Status,
    _category: Text,
    _format: Text,
    _message: Text,
) {
}

impl Instance {
    fn new() -> Self {
        let guid = CString::new(guid::<ClosedLoop>()).expect("a GUID has no NUL");
        // SAFETY: C calls a function with more arguments than it looks at.
        let logger = unsafe { std::mem::transmute::<*const c_void, CallbackLogger>(ignore as *const c_void) };
        let callbacks = CallbackFunctions {
            logger: Some(logger),
            allocate_memory: None,
            free_memory: None,
            step_finished: None,
            component_environment: ptr::null_mut(),
        };
        let models = [LibraryModel::of::<ClosedLoop>()];
        let (name, token) = (c"counted", guid.as_ptr());
        // SAFETY: names, callbacks and models are there during the call, and the logger is a function.
        let component = unsafe {
            functions::instantiate(
                &models,
                name.as_ptr(),
                CO_SIMULATION,
                token,
                ptr::null(),
                &callbacks,
                FALSE,
                FALSE,
            )
        };
        assert!(!component.is_null(), "not instantiated");
        let armed = [reference("armed")];
        // SAFETY: the component is an instance that nobody else has, and the arrays have one element.
        let statuses = unsafe {
            [
                functions::setup_experiment(component, FALSE, 0.0, 0.0, FALSE, 0.0),
                functions::enter_initialization_mode(component),
                functions::set_boolean(component, armed.as_ptr(), 1, [1].as_ptr()),
                functions::set_real(
                    component,
                    [reference("reference.position.x")].as_ptr(),
                    1,
                    [5.0].as_ptr(),
                ),
                functions::set_real(
                    component,
                    [reference("reference.position.z")].as_ptr(),
                    1,
                    [-10.0].as_ptr(),
                ),
                functions::exit_initialization_mode(component),
            ]
        };
        assert!(statuses.iter().all(|status| *status == Status::Ok), "{statuses:?}");
        let mut instance = Self { component, steps: 0 };
        for _ in 0..STEPS_BEFORE {
            instance.step();
        }
        instance
    }

    fn step(&mut self) {
        // SAFETY: the component is an instance that nobody else has.
        let status =
            unsafe { functions::do_step(self.component, f64::from(self.steps) * STEP_S, STEP_S, FALSE) };
        assert!(status == Status::Ok, "{status:?}");
        self.steps += 1;
    }

    fn read<const N: usize>(&mut self, references: &[u32; N]) -> [f64; N] {
        let mut values = [0.0; N];
        // SAFETY: the component is an instance that nobody else has, and both arrays have N elements.
        let status =
            unsafe { functions::get_real(self.component, references.as_ptr(), N, values.as_mut_ptr()) };
        assert!(status == Status::Ok, "{status:?}");
        values
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: the component is an instance, and is not used again.
        unsafe { functions::free_instance(self.component) }
    }
}
