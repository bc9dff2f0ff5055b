//! The branches of f(x, u).

/// A branch of the plant's equations, which is on or off. Feet and rotors are numbered in the order of the airframe's layout.
///
/// Two kinks of f(x, u) are not among them. A rotor with different lags for rising and falling approaches its command and does
/// not cross it, so that an event there would come again and again with an integrator's noise; the power of a rotor goes with
/// |Ω|³, which is smooth enough at rest for every integrator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Switch {
    /// This foot is on the ground and presses.
    Bears(usize),
    /// This foot slips so fast that its friction is fully developed.
    Slides(usize),
    /// This foot presses as hard as any foot can.
    Hardest(usize),
    /// This rotor's thrust is at its upper bound.
    MostThrust(usize),
    /// This rotor's thrust is at its lower bound, zero.
    NoThrust(usize),
    /// This rotor is so close to the ground that the ground effect does not grow any more.
    NearGround(usize),
    /// The rotors' axes point up, so that the ground is below the rotors.
    Upright,
    /// The battery's charge is above the knee of its voltage.
    AboveKnee,
    /// The battery is empty.
    Empty,
    /// The rotors would take more power than the battery can give.
    Overloaded,
    /// Static friction holds the vehicle.
    Held,
}

impl Switch {
    /// How many there are.
    pub const COUNT: usize = 29;

    /// Its place among the [event indicators](crate::Plant::event_indicators).
    pub fn index(self) -> usize {
        match self {
            Self::Bears(foot) => foot,
            Self::Slides(foot) => 4 + foot,
            Self::Hardest(foot) => 8 + foot,
            Self::MostThrust(rotor) => 12 + rotor,
            Self::NoThrust(rotor) => 16 + rotor,
            Self::NearGround(rotor) => 20 + rotor,
            Self::Upright => 24,
            Self::AboveKnee => 25,
            Self::Empty => 26,
            Self::Overloaded => 27,
            Self::Held => 28,
        }
    }
}
