//! `terminalsAndIcons.xml`: groups of variables that are connected together.

use std::io;

use super::document::{Xml, document, empty};
use super::fmi3::elements;
use crate::layout::Layout;
use crate::model::Model;
use crate::variables::{Matching, Role, Terminal, Variable, variables};

/// Path of the file in an FMU: since FMI 2.0.4 version 2.0 has it, too.
pub const TERMINALS_AND_ICONS: &str = "terminalsAndIcons/terminalsAndIcons.xml";

/// The text of `terminalsAndIcons/terminalsAndIcons.xml` for an FMU of version 2.0, if the model has terminals.
///
/// # Panics
/// Never: writing into memory does not fail, and the writer makes UTF-8 of UTF-8.
pub fn terminals_and_icons<M: Model>() -> Option<String> {
    let ports: Vec<&str> =
        variables::<M>().filter_map(|(_, variable)| is_port(variable).then_some(variable.name)).collect();
    of(M::TERMINALS, &ports)
}

/// The same for an FMU of version 3.0, where vectors are one variable.
///
/// # Panics
/// Never, as above.
pub fn terminals_and_icons3<M: Model>() -> Option<String> {
    let layout = Layout::of::<M>();
    let ports: Vec<&str> = layout
        .entries()
        .iter()
        .filter(|entry| elements::<M>(entry).first().is_some_and(|variable| is_port(variable)))
        .map(|entry| entry.name)
        .collect();
    of(M::TERMINALS, &ports)
}

fn is_port<M: Model>(variable: &Variable<M>) -> bool {
    matches!(variable.role, Role::Input(_) | Role::Output { .. })
}

fn of(terminals: &[Terminal], ports: &[&str]) -> Option<String> {
    let written = || written(terminals, ports).expect("writing into memory does not fail");
    (!terminals.is_empty()).then(written)
}

fn written(terminals: &[Terminal], ports: &[&str]) -> io::Result<String> {
    document("fmiTerminalsAndIcons", &[("fmiVersion", "3.0")], |xml| {
        xml.create_element("Terminals").write_inner_content(|xml| {
            terminals.iter().try_for_each(|terminal| write_terminal(xml, terminal, ports))
        })?;
        Ok(())
    })
}

fn write_terminal(xml: &mut Xml, terminal: &Terminal, ports: &[&str]) -> io::Result<()> {
    let rule = match terminal.matching {
        Matching::Plug => "plug",
        Matching::Bus => "bus",
    };
    xml.create_element("Terminal")
        .with_attributes([
            ("name", terminal.name),
            ("matchingRule", rule),
            ("description", terminal.description),
        ])
        .write_inner_content(|xml| {
            for (port, member) in ports.iter().filter_map(|port| Some((*port, terminal.member(port)?))) {
                let names = [("variableName", port), ("memberName", member), ("variableKind", "signal")];
                empty(
                    xml,
                    "TerminalMemberVariable",
                    &names.map(|(name, value)| (name, value.to_owned())).into(),
                )?;
            }
            Ok(())
        })?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{Matching, Terminal, terminals_and_icons, written};
    use crate::lag::Lag;

    #[test]
    fn a_terminal_lists_its_ports_under_the_names_of_its_members() {
        let terminal = Terminal {
            name: "motion",
            description: "Motion",
            matching: Matching::Bus,
            variables: &["measured.", "armed"],
            prefix: "measured.",
        };
        let text = written(&[terminal], &["armed", "measured.x", "x"]).expect("written");
        let members: Vec<&str> =
            text.lines().filter(|line| line.contains("TerminalMemberVariable")).map(str::trim).collect();
        assert_eq!(
            members,
            [
                r#"<TerminalMemberVariable variableName="armed" memberName="armed" variableKind="signal"/>"#,
                r#"<TerminalMemberVariable variableName="measured.x" memberName="x" variableKind="signal"/>"#,
            ]
        );
        assert!(
            text.contains(r#"<Terminal name="motion" matchingRule="bus" description="Motion">"#),
            "{text}"
        );
    }

    #[test]
    fn a_model_without_terminals_has_no_file() {
        assert_eq!(terminals_and_icons::<Lag>(), None);
    }
}
