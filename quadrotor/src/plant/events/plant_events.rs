//! The plant for an integrator that stops at events.

use super::branches::Watched;
use super::plant_mode::PlantMode;
use super::switch::Switch;
use crate::plant::differentiation::real::{Real, Valued};
use crate::plant::dynamics::{held, hold};
use crate::{Plant, PlantInputs, PlantOutputs, PlantState};

/// How far beyond its bound a switch is switched, as a share of what is usual: rounding and the error of locating an event do
/// not switch it back.
const HYSTERESIS: f64 = 1e-9;
/// How often an event is looked at again, as far as switches depend on one another: the load of a foot, its slip, static
/// friction, and what stopping changes.
const PASSES: usize = 8;

/// f(x, u) from event to event: smooth within a [`PlantMode`]. Integrate [`Plant::derivative_in`]; when a component of
/// [`Plant::event_indicators`] changes its sign, go on with the mode and state of [`Plant::event`].
///
/// [`Plant::step`] follows the same rules with steps of its own, but decides static friction at the beginning of each step.
impl Plant {
    /// The mode that a state is in under these inputs: where an integration starts, together with
    /// [`Plant::event`], which stops a vehicle that static friction holds.
    pub fn mode(&self, state: &PlantState, inputs: &PlantInputs) -> PlantMode {
        let mut mode = PlantMode::default();
        for (index, guard) in self.guards(None, state, inputs).into_iter().enumerate() {
            mode = mode.with(index, guard.is_some_and(|guard| guard > 0.0));
        }
        mode
    }

    /// f(x, u) in a mode, whatever the state: the time derivative, smooth. In a vehicle that static friction holds, place and
    /// heading and their rates do not change.
    pub fn derivative_in<T: Real>(
        &self,
        mode: PlantMode,
        state: &PlantState<T>,
        inputs: &PlantInputs<T>,
    ) -> PlantState<T> {
        let derivative = self.forces(state, inputs, &mut { mode }).derivative(self.mass(), state);
        if mode.is_on(Switch::Held) { held(derivative) } else { derivative }
    }

    /// What can be observed in a mode.
    pub fn outputs_in<T: Valued>(
        &self,
        mode: PlantMode,
        state: &PlantState<T>,
        inputs: &PlantInputs<T>,
    ) -> PlantOutputs<T> {
        self.observed(state, inputs, mode.is_on(Switch::Held), &mut { mode })
    }

    /// Dimensionless numbers, one for each [`Switch`], that are positive where it is on and change their signs where the mode
    /// has to change, which is a billionth beyond the bound. A switch that does not matter, such as the slip of a foot in the
    /// air, has a constant.
    pub fn event_indicators(
        &self,
        mode: PlantMode,
        state: &PlantState,
        inputs: &PlantInputs,
    ) -> [f64; Switch::COUNT] {
        let guards = self.guards(Some(mode), state, inputs);
        core::array::from_fn(|index| {
            let on = mode.has(index);
            guards[index].map_or(if on { 1.0 } else { -1.0 }, |guard| shifted(guard, on))
        })
    }

    /// The mode and the state after an event: switches whose indicators have changed their signs are switched, and those that
    /// matter now are set. A vehicle that static friction holds, or begins to hold, stops. Otherwise the state stays, and
    /// without an event the mode does.
    pub fn event(
        &self,
        mode: PlantMode,
        state: &PlantState,
        inputs: &PlantInputs,
    ) -> (PlantMode, PlantState) {
        let (mut mode, mut state) = (mode, *state);
        let mut known = self.guards(Some(mode), &state, inputs).map(|guard| guard.is_some());
        for _ in 0..PASSES {
            let guards = self.guards(Some(mode), &state, inputs);
            let next = next_mode(mode, &guards, &known);
            let mut after = state;
            if next.is_on(Switch::Held) {
                hold(&mut after);
            }
            if (next, after) == (mode, state) {
                break;
            }
            known = core::array::from_fn(|index| known[index] || guards[index].is_some());
            (mode, state) = (next, after);
        }
        (mode, state)
    }

    /// How far each switch is from being switched, in a mode or by the values.
    fn guards(
        &self,
        mode: Option<PlantMode>,
        state: &PlantState,
        inputs: &PlantInputs,
    ) -> [Option<f64>; Switch::COUNT] {
        let mut watched = Watched::in_mode(mode);
        // All that looks at branches.
        self.observed(state, inputs, false, &mut watched);
        let mut guards = *watched.guards();
        if self.has_ground() {
            let margins = self.holding_margins(state, inputs);
            guards[Switch::Held.index()] = Some(margins.least(self.airframe()));
        }
        guards
    }
}

/// Switches that matter, switched beyond their hysteresis if they were `known` to matter before.
fn next_mode(
    mode: PlantMode,
    guards: &[Option<f64>; Switch::COUNT],
    known: &[bool; Switch::COUNT],
) -> PlantMode {
    (0..Switch::COUNT).fold(PlantMode::default(), |next, index| {
        let shift = |guard: f64| if known[index] { shifted(guard, mode.has(index)) } else { guard };
        next.with(index, guards[index].is_some_and(|guard| shift(guard) > 0.0))
    })
}

/// The guard of a switch, which is switched a little beyond its bound.
fn shifted(guard: f64, on: bool) -> f64 {
    guard + if on { HYSTERESIS } else { -HYSTERESIS }
}
