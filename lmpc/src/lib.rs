//! Model predictive control with Laguerre functions (LMPC).
//!
//! The future moves of the input are written as a short sum of discrete Laguerre functions, so that
//! a long control horizon costs few unknowns (Wang 2009, chapters 3 and 4; Chipofya, Lee, Chong 2015,
//! whose equation numbers are quoted as "(36)" throughout).
//!
//! ```text
//! StateSpace ─► Augmented ─┬─► Dlqr (Riccati) ─► Weighting ─┐
//!  (9) (15) (23)   (36)    │       (54)           (51)–(57) ├─► LmpcDesign ─► Controller
//!                          └─► LaguerreBasis ─► Prediction ─┘      (50)        run time
//!                                 (38)–(43)      (46)–(50)
//! ```
//!
//! Design (everything up to [`LmpcDesign`]) allocates, takes sizes at run time and returns a
//! [`DesignError`] for each violated precondition. The run-time [`Controller`] takes its sizes as const
//! generics, allocates nothing and does not panic. The crate builds without the standard library.
//!
//! # Example: the paper's altitude controller
//!
//! ```
//! use lmpc::{Augmented, Discretization, LaguerreBasis, LmpcDesign, StateSpace, Weighting, Weights};
//! use nalgebra::{dmatrix, DMatrix};
//!
//! // z̈ = G (7), sampled at 0.05 s with the forward Euler method (9).
//! let plant = StateSpace::from_continuous(
//!     &dmatrix![0.0, 1.0; 0.0, 0.0],
//!     &dmatrix![0.0; 1.0],
//!     &dmatrix![1.0, 0.0],
//!     0.05,
//!     Discretization::ForwardEuler,
//! )?;
//! let augmented = Augmented::new(&plant);
//! let weights = Weights::output(&augmented, 1.0, 1.0)?;
//! let bases = [LaguerreBasis::new(5, 0.8187)?];
//! let design = LmpcDesign::new(&augmented, &weights, &bases, 100, Weighting::exponential(1.2, 1.0))?;
//!
//! // Five Laguerre terms already give the gain of the infinite-horizon regulator to 0.1 %.
//! let difference: DMatrix<f64> = design.gain() - design.dlqr().gain();
//! assert!(difference.amax() / design.dlqr().gain().amax() < 1e-3);
//! # Ok::<(), lmpc::DesignError>(())
//! ```

#![no_std]
#![forbid(unsafe_code)]
#![cfg_attr(not(test), warn(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

extern crate alloc;

mod active_set;
mod augmented;
mod capacity;
mod controller;
mod controller_state;
mod dense;
mod design;
mod dlqr;
mod eigenvalues;
mod error;
mod exponential;
mod kalman;
mod laguerre;
mod laguerre_mpc;
mod laguerre_walk;
mod limit;
mod limit_row;
mod model_increment;
mod moves_walk;
mod prediction;
mod quadratic_program;
mod reachability;
mod relaxable;
mod riccati;
mod sample;
mod state_feedback;
mod state_space;
mod state_space_mpc;
mod state_space_mpc_design;
mod stein;
mod step;
mod validate;
mod weighting;

pub use augmented::Augmented;
pub use capacity::unknowns;
pub use controller::Controller;
pub use controller_state::ControllerState;
pub use design::LmpcDesign;
pub use dlqr::Dlqr;
pub use eigenvalues::{condition_number, eigenvalues, spectral_radius};
pub use error::DesignError;
pub use kalman::{KalmanDesign, KalmanPredictor, NoiseCovariance};
pub use laguerre::LaguerreBasis;
pub use laguerre_mpc::LaguerreMpc;
pub use limit::{Limit, Quantity};
pub use prediction::Prediction;
pub use quadratic_program::{Outcome, QuadraticProgram, Solution, WarmStart};
pub use reachability::{uncontrollable_eigenvalues, unobservable_eigenvalues};
pub use riccati::{riccati_residual, solve_riccati};
pub use sample::{Reference, Sample};
pub use state_feedback::StateFeedback;
pub use state_space::{Discretization, StateSpace};
pub use state_space_mpc::StateSpaceMpc;
pub use state_space_mpc_design::{StateSpaceMpcDesign, StateSpaceMpcWeights};
pub use step::{Status, Step};
pub use weighting::{Weighting, Weights};
