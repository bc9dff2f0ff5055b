//! Rejects what a model calculates when it is not finite: no importer gets NaN or an infinity in silence.

use crate::error::CallError;
use crate::model::Model;
use crate::variables::{Role, Value, Variable, variables};

/// Rejects the first calculated parameter that is not finite.
pub(crate) fn check_calculated<M: Model>(model: &M) -> Result<(), CallError> {
    variables::<M>().try_for_each(|(_, variable)| match &variable.role {
        Role::CalculatedParameter { get, .. } => finite(variable, Value::Real(get(model))).map(drop),
        _ => Ok(()),
    })
}

/// Rejects the first output that is not finite.
pub(crate) fn check_outputs<M: Model>(outputs: &M::Outputs) -> Result<(), CallError> {
    if M::are_finite(outputs) {
        return Ok(());
    }
    let groups = const { groups_with_outputs::<M>() };
    groups.iter().flat_map(|group| group.iter()).try_for_each(|variable| match &variable.role {
        Role::Output { signal, .. } => finite(variable, signal.get(outputs)).map(drop),
        Role::Derivative { get, .. } => finite(variable, Value::Real(get(outputs))).map(drop),
        _ => Ok(()),
    })
}

/// The groups of the table from the first with an output to the last: looking at the parameters at each step takes longer than most
/// steps.
const fn groups_with_outputs<M: Model>() -> &'static [&'static [Variable<M>]] {
    let groups = M::VARIABLES;
    let (mut first, mut end, mut group) = (groups.len(), 0, 0);
    while group < groups.len() {
        let mut variable = 0;
        while variable < groups[group].len() {
            if matches!(groups[group][variable].role, Role::Output { .. } | Role::Derivative { .. }) {
                if group < first {
                    first = group;
                }
                end = group + 1;
            }
            variable += 1;
        }
        group += 1;
    }
    if first >= end {
        return &[];
    }
    groups.split_at(end).0.split_at(first).1
}

/// The value of a variable, if it is finite.
pub(crate) fn finite<M: Model>(variable: &Variable<M>, value: Value) -> Result<Value, CallError> {
    match value {
        Value::Real(number) if !number.is_finite() => {
            Err(CallError::NotFinite { name: variable.name, value: number })
        }
        _ => Ok(value),
    }
}

#[cfg(test)]
mod tests {
    use super::CallError;
    use crate::instance::Instance;
    use crate::lifecycle::Phase;
    use crate::logger::Logger;
    use crate::model::{Experiment, Identity, Model, SavedStateFormat, Words};
    use crate::variables::{Field, Quantity, Signal, Type, Value, Variable};

    /// A population that doubles each second, and the reciprocal of a parameter.
    #[derive(Debug)]
    struct Growth {
        divisor: f64,
        time_us: u64,
    }

    const NUMBER: Quantity =
        Quantity { name: "Number", description: "A number", unit: None, display_unit: None, nominal: 1.0 };
    const POPULATION: u32 = 1;
    const DIVISOR: u32 = 2;
    const RECIPROCAL: u32 = 3;

    impl Model for Growth {
        const IDENTITY: Identity = Identity {
            name: "Growth",
            model_identifier: "growth",
            description: "",
            version: "1",
            author: "",
            copyright: "",
            license: "",
            generation_tool: "",
            date: "",
            default_experiment: Experiment { stop_time_s: 1.0, step_size_s: 1.0 },
            longest_step_s: 1e4,
            saved_state: SavedStateFormat { magic: *b"GROWTHST", version: 1 },
            words: Words::GENERAL,
        };
        const VARIABLES: &'static [&'static [Variable<Self>]] = &[&[
            Variable::output(
                "time",
                "",
                &[],
                Signal::Real {
                    quantity: &NUMBER,
                    minimum: None,
                    maximum: None,
                    get: |outputs: &(f64, f64)| outputs.0,
                },
            ),
            Variable::output(
                "population",
                "",
                &[],
                Signal::Real {
                    quantity: &NUMBER,
                    minimum: None,
                    maximum: None,
                    get: |outputs: &(f64, f64)| outputs.1,
                },
            ),
            Variable::tunable(
                "divisor",
                "",
                Field::Real {
                    quantity: &NUMBER,
                    minimum: 0.0,
                    maximum: 1.0,
                    get: |parameter| *parameter,
                    set: |parameter, value| *parameter = value,
                },
            ),
            Variable::calculated("reciprocal", "", &["divisor"], &NUMBER, |model| model.divisor.recip()),
        ]];
        type Parameters = f64;
        type Inputs = ();
        type State = u64;
        type Outputs = (f64, f64);
        type Error = String;

