//! Exact motion between two samples, under a command that is held.

use alloc::vec::Vec;

use lmpc::{DesignError, Discretization, StateSpace};
use nalgebra::{DMatrix, SMatrix, SVector};

use crate::{Configuration, GRAVITY_M_S2};

/// The motion of N values over a fixed time. The last one is the command, which is held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Motion<const N: usize> {
    transition: SMatrix<f64, N, N>,
}

impl<const N: usize> Motion<N> {
    /// That of ẋ = A x, the last row of which is zero, over `duration_s`.
    fn new(a: &SMatrix<f64, N, N>, duration_s: f64) -> Result<Self, DesignError> {
        let (states, command) = (N - 1, N - 1);
        let plant = StateSpace::from_continuous(
            &DMatrix::from_fn(states, states, |row, column| a[(row, column)]),
            &DMatrix::from_fn(states, 1, |row, _| a[(row, command)]),
            &DMatrix::identity(states, states),
            duration_s,
            Discretization::ZeroOrderHold,
        )?;
        Ok(Self {
            transition: SMatrix::from_fn(|row, column| match (row < states, column < states) {
                (true, true) => plant.a()[(row, column)],
                (true, false) => plant.b()[(row, 0)],
                (false, true) => 0.0,
                (false, false) => 1.0,
            }),
        })
    }

    /// The values at the end of it.
    pub(crate) fn after(&self, values: [f64; N]) -> [f64; N] {
        (self.transition * SVector::from(values)).into()
    }
}

/// Angle, rate, angular acceleration of the rotors' torque, and the commanded one. The torque acts together with its rate of
/// change times a lead, s: on yaw, the reaction to the spin-up of the rotors.
pub(crate) fn rotation(
    configuration: &Configuration,
    lead_s: f64,
    duration_s: f64,
) -> Result<Motion<4>, DesignError> {
    let lag = 1.0 / configuration.airframe.mean_rotor_lag_s();
    let mut a = SMatrix::zeros();
    // φ̇ = ω,  ω̇ = α + T α̇,  α̇ = (α_c − α)/τ
    (a[(0, 1)], a[(1, 2)], a[(1, 3)]) = (1.0, 1.0 - lead_s * lag, lead_s * lag);
    (a[(2, 2)], a[(2, 3)]) = (-lag, lag);
    Motion::new(&a, duration_s)
}

/// Position, velocity, angle, rate, angular acceleration and the commanded one, along a horizontal axis (0 or 1).
pub(crate) fn horizontal(
    configuration: &Configuration,
    axis: usize,
    duration_s: f64,
) -> Result<Motion<6>, DesignError> {
    let airframe = &configuration.airframe;
    let (lag, drag) =
        (1.0 / airframe.mean_rotor_lag_s(), airframe.hover_drag_n_s_m()[axis] / airframe.mass_kg);
    let mut a = SMatrix::zeros();
    // ẋ = v,  v̇ = g φ − d v/m: under the thrust of hover
    (a[(0, 1)], a[(1, 2)], a[(1, 1)]) = (1.0, GRAVITY_M_S2, -drag);
    (a[(2, 3)], a[(3, 4)], a[(4, 4)], a[(4, 5)]) = (1.0, 1.0, -lag, lag);
    Motion::new(&a, duration_s)
}

/// Position down, velocity, acceleration by the rotors' thrust, and the commanded one.
pub(crate) fn vertical(configuration: &Configuration, duration_s: f64) -> Result<Motion<4>, DesignError> {
    let airframe = &configuration.airframe;
    let (lag, drag) = (1.0 / airframe.mean_rotor_lag_s(), airframe.hover_drag_n_s_m()[2] / airframe.mass_kg);
    let mut a = SMatrix::zeros();
    // ż = w,  ẇ = f − d w/m,  ḟ = (f_c − f)/τ
    (a[(0, 1)], a[(1, 2)], a[(1, 1)], a[(2, 2)], a[(2, 3)]) = (1.0, 1.0, -drag, -lag, lag);
    Motion::new(&a, duration_s)
}

/// One motion per different duration of some events, µs, and which of them each event has.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Motions<const N: usize> {
    motions: Vec<Motion<N>>,
    of_event: Vec<usize>,
}

impl<const N: usize> Motions<N> {
    /// For events of these durations.
    pub(crate) fn new(
        durations_us: impl Iterator<Item = u64>,
        motion: impl Fn(f64) -> Result<Motion<N>, DesignError>,
    ) -> Result<Self, DesignError> {
        let mut known = Vec::new();
        let (mut motions, mut of_event) = (Vec::new(), Vec::new());
        for duration_us in durations_us {
            let index = match known.iter().position(|other| *other == duration_us) {
                Some(index) => index,
                None => {
                    motions.push(motion(duration_us as f64 / 1e6)?);
                    known.push(duration_us);
                    known.len() - 1
                }
            };
            of_event.push(index);
        }
        Ok(Self { motions, of_event })
    }

    /// The values at the end of an event.
    pub(crate) fn after(&self, event: usize, values: [f64; N]) -> [f64; N] {
        self.motions[self.of_event[event]].after(values)
    }
}
