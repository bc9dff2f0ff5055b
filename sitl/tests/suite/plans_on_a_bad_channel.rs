//! The mission protocol on a channel that loses messages.

#![allow(deprecated)] // Clients still use what the dialect calls deprecated.

use crate::common::channel::Lossy;
use crate::common::plan_client::{ack_of, count_message, item_message, items, mission_type, request_of};
use autopilot::codec::Message;
use mavlink::dialects::ardupilotmega::*;
use vehicle::plan::{MissionItem, PlanKind};

const ACCEPTED: u8 = 0;

/// An upload by a client with the retries that the protocol recommends.
fn upload(lossy: &mut Lossy, kind: PlanKind, items: &[MissionItem], int: bool) -> MISSION_ACK_DATA {
    let mut last = Message::from(count_message(kind, items.len()));
    lossy.send(last.clone());
    let mut silent_ms = 0;
    for _ in 0..120_000 {
        silent_ms += 1;
        for message in lossy.step() {
            if let Some(sequence) = request_of(&message) {
                last = item_message(kind, sequence.into(), items[usize::from(sequence)], int);
                lossy.send(last.clone());
                silent_ms = 0;
            }
            if let Some(ack) = ack_of(&message) {
                assert_eq!(ack.mission_type, mission_type(kind));
                return ack;
            }
        }
        if silent_ms > 1500 {
            lossy.send(last.clone());
            silent_ms = 0;
        }
    }
    panic!("the upload does not end");
}

/// A download by such a client.
fn download(lossy: &mut Lossy, kind: PlanKind, int: bool) -> (Vec<MissionItem>, u32) {
    let list = MavMessage::MISSION_REQUEST_LIST(MISSION_REQUEST_LIST_DATA {
        target_system: 1,
        target_component: 1,
        mission_type: mission_type(kind),
    });
    let (mut total, mut items): (Option<(u16, u32)>, Vec<MissionItem>) = (None, Vec::new());
    let mut last = list;
    lossy.send(last.clone());
    let mut silent_ms = 0;
    for _ in 0..120_000 {
        silent_ms += 1;
        let mut next = silent_ms > 250;
        for message in lossy.step() {
            match message {
                Message::Typed(MavMessage::MISSION_COUNT(count)) if total.is_none() => {
                    assert_eq!(count.mission_type, mission_type(kind));
                    total = Some((count.count, count.opaque_id));
                    next = true;
                }
                Message::MissionItem(item) if usize::from(item.sequence) == items.len() => {
                    assert_eq!((item.kind, item.int), (kind.number(), int));
                    items.push(item.item);
                    next = true;
                }
                _ => {}
            }
        }
        if let Some((count, id)) = total {
            if items.len() == usize::from(count) {
                return (items, id);
            }
            let (seq, target_system, target_component) = (items.len() as u16, 1, 1);
            let mission_type = mission_type(kind);
            last = if int {
                MavMessage::MISSION_REQUEST_INT(MISSION_REQUEST_INT_DATA {
                    seq,
                    target_system,
                    target_component,
                    mission_type,
                })
            } else {
                MavMessage::MISSION_REQUEST(MISSION_REQUEST_DATA {
                    seq,
                    target_system,
                    target_component,
                    mission_type,
                })
            };
        }
        if next {
            lossy.send(last.clone());
            silent_ms = 0;
        }
    }
    panic!("the download does not end");
}

/// All kinds, over either message, arrive as they were sent, and the ids are told.
#[test]
fn plans_cross_a_bad_channel() {
    for seed in 1..=8 {
        let mut lossy = Lossy::new(seed);
        for kind in PlanKind::ALL {
            let int = seed % 4 > 0;
            let mut sent = items(kind, 40);
            let ack = upload(&mut lossy, kind, &sent, int);
            assert_eq!(ack.mavtype as u8, ACCEPTED, "seed {seed}, {kind:?}");
            let (got, id) = download(&mut lossy, kind, int);
            if !int {
                // Floats are what they are.
                for item in &mut sent {
                    item.position = item.position.map(|value| f64::from(value as f32));
                }
            }
            assert_eq!(got, sent, "seed {seed}, {kind:?}");
            assert_eq!(id, ack.opaque_id);
            assert_ne!(id, 0);
        }
        for kind in PlanKind::ALL {
            let kept = lossy.bench.autopilot.vehicle().plans().get(kind).items().len();
            assert_eq!(kept, 40, "a kind has disturbed another");
        }
        assert!(lossy.up.lost + lossy.down.lost > 10, "the channel was a good one");
    }
}
