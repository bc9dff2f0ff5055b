//! QGC WPL 110: a line per item, its fields between tabs or blanks.
//!
//! ```text
//! QGC WPL 110
//! 0  1  0  16  0  0  0  0  47.397742  8.545594  488  1
//! number, current, frame, command, four parameters, latitude, longitude, altitude, autocontinue
//! ```

use super::super::{MissionItem, command, frame};
use super::Content;

const HEADER: [&str; 3] = ["QGC", "WPL", "110"];
const FIELDS: usize = 12;

/// Reads the items. A first one that is a waypoint above sea level is home, as ground stations write it; jumps count it.
pub fn parse(text: &str) -> Result<Content, String> {
    let mut lines = (1_usize..).zip(text.lines()).filter(|(_, line)| {
        let line = line.trim();
        !line.is_empty() && !line.starts_with('#')
    });
    let header = lines.next().map(|(_, line)| line.split_whitespace().collect::<Vec<_>>());
    if header.as_deref() != Some(&HEADER) {
        return Err("is neither a .plan (JSON) nor a text that begins with `QGC WPL 110`".to_owned());
    }
    let mut content = Content::default();
    for (index, (number, line)) in lines.enumerate() {
        let item = item(index, line).map_err(|reason| format!("line {number}: {reason}"))?;
        content.mission.push((item, format!("line {number}")));
    }
    let first = content.mission.first().map(|(item, _)| *item);
    if let Some(home) =
        first.filter(|item| item.frame == frame::GLOBAL && item.command == command::NAV_WAYPOINT)
    {
        content.mission.remove(0);
        content.home = Some(home.position);
        without_home(&mut content)?;
    }
    Ok(content)
}

fn without_home(content: &mut Content) -> Result<(), String> {
    for (item, place) in &mut content.mission {
        let Some(target) = item.jump_target_mut() else { continue };
        if *target < 1.0 {
            return Err(format!("{place}: a jump cannot go to item {target}, which is home"));
        }
        *target -= 1.0;
    }
    Ok(())
}

fn item(index: usize, line: &str) -> Result<MissionItem, String> {
    let fields: Vec<&str> = line.split_whitespace().collect();
    if fields.len() != FIELDS {
        return Err(format!("found {} fields, expected {FIELDS}", fields.len()));
    }
    let number = |field: usize| -> Result<f64, String> {
        let text = fields.get(field).copied().unwrap_or_default();
        text.parse().map_err(|_| format!("field {} `{text}` is not a number", field + 1))
    };
    let whole = |field: usize, name: &str, most: f64| -> Result<f64, String> {
        let value = number(field)?;
        if (0.0..=most).contains(&value) && value.fract() == 0.0 {
            Ok(value)
        } else {
            Err(format!("{name} = {value} must be a whole number from 0 to {most}"))
        }
    };
    let told = whole(0, "number", f64::from(u16::MAX))?;
    if told != index as f64 {
        return Err(format!("found item {told}, expected item {index}"));
    }
    Ok(MissionItem {
        frame: whole(2, "frame", f64::from(u8::MAX))? as u8,
        command: whole(3, "command", f64::from(u16::MAX))? as u16,
        parameters: [number(4)?, number(5)?, number(6)?, number(7)?],
        position: [number(8)?, number(9)?, number(10)?],
        autocontinue: whole(11, "autocontinue", 1.0)? == 1.0,
    })
}
