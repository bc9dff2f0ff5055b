//! Inputs that move during a step.

use quadrotor::{InputSignal, Inputs};
use serde::{Deserialize, Serialize};

use crate::types::ValueReference;
use crate::variables::{Input, Role, variable};

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
pub(crate) struct Extrapolated<'a> {
    /// At the beginning of the step.
    pub inputs: &'a Inputs,
    /// There.
    pub derivatives: &'a [InputDerivative],
    /// Its beginning, µs.
    pub begin_us: u64,
}

impl InputSignal for Extrapolated<'_> {
    /// u(t) = u + Σ uᵏ (t − t₀)ᵏ / k!
    fn at(&self, time_us: u64) -> Inputs {
        let elapsed_s = time_us.saturating_sub(self.begin_us) as f64 * 1e-6;
        let mut inputs = *self.inputs;
        for derivative in self.derivatives {
            if let Some((get, set, _)) = continuous(derivative.reference) {
                let moved = get(&inputs) + derivative.term(elapsed_s);
                set(&mut inputs, moved);
            }
        }
        // Only when all terms are added: they may cancel.
        for derivative in self.derivatives {
            if let Some((get, set, (minimum, maximum))) = continuous(derivative.reference) {
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

type Continuous = (fn(&Inputs) -> f64, fn(&mut Inputs, f64), (f64, f64));

/// Access to a continuous input, and its range.
pub(crate) fn continuous(reference: ValueReference) -> Option<Continuous> {
    match variable(reference)?.role {
        Role::Input(Input::Real { get, set, minimum, maximum, .. }) => Some((get, set, (minimum, maximum))),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use quadrotor::{InputSignal, Inputs};

    use super::{Extrapolated, InputDerivative};
    use crate::types::ValueReference;
    use crate::variables::with_references;

    fn reference(name: &str) -> ValueReference {
        with_references().find(|(_, variable)| variable.name == name).expect("a known name").0
    }

    #[test]
    fn polynomial_from_the_beginning_of_the_step() {
        let x = reference("reference.position.x");
        let inputs = Inputs::default();
        let derivatives = [(1, 2.0), (2, 3.0), (3, -6.0)].map(|(order, value)| InputDerivative {
            reference: x,
            order,
            value,
        });
        let signal = Extrapolated { inputs: &inputs, derivatives: &derivatives, begin_us: 1_000_000 };
        assert_eq!(signal.at(1_000_000), inputs);
        let half = signal.at(1_500_000);
        assert_eq!(half.reference.position_m.x, 5.0 + 2.0 * 0.5 + 3.0 * 0.125 - 0.125);
        assert_eq!(half.reference.position_m.y, inputs.reference.position_m.y);
    }

    #[test]
    fn range_is_kept() {
        let x = reference("wind.velocity.x");
        let inputs = Inputs::default();
        let derivatives = [InputDerivative { reference: x, order: 1, value: -1e9 }];
        let signal = Extrapolated { inputs: &inputs, derivatives: &derivatives, begin_us: 0 };
        assert_eq!(signal.at(1_000_000).disturbance.wind_m_s.x, -200.0);
    }
}
