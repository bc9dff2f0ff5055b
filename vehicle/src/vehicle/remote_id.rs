//! What the vehicle tells of itself by remote identification: who it is, who operates it, and from where.

use nalgebra::Vector3;

use super::situation::Situation;

/// Who it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BasicId {
    /// Kind of the identifier: 1 is a serial number.
    pub id_kind: u8,
    /// Kind of aircraft: 2 is a multicopter.
    pub aircraft_kind: u8,
    /// The identifier, filled up with zeros.
    pub id: [u8; 20],
}

/// Who operates it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OperatorId {
    /// Kind of the identifier.
    pub kind: u8,
    /// The identifier, filled up with zeros.
    pub id: [u8; 20],
}

/// What the flight is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SelfId {
    /// Kind of the description.
    pub kind: u8,
    /// The description, filled up with zeros.
    pub text: [u8; 23],
}

/// From where it is operated, and in which class.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OperatorPlace {
    /// Where the operator is, NED, m; `None` while nobody knows.
    pub position_m: Option<Vector3<f64>>,
    /// How that is known: 0 from the takeoff, 1 live, 2 fixed.
    pub kind: u8,
    /// How many fly together, and within which radius, m.
    pub area: (u16, u16),
    /// Highest and lowest altitude of the flight, m.
    pub altitudes_m: (f64, f64),
    /// Kind of classification, its category and its class in the European Union.
    pub classification: [u8; 3],
    /// The time that the sender gives, s since 2019.
    pub time_s: u32,
}

/// What is known of it. Without a ground station PX4 fills in what it knows itself, ArduPilot waits.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct RemoteId {
    /// Who it is.
    pub basic: Option<BasicId>,
    /// Who operates it.
    pub operator: Option<OperatorId>,
    /// What the flight is for.
    pub own: Option<SelfId>,
    /// From where it is operated.
    pub place: Option<OperatorPlace>,
}

impl RemoteId {
    /// What is missing, if the vehicle identifies itself.
    pub fn missing(&self, situation: &Situation) -> Option<&'static str> {
        if !situation.conduct.surroundings.remote_id || !situation.identity.is_ardupilot() {
            return None;
        }
        if self.basic.is_none_or(|basic| basic.aircraft_kind == 0) {
            return Some("remote ID: no aircraft type and serial number; send OPEN_DRONE_ID_BASIC_ID");
        }
        if self.place.is_none_or(|place| place.position_m.is_none()) {
            return Some("remote ID: no place of the operator; send OPEN_DRONE_ID_SYSTEM");
        }
        None
    }

    /// What is missing to arm.
    pub fn obstacle(&self, situation: &Situation) -> Option<&'static str> {
        self.missing(situation).filter(|_| situation.conduct.surroundings.remote_id_to_arm)
    }
}
