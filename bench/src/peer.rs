//! Solvers in C, loaded as `bench/peers/peer.h` describes them.

use std::ffi::{CStr, c_char, c_double, c_int, c_void};
use std::path::PathBuf;
use std::ptr::NonNull;

use libloading::Library;

use crate::Failure;
use crate::program::{PosedSample, Program};
use crate::solver::{Maker, Solved, Solver};

type Name = unsafe extern "C" fn() -> *const c_char;
type New = unsafe extern "C" fn(c_int, c_int, *const c_double) -> *mut c_void;
type Solve = unsafe extern "C" fn(
    *mut c_void,
    *const c_double,
    *const c_double,
    c_int,
    *mut c_double,
    *mut c_int,
) -> c_int;
type Memory = unsafe extern "C" fn(*const c_void) -> usize;
type Free = unsafe extern "C" fn(*mut c_void);

/// A library with a peer.
pub struct PeerLibrary {
    name: String,
    new: New,
    solve: Solve,
    memory: Memory,
    free: Free,
    /// The functions are in it.
    _library: Library,
}

/// Loads libraries.
///
/// # Errors
/// When one of them is no library, or lacks a function.
pub fn load_all(paths: &[PathBuf]) -> Result<Vec<PeerLibrary>, Failure> {
    let load = |path: &PathBuf| {
        PeerLibrary::load(path).map_err(|failure| format!("{}: {failure:?}", path.display()).into())
    };
    paths.iter().map(load).collect()
}

impl PeerLibrary {
    fn load(path: &PathBuf) -> Result<Self, Failure> {
        // SAFETY: it was compiled from bench/peers, whose libraries do nothing when they are loaded.
        let library = unsafe { Library::new(path) }?;
        // SAFETY: these are the functions of peer.h.
        let (name, new, solve, memory, free) = unsafe {
            (
                *library.get::<Name>(b"peer_name")?,
                *library.get::<New>(b"peer_new")?,
                *library.get::<Solve>(b"peer_solve")?,
                *library.get::<Memory>(b"peer_memory")?,
                *library.get::<Free>(b"peer_free")?,
            )
        };
        // SAFETY: the name is a text that lives as long as the library.
        let name = unsafe { CStr::from_ptr(name()) }.to_string_lossy().into_owned();
        Ok(Self { name, new, solve, memory, free, _library: library })
    }
}

impl Maker for PeerLibrary {
    fn solver<'a>(&'a self, program: &'a Program) -> Option<Box<dyn Solver + 'a>> {
        let (unknowns, rows) = (i32::try_from(program.unknowns).ok()?, i32::try_from(program.rows).ok()?);
        // SAFETY: G has as many numbers as the program says, and is copied.
        let peer = NonNull::new(unsafe { (self.new)(unknowns, rows, program.left.as_ptr()) })?;
        Some(Box::new(Peer { library: self, program, peer }))
    }
}

struct Peer<'a> {
    library: &'a PeerLibrary,
    program: &'a Program,
    peer: NonNull<c_void>,
}

impl Solver for Peer<'_> {
    fn name(&self) -> &str {
        &self.library.name
    }

    fn solve(&mut self, sample: &PosedSample, warm: bool, z: &mut [f64]) -> Solved {
        assert_eq!(
            (sample.gradient.len(), sample.upper.len(), z.len()),
            (self.program.unknowns, self.program.rows, self.program.unknowns)
        );
        let mut iterations: c_int = 0;
        // SAFETY: the lengths are those that it was made with.
        let status = unsafe {
            (self.library.solve)(
                self.peer.as_ptr(),
                sample.gradient.as_ptr(),
                sample.upper.as_ptr(),
                c_int::from(warm),
                z.as_mut_ptr(),
                &raw mut iterations,
            )
        };
        Solved { solved: status == 0, iterations: u32::try_from(iterations).unwrap_or_default() }
    }

    fn memory(&self) -> Option<usize> {
        // SAFETY: the peer is alive.
        Some(unsafe { (self.library.memory)(self.peer.as_ptr()) }).filter(|bytes| *bytes > 0)
    }
}

impl Drop for Peer<'_> {
    fn drop(&mut self) {
        // SAFETY: the peer is alive, and nobody has it after this.
        unsafe { (self.library.free)(self.peer.as_ptr()) }
    }
}
