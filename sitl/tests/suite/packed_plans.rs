//! Plans as packed files by FTP.

use crate::common::ftp_client::{CREATE, Client, ERRNO, FAIL, PROTECTED, REMOVE, TERMINATE, WRITE};
use mavlink::dialects::ardupilotmega::{MISSION_ITEM_INT_DATA, MavCmd, MavFrame, MavMissionType};
use mavlink::{MavlinkVersion, MessageData};
use sitl::files::Disk;
use vehicle::plan::PlanKind;

/// Header and items, as ArduPilot packs them: those of the dialect with what it cuts off.
fn packed(kind: u16, items: &[MISSION_ITEM_INT_DATA]) -> Vec<u8> {
    let header = [0x763d, kind, 0, 0, items.len() as u16];
    let mut bytes: Vec<u8> = header.into_iter().flat_map(u16::to_le_bytes).collect();
    for item in items {
        let mut payload = [0; 255];
        item.ser(MavlinkVersion::V2, &mut payload);
        bytes.extend(&payload[..38]);
    }
    bytes
}

fn item(sequence: u16, command: MavCmd, x: i32, z: f32) -> MISSION_ITEM_INT_DATA {
    MISSION_ITEM_INT_DATA {
        param4: f32::NAN,
        x,
        y: 85_455_940,
        z,
        seq: sequence,
        command,
        target_system: 1,
        target_component: 1,
        frame: MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT,
        current: u8::from(sequence == 0),
        autocontinue: 1,
        mission_type: MavMissionType::MAV_MISSION_TYPE_MISSION,
        ..MISSION_ITEM_INT_DATA::default()
    }
}

fn mission() -> Vec<MISSION_ITEM_INT_DATA> {
    vec![
        item(0, MavCmd::MAV_CMD_NAV_TAKEOFF, 473_977_420, 5.0),
        item(1, MavCmd::MAV_CMD_NAV_WAYPOINT, 473_978_420, 7.5),
        item(2, MavCmd::MAV_CMD_NAV_LAND, 473_978_420, 0.0),
    ]
}

/// Writes a file, its second half first.
fn write(client: &mut Client, path: &str, bytes: &[u8]) -> Result<Vec<u8>, u8> {
    client.on(CREATE, path)?;
    let middle = bytes.len() / 2;
    client.ask(WRITE, middle as u32, &bytes[middle..])?;
    client.ask(WRITE, 0, &bytes[..middle])?;
    client.ask(TERMINATE, 0, &[])
}

#[test]
fn what_is_written_is_taken_when_it_is_closed_and_reads_back() {
    let mut client = Client::of(Disk::default());
    let bytes = packed(0, &mission());
    assert_eq!(write(&mut client, "@MISSION/mission.dat", &bytes), Ok(Vec::new()));
    let items = client.bench.autopilot.vehicle().plans().get(PlanKind::Mission).items();
    assert_eq!(items.iter().map(|item| item.command).collect::<Vec<_>>(), [22, 16, 21]);
    assert!((items[1].position[0] - 47.397_842).abs() < 1e-9 && items[1].position[2] == 7.5);
    assert_eq!(client.read("/@MISSION/mission.dat"), Ok(bytes));
    assert_eq!(client.read("/@MISSION/rally.dat"), Ok(packed(2, &[])));
    assert_eq!(client.on(REMOVE, "/@MISSION/mission.dat"), Err(PROTECTED));
    // An empty one clears the plan.
    assert_eq!(write(&mut client, "/@MISSION/mission.dat", &packed(0, &[])), Ok(Vec::new()));
    assert_eq!(client.bench.autopilot.vehicle().plans().get(PlanKind::Mission).items(), []);
}

#[test]
fn what_is_wrong_is_told_and_the_old_plan_stays() {
    let mut client = Client::of(Disk::default());
    let good = packed(0, &mission());
    assert_eq!(write(&mut client, "/@MISSION/mission.dat", &good), Ok(Vec::new()));
    let mut foreign = mission();
    foreign[1].command = MavCmd::MAV_CMD_PREFLIGHT_CALIBRATION;
    let mut partial = good.clone();
    partial[4] = 1;
    for (wrong, reason) in [
        (packed(0, &foreign), "Mission rejected: item 2: PREFLIGHT_CALIBRATION (241): not supported"),
        (good[..good.len() - 1].to_vec(), "3 items in 113 bytes"),
        (packed(1, &mission()), "type 1"),
        (b"QGC WPL 110".to_vec(), "begins with 0x4751"),
        (Vec::new(), "begins with 0x0000"),
        (partial, "only complete plans"),
    ] {
        assert_eq!(write(&mut client, "/@MISSION/mission.dat", &wrong), Err(FAIL), "{reason}");
        let texts = client.bench.texts();
        assert!(texts.iter().any(|text| text.contains(reason)), "{reason}: {texts:?}");
        assert_eq!(client.read("/@MISSION/mission.dat").as_ref(), Ok(&good));
        client.bench.fly(1.1);
    }
    // More than a plan holds is not kept in memory.
    client.on(CREATE, "/@MISSION/rally.dat").expect("opened");
    assert_eq!(client.ask(WRITE, 10 + 38 * 100, &[1]), Err(ERRNO));
}
