#![doc = include_str!("../README.md")]
//!
//! # The example's flight
//!
#![doc = include_str!("climb.svg")]
//!
//! # From symbol to type
//!
//! | object | type | equation |
//! | --- | --- | --- |
//! | A_m, B_m, C_m, the plant | [`StateSpace`] | (9), (15), (23), (35) |
//! | A, B, C, the augmented model | [`Augmented`] | (36) |
//! | Q, R, and how they vary over the horizon | [`Weights`], [`Weighting`] | (48), (51)–(57) |
//! | L(m), A_l, a | [`LaguerreBasis`] | (38)–(43), (58) |
//! | Ω, Ψ, φ(m) | [`Prediction`] | (46)–(50) |
//! | K, η = −Ω⁻¹Ψx, and the eigenvalues of A − BK | [`LmpcDesign`] | (50) |
//! | P, K of the infinite horizon; K_w with α > 1 | [`Dlqr`], [`solve_riccati`] | (54) |
//! | D, and the samples m of a limit | [`Limit`] of a [`Quantity`] | |
//! | x(k), y − r, u_r(k), d(k), b | [`Sample`] | |
//! | u(k), Δu(k), and how they were found | [`Step`], [`Status`] | |
//! | K_s, S, K of a plan about a stabilizing feedback | [`StabilizedDesign`], [`StabilizedMpc`] | |
//! | C, D and directions of a limited signal; its relaxation | [`SignalLimit`] | |
//! | z₀, G, b of the program that it makes, for another solver | [`PosedProgram`] | |
//! | Σ xᵀQx + ΔuᵀRΔu of a flight; designs compared by it | [`ClosedLoop`], [`Trial`], [`DesignSearch`] | |
//! | the numbers of a step: `f64`, or `f32` | [`Precision`] | |
//! | F, Φ, H of the state-space MPC | [`StateSpaceMpcDesign`] | (28)–(34) |
//! | x̂(k+1 given k), K, P of the predictor | [`KalmanDesign`], [`KalmanPredictor`] | (24)–(27) |
//!
//! # From design to flight
//!
//! ```text
//!    design: sizes at run time, allocates, Result                    │ flight: const generics, no allocation, no panic
//!                                                                    │
//! StateSpace ─► Augmented ─┬─► Dlqr ──────────────┬──────────────────┼─► StateFeedback ─┐
//!     │                    ├─► Weights, Weighting ├─► LmpcDesign ────┼─► StateFeedback  │
//!     │                    └─► LaguerreBasis ─────┤       │          │                  ├─ Controller
//!     │                                           │ Limit ┴──────────┼─► LaguerreMpc    │  ControllerState, Sample → Step
//!     │                       StabilizedDesign ◄──┘                  │                  │
//!     │                               └─ SignalLimit ────────────────┼─► StabilizedMpc ─┤
//!     ├─► StateSpaceMpcWeights ─► StateSpaceMpcDesign, Limit ────────┼─► StateSpaceMpc ─┘
//!     └─► NoiseCovariance ─► KalmanDesign ───────────────────────────┼─► KalmanPredictor
//! ```
//!
//! Designs are made in `f64`. What flies is generic over its [`Precision`], the last parameter of its type, which defaults to `f64`:
//! `to_precision` converts it, and serde saves it, so a microcontroller can load a finished design. Deserialize only what serde saved:
//! indices are not checked.
//!
//! Every step of the design returns a [`DesignError`] when a precondition is violated. Of the const generics, N, P and Q
//! are the numbers of states, inputs and outputs of the plant. E is the capacity of a program, at least its
//! [number of unknowns](unknowns); W is the number of active limits that a [`ControllerState`] has room for,
//! K the number of unknowns whose factors it [keeps](ControllerState::keeping) from one step to the next.
#![doc = include_str!("equations.md")]
#![no_std]
#![forbid(unsafe_code)]
#![cfg_attr(not(test), warn(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

extern crate alloc;

mod active_set;
mod augmented;
mod balancing;
mod bounds;
mod capacity;
mod closed_loop;
mod controller;
mod controller_state;
mod dense;
mod design;
mod design_search;
mod dlqr;
mod dual_search;
mod eigenvalues;
mod error;
mod exponential;
mod hessenberg_qr;
mod kalman;
mod kept_active_set;
mod laguerre;
mod laguerre_mpc;
mod laguerre_walk;
mod limit;
mod limit_row;
mod limited_signals;
mod model_increment;
mod moves_walk;
mod optimal_gain;
mod placed_limit;
mod posed_program;
mod precision;
mod prediction;
mod product;
mod quadratic_program;
mod reachability;
mod relaxable;
mod riccati;
mod sample;
mod signal_limit;
mod sparse_columns;
mod sparse_rows;
mod stabilized_design;
mod stabilized_mpc;
mod state_feedback;
mod state_space;
mod state_space_mpc;
mod state_space_mpc_design;
mod stein;
mod step;
mod unit_scaling;
mod validate;
mod weighting;
mod worst_constraint;

pub use augmented::Augmented;
pub use capacity::unknowns;
pub use closed_loop::{ClosedLoop, Trial, TrialCost};
pub use controller::Controller;
pub use controller_state::ControllerState;
pub use design::LmpcDesign;
pub use design_search::DesignSearch;
pub use dlqr::Dlqr;
pub use eigenvalues::{condition_number, eigenvalues, spectral_radius};
pub use error::DesignError;
pub use kalman::{KalmanDesign, KalmanPredictor, NoiseCovariance};
pub use laguerre::LaguerreBasis;
pub use laguerre_mpc::LaguerreMpc;
pub use limit::{Limit, Quantity};
pub use model_increment::ModelIncrement;
pub use posed_program::PosedProgram;
pub use precision::Precision;
pub use prediction::Prediction;
pub use quadratic_program::{Outcome, QuadraticProgram, Solution, WarmStart};
pub use reachability::{uncontrollable_eigenvalues, unobservable_eigenvalues};
pub use riccati::{riccati_residual, solve_riccati};
pub use sample::{Reference, Sample};
pub use signal_limit::SignalLimit;
pub use stabilized_design::StabilizedDesign;
pub use stabilized_mpc::StabilizedMpc;
pub use state_feedback::StateFeedback;
pub use state_space::{Discretization, StateSpace};
pub use state_space_mpc::StateSpaceMpc;
pub use state_space_mpc_design::{StateSpaceMpcDesign, StateSpaceMpcWeights};
pub use stein::solve_stein;
pub use step::{Status, Step};
pub use weighting::{Weighting, Weights};
