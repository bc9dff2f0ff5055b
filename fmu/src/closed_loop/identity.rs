//! Names and texts of the closed loop.

use fmi::{Identity, SavedStateFormat};

use crate::tables::identity::PROJECT;

pub(super) const IDENTITY: Identity = Identity {
    name: "LmpcQuadrotor",
    model_identifier: "LmpcQuadrotor",
    description: "Quadrotor under a cascade of Laguerre model predictive controllers \
        (Chipofya, Lee and Chong 2015), flying from the origin to 5 m north, 5 m east, 10 m up",
    saved_state: SavedStateFormat { magic: *b"LMPCQRST", version: 17 },
    ..PROJECT
};
