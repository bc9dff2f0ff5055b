//! A thousand times: load, instantiate, fly a little, free, unload. In a process of its own, where nothing
//! else keeps the library loaded.

mod common;

use common::instance::Instance;
use common::library::Library;

/// Resident memory in pages; `None` where that is not known.
fn resident_pages() -> Option<usize> {
    let statistics = std::fs::read_to_string("/proc/self/statm").ok()?;
    statistics.split_whitespace().nth(1)?.parse().ok()
}

fn cycle() -> u64 {
    let library = Library::load();
    let mut instance = Instance::new(&library);
    instance.initialize();
    instance.fly(0.0, 0.05, 2);
    let state = instance.get_state();
    instance.free_state(state);
    instance.real("position.z").to_bits()
}

#[test]
fn a_thousand_cycles() {
    let first = cycle();
    for _ in 0..100 {
        assert_eq!(cycle(), first);
    }
    let before = resident_pages();
    for _ in 0..900 {
        assert_eq!(cycle(), first);
    }
    if let (Some(before), Some(after)) = (before, resident_pages()) {
        assert!(after <= before + 256, "resident memory grew from {before} to {after} pages");
    }
}

/// The library is really unloaded: nothing of it is mapped any more.
#[test]
#[cfg(target_os = "linux")]
fn nothing_stays_behind() {
    // Not while the other test has it loaded: in a process of its own.
    let test = std::env::current_exe().expect("a test knows where it is");
    let output = std::process::Command::new(test)
        .args(["--exact", "unloaded_after_one_cycle", "--ignored"])
        .output()
        .expect("this executable runs");
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success() && text.contains("1 passed"), "{text}");
}

#[test]
#[ignore = "run by nothing_stays_behind, in a process of its own"]
fn unloaded_after_one_cycle() {
    cycle();
    let maps = std::fs::read_to_string("/proc/self/maps").expect("Linux");
    let path = common::library::path();
    let name = path.file_name().expect("a file").to_string_lossy().into_owned();
    assert!(!maps.lines().any(|line| line.ends_with(&name)), "{name} is still mapped");
}
