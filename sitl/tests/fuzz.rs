//! A short, seeded run of the fuzzer: see `examples/fuzz.rs` for long ones.

mod fuzzing;

#[test]
fn nothing_that_arrives_breaks_it_or_makes_it_grow() {
    let corpus = fuzzing::corpus();
    assert!(corpus.len() > 300);
    let frames: u64 = (0..24).map(|seed| fuzzing::case(seed, &corpus)).sum();
    // Most of what is made arrives as frames: it is the vehicle that is tested, not the checksum.
    assert!(frames > 24 * 300, "{frames}");
}

#[test]
fn garbage_between_orders_leaves_the_flight_as_it_is() {
    let corpus = fuzzing::corpus();
    for seed in 0..3 {
        fuzzing::undisturbed(seed, &corpus);
    }
}
