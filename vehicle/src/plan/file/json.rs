//! QGroundControl's `.plan`: mission of simple items, surveys and corridor scans, fence and rally points.

use serde::Deserialize;
use serde_json::Value;

use super::super::{MissionItem, command, frame};
use super::Content;

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct File {
    file_type: String,
    mission: Option<Mission>,
    geo_fence: Option<Fence>,
    rally_points: Option<Rally>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Mission {
    version: u32,
    #[serde(default)]
    items: Vec<Value>,
    planned_home_position: Option<[f64; 3]>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Simple {
    command: u16,
    frame: u8,
    /// `null` is "not given".
    params: [Option<f64>; 7],
    #[serde(default = "yes")]
    auto_continue: bool,
    do_jump_id: Option<u32>,
}

fn yes() -> bool {
    true
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Fence {
    #[serde(default)]
    circles: Vec<Circle>,
    #[serde(default)]
    polygons: Vec<Polygon>,
    breach_return: Option<[f64; 3]>,
}

#[derive(Deserialize)]
struct Circle {
    circle: Round,
    inclusion: bool,
}

#[derive(Deserialize)]
struct Round {
    center: [f64; 2],
    radius: f64,
}

#[derive(Deserialize)]
struct Polygon {
    polygon: Vec<[f64; 2]>,
    inclusion: bool,
}

#[derive(Deserialize)]
struct Rally {
    #[serde(default)]
    points: Vec<[f64; 3]>,
}

/// Version of the missions that are understood.
const MISSION_VERSION: u32 = 2;

/// Reads the items.
pub fn parse(text: &str) -> Result<Content, String> {
    let file: File =
        serde_json::from_str(text).map_err(|error| format!("not a valid .plan file: {error}"))?;
    if file.file_type != "Plan" {
        return Err(format!("fileType is `{}`; only `Plan` is supported", file.file_type));
    }
    let mut content = Content::default();
    if let Some(mission) = &file.mission {
        content.home = mission.planned_home_position;
        content.mission = items(mission)?;
    }
    content.fence = file.geo_fence.map(|fence| fence_items(&fence)).unwrap_or_default();
    let points = file.rally_points.map(|rally| rally.points).unwrap_or_default();
    let rally = |(index, point): (usize, [f64; 3])| {
        let item = place(command::NAV_RALLY_POINT, 0.0, frame::GLOBAL_RELATIVE, point);
        (item, format!("rally point {}", index + 1))
    };
    content.rally = points.into_iter().enumerate().map(rally).collect();
    Ok(content)
}

fn items(mission: &Mission) -> Result<Vec<(MissionItem, String)>, String> {
    if mission.version != MISSION_VERSION {
        return Err(format!(
            "mission version {} is not supported; expected {MISSION_VERSION}",
            mission.version
        ));
    }
    let mut items = Vec::new();
    let mut jump_ids = Vec::new();
    for (value, place) in mission.items.iter().enumerate().flat_map(|(index, value)| parts(index, value)) {
        let simple = simple(value).map_err(|reason| format!("{place}: {reason}"))?;
        let [one, two, three, four, x, y, z] = simple.params.map(|value| value.unwrap_or(f64::NAN));
        jump_ids.push(simple.do_jump_id);
        let item = MissionItem {
            frame: simple.frame,
            command: simple.command,
            parameters: [one, two, three, four],
            position: [x, y, z],
            autocontinue: simple.auto_continue,
        };
        items.push((item, place));
    }
    // In the file a jump names the id of its target.
    for (item, place) in &mut items {
        let Some(target) = item.jump_target_mut() else { continue };
        let index = jump_ids.iter().position(|id| id.map(f64::from) == Some(*target));
        *target = index.ok_or_else(|| format!("{place}: no item has doJumpId {target}"))? as f64;
    }
    Ok(items)
}

/// The simple items of an item, with their places: a survey or a corridor scan has those that the ground station made of it.
fn parts(index: usize, value: &Value) -> Vec<(&Value, String)> {
    let place = format!("item {}", index + 1);
    match value.pointer("/TransectStyleComplexItem/Items").and_then(Value::as_array) {
        Some(parts) => {
            let part = |(number, part): (usize, _)| (part, format!("{place}, part {}", number + 1));
            parts.iter().enumerate().map(part).collect()
        }
        None => vec![(value, place)],
    }
}

fn simple(value: &Value) -> Result<Simple, String> {
    let text = |name: &str| value.get(name).and_then(Value::as_str);
    match text("type") {
        Some("SimpleItem") => {}
        Some("ComplexItem") => {
            let kind = text("complexItemType").unwrap_or("unknown");
            return Err(format!(
                "complex item `{kind}` is not supported; upload the plan from the ground station, which expands it"
            ));
        }
        other => {
            return Err(format!(
                "type `{}` is not supported; expected `SimpleItem`",
                other.unwrap_or("none")
            ));
        }
    }
    Simple::deserialize(value).map_err(|error| error.to_string())
}

fn fence_items(fence: &Fence) -> Vec<(MissionItem, String)> {
    let mut items = Vec::new();
    for (index, polygon) in fence.polygons.iter().enumerate() {
        let command = if polygon.inclusion {
            command::NAV_FENCE_POLYGON_VERTEX_INCLUSION
        } else {
            command::NAV_FENCE_POLYGON_VERTEX_EXCLUSION
        };
        let count = polygon.polygon.len() as f64;
        for [latitude, longitude] in &polygon.polygon {
            let item = place(command, count, frame::GLOBAL, [*latitude, *longitude, 0.0]);
            items.push((item, format!("fence polygon {}", index + 1)));
        }
    }
    for (index, circle) in fence.circles.iter().enumerate() {
        let command = if circle.inclusion {
            command::NAV_FENCE_CIRCLE_INCLUSION
        } else {
            command::NAV_FENCE_CIRCLE_EXCLUSION
        };
        let [latitude, longitude] = circle.circle.center;
        let item = place(command, circle.circle.radius, frame::GLOBAL, [latitude, longitude, 0.0]);
        items.push((item, format!("fence circle {}", index + 1)));
    }
    if let Some(point) = fence.breach_return {
        let item = place(command::NAV_FENCE_RETURN_POINT, 0.0, frame::GLOBAL_RELATIVE, point);
        items.push((item, "breachReturn".to_owned()));
    }
    items
}

fn place(command: u16, parameter: f64, frame: u8, position: [f64; 3]) -> MissionItem {
    MissionItem { frame, command, parameters: [parameter, 0.0, 0.0, 0.0], position, autocontinue: true }
}
