//! ArduPilot's packed plans, which MAVProxy and others of its clients read and write.
//!
//! Header: magic 0x763d, MAV_MISSION_TYPE, options, number of the first item, number of items, each 16 bits. Then the items as
//! payloads of MISSION_ITEM_INT with nothing cut off.

use vehicle::plan::{FaultCode, MissionItem, PlanFault, PlanKind};

use crate::codec::{COMPONENT, MissionItemMessage, Payload, Target};
use crate::context::Context;

/// The files' folder, and their names.
pub const FOLDER: &str = "@MISSION";
pub const NAMES: &[&str] = &["mission.dat", "fence.dat", "rally.dat"];

const MAGIC: u16 = 0x763d;
const HEADER: usize = 10;

/// The plan of a plain path.
pub fn kind_of(path: &str) -> Option<PlanKind> {
    let name = path.strip_prefix(FOLDER)?.strip_prefix('/')?;
    NAMES.iter().position(|known| *known == name).and_then(|number| PlanKind::of(number as u8))
}

/// Bytes of the largest plan that is taken.
pub fn largest(kind: PlanKind) -> usize {
    HEADER + kind.capacity() * MissionItemMessage::LENGTH
}

/// A plan, packed.
pub fn pack(context: &Context, kind: PlanKind) -> Vec<u8> {
    let vehicle = &context.vehicle;
    let count = vehicle.plans().get(kind).items().len();
    let header = [MAGIC, u16::from(kind.number()), 0, 0, count as u16];
    let mut bytes: Vec<u8> = header.into_iter().flat_map(u16::to_le_bytes).collect();
    let current = vehicle.mission_status().current;
    for (index, item) in (0..count).filter_map(|index| Some((index, vehicle.plan_item(kind, index)?))) {
        let message = MissionItemMessage {
            sequence: index as u16,
            item,
            current: u8::from(kind == PlanKind::Mission && index == current),
            kind: kind.number(),
            target: Target { system: context.system_id(), component: COMPONENT },
            int: true,
        };
        bytes.extend(message.payload());
    }
    bytes
}

/// The items of a packed plan, unchecked.
pub fn unpack(bytes: &[u8], kind: PlanKind) -> Result<Vec<MissionItem>, PlanFault> {
    let wrong = |reason: String| PlanFault::of_plan(FaultCode::Invalid, reason);
    let header = Payload::new(bytes);
    let [magic, number, options, first, count] = [0, 2, 4, 6, 8].map(|offset| header.u16(offset));
    if magic != MAGIC || number != u16::from(kind.number()) {
        return Err(wrong(format!(
            "the file begins with {magic:#06x} and type {number}, not with {MAGIC:#06x} and {}",
            kind.number()
        )));
    }
    if options != 0 || first != 0 {
        return Err(wrong(format!(
            "options {options} and first item {first}: only complete plans are supported"
        )));
    }
    let items = bytes.get(HEADER..).unwrap_or_default();
    if items.len() != usize::from(count) * MissionItemMessage::LENGTH {
        return Err(wrong(format!("{count} items in {} bytes", items.len())));
    }
    let item = |bytes: &[u8]| MissionItemMessage::of_payload(Payload::new(bytes), true).item;
    Ok(items.chunks(MissionItemMessage::LENGTH).map(item).collect())
}
