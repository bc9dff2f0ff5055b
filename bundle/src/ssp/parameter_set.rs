//! `LmpcQuadrotor.ssv`: the reference, the vehicle that both sides know, and what is measured.

use std::io;

use super::ports::{Port, Ports};
use super::{CONTROLLERS, NAME, VEHICLE, Xml, document, empty};

/// Where the vehicle is asked to be.
const REFERENCE: [&str; 4] =
    ["reference.position.x", "reference.position.y", "reference.position.z", "reference.yaw"];

/// What both sides know of the vehicle. They may differ: then the controllers believe in another one.
const VEHICLE_OF_BOTH: [&str; 11] = [
    "airframe.mass",
    "airframe.arm_length",
    "airframe.inertia.x",
    "airframe.inertia.y",
    "airframe.inertia.z",
    "airframe.rotor.thrust_coefficient",
    "airframe.rotor.torque_coefficient",
    "airframe.rotor.time_constant",
    "airframe.drag.x",
    "airframe.drag.y",
    "airframe.drag.z",
];

/// Enumerations by the numbers of their items, which every importer can set: Euler angles are measured, and rotor speeds are predicted.
const MEASURED: [(&str, &str); 2] = [("measurement.attitude", "2"), ("measurement.rotor_speeds", "2")];

/// The parameter set, with the start values of the FMUs.
pub fn text(controller: &Ports, plant: &Ports) -> io::Result<String> {
    let attributes = [
        ("xmlns:ssv", "http://ssp-standard.org/SSP1/SystemStructureParameterValues"),
        ("version", "1.0"),
        ("name", NAME),
    ];
    document("ssv:ParameterSet", &attributes, |xml| {
        xml.create_element("ssv:Parameters").write_inner_content(|xml| {
            for (name, value) in MEASURED {
                parameter(xml, CONTROLLERS, name, |xml| empty(xml, "ssv:Integer", &[("value", value)]))?;
            }
            let parts = [
                (CONTROLLERS, controller, &REFERENCE[..]),
                (CONTROLLERS, controller, &VEHICLE_OF_BOTH),
                (VEHICLE, plant, &VEHICLE_OF_BOTH),
            ];
            for (element, ports, names) in parts {
                for port in names.iter().filter_map(|name| ports.find(name)) {
                    parameter(xml, element, &port.name, |xml| value(xml, port))?;
                }
            }
            Ok(())
        })?;
        Ok(())
    })
}

fn parameter(
    xml: &mut Xml,
    element: &str,
    name: &str,
    value: impl FnOnce(&mut Xml) -> io::Result<()>,
) -> io::Result<()> {
    xml.create_element("ssv:Parameter")
        .with_attribute(("name", format!("{element}.{name}").as_str()))
        .write_inner_content(value)?;
    Ok(())
}

/// Its start value. Units are those of the FMU.
fn value(xml: &mut Xml, port: &Port) -> io::Result<()> {
    empty(xml, "ssv:Real", &[("value", port.start.as_deref().unwrap_or("0"))])
}
