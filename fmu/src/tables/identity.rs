//! What all models say of themselves.

use fmi::{Experiment, Identity, SavedStateFormat, Words};

/// The identity of the project: a model replaces names, texts and formats.
pub(crate) const PROJECT: Identity = Identity {
    name: "",
    model_identifier: "",
    description: "",
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
    saved_state: SavedStateFormat { magic: [0; 8], version: 0 },
    words: Words {
        run: "flight",
        retuned: "parameters changed, controllers redesigned",
        events: "Initialization, redesign of the controllers, reset",
        errors: "Rejected calls and failed flights",
    },
};
