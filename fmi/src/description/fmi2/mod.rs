//! `modelDescription.xml` of FMI 2.0.

mod structure;
mod types;
mod variables;

use std::io;

use super::document::{Xml, default_experiment, document, empty, log_categories, truth};
use super::units;
use crate::identity::guid;
use crate::model::Model;

/// The text of `modelDescription.xml` of FMI 2.0.
///
/// # Panics
/// Never: writing into memory does not fail, and the writer makes UTF-8 of UTF-8.
pub fn model_description<M: Model>() -> String {
    written::<M>().expect("writing into memory does not fail")
}

fn written<M: Model>() -> io::Result<String> {
    let identity = M::IDENTITY;
    let guid = guid::<M>();
    let event_indicators = M::CONTINUOUS.map(|equations| equations.event_indicators().to_string());
    let mut attributes = vec![
        ("fmiVersion", "2.0"),
        ("modelName", identity.name),
        ("guid", &guid),
        ("description", identity.description),
        ("author", identity.author),
        ("version", identity.version),
        ("copyright", identity.copyright),
        ("license", identity.license),
        ("generationTool", identity.generation_tool),
        ("generationDateAndTime", identity.date),
        ("variableNamingConvention", "structured"),
    ];
    attributes.extend(event_indicators.as_deref().map(|count| ("numberOfEventIndicators", count)));
    document("fmiModelDescription", &attributes, |xml| {
        if M::CONTINUOUS.is_some() {
            model_exchange::<M>(xml)?;
        }
        co_simulation::<M>(xml)?;
        let quantities = units::quantities::<M>();
        units::write(xml, &units::units(&quantities))?;
        types::write::<M>(xml, &quantities)?;
        log_categories(xml, &identity.words, "; always logged")?;
        default_experiment(xml, &identity.default_experiment)?;
        variables::write::<M>(xml)?;
        structure::write::<M>(xml)
    })
}

/// Capabilities of model exchange.
fn model_exchange<M: Model>(xml: &mut Xml) -> io::Result<()> {
    let attributes = vec![
        ("modelIdentifier", M::IDENTITY.model_identifier.to_owned()),
        ("completedIntegratorStepNotNeeded", truth(false)),
        ("canBeInstantiatedOnlyOncePerProcess", truth(false)),
        ("canNotUseMemoryManagementFunctions", truth(true)),
        ("canGetAndSetFMUstate", truth(true)),
        ("canSerializeFMUstate", truth(true)),
        ("providesDirectionalDerivative", truth(true)),
    ];
    empty(xml, "ModelExchange", &attributes)
}

/// Capabilities of co-simulation.
fn co_simulation<M: Model>(xml: &mut Xml) -> io::Result<()> {
    let attributes = vec![
        ("modelIdentifier", M::IDENTITY.model_identifier.to_owned()),
        ("canHandleVariableCommunicationStepSize", truth(true)),
        ("canInterpolateInputs", truth(true)),
        ("maxOutputDerivativeOrder", u8::from(M::OUTPUT_RATES.is_some()).to_string()),
        ("canBeInstantiatedOnlyOncePerProcess", truth(false)),
        ("canNotUseMemoryManagementFunctions", truth(true)),
        ("canGetAndSetFMUstate", truth(true)),
        ("canSerializeFMUstate", truth(true)),
        ("providesDirectionalDerivative", truth(M::CONTINUOUS.is_some())),
    ];
    empty(xml, "CoSimulation", &attributes)
}
