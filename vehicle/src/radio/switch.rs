//! Positions of switches.

/// A switch with three positions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Position {
    /// Below 1200 µs.
    Low,
    /// Between.
    Middle,
    /// Above 1800 µs.
    High,
}

/// A pulse outside of these, µs, is no position.
const VALID_US: core::ops::RangeInclusive<u16> = 800..=2200;

/// Where a switch is; `None`: the pulse is none of a switch.
pub fn position(pulse_us: u16) -> Option<Position> {
    match pulse_us {
        _ if !VALID_US.contains(&pulse_us) => None,
        ..1200 => Some(Position::Low),
        1801.. => Some(Position::High),
        _ => Some(Position::Middle),
    }
}

/// Where a switch with six positions is, from 0, as ArduPilot divides the pulses.
pub fn sixth(pulse_us: u16) -> Option<usize> {
    const ENDS_US: [u16; 5] = [1231, 1361, 1491, 1621, 1750];
    let inside = (901..2200).contains(&pulse_us);
    inside.then(|| ENDS_US.iter().filter(|end_us| pulse_us >= **end_us).count())
}

/// A switch must stay where it is for this long to count, µs.
const STEADY_US: u64 = 200_000;

/// A switch whose positions count once they are steady.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Debounced<T> {
    counted: Option<T>,
    /// Another position, and since when, µs.
    candidate: Option<(T, u64)>,
}

impl<T> Default for Debounced<T> {
    fn default() -> Self {
        Self { counted: None, candidate: None }
    }
}

impl<T: Copy + PartialEq> Debounced<T> {
    /// Sees a position at a time, µs. Returns a position that counts from now on, with the one before.
    pub fn see(&mut self, position: T, time_us: u64) -> Option<(Option<T>, T)> {
        if self.counted == Some(position) {
            self.candidate = None;
            return None;
        }
        match self.candidate {
            Some((candidate, since_us)) if candidate == position => {
                (time_us >= since_us + STEADY_US).then(|| (self.counted.replace(position), position))
            }
            _ => {
                self.candidate = Some((position, time_us));
                None
            }
        }
    }

    /// The position that counts.
    pub fn counted(&self) -> Option<T> {
        self.counted
    }

    /// Forgets where it was: the next steady position is a new one.
    pub fn forget(&mut self) {
        *self = Self::default();
    }
}

#[cfg(test)]
mod tests {
    use super::{Debounced, Position, position, sixth};

    #[test]
    fn positions_are_those_of_ardupilot() {
        let sixths: Vec<_> = [1165, 1230, 1231, 1295, 1425, 1555, 1685, 1749, 1750, 1815].map(sixth).into();
        assert_eq!(sixths, [0, 0, 1, 1, 2, 3, 4, 4, 5, 5].map(Some));
        assert!(sixth(900).is_none() && sixth(2200).is_none() && position(0).is_none());
        assert_eq!(
            [1000, 1199, 1200, 1800, 1801].map(position),
            [Position::Low, Position::Low, Position::Middle, Position::Middle, Position::High].map(Some)
        );
    }

    #[test]
    fn a_position_counts_once_it_is_steady() {
        let mut switch = Debounced::default();
        assert_eq!(switch.see(1, 0), None);
        assert_eq!(switch.see(2, 100_000), None);
        assert_eq!(switch.see(2, 299_999), None);
        assert_eq!(switch.see(2, 300_000), Some((None, 2)));
        assert_eq!(switch.see(2, 900_000), None);
        assert_eq!(switch.see(1, 1_000_000), None);
        assert_eq!(switch.see(2, 1_100_000), None, "a bounce");
        assert_eq!(switch.see(1, 1_150_000), None);
        assert_eq!(switch.see(1, 1_350_000), Some((Some(2), 1)));
    }
}
