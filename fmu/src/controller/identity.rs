//! Names and texts of the controllers.

use fmi::{Experiment, Identity, SavedStateFormat};

use crate::tables::identity::PROJECT;

pub(super) const IDENTITY: Identity = Identity {
    name: "LmpcController",
    model_identifier: "LmpcController",
    description: "Laguerre model predictive controllers of a quadrotor (Chipofya, Lee and Chong 2015): from a reference and \
        the measured motion to rotor commands, sampled at their own exact instants",
    // The attitude controller's sample time: every sample is a communication point.
    default_experiment: Experiment { stop_time_s: 10.0, step_size_s: 0.01 },
    saved_state: SavedStateFormat { magic: *b"LMPCCTRL", version: 11 },
    ..PROJECT
};
