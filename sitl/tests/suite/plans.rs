//! The mission protocol of missions, fences and rally points.

#![allow(deprecated)] // Clients still use what the dialect calls deprecated.

use crate::common;
use crate::common::plan_client::{ack_of, count_message, item_message, items, request_of, result, waypoint};
use crate::common::{Bench, GROUND_STATION};
use autopilot::codec::{Frame, Message, Version};
use autopilot::envelope::{Origin, PeerId};
use mavlink::dialects::ardupilotmega::*;
use vehicle::identity::Identity;
use vehicle::plan::{MissionItem, PlanKind};

const ACCEPTED: u8 = 0;

/// A client on a good channel.
struct Client {
    bench: Bench,
}

impl Client {
    fn new() -> Self {
        Self::of(Identity::Px4)
    }

    fn of(identity: Identity) -> Self {
        let mut bench = Bench::new(identity);
        bench.heard.clear();
        Self { bench }
    }

    fn send(&mut self, message: impl Into<Message>) -> Vec<Message> {
        let frame = self.bench.frame(message);
        self.bench.receive(&frame);
        std::mem::take(&mut self.bench.heard)
    }

    /// Uploads as a client does, and returns what is heard at the end.
    fn upload(&mut self, kind: PlanKind, items: &[MissionItem]) -> Vec<Message> {
        common::plan_client::upload(&mut self.bench, kind, items)
    }

    fn take(&mut self, kind: PlanKind, items: &[MissionItem]) {
        let heard = self.upload(kind, items);
        assert_eq!(result(&heard), Some(ACCEPTED), "{heard:?}");
    }

    fn plan(&self, kind: PlanKind) -> &[MissionItem] {
        self.bench.autopilot.vehicle().plans().get(kind).items()
    }
}

fn texts(heard: Vec<Message>) -> String {
    let mut bench = Bench::new(Identity::Px4);
    bench.heard = heard;
    bench.texts().join("\n")
}

