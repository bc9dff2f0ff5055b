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
    assert_eq!(message, "airframe.mass = -1 is outside [0.05, 50]");
}

#[test]
fn values_that_contradict_one_another_are_refused() {
    for (name, value, culprit) in [
        ("airframe.rotor.speed_min", 460.0, "airframe.rotor.speed_min"),
        ("airframe.mass", 5.0, "airframe.mass"),
        ("airframe.rotor.speed_min", 300.0, "the mass in kg that four idle rotors carry"),
        ("airframe.inertia.x", 0.5, "limits.tilt_acceleration"),
        ("limits.acceleration.horizontal", 9.0, "limits.acceleration.horizontal"),
        ("controller.attitude.sample_time", 0.06, "controller.position.sample_time"),
    ] {
        let mut configuration = Configuration::default();
        set(&mut configuration, name, value);
        match Simulation::new(&configuration, &Inputs::default()) {
            Err(ConfigurationError::Inconsistent { name, .. }) => assert_eq!(name, culprit),
            other => panic!("{name} = {value}: {other:?}"),
        }
    }
    let mut configuration = Configuration::default();
    set(&mut configuration, "controller.position.prediction_horizon", 3.0);
    let error = Simulation::new(&configuration, &Inputs::default()).unwrap_err();
    assert!(matches!(error, ConfigurationError::Design { part: "position controller", .. }), "{error}");
}
