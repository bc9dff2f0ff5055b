//! Getting and setting the values of variables.

use quadrotor::{Inputs, Parameter};

use crate::error::CallError;
use crate::input_derivative::{InputDerivative, MAXIMUM_ORDER, continuous};
use crate::instance::Instance;
use crate::lifecycle::State;
use crate::snapshot::Settings;
use crate::types::{Integer, ValueReference};
use crate::variables::{Role, Type, VARIABLES, Value, Variable, get_parameter, set_parameter, variable};

impl Instance {
    /// Values of variables of one type, each given to `put` with its place. Nothing is put unless all
    /// references are good.
    pub fn get(
        &mut self,
        value_type: Type,
        references: &[ValueReference],
        mut put: impl FnMut(usize, Value),
    ) -> Result<(), CallError> {
        for &reference in references {
            typed(reference, value_type)?;
        }
        for (place, &reference) in references.iter().enumerate() {
            let value = self.value(typed(reference, value_type)?)?;
            put(place, value);
        }
        Ok(())
    }

    /// Sets variables of one type to the values that `value` has for their places: all of them or, on an
    /// error, none.
    pub fn set(
        &mut self,
        value_type: Type,
        references: &[ValueReference],
        value: impl Fn(usize) -> Value,
    ) -> Result<(), CallError> {
        let mut settings = self.settings;
        for (place, &reference) in references.iter().enumerate() {
            let variable = typed(reference, value_type)?;
            let value = value(place);
            variable.check_range(value)?;
            match variable.role {
                Role::Input(input) => input.set(&mut settings.inputs, value),
                Role::Parameter(Parameter { name, tunable: false, .. })
                    if self.state() == State::StepComplete =>
                {
                    return Err(CallError::Fixed { name });
                }
                Role::Parameter(parameter) => {
                    set_parameter(parameter, &mut settings.configuration, value);
                }
                Role::Output(_) | Role::CalculatedParameter(_) => {
                    let (name, causality) = (variable.name, variable.causality());
                    return Err(CallError::NotSettable { name, causality });
                }
            }
        }
        self.commit(&settings)
    }

    /// There are no String variables, so only an empty list of references is good.
    pub fn no_strings(&self, references: &[ValueReference]) -> Result<(), CallError> {
        match references.first() {
            None => Ok(()),
            Some(&reference) if variable(reference).is_none() => {
                Err(CallError::UnknownReference { reference })
            }
            Some(&reference) => Err(CallError::NoStrings { reference }),
        }
    }

    /// Derivatives of inputs for the next step: all of them or, on an error, none.
    pub fn set_input_derivatives(
        &mut self,
        references: &[ValueReference],
        orders: &[Integer],
        values: &[f64],
    ) -> Result<(), CallError> {
        let given = references.iter().zip(orders).zip(values);
        let given = given.map(|((&reference, &order), &value)| InputDerivative { reference, order, value });
        for derivative in given.clone() {
            check_derivative(&derivative)?;
        }
        for derivative in given {
            let same = |known: &&mut InputDerivative| {
                known.reference == derivative.reference && known.order == derivative.order
            };
            match self.derivatives.iter_mut().find(same) {
                Some(known) => *known = derivative,
                None => self.derivatives.push(derivative),
            }
        }
        Ok(())
    }

    fn value(&mut self, variable: &Variable) -> Result<Value, CallError> {
        Ok(match variable.role {
            Role::Input(input) => input.get(&self.settings.inputs),
            Role::Parameter(parameter) => get_parameter(parameter, &self.settings.configuration),
            Role::CalculatedParameter(calculated) => Value::Real((calculated.get)(self.design()?)),
            Role::Output(output) => output.get(self.outputs()?),
        })
    }
}

impl Variable {
    /// Refuses what is not between its smallest and its largest value; NaN never is.
    fn check_range(&self, value: Value) -> Result<(), CallError> {
        let number = |value| match value {
            Value::Real(value) => Some(value),
            Value::Integer(value) => Some(f64::from(value)),
            Value::Boolean(_) => None,
        };
        let (Some(minimum), Some(maximum)) = self.range() else { return Ok(()) };
        match (number(value), number(minimum), number(maximum)) {
            (Some(given), Some(least), Some(most)) if !(least..=most).contains(&given) => {
                Err(CallError::OutOfRange { name: self.name, value, minimum, maximum })
            }
            _ => Ok(()),
        }
    }
}

impl Settings {
    /// Refuses inputs outside their ranges.
    pub fn check(&self) -> Result<(), CallError> {
        let inputs: &Inputs = &self.inputs;
        for variable in &VARIABLES {
            if let Role::Input(input) = variable.role {
                variable.check_range(input.get(inputs))?;
            }
        }
        Ok(())
    }
}

fn check_derivative(derivative: &InputDerivative) -> Result<(), CallError> {
    let &InputDerivative { reference, order, value } = derivative;
    let name = variable(reference).ok_or(CallError::UnknownReference { reference })?.name;
    if continuous(reference).is_none() {
        return Err(CallError::NotContinuousInput { name });
    }
    if !(1..=MAXIMUM_ORDER).contains(&order) {
        return Err(CallError::DerivativeOrder { name, order, maximum: MAXIMUM_ORDER });
    }
    if !value.is_finite() {
        return Err(CallError::DerivativeNotFinite { name, order, value });
    }
    Ok(())
}

/// The variable with this reference, if it has this type.
fn typed(reference: ValueReference, asked: Type) -> Result<&'static Variable, CallError> {
    let variable = variable(reference).ok_or(CallError::UnknownReference { reference })?;
    let declared = variable.value_type();
    if declared.of_functions() == asked {
        Ok(variable)
    } else {
        Err(CallError::WrongType { name: variable.name, reference, declared, asked })
    }
}