#[test]
fn each_fault_has_its_result_and_names_its_item_and_the_old_plan_stays() {
    let mut client = Client::new();
    let old = items(PlanKind::Mission, 3);
    client.take(PlanKind::Mission, &old);
    let good = waypoint(1.0, 10.0);
    let with = |command: u16, parameters: [f64; 4]| MissionItem { command, parameters, ..good };
    let nan = f64::NAN;
    let cases: Vec<(MissionItem, MavMissionResult, &str)> = vec![
        (with(30, [0.0; 4]), MavMissionResult::MAV_MISSION_UNSUPPORTED, "NAV_CONTINUE_AND_CHANGE_ALT (30)"),
        (with(60_000, [0.0; 4]), MavMissionResult::MAV_MISSION_UNSUPPORTED, "command 60000"),
        (with(5100, [0.0; 4]), MavMissionResult::MAV_MISSION_UNSUPPORTED, "NAV_RALLY_POINT (5100)"),
        (MissionItem { frame: 8, ..good }, MavMissionResult::MAV_MISSION_UNSUPPORTED_FRAME, "frame 8"),
        (MissionItem { frame: 200, ..good }, MavMissionResult::MAV_MISSION_UNSUPPORTED_FRAME, "frame 200"),
        (with(16, [-1.0, 0.0, 0.0, nan]), MavMissionResult::MAV_MISSION_INVALID_PARAM1, "hold time = -1"),
        (with(16, [0.0, 5e3, 0.0, nan]), MavMissionResult::MAV_MISSION_INVALID_PARAM2, "radius = 5000"),
        (with(18, [nan; 4]), MavMissionResult::MAV_MISSION_INVALID_PARAM1, "parameter 1 is required"),
        (with(115, [0.0, 0.0, 7.0, 0.0]), MavMissionResult::MAV_MISSION_INVALID_PARAM3, "direction = 7"),
        (with(16, [0.0, 0.0, 0.0, 1e4]), MavMissionResult::MAV_MISSION_INVALID_PARAM4, "yaw = 10000"),
        (
            MissionItem { position: [91.0, 8.0, 10.0], ..good },
            MavMissionResult::MAV_MISSION_INVALID_PARAM5_X,
            "latitude = 91",
        ),
        (
            MissionItem { position: [47.0, 181.0, 10.0], ..good },
            MavMissionResult::MAV_MISSION_INVALID_PARAM6_Y,
            "longitude = 181",
        ),
        (
            with(177, [9.0, 1.0, 0.0, 0.0]),
            MavMissionResult::MAV_MISSION_INVALID_PARAM1,
            "no item has sequence number 9",
        ),
        (with(178, [1.0, 0.0, 0.0, 0.0]), MavMissionResult::MAV_MISSION_INVALID_PARAM2, "speed = 0"),
        (with(93, [-0.5, 0.0, 0.0, 0.0]), MavMissionResult::MAV_MISSION_INVALID_PARAM1, "delay = -0.5"),
        (with(93, [-1.0; 4]), MavMissionResult::MAV_MISSION_INVALID_PARAM2, "needs an hour"),
        (with(93, [-1.0, 24.0, 0.0, 0.0]), MavMissionResult::MAV_MISSION_INVALID_PARAM2, "hour = 24"),
        (
            with(93, [-1.0, 1.0, 0.5, 0.0]),
            MavMissionResult::MAV_MISSION_INVALID_PARAM3,
            "= 0.5 must be a whole",
        ),
    ];
    for (wrong, expected, line) in cases {
        let heard = client.upload(PlanKind::Mission, &[good, wrong, good]);
        assert_eq!(result(&heard), Some(expected as u8), "{wrong:?}");
        let text = texts(heard);
        assert!(text.contains("item 2") && text.contains(line), "{text}");
        assert_eq!(client.plan(PlanKind::Mission), old);
        client.bench.fly(1.1);
    }
    for kind in [PlanKind::Fence, PlanKind::Rally] {
        let heard = client.upload(kind, &[good]);
        assert_eq!(result(&heard), Some(MavMissionResult::MAV_MISSION_UNSUPPORTED as u8));
    }
    let heard = client.send(count_message(PlanKind::Mission, 2001));
    assert_eq!(result(&heard), Some(MavMissionResult::MAV_MISSION_NO_SPACE as u8));
    assert_eq!(client.plan(PlanKind::Mission), old);
}

/// A waypoint of PX4 keeps its height then.
#[test]
fn a_mission_of_ardupilot_needs_altitudes() {
    let mut client = Client::of(Identity::ArduPilot);
    let good = waypoint(1.0, 10.0);
    let [latitude, longitude, _] = good.position;
    let open = MissionItem { position: [latitude, longitude, f64::NAN], ..good };
    let heard = client.upload(PlanKind::Mission, &[good, good, open]);
    assert_eq!(result(&heard), Some(MavMissionResult::MAV_MISSION_INVALID_PARAM7 as u8));
    let text = texts(heard);
    assert!(text.contains("item 2") && text.contains("an altitude is required"), "{text}");
}

#[test]
fn items_out_of_order_and_copies_do_no_harm() {
    let mut client = Client::new();
    let plan = items(PlanKind::Mission, 3);
    let send = |client: &mut Client, sequence: usize| {
        client.send(item_message(PlanKind::Mission, sequence, plan[sequence], true))
    };
    let heard = client.send(count_message(PlanKind::Mission, 3));
    assert_eq!(heard.iter().find_map(request_of), Some(0));
    let heard = send(&mut client, 1);
    assert_eq!(heard.iter().find_map(request_of), Some(0), "the one that is missing is asked for");
    send(&mut client, 0);
    assert!(send(&mut client, 0).is_empty(), "a copy needs no answer");
    send(&mut client, 1);
    let heard = send(&mut client, 2);
    assert_eq!(result(&heard), Some(ACCEPTED));
    // The answer was lost: the last item comes again.
    let again = send(&mut client, 2);
    assert_eq!(result(&again), Some(ACCEPTED));
    assert!(send(&mut client, 1).is_empty());
    assert_eq!(client.plan(PlanKind::Mission), plan);
    // A wrong type ends an upload.
    client.send(count_message(PlanKind::Mission, 1));
    let heard = client.send(item_message(PlanKind::Fence, 0, plan[0], true));
    assert_eq!(result(&heard), Some(MavMissionResult::MAV_MISSION_INVALID as u8));
    // An item that nobody has asked for.
    let heard = client.send(item_message(PlanKind::Rally, 0, plan[0], true));
    assert_eq!(result(&heard), Some(MavMissionResult::MAV_MISSION_ERROR as u8));
    assert_eq!(client.plan(PlanKind::Mission), plan);
}

