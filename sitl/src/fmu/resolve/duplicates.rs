//! Variables that stand for two signals: a slip of the hand in a map.

use super::super::mapping::{Channel, Mapping};
use super::super::signals::{Group, INPUTS, OUTPUTS};

/// Refuses two signals that go to, or come from, one variable. Variables with the same value reference are one.
///
/// # Errors
/// Names both signals and the variable.
pub(super) fn refuse_duplicates(mapping: &Mapping) -> Result<(), String> {
    if let Some((first, second)) = twice(&mapping.inputs) {
        return Err(format!(
            "{}; give each its own input, or map one of the two to false",
            pair(&INPUTS, first, second)
        ));
    }
    if let Some((first, second)) = twice(&mapping.outputs) {
        return Err(format!(
            "{}; give each its own output, or map one to a constant if it does not change",
            pair(&OUTPUTS, first, second)
        ));
    }
    Ok(())
}

/// Two channels of one variable.
fn twice(channels: &[Channel]) -> Option<(&Channel, &Channel)> {
    channels.iter().enumerate().find_map(|(place, second)| {
        let before = channels.iter().take(place);
        let first = before.into_iter().find(|first| first.variable.1 == second.variable.1)?;
        Some((first, second))
    })
}

fn pair(groups: &[Group], first: &Channel, second: &Channel) -> String {
    let signal = |channel: &Channel| {
        groups.get(channel.group).map(|group| group.signal(channel.part)).unwrap_or_default()
    };
    let (one, other) = (&first.variable.0, &second.variable.0);
    let names = if one == other {
        format!("the variable `{one}`")
    } else {
        format!("the variables `{one}` and `{other}`, which share a value reference")
    };
    format!("{} and {} are both mapped to {names}", signal(first), signal(second))
}
