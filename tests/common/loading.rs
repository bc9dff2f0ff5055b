//! Loading a freshly built library.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::path::PathBuf;

/// A type for a library with these functions: name of the field, exported name, type.
macro_rules! library {
    ($($field:ident = $symbol:literal: fn($($argument:ty),*) $(-> $result:ty)?;)*) => {
        /// The library with its functions.
        #[allow(clippy::type_complexity)]
        pub struct Library {
            $(pub $field: unsafe extern "C" fn($($argument),*) $(-> $result)?,)*
            // Last: the functions are gone when it is dropped.
            _handle: libloading::Library,
        }

        /// The names of the functions, in the order of the specification.
        pub const SYMBOLS: &[&str] = &[$($symbol),*];

        impl Library {
            /// Loads the library of this name that was built together with this test.
            pub fn load(name: &str) -> Self {
                let path = $crate::common::loading::path(name);
                // SAFETY: the library's initialisers are those of a Rust cdylib.
                let handle = unsafe { libloading::Library::new(&path) }
                    .unwrap_or_else(|error| panic!("{} cannot be loaded: {error}", path.display()));
                // SAFETY: the types are those of the header of the standard.
                $(let $field = *unsafe { handle.get($symbol.as_bytes()) }
                    .unwrap_or_else(|error| panic!("{} is missing: {error}", $symbol));)*
                Self { $($field,)* _handle: handle }
            }
        }
    };
}

pub(crate) use library;

/// Where Cargo puts a library that belongs to this test: beside the test itself. The copy one folder up
/// may be missing or old.
pub fn path(name: &str) -> PathBuf {
    let test = std::env::current_exe().expect("a test knows where it is");
    test.with_file_name(format!("{DLL_PREFIX}{name}{DLL_SUFFIX}"))
}
