//! Short, seeded runs of the fuzz targets: see `examples/fuzz.rs` for long ones.

use crate::fuzzing;

/// How much of what a target counts there was in so many cases.
fn run(name: &str, most: u64) -> u64 {
    let target = fuzzing::TARGETS.iter().find(|target| target.name == name).expect("a target");
    let (count, figures) = target.run(0, |cases| cases < most);
    println!("{figures}");
    count
}

#[test]
fn nothing_that_arrives_breaks_it_or_makes_it_grow() {
    // Most of what is made arrives as frames: it is the vehicle that is tested, not the checksum.
    let frames = run("vehicle", 24);
    assert!(frames > 24 * 300, "{frames}");
}

#[test]
fn garbage_between_orders_leaves_the_flight_as_it_is() {
    assert_eq!(run("garbage", 3), 3);
}

#[test]
fn without_the_key_nothing_is_accepted_and_nothing_changes() {
    let refused = run("signatures", 10);
    assert!(refused > 10 * 1_000, "{refused}");
}

#[test]
fn an_edited_file_is_refused_in_a_line_or_flies() {
    assert!(run("files", 40) > 0);
}

#[test]
fn no_controls_lose_the_plant() {
    let controls = run("simulator", 3);
    assert!(controls > 3 * 1_000, "{controls}");
}