        fn new(divisor: &f64, (): &()) -> Result<Self, String> {
            Ok(Self { divisor: *divisor, time_us: 0 })
        }

        fn from_state(divisor: &f64, time_us: &u64) -> Result<Self, String> {
            Ok(Self { divisor: *divisor, time_us: *time_us })
        }

        fn state(&self) -> u64 {
            self.time_us
        }

        fn time_us(&self) -> u64 {
            self.time_us
        }

        fn advance_to(&mut self, time_us: u64, _inputs: &impl Fn(u64)) -> Result<(), String> {
            self.time_us = time_us;
            Ok(())
        }

        fn outputs(&self) -> (f64, f64) {
            let time_s = self.time_us as f64 * 1e-6;
            (time_s, time_s.exp2())
        }
    }

    /// With a divisor of 1.
    fn stepping() -> Instance<Growth> {
        let mut instance =
            Instance::new(crate::lifecycle::Kind::CoSimulation, Logger::new(Box::new(|_, _| ()), false));
        set_divisor(&mut instance, 1.0).expect("an instance takes values");
        instance.enter_initialization_mode().expect("it is new");
        instance.exit_initialization_mode().expect("all values are finite");
        instance
    }

    fn set_divisor(instance: &mut Instance<Growth>, value: f64) -> Result<(), CallError> {
        instance.set(Type::Real, &[DIVISOR], |_| Value::Real(value))
    }

    fn real(instance: &mut Instance<Growth>, reference: u32) -> Result<f64, CallError> {
        let mut value = f64::NAN;
        instance.get(Type::Real, &[reference], |_, got| {
            if let Value::Real(got) = got {
                value = got;
            }
        })?;
        Ok(value)
    }

    #[test]
    fn an_output_that_overflows_ends_the_run_and_is_named() {
        let mut instance = stepping();
        instance.do_step(0.0, 1000.0).expect("2^1000 is finite");
        let error = instance.do_step(1000.0, 24.0).expect_err("2^1024 is not");
        assert_eq!(
            error.to_string(),
            "the simulation cannot continue: population is inf, not a finite number"
        );
        assert_eq!((instance.phase(), instance.time_s()), (Phase::Error, 1000.0));
        // The others can be read.
        assert_eq!(real(&mut instance, 0), Ok(1024.0));
        let refusal = CallError::NotFinite { name: "population", value: f64::INFINITY };
        assert_eq!(real(&mut instance, POPULATION), Err(refusal));
    }

    #[test]
    fn a_calculated_parameter_that_overflows_is_refused_and_changes_nothing() {
        let refusal = || Err(CallError::NotFinite { name: "reciprocal", value: f64::INFINITY });
        let mut instance = stepping();
        instance.do_step(0.0, 3.0).expect("a step");
        assert_eq!(set_divisor(&mut instance, 0.0), refusal());
        assert_eq!(real(&mut instance, RECIPROCAL), Ok(1.0));
        assert_eq!(real(&mut instance, POPULATION), Ok(8.0));
        set_divisor(&mut instance, 0.5).expect("it is finite");
        assert_eq!(real(&mut instance, RECIPROCAL), Ok(2.0));

        instance.reset().expect("it can always be reset");
        set_divisor(&mut instance, 0.0).expect("values are checked together");
        instance.enter_initialization_mode().expect("it is new");
        assert_eq!(instance.exit_initialization_mode(), refusal());
        set_divisor(&mut instance, 1.0).expect("initialization mode continues");
        instance.exit_initialization_mode().expect("all values are finite");
    }
}
