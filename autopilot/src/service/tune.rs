//! PLAY_TUNE and PLAY_TUNE_V2: tunes for a buzzer. Nobody would hear it, so the pilot is shown the tune instead.

#![allow(deprecated)] // Clients still send the older message.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::{
    MavMessage, PLAY_TUNE_DATA, PLAY_TUNE_V2_DATA, SUPPORTED_TUNES_DATA, TuneFormat,
};
use vehicle::{Severity, Vehicle};

use super::Service;
use crate::codec::{Frame, Payload};
use crate::context::Context;
use crate::envelope::Origin;
use crate::stream::Stream;

/// Of a long tune so many characters are shown.
const SHOWN: usize = 40;
/// The format that PX4 and ArduPilot play.
const FORMAT: TuneFormat = TuneFormat::TUNE_FORMAT_QBASIC1_1;

/// Takes tunes, and tells the format that they have.
#[derive(Clone, Copy, Debug)]
pub struct Tunes;

const STREAMS: &[Stream] = &[Stream::new(SUPPORTED_TUNES_DATA::ID, [0.0; 2], supported_tunes)];

impl Service for Tunes {
    fn summary(&self) -> &'static str {
        "Tunes, which are shown"
    }

    fn messages(&self) -> &'static [u32] {
        &[PLAY_TUNE_DATA::ID, PLAY_TUNE_V2_DATA::ID]
    }

    fn streams(&self) -> &'static [Stream] {
        STREAMS
    }

    fn receive(&mut self, context: &mut Context, _origin: &Origin, frame: &Frame) {
        let payload = frame.payload();
        let tune = if frame.message_id() == PLAY_TUNE_DATA::ID {
            text::<30>(&payload, 2) + &text::<200>(&payload, 32)
        } else if payload.u32(0) == FORMAT as u32 {
            text::<248>(&payload, 6)
        } else {
            let reason = "Tune rejected: only format 1 (QBasic 1.1) is known; see SUPPORTED_TUNES";
            context.say(Severity::Warning, reason);
            return;
        };
        let is_long = tune.chars().count() > SHOWN;
        let shown: String = tune.chars().take(SHOWN).collect();
        context.say(Severity::Info, &format!("Tune: {shown}{}", if is_long { "..." } else { "" }));
    }
}

/// The text at a place of the payload, up to its end or its first zero.
fn text<const N: usize>(payload: &Payload<'_>, offset: usize) -> String {
    let bytes: [u8; N] = payload.bytes(offset);
    bytes.iter().take_while(|byte| **byte != 0).map(|byte| char::from(*byte)).collect()
}

fn supported_tunes(_vehicle: &Vehicle) -> MavMessage {
    MavMessage::SUPPORTED_TUNES(SUPPORTED_TUNES_DATA { format: FORMAT, ..SUPPORTED_TUNES_DATA::default() })
}
