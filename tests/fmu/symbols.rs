//! What the library exports.

use std::collections::BTreeSet;
use std::ffi::CStr;

use object::{Object, ObjectSymbol};

use crate::common::fmi3::library::SYMBOLS as SYMBOLS_OF_3;
use crate::common::library::SYMBOLS;
use crate::common::subject::Subject;

#[test]
fn there_are_44_functions_of_version_2_and_75_of_version_3() {
    assert_eq!(SYMBOLS.iter().collect::<BTreeSet<_>>().len(), 44);
    assert_eq!(SYMBOLS_OF_3.iter().collect::<BTreeSet<_>>().len(), 75);
}

/// Read from the file: the linker decides what is exported, and another one may decide otherwise.
fn exactly_the_functions_of_both_versions_are_exported(subject: &'static Subject) {
    if !cfg!(target_os = "linux") {
        return;
    }
    let bytes =
        std::fs::read(crate::common::loading::path(subject.sample.library)).expect("the library was built");
    let file = object::File::parse(&*bytes).expect("it is an ELF file");
    let exported: BTreeSet<&str> = file
        .dynamic_symbols()
        .filter(|symbol| symbol.is_definition())
        .map(|symbol| symbol.name().expect("symbols have names"))
        .collect();
    assert_eq!(exported, SYMBOLS.iter().chain(SYMBOLS_OF_3).copied().collect());
}

#[test]
fn version_of_3() {
    let library = crate::common::fmi3::library::Library::load("fmu");
    // SAFETY: the function takes nothing and returns a static string.
    assert_eq!(unsafe { CStr::from_ptr((library.get_version)()) }, c"3.0");
}

fn version_and_platform(subject: &'static Subject) {
    // SAFETY: both functions take nothing and return static strings.
    unsafe {
        assert_eq!(CStr::from_ptr((subject.library.get_version)()), c"2.0");
        assert_eq!(CStr::from_ptr((subject.library.get_types_platform)()), c"default");
    }
}

for_each_model! {
    exactly_the_functions_of_both_versions_are_exported,
    version_and_platform,
}
