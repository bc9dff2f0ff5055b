//! Names and texts of the plant.

use fmi::{Experiment, Identity, SavedStateFormat, Words};

use crate::tables::identity::PROJECT;

pub(super) const IDENTITY: Identity = Identity {
    name: "QuadrotorPlant",
    model_identifier: "QuadrotorPlant",
    description: "Quadrotor without its controllers: rotor speeds or thrust and torques in, motion out \
        (Chipofya, Lee and Chong 2015), climbing from the origin",
    // A climb by 30 m.
    default_experiment: Experiment { stop_time_s: 10.0, step_size_s: 0.01 },
    saved_state: SavedStateFormat { magic: *b"QUADPLNT", version: 4 },
    words: Words {
        run: "flight",
        retuned: "parameters changed",
        events: "Initialization, changed parameters, reset",
        ..PROJECT.words
    },
    ..PROJECT
};