#[test]
fn a_silent_client_is_asked_again_and_then_given_up() {
    let mut client = Client::new();
    client.take(PlanKind::Mission, &items(PlanKind::Mission, 2));
    client.send(count_message(PlanKind::Mission, 4));
    client.bench.fly(0.3);
    let asked: Vec<u16> = client.bench.heard.iter().filter_map(request_of).collect();
    assert_eq!(asked, [0]);
    client.bench.fly(6.0);
    let heard = std::mem::take(&mut client.bench.heard);
    let older = heard.iter().any(|m| matches!(m, Message::Typed(MavMessage::MISSION_REQUEST(_))));
    assert!(older, "the older request is tried, too");
    assert_eq!(result(&heard), Some(MavMissionResult::MAV_MISSION_OPERATION_CANCELLED as u8));
    assert_eq!(client.plan(PlanKind::Mission).len(), 2);
    client.bench.fly(5.0);
    assert!(!client.bench.heard.iter().any(|message| request_of(message).is_some()));
}

/// An upload that is begun again and again, that asks for what is not its turn, or that creeps, gives way to another client.
#[test]
fn an_upload_that_does_not_get_on_gives_way() {
    let plan = items(PlanKind::Mission, 40);
    let item = |index: usize| item_message(PlanKind::Mission, index, plan[index], true);
    let other = Origin { peer: PeerId { link: 0, number: 2 }, system: 254, component: 190 };
    for (manner, gives_way) in
        [("begins again", true), ("hurries", true), ("creeps", true), ("gets on", false)]
    {
        let mut client = Client::new();
        client.send(count_message(PlanKind::Mission, 40));
        // Five times a second for 16 s.
        for turn in 0..80 {
            match manner {
                "begins again" => drop(client.send(count_message(PlanKind::Mission, 40))),
                "hurries" => drop(client.send(item(20))),
                "creeps" if turn % 20 == 0 => drop(client.send(item(turn / 20))),
                "gets on" if turn % 3 == 0 => drop(client.send(item(turn / 3))),
                _ => {}
            }
            client.bench.fly(0.2);
        }
        client.bench.heard.clear();
        let begin = Frame::encode(&count_message(PlanKind::Mission, 1).into(), Version::Two, 1, (254, 190));
        client.bench.autopilot.receive(&other, &begin.expect("a frame"));
        client.bench.listen();
        let begun = client.bench.heard.iter().any(|message| request_of(message) == Some(0));
        assert_eq!(begun, gives_way, "{manner}");
        let cancelled = MavMissionResult::MAV_MISSION_OPERATION_CANCELLED as u8;
        let denied = MavMissionResult::MAV_MISSION_DENIED as u8;
        assert_eq!(result(&client.bench.heard), Some(if gives_way { cancelled } else { denied }), "{manner}");
    }
}

