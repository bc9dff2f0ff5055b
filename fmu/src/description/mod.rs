//! `modelDescription.xml`, written from the table of variables.

mod structure;
mod units;
mod variables;

use std::io;

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};

use crate::{MODEL_IDENTIFIER, MODEL_NAME, guid};

/// The writer that the parts of the description share.
type Xml = Writer<Vec<u8>>;

/// Date of the release that the description is of: fixed, so that the same sources give the same bytes.
const DATE: &str = "2026-11-21T00:00:00Z";

const DESCRIPTION: &str = "Quadrotor under a cascade of Laguerre model predictive controllers \
    (Chipofya, Lee and Chong 2015), flying from the origin to 5 m north, 5 m east, 10 m up";

/// End of the default experiment, s: the flight and a rest.
const STOP_TIME_S: &str = "20";
/// Half of the outer controllers' sample time: a multiple of it is a communication point, too.
const STEP_SIZE_S: &str = "0.025";

/// The text of `modelDescription.xml`.
///
/// # Panics
/// Never: writing into memory does not fail, and the writer makes UTF-8 of UTF-8.
pub fn model_description() -> String {
    written().expect("writing into memory does not fail")
}

fn written() -> io::Result<String> {
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    xml.create_element("fmiModelDescription")
        .with_attributes([
            ("fmiVersion", "2.0"),
            ("modelName", MODEL_NAME),
            ("guid", &guid()),
            ("description", DESCRIPTION),
            ("version", env!("CARGO_PKG_VERSION")),
            ("license", env!("CARGO_PKG_LICENSE")),
            ("generationTool", concat!("lmpc-quadrotor ", env!("CARGO_PKG_VERSION"))),
            ("generationDateAndTime", DATE),
            ("variableNamingConvention", "structured"),
        ])
        .write_inner_content(|xml| {
            co_simulation(xml)?;
            units::write(xml)?;
            log_categories(xml)?;
            default_experiment(xml)?;
            variables::write(xml)?;
            structure::write(xml)
        })?;
    let mut bytes = xml.into_inner();
    bytes.push(b'\n');
    String::from_utf8(bytes).map_err(io::Error::other)
}

fn co_simulation(xml: &mut Xml) -> io::Result<()> {
    xml.create_element("CoSimulation")
        .with_attributes([
            ("modelIdentifier", MODEL_IDENTIFIER),
            ("canHandleVariableCommunicationStepSize", "true"),
            ("canInterpolateInputs", "true"),
            ("maxOutputDerivativeOrder", "0"),
            ("canBeInstantiatedOnlyOncePerProcess", "false"),
            ("canNotUseMemoryManagementFunctions", "true"),
            ("canGetAndSetFMUstate", "true"),
            ("canSerializeFMUstate", "true"),
            ("providesDirectionalDerivative", "false"),
        ])
        .write_empty()?;
    Ok(())
}

fn log_categories(xml: &mut Xml) -> io::Result<()> {
    xml.create_element("LogCategories").write_inner_content(|xml| {
        for (name, description) in crate::logger::categories() {
            xml.create_element("Category")
                .with_attributes([("name", name.as_str()), ("description", description)])
                .write_empty()?;
        }
        Ok(())
    })?;
    Ok(())
}

fn default_experiment(xml: &mut Xml) -> io::Result<()> {
    xml.create_element("DefaultExperiment")
        .with_attributes([("startTime", "0"), ("stopTime", STOP_TIME_S), ("stepSize", STEP_SIZE_S)])
        .write_empty()?;
    Ok(())
}
