//! Something that counts once it has been so for a while.

/// Since when something is so, µs.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Lasting(Option<u64>);

impl Lasting {
    /// Whether it has been so for a time.
    pub fn update(&mut self, is_so: bool, time_us: u64, least_us: u64) -> bool {
        self.0 = is_so.then(|| self.0.unwrap_or(time_us));
        self.0.is_some_and(|since_us| time_us - since_us >= least_us)
    }
}
