//! The variables as FMI 3.0 has them: some are arrays, and time and the event indicators are variables, too.

use crate::error::CallError;
use crate::model::Model;
use crate::variables::{Type, ValueReference, arrays, reference_of, variables};

/// Name of the independent variable.
pub(crate) const TIME: &str = "time";
/// Name of the array of event indicators.
pub(crate) const EVENT_INDICATORS: &str = "event_indicator";

/// One variable of FMI 3.0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Entry {
    /// Its value reference: for variables of the table that of the first element.
    pub reference: ValueReference,
    /// Structured name.
    pub name: &'static str,
    /// Number of its elements: 1 for a scalar.
    pub length: usize,
    /// Whether it is an array, which may have one element.
    pub is_array: bool,
    /// What its elements are.
    pub content: Content,
}

/// What the elements of a variable are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Content {
    /// Neighbours in the table of variables.
    Variables(Type),
    /// The independent variable.
    Time,
    /// All event indicators.
    EventIndicators,
}

/// One number of a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Number {
    /// A variable of the table.
    Variable(ValueReference),
    /// The independent variable.
    Time,
    /// The event indicator of this index.
    EventIndicator(usize),
}

/// All variables by their value references.
#[derive(Clone, Debug)]
pub(crate) struct Layout {
    entries: Vec<Entry>,
}

impl Layout {
    /// The variables of `M`: those of the table, then time, then the event indicators.
    pub fn of<M: Model>() -> Self {
        let arrays: Vec<_> =
            arrays::<M>().filter_map(|array| Some((reference_of::<M>(array)?, array))).collect();
        let mut entries: Vec<Entry> = Vec::new();
        let mut next = 0;
        for (reference, variable) in variables::<M>() {
            if reference < next {
                continue;
            }
            let array = arrays.iter().find(|(first, _)| *first == reference).map(|(_, array)| array);
            let length = array.map_or(1, |array| array.components.len());
            entries.push(Entry {
                reference,
                name: array.map_or(variable.name, |array| array.name),
                length,
                is_array: array.is_some(),
                content: Content::Variables(variable.value_type()),
            });
            next = following(reference, length);
        }
        let time = Entry { reference: next, name: TIME, length: 1, is_array: false, content: Content::Time };
        entries.push(time);
        let indicators = M::CONTINUOUS.map_or(0, |equations| equations.event_indicators());
        if indicators > 0 {
            entries.push(Entry {
                reference: following(next, 1),
                name: EVENT_INDICATORS,
                length: indicators,
                is_array: true,
                content: Content::EventIndicators,
            });
        }
        Self { entries }
    }

    /// All of them, by increasing reference.
    #[cfg(feature = "description")]
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// The reference of the variable that a variable of the table is, or is an element of.
    #[cfg(feature = "description")]
    pub fn whole(&self, reference: ValueReference) -> Option<ValueReference> {
        match self.find(reference) {
            Ok(entry) => Some(entry.reference),
            Err(CallError::InsideArray { first, .. }) => Some(first),
            Err(_) => None,
        }
    }

    /// The variable with this reference.
    pub fn find(&self, reference: ValueReference) -> Result<&Entry, CallError> {
        let unknown = CallError::UnknownReference { reference };
        let behind = self.entries.partition_point(|entry| entry.reference <= reference);
        let Some(entry) = behind.checked_sub(1).and_then(|place| self.entries.get(place)) else {
            return Err(unknown);
        };
        if entry.reference == reference {
            return Ok(entry);
        }
        match entry.content {
            Content::Variables(_) if reference < following(entry.reference, entry.length) => {
                Err(CallError::InsideArray { reference, array: entry.name, first: entry.reference })
            }
            _ => Err(unknown),
        }
    }

    /// The numbers of all these variables, one variable after the other. There must be `count` of them.
    pub fn numbers(
        &self,
        references: &[ValueReference],
        argument: &'static str,
        count: usize,
    ) -> Result<Vec<Number>, CallError> {
        let mut numbers = Vec::with_capacity(count);
        for &reference in references {
            numbers.extend(self.find(reference)?.numbers());
        }
        match numbers.len() {
            expected if expected == count => Ok(numbers),
            expected => Err(CallError::Count { argument, given: count, expected }),
        }
    }
}

impl Entry {
    /// Its elements.
    pub fn numbers(self) -> impl Iterator<Item = Number> {
        (0..self.length).map(move |place| match self.content {
            Content::Variables(_) => Number::Variable(following(self.reference, place)),
            Content::Time => Number::Time,
            Content::EventIndicators => Number::EventIndicator(place),
        })
    }
}

/// The reference `count` places behind another.
fn following(reference: ValueReference, count: usize) -> ValueReference {
    ValueReference::try_from(count).map_or(ValueReference::MAX, |count| reference.saturating_add(count))
}
