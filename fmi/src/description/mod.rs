//! `modelDescription.xml`, written from the table of variables.

mod structure;
mod units;
mod variables;

use std::io;

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};

use crate::identity::guid;
use crate::model::{Experiment, Identity, Model};

/// The writer that the parts of the description share.
type Xml = Writer<Vec<u8>>;

/// The text of `modelDescription.xml`.
///
/// # Panics
/// Never: writing into memory does not fail, and the writer makes UTF-8 of UTF-8.
pub fn model_description<M: Model>() -> String {
    written::<M>().expect("writing into memory does not fail")
}

fn written<M: Model>() -> io::Result<String> {
    let identity = M::IDENTITY;
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    xml.create_element("fmiModelDescription")
        .with_attributes([
            ("fmiVersion", "2.0"),
            ("modelName", identity.name),
            ("guid", &guid::<M>()),
            ("description", identity.description),
            ("author", identity.author),
            ("version", identity.version),
            ("copyright", identity.copyright),
            ("license", identity.license),
            ("generationTool", identity.generation_tool),
            ("generationDateAndTime", identity.date),
            ("variableNamingConvention", "structured"),
        ])
        .with_attributes(
            M::CONTINUOUS
                .map(|equations| ("numberOfEventIndicators", equations.event_indicators().to_string()))
                .iter()
                .map(|(name, count)| (*name, count.as_str())),
        )
        .write_inner_content(|xml| {
            if M::CONTINUOUS.is_some() {
                model_exchange(xml, &identity)?;
            }
            co_simulation::<M>(xml, &identity)?;
            units::write::<M>(xml)?;
            log_categories(xml, &identity)?;
            default_experiment(xml, &identity.default_experiment)?;
            variables::write::<M>(xml)?;
            structure::write::<M>(xml)
        })?;
    let mut bytes = xml.into_inner();
    bytes.push(b'\n');
    String::from_utf8(bytes).map_err(io::Error::other)
}

/// Capabilities of model exchange.
fn model_exchange(xml: &mut Xml, identity: &Identity) -> io::Result<()> {
    xml.create_element("ModelExchange")
        .with_attributes([
            ("modelIdentifier", identity.model_identifier),
            ("completedIntegratorStepNotNeeded", "false"),
            ("canBeInstantiatedOnlyOncePerProcess", "false"),
            ("canNotUseMemoryManagementFunctions", "true"),
            ("canGetAndSetFMUstate", "true"),
            ("canSerializeFMUstate", "true"),
            ("providesDirectionalDerivative", "true"),
        ])
        .write_empty()?;
    Ok(())
}

/// Capabilities of co-simulation.
fn co_simulation<M: Model>(xml: &mut Xml, identity: &Identity) -> io::Result<()> {
    xml.create_element("CoSimulation")
        .with_attributes([
            ("modelIdentifier", identity.model_identifier),
            ("canHandleVariableCommunicationStepSize", "true"),
            ("canInterpolateInputs", "true"),
            ("maxOutputDerivativeOrder", if M::OUTPUT_RATES.is_some() { "1" } else { "0" }),
            ("canBeInstantiatedOnlyOncePerProcess", "false"),
            ("canNotUseMemoryManagementFunctions", "true"),
            ("canGetAndSetFMUstate", "true"),
            ("canSerializeFMUstate", "true"),
            ("providesDirectionalDerivative", if M::CONTINUOUS.is_some() { "true" } else { "false" }),
        ])
        .write_empty()?;
    Ok(())
}

fn log_categories(xml: &mut Xml, identity: &Identity) -> io::Result<()> {
    xml.create_element("LogCategories").write_inner_content(|xml| {
        for (name, description) in crate::logger::categories(&identity.words) {
            xml.create_element("Category")
                .with_attributes([("name", name.as_str()), ("description", description)])
                .write_empty()?;
        }
        Ok(())
    })?;
    Ok(())
}

fn default_experiment(xml: &mut Xml, experiment: &Experiment) -> io::Result<()> {
    let [stop_time, step_size] = [experiment.stop_time_s, experiment.step_size_s].map(variables::real);
    xml.create_element("DefaultExperiment")
        .with_attributes([("startTime", "0"), ("stopTime", &stop_time), ("stepSize", &step_size)])
        .write_empty()?;
    Ok(())
}
