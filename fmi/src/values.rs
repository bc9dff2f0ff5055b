//! Getting and setting the values of variables.

use crate::choice_number::{number, set_number, set_parameter};
use crate::continuous::{state_count, state_place};
use crate::error::CallError;
use crate::finite_values::finite;
use crate::input_derivative::{InputDerivative, MAXIMUM_ORDER, continuous};
use crate::instance::Instance;
use crate::lifecycle::Phase;
use crate::model::Model;
use crate::variables::{Field, Role, Signal, Type, Value, ValueReference, Variable, found, variable};

/// As many outputs as are read at once.
const FEW: usize = 16;

impl<M: Model> Instance<M> {
    /// Values of variables of one type, each given to `put` with its place. Nothing is put unless all
    /// references are good.
    pub fn get(
        &mut self,
        value_type: Type,
        references: &[ValueReference],
        mut put: impl FnMut(usize, Value),
    ) -> Result<(), CallError> {
        let mut numbers = [0.0; FEW];
        if value_type == Type::Real && self.reads_finite_outputs(references, &mut numbers) {
            for (place, &number) in numbers.iter().take(references.len()).enumerate() {
                put(place, Value::Real(number));
            }
            return Ok(());
        }
        // Errors are large: what is good, as almost always, is found without a place for one.
        if let Some(&wrong) = references.iter().find(|&&reference| !has_type::<M>(reference, value_type)) {
            typed::<M>(wrong, value_type)?;
        }
        for (place, &reference) in references.iter().enumerate() {
            let Some(variable) = found::<M>(reference) else {
                return Err(CallError::UnknownReference { reference });
            };
            // One that is missing is not finite.
            if let Some(get) = real_output(variable) {
                let number = get(self.prompt_outputs()?);
                if number.is_finite() {
                    put(place, Value::Real(number));
                    continue;
                }
            }
            put(place, self.value(reference, variable)?);
        }
        Ok(())
    }

    /// Reads what mostly is asked for: a few outputs of a run, each of which is found only once. Whether all of them are that, real and
    /// finite.
    fn reads_finite_outputs(&mut self, references: &[ValueReference], numbers: &mut [f64; FEW]) -> bool {
        let is_output = |&reference| found::<M>(reference).and_then(real_output::<M>).is_some();
        if references.len() > FEW || !self.has_run() || !references.first().is_some_and(is_output) {
            return false;
        }
        let Ok(outputs) = self.prompt_outputs() else { return false };
        numbers.iter_mut().zip(references).all(|(number, &reference)| {
            let Some(get) = found::<M>(reference).and_then(real_output::<M>) else { return false };
            *number = get(outputs);
            number.is_finite()
        })
    }

    /// Sets variables of one type to the values that `value` has for their places: all of them or, on an
    /// error, none.
    pub fn set(
        &mut self,
        value_type: Type,
        references: &[ValueReference],
        value: impl Fn(usize) -> Value,
    ) -> Result<(), CallError> {
        let mut settings = self.settings.clone();
        // The continuous states, once one of them is set.
        let mut states: Option<Vec<f64>> = None;
        for (place, &reference) in references.iter().enumerate() {
            let variable = typed::<M>(reference, value_type)?;
            let (name, value) = (variable.name, value(place));
            // A solver may try states beyond the range that they have in a flight.
            if let (Some(place), Value::Real(value)) = (self.settable_state(variable), value) {
                if !value.is_finite() {
                    return Err(CallError::StateNotFinite { name, value });
                }
                let mut present = states.map_or_else(|| self.all_states(), Ok)?;
                present[place] = value;
                states = Some(present);
                continue;
            }
            variable.check_range(value)?;
            let continuous = matches!(variable.role, Role::Input(Field::Real { .. }));
            if self.phase() == Phase::ContinuousTimeMode && !continuous {
                return Err(CallError::OnlyAtEvents { name });
            }
            match &variable.role {
                Role::Input(field) => field.set(&mut settings.inputs, value),
                Role::Parameter { tunable: false, .. } if self.phase().is_running() => {
                    return Err(CallError::Fixed { name });
                }
                Role::Parameter { field, .. } => set_parameter::<M>(&mut settings, variable, field, value),
                Role::Number { .. } if self.phase().is_running() && variable.variability() == "fixed" => {
                    return Err(CallError::Fixed { name });
                }
                Role::Number { of } => {
                    if let Value::Integer(number) = value {
                        set_number::<M>(&mut settings, reference, of, number);
                    }
                }
                Role::Output { .. } => return Err(CallError::ReadOnly { name, kind: "an output" }),
                Role::Derivative { .. } => return Err(CallError::ReadOnly { name, kind: "a derivative" }),
                Role::CalculatedParameter { .. } => {
                    return Err(CallError::ReadOnly { name, kind: "calculated" });
                }
            }
        }
        self.commit(settings)?;
        states.map_or(Ok(()), |states| self.set_continuous_states(&states))
    }

