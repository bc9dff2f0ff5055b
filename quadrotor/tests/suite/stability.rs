//! Configurations that would lose the vehicle are refused, at the start and in flight; those that fly badly are warned about.

use crate::common::{KINDS, goal};
use quadrotor::{
    AirframePreset, Configuration, ConfigurationError, Inputs, PredictionModel, Sensors, Simulation,
    StabilityReport, StabilityWarning,
};

type Change = fn(&mut Configuration);

fn refused(change: impl Fn(&mut Configuration)) -> String {
    let mut configuration = Configuration::default();
    change(&mut configuration);
    let error = Simulation::new(&configuration, &goal([1.0, 0.0, -1.0], 0.0)).expect_err("refused");
    assert_eq!(StabilityReport::new(&configuration), Err(error.clone()));
    error.to_string()
}

/// Each names what is wrong, the value to blame, and one that is allowed.
#[test]
fn values_that_lose_the_vehicle_are_refused_by_their_names() {
    // Models with the rotors' lag in them fly with any lag; the printed ones do not.
    let mut late = Configuration::default();
    late.airframe.rotor_time_constant_s = 0.3;
    StabilityReport::new(&late).expect("a lag that is known");
    let lag = refused(|configuration| {
        configuration.controllers.model = PredictionModel::Paper;
        configuration.airframe.rotor_time_constant_s = 0.3;
    });
    assert!(lag.starts_with("the north loop is unstable: errors double every 0."), "{lag}");
    assert!(lag.ends_with("caused by airframe.rotor.time_constant = 0.3 s, stable with 0.03 s"), "{lag}");

    let weight = refused(|configuration| {
        configuration.controllers.model = PredictionModel::Paper;
        configuration.controllers.attitude.output_weight[1] = 1e5;
    });
    assert!(weight.starts_with("the pitch loop is unstable"), "{weight}");
    assert!(
        weight.ends_with("caused by controller.attitude.output_weight.theta = 100000, stable with 1"),
        "{weight}"
    );

    assert_eq!(
        refused(|configuration| configuration.airframe.inertia_kg_m2[0] = 1e-5),
        "airframe.inertia.x = 1e-5 kg·m² must be at least 0.001059 kg·m²: the other two moments of inertia differ by \
         a hundred times that; change one of them first, or set this limit for now"
    );
    assert_eq!(
        refused(|configuration| configuration.airframe.inertia_kg_m2 = [1e-5; 3]),
        "airframe.inertia.x = 1e-5 kg·m² must be at least 3.147e-4 kg·m²: with less the rotors spin it by over 30 \
         rad/s within one controller.attitude.sample_time"
    );
    let drag = refused(|configuration| configuration.airframe.torque_coefficient_n_m_s2 = 0.01);
    assert!(
        drag.starts_with("airframe.rotor.torque_coefficient = 0.01 N·m·s² must be at most 0.00"),
        "{drag}"
    );
}

/// Parameters that arrive one by one: a refused step names a value that is allowed, and from there the way goes on.
#[test]
fn moments_of_inertia_reach_any_target_one_by_one() {
    for (start, target) in
        [([0.106, 0.106, 0.212], [9e-4, 9e-4, 1.8e-3]), ([9e-4, 9e-4, 1.8e-3], [0.106, 0.106, 0.212])]
    {
        let mut configuration = Configuration::default();
        configuration.airframe.inertia_kg_m2 = start;
        StabilityReport::new(&configuration).expect("the start flies");
        let mut refusals = 0;
        for _ in 0..3 {
            for (axis, wanted) in target.into_iter().enumerate() {
                let mut changed = configuration;
                changed.airframe.inertia_kg_m2[axis] = wanted;
                match StabilityReport::new(&changed) {
                    Err(ConfigurationError::Inconsistent { name, limit, .. }) => {
                        refusals += 1;
                        let named = ["airframe.inertia.x", "airframe.inertia.y", "airframe.inertia.z"]
                            .iter()
                            .position(|each| *each == name)
                            .expect("a moment of inertia");
                        configuration.airframe.inertia_kg_m2[named] = limit.value;
                    }
                    other => {
                        other.expect("flies");
                        configuration = changed;
                    }
                }
                StabilityReport::new(&configuration).expect("flies at the limit");
            }
        }
        assert!(refusals > 0);
        assert_eq!(configuration.airframe.inertia_kg_m2, target);
    }
}

