//! The floating-point environment of a call.
//!
//! Compiled code relies on the default environment: rounding to nearest, gradual underflow, no traps. A host may have another one:
//! it unmasks exceptions to find its own defects, or flushes tiny numbers to zero to save time. Results must not depend on that,
//! and an intermediate result must not end the host.

/// The default environment for as long as this value lives; then the host's again, with its status flags.
pub(crate) struct DefaultEnvironment {
    host: registers::Environment,
}

impl DefaultEnvironment {
    /// Replaces the host's environment.
    pub fn enter() -> Self {
        let host = registers::read();
        registers::write(registers::DEFAULT);
        Self { host }
    }
}

impl Drop for DefaultEnvironment {
    fn drop(&mut self) {
        registers::write(self.host);
    }
}

#[cfg(target_arch = "x86_64")]
mod registers {
    use std::arch::asm;

    /// MXCSR: control bits and status flags (Intel SDM, volume 1, section 10.2.3).
    pub(super) type Environment = u32;

    /// All exceptions masked, rounding to nearest, gradual underflow, no flag raised.
    pub(super) const DEFAULT: Environment = 0x1f80;

    pub(super) fn read() -> Environment {
        let mut value = 0_u32;
        // SAFETY: it writes four bytes to `value`.
        unsafe { asm!("stmxcsr [{}]", in(reg) &raw mut value, options(nostack, preserves_flags)) };
        value
    }

    pub(super) fn write(value: Environment) {
        // SAFETY: it reads four bytes of `value`, which is the default or was read before: no reserved bit is set.
        unsafe { asm!("ldmxcsr [{}]", in(reg) &raw const value, options(nostack, readonly)) };
    }
}

#[cfg(target_arch = "aarch64")]
mod registers {
    use std::arch::asm;

    /// FPCR and FPSR (Arm Architecture Reference Manual for A-profile, section C5.2).
    #[derive(Clone, Copy)]
    pub(super) struct Environment {
        control: u64,
        status: u64,
    }

    /// No trap enabled, rounding to nearest, gradual underflow, NaNs kept, no flag raised.
    pub(super) const DEFAULT: Environment = Environment { control: 0, status: 0 };

    pub(super) fn read() -> Environment {
        let (control, status): (u64, u64);
        // SAFETY: it reads two registers that every process may read.
        unsafe {
            asm!("mrs {}, fpcr", "mrs {}, fpsr", out(reg) control, out(reg) status, options(nostack, nomem, preserves_flags));
        }
        Environment { control, status }
    }

    pub(super) fn write(Environment { control, status }: Environment) {
        // SAFETY: the values are the default or were read before: no reserved bit is set. Not `nomem`: arithmetic on memory stays where it is.
        unsafe {
            asm!("msr fpcr, {}", "msr fpsr, {}", in(reg) control, in(reg) status, options(nostack, preserves_flags));
        }
    }
}

/// Other processors keep the host's environment.
#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
mod registers {
    pub(super) type Environment = ();

    pub(super) const DEFAULT: Environment = ();

    pub(super) fn read() -> Environment {}

    pub(super) fn write((): Environment) {}
}