    /// The place of a variable among the continuous states, if it is one and the importer's solver has them: some importers set states
    /// by their value references.
    fn settable_state(&self, variable: &Variable<M>) -> Option<usize> {
        let solved = matches!(self.phase(), Phase::EventMode | Phase::ContinuousTimeMode);
        solved.then(|| state_place(variable)).flatten()
    }

    fn all_states(&mut self) -> Result<Vec<f64>, CallError> {
        let mut present = vec![0.0; state_count::<M>()];
        self.continuous_states(&mut present)?;
        Ok(present)
    }

    /// There are no String variables, so only an empty list of references is good.
    pub fn no_strings(&self, references: &[ValueReference]) -> Result<(), CallError> {
        let Some(&reference) = references.first() else { return Ok(()) };
        variable::<M>(reference)?;
        Err(CallError::NoStrings { reference })
    }

    /// Derivatives of inputs for the next step: all of them or, on an error, none.
    pub fn set_input_derivatives(
        &mut self,
        references: &[ValueReference],
        orders: &[i32],
        values: &[f64],
    ) -> Result<(), CallError> {
        let given = references.iter().zip(orders).zip(values);
        let given = given.map(|((&reference, &order), &value)| InputDerivative { reference, order, value });
        for derivative in given.clone() {
            check_derivative::<M>(&derivative)?;
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

    fn value(&mut self, reference: ValueReference, variable: &Variable<M>) -> Result<Value, CallError> {
        Ok(match &variable.role {
            Role::Input(field) => field.get(&self.settings.inputs),
            Role::Parameter { field, .. } => field.get(&M::as_read(&self.settings.parameters)),
            Role::Number { .. } => Value::Integer(number::<M>(&self.settings, reference)),
            Role::CalculatedParameter { get, .. } => finite(variable, Value::Real(get(self.model()?)))?,
            Role::Output { signal, .. } => finite(variable, signal.get(self.outputs()?))?,
            Role::Derivative { get, .. } => finite(variable, Value::Real(get(self.outputs()?)))?,
        })
    }
}

fn check_derivative<M: Model>(derivative: &InputDerivative) -> Result<(), CallError> {
    let &InputDerivative { reference, order, value } = derivative;
    let name = variable::<M>(reference)?.name;
    if continuous::<M>(reference).is_none() {
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

/// How a variable is read, if it is a real output.
#[inline]
fn real_output<M: Model>(variable: &Variable<M>) -> Option<fn(&M::Outputs) -> f64> {
    match &variable.role {
        Role::Output { signal: Signal::Real { get, .. }, .. } => Some(*get),
        _ => None,
    }
}

/// Whether there is a variable with this reference, and of this type.
#[inline]
fn has_type<M: Model>(reference: ValueReference, asked: Type) -> bool {
    found::<M>(reference).is_some_and(|variable| variable.value_type().of_functions() == asked)
}

/// The variable with this reference, if it has this type.
fn typed<M: Model>(reference: ValueReference, asked: Type) -> Result<&'static Variable<M>, CallError> {
    let variable = variable::<M>(reference)?;
    let declared = variable.value_type();
    if declared.of_functions() == asked {
        Ok(variable)
    } else {
        Err(CallError::WrongType {
            name: variable.name,
            reference,
            declared: declared.name(),
            asked: asked.name(),
        })
    }
}
