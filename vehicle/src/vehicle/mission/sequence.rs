//! Which item follows which.

use std::collections::BTreeMap;

use super::super::plans::first_mission_item;
use super::super::state::Vehicle;
use crate::plan::{MissionItem, PlanKind, command};

/// What follows an item.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Next {
    /// The next item that navigates, if there is one.
    pub navigation: Option<usize>,
    /// Items to be done on the way to it.
    pub actions: Vec<usize>,
    /// Jumps that were made.
    pub jumps: Vec<usize>,
}

/// Whether an item navigates.
pub fn navigates(item: &MissionItem) -> bool {
    item.command <= command::NAV_DELAY
}

/// What follows from item `from` on, itself included. `made` counts the jumps that were made, and is counted up. Jumps that
/// lead in a circle without a navigating item end the search.
pub fn next_from(items: &[MissionItem], from: usize, made: &mut BTreeMap<usize, u32>) -> Next {
    let mut next = Next::default();
    let mut index = from;
    for _ in 0..=2 * items.len() {
        let Some(item) = items.get(index) else { break };
        if navigates(item) {
            next.navigation = Some(index);
            break;
        }
        if item.command == command::DO_JUMP {
            let repeats = item.parameter(2);
            let count = made.entry(index).or_default();
            if repeats < 0.0 || f64::from(*count) < repeats {
                *count = count.saturating_add(1);
                next.jumps.push(index);
                index = item.parameter(1) as usize;
                continue;
            }
        } else {
            next.actions.push(index);
        }
        index += 1;
    }
    next
}

impl Vehicle {
    /// The mission's items.
    pub(in super::super) fn mission_items(&self) -> &[MissionItem] {
        self.plans.plans().get(PlanKind::Mission).items()
    }

    /// Number of the first item that is flown: in ArduPilot's convention the one before it is home.
    pub fn first_mission_item(&self) -> usize {
        first_mission_item(&self.situation())
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::{MissionItem, command, next_from};

    fn item(command: u16, parameters: [f64; 2]) -> MissionItem {
        let [one, two] = parameters;
        let parameters = [one, two, 0.0, 0.0];
        MissionItem { frame: 2, command, parameters, position: [0.0; 3], autocontinue: true }
    }

    #[test]
    fn jumps_are_made_as_often_as_asked() {
        let way = item(command::NAV_WAYPOINT, [0.0; 2]);
        let items =
            [way, item(command::DO_CHANGE_SPEED, [1.0, 3.0]), way, item(command::DO_JUMP, [0.0, 2.0]), way];
        let mut made = BTreeMap::new();
        let mut order = Vec::new();
        let mut from = 0;
        while let Some(index) = next_from(&items, from, &mut made).navigation {
            order.push(index);
            from = index + 1;
        }
        assert_eq!(order, [0, 2, 0, 2, 0, 2, 4]);
        assert_eq!(next_from(&items, 1, &mut made).actions, [1]);
    }

    #[test]
    fn jumps_in_a_circle_end() {
        let items = [item(command::DO_JUMP, [1.0, -1.0]), item(command::DO_JUMP, [0.0, -1.0])];
        assert_eq!(next_from(&items, 0, &mut BTreeMap::new()).navigation, None);
    }
}
