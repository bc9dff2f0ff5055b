//! What a controller costs on the linear loop that it was designed for.

use alloc::vec::Vec;

use nalgebra::{DMatrix, DVector, SVector};

use crate::{
    Augmented, Controller, ControllerState, DesignError, Dlqr, Sample, SignalLimit, Status, Weights, validate,
};

/// How a flight on the linear loop begins, with N states, P inputs and Q outputs, as deviations from a plant at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trial<const N: usize, const P: usize, const Q: usize> {
    /// x_m(0).
    pub state: SVector<f64, N>,
    /// Δx_m(0) = x_m(0) − x_m(−1).
    pub increment: SVector<f64, N>,
    /// u(−1).
    pub input: SVector<f64, P>,
    /// r, constant.
    pub goal: SVector<f64, Q>,
}

impl<const N: usize, const P: usize, const Q: usize> Trial<N, P, Q> {
    /// A step of the set-point to `goal`, from rest.
    pub fn step(goal: SVector<f64, Q>) -> Self {
        Self { state: SVector::zeros(), increment: SVector::zeros(), input: SVector::zeros(), goal }
    }
}

/// What a [`Trial`] came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrialCost {
    /// Σ xᵀQx + ΔuᵀRΔu with x = \[Δx_m; y − r\]. After the last sample the regulator's cost of the remaining state stands for the
    /// rest.
    pub stage_cost: f64,
    /// Σ c σ², σ being by how many of its relaxations the worst limit is exceeded at each sample; infinite when one without
    /// a relaxation is.
    pub violation_cost: f64,
    /// The largest σ.
    pub violation: f64,
    /// Samples at which the controller reported that it relaxed its limits.
    pub relaxed: usize,
}

impl TrialCost {
    /// The sum of stage cost and violation cost. A [`StabilizedMpc`](crate::StabilizedMpc) penalizes the worst violation of its plan once;
    /// this sum penalizes every sample at which a limit is violated.
    pub fn total(&self) -> f64 {
        self.stage_cost + self.violation_cost
    }
}

/// The undisturbed linear loop: a plant under limits, and the cost that judges it.
///
/// This is the offline side of a design: it allocates, and is meant for comparing candidates.
#[derive(Clone, Debug, PartialEq)]
pub struct ClosedLoop<'a> {
    model: &'a Augmented,
    weights: &'a Weights,
    limits: &'a [SignalLimit],
    upper: &'a [f64],
    slack_cost: f64,
    /// P: xᵀPx is the regulator's cost to go.
    cost_to_go: DMatrix<f64>,
}

impl<'a> ClosedLoop<'a> {
    /// The loop of a model under limits with the values `upper`, one per row of their directions, in which a slack of 1 costs
    /// `slack_cost`.
    ///
    /// # Errors
    /// Those of [`Dlqr::new`] with λ = 1, and [`DesignError::Dimension`] when the limits do not fit the model or each other's values.
    pub fn new(
        model: &'a Augmented,
        weights: &'a Weights,
        limits: &'a [SignalLimit],
        upper: &'a [f64],
        slack_cost: f64,
    ) -> Result<Self, DesignError> {
        let plant = model.plant();
        let mut rows = 0;
        for limit in limits {
            let components = limit.state.nrows();
            validate::shape("C of a limit", &limit.state, (components, plant.states()))?;
            validate::shape("D of a limit", &limit.input, (components, plant.inputs()))?;
            validate::shape(
                "directions of a limit",
                &limit.directions,
                (limit.directions.nrows(), components),
            )?;
            rows += limit.directions.nrows();
        }
        if upper.len() != rows {
            return Err(DesignError::Dimension {
                name: "values of the limits",
                expected: (rows, 1),
                actual: (upper.len(), 1),
            });
        }
        let regulator = Dlqr::new(model.a(), model.b(), weights.q(), weights.r(), 1.0)?;
        Ok(Self { model, weights, limits, upper, slack_cost, cost_to_go: regulator.cost().clone() })
    }

    /// Flies a trial over some samples.
    ///
    /// # Errors
    /// [`DesignError::Dimension`] when N, P and Q are not those of the model.
    pub fn fly<const N: usize, const P: usize, const Q: usize, const W: usize>(
        &self,
        law: &impl Controller<N, P, Q, W>,
        trial: &Trial<N, P, Q>,
        samples: usize,
    ) -> Result<TrialCost, DesignError> {
        let plant = self.model.plant();
        validate::shape("A of the plant", plant.a(), (N, N))?;
        validate::shape("B of the plant", plant.b(), (N, P))?;
        validate::shape("C of the plant", plant.c(), (Q, N))?;
        let mut measured = DVector::from_column_slice(trial.state.as_slice());
        let mut increment = DVector::from_column_slice(trial.increment.as_slice());
        let goal = DVector::from_column_slice(trial.goal.as_slice());
        let mut state =
            ControllerState::<N, P, W>::new(trial.state - trial.increment, trial.input, SVector::zeros());
        let mut cost = TrialCost { stage_cost: 0.0, violation_cost: 0.0, violation: 0.0, relaxed: 0 };
        let mut before = DVector::from_column_slice(trial.input.as_slice());
        for _ in 0..samples {
            let error = plant.c() * &measured - &goal;
            let sample = Sample {
                measured: fixed(&measured),
                increment: fixed(&increment),
                deviation: fixed(&measured),
                error: fixed(&error),
                upper: self.upper,
                ..Sample::default()
            };
            let step = law.step(&mut state, &sample);
            cost.relaxed += usize::from(step.status == Status::Relaxed);
            let input = DVector::from_column_slice(step.input.as_slice());
            let moved = &input - &before;
            let x = stacked(&increment, &error);
            cost.stage_cost += x.dot(&(self.weights.q() * &x)) + moved.dot(&(self.weights.r() * &moved));
            let sigma = self.violation(&measured, &input);
            cost.violation = cost.violation.max(sigma);
            cost.violation_cost += if sigma > 0.0 { self.slack_cost * sigma * sigma } else { 0.0 };
            let next = plant.a() * &measured + plant.b() * &input;
            increment = &next - &measured;
            measured = next;
            before = input;
        }
        let x = stacked(&increment, &(plant.c() * &measured - &goal));
        cost.stage_cost += x.dot(&(&self.cost_to_go * &x));
        Ok(cost)
    }

    /// σ at one sample.
    fn violation(&self, state: &DVector<f64>, input: &DVector<f64>) -> f64 {
        let (mut worst, mut bound) = (0.0_f64, 0);
        for limit in self.limits {
            let signal = &limit.state * state + &limit.input * input;
            let along = &limit.directions * signal;
            for value in along.iter() {
                let upper = self.upper[bound];
                let over = value - upper;
                // As much as a solver's tolerance counts as met.
                if over > ROUNDING * libm::fabs(upper) {
                    worst = worst.max(over / limit.relaxation);
                }
                bound += 1;
            }
        }
        worst
    }
}

/// By which share of its value a limit may be exceeded and still count as met.
const ROUNDING: f64 = 1e-8;

fn fixed<const R: usize>(vector: &DVector<f64>) -> SVector<f64, R> {
    SVector::from_column_slice(vector.as_slice())
}

fn stacked(increment: &DVector<f64>, error: &DVector<f64>) -> DVector<f64> {
    let values: Vec<f64> = increment.iter().chain(error.iter()).copied().collect();
    DVector::from_vec(values)
}
