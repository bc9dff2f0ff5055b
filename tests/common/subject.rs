//! The models that go through the same checks: the closed-loop quadrotor, its controllers alone, and a first-order lag.

use super::description::Description;
use super::library::Library;
use super::plant_sample::PLANT;

#[path = "../lag/src/model.rs"]
pub(super) mod lag_model;

/// A built library with its description, and names and values for the checks.
pub struct Subject {
    pub library: Library,
    pub description: Description,
    pub sample: Sample,
}

/// Variables with values.
type Reals = &'static [(&'static str, f64)];
type Booleans = &'static [(&'static str, bool)];

/// What the checks need to know of a model.
pub struct Sample {
    /// File name of the library.
    pub library: &'static str,
    pub model_name: &'static str,
    pub model_identifier: &'static str,
    /// What its log calls a run.
    pub run: &'static str,
    /// A continuous input whose range contains 0 to 8.
    pub input: &'static str,
    /// A Boolean input.
    pub switch: &'static str,
    /// A real output that moves past ±0.1 in a second, with nothing set.
    pub output: &'static str,
    /// A tunable parameter.
    pub tunable: &'static str,
    /// A fixed parameter and a value of it.
    pub fixed: (&'static str, f64),
    /// A parameter, a value of it, and what has this value then at the beginning.
    pub initial: (&'static str, f64, &'static str),
    /// A tunable parameter, a value in its range that does not fit to the others, and one that does.
    pub contradiction: (&'static str, f64, f64),
    /// Values with which a run breaks within 5 s.
    pub breaking: Breaking,
    /// The longest communication step, s.
    pub longest_step: f64,
    /// What may be set together in a run.
    pub good: Reals,
    /// What may not be set in a run.
    pub bad: Reals,
    /// A run in which much happens, so that its state is not a simple one.
    pub eventful: Eventful,
    /// Switches with which a derivative of the input acts within half a second.
    pub unshaped: Booleans,
    /// Values from which each input and parameter is changed alone.
    pub points: &'static [(Reals, Booleans)],
    /// At least so many initial unknowns then change.
    pub dependent: usize,
    /// At least so many numbers are in a saved state.
    pub state_numbers: usize,
    /// At least so many variables have a start value that is a number.
    pub numbers: usize,
}

/// Start values, and values that are set in the run.
pub struct Breaking {
    pub integers: &'static [(&'static str, i32)],
    pub start: Reals,
    pub in_the_run: Reals,
}

/// Start values, and values and a derivative that are set on the way.
pub struct Eventful {
    pub reals: Reals,
    pub integers: &'static [(&'static str, i32)],
    pub booleans: Booleans,
    pub on_the_way: Reals,
    pub derivative: (&'static str, i32, f64),
}

impl Subject {
    /// The closed-loop quadrotor.
    pub fn closed_loop() -> Self {
        let text = fmi::description::model_description::<fmu::ClosedLoop>();
        Self {
            library: Library::load(CLOSED_LOOP.library),
            description: Description::parse(text),
            sample: CLOSED_LOOP,
        }
    }

    /// The controllers.
    pub fn controller() -> Self {
        let text = fmi::description::model_description::<fmu::Controller>();
        Self {
            library: Library::load(CONTROLLER.library),
            description: Description::parse(text),
            sample: CONTROLLER,
        }
    }

    /// The first-order lag.
    pub fn lag() -> Self {
        let text = fmi::description::model_description::<lag_model::Lag>();
        Self { library: Library::load(LAG.library), description: Description::parse(text), sample: LAG }
    }

    /// The plant alone.
    pub fn plant() -> Self {
        let text = fmi::description::model_description::<fmu::QuadrotorPlant>();
        Self { library: Library::load(PLANT.library), description: Description::parse(text), sample: PLANT }
    }
}

const CLOSED_LOOP: Sample = Sample {
    library: "fmu",
    model_name: "LmpcQuadrotor",
    model_identifier: "LmpcQuadrotor",
    run: "flight",
    input: "reference.position.x",
    switch: "armed",
    output: "position.z",
    tunable: "limits.tilt",
    fixed: ("airframe.mass", 0.9),
    initial: ("initial.position.x", 2.0, "position.x"),
    contradiction: ("limits.acceleration.horizontal", 15.0, 2.0),
    // A torque that no body of this size survives.
    breaking: Breaking { integers: &[], start: &[("disturbance.torque.z", 1e3)], in_the_run: &[] },
    longest_step: 3600.0,
    good: &[
        ("reference.position.x", 1.0),
        ("limits.jerk.vertical", 5.0),
        ("reference.position.y", 2.0),
        ("limits.speed.up", 1.5),
        ("disturbance.force.z", 0.5),
    ],
    bad: &[("disturbance.torque.x", f64::NAN), ("limits.tilt", 9.0), ("airframe.mass", 0.8), ("thrust", 1.0)],
    // Warm starts, an estimate and the place in the sequence of noise are part of its state.
    eventful: Eventful {
        reals: &[
            ("disturbance.force.x", 0.5),
            ("airframe.drag.x", 0.1),
            ("wind.velocity.x", 4.0),
            ("sensor.position_noise", 0.02),
            ("sensor.attitude_noise", 0.005),
        ],
        integers: &[("controller.kind", 2), ("sensor.seed", 5)],
        booleans: &[("sensor.output_feedback", true), ("reference.shaping", false)],
        on_the_way: &[("reference.position.y", 1.0), ("limits.tilt", 0.45)],
        derivative: ("reference.position.y", 1, 0.5),
    },
    unshaped: &[("reference.shaping", false)],
    points: &[
        (&[], &[("environment.ground_plane", false)]),
        (&[], &[("reference.shaping", false)]),
        (
            &[
                // With this attitude the right foot is 2 mm deep.
                ("initial.position.z", -0.1003),
                ("initial.velocity.x", 2.0),
                ("initial.velocity.y", -1.0),
                ("initial.attitude.phi", 0.4),
                ("initial.attitude.theta", 0.3),
                ("initial.attitude.psi", -1.0),
                ("initial.body_rate.p", 0.2),
                ("airframe.drag.x", 0.1),
                ("airframe.drag.y", 0.1),
                ("airframe.drag.z", 0.1),
                ("wind.velocity.y", 3.0),
            ],
            &[("environment.ground_plane", true)],
        ),
    ],
    dependent: 41,
    state_numbers: 101,
    numbers: 51,
};

