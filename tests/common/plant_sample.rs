//! What the checks need to know of the plant.

use super::subject::{Eventful, Sample};

pub const PLANT: Sample = Sample {
    library: "fmu",
    model_name: "QuadrotorPlant",
    model_identifier: "QuadrotorPlant",
    run: "flight",
    input: "disturbance.force.x",
    switch: "rotor.failed[1]",
    output: "position.z",
    tunable: "airframe.drag.x",
    fixed: ("initial.discharge", 0.9),
    initial: ("initial.position.x", 2.0, "position.x"),
    contradiction: ("airframe.inertia.xy", 50.0, 0.001),
    // A torque that no body of this size survives.
    breaking: [&[("disturbance.torque.z", 1e3)], &[]],
    longest_step: 3600.0,
    good: &[
        ("rotor.command[1]", 255.0),
        ("airframe.drag.z", 0.3),
        ("rotor.command[2]", 257.0),
        ("airframe.mass", 0.75),
        ("disturbance.force.z", 0.5),
    ],
    bad: &[
        ("disturbance.torque.x", f64::NAN),
        ("airframe.mass", 99.0),
        ("initial.discharge", 0.8),
        ("thrust", 1.0),
    ],
    // Rotors on their way and a battery that is drained are part of its state.
    eventful: Eventful {
        reals: &[
            ("disturbance.force.x", 0.5),
            ("airframe.drag.x", 0.1),
            ("wind.velocity.x", 4.0),
            ("airframe.rotor.inertia", 1e-4),
            ("rotor.command[3]", 270.0),
        ],
        integers: &[("airframe.preset", 1)],
        booleans: &[("airframe.battery.sag", true), ("environment.ground_plane", true)],
        on_the_way: &[("rotor.command[2]", 275.0), ("airframe.mass", 0.65)],
        derivative: ("rotor.command[1]", 1, 0.5),
    },
    unshaped: &[],
    points: &[
        (&[], &[("environment.ground_plane", false)]),
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
                ("initial.discharge", 0.3),
                ("airframe.drag.x", 0.1),
                ("airframe.drag.y", 0.1),
                ("airframe.drag.z", 0.1),
                ("airframe.rotor.drag_coefficient", 1e-4),
                ("airframe.rotor.inertia", 1e-4),
                ("wind.velocity.y", 3.0),
            ],
            &[("environment.ground_plane", true), ("airframe.battery.sag", true)],
        ),
    ],
    dependent: 40,
    state_numbers: 30,
    numbers: 60,
};
