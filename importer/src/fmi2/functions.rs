//! The functions of an FMU's library.

use std::ffi::{c_int, c_void};
use std::path::Path;

use libloading::Library;

use super::logger::text_of;
use super::types::{DoStep, Free, Get, GetText, Instantiate, Plain, Set, SetupExperiment, Text};
use crate::error::ImportError;

/// The functions that are called. The library stays loaded to the end of the process: one that has made threads, or is an
/// interpreter, does not survive being unloaded.
pub(crate) struct Functions {
    pub(crate) instantiate: Instantiate,
    pub(crate) free_instance: Free,
    pub(crate) setup_experiment: SetupExperiment,
    pub(crate) enter_initialization: Plain,
    pub(crate) exit_initialization: Plain,
    pub(crate) terminate: Plain,
    pub(crate) get_real: Get<f64>,
    pub(crate) get_integer: Get<c_int>,
    pub(crate) get_boolean: Get<c_int>,
    pub(crate) set_real: Set<f64>,
    pub(crate) set_integer: Set<c_int>,
    pub(crate) set_boolean: Set<c_int>,
    pub(crate) set_string: Set<Text>,
    pub(crate) do_step: DoStep,
}

impl Functions {
    /// Loads a library and asks for its version.
    ///
    /// # Errors
    /// [`ImportError`] of the loader, of a missing function or of the version.
    pub(crate) fn load(path: &Path) -> Result<Self, ImportError> {
        let library = open(path)?;
        let version = find::<GetText>(&library, "fmi2GetVersion")?;
        // SAFETY: the type is the standard's; the text is a constant of the library.
        let version = unsafe { text_of(version()) };
        if !version.starts_with("2.") {
            return Err(ImportError::LibraryVersion(version));
        }
        let functions = Self {
            instantiate: find(&library, "fmi2Instantiate")?,
            free_instance: find(&library, "fmi2FreeInstance")?,
            setup_experiment: find(&library, "fmi2SetupExperiment")?,
            enter_initialization: find(&library, "fmi2EnterInitializationMode")?,
            exit_initialization: find(&library, "fmi2ExitInitializationMode")?,
            terminate: find(&library, "fmi2Terminate")?,
            get_real: find(&library, "fmi2GetReal")?,
            get_integer: find(&library, "fmi2GetInteger")?,
            get_boolean: find(&library, "fmi2GetBoolean")?,
            set_real: find(&library, "fmi2SetReal")?,
            set_integer: find(&library, "fmi2SetInteger")?,
            set_boolean: find(&library, "fmi2SetBoolean")?,
            set_string: find(&library, "fmi2SetString")?,
            do_step: find(&library, "fmi2DoStep")?,
        };
        std::mem::forget(library);
        Ok(functions)
    }
}

/// Loads a library whose symbols later ones see: an interpreter's, for instance. It stays loaded.
///
/// # Errors
/// [`ImportError::Library`]
pub(crate) fn load_for_all(name: &Path) -> Result<(), ImportError> {
    #[cfg(unix)]
    let loaded = {
        use libloading::os::unix::{Library, RTLD_GLOBAL, RTLD_NOW};
        // SAFETY: its constructors run; the user has named it.
        unsafe { Library::open(Some(name), RTLD_NOW | RTLD_GLOBAL) }.map(std::mem::forget)
    };
    #[cfg(not(unix))]
    // SAFETY: as above.
    let loaded = unsafe { Library::new(name) }.map(std::mem::forget);
    loaded.map_err(|error| ImportError::Library(told(&error)))
}

fn open(path: &Path) -> Result<Library, ImportError> {
    // SAFETY: its constructors run. Whoever imports an FMU runs its code; the isolation is for those who do not trust it.
    #[cfg(not(windows))]
    let library = unsafe { Library::new(path) };
    #[cfg(windows)]
    // SAFETY: as above. Libraries beside it are found, too.
    let library = unsafe {
        use libloading::os::windows::{
            LOAD_LIBRARY_SEARCH_DEFAULT_DIRS, LOAD_LIBRARY_SEARCH_DLL_LOAD_DIR, Library,
        };
        Library::load_with_flags(path, LOAD_LIBRARY_SEARCH_DLL_LOAD_DIR | LOAD_LIBRARY_SEARCH_DEFAULT_DIRS)
    }
    .map(Library::from);
    library.map_err(|error| ImportError::Library(told(&error)))
}

/// The loader's own words, in one line.
fn told(error: &libloading::Error) -> String {
    let source = std::error::Error::source(error).map(ToString::to_string);
    source.unwrap_or_else(|| error.to_string()).lines().collect::<Vec<_>>().join(" ")
}

/// A function of a library that stays loaded.
fn find<T: Copy>(library: &Library, name: &'static str) -> Result<T, ImportError> {
    const { assert!(size_of::<T>() == size_of::<*const c_void>()) };
    // SAFETY: T is the standard's type of the function with this name, see the callers.
    let symbol = unsafe { library.get::<T>(name) };
    symbol.map(|symbol| *symbol).map_err(|_| ImportError::Function(name))
}