#[test]
fn a_client_can_cancel_and_another_waits_for_its_turn() {
    let mut client = Client::new();
    let plan = items(PlanKind::Mission, 2);
    client.send(count_message(PlanKind::Mission, 2));
    let other = Origin { peer: PeerId { link: 0, number: 2 }, system: 254, component: 190 };
    let from_other = |client: &mut Client, message: Message| {
        let frame = Frame::encode(&message, Version::Two, 1, (254, 190)).unwrap();
        client.bench.autopilot.receive(&other, &frame);
        client.bench.listen();
        std::mem::take(&mut client.bench.heard)
    };
    let denied = Some(MavMissionResult::MAV_MISSION_DENIED as u8);
    let heard = from_other(&mut client, count_message(PlanKind::Fence, 2).into());
    assert_eq!(result(&heard), denied);
    let heard = from_other(&mut client, item_message(PlanKind::Mission, 0, plan[0], true));
    assert_eq!(result(&heard), denied);
    let clear = MavMessage::MISSION_CLEAR_ALL(MISSION_CLEAR_ALL_DATA {
        target_system: 1,
        target_component: 1,
        mission_type: MavMissionType::MAV_MISSION_TYPE_ALL,
    });
    assert_eq!(result(&from_other(&mut client, clear.clone().into())), denied);
    // The first one goes on undisturbed, and gives up.
    let heard = client.send(item_message(PlanKind::Mission, 0, plan[0], true));
    assert_eq!(heard.iter().find_map(request_of), Some(1));
    client.send(MavMessage::MISSION_ACK(MISSION_ACK_DATA {
        target_system: 1,
        target_component: 1,
        mavtype: MavMissionResult::MAV_MISSION_OPERATION_CANCELLED,
        mission_type: MavMissionType::MAV_MISSION_TYPE_MISSION,
        opaque_id: 0,
    }));
    client.bench.fly(2.0);
    assert!(!client.bench.heard.iter().any(|message| request_of(message).is_some()), "it is over");
    let heard = from_other(&mut client, count_message(PlanKind::Rally, 0).into());
    assert_eq!(result(&heard), Some(ACCEPTED));
    assert!(client.plan(PlanKind::Mission).is_empty());
    // All kinds are cleared at once.
    for kind in PlanKind::ALL {
        client.take(kind, &items(kind, 3));
    }
    assert_eq!(result(&client.send(clear)), Some(ACCEPTED));
    assert!(PlanKind::ALL.iter().all(|kind| client.plan(*kind).is_empty()));
    // A count of zero clears as well.
    client.take(PlanKind::Mission, &plan);
    client.take(PlanKind::Mission, &[]);
    assert!(client.plan(PlanKind::Mission).is_empty());
}

#[test]
fn a_part_is_written_and_the_rest_stays() {
    let mut client = Client::new();
    let mut plan = items(PlanKind::Mission, 5);
    client.take(PlanKind::Mission, &plan);
    let write = |client: &mut Client, start: i16, end: i16, new: &[MissionItem]| {
        let mut heard =
            client.send(MavMessage::MISSION_WRITE_PARTIAL_LIST(MISSION_WRITE_PARTIAL_LIST_DATA {
                start_index: start,
                end_index: end,
                target_system: 1,
                target_component: 1,
                mission_type: MavMissionType::MAV_MISSION_TYPE_MISSION,
            }));
        while let Some(sequence) = heard.iter().find_map(request_of) {
            let item = new[usize::from(sequence) - start as usize];
            heard = client.send(item_message(PlanKind::Mission, sequence.into(), item, true));
        }
        result(&heard)
    };
    let new = [waypoint(50.0, 30.0), waypoint(60.0, 31.0)];
    assert_eq!(write(&mut client, 1, 2, &new), Some(ACCEPTED));
    plan[1..=2].copy_from_slice(&new);
    assert_eq!(client.plan(PlanKind::Mission), plan);
    // Behind the end it grows.
    assert_eq!(write(&mut client, 5, 6, &new), Some(ACCEPTED));
    plan.extend(new);
    assert_eq!(client.plan(PlanKind::Mission), plan);
    let wrong = Some(MavMissionResult::MAV_MISSION_INVALID_SEQUENCE as u8);
    for (start, end) in [(8, 9), (3, 2), (-1, 2)] {
        assert_eq!(write(&mut client, start, end, &new), wrong, "{start} to {end}");
    }
    assert_eq!(client.plan(PlanKind::Mission), plan);
}

