//! The controllers and the plant as models of one library, wired as importers wire them: by the values of their variables.

use fmi::Model;
use fmi::variables::{Field, Role, Signal, Variable};
use fmu::{
    ClosedLoop, Commands, Controller, ControllerInputs, ControllerParameters, QuadrotorPlant, Settings,
};
use quadrotor::{Configuration, Inputs};

/// A real output by its name.
fn output<M: Model>(outputs: &M::Outputs, name: &str) -> f64 {
    let found = M::VARIABLES.iter().copied().flatten().find(|variable| variable.name == name);
    match found.map(|variable| &variable.role) {
        Some(Role::Output { signal: Signal::Real { get, .. }, .. }) => get(outputs),
        _ => panic!("{name} is no real output"),
    }
}

/// Sets each real input that `source` knows.
fn connect<M: Model>(inputs: &mut M::Inputs, source: impl Fn(&str) -> Option<f64>) {
    for Variable { name, role, .. } in M::VARIABLES.iter().copied().flatten() {
        if let (Role::Input(Field::Real { set, .. }), Some(value)) = (role, source(name)) {
            set(inputs, value);
        }
    }
}

/// As by a master that steps the controllers first.
#[test]
fn wired_by_their_variables_they_are_the_closed_loop() {
    let configuration = Configuration { ..Configuration::default() };
    let parameters = ControllerParameters { configuration, ..ControllerParameters::default() };
    let settings = Settings { configuration, ..Settings::default() };
    let inputs = Inputs::default();
    let mut closed = ClosedLoop::new(&configuration, &inputs).unwrap();
    let (mut measured, mut commands) = (ControllerInputs::default(), Commands::default());
    let mut controller = Controller::new(&parameters, &measured).unwrap();
    let mut plant = QuadrotorPlant::new(&settings, &commands).unwrap();
    for time_us in (1_000..=20_000_000).step_by(1_000) {
        let motion = plant.outputs();
        connect::<Controller>(&mut measured, |name| {
            Some(output::<QuadrotorPlant>(&motion, name.strip_prefix("measured.")?))
        });
        controller.advance_to(time_us, &|_| measured).unwrap();
        let commanded = controller.outputs();
        connect::<QuadrotorPlant>(&mut commands, |name| {
            name.contains("command").then(|| output::<Controller>(&commanded, name))
        });
        plant.advance_to(time_us, &|_| commands).unwrap();
        closed.advance_to(time_us, &|_| inputs).unwrap();
        let (expected, motion) = (closed.outputs(), plant.outputs());
        for (name, value) in [
            ("position.x", expected.position_m.x),
            ("velocity.z", expected.velocity_m_s.z),
            ("attitude.phi", expected.attitude_rad.x),
            ("attitude.q3", expected.quaternion[3]),
            ("rotor.speed[2]", expected.rotor_speed_rad_s[1]),
            ("thrust", expected.thrust_n),
        ] {
            assert_eq!(output::<QuadrotorPlant>(&motion, name), value, "{name} at {time_us} us");
        }
    }
}
