//! Directional derivatives, and time derivatives of outputs.

use crate::continuous::{Seed, equations, real_signal, states};
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
        let equations = equations::<M>().map_err(|_| {
            CallError::NotOffered(
                "directional derivatives are not available (providesDirectionalDerivative = false)",
            )
        })?;
        let signals = unknowns.iter().map(|&unknown| {
            let variable = variable::<M>(unknown)?;
            real_signal(variable).ok_or(CallError::NotAnUnknown { name: variable.name })
        });
        let signals = signals.collect::<Result<Vec<_>, _>>()?;
        let (model, inputs) = self.run()?;
        let seed = seed::<M>(inputs, knowns, direction)?;
        let tangent = equations.tangent(model, inputs, &seed);
        for ((into, signal), &unknown) in into.iter_mut().zip(signals).zip(unknowns) {
            let value = signal(&tangent);
            if !value.is_finite() {
                return Err(CallError::NoDerivative { name: variable::<M>(unknown)?.name, value });
            }
            *into = value;
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

/// The direction in the space of states and inputs. A variable that is named twice counts twice.
fn seed<M: Model>(
    inputs: &M::Inputs,
    knowns: &[ValueReference],
    direction: &[f64],
) -> Result<Seed<M>, CallError> {
    let mut seed = Seed::<M> { states: vec![0.0; states::<M>().count()], inputs: inputs.clone() };
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
        } else if let Some(state) = states::<M>().position(|state| state.reference == known) {
            seed.states[state] += value;
        } else {
            return Err(CallError::NotAKnown { name });
        }
    }
    Ok(seed)
}
