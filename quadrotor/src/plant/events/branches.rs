//! How branches of f(x, u) are chosen.

use super::plant_mode::PlantMode;
use super::switch::Switch;
use crate::plant::differentiation::real::{Real, Valued};

/// Chooses the branches of f(x, u) while it is calculated.
pub(crate) trait Branches<T: Real> {
    /// Whether `switch` is on, which it is by its value where `value` is greater than `bound`; `scale` is what their
    /// difference is compared with.
    fn exceeds(&mut self, switch: Switch, value: T, bound: T, scale: f64) -> bool;

    /// Whether branches that are off by their values while `value` is not greater than `bound` need not be looked at.
    fn may_skip(&self, value: T, bound: f64) -> bool;
}

/// By the value: f(x, u) as it is everywhere.
pub(crate) struct ByValue;

impl<T: Valued> Branches<T> for ByValue {
    #[inline(always)]
    fn exceeds(&mut self, _: Switch, value: T, bound: T, _: f64) -> bool {
        value.value() > bound.value()
    }

    #[inline(always)]
    fn may_skip(&self, value: T, bound: f64) -> bool {
        value.value() <= bound
    }
}

/// Those of a mode, whatever the value: smooth.
impl<T: Real> Branches<T> for PlantMode {
    fn exceeds(&mut self, switch: Switch, _: T, _: T, _: f64) -> bool {
        self.is_on(switch)
    }

    fn may_skip(&self, _: T, _: f64) -> bool {
        false
    }
}

/// Those of a mode, or by the value without one, and remembers how far from its bound each value was.
pub(crate) struct Watched {
    mode: Option<PlantMode>,
    /// (value − bound)/scale of each switch that was asked for.
    guards: [Option<f64>; Switch::COUNT],
}

impl Watched {
    /// Branches of a mode.
    pub(crate) fn in_mode(mode: Option<PlantMode>) -> Self {
        Self { mode, guards: [None; Switch::COUNT] }
    }

    /// How far each switch is from being switched: positive where it is on by its value, nothing where it does not matter.
    pub(crate) fn guards(&self) -> &[Option<f64>; Switch::COUNT] {
        &self.guards
    }
}

impl Branches<f64> for Watched {
    fn exceeds(&mut self, switch: Switch, value: f64, bound: f64, scale: f64) -> bool {
        let guard = &mut self.guards[switch.index()];
        *guard = Some((value - bound) / scale);
        self.mode.map_or(value > bound, |mode| mode.is_on(switch))
    }

    fn may_skip(&self, _: f64, _: f64) -> bool {
        false
    }
}
