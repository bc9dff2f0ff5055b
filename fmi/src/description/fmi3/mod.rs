//! `modelDescription.xml` of FMI 3.0.

mod structure;
mod types;
mod variables;

pub(super) use variables::elements;

use std::io;

use super::document::{Xml, default_experiment, document, empty, log_categories, truth};
use super::units;
use crate::identity::guid;
use crate::layout::Layout;
use crate::model::Model;
use crate::variables::Unit;

/// The unit of the independent variable.
const SECOND: Unit = Unit { name: "s", base: &[("s", "1")], display: &[] };

/// The text of `modelDescription.xml` of FMI 3.0.
///
/// # Panics
/// Never: writing into memory does not fail, and the writer makes UTF-8 of UTF-8.
pub fn model_description3<M: Model>() -> String {
    written::<M>().expect("writing into memory does not fail")
}

fn written<M: Model>() -> io::Result<String> {
    let identity = M::IDENTITY;
    let attributes = [
        ("fmiVersion", "3.0"),
        ("modelName", identity.name),
        ("instantiationToken", &guid::<M>()),
        ("description", identity.description),
        ("author", identity.author),
        ("version", identity.version),
        ("copyright", identity.copyright),
        ("license", identity.license),
        ("generationTool", identity.generation_tool),
        ("generationDateAndTime", identity.date),
        ("variableNamingConvention", "structured"),
    ];
    let layout = Layout::of::<M>();
    document("fmiModelDescription", &attributes, |xml| {
        if M::CONTINUOUS.is_some() {
            model_exchange::<M>(xml)?;
        }
        co_simulation::<M>(xml)?;
        let quantities = units::quantities::<M>();
        let mut units = units::units(&quantities);
        if units.iter().all(|unit| unit.name != SECOND.name) {
            units.push(&SECOND);
        }
        units::write(xml, &units)?;
        types::write::<M>(xml, &quantities)?;
        log_categories(xml, &identity.words, "")?;
        default_experiment(xml, &identity.default_experiment)?;
        variables::write::<M>(xml, &layout)?;
        structure::write::<M>(xml, &layout)
    })
}

/// Capabilities of model exchange.
fn model_exchange<M: Model>(xml: &mut Xml) -> io::Result<()> {
    let attributes = vec![
        ("modelIdentifier", M::IDENTITY.model_identifier.to_owned()),
        ("canGetAndSetFMUState", truth(true)),
        ("canSerializeFMUState", truth(true)),
        ("providesDirectionalDerivatives", truth(true)),
        ("providesAdjointDerivatives", truth(true)),
        ("needsCompletedIntegratorStep", truth(true)),
    ];
    empty(xml, "ModelExchange", &attributes)
}

/// Capabilities of co-simulation. What is not named is not offered: event mode, early return, intermediate update, dependencies of elements.
fn co_simulation<M: Model>(xml: &mut Xml) -> io::Result<()> {
    let attributes = vec![
        ("modelIdentifier", M::IDENTITY.model_identifier.to_owned()),
        ("canGetAndSetFMUState", truth(true)),
        ("canSerializeFMUState", truth(true)),
        ("providesDirectionalDerivatives", truth(M::CONTINUOUS.is_some())),
        ("providesAdjointDerivatives", truth(M::CONTINUOUS.is_some())),
        ("canHandleVariableCommunicationStepSize", truth(true)),
        ("maxOutputDerivativeOrder", u8::from(M::OUTPUT_RATES.is_some()).to_string()),
        ("hasEventMode", truth(false)),
    ];
    empty(xml, "CoSimulation", &attributes)
}
