//! Controllers in single precision with flights of theirs that were recorded in double precision: what one machine writes and a
//! microcontroller reads.
//!
//! ```text
//! recording   position, altitude, roll and pitch, yaw: [controller, moments × moment]
//! ```
//!
//! The way of a controller from the one to the other:
//!
//! ```
//! # use lmpc::{Controller, ControllerState, Sample, StabilizedMpc, unknowns};
//! # fn convert(controller: &StabilizedMpc<12, 2, 2, { unknowns(2, 8) }>) -> Result<Vec<u8>, postcard::Error> {
//! // On the computer: any controller of lmpc.
//! let single = controller.to_precision::<f32>();
//! let bytes = postcard::to_allocvec(&single)?;
//! # Ok(bytes)
//! # }
//! # static BYTES: &[u8] = &[];
//! # fn fly(sample: Sample<'_, 12, 2, 2, f32>) -> Result<(), postcard::Error> {
//! // On the device, once. Its memory holds the controller from then on.
//! let controller: StabilizedMpc<12, 2, 2, { unknowns(2, 8) }, f32> = postcard::from_bytes(BYTES)?;
//! let mut state = ControllerState::<12, 2, { unknowns(2, 8) }, f32>::at_rest().keeping::<{ unknowns(2, 8) }>();
//! // At each sample:
//! let step = controller.step(&mut state, &sample);
//! # Ok(())
//! # }
//! ```
#![no_std]
#![forbid(unsafe_code)]

extern crate alloc;

use alloc::vec::Vec;

use lmpc::{Sample, StabilizedMpc, unknowns};
use nalgebra::SVector;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

/// Laguerre terms per input that a controller of the cascade has room for.
pub const TERMS: usize = 8;
/// Unknowns of programs of one input.
pub const ONE: usize = unknowns(1, TERMS);
/// The same of two inputs.
pub const TWO: usize = unknowns(2, TERMS);

/// A controller of N states and P inputs with at most E unknowns, under constant limits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Recorded<const N: usize, const P: usize, const E: usize> {
    /// The controller.
    pub law: StabilizedMpc<N, P, P, E, f32>,
    /// Values of its limits.
    pub upper: Vec<f32>,
    /// Its sample time, µs.
    pub period_us: u32,
    /// How many moments follow.
    pub moments: u32,
}

/// A sample of a flight, and what was applied at it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Moment<const N: usize, const P: usize> {
    /// Whether a flight begins: the controller is at rest.
    pub begins: bool,
    /// x(k).
    pub measured: SVector<f32, N>,
    /// Δx(k).
    pub increment: SVector<f32, N>,
    /// y(k) − r(k).
    pub error: SVector<f32, P>,
    /// u(k) of double precision.
    pub applied: SVector<f32, P>,
}

impl<const N: usize, const P: usize> Moment<N, P> {
    /// What the controller is told, under some limits.
    pub fn sample<'a>(&self, upper: &'a [f32]) -> Sample<'a, N, P, P, f32> {
        Sample {
            measured: self.measured,
            increment: self.increment,
            error: self.error,
            upper,
            ..Sample::default()
        }
    }
}

/// Appends a part of a recording.
///
/// # Errors
/// Those of postcard.
pub fn write(part: &impl Serialize, to: Vec<u8>) -> postcard::Result<Vec<u8>> {
    postcard::to_extend(part, to)
}

/// Reads a part from the begin of what is left of a recording, and goes on behind it.
///
/// # Errors
/// When the bytes are no such part.
pub fn read<T: DeserializeOwned>(left: &mut &[u8]) -> postcard::Result<T> {
    let (part, rest) = postcard::take_from_bytes(left)?;
    *left = rest;
    Ok(part)
}
