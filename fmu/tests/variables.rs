//! The table of variables against the engine's parameters and against the units as the SI defines them.

use std::collections::HashSet;

use fmi::Model;
use fmi::variables::{Field, Role, Type, Value, Variable};
use fmu::ClosedLoop;
use quadrotor::{Configuration, Mutability, PARAMETERS, Unit};

fn variables() -> impl Iterator<Item = &'static Variable<ClosedLoop>> {
    ClosedLoop::VARIABLES.iter().copied().flatten()
}

fn variable(name: &str) -> &'static Variable<ClosedLoop> {
    variables().find(|variable| variable.name == name).unwrap_or_else(|| panic!("{name} is missing"))
}

#[test]
fn every_parameter_of_the_engine_is_a_variable_of_its_name_type_range_and_place() {
    let parameters: Vec<_> =
        variables().filter(|variable| matches!(variable.role, Role::Parameter { .. })).collect();
    let names =
        |variables: &[&Variable<ClosedLoop>]| -> Vec<_> { variables.iter().map(|v| v.name).collect() };
    assert_eq!(names(&parameters), PARAMETERS.iter().map(|parameter| parameter.name).collect::<Vec<_>>());
    for (variable, parameter) in parameters.iter().zip(PARAMETERS) {
        let Role::Parameter { tunable, field } = &variable.role else { panic!("{}", variable.name) };
        assert_eq!(variable.description, parameter.description);
        assert_eq!(*tunable, parameter.mutability == Mutability::Tunable, "{}", variable.name);
        match (field, parameter.access) {
            (
                Field::Real { minimum, maximum, get, set, .. },
                quadrotor::Access::Real { minimum: least, maximum: most, get: read, .. },
            ) => {
                assert_eq!((*minimum, *maximum), (least, most), "{}", variable.name);
                let mut configuration = Configuration::default();
                assert_eq!(get(&configuration), read(&configuration), "{}", variable.name);
                set(&mut configuration, most);
                assert_eq!((get(&configuration), read(&configuration)), (most, most), "{}", variable.name);
            }
            (
                Field::Integer { minimum, maximum, get, set },
                quadrotor::Access::Integer { minimum: least, maximum: most, get: read, .. },
            ) => {
                assert_eq!((*minimum, *maximum), (least, most), "{}", variable.name);
                let mut configuration = Configuration::default();
                set(&mut configuration, most);
                assert_eq!((get(&configuration), read(&configuration)), (most, most), "{}", variable.name);
            }
            (
                Field::Enumeration { choice, get, set },
                quadrotor::Access::Enumeration { choice: known, get: read, .. },
            ) => {
                assert_eq!((choice.name, choice.items), (known.name, known.items));
                let mut configuration = Configuration::default();
                let last = i32::try_from(known.items.len()).unwrap();
                set(&mut configuration, last);
                assert_eq!((get(&configuration), read(&configuration)), (last, last), "{}", variable.name);
            }
            (Field::Boolean { get, set }, quadrotor::Access::Boolean { get: read, .. }) => {
                let mut configuration = Configuration::default();
                let other = !read(&configuration);
                set(&mut configuration, other);
                assert_eq!((get(&configuration), read(&configuration)), (other, other), "{}", variable.name);
            }
            _ => panic!("{} is of another type than the engine's", variable.name),
        }
    }
}

/// The FMU's symbol of an engine's unit, in ASCII as FMI asks for: products with a point, exponents behind the unit.
fn symbol(unit: Unit) -> String {
    unit.symbol().replace('·', ".").replace('²', "2").replace('³', "3").replace('Ω', "Ohm")
}

#[test]
fn every_parameter_is_measured_in_the_engines_unit() {
    let reals =
        PARAMETERS.iter().filter(|parameter| matches!(parameter.access, quadrotor::Access::Real { .. }));
    for parameter in reals {
        let quantity = variable(parameter.name).quantity().unwrap();
        let unit = quantity.unit.map_or("", |unit| unit.name);
        assert_eq!(unit, symbol(parameter.unit), "{}", parameter.name);
        // People count the turns of a rotor and the degrees of anything else.
        if parameter.unit == Unit::RadianPerSecond {
            let expected = if parameter.name.starts_with("airframe.rotor.") { "rpm" } else { "deg/s" };
            assert_eq!(quantity.display_unit, Some(expected), "{}", parameter.name);
        }
    }
}

