//! The plant's equations for several vehicles at once.

use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use num_traits::{One, Zero};
use wide::f64x4;

use crate::plant::differentiation::real::Real;
use crate::plant::events::branches::Branches;
use crate::plant::events::switch::Switch;

/// How many vehicles are calculated at once.
pub(crate) const LANES: usize = 4;

/// A number of each of several vehicles. All operations are those of `f64`, lane by lane, so that each vehicle has the doubles that it
/// would have alone.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lanes(f64x4);

impl Lanes {
    /// Of these numbers.
    #[inline(always)]
    pub(crate) fn new(numbers: [f64; LANES]) -> Self {
        Self(f64x4::new(numbers))
    }

    /// The numbers.
    #[inline(always)]
    pub(crate) fn numbers(self) -> [f64; LANES] {
        self.0.to_array()
    }
}

/// In all lanes.
impl PartialEq for Lanes {
    fn eq(&self, other: &Self) -> bool {
        self.numbers() == other.numbers()
    }
}

impl Zero for Lanes {
    #[inline(always)]
    fn zero() -> Self {
        Self::constant(0.0)
    }

    fn is_zero(&self) -> bool {
        *self == Self::zero()
    }
}

impl One for Lanes {
    #[inline(always)]
    fn one() -> Self {
        Self::constant(1.0)
    }
}

impl Neg for Lanes {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

/// An operation, and its assignment, with lanes and with the same number for each.
macro_rules! operation {
    ($operation:ident, $method:ident, $assignment:ident, $assigned:ident) => {
        impl $operation for Lanes {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        }

        impl $operation<f64> for Lanes {
            type Output = Self;

            #[inline(always)]
            fn $method(self, constant: f64) -> Self {
                Self(self.0.$method(f64x4::splat(constant)))
            }
        }

        impl $assignment for Lanes {
            #[inline(always)]
            fn $assigned(&mut self, other: Self) {
                *self = self.$method(other);
            }
        }
    };
}

operation!(Add, add, AddAssign, add_assign);
operation!(Sub, sub, SubAssign, sub_assign);
operation!(Mul, mul, MulAssign, mul_assign);
operation!(Div, div, DivAssign, div_assign);

impl Real for Lanes {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self(f64x4::splat(value))
    }

    #[inline(always)]
    fn where_greater(self, bound: Self, then: Self, otherwise: Self) -> Self {
        Self(self.0.simd_gt(bound.0).select(then.0, otherwise.0))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.abs())
    }

    fn hypot(self, other: Self) -> Self {
        let (x, y) = (self.numbers(), other.numbers());
        Self::new(core::array::from_fn(|lane| libm::hypot(x[lane], y[lane])))
    }
}

/// By the values, as long as all vehicles take the same branch.
pub(crate) struct Unanimous {
    agreed: bool,
}

impl Unanimous {
    /// Before the first branch.
    pub(crate) fn new() -> Self {
        Self { agreed: true }
    }

    /// Whether the vehicles have taken the same branches: if not, what was calculated means nothing.
    pub(crate) fn have_agreed(&self) -> bool {
        self.agreed
    }
}

impl Branches<Lanes> for Unanimous {
    #[inline(always)]
    fn exceeds(&mut self, _: Switch, value: Lanes, bound: Lanes, _: f64) -> bool {
        let exceeding = value.0.simd_gt(bound.0);
        let (all, any) = (exceeding.all(), exceeding.any());
        self.agreed &= all == any;
        all
    }

    #[inline(always)]
    fn may_skip(&self, value: Lanes, bound: f64) -> bool {
        value.0.simd_le(f64x4::splat(bound)).all()
    }
}
