//! What was lost under a load, in numbers and words.

/// What was lost because more came than can be handled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lost {
    /// Datagrams for which the inbox of their sender had no room.
    pub datagrams: u64,
    /// Frames beyond the share that their sender may have forwarded.
    pub forwards: u64,
}

impl std::fmt::Display for Lost {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let counts = [(self.datagrams, "datagram"), (self.forwards, "forwarded frame")];
        let words = counts.iter().filter(|(count, _)| *count > 0).map(|(count, what)| {
            let plural = if *count == 1 { "" } else { "s" };
            format!("{count} {what}{plural}")
        });
        write!(formatter, "dropped {}", words.collect::<Vec<_>>().join(", "))
    }
}