/// The most noise of the attitude that can be set, 0.5 rad, is flown, with warnings: see below.
#[test]
fn noise_that_no_flight_survives_is_refused_by_its_source() {
    let cases: [(&str, Change); 2] = [
        // Each is filtered with the help of the other one.
        ("10 m", |configuration| {
            configuration.sensors.position_noise_m = 10.0;
            configuration.sensors.velocity_noise_m_s = 10.0;
        }),
        ("sensor.body_rate_noise = 10 rad/s", |configuration| {
            configuration.sensors.body_rate_noise_rad_s = 10.0;
        }),
    ];
    for (expected, change) in cases {
        let message = refused(|configuration| {
            // A little of everything else.
            configuration.sensors.position_noise_m = 0.01;
            configuration.sensors.attitude_noise_rad = 0.001;
            change(configuration);
        });
        assert!(message.contains(" is too much noise: the t"), "{message}");
        assert!(message.starts_with("sensor.") && message.contains(expected), "{message}");
        assert!(message.ends_with("lower it"), "{message}");
    }
}

/// Positions tell the velocity when its measurement says nothing.
#[test]
fn a_noisy_velocity_is_filtered() {
    let mut configuration = Configuration::default();
    configuration.sensors.position_noise_m = 0.01;
    configuration.sensors.velocity_noise_m_s = 10.0;
    let report = StabilityReport::new(&configuration).expect("flies");
    assert_eq!(report.warnings(), []);
}

/// Two values that are at odds only together: the message names one that mends it.
#[test]
fn a_combination_is_judged_as_a_whole() {
    let slow_rotors = |configuration: &mut Configuration| {
        configuration.controllers.model = PredictionModel::Paper;
        configuration.airframe.rotor_time_constant_s = 0.04;
    };
    let heavy_weight = |configuration: &mut Configuration| {
        configuration.controllers.model = PredictionModel::Paper;
        configuration.controllers.position.output_weight.fill(2.0);
    };
    for change in [slow_rotors, heavy_weight] {
        let mut configuration = Configuration::default();
        change(&mut configuration);
        StabilityReport::new(&configuration).expect("each alone flies");
    }
    let message = refused(|configuration| {
        slow_rotors(configuration);
        heavy_weight(configuration);
    });
    assert!(message.starts_with("the north loop is unstable"), "{message}");
    assert!(
        message.ends_with("caused by airframe.rotor.time_constant = 0.04 s, stable with 0.03 s"),
        "{message}"
    );
}

/// A refused change leaves the flight as it is, bit for bit, and names the parameter that was changed.
#[test]
fn a_change_that_would_lose_the_vehicle_leaves_the_flight_alone() {
    let inputs = goal([1.0, 0.5, -1.0], 0.3);
    let mut configuration = Configuration::default();
    // Not the default's: the cause is what has changed in flight.
    configuration.controllers.model = PredictionModel::Paper;
    configuration.airframe.rotor_time_constant_s = 0.02;
    let mut flight = Simulation::new(&configuration, &inputs).expect("a flight");
    let mut undisturbed = flight.clone();
    for simulation in [&mut flight, &mut undisturbed] {
        simulation.advance_to(1_000_000, &inputs).expect("flies");
    }
    let mut changed = configuration;
    changed.airframe.rotor_time_constant_s = 0.06;
    match flight.reconfigure(&changed) {
        Err(ConfigurationError::Unstable { name: "north", cause: Some(cause), .. }) => {
            assert_eq!(
                (cause.name, cause.value.value, cause.stable.value),
                ("airframe.rotor.time_constant", 0.06, 0.02)
            );
        }
        other => panic!("{other:?}"),
    }
    assert_eq!(*flight.configuration(), configuration);
    for simulation in [&mut flight, &mut undisturbed] {
        simulation.advance_to(3_000_000, &inputs).expect("flies");
    }
    assert_eq!(flight.state(), undisturbed.state());
}

