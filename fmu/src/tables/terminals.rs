//! Terminals that several models have: members of the same names plug into one another.

use fmi::variables::{Matching, Terminal};

/// What the vehicle is asked for.
pub(crate) const REFERENCE: Terminal = Terminal {
    name: "reference",
    description: "What the vehicle is asked for",
    matching: Matching::Bus,
    variables: &["reference.", "armed"],
    prefix: "reference.",
};

/// What pushes the vehicle.
pub(crate) const DISTURBANCE: Terminal = Terminal {
    name: "disturbance",
    description: "Force, torque, wind and ground that act on the vehicle",
    matching: Matching::Bus,
    variables: &["disturbance.", "wind.", "ground."],
    prefix: "disturbance.",
};

/// The motion of the vehicle, as the controllers measure it.
pub(crate) const MOTION: Terminal = Terminal {
    name: "motion",
    description: "Motion of the vehicle and speeds of its rotors",
    matching: Matching::Bus,
    variables: &["position", "velocity", "attitude", "quaternion", "body_rate", "rotor.speed"],
    prefix: "",
};

/// The motion of the vehicle where it is measured.
pub(crate) const MEASURED_MOTION: Terminal =
    Terminal { variables: &["measured."], prefix: "measured.", ..MOTION };

/// What drives the vehicle.
pub(crate) const ACTUATION: Terminal = Terminal {
    name: "actuation",
    description: "Commanded rotor speeds, and thrust and torques in their place",
    matching: Matching::Plug,
    variables: &["rotor.command", "command."],
    prefix: "",
};
