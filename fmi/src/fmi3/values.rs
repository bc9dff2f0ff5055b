//! Reading and setting variables, some of which are arrays: their elements follow one another in the values of a call.

use super::types::{Boolean, FALSE, Float64, Int32, Int64, TRUE};
use crate::component::Component;
use crate::error::CallError;
use crate::layout::{Content, Entry, Layout, Number};
use crate::variables::{Type, Value, ValueReference};

type Outcome = Result<(), CallError>;

/// Name of the count of values in all these functions.
const COUNT: &str = "nValues";

/// Values of `Float64` variables, of time and of event indicators.
pub(super) fn get_float64(
    instance: &mut dyn Component,
    layout: &Layout,
    references: &[ValueReference],
    values: &mut [Float64],
) -> Outcome {
    check_types(layout, references, Type::Real, true)?;
    let numbers = layout.numbers(references, COUNT, values.len())?;
    let tabled = (0..).zip(&numbers).filter_map(|(place, number): (usize, _)| match number {
        Number::Variable(reference) => Some((place, *reference)),
        Number::Time | Number::EventIndicator(_) => None,
    });
    let (places, tabled): (Vec<usize>, Vec<ValueReference>) = tabled.unzip();
    let mut indicators = vec![0.0; numbers.iter().filter_map(indicator).max().map_or(0, |last| last + 1)];
    if !indicators.is_empty() {
        instance.event_indicator_values(&mut indicators)?;
    }
    instance.get(Type::Real, &tabled, &mut |tabled, got| {
        if let Value::Real(got) = got {
            values[places[tabled]] = got;
        }
    })?;
    for (value, number) in values.iter_mut().zip(numbers) {
        match number {
            Number::Variable(_) => {}
            Number::Time => *value = instance.time_s(),
            Number::EventIndicator(index) => *value = indicators[index],
        }
    }
    Ok(())
}

/// Values of `Int32` variables.
pub(super) fn get_int32(
    instance: &mut dyn Component,
    layout: &Layout,
    references: &[ValueReference],
    values: &mut [Int32],
) -> Outcome {
    let tabled = tabled(layout, references, Type::Integer, values.len())?;
    instance.get(Type::Integer, &tabled, &mut |place, got| {
        if let Value::Integer(got) = got {
            values[place] = got;
        }
    })
}

/// Values of `Enumeration` variables, which are read as `Int64`.
pub(super) fn get_int64(
    instance: &mut dyn Component,
    layout: &Layout,
    references: &[ValueReference],
    values: &mut [Int64],
) -> Outcome {
    let tabled = tabled(layout, references, Type::Enumeration, values.len())?;
    instance.get(Type::Integer, &tabled, &mut |place, got| {
        if let Value::Integer(got) = got {
            values[place] = Int64::from(got);
        }
    })
}

/// Values of `Boolean` variables.
pub(super) fn get_boolean(
    instance: &mut dyn Component,
    layout: &Layout,
    references: &[ValueReference],
    values: &mut [Boolean],
) -> Outcome {
    let tabled = tabled(layout, references, Type::Boolean, values.len())?;
    instance.get(Type::Boolean, &tabled, &mut |place, got| {
        if let Value::Boolean(got) = got {
            values[place] = boolean(got);
        }
    })
}

/// Sets `Float64` variables.
pub(super) fn set_float64(
    instance: &mut dyn Component,
    layout: &Layout,
    references: &[ValueReference],
    values: &[Float64],
) -> Outcome {
    let tabled = tabled(layout, references, Type::Real, values.len())?;
    instance.set(Type::Real, &tabled, &|place| Value::Real(values[place]))
}

/// Sets `Int32` variables.
pub(super) fn set_int32(
    instance: &mut dyn Component,
    layout: &Layout,
    references: &[ValueReference],
    values: &[Int32],
) -> Outcome {
    let tabled = tabled(layout, references, Type::Integer, values.len())?;
    instance.set(Type::Integer, &tabled, &|place| Value::Integer(values[place]))
}

/// Sets `Enumeration` variables, which are set as `Int64`.
pub(super) fn set_int64(
    instance: &mut dyn Component,
    layout: &Layout,
    references: &[ValueReference],
    values: &[Int64],
) -> Outcome {
    let tabled = tabled(layout, references, Type::Enumeration, values.len())?;
    // A number that no item can have is refused with the others that no item has.
    let item = |value| Int32::try_from(value).unwrap_or(Int32::MAX);
    instance.set(Type::Integer, &tabled, &|place| Value::Integer(item(values[place])))
}

