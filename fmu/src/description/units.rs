//! Units and simple types of quantities and enumerations.

use std::f64::consts::PI;
use std::io;

use quadrotor::Choice;

use super::Xml;
use crate::variables::{Quantity, VARIABLES, Variable};

/// A unit: its name, its exponents of SI base units, and units that a person may prefer, with how many of
/// them make one.
struct Unit {
    name: &'static str,
    base: &'static [(&'static str, &'static str)],
    display: &'static [(&'static str, f64)],
}

const DEGREES: f64 = 180.0 / PI;
const TURNS_PER_MINUTE: f64 = 30.0 / PI;

#[rustfmt::skip]
const UNITS: [Unit; 16] = [
    Unit { name: "s", base: &[("s", "1")], display: &[("ms", 1e3)] },
    Unit { name: "kg", base: &[("kg", "1")], display: &[("g", 1e3)] },
    Unit { name: "m", base: &[("m", "1")], display: &[("cm", 1e2), ("km", 1e-3)] },
    Unit { name: "m/s", base: &[("m", "1"), ("s", "-1")], display: &[("km/h", 3.6)] },
    Unit { name: "m/s2", base: &[("m", "1"), ("s", "-2")], display: &[] },
    Unit { name: "m/s3", base: &[("m", "1"), ("s", "-3")], display: &[] },
    Unit { name: "rad", base: &[("rad", "1")], display: &[("deg", DEGREES)] },
    Unit { name: "rad/s", base: &[("s", "-1"), ("rad", "1")], display: &[("deg/s", DEGREES), ("rpm", TURNS_PER_MINUTE)] },
    Unit { name: "rad/s2", base: &[("s", "-2"), ("rad", "1")], display: &[("deg/s2", DEGREES)] },
    Unit { name: "rad/s3", base: &[("s", "-3"), ("rad", "1")], display: &[("deg/s3", DEGREES)] },
    Unit { name: "N", base: &[("kg", "1"), ("m", "1"), ("s", "-2")], display: &[("kN", 1e-3)] },
    Unit { name: "N.m", base: &[("kg", "1"), ("m", "2"), ("s", "-2")], display: &[] },
    Unit { name: "kg.m2", base: &[("kg", "1"), ("m", "2")], display: &[] },
    Unit { name: "N.s2", base: &[("kg", "1"), ("m", "1")], display: &[] },
    Unit { name: "N.m.s2", base: &[("kg", "1"), ("m", "2")], display: &[] },
    Unit { name: "N.s/m", base: &[("kg", "1"), ("s", "-1")], display: &[] },
];

pub(super) fn write(xml: &mut Xml) -> io::Result<()> {
    xml.create_element("UnitDefinitions")
        .write_inner_content(|xml| UNITS.iter().try_for_each(|u| u.write(xml)))?;
    xml.create_element("TypeDefinitions").write_inner_content(|xml| {
        Quantity::ALL.iter().try_for_each(|quantity| simple_type(xml, *quantity))?;
        choices().into_iter().try_for_each(|choice| enumeration(xml, choice))
    })?;
    Ok(())
}

impl Unit {
    fn write(&self, xml: &mut Xml) -> io::Result<()> {
        xml.create_element("Unit").with_attribute(("name", self.name)).write_inner_content(|xml| {
            xml.create_element("BaseUnit").with_attributes(self.base.iter().copied()).write_empty()?;
            for (name, factor) in self.display {
                xml.create_element("DisplayUnit")
                    .with_attributes([("name", *name), ("factor", &factor.to_string())])
                    .write_empty()?;
            }
            Ok(())
        })?;
        Ok(())
    }
}

fn simple_type(xml: &mut Xml, quantity: Quantity) -> io::Result<()> {
    let definition = quantity.quantity_type();
    let names = [("name", definition.name), ("description", definition.description)];
    xml.create_element("SimpleType").with_attributes(names).write_inner_content(|xml| {
        let mut real = xml.create_element("Real").with_attribute(("quantity", definition.name));
        if let Some(unit) = definition.unit {
            real = real.with_attribute(("unit", unit));
        }
        if let Some(unit) = definition.display_unit {
            real = real.with_attribute(("displayUnit", unit));
        }
        real.write_empty()?;
        Ok(())
    })?;
    Ok(())
}

/// Everything that is chosen from, once each.
fn choices() -> Vec<&'static Choice> {
    let mut choices: Vec<&Choice> = VARIABLES.iter().filter_map(Variable::choice).collect();
    choices.sort_by_key(|choice| choice.name);
    choices.dedup_by_key(|choice| choice.name);
    choices
}

fn enumeration(xml: &mut Xml, choice: &Choice) -> io::Result<()> {
    let names = [("name", choice.name), ("description", choice.description)];
    xml.create_element("SimpleType").with_attributes(names).write_inner_content(|xml| {
        xml.create_element("Enumeration").write_inner_content(|xml| {
            for (value, (name, description)) in (1..).zip(choice.items) {
                xml.create_element("Item")
                    .with_attributes([
                        ("name", *name),
                        ("value", i32::to_string(&value).as_str()),
                        ("description", *description),
                    ])
                    .write_empty()?;
            }
            Ok(())
        })?;
        Ok(())
    })?;
    Ok(())
}
