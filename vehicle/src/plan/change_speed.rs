//! Changes of a limit of speed.

/// Which limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpeedKind {
    /// Horizontally.
    Horizontal,
    /// Up.
    Up,
    /// Down.
    Down,
}

/// What becomes of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpeedTarget {
    /// It stays as it is.
    Keep,
    /// It is what the parameter says.
    Default,
    /// It is this, m/s.
    Limit(f64),
}

/// A change of a limit of speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChangeSpeed {
    /// Which limit.
    pub kind: SpeedKind,
    /// What becomes of it.
    pub target: SpeedTarget,
}

impl ChangeSpeed {
    /// Reads parameters 1 and 2 of DO_CHANGE_SPEED: SPEED_TYPE, and a speed in m/s, −1 (keep it) or −2 (the parameter's). `None`
    /// for a type that there is not.
    pub fn of(kind: f64, speed_m_s: f64) -> Option<Self> {
        // The vehicle has one limit for its speed through the air (0) and over the ground (1).
        const KINDS: [(f64, SpeedKind); 4] = [
            (0.0, SpeedKind::Horizontal),
            (1.0, SpeedKind::Horizontal),
            (2.0, SpeedKind::Up),
            (3.0, SpeedKind::Down),
        ];
        let (_, kind) = KINDS.into_iter().find(|(number, _)| *number == kind)?;
        let target = match speed_m_s {
            -1.0 => SpeedTarget::Keep,
            -2.0 => SpeedTarget::Default,
            limit_m_s => SpeedTarget::Limit(limit_m_s),
        };
        Some(Self { kind, target })
    }
}
