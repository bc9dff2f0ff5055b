//! Names and texts of the closed loop.

use fmi::{Experiment, Identity, SavedStateFormat, Words};

pub(super) const IDENTITY: Identity = Identity {
    name: "LmpcQuadrotor",
    model_identifier: "LmpcQuadrotor",
    description: "Quadrotor under a cascade of Laguerre model predictive controllers \
        (Chipofya, Lee and Chong 2015), flying from the origin to 5 m north, 5 m east, 10 m up",
    version: env!("CARGO_PKG_VERSION"),
    author: env!("CARGO_PKG_AUTHORS"),
    copyright: concat!("Copyright (c) 2026 ", env!("CARGO_PKG_AUTHORS")),
    license: env!("CARGO_PKG_LICENSE"),
    generation_tool: concat!("lmpc-quadrotor ", env!("CARGO_PKG_VERSION")),
    // Of the release.
    date: "2026-11-21T00:00:00Z",
    // The flight and a rest, in half of the outer controllers' sample time: a multiple of it is a communication
    // point, too.
    default_experiment: Experiment { stop_time_s: 20.0, step_size_s: 0.025 },
    // An hour; it takes seconds.
    longest_step_s: 3600.0,
    saved_state: SavedStateFormat { magic: *b"LMPCQRST", version: 5 },
    words: Words {
        run: "flight",
        retuned: "parameters changed, controllers redesigned",
        events: "Initialization, redesign of the controllers, reset",
        errors: "Rejected calls and failed flights",
    },
};
