//! The table of variables: the one source of value references, names, types, ranges, start values and units.

mod access;
mod allowed;
mod array;
mod quantity;
mod terminal;
mod value;
mod variable;

pub use access::{Field, Signal};
pub use array::Array;
pub(crate) use array::{arrays, check_arrays, reference_of};
pub use quantity::{Choice, Quantity, Unit};
pub use terminal::{Matching, Terminal};
pub use value::{Type, Value};
pub use variable::{Role, ValueReference, Variable};
pub(crate) use variable::{found, named, variable, variables};
