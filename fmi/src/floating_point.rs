//! The floating-point environment of a call.
//!
//! Compiled code relies on the default environment: rounding to nearest, gradual underflow, no traps. A host may have another one:
//! it unmasks exceptions to find its own defects, or flushes tiny numbers to zero to save time. Results must not depend on that,
//! and an intermediate result must not end the host.

/// The default environment for as long as this value lives; then the host's again, with its status flags.
pub(crate) struct DefaultEnvironment {
    #[cfg(target_arch = "x86_64")]
    host: u32,
}

#[cfg(target_arch = "x86_64")]
mod mxcsr {
    use std::arch::asm;

    /// All exceptions masked, rounding to nearest, gradual underflow, no flag raised (Intel SDM, volume 1, section 10.2.3).
    pub(super) const DEFAULT: u32 = 0x1f80;

    pub(super) fn read() -> u32 {
        let mut value = 0_u32;
        // SAFETY: it writes four bytes to `value`.
        unsafe { asm!("stmxcsr [{}]", in(reg) &raw mut value, options(nostack, preserves_flags)) };
        value
    }

    pub(super) fn write(value: u32) {
        // SAFETY: it reads four bytes of `value`, which is the default or was read before: no reserved bit is set.
        unsafe { asm!("ldmxcsr [{}]", in(reg) &raw const value, options(nostack, readonly)) };
    }
}

impl DefaultEnvironment {
    /// Replaces the host's environment.
    #[cfg(target_arch = "x86_64")]
    pub fn enter() -> Self {
        let host = mxcsr::read();
        mxcsr::write(mxcsr::DEFAULT);
        Self { host }
    }

    /// Other architectures keep the host's environment: their default one has no traps to set.
    #[cfg(not(target_arch = "x86_64"))]
    pub fn enter() -> Self {
        Self {}
    }
}

#[cfg(target_arch = "x86_64")]
impl Drop for DefaultEnvironment {
    fn drop(&mut self) {
        mxcsr::write(self.host);
    }
}
