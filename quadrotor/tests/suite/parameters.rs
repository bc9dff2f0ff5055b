//! The parameter table and the validation behind it.

use quadrotor::{Access, Configuration, ConfigurationError, Inputs, PARAMETERS, Parameter, Simulation};

fn find(name: &str) -> &'static Parameter {
    PARAMETERS.iter().find(|parameter| parameter.name == name).unwrap()
}

fn set(configuration: &mut Configuration, name: &str, value: f64) {
    match find(name).access {
        Access::Real { set, .. } => set(configuration, value),
        Access::Integer { set, .. } => set(configuration, value as i32),
        Access::Enumeration { set, .. } => set(configuration, value as i32),
        Access::Boolean { set, .. } => set(configuration, value != 0.0),
    }
}

#[test]
fn names_are_unique_and_described() {
    for (index, parameter) in PARAMETERS.iter().enumerate() {
        assert!(!parameter.description.is_empty(), "{}", parameter.name);
        assert!(PARAMETERS[..index].iter().all(|other| other.name != parameter.name), "{}", parameter.name);
    }
}

/// Every parameter has a place of its own: writing one changes that one and no other.
#[test]
fn each_parameter_reads_what_was_written_to_it_alone() {
    let read = |parameter: &Parameter, configuration: &Configuration| match parameter.access {
        Access::Real { get, .. } => get(configuration),
        Access::Integer { get, .. } => f64::from(get(configuration)),
        Access::Enumeration { get, .. } => f64::from(get(configuration)),
        Access::Boolean { get, .. } => f64::from(get(configuration)),
    };
    let default = Configuration::default();
    for parameter in PARAMETERS {
        let mut changed = default;
        let value = match parameter.access {
            Access::Real { minimum, maximum, .. } => {
                if read(parameter, &default) == minimum {
                    maximum
                } else {
                    minimum
                }
            }
            Access::Integer { minimum, .. } => f64::from(minimum),
            Access::Enumeration { choice, .. } => choice.items.len() as f64,
            Access::Boolean { .. } => 1.0 - read(parameter, &default),
        };
        set(&mut changed, parameter.name, value);
        assert_eq!(read(parameter, &changed), value, "{}", parameter.name);
        for other in PARAMETERS.iter().filter(|other| other.name != parameter.name) {
            assert_eq!(
                read(other, &changed),
                read(other, &default),
                "{} changed {}",
                parameter.name,
                other.name
            );
        }
    }
}

#[test]
fn defaults_are_within_their_ranges() {
    for parameter in PARAMETERS {
        parameter.check(&Configuration::default()).unwrap();
    }
}

#[test]
fn values_out_of_range_are_refused_by_name_value_and_range() {
    for parameter in PARAMETERS {
        let Access::Real { minimum, maximum, .. } = parameter.access else { continue };
        for value in [minimum - 1.0 - minimum.abs(), maximum + 1.0 + maximum.abs(), f64::NAN, f64::INFINITY] {
            let mut configuration = Configuration::default();
            set(&mut configuration, parameter.name, value);
            match Simulation::new(&configuration, &Inputs::default()) {
                Err(ConfigurationError::OutOfRange { name, .. }) => assert_eq!(name, parameter.name),
                other => panic!("{} = {value}: {other:?}", parameter.name),
            }
        }
    }
    let mut configuration = Configuration::default();
    set(&mut configuration, "airframe.mass", -1.0);
    let message = Simulation::new(&configuration, &Inputs::default()).unwrap_err().to_string();
    assert_eq!(message, "airframe.mass = -1 kg; allowed 0.005–50 kg");
}

#[test]
fn values_that_contradict_one_another_are_refused() {
    for (name, value, expected) in [
        (
            "airframe.rotor.speed_min",
            460.0,
            "airframe.rotor.speed_min = 460 rad/s must be below 450 rad/s: that is airframe.rotor.speed_max",
        ),
        (
            "airframe.mass",
            3.0,
            "airframe.mass = 3 kg is too heavy; allowed up to 1.78 kg, which these rotors carry; lower it, or raise airframe.rotor.speed_max",
        ),
        (
            "airframe.rotor.speed_min",
            300.0,
            "airframe.mass = 0.7 kg is too light; allowed from 1 kg, which these rotors carry when idle; raise it, or lower airframe.rotor.speed_min",
        ),
        (
            "airframe.inertia.x",
            0.5,
            "limits.tilt_acceleration = 8 rad/s² must be at most 3.775 rad/s²: \
             the rotors give airframe.inertia half of that in hover",
        ),
        (
            "limits.acceleration.horizontal",
            9.0,
            "limits.acceleration.horizontal = 9 m/s² must be below 5.958 m/s²: \
             the commanded tilt gives no more; raise limits.tilt",
        ),
        (
            "controller.attitude.sample_time",
            0.06,
            "controller.position.sample_time = 0.05 s must be at least 0.06 s: \
             that is controller.attitude.sample_time",
        ),
    ] {
        let mut configuration = Configuration::default();
        set(&mut configuration, name, value);
        let refused = Simulation::new(&configuration, &Inputs::default()).unwrap_err();
        assert_eq!(refused.to_string(), expected, "{name} = {value}");
    }
    let mut configuration = Configuration::default();
    // Laguerre functions that decay as 0.59^k are no plan that settles as 0.5^k.
    set(&mut configuration, "controller.position.lambda", 0.5);
    let error = Simulation::new(&configuration, &Inputs::default()).unwrap_err();
    assert!(matches!(error, ConfigurationError::Design { part: "position controller", .. }), "{error}");
}
