//! The one shape of a control step.

use crate::{ControllerState, Precision, Sample, Step};

/// A receding-horizon control law for a plant of N states, P inputs and Q outputs: a sample in, a step out.
///
/// The law itself is immutable. What it remembers from one sample to the next is a [`ControllerState`], which the
/// caller owns, copies and saves; its W is the number of active limits that it has room for, its K that of unknowns whose
/// factors it keeps. All laws share it, so that a program can choose among them at run time through `&dyn Controller<N, P, Q, W>`.
///
/// | law | what of the [`Sample`] it reads |
/// | --- | --- |
/// | [`StateFeedback`](crate::StateFeedback) | `increment`, `error`, `input_reference` |
/// | [`LaguerreMpc`](crate::LaguerreMpc) | the same, `upper`, and `measured` for limits of the state |
/// | … [`with_model_increment`](crate::LaguerreMpc::with_model_increment) | `deviation` and `disturbance` instead of `increment` |
/// | [`StateSpaceMpc`](crate::StateSpaceMpc) | `deviation`, `disturbance`, `input_reference`, `preview`, `upper` |
///
/// Each remembers `measured`, and holds its input when that is not finite. A step allocates nothing and does not panic,
/// whatever the numbers are.
pub trait Controller<
    const N: usize,
    const P: usize,
    const Q: usize,
    const W: usize,
    T: Precision = f64,
    const K: usize = 0,
>
{
    /// One sample: from what is known at sample k to u(k), which the state takes as applied. Report a different
    /// input with [`ControllerState::apply`] before the next sample.
    fn step(&self, state: &mut ControllerState<N, P, W, T, K>, sample: &Sample<'_, N, P, Q, T>)
    -> Step<P, T>;
}