/// Each unit's exponents are those of its symbol, and a display unit is as large as its definition says.
#[test]
fn units_are_those_of_the_si() {
    // kg, m, s, rad, A
    let known = [
        ("s", [0, 0, 1, 0, 0]),
        ("kg", [1, 0, 0, 0, 0]),
        ("m", [0, 1, 0, 0, 0]),
        ("rad", [0, 0, 0, 1, 0]),
        ("A", [0, 0, 0, 0, 1]),
        // 1 N = 1 kg m/s²
        ("N", [1, 1, -2, 0, 0]),
        // 1 V = 1 N m/(A s)
        ("V", [1, 2, -3, 0, -1]),
        // 1 Ω = 1 V/A
        ("Ohm", [1, 2, -3, 0, -2]),
    ];
    let exponents_of = |symbol: &str| {
        let (product, divisor) = symbol.split_once('/').unwrap_or((symbol, ""));
        let mut sum = [0; 5];
        for (factors, sign) in [(product, 1), (divisor, -1)] {
            for factor in factors.split('.').filter(|factor| !factor.is_empty()) {
                let base = factor.trim_end_matches(char::is_numeric);
                let power: i32 = factor[base.len()..].parse().unwrap_or(1);
                let (_, exponents) = known.iter().find(|(name, _)| *name == base).unwrap();
                for (total, exponent) in sum.iter_mut().zip(exponents) {
                    *total += sign * power * exponent;
                }
            }
        }
        sum
    };
    let factors = [
        ("ms", 1000.0),
        ("g", 1000.0),
        ("deg", 57.295_779_513_082_32),
        ("deg/s", 57.295_779_513_082_32),
        ("deg/s2", 57.295_779_513_082_32),
        ("deg/s3", 57.295_779_513_082_32),
        // 60 s over 2π
        ("rpm", 9.549_296_585_513_72),
        ("A.h", 1.0 / 3600.0),
    ];
    let mut units = HashSet::new();
    for quantity in ClosedLoop::QUANTITIES {
        let Some(unit) = quantity.unit else { continue };
        units.insert(unit.name);
        let base = ["kg", "m", "s", "rad", "A"].map(|name| {
            unit.base
                .iter()
                .find(|(base, _)| *base == name)
                .map_or(0, |(_, exponent)| exponent.parse().unwrap())
        });
        assert_eq!(base, exponents_of(unit.name), "{}", unit.name);
        for (display, factor) in unit.display {
            let (_, expected) = factors.iter().find(|(name, _)| name == display).unwrap();
            assert!((factor / expected - 1.0_f64).abs() < 1e-15, "{display}: {factor}");
        }
        if let Some(display) = quantity.display_unit {
            assert!(unit.display.iter().any(|(name, _)| *name == display), "{display} of {}", quantity.name);
        }
        assert!(quantity.nominal > 0.0 && !quantity.description.is_empty(), "{}", quantity.name);
    }
    assert_eq!(units.len(), 22, "{units:?}");
}

/// All quantities are listed, once each, and so is every variable.
#[test]
fn names_are_unique_and_quantities_complete() {
    let mut names = HashSet::new();
    for variable in variables() {
        assert!(names.insert(variable.name) && !variable.description.is_empty(), "{}", variable.name);
        if let Some(quantity) = variable.quantity() {
            assert!(
                ClosedLoop::QUANTITIES.iter().any(|listed| std::ptr::eq(*listed, quantity)),
                "{}",
                quantity.name
            );
        }
    }
    let quantities: HashSet<_> = ClosedLoop::QUANTITIES.iter().map(|quantity| quantity.name).collect();
    assert_eq!(quantities.len(), ClosedLoop::QUANTITIES.len());
}

/// Angles within their turn; thrust, rotor speeds, the battery's figures and a mass not negative; nothing else is bounded but counts and statuses.
#[test]
fn outputs_have_the_ranges_of_their_definitions() {
    use std::f64::consts::{FRAC_PI_2, PI};
    for variable in variables().filter(|variable| variable.causality() == "output") {
        let range = |minimum: f64, maximum: f64| (Some(Value::Real(minimum)), Some(Value::Real(maximum)));
        let expected = match (variable.name, variable.value_type()) {
            ("attitude.phi" | "attitude.psi" | "yaw_error", _) => range(-PI, PI),
            ("attitude.theta", _) => range(-FRAC_PI_2, FRAC_PI_2),
            ("battery.remaining", _) => range(0.0, 1.0),
            (name, Type::Real)
                if ["thrust", "battery.voltage", "battery.current", "controller.believed_mass"]
                    .contains(&name)
                    || name.starts_with("rotor.speed[") =>
            {
                (Some(Value::Real(0.0)), None)
            }
            (_, Type::Real | Type::Boolean) => (None, None),
            (_, Type::Integer) => (Some(Value::Integer(0)), None),
            (_, Type::Enumeration) => (Some(Value::Integer(1)), Some(Value::Integer(4))),
        };
        assert_eq!(variable.range(), expected, "{}", variable.name);
    }
}
