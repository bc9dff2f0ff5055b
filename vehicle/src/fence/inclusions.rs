//! How several areas to stay in combine.

/// Where the vehicle may be when there are several areas to stay in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Inclusions {
    /// In any of them: together they are one area.
    #[default]
    Any,
    /// Only where all of them are.
    All,
}

impl Inclusions {
    /// Whether a place is forbidden that is outside of each of the areas, or not. Without an area nothing is.
    pub fn forbid(self, mut outside: impl Iterator<Item = bool>) -> bool {
        match self {
            Self::Any => {
                let mut outside = outside.peekable();
                outside.peek().is_some() && outside.all(|outside| outside)
            }
            Self::All => outside.any(|outside| outside),
        }
    }
}
