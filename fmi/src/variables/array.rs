//! Variables that belong together, as the arrays of FMI 3.0.

use super::ValueReference;
use crate::model::Model;

/// Neighbours in the table that FMI 3.0 reads and sets as one variable; FMI 2.0 has no arrays.
///
/// They have the same type, causality, variability and unit; those that can be set also have the same range.
#[derive(Clone, Copy, Debug)]
pub struct Array {
    /// Structured name.
    pub name: &'static str,
    /// Human-readable description, with the meaning of the elements in their order.
    pub description: &'static str,
    /// Names of the elements, in the order of the table.
    pub components: &'static [&'static str],
}

impl Array {
    /// An array.
    pub const fn new(
        name: &'static str,
        description: &'static str,
        components: &'static [&'static str],
    ) -> Self {
        Self { name, description, components }
    }
}

/// An [`Array`] whose elements have the names of a stem and their endings. It is called as the stem unless another name is given.
///
/// ```
/// let position = fmi::array!("position", [".x", ".y", ".z"], "Position: north, east, down");
/// assert_eq!(position.name, "position");
/// assert_eq!(position.components, ["position.x", "position.y", "position.z"]);
/// let quaternion = fmi::array!("attitude.q" as "quaternion", ["0", "1", "2", "3"], "Attitude quaternion");
/// assert_eq!((quaternion.name, quaternion.components[0]), ("quaternion", "attitude.q0"));
/// ```
#[macro_export]
macro_rules! array {
    ($stem:literal, [$($ending:literal),+], $description:literal) => {
        $crate::array!($stem as $stem, [$($ending),+], $description)
    };
    ($stem:literal as $name:literal, [$($ending:literal),+], $description:literal) => {
        $crate::variables::Array::new($name, $description, &[$(concat!($stem, $ending)),+])
    };
}

/// Fails to compile if the elements of an array are not neighbours in the table.
pub(crate) const fn check_arrays<M: Model>() {
    let mut group = 0;
    while group < M::ARRAYS.len() {
        let mut i = 0;
        while i < M::ARRAYS[group].len() {
            check_array::<M>(&M::ARRAYS[group][i]);
            i += 1;
        }
        group += 1;
    }
}

const fn check_array<M: Model>(array: &Array) {
    let Some(first) = first_place::<M>(array) else {
        panic!("the first element of an array is not in the table of variables")
    };
    let mut j = 1;
    while j < array.components.len() {
        let neighbour = match name_at::<M>(first + j) {
            Some(name) => are_equal(name, array.components[j]),
            None => false,
        };
        assert!(neighbour, "the elements of an array must be neighbours in the table of variables");
        j += 1;
    }
}

/// All arrays of a model.
pub(crate) fn arrays<M: Model>() -> impl Iterator<Item = &'static Array> {
    M::ARRAYS.iter().copied().flatten()
}

/// The value reference of an array: that of its first element.
pub(crate) fn reference_of<M: Model>(array: &Array) -> Option<ValueReference> {
    first_place::<M>(array).and_then(|place| ValueReference::try_from(place).ok())
}

/// The place of the first element in the table.
const fn first_place<M: Model>(array: &Array) -> Option<usize> {
    let [first, ..] = array.components else { return None };
    let mut place = 0;
    while let Some(name) = name_at::<M>(place) {
        if are_equal(name, first) {
            return Some(place);
        }
        place += 1;
    }
    None
}

/// The name of the variable at a place of the table.
const fn name_at<M: Model>(mut place: usize) -> Option<&'static str> {
    let mut group = 0;
    while group < M::VARIABLES.len() {
        let variables = M::VARIABLES[group];
        if place < variables.len() {
            return Some(variables[place].name);
        }
        place -= variables.len();
        group += 1;
    }
    None
}

/// `==` for constants.
const fn are_equal(a: &str, b: &str) -> bool {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    if a.len() != b.len() {
        return false;
    }
    let mut i = 0;
    while i < a.len() {
        if a[i] != b[i] {
            return false;
        }
        i += 1;
    }
    true
}
