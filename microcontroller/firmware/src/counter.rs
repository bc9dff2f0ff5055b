//! Instructions, by the system timer of an emulator that goes by them.

use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;

/// The timer counts 24 bits.
const RANGE: u32 = 1 << 24;
/// Ticks of 40 ns for an instruction of 64 ns: 25 MHz, and `-icount shift=6`.
const TICKS: (u64, u64) = (8, 5);
/// Turns of a loop of two instructions that are counted to see whether the timer goes by instructions.
const TURNS: u32 = 10_000;
/// By how much that may differ.
const AROUND_IT: u64 = 40;

/// Counts instructions.
pub struct Counter {
    timer: SYST,
}

impl Counter {
    /// Starts the timer.
    pub fn start(mut timer: SYST) -> Self {
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(RANGE - 1);
        timer.clear_current();
        timer.enable_counter();
        Self { timer }
    }

    /// Whether a loop of a known number of instructions takes that number.
    pub fn check(&self) -> Result<(), &'static str> {
        // Two instructions a turn: subtract and branch.
        let (_, counted) = self.of(|| cortex_m::asm::delay(TURNS));
        if counted.abs_diff(u64::from(2 * TURNS)) < AROUND_IT {
            Ok(())
        } else {
            Err("the timer does not count instructions")
        }
    }

    /// What a piece of work returns, and its instructions: at most ten million.
    pub fn of<R>(&self, work: impl FnOnce() -> R) -> (R, u64) {
        let before = SYST::get_current();
        let result = work();
        let after = SYST::get_current();
        // It counts down.
        let ticks = before.wrapping_sub(after) % RANGE;
        (result, u64::from(ticks) * TICKS.1 / TICKS.0)
    }
}

impl Drop for Counter {
    fn drop(&mut self) {
        self.timer.disable_counter();
    }
}
