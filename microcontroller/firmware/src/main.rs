//! The four controllers of the cascade in single precision on a Cortex-M4F: each flies its recorded flights again, and says what a step
//! took and how far its commands are from those of double precision.
//!
//! Meant for `qemu-system-arm -M mps2-an386 -icount shift=6`, where the system timer goes by instructions.
#![no_std]
#![no_main]

extern crate alloc;

mod counter;
mod flight;
mod image;
mod stack;

use core::mem::MaybeUninit;
use core::panic::PanicInfo;

use cortex_m_rt::{ExceptionFrame, entry, exception};
use cortex_m_semihosting::{debug, hprintln};
use embedded_alloc::LlffHeap;

use counter::Counter;
use flight::Loop;
use recording::{ONE, TWO};

/// Room for the controllers, which are read once, when the firmware starts.
const HEAP: usize = 32 * 1024;

#[global_allocator]
static ALLOCATOR: LlffHeap = LlffHeap::empty();
static mut ROOM: [MaybeUninit<u8>; HEAP] = [MaybeUninit::uninit(); HEAP];

/// Controllers with flights, made by `bench recording`.
static RECORDING: &[u8] = include_bytes!(env!("RECORDING"));

#[entry]
fn main() -> ! {
    // SAFETY: nothing else uses the room, and it is given away once, before the first allocation.
    unsafe { ALLOCATOR.init(&raw mut ROOM as usize, HEAP) }
    let timer = cortex_m::Peripherals::take().map(|peripherals| Counter::start(peripherals.SYST));
    match timer.ok_or("no timer").and_then(|counter| run(&counter)) {
        Ok(()) => end(debug::EXIT_SUCCESS),
        Err(why) => {
            hprintln!("error: {}", why);
            end(debug::EXIT_FAILURE)
        }
    }
}

/// Reads all controllers, then flies one after the other.
fn run(counter: &Counter) -> Result<(), &'static str> {
    counter.check()?;
    let mut left = RECORDING;
    let position = Loop::<12, 2, TWO>::read("position", &mut left)?;
    let altitude = Loop::<3, 1, ONE>::read("altitude", &mut left)?;
    let lean = Loop::<6, 2, TWO>::read("roll and pitch", &mut left)?;
    let turn = Loop::<3, 1, ONE>::read("yaw", &mut left)?;
    let used = ALLOCATOR.used();
    hprintln!("flash\t{}\t{}", image::code_bytes(), image::constant_bytes() - RECORDING.len());
    hprintln!("memory\t{}\t{}", image::static_bytes() - HEAP, used);
    position.fly(counter)?;
    altitude.fly(counter)?;
    lean.fly(counter)?;
    turn.fly(counter)?;
    if ALLOCATOR.used() == used { Ok(()) } else { Err("a step allocated") }
}

// SAFETY: it only tells the emulator to end.
#[exception]
unsafe fn HardFault(_frame: &ExceptionFrame) -> ! {
    end(debug::EXIT_FAILURE)
}

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    hprintln!("{}", info);
    end(debug::EXIT_FAILURE)
}

/// Ends the emulator.
fn end(status: debug::ExitStatus) -> ! {
    debug::exit(status);
    loop {
        cortex_m::asm::wfi();
    }
}
