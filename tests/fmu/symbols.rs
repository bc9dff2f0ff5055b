//! What the library exports.

use std::collections::BTreeSet;
use std::ffi::CStr;

use object::{Object, ObjectSymbol};

use crate::common::library::SYMBOLS;
use crate::common::subject::Subject;

#[test]
fn there_are_44_functions() {
    assert_eq!(SYMBOLS.iter().collect::<BTreeSet<_>>().len(), 44);
}

/// Read from the file: the linker decides what is exported, and another one may decide otherwise.
fn exactly_the_functions_of_the_interface_are_exported(subject: &'static Subject) {
    if !cfg!(target_os = "linux") {
        return;
    }
    let bytes =
        std::fs::read(crate::common::library::path(subject.sample.library)).expect("the library was built");
    let file = object::File::parse(&*bytes).expect("it is an ELF file");
    let exported: BTreeSet<&str> = file
        .dynamic_symbols()
        .filter(|symbol| symbol.is_definition())
        .map(|symbol| symbol.name().expect("symbols have names"))
        .collect();
    assert_eq!(exported, SYMBOLS.iter().copied().collect());
}

fn version_and_platform(subject: &'static Subject) {
    // SAFETY: both functions take nothing and return static strings.
    unsafe {
        assert_eq!(CStr::from_ptr((subject.library.get_version)()), c"2.0");
        assert_eq!(CStr::from_ptr((subject.library.get_types_platform)()), c"default");
    }
}

for_each_model! {
    exactly_the_functions_of_the_interface_are_exported,
    version_and_platform,
}
