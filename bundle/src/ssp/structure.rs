//! `SystemStructure.ssd`

use std::io;

use fmi::Model;
use fmu::ClosedLoop;

use super::wiring::{End, Wiring};
use super::{CONTROLLERS, NAME, PARAMETER_SET, VEHICLE, Xml, document, empty, source};
use crate::product::{CONTROLLER, PLANT};

/// The structure of the system.
pub fn text(wiring: &Wiring) -> io::Result<String> {
    let identity = ClosedLoop::IDENTITY;
    let attributes = [
        ("xmlns:ssd", "http://ssp-standard.org/SSP1/SystemStructureDescription"),
        ("xmlns:ssc", "http://ssp-standard.org/SSP1/SystemStructureCommon"),
        ("version", "1.0"),
        ("name", NAME),
        (
            "description",
            "Controllers and plant of a quadrotor, wired: a flight from the origin to 5 m north, 5 m east, 10 m up",
        ),
        ("author", identity.author),
        ("fileversion", identity.version),
        ("copyright", identity.copyright),
        ("license", identity.license),
        ("generationTool", identity.generation_tool),
        ("generationDateAndTime", identity.date),
    ];
    document("ssd:SystemStructureDescription", &attributes, |xml| {
        system(xml, wiring)?;
        units(xml, wiring)?;
        let stop_time_s = identity.default_experiment.stop_time_s.to_string();
        empty(xml, "ssd:DefaultExperiment", &[("startTime", "0"), ("stopTime", &stop_time_s)])
    })
}

fn system(xml: &mut Xml, wiring: &Wiring) -> io::Result<()> {
    xml.create_element("ssd:System").with_attribute(("name", NAME)).write_inner_content(|xml| {
        xml.create_element("ssd:ParameterBindings")
            .write_inner_content(|xml| empty(xml, "ssd:ParameterBinding", &[("source", PARAMETER_SET)]))?;
        // Importers that step one after the other do it in this order: the controllers first, so that the plant gets the command of its step.
        xml.create_element("ssd:Elements").write_inner_content(|xml| {
            component(xml, wiring, CONTROLLERS, CONTROLLER.identifier)?;
            component(xml, wiring, VEHICLE, PLANT.identifier)
        })?;
        connections(xml, wiring)
    })?;
    Ok(())
}

fn component(xml: &mut Xml, wiring: &Wiring, name: &'static str, identifier: &str) -> io::Result<()> {
    let attributes = [
        ("name", name),
        ("type", "application/x-fmu-sharedlibrary"),
        ("source", &source(identifier)),
        ("implementation", "CoSimulation"),
    ];
    xml.create_element("ssd:Component")
        .with_attributes(attributes)
        .write_inner_content(|xml| connectors(xml, wiring, name))?;
    Ok(())
}

/// Those that are connected, and outputs: FMPy sets unconnected inputs that are listed here to 0.
fn connectors(xml: &mut Xml, wiring: &Wiring, element: &str) -> io::Result<()> {
    xml.create_element("ssd:Connectors").write_inner_content(|xml| {
        for connection in &wiring.connections {
            for (end, kind) in [(&connection.start, "output"), (&connection.end, "input")] {
                if end.element == element {
                    connector(xml, end, kind)?;
                }
            }
        }
        let mut shown = wiring.shown.iter().filter(|end| end.element == element);
        shown.try_for_each(|end| connector(xml, end, "output"))
    })?;
    Ok(())
}

fn connector(xml: &mut Xml, end: &End, kind: &str) -> io::Result<()> {
    let attributes = [("name", end.port.name.as_str()), ("kind", kind)];
    xml.create_element("ssd:Connector").with_attributes(attributes).write_inner_content(|xml| {
        let unit = end.port.unit.as_ref().map(|unit| ("unit", unit.as_str()));
        empty(xml, "ssc:Real", unit.as_slice())
    })?;
    Ok(())
}

fn connections(xml: &mut Xml, wiring: &Wiring) -> io::Result<()> {
    xml.create_element("ssd:Connections").write_inner_content(|xml| {
        for connection in &wiring.connections {
            let attributes = [
                ("startElement", connection.start.element),
                ("startConnector", &connection.start.port.name),
                ("endElement", connection.end.element),
                ("endConnector", &connection.end.port.name),
            ];
            empty(xml, "ssd:Connection", &attributes)?;
        }
        Ok(())
    })?;
    Ok(())
}

fn units(xml: &mut Xml, wiring: &Wiring) -> io::Result<()> {
    xml.create_element("ssd:Units").write_inner_content(|xml| {
        for unit in &wiring.units {
            xml.create_element("ssc:Unit")
                .with_attribute(("name", unit.symbol.as_str()))
                .write_inner_content(|xml| {
                    let base: Vec<(&str, &str)> =
                        unit.base.iter().map(|(name, exponent)| (name.as_str(), exponent.as_str())).collect();
                    empty(xml, "ssc:BaseUnit", &base)
                })?;
        }
        Ok(())
    })?;
    Ok(())
}
