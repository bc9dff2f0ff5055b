//! A plan as a text that ground stations read, and `--mission` does: QGC WPL 110.

use std::fmt::Write as _;

use vehicle::Vehicle;
use vehicle::plan::{MissionItem, PlanKind};

/// The text. The first line of a mission is home, as ground stations write it, and jumps count it.
pub fn render(vehicle: &Vehicle, kind: PlanKind) -> Vec<u8> {
    let count = vehicle.plans().get(kind).items().len();
    let mut items: Vec<MissionItem> = (0..count).filter_map(|index| vehicle.plan_item(kind, index)).collect();
    if kind == PlanKind::Mission && !vehicle.identity().is_ardupilot() && !items.is_empty() {
        items.iter_mut().filter_map(MissionItem::jump_target_mut).for_each(|target| *target += 1.0);
        items.insert(0, vehicle.home_item());
    }
    let mut text = String::from("QGC WPL 110\n");
    for (index, item) in items.iter().enumerate() {
        let current = u8::from(index == 0);
        // Writing into a string cannot fail.
        let _infallible = write!(text, "{index}\t{current}\t{}\t{}", item.frame, item.command);
        for value in item.parameters.iter().chain(&item.position) {
            let _infallible = write!(text, "\t{value}");
        }
        let _infallible = writeln!(text, "\t{}", u8::from(item.autocontinue));
    }
    text.into_bytes()
}