const CONTROLLER: Sample = Sample {
    library: "fmu",
    model_name: "LmpcController",
    model_identifier: "LmpcController",
    run: "flight",
    input: "reference.position.x",
    switch: "armed",
    output: "setpoint.position.z",
    tunable: "limits.tilt",
    fixed: ("airframe.mass", 0.9),
    initial: ("airframe.mass", 0.8, "airframe.mass"),
    contradiction: ("limits.acceleration.horizontal", 15.0, 2.0),
    // No attitude.
    breaking: Breaking {
        integers: &[("measurement.attitude", 1)],
        start: &[],
        in_the_run: &[("measured.attitude.q0", 0.0)],
    },
    longest_step: 3600.0,
    good: &[
        ("reference.position.x", 1.0),
        ("limits.jerk.vertical", 5.0),
        ("reference.position.y", 2.0),
        ("limits.speed.up", 1.5),
        ("measured.velocity.z", 0.5),
    ],
    bad: &[
        ("measured.position.x", f64::NAN),
        ("limits.tilt", 9.0),
        ("airframe.mass", 0.8),
        ("command.thrust", 1.0),
    ],
    // Warm starts, an estimate and predicted rotor speeds are part of its state.
    eventful: Eventful {
        reals: &[
            ("measured.position.x", 0.1),
            ("measured.velocity.y", 0.2),
            ("measured.attitude.phi", 0.02),
            ("airframe.drag.x", 0.1),
            ("sensor.position_noise", 0.02),
            ("sensor.attitude_noise", 0.005),
        ],
        integers: &[("controller.kind", 2), ("measurement.rotor_speeds", 1)],
        booleans: &[("sensor.output_feedback", true), ("reference.shaping", false)],
        on_the_way: &[("reference.position.y", 1.0), ("limits.tilt", 0.45)],
        derivative: ("measured.position.y", 1, 0.5),
    },
    unshaped: &[("reference.shaping", false)],
    points: &[
        (&[], &[("environment.ground_plane", false)]),
        (&[], &[("reference.shaping", false)]),
        (
            &[
                ("measured.position.z", -0.1),
                ("measured.velocity.x", 2.0),
                ("measured.attitude.phi", 0.4),
                ("measured.attitude.psi", -1.0),
                ("measured.body_rate.p", 0.2),
                ("measured.rotor.speed[1]", 260.0),
                ("measured.rotor.speed[2]", 240.0),
                ("airframe.drag.x", 0.1),
            ],
            &[("environment.ground_plane", true)],
        ),
    ],
    dependent: 20,
    state_numbers: 90,
    numbers: 51,
};

const LAG: Sample = Sample {
    library: "lag",
    model_name: "Lag",
    model_identifier: "lag",
    run: "simulation",
    input: "u",
    switch: "hold",
    output: "y",
    tunable: "time_constant",
    fixed: ("limit", 40.0),
    initial: ("limit", 20.0, "limit"),
    contradiction: ("gain", 60.0, 3.0),
    breaking: Breaking { integers: &[], start: &[("u", 10.0), ("gain", 50.0)], in_the_run: &[] },
    longest_step: 1800.0,
    good: &[("u", 3.0), ("gain", 1.5), ("time_constant", 0.7)],
    bad: &[("u", f64::NAN), ("gain", 1e3), ("limit", 20.0), ("y", 1.0)],
    eventful: Eventful {
        reals: &[("u", -3.0), ("time_constant", 0.3)],
        integers: &[("divisor", 3), ("sign", 2)],
        booleans: &[("hold", true)],
        on_the_way: &[("gain", 4.0)],
        derivative: ("u", 1, 0.5),
    },
    unshaped: &[],
    points: &[(&[], &[("hold", false)])],
    dependent: 1,
    state_numbers: 6,
    numbers: 6,
};
