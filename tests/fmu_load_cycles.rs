//! A thousand times: load, instantiate, fly a little, free, unload; and nothing stays behind. The only test of its
//! process, where nothing else keeps the library loaded.

mod common;

use common::instance::Instance;
use common::subject::Subject;

/// Resident memory in pages; `None` where that is not known.
fn resident_pages() -> Option<usize> {
    let statistics = std::fs::read_to_string("/proc/self/statm").ok()?;
    statistics.split_whitespace().nth(1)?.parse().ok()
}

fn cycle(load: fn() -> Subject) -> u64 {
    let subject = load();
    let mut instance = Instance::new(&subject);
    instance.initialize();
    instance.fly(0.0, 0.05, 2);
    let state = instance.get_state();
    instance.free_state(state);
    instance.real(subject.sample.output).to_bits()
}

#[test]
fn a_thousand_cycles_of_each_model() {
    a_thousand_cycles("fmu", Subject::closed_loop);
    a_thousand_cycles("lag", Subject::lag);
}

fn a_thousand_cycles(library: &str, load: fn() -> Subject) {
    let first = cycle(load);
    assert!(!is_mapped(library), "the library is still mapped");
    for _ in 0..100 {
        assert_eq!(cycle(load), first);
    }
    let before = resident_pages();
    for _ in 0..900 {
        assert_eq!(cycle(load), first);
    }
    if let (Some(before), Some(after)) = (before, resident_pages()) {
        assert!(after <= before + 256, "resident memory grew from {before} to {after} pages");
    }
    assert!(!is_mapped(library), "the library is still mapped");
}

/// Whether anything of the library is in this process; `false` where that is not known.
fn is_mapped(library: &str) -> bool {
    let Ok(maps) = std::fs::read_to_string("/proc/self/maps") else { return false };
    let path = common::loading::path(library);
    let name = path.file_name().expect("a file").to_string_lossy().into_owned();
    maps.lines().any(|line| line.ends_with(&name))
}
