//! How deep the stack gets: what is below it is painted before, and looked at afterwards.

use cortex_m::register::msp;

/// How far down it is painted, bytes: more than any controller needs.
const DEPTH: usize = 16 * 1024;
/// What a stack does not hold by itself.
const PAINT: u32 = 0xC0FF_EE15;
/// Left alone next to the painter, bytes: its own frame.
const OWN: usize = 128;

/// The deepest stack of a piece of work, bytes, and what it returns.
#[inline(never)]
pub fn depth_of<R>(work: impl FnOnce() -> R) -> (R, usize) {
    let top = msp::read() as usize - OWN;
    let bottom = top - DEPTH;
    for address in (bottom..top).step_by(size_of::<u32>()) {
        // SAFETY: below the stack and above all else in memory, which the linker leaves room for; aligned as the stack is.
        unsafe { core::ptr::write_volatile(address as *mut u32, PAINT) };
    }
    let result = work();
    let untouched = (bottom..top)
        .step_by(size_of::<u32>())
        // SAFETY: as above.
        .find(|address| unsafe { core::ptr::read_volatile(*address as *const u32) } != PAINT);
    (result, untouched.map_or(0, |address| top + OWN - address))
}
