//! The shipped controllers in single precision with flights of theirs, for a microcontroller that flies them again.

use lmpc::Controller;
use recording::{Moment, Recorded, write};

use crate::Failure;
use crate::shipped::{Loops, Shipped};

/// Controllers and flights, as `recording` reads them.
///
/// # Errors
/// When a loop cannot be designed.
pub fn record() -> Result<Vec<u8>, Failure> {
    let loops = Loops::new()?;
    let bytes = append(&loops.position, Vec::new())?;
    let bytes = append(&loops.altitude, bytes)?;
    let bytes = append(&loops.lean, bytes)?;
    append(&loops.turn, bytes)
}

fn append<const N: usize, const P: usize, const E: usize>(
    shipped: &Shipped<N, P, E>,
    bytes: Vec<u8>,
) -> Result<Vec<u8>, Failure> {
    // Few flights: the memory of a microcontroller holds them.
    let moments = shipped.flights(true);
    let upper = &shipped.linear.upper;
    let recorded = Recorded {
        law: shipped.law.to_precision(),
        upper: upper.iter().map(|bound| *bound as f32).collect(),
        period_us: (shipped.linear.sample_time_s * 1e6).round() as u32,
        moments: u32::try_from(moments.len())?,
    };
    let mut bytes = write(&recorded, bytes)?;
    let mut flight = None;
    for moment in &moments {
        let mut controller = moment.before;
        let step = shipped.law.step(&mut controller, &moment.sample(upper));
        let moment = Moment {
            begins: flight.replace(moment.flight) != Some(moment.flight),
            measured: moment.measured.cast(),
            increment: moment.increment.cast(),
            error: moment.error.cast(),
            applied: step.input.cast(),
        };
        bytes = write(&moment, bytes)?;
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use lmpc::{Controller, ControllerState};
    use recording::{Moment, ONE, Recorded, TWO, read};

    use super::record;

    /// Flies the next loop again: by how much its commands differ from those of double precision, as a share of the largest one.
    fn flown<const N: usize, const P: usize, const E: usize>(left: &mut &[u8]) -> (f32, usize) {
        let recorded: Recorded<N, P, E> = read(left).unwrap();
        let mut state = ControllerState::<N, P, E, f32>::at_rest();
        let (mut furthest, mut largest, mut limited) = (0.0_f32, 0.0_f32, 0);
        for _ in 0..recorded.moments {
            let moment: Moment<N, P> = read(left).unwrap();
            if moment.begins {
                state = ControllerState::at_rest();
            }
            let step = recorded.law.step(&mut state, &moment.sample(&recorded.upper));
            state.apply(&moment.applied);
            furthest = furthest.max((step.input - moment.applied).amax());
            largest = largest.max(moment.applied.amax());
            limited += usize::from(step.active > 0);
        }
        (furthest / largest, limited)
    }

    /// What the firmware does on a microcontroller, here: commands of single precision within a two-hundredth of the largest of those of
    /// double precision, at limits and off them.
    #[test]
    fn recorded_flights_are_flown_again_in_single_precision() {
        let bytes = record().unwrap();
        let mut left = bytes.as_slice();
        let flights = [
            flown::<12, 2, TWO>(&mut left),
            flown::<3, 1, ONE>(&mut left),
            flown::<6, 2, TWO>(&mut left),
            flown::<3, 1, ONE>(&mut left),
        ];
        assert!(left.is_empty());
        for (apart, limited) in flights {
            assert!(apart < 5e-3 && limited > 10, "{flights:?}");
        }
    }
}
