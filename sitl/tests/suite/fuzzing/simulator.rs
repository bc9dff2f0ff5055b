//! Controls of all kinds into the plant that an external autopilot flies.

use autopilot::codec::{Frame, FrameDecoder};
use sitl::configuration::{Arguments, Settings};
use sitl::hil::{ActuatorControls, Mount, Rig};

use super::bytes::{Bytes, framed};

/// Steps of one case.
const STEPS: usize = 2_000;

/// Flies one case. Panics if the plant is lost. Returns the number of controls that arrived.
pub fn controlled(seed: u64) -> u64 {
    let mut bytes = Bytes::new(seed);
    let settings = Settings::resolve(&Arguments::default()).expect("defaults");
    let mount = if seed.is_multiple_of(2) { Mount::X } else { Mount::Plus };
    let mut rig = Rig::new(&settings.vehicles[0].vehicle, mount).expect("a vehicle");
    let mut decoder = FrameDecoder::default();
    let mut taken = 0;
    for _ in 0..STEPS {
        let sent = if bytes.below(3) == 0 { bytes.piece() } else { controls(&mut bytes) };
        for frame in decoder.push(&sent) {
            if frame.message_id() == ActuatorControls::ID {
                rig.control(&ActuatorControls::read(&frame));
                taken += 1;
            }
        }
        let told = rig.step().expect("the flight goes on");
        assert!(!told.is_empty());
        let body = &rig.plant().body;
        assert!(body.position_m.iter().chain(&body.velocity_m_s).all(|number| number.is_finite()));
    }
    taken
}

/// HIL_ACTUATOR_CONTROLS: mostly armed, motors in range, out of it, or no numbers.
fn controls(bytes: &mut Bytes) -> Vec<u8> {
    let mut payload = bytes.below(1 << 30).to_le_bytes().to_vec();
    payload.extend((bytes.below(2) as u64).to_le_bytes());
    for _ in 0..16 {
        let motor = match bytes.below(40) {
            0 => f32::NAN,
            1 => f32::NEG_INFINITY,
            2 => 1e38,
            _ => bytes.below(1_000) as f32 / 999.0,
        };
        payload.extend(motor.to_le_bytes());
    }
    payload.push(if bytes.below(50) == 0 { 0 } else { 128 });
    let frame = framed(2, [0, 1, 1], ActuatorControls::ID, &payload);
    debug_assert!(Frame::parse(&frame).is_some());
    frame
}