/// Sets `Boolean` variables.
pub(super) fn set_boolean(
    instance: &mut dyn Component,
    layout: &Layout,
    references: &[ValueReference],
    values: &[Boolean],
) -> Outcome {
    let tabled = tabled(layout, references, Type::Boolean, values.len())?;
    instance.set(Type::Boolean, &tabled, &|place| Value::Boolean(values[place] != FALSE))
}

/// There are no variables of a type, so only an empty list of references is good.
pub(super) fn none_of(layout: &Layout, asked: &'static str, references: &[ValueReference]) -> Outcome {
    match references.first() {
        None => Ok(()),
        Some(&reference) => Err(wrong_type(layout.find(reference)?, asked)),
    }
}

/// The elements of variables whose derivatives are asked for, in the table of variables.
pub(super) fn unknowns(
    layout: &Layout,
    references: &[ValueReference],
    argument: &'static str,
    count: usize,
) -> Result<Vec<ValueReference>, CallError> {
    differentiable(layout, references, argument, count, |name| CallError::NotAnUnknown { name })
}

/// The elements of variables that derivatives are taken with respect to, in the table of variables.
pub(super) fn knowns(
    layout: &Layout,
    references: &[ValueReference],
    argument: &'static str,
    count: usize,
) -> Result<Vec<ValueReference>, CallError> {
    differentiable(layout, references, argument, count, |name| CallError::NotAKnown { name })
}

/// Each reference as those of its elements, with the order of the derivative that belongs to it.
pub(super) fn with_orders(
    layout: &Layout,
    references: &[ValueReference],
    orders: &[Int32],
    count: usize,
) -> Result<(Vec<ValueReference>, Vec<Int32>), CallError> {
    let elements = unknowns(layout, references, COUNT, count)?;
    let mut of_elements = Vec::with_capacity(count);
    for (&reference, &order) in references.iter().zip(orders) {
        of_elements.extend(std::iter::repeat_n(order, layout.find(reference)?.length));
    }
    Ok((elements, of_elements))
}

/// The truth value of C.
pub(super) fn boolean(value: bool) -> Boolean {
    if value { TRUE } else { FALSE }
}

/// The elements of variables of one type in the table of variables.
fn tabled(
    layout: &Layout,
    references: &[ValueReference],
    asked: Type,
    count: usize,
) -> Result<Vec<ValueReference>, CallError> {
    check_types(layout, references, asked, false)?;
    Ok(layout.numbers(references, COUNT, count)?.into_iter().filter_map(variable).collect())
}

fn check_types(layout: &Layout, references: &[ValueReference], asked: Type, reads: bool) -> Outcome {
    references.iter().try_for_each(|&reference| {
        let entry = layout.find(reference)?;
        match entry.content {
            Content::Variables(declared) if declared == asked => Ok(()),
            Content::Time | Content::EventIndicators if asked == Type::Real && reads => Ok(()),
            Content::Time if asked == Type::Real => {
                Err(CallError::ReadOnly { name: entry.name, kind: "the independent variable" })
            }
            Content::EventIndicators if asked == Type::Real => {
                Err(CallError::ReadOnly { name: entry.name, kind: "calculated" })
            }
            _ => Err(wrong_type(entry, type_name(asked))),
        }
    })
}

fn wrong_type(entry: &Entry, asked: &'static str) -> CallError {
    let declared = match entry.content {
        Content::Variables(declared) => type_name(declared),
        Content::Time | Content::EventIndicators => type_name(Type::Real),
    };
    CallError::WrongType { name: entry.name, reference: entry.reference, declared, asked }
}

/// The name of a type in FMI 3.0.
fn type_name(of: Type) -> &'static str {
    match of {
        Type::Real => "Float64",
        Type::Integer => "Int32",
        Type::Enumeration => "Enumeration (read and set as Int64)",
        Type::Boolean => "Boolean",
    }
}

fn variable(number: Number) -> Option<ValueReference> {
    match number {
        Number::Variable(reference) => Some(reference),
        Number::Time | Number::EventIndicator(_) => None,
    }
}

fn indicator(number: &Number) -> Option<usize> {
    match number {
        Number::EventIndicator(index) => Some(*index),
        Number::Variable(_) | Number::Time => None,
    }
}

fn differentiable(
    layout: &Layout,
    references: &[ValueReference],
    argument: &'static str,
    count: usize,
    refusal: impl Fn(&'static str) -> CallError,
) -> Result<Vec<ValueReference>, CallError> {
    for &reference in references {
        let entry = layout.find(reference)?;
        if !matches!(entry.content, Content::Variables(_)) {
            return Err(refusal(entry.name));
        }
    }
    Ok(layout.numbers(references, argument, count)?.into_iter().filter_map(variable).collect())
}
