//! The steps of a mission, in SI units.

use super::{ChangeSpeed, Look, Place, TimeOfDay};
use crate::equipment::Operation;
use crate::fence::FenceSwitch;
use crate::radio::Position;

/// One step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// Flown, one after the other.
    Navigate(Navigate),
    /// Waited for on the way to the next step that is flown; what follows it waits, too.
    Condition(Condition),
    /// Done at once, on the way.
    Do(Do),
    /// Changes the order of the steps.
    Jump(Jump),
    /// Nothing: an item that no checked mission has.
    Pass,
}

/// A step that is flown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Navigate {
    /// To a place, and on.
    Waypoint(Waypoint),
    /// To a place, and stay.
    Loiter {
        /// The place.
        place: Place,
        /// Heading on the way and there, rad; `None`: that of the way.
        heading_rad: Option<f64>,
    },
    /// To a place, and stay for a time.
    LoiterTime {
        /// The place.
        place: Place,
        /// How long, s.
        time_s: f64,
    },
    /// Turns around a place.
    LoiterTurns(Turns),
    /// Ends the mission with a return.
    ReturnToLaunch,
    /// Down, at a place if there is one.
    Land {
        /// The place.
        place: Place,
        /// Heading on the way and there, rad; `None`: that of the way.
        heading_rad: Option<f64>,
    },
    /// Up where the vehicle is.
    Takeoff {
        /// How high, and where to go then.
        place: Place,
        /// Whether it goes to the place then: ArduPilot only climbs.
        travels: bool,
    },
    /// To a place at the present height, and there to another height.
    LoiterToAltitude {
        /// The place with that height.
        place: Place,
    },
    /// To a place, along a curve through it and those before and behind it.
    Spline {
        /// The place.
        place: Place,
        /// How long the vehicle stays, s; 0: it need not stop.
        hold_s: f64,
    },
    /// To a place, down to the ground there, where the gripper releases, and up again.
    PlacePayload {
        /// The place.
        place: Place,
        /// How far it may descend, m; `None`: to the ground.
        descent_m: Option<f64>,
    },
    /// Wait where the vehicle is.
    Delay(Delay),
}

impl Navigate {
    /// Where it goes, if it names a place.
    pub fn place(&self) -> Option<&Place> {
        match self {
            Self::Waypoint(Waypoint { place, .. })
            | Self::LoiterTurns(Turns { place, .. })
            | Self::Loiter { place, .. }
            | Self::LoiterTime { place, .. }
            | Self::Land { place, .. }
            | Self::LoiterToAltitude { place }
            | Self::Spline { place, .. }
            | Self::PlacePayload { place, .. }
            | Self::Takeoff { place, .. } => Some(place),
            Self::ReturnToLaunch | Self::Delay(_) => None,
        }
    }
}

/// A place on the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Waypoint {
    /// The place.
    pub place: Place,
    /// How long the vehicle stays, s; 0: it need not stop.
    pub hold_s: f64,
    /// How near it must come, m, positive; `None`: as the parameter says.
    pub acceptance_radius_m: Option<f64>,
    /// Heading on the way and there, rad; `None`: that of the way.
    pub heading_rad: Option<f64>,
}

/// Turns around a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turns {
    /// The centre.
    pub place: Place,
    /// How many.
    pub turns: f64,
    /// Radius, m, negative for turns that are counter-clockwise seen from above; `None`: as the vehicle has it.
    pub radius_m: Option<f64>,
}

/// How long a delay lasts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Delay {
    /// A time, s.
    For(f64),
    /// To the next such time.
    Until(TimeOfDay),
}

/// What the steps behind it wait for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Condition {
    /// A time, s.
    Delay(f64),
    /// So near to the end of the leg, m.
    Distance(f64),
    /// Beyond the upright plane through a place, north and east, m, across the way from there to the end of the leg.
    Gate([f64; 2]),
    /// The end of a turn.
    Yaw(Turn),
}

/// A turn of the heading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// Where to.
    pub to: TurnTo,
    /// How fast, rad/s, positive; `None`: as fast as the vehicle can.
    pub rate_rad_s: Option<f64>,
}

/// Where a turn ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TurnTo {
    /// At a heading, rad from north.
    Heading(f64, TurnDirection),
    /// After an angle, rad, positive clockwise.
    By(f64),
}

/// The way round to a heading.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TurnDirection {
    /// The short way.
    Shortest,
    /// Clockwise seen from above.
    Clockwise,
    /// Counter-clockwise seen from above.
    CounterClockwise,
}

/// What is done at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Do {
    /// Changes a limit of speed while the mission is flown.
    ChangeSpeed(ChangeSpeed),
    /// Puts home at a place; where the vehicle is if there is none. A place without an altitude keeps that of home.
    SetHome(Option<Place>),
    /// Looks at something; `None`: at nothing any more.
    Look(Option<Look>),
    /// Asks something of the equipment.
    Operate(Operation),
    /// Switches the fence.
    SwitchFence(FenceSwitch),
    /// Does what a switch of the pilot does that comes to a position, by ArduPilot's number.
    MoveSwitch {
        /// RCn_OPTION's number.
        function: u32,
        /// Where the switch is then.
        position: Position,
    },
    /// Passes something by that the vehicle does not have.
    Absent(&'static str),
    /// Nothing: other commands find their way by it.
    Mark,
}

/// A jump.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Jump {
    /// Number of the step that it leads to.
    pub to: usize,
    /// How often it is made; `None`: always.
    pub repeats: Option<u32>,
}
