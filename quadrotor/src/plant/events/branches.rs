//! How branches of f(x, u) are chosen.

use super::plant_mode::PlantMode;
use super::switch::Switch;

/// Chooses the branches of f(x, u) while it is calculated.
pub(crate) trait Branches {
    /// Whether a branch that is off by its value need not be looked at.
    const BY_VALUE: bool;

    /// Whether `switch` is on, which it is by its value where `value` is greater than `bound`; `scale` is what their
    /// difference is compared with.
    fn exceeds(&mut self, switch: Switch, value: f64, bound: f64, scale: f64) -> bool;
}

/// By the value: f(x, u) as it is everywhere.
pub(crate) struct ByValue;

impl Branches for ByValue {
    const BY_VALUE: bool = true;

    #[inline(always)]
    fn exceeds(&mut self, _: Switch, value: f64, bound: f64, _: f64) -> bool {
        value > bound
    }
}

/// Those of a mode, whatever the value: smooth.
impl Branches for PlantMode {
    const BY_VALUE: bool = false;

    fn exceeds(&mut self, switch: Switch, _: f64, _: f64, _: f64) -> bool {
        self.is_on(switch)
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

impl Branches for Watched {
    const BY_VALUE: bool = false;

    fn exceeds(&mut self, switch: Switch, value: f64, bound: f64, scale: f64) -> bool {
        let guard = &mut self.guards[switch.index()];
        *guard = Some((value - bound) / scale);
        self.mode.map_or(value > bound, |mode| mode.is_on(switch))
    }
}