/// In ArduPilot's convention the first item is home.
#[test]
fn ardupilot_has_home_in_front() {
    let mut client = Client::of(Identity::ArduPilot);
    let mut plan = items(PlanKind::Mission, 2);
    plan.insert(0, MissionItem { command: 16, frame: 0, position: [0.0; 3], ..plan[0] });
    client.take(PlanKind::Mission, &plan);
    let mut request = |seq| {
        let heard = client.send(MavMessage::MISSION_REQUEST_INT(MISSION_REQUEST_INT_DATA {
            seq,
            target_system: 1,
            target_component: 1,
            mission_type: MavMissionType::MAV_MISSION_TYPE_MISSION,
        }));
        heard.into_iter().find_map(|message| match message {
            Message::MissionItem(item) => Some(item),
            message => ack_of(&message).map(|ack| panic!("{ack:?}")),
        })
    };
    let home = request(0).expect("home");
    assert!((home.item.position[0] - 47.397_742).abs() < 1e-6 && home.item.position[2] == 488.0, "{home:?}");
    assert_eq!(request(1).expect("an item").item, plan[1]);
    assert_eq!((home.target.system, home.target.component), GROUND_STATION);
}

/// PX4 and ArduPilot take places wherever they are, and below home; a mission that cannot be flown is not begun.
#[test]
fn places_are_taken_wherever_they_are_and_refused_when_they_are_to_be_flown() {
    let far = waypoint(200_000.0, 10.0);
    for (items, why) in [
        ([waypoint(1.0, 10.0), far], "200 km away"),
        ([waypoint(1.0, 10.0), waypoint(2.0, -3.0)], "3.0 m below"),
    ] {
        let mut client = Client::new();
        let heard = client.upload(PlanKind::Mission, &items);
        assert_eq!(result(&heard), Some(ACCEPTED), "{heard:?}");
        assert!(texts(heard).contains(why), "{why}");
        assert_eq!(client.plan(PlanKind::Mission), items);
        client.bench.fly(1.1);
        client.bench.heard.clear();
        assert_eq!(client.bench.set_mode(vehicle::Mode::Mission), 2);
        assert!(client.bench.texts().iter().any(|text| text.contains(why)), "{:?}", client.bench.texts());
    }
    let mut client = Client::new();
    client.take(PlanKind::Rally, &[MissionItem { command: 5100, ..far }]);
    let around = MissionItem { command: 5004, parameters: [20.0, 0.0, 0.0, 0.0], ..far };
    client.take(PlanKind::Fence, &[around]);
    client.bench.arm();
}

/// ArduPilot asks by MISSION_REQUEST whatever it is answered; its item 0 is home, also of an empty mission.
#[test]
fn ardupilot_asks_by_the_older_request_and_always_has_home() {
    let mut client = Client::of(Identity::ArduPilot);
    let home = client.send(MavMessage::MISSION_REQUEST(MISSION_REQUEST_DATA {
        seq: 0,
        target_system: 1,
        target_component: 1,
        ..MISSION_REQUEST_DATA::default()
    }));
    let item = home.iter().find_map(|message| match message {
        Message::MissionItem(item) => Some(*item),
        _ => None,
    });
    let item = item.expect("home").item;
    assert_eq!(item.command, 16);
    assert!((item.position[0] - 47.397_742).abs() < 1e-4 && item.position[2] > 400.0, "{item:?}");
    for (identity, older) in [(Identity::ArduPilot, true), (Identity::Px4, false)] {
        let mut client = Client::of(identity);
        let mut heard = client.send(count_message(PlanKind::Mission, 3));
        for sequence in 0..3 {
            let asked = heard.iter().find_map(|message| match message {
                Message::Typed(MavMessage::MISSION_REQUEST(request)) => Some((request.seq, true)),
                Message::Typed(MavMessage::MISSION_REQUEST_INT(request)) => Some((request.seq, false)),
                _ => None,
            });
            assert_eq!(asked, Some((sequence, older)), "{identity:?}");
            let item = item_message(PlanKind::Mission, sequence.into(), waypoint(1.0, 10.0), true);
            heard = client.send(item);
        }
        assert_eq!(result(&heard), Some(ACCEPTED));
    }
}
