//! Flights of a loop of the cascade on its own model in hover, with every sample that its controller was told.

use lmpc::{Controller, ControllerState, Sample, Step};
use nalgebra::SVector;
use quadrotor::LinearLoop;

use crate::pick::Pick;

/// Samples from one goal to the next.
const LEG: usize = 100;
/// Farthest goal, as a multiple of the largest error that the controller plans with. Near ones are more frequent.
const FARTHEST: f64 = 3.0;

/// What a controller was told at a sample, and what it remembered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment<const N: usize, const P: usize, const E: usize> {
    /// Which flight it is of.
    pub flight: usize,
    /// x(k).
    pub measured: SVector<f64, N>,
    /// Δx(k).
    pub increment: SVector<f64, N>,
    /// y(k) − r(k) as it is seen.
    pub error: SVector<f64, P>,
    /// The controller before, with the limits that were active last and what it keeps of them.
    pub before: ControllerState<N, P, E, f64, E>,
    /// Whether its solver was needed.
    pub limited: bool,
}

impl<const N: usize, const P: usize, const E: usize> Moment<N, P, E> {
    /// The sample under some bounds.
    pub fn sample<'a>(&self, upper: &'a [f64]) -> Sample<'a, N, P, P> {
        let states_per_channel = N / P;
        let mut deviation = self.measured;
        for channel in 0..P {
            deviation[channel * states_per_channel] = self.error[channel];
        }
        Sample {
            measured: self.measured,
            increment: self.increment,
            deviation,
            error: self.error,
            upper,
            ..Sample::default()
        }
    }

    /// The same controller without the limits that were active last.
    pub fn forgetful(&self) -> ControllerState<N, P, E, f64, E> {
        ControllerState::new(self.before.measured(), self.before.applied(), self.before.input_reference())
            .keeping()
    }
}

/// Flies to random goals, in random directions, so many legs per flight.
pub fn fly<const N: usize, const P: usize, const E: usize>(
    linear: &LinearLoop,
    law: &impl Controller<N, P, P, E, f64, E>,
    flights: usize,
    legs: usize,
) -> Vec<Moment<N, P, E>> {
    let mut moments = Vec::with_capacity(flights * legs * LEG);
    let mut pick = Pick::new(7);
    let (a, b, c) = (linear.model.a(), linear.model.b(), linear.model.c());
    for flight in 0..flights {
        let mut state = SVector::<f64, N>::zeros();
        let mut increment = SVector::<f64, N>::zeros();
        let mut controller = ControllerState::<N, P, E>::at_rest().keeping();
        let mut goal = SVector::<f64, P>::zeros();
        for sample in 0..legs * LEG {
            if sample % LEG == 0 {
                let farness = pick.signed().abs().powi(2);
                goal = SVector::from_fn(|_, _| FARTHEST * linear.sight * farness * pick.signed());
            }
            let output: SVector<f64, P> = SVector::from_fn(|row, _| (c.row(row) * state)[0]);
            let error = output - goal;
            let seen = error * (linear.sight / error.norm().max(linear.sight));
            let mut moment = Moment {
                flight,
                measured: state,
                increment,
                error: seen,
                before: controller,
                limited: false,
            };
            let step: Step<P> = law.step(&mut controller, &moment.sample(&linear.upper));
            moment.limited = step.active > 0 || step.iterations > 0;
            moments.push(moment);
            let next: SVector<f64, N> =
                SVector::from_fn(|row, _| (a.row(row) * state)[0] + (b.row(row) * step.input)[0]);
            increment = next - state;
            state = next;
        }
    }
    moments
}
