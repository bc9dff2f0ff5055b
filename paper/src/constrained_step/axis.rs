//! One loop of the cascade as it flies in hover, with the steps that it is measured by.

use lmpc::{Augmented, DesignError, Dlqr, SignalLimit};
use nalgebra::{DVector, DVectorView};
use quadrotor::{Configuration, HoverLoops, LinearLoop};

use crate::Error;

/// Names of the loops.
pub const AXES: [&str; 4] = ["position", "altitude", "roll", "yaw"];

/// A step from rest at the origin.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// "position step of 5 m".
    pub problem: &'static str,
    /// The set-point of each output, m or rad.
    pub goal: Vec<f64>,
}

/// A loop of the cascade.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// "position", "altitude", "roll" or "yaw".
    pub name: &'static str,
    /// Its model, weights, limits and default design.
    pub linear: LinearLoop,
    /// The steps.
    pub steps: Vec<Step>,
}

fn steps(of: &[(&'static str, &[f64])]) -> Vec<Step> {
    of.iter().map(|(problem, goal)| Step { problem, goal: goal.to_vec() }).collect()
}

impl Axis {
    /// The loops of the cascade with its defaults: north and east together, down, roll and pitch together, and yaw.
    ///
    /// # Errors
    /// [`Error`] when a loop cannot be designed.
    pub fn all() -> Result<[Self; 4], Error> {
        let loops = HoverLoops::new(&Configuration::default())?;
        Ok([
            Self {
                name: "position",
                linear: LinearLoop::new(&loops.position)?,
                steps: steps(&[
                    ("position step of 1 m", &[1.0, 0.0]),
                    ("position step of 5 m", &[5.0, 0.0]),
                    ("position step of 20 m", &[20.0, 0.0]),
                    ("position step of 5 m north and 5 m east", &[5.0, 5.0]),
                ]),
            },
            Self {
                name: "altitude",
                linear: LinearLoop::new(&loops.altitude)?,
                steps: steps(&[
                    ("altitude step of 1 m up", &[-1.0]),
                    ("altitude step of 5 m up", &[-5.0]),
                    ("altitude step of 20 m up", &[-20.0]),
                    ("altitude step of 1 m down", &[1.0]),
                    ("altitude step of 5 m down", &[5.0]),
                    ("altitude step of 20 m down", &[20.0]),
                ]),
            },
            Self {
                name: "roll",
                linear: LinearLoop::new(&loops.lean)?,
                steps: steps(&[("roll step of 0.3 rad", &[0.3, 0.0]), ("roll step of 1 rad", &[1.0, 0.0])]),
            },
            Self {
                name: "yaw",
                linear: LinearLoop::new(&loops.turn)?,
                steps: steps(&[("yaw step of 0.3 rad", &[0.3]), ("yaw step of 1 rad", &[1.0])]),
            },
        ])
    }

    /// a of the default design.
    pub fn scale(&self) -> f64 {
        self.linear.scale
    }

    /// The state at a set-point: at rest there.
    pub fn at_rest(&self, goal: &[f64]) -> DVector<f64> {
        let per_channel = self.linear.model.states() / goal.len();
        DVector::from_fn(self.linear.model.states(), |state, _| {
            if state % per_channel == 0 { goal[state / per_channel] } else { 0.0 }
        })
    }

    /// The regulator of the same weights (54), α = 1.
    ///
    /// # Errors
    /// As [`Dlqr::new`].
    pub fn regulator(&self) -> Result<Dlqr, DesignError> {
        let (model, weights) = (Augmented::new(&self.linear.model), &self.linear.weights);
        Dlqr::new(model.a(), model.b(), weights.q(), weights.r(), 1.0)
    }

    /// The limits and their bounds, each bound with the limit that it belongs to and its direction.
    pub fn bounds(&self) -> impl Iterator<Item = (&SignalLimit, usize, f64)> {
        let limits = self.linear.limits.iter();
        limits
            .flat_map(|limit| (0..limit.directions.nrows()).map(move |direction| (limit, direction)))
            .zip(&self.linear.upper)
            .map(|((limit, direction), upper)| (limit, direction, *upper))
    }

    /// Largest excess over a limit, as a share of it.
    pub fn excess(&self, state: DVectorView<'_, f64>, input: DVectorView<'_, f64>) -> f64 {
        let share = |(limit, direction, upper): (&SignalLimit, usize, f64)| {
            let signal = &limit.state * state + &limit.input * input;
            (limit.directions.row(direction) * signal)[0] / upper - 1.0
        };
        self.bounds().map(share).fold(0.0, f64::max)
    }
}
