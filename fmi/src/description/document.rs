//! A document, and the parts around its variables that are the same in all versions.

use std::io;

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};

use super::numbers::real;
use crate::model::{Experiment, Words};

/// The writer that the parts of a description share.
pub(super) type Xml = Writer<Vec<u8>>;

/// Attributes of an element.
pub(super) type Attributes<'a> = Vec<(&'a str, String)>;

/// A whole document: its root with attributes, and what is in it.
pub(super) fn document(
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
pub(super) fn empty(xml: &mut Xml, name: &str, attributes: &Attributes<'_>) -> io::Result<()> {
    xml.create_element(name)
        .with_attributes(attributes.iter().map(|(name, value)| (*name, value.as_str())))
        .write_empty()?;
    Ok(())
}

/// `LogCategories`. `of_errors` is appended to the descriptions of categories that report errors.
pub(super) fn log_categories(xml: &mut Xml, words: &Words, of_errors: &str) -> io::Result<()> {
    xml.create_element("LogCategories").write_inner_content(|xml| {
        crate::logger::categories(words).try_for_each(|(name, description, reports_errors)| {
            let remark = if reports_errors { of_errors } else { "" };
            empty(xml, "Category", &vec![("name", name), ("description", format!("{description}{remark}"))])
        })
    })?;
    Ok(())
}

/// `DefaultExperiment`
pub(super) fn default_experiment(xml: &mut Xml, experiment: &Experiment) -> io::Result<()> {
    let (stop_time, step_size) = (real(experiment.stop_time_s), real(experiment.step_size_s));
    let attributes = vec![("startTime", "0".to_owned()), ("stopTime", stop_time), ("stepSize", step_size)];
    empty(xml, "DefaultExperiment", &attributes)
}

/// A truth value.
pub(super) fn truth(value: bool) -> String {
    value.to_string()
}
