//! `LmpcQuadrotor.ssv`: the reference, and the vehicle as both sides know it.

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

/// The parameter set, with the start values of the FMUs.
pub fn text(controller: &Ports, plant: &Ports) -> io::Result<String> {
    let attributes = [
        ("xmlns:ssv", "http://ssp-standard.org/SSP1/SystemStructureParameterValues"),
        ("version", "1.0"),
        ("name", NAME),
    ];
    document("ssv:ParameterSet", &attributes, |xml| {
        xml.create_element("ssv:Parameters").write_inner_content(|xml| {
            let parts = [
                (CONTROLLERS, controller, &REFERENCE[..]),
                (CONTROLLERS, controller, &VEHICLE_OF_BOTH),
                (VEHICLE, plant, &VEHICLE_OF_BOTH),
            ];
            for (element, ports, names) in parts {
                for port in names.iter().filter_map(|name| ports.find(name)) {
                    parameter(xml, element, port)?;
                }
            }
            Ok(())
        })?;
        Ok(())
    })
}

/// Its start value. Units are those of the FMU.
fn parameter(xml: &mut Xml, element: &str, port: &Port) -> io::Result<()> {
    let name = format!("{element}.{}", port.name);
    xml.create_element("ssv:Parameter").with_attribute(("name", name.as_str())).write_inner_content(
        |xml| empty(xml, "ssv:Real", &[("value", port.start.as_deref().unwrap_or("0"))]),
    )?;
    Ok(())
}
