//! LmpcQuadrotor.ssp: controllers and plant wired, as an SSP 1.0 archive that importers of systems run as it is.
//!
//! `ports` reads what the two FMUs offer, `wiring` connects them by their terminals, `structure` and `parameter_set` are the two documents.

mod parameter_set;
mod ports;
mod structure;
mod wiring;

use std::io;

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};

use crate::archive::Archive;
use crate::failure::Failure;
use crate::product::{CONTROLLER, PLANT, Version};
use ports::Ports;
use wiring::Wiring;
use xtask::files;
use xtask::workspace::Workspace;

/// Name of the system and of the file, without its extension.
const NAME: &str = "LmpcQuadrotor";
/// Names of the components.
const CONTROLLERS: &str = "controller";
const VEHICLE: &str = "plant";
/// Place of the parameter set.
const PARAMETER_SET: &str = "resources/LmpcQuadrotor.ssv";

type Xml = Writer<Vec<u8>>;

/// Writes target/fmu/LmpcQuadrotor.ssp from the FMUs of version 2.0 there, and prints its path and size.
pub fn write(workspace: &Workspace) -> Result<(), Failure> {
    let mut archive = Archive::default();
    let descriptions = [CONTROLLER, PLANT].map(|product| product.description(Version::Two));
    let [controller, plant] = &descriptions;
    let (controller, plant) = (Ports::read(controller)?, Ports::read(plant)?);
    let wiring = Wiring::new(&controller, &plant);
    for product in [CONTROLLER, PLANT] {
        let bytes = files::read(&product.path(workspace, Version::Two))?;
        archive.add(&source(product.identifier), bytes);
    }
    let document = |written: io::Result<String>| written.map(String::into_bytes).map_err(Failure::Document);
    archive.add("SystemStructure.ssd", document(structure::text(&wiring))?);
    archive.add(PARAMETER_SET, document(parameter_set::text(&controller, &plant))?);

    let path = workspace.fmus().join(format!("{NAME}.ssp"));
    let bytes = archive.into_bytes().map_err(|source| Failure::Archive { path: path.clone(), source })?;
    files::write(&path, &bytes)?;
    println!("{} ({:.0} kB)", workspace.shown(&path), bytes.len() as f64 / 1000.0);
    Ok(())
}

/// Where an FMU lies in the archive.
fn source(identifier: &str) -> String {
    format!("resources/{identifier}.fmu")
}

/// A document: its root with attributes, and what is in it.
fn document(
    root: &str,
    attributes: &[(&str, &str)],
    content: impl FnOnce(&mut Xml) -> io::Result<()>,
) -> io::Result<String> {
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    xml.create_element(root).with_attributes(attributes.iter().copied()).write_inner_content(content)?;
    let mut bytes = xml.into_inner();
    bytes.push(b'\n');
    String::from_utf8(bytes).map_err(io::Error::other)
}

/// An element without content.
fn empty(xml: &mut Xml, name: &str, attributes: &[(&str, &str)]) -> io::Result<()> {
    xml.create_element(name).with_attributes(attributes.iter().copied()).write_empty()?;
    Ok(())
}
