//! Plans in files: QGroundControl's `.plan` and the text of QGC WPL 110.

mod json;
mod text;

use super::{MissionItem, Plan, PlanFileFault, PlanKind, Plans, Site, check};

/// The items of a file, before they are checked.
#[derive(Clone, Debug, PartialEq, Default)]
struct Content {
    /// Where the mission was planned from, if the file says so: in ArduPilot's convention its first item.
    home: Option<[f64; 3]>,
    /// Each item with the place in the file that an error names.
    mission: Vec<(MissionItem, String)>,
    fence: Vec<(MissionItem, String)>,
    rally: Vec<(MissionItem, String)>,
}

/// Reads the plans in a file's text for a vehicle at a site.
///
/// # Errors
/// [`PlanFileFault`] that names the line or the item, the value and its range.
pub fn parse(text: &str, site: &Site) -> Result<Plans, PlanFileFault> {
    let mut content =
        if text.trim_start().starts_with('{') { json::parse(text)? } else { text::parse(text)? };
    if site.identity.is_ardupilot() && !content.mission.is_empty() {
        put_home_in_front(&mut content);
    }
    let mut plans = Plans::default();
    let kinds = [
        (PlanKind::Mission, content.mission),
        (PlanKind::Fence, content.fence),
        (PlanKind::Rally, content.rally),
    ];
    for (kind, named) in kinds {
        let items: Vec<MissionItem> = named.iter().map(|(item, _)| *item).collect();
        check::plan(kind, &items, site).map_err(|fault| {
            let place = fault.item.and_then(|item| named.get(item)).map(|(_, place)| place.clone());
            PlanFileFault::of_item(fault, place.as_deref())
        })?;
        plans.set(kind, Plan::new(items));
    }
    Ok(plans)
}

/// Jumps count home then.
fn put_home_in_front(content: &mut Content) {
    let items = content.mission.iter_mut();
    items.filter_map(|(item, _)| item.jump_target_mut()).for_each(|target| *target += 1.0);
    let home = MissionItem::home(content.home.unwrap_or([0.0; 3]));
    content.mission.insert(0, (home, "home".to_owned()));
}
