//! Saved states that somebody made on purpose: header, length and checksum are good, the content is not. The layout is
//! written down again here.

use quadrotor::{Configuration, Inputs, SimulationState};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::closed_loop;
use crate::common::instance::Instance;
use crate::common::library::ERROR;
use crate::common::subject::Subject;
use crate::state::{bytes_midway, midway};

const HEADER: usize = 40;
const LENGTH: std::ops::Range<usize> = 28..36;
const CHECKSUM: std::ops::Range<usize> = 36..40;

/// Kind of the run, place in the life, clock, parameters and inputs, derivatives of inputs, run.
type Payload = (
    u32,
    u32,
    (f64, Option<f64>, f64),
    (Configuration, Inputs, Vec<(u32, i32, i32)>),
    Vec<(u32, i32, f64)>,
    Option<SimulationState>,
);

/// Makes header and payload fit together.
fn sign(bytes: &mut [u8]) {
    let payload = &bytes[HEADER..];
    let (length, checksum) = (payload.len() as u64, crc32fast::hash(payload));
    bytes[LENGTH].copy_from_slice(&length.to_le_bytes());
    bytes[CHECKSUM].copy_from_slice(&checksum.to_le_bytes());
}

fn decoded<T: DeserializeOwned>(bytes: &[u8]) -> T {
    postcard::from_bytes(&bytes[HEADER..]).expect("the layout is this")
}

fn encoded(header: &[u8], payload: &impl Serialize) -> Vec<u8> {
    let mut bytes = header[..HEADER].to_vec();
    bytes.extend(postcard::to_allocvec(payload).expect("it serializes"));
    sign(&mut bytes);
    bytes
}

#[test]
fn absurd_content_with_a_good_checksum_is_refused() {
    let good = bytes_midway(closed_loop());
    let mut instance = Instance::new(closed_loop());
    let payload: Payload = decoded(&good);
    assert_eq!(encoded(&good, &payload), good);
    // Numbers of enumerations: of no enumeration, twice, not the item that flies, of no item.
    let kind = closed_loop().description.reference("controller.kind_number");
    for numbers in [vec![(0, 2, 1)], vec![(kind, 2, 1); 2], vec![(kind, 1, 1)], vec![(kind, 2, 9)]] {
        let mut payload = payload.clone();
        payload.3.2 = numbers;
        assert_eq!(instance.deserialize(&encoded(&good, &payload)), Err(ERROR), "{payload:?}");
        instance.log.last();
    }
    let mut refused = |change: fn(&mut Payload)| {
        let mut payload = payload.clone();
        change(&mut payload);
        assert_eq!(instance.deserialize(&encoded(&good, &payload)), Err(ERROR), "{payload:?}");
        instance.log.last();
    };
    refused(|(_, _, _, (_, inputs, _), ..)| inputs.reference.position_m.x = f64::NAN);
    refused(|(_, _, _, (_, inputs, _), ..)| inputs.reference.position_m.x = 1e7);
    refused(|(_, _, _, (configuration, ..), ..)| configuration.airframe.mass_kg = 0.0);
    refused(|(_, _, _, (configuration, ..), ..)| configuration.controllers.altitude.terms = 1_000_000);
    refused(|(_, _, _, (configuration, ..), ..)| configuration.limits.thrust_min = 20.0);
    refused(|(_, _, clock, ..)| *clock = (0.0, None, 0.0));
    refused(|(.., run)| *run = None);
    // The sixth place in the life: lost.
    refused(|(_, phase, ..)| *phase = 5);
    // Model exchange, which this model has not, and a place in the life that only model exchange has.
    refused(|(kind, ..)| *kind = 1);
    refused(|(_, phase, ..)| *phase = 6);
}

fn trailing_bytes_in_the_payload_are_refused(subject: &'static Subject) {
    let mut bytes = bytes_midway(subject);
    bytes.push(0);
    sign(&mut bytes);
    let mut instance = Instance::new(subject);
    assert_eq!(instance.deserialize(&bytes), Err(ERROR));
    assert!(instance.log.last().text.contains("cannot be decoded"));
}

/// NaN in any place of the payload is found.
fn nan_anywhere_is_refused(subject: &'static Subject) {
    let good = bytes_midway(subject);
    let mut instance = midway(subject);
    let mut found = 0;
    for place in HEADER..good.len() - 8 {
        let mut bytes = good.clone();
        bytes[place..place + 8].copy_from_slice(&f64::NAN.to_le_bytes());
        sign(&mut bytes);
        match instance.deserialize(&bytes) {
            // Across the bounds of numbers it makes another number.
            Ok(state) => instance.free_state(state),
            Err(_) => found += usize::from(instance.log.last().text.contains("NaN or infinity")),
        }
    }
    assert!(found >= subject.sample.state_numbers, "only {found} numbers");
}

for_each_model! {
    trailing_bytes_in_the_payload_are_refused,
    nan_anywhere_is_refused,
}