#[test]
fn what_flies_badly_is_accepted_with_a_warning() {
    let warnings = |change: fn(&mut Configuration)| {
        let mut configuration = Configuration::default();
        change(&mut configuration);
        StabilityReport::new(&configuration).expect("accepted").warnings().to_vec()
    };
    assert_eq!(warnings(|_| ()), []);
    let slow = warnings(|configuration| configuration.controllers.altitude.output_weight.fill(1e-8));
    assert!(matches!(slow[..], [StabilityWarning::Slow { name: "altitude", .. }]), "{slow:?}");
    // The printed model does not know that the rotors answer late.
    let swings = warnings(|configuration| configuration.controllers.model = PredictionModel::Paper);
    assert!(
        swings.iter().any(|each| matches!(each, StabilityWarning::Swings { name: "north", .. })),
        "{swings:?}"
    );
    // On the way to noise that is refused.
    let shaken = (0..17).map(|step| 0.1 * 1.3_f64.powi(step)).any(|noise| {
        let mut configuration = Configuration::default();
        (configuration.sensors.position_noise_m, configuration.sensors.velocity_noise_m_s) = (noise, noise);
        StabilityReport::new(&configuration).is_ok_and(|report| {
            report.warnings().iter().any(|each| matches!(each, StabilityWarning::Shaken { .. }))
        })
    });
    assert!(shaken);
    let saturated = warnings(|configuration| configuration.sensors.attitude_noise_rad = 0.5);
    assert!(
        saturated.iter().any(|each| matches!(each, StabilityWarning::Saturated { name: "roll", .. })),
        "{saturated:?}"
    );
    let rod = warnings(|configuration| configuration.airframe.inertia_kg_m2[0] = 0.01);
    assert!(rod.iter().any(|each| matches!(each, StabilityWarning::Inertia { .. })), "{rod:?}");
    // The largest moment is within 1.5 times the sum of the others, the smallest one far from their difference.
    let needle = warnings(|configuration| configuration.airframe.inertia_kg_m2 = [0.002, 0.1, 0.15]);
    assert!(needle.iter().any(|each| matches!(each, StabilityWarning::Inertia { .. })), "{needle:?}");
    // A short sample time keeps it below what is refused.
    let drag = warnings(|configuration| {
        configuration.airframe.torque_coefficient_n_m_s2 = 0.01;
        configuration.controllers.attitude.sample_time_us = 1_000;
    });
    assert!(drag.iter().any(|each| matches!(each, StabilityWarning::RotorDrag { .. })), "{drag:?}");
}

/// A limit is no part of the loops; a weight is.
#[test]
fn a_change_is_judged_by_what_it_changes() {
    let mut flight = Simulation::new(&Configuration::default(), &goal([0.0; 3], 0.0)).expect("a flight");
    let before = flight.control().stability().clone();
    let mut configuration = Configuration::default();
    configuration.limits.speed_horizontal_m_s = 3.0;
    flight.reconfigure(&configuration).expect("flies");
    assert_eq!(*flight.control().stability(), before);
    configuration.controllers.altitude.output_weight.fill(3.0);
    flight.reconfigure(&configuration).expect("flies");
    let after = flight.control().stability();
    assert_eq!(*after, StabilityReport::new(&configuration).expect("flies"));
    assert_ne!(after.loops()[5], before.loops()[5]);
    assert_eq!(after.loops()[..5], before.loops()[..5]);
}

/// Every kind, with and without the Kalman predictor, a wrong mass and airframes 30 % apart.
#[test]
fn ordinary_vehicles_are_accepted() {
    for kind in KINDS {
        for output_feedback in [false, true] {
            for factor in [0.7, 0.8, 1.0, 1.2, 1.3] {
                let mut configuration = Configuration::default();
                configuration.controllers.kind = kind;
                configuration.sensors.output_feedback = output_feedback;
                configuration.controllers.mass_factor = factor;
                StabilityReport::new(&configuration).expect("a wrong mass");
                configuration.controllers.mass_factor = 1.0;
                let airframe = &mut configuration.airframe;
                airframe.inertia_kg_m2[0] *= factor;
                airframe.inertia_kg_m2[2] /= factor;
                airframe.rotor_time_constant_s *= factor;
                configuration.limits.tilt_acceleration_rad_s2 = 6.0;
                StabilityReport::new(&configuration).expect("another airframe");
            }
        }
    }
}

/// Heavy rotors turn the body when they change their speed, which the estimate of torques knows.
#[test]
fn heavy_rotors_are_no_torque_from_outside() {
    for (inertia_kg_m2, output_feedback) in [(1e-4, false), (1e-4, true), (4e-4, false), (4e-4, true)] {
        for noise in [0.0, 1e-3, 5e-3] {
            let mut configuration = Configuration::default();
            configuration.airframe.rotor_spin.inertia_kg_m2 = inertia_kg_m2;
            configuration.sensors = Sensors {
                output_feedback,
                attitude_noise_rad: noise,
                body_rate_noise_rad_s: 5.0 * noise,
                ..Sensors::default()
            };
            let report = StabilityReport::new(&configuration);
            assert!(report.is_ok(), "{inertia_kg_m2} {output_feedback} {noise}: {report:?}");
        }
    }
}

/// A value that makes the loops of another airframe unstable is named: that differs from the default in more values than are tried.
#[test]
fn what_is_wrong_with_another_airframe_is_named() {
    let mut configuration = Configuration::for_airframe(&AirframePreset::Crazyflie.airframe()).unwrap();
    configuration.controllers.model = PredictionModel::Paper;
    let error = Simulation::new(&configuration, &Inputs::default()).expect_err("refused").to_string();
    assert!(error.starts_with("the north loop is unstable"), "{error}");
    assert!(
        error.ends_with("caused by airframe.rotor.time_constant = 0.072 s, stable with 0.03 s"),
        "{error}"
    );
}
