//! The items of the enumerations as a reader of the documentation wants them, from modelDescription.xml.

use std::fmt::Write;

use roxmltree::{Document, Node};

use crate::failure::Failure;
use crate::html::escaped;

/// An HTML table for each enumeration: number, name, meaning, and the variables that have it.
pub fn tables(description: &str) -> Result<String, Failure> {
    let document = Document::parse(description)?;
    let mut html = String::new();
    let is_enumeration = |node: &Node| {
        // FMI 3.0, FMI 2.0
        node.has_tag_name("EnumerationType")
            || node.has_tag_name("SimpleType")
                && node.children().any(|child| child.has_tag_name("Enumeration"))
    };
    for enumeration in document.descendants().filter(is_enumeration) {
        let attribute = |name| enumeration.attribute(name).unwrap_or("");
        let rows: String =
            enumeration.descendants().filter(|node| node.has_tag_name("Item")).map(row).collect();
        let has_it = |node: &Node| {
            node.has_tag_name("Enumeration") && node.attribute("declaredType") == Some(attribute("name"))
        };
        let variables: Vec<String> = document
            .descendants()
            .filter(has_it)
            .filter_map(|node| node.attribute("name").or_else(|| node.parent_element()?.attribute("name")))
            .map(|name| format!("<code>{}</code>", escaped(name)))
            .collect();
        // Writing to a String cannot fail.
        let _ = write!(
            html,
            "<h3>{}</h3>\n<p>{}: {}</p>\n<table>\n<tr><th>Number</th><th>Name</th><th>Meaning</th></tr>\n{rows}</table>\n",
            escaped(attribute("name")),
            escaped(attribute("description")),
            variables.join(", "),
        );
    }
    Ok(html)
}

fn row(item: Node) -> String {
    let attribute = |name| escaped(item.attribute(name).unwrap_or(""));
    let (number, name, meaning) = (attribute("value"), attribute("name"), attribute("description"));
    format!("<tr><td>{number}</td><td><code>{name}</code></td><td>{meaning}</td></tr>\n")
}

#[cfg(test)]
mod tests {
    use super::tables;
    use crate::product::{CLOSED_LOOP, Version};

    #[test]
    fn explains_every_status() {
        for description in Version::ALL.map(|version| CLOSED_LOOP.description(version)) {
            let html = tables(&description).expect("the description is XML");
            for status in ["optimal", "relaxed", "iteration_limit", "held"] {
                assert!(html.contains(&format!("<td><code>{status}</code></td>")), "{status}");
            }
            assert!(html.contains("<code>controller.position.status</code>"), "{html}");
        }
    }
}
