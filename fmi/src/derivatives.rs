//! Directional derivatives, and time derivatives of outputs.

use crate::continuous::{Continuous, Seed, equations, real_signal, state_count, state_place};
use crate::error::CallError;
use crate::instance::Instance;
use crate::model::Model;
use crate::variables::{Field, Role, ValueReference, variable, variables};

impl<M: Model> Instance<M> {
    /// Derivatives of `unknowns` (outputs and derivatives of states) along `direction` in `knowns` (continuous inputs and
    /// states), at the present states and inputs.
    pub fn directional_derivative(
        &mut self,
        unknowns: &[ValueReference],
        knowns: &[ValueReference],
        direction: &[f64],
        into: &mut [f64],
    ) -> Result<(), CallError> {
        let equations = differentiable::<M>()?;
        let signals = signals::<M>(unknowns)?;
        let (model, inputs) = self.run()?;
        let seed = seed::<M>(inputs, knowns, direction)?;
        let tangent = equations.tangent(model, inputs, &seed);
        for (into, signal) in into.iter_mut().zip(&signals) {
            *into = signal.derivative(&tangent)?;
        }
        Ok(())
    }

    /// The transposed product: derivatives of the sum of `unknowns`, each times its weight, with respect to each of `knowns`. It takes one
    /// directional derivative a known.
    pub fn adjoint_derivative(
        &mut self,
        unknowns: &[ValueReference],
        knowns: &[ValueReference],
        weights: &[f64],
        into: &mut [f64],
    ) -> Result<(), CallError> {
        let equations = differentiable::<M>()?;
        let signals = signals::<M>(unknowns)?;
        if let Some((signal, &value)) = signals.iter().zip(weights).find(|(_, weight)| !weight.is_finite()) {
            return Err(CallError::NotFinite { name: signal.name, value });
        }
        let (model, inputs) = self.run()?;
        for (into, &known) in into.iter_mut().zip(knowns) {
            let seed = seed::<M>(inputs, &[known], &[1.0])?;
            let tangent = equations.tangent(model, inputs, &seed);
            let mut sum = 0.0;
            for (signal, weight) in signals.iter().zip(weights) {
                sum += weight * signal.derivative(&tangent)?;
            }
            *into = sum;
        }
        Ok(())
    }

    /// Time derivatives of outputs at the communication point, where the last step ended.
    pub fn output_derivatives(
        &mut self,
        references: &[ValueReference],
        orders: &[i32],
        into: &mut [f64],
    ) -> Result<(), CallError> {
        if references.is_empty() {
            return Ok(());
        }
        let rates = M::OUTPUT_RATES.ok_or(CallError::NotOffered(
            "output derivatives are not available (maxOutputDerivativeOrder = 0)",
        ))?;
        let (model, _) = self.run()?;
        let rates = rates(model);
        for ((&reference, &order), into) in references.iter().zip(orders).zip(into) {
            let variable = variable::<M>(reference)?;
            let name = variable.name;
            if order != 1 {
                return Err(CallError::DerivativeOrder { name, order, maximum: 1 });
            }
            let signal = real_signal(variable).ok_or(CallError::NotAnUnknown { name })?;
            *into = signal(&rates);
        }
        Ok(())
    }
}

/// The equations of a model that has derivatives.
fn differentiable<M: Model>() -> Result<&'static dyn Continuous<M>, CallError> {
    equations::<M>().map_err(|_| {
        CallError::NotOffered(
            "derivatives are not available (providesDirectionalDerivative = false, and so are those of FMI 3.0)",
        )
    })
}

/// A variable that has derivatives.
struct Differentiable<M: Model> {
    name: &'static str,
    get: fn(&M::Outputs) -> f64,
}

impl<M: Model> Differentiable<M> {
    fn derivative(&self, tangent: &M::Outputs) -> Result<f64, CallError> {
        let value = (self.get)(tangent);
        if value.is_finite() { Ok(value) } else { Err(CallError::NoDerivative { name: self.name, value }) }
    }
}

/// The variables with these references, all of which must have derivatives.
fn signals<M: Model>(unknowns: &[ValueReference]) -> Result<Vec<Differentiable<M>>, CallError> {
    let signals = unknowns.iter().map(|&unknown| {
        let variable = variable::<M>(unknown)?;
        let name = variable.name;
        real_signal(variable).map(|get| Differentiable { name, get }).ok_or(CallError::NotAnUnknown { name })
    });
    signals.collect()
}

/// The direction in the space of states and inputs. A variable that is named twice counts twice.
fn seed<M: Model>(
    inputs: &M::Inputs,
    knowns: &[ValueReference],
    direction: &[f64],
) -> Result<Seed<M>, CallError> {
    let mut seed = Seed::<M> { states: vec![0.0; state_count::<M>()], inputs: inputs.clone() };
    for (_, variable) in variables::<M>() {
        if let Role::Input(Field::Real { set, .. }) = variable.role {
            set(&mut seed.inputs, 0.0);
        }
    }
    for (&known, &value) in knowns.iter().zip(direction) {
        let variable = variable::<M>(known)?;
        let name = variable.name;
        if !value.is_finite() {
            return Err(CallError::NotFinite { name, value });
        }
        if let Role::Input(Field::Real { get, set, .. }) = variable.role {
            let moved = get(&seed.inputs) + value;
            set(&mut seed.inputs, moved);
        } else if let Some(place) = state_place(variable) {
            seed.states[place] += value;
        } else {
            return Err(CallError::NotAKnown { name });
        }
    }
    Ok(seed)
}
