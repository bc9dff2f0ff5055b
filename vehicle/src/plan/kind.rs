//! Kinds of plans.

/// MAV_MISSION_TYPE of a single plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PlanKind {
    /// What is flown.
    Mission,
    /// Where it may be flown.
    Fence,
    /// Where to return to.
    Rally,
}

impl PlanKind {
    /// All kinds.
    pub const ALL: [Self; 3] = [Self::Mission, Self::Fence, Self::Rally];
    /// MAV_MISSION_TYPE of all kinds at once.
    pub const NUMBER_OF_ALL: u8 = 255;

    /// MAV_MISSION_TYPE.
    pub fn number(self) -> u8 {
        match self {
            Self::Mission => 0,
            Self::Fence => 1,
            Self::Rally => 2,
        }
    }

    /// The kind of a MAV_MISSION_TYPE.
    pub fn of(number: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.number() == number)
    }

    /// Most items that are kept.
    pub fn capacity(self) -> usize {
        match self {
            Self::Mission => 2000,
            Self::Fence => 500,
            Self::Rally => 100,
        }
    }

    /// Word for the pilot.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mission => "Mission",
            Self::Fence => "Fence",
            Self::Rally => "Rally",
        }
    }
}
