//! The table of variables as a reader of the documentation wants it, from modelDescription.xml.

use std::fmt::Write;

use roxmltree::{Document, Node};

use crate::failure::Failure;
use crate::html::escaped;

/// Groups of the table: title, causality.
const GROUPS: [(&str, &str); 5] = [
    ("Inputs", "input"),
    ("Outputs", "output"),
    ("Derivatives of states, event indicators", "local"),
    ("Parameters", "parameter"),
    ("Calculated parameters", "calculatedParameter"),
];

/// HTML tables of all variables, grouped by causality.
pub fn tables(description: &str) -> Result<String, Failure> {
    let document = Document::parse(description)?;
    let mut html = String::new();
    for (title, causality) in GROUPS {
        let rows: String = document
            .descendants()
            .filter(|node| node.has_tag_name("ModelVariables"))
            .flat_map(|list| list.children())
            .filter(|node| node.attribute("causality") == Some(causality))
            .map(row)
            .collect();
        if !rows.is_empty() {
            // Writing to a String cannot fail.
            let _ = write!(
                html,
                "<h3>{title}</h3>\n<table class=\"variables\">\n<tr><th>Name</th><th>Unit</th><th>Start</th><th>Range</th>\
                 <th>Description</th></tr>\n{rows}</table>\n"
            );
        }
    }
    Ok(html)
}

fn row(variable: Node) -> String {
    // FMI 3.0 has no element for the type in that of the variable: it is that of the type.
    let (kind, dimension) = match variable.children().find(Node::is_element) {
        Some(child) if variable.has_tag_name("ScalarVariable") => (Some(child), None),
        child => (Some(variable), child.and_then(|dimension| dimension.attribute("start"))),
    };
    let name = variable.attribute("name").unwrap_or("");
    let name = dimension.map_or_else(|| name.to_owned(), |size| format!("{name}[{size}]"));
    let attribute = |name| kind.and_then(|node| node.attribute(name)).unwrap_or("");
    let range = match (attribute("min"), attribute("max")) {
        ("", "") => String::new(),
        (minimum, maximum) => format!("{} … {}", short(minimum), short(maximum)),
    };
    let unit = match kind.map(|node| node.tag_name().name()) {
        Some("Real" | "Float64") | None => declared_unit(variable, kind),
        Some(other) => other.to_owned(),
    };
    let tunable = if variable.attribute("variability") == Some("tunable") { " (tunable)" } else { "" };
    format!(
        "<tr><td><code>{}</code></td><td>{}</td><td data-label=\"start\">{}</td><td data-label=\"range\">{}</td>\
         <td>{}{tunable}</td></tr>\n",
        escaped(&name),
        escaped(&unit),
        escaped(&short(attribute("start"))),
        escaped(&range),
        escaped(variable.attribute("description").unwrap_or("")),
    )
}

/// The unit of a real variable, its own or that of its declared type.
fn declared_unit(variable: Node, kind: Option<Node>) -> String {
    let own = kind.and_then(|node| node.attribute("unit"));
    let declared = || {
        let name = kind?.attribute("declaredType")?;
        let simple = variable
            .document()
            .descendants()
            .find(|node| node.has_tag_name("SimpleType") && node.attribute("name") == Some(name))?;
        simple.children().find(Node::is_element)?.attribute("unit").map(str::to_owned)
    };
    own.map(str::to_owned).or_else(declared).unwrap_or_default()
}

/// A number without the digits that nobody reads: those of multiples of π.
fn short(number: &str) -> String {
    match number.parse::<f64>() {
        Ok(value) if number.len() > 12 => format!("{value:.4}"),
        _ => number.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::tables;

    #[test]
    fn lists_every_variable_with_unit_start_and_range() {
        let html = tables(&fmi::description::model_description::<fmu::ClosedLoop>())
            .expect("the description is XML");
        let rows = html.matches("<tr><td>").count();
        let variables =
            fmi::description::model_description::<fmu::ClosedLoop>().matches("<ScalarVariable ").count();
        assert_eq!(rows, variables, "variables of a causality that the documentation leaves out");
        assert!(
            html.contains("<td><code>airframe.mass</code></td><td>kg</td><td data-label=\"start\">0.7</td>"),
            "{html}"
        );
    }
}
