//! Groups of variables that are connected together.

/// A group of inputs and outputs that plugs into one of another model: a terminal of FMI 3.0, which FMI 2.0.4 has, too.
///
/// Members of two terminals belong together when their names are the same.
#[derive(Clone, Copy, Debug)]
pub struct Terminal {
    /// Its name.
    pub name: &'static str,
    /// What it connects, for a person.
    pub description: &'static str,
    /// How its members find theirs.
    pub matching: Matching,
    /// Its inputs and outputs, in the order of the table: each entry stands for all whose names begin with it.
    pub variables: &'static [&'static str],
    /// What is left out of a variable's name to make its member's, if the name begins with it.
    pub prefix: &'static str,
}

/// How members of two terminals find one another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Matching {
    /// Both terminals have the same members.
    Plug,
    /// A member that the other terminal does not have stays unconnected.
    Bus,
}

impl Terminal {
    /// The name of the member that is this variable, if it is one.
    pub fn member<'a>(&self, variable: &'a str) -> Option<&'a str> {
        let belongs = self.variables.iter().any(|beginning| variable.starts_with(beginning));
        belongs.then(|| variable.strip_prefix(self.prefix).unwrap_or(variable))
    }
}
