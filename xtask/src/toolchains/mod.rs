//! What builds for a platform, and what runs its programs: how each part is found, and installed.
//!
//! ```text
//! Toolchain ─┬─ compiler    this project's, or another on the machine that knows the platform
//!            ├─ linker      the system's, mingw, zig
//!            └─ emulator    wine, qemu
//! need ◄──── what of these is missing ────► install: rustup, apt
//! ```

mod compiler;
mod debian;
mod emulator;
mod linker;
mod machine;
mod need;
mod system_emulator;
mod toolchain;

pub use compiler::Compiler;
pub use emulator::Emulator;
pub use linker::{c_library_notice, zig_environment};
pub use need::{Need, provide};
pub use system_emulator::SystemEmulator;
pub use toolchain::Toolchain;
