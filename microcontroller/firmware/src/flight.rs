//! A controller that flies recorded flights again.

use alloc::vec::Vec;

use cortex_m_semihosting::hprintln;
use lmpc::{Controller, ControllerState};
use recording::{Moment, Recorded, read};

use crate::counter::Counter;
use crate::stack;

/// A loop of the cascade with its flights.
pub struct Loop<const N: usize, const P: usize, const E: usize> {
    name: &'static str,
    recorded: Recorded<N, P, E>,
    /// Its moments, not read yet.
    moments: &'static [u8],
}

/// The figures of its steps.
struct Figures {
    instructions: Vec<u32>,
    limited: usize,
    stack_bytes: usize,
    /// The largest difference to a command of double precision, and the largest command.
    furthest: f32,
    largest: f32,
}

impl<const N: usize, const P: usize, const E: usize> Loop<N, P, E> {
    /// Reads the next loop of a recording.
    pub fn read(name: &'static str, left: &mut &'static [u8]) -> Result<Self, &'static str> {
        let recorded: Recorded<N, P, E> = read(left).map_err(|_| "no controller")?;
        let moments = *left;
        for _ in 0..recorded.moments {
            read::<Moment<N, P>>(left).map_err(|_| "no moment")?;
        }
        Ok(Self { name, recorded, moments })
    }

    /// Flies all of it, and prints a line of figures.
    pub fn fly(&self, counter: &Counter) -> Result<(), &'static str> {
        let mut figures = self.figures(counter)?;
        figures.instructions.sort_unstable();
        let count = figures.instructions.len();
        let at = |share: usize| figures.instructions[(count - 1) * share / 100];
        let mean = figures.instructions.iter().copied().map(u64::from).sum::<u64>() / count as u64;
        let period_us = self.recorded.period_us;
        let rows = self.recorded.law.rows();
        hprintln!(
            "loop\t{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}",
            self.name,
            period_us,
            rows,
            count,
            figures.limited,
            mean,
            at(50),
            at(99),
            at(100),
            figures.stack_bytes,
            figures.furthest,
            figures.largest
        );
        Ok(())
    }

    fn figures(&self, counter: &Counter) -> Result<Figures, &'static str> {
        let count = self.recorded.moments as usize;
        let mut figures = Figures {
            instructions: Vec::with_capacity(count),
            limited: 0,
            stack_bytes: 0,
            furthest: 0.0,
            largest: 0.0,
        };
        let mut left = self.moments;
        let mut state = ControllerState::<N, P, E, f32>::at_rest().keeping::<E>();
        for _ in 0..count {
            let moment: Moment<N, P> = read(&mut left).map_err(|_| "no moment")?;
            if moment.begins {
                state = ControllerState::at_rest().keeping();
            }
            let sample = moment.sample(&self.recorded.upper);
            let mut tried = state;
            let (_, stack_bytes) =
                stack::depth_of(|| core::hint::black_box(self.recorded.law.step(&mut tried, &sample)));
            let (step, instructions) = counter.of(|| self.recorded.law.step(&mut state, &sample));
            // Both go on from the same input.
            state.apply(&moment.applied);
            figures.instructions.push(instructions as u32);
            figures.limited += usize::from(step.active > 0);
            figures.stack_bytes = figures.stack_bytes.max(stack_bytes);
            figures.furthest = figures.furthest.max((step.input - moment.applied).amax());
            figures.largest = figures.largest.max(moment.applied.amax());
        }
        Ok(figures)
    }
}
