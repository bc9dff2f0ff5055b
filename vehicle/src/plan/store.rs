//! The plans of a vehicle.

use serde::{Deserialize, Serialize};

use super::{MissionItem, PlanFault, PlanKind, Site, check};

/// A plan that was taken.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Plan {
    items: Vec<MissionItem>,
}

impl Plan {
    /// A plan of items, unchecked.
    pub fn new(items: Vec<MissionItem>) -> Self {
        Self { items }
    }

    /// Its items, in their order.
    pub fn items(&self) -> &[MissionItem] {
        &self.items
    }

    /// A number that tells plans apart: CRC-32 over the items; zero only for the empty one.
    pub fn id(&self) -> u32 {
        if self.items.is_empty() {
            return 0;
        }
        let mut checksum = crc32fast::Hasher::new();
        for item in &self.items {
            checksum.update(&item.bytes());
        }
        checksum.finalize().max(1)
    }
}

/// One plan of each kind.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Plans {
    mission: Plan,
    fence: Plan,
    rally: Plan,
}

impl Plans {
    /// The plan of a kind.
    pub fn get(&self, kind: PlanKind) -> &Plan {
        match kind {
            PlanKind::Mission => &self.mission,
            PlanKind::Fence => &self.fence,
            PlanKind::Rally => &self.rally,
        }
    }

    /// Checks what was kept elsewhere, as if it were uploaded to a vehicle at a site.
    ///
    /// # Errors
    /// [`PlanFault`] of the first item that is wrong.
    pub fn check(&self, site: &Site) -> Result<(), PlanFault> {
        let kinds = [PlanKind::Mission, PlanKind::Fence, PlanKind::Rally];
        let plans = kinds.into_iter().map(|kind| (kind, self.get(kind).items()));
        plans
            .filter(|(_, items)| !items.is_empty())
            .try_for_each(|(kind, items)| check::plan(kind, items, site))
    }

    /// Replaces the plan of a kind.
    pub fn set(&mut self, kind: PlanKind, plan: Plan) {
        match kind {
            PlanKind::Mission => self.mission = plan,
            PlanKind::Fence => self.fence = plan,
            PlanKind::Rally => self.rally = plan,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{MissionItem, Plan};

    #[test]
    fn the_id_tells_plans_apart() {
        let item = |x: f64| MissionItem {
            frame: 6,
            command: 16,
            parameters: [0.0, 0.0, 0.0, f64::NAN],
            position: [x, 8.0, 10.0],
            autocontinue: true,
        };
        assert_eq!(Plan::default().id(), 0);
        let plan = Plan::new(vec![item(47.0), item(48.0)]);
        assert_eq!(plan.id(), Plan::new(vec![item(47.0), item(48.0)]).id());
        assert_ne!(plan.id(), Plan::new(vec![item(48.0), item(47.0)]).id());
        assert_ne!(plan.id(), Plan::new(vec![item(47.0)]).id());
        assert_ne!(plan.id(), Plan::new(vec![item(47.0), item(48.000_000_1)]).id());
    }
}
