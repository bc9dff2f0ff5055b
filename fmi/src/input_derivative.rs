//! Inputs that change during a step.

use serde::{Deserialize, Serialize};

use crate::model::Model;
use crate::variables::{Field, Role, ValueReference, variable};

/// Highest order of the derivatives of inputs.
pub(crate) const MAXIMUM_ORDER: i32 = 3;

/// One time derivative of one input, at the beginning of a step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct InputDerivative {
    /// The input.
    pub reference: ValueReference,
    /// 1 for the first derivative.
    pub order: i32,
    /// Its value in SI units.
    pub value: f64,
}

/// Inputs that continue as polynomials of time from the beginning of a step, within their ranges.
pub(crate) struct Extrapolated<'a, M: Model> {
    /// Values at the beginning of the step.
    pub inputs: &'a M::Inputs,
    /// Derivatives at the beginning of the step.
    pub derivatives: &'a [InputDerivative],
    /// Beginning of the step, µs.
    pub begin_us: u64,
}

impl<M: Model> Extrapolated<'_, M> {
    /// u(t) = u + Σ uᵏ (t − t₀)ᵏ / k!
    pub fn at(&self, time_us: u64) -> M::Inputs {
        let elapsed_s = time_us.saturating_sub(self.begin_us) as f64 * 1e-6;
        let mut inputs = self.inputs.clone();
        for derivative in self.derivatives {
            if let Some(Continuous { get, set, .. }) = continuous::<M>(derivative.reference) {
                let moved = get(&inputs) + derivative.term(elapsed_s);
                set(&mut inputs, moved);
            }
        }
        // Only when all terms are added: they may cancel.
        for derivative in self.derivatives {
            if let Some(Continuous { get, set, minimum, maximum }) = continuous::<M>(derivative.reference) {
                let limited = get(&inputs).clamp(minimum, maximum);
                set(&mut inputs, limited);
            }
        }
        inputs
    }
}

impl InputDerivative {
    fn term(&self, elapsed_s: f64) -> f64 {
        (1..=self.order).fold(self.value, |term, k| term * elapsed_s / f64::from(k))
    }
}

/// Access to a continuous input, and its range.
pub(crate) struct Continuous<I> {
    get: fn(&I) -> f64,
    set: fn(&mut I, f64),
    minimum: f64,
    maximum: f64,
}

/// The continuous input with this reference.
pub(crate) fn continuous<M: Model>(reference: ValueReference) -> Option<Continuous<M::Inputs>> {
    match variable::<M>(reference).ok()?.role {
        Role::Input(Field::Real { get, set, minimum, maximum, .. }) => {
            Some(Continuous { get, set, minimum, maximum })
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::{Extrapolated, InputDerivative};
    use crate::lag::{Inputs, Lag};

    /// The input `u`.
    const U: u32 = 0;

    #[test]
    fn polynomial_from_the_beginning_of_the_step() {
        let inputs = Inputs { u: 5.0, hold: false };
        let derivatives = [(1, 2.0), (2, 3.0), (3, -6.0)].map(|(order, value)| InputDerivative {
            reference: U,
            order,
            value,
        });
        let signal = Extrapolated::<Lag> { inputs: &inputs, derivatives: &derivatives, begin_us: 1_000_000 };
        assert_eq!(signal.at(1_000_000), inputs);
        let half = signal.at(1_500_000);
        assert_eq!(half.u, 5.0 + 2.0 * 0.5 + 3.0 * 0.125 - 0.125);
        assert_eq!(half.hold, inputs.hold);
    }

    #[test]
    fn range_is_kept() {
        let inputs = Inputs::default();
        let derivatives = [InputDerivative { reference: U, order: 1, value: -1e9 }];
        let signal = Extrapolated::<Lag> { inputs: &inputs, derivatives: &derivatives, begin_us: 0 };
        assert_eq!(signal.at(1_000_000).u, -10.0);
    }
}
