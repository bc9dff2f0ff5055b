//! What a control loop is asked for.

use serde::{Deserialize, Serialize};

use crate::{AttitudeTarget, ControlError, PositionReference, ReferencePlan};

/// The law that flies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum ControlLaw {
    /// Position, altitude and attitude controllers (Figure 2).
    #[default]
    Cascade,
    /// The attitude controller alone.
    Attitude,
    /// Three rotors: the thrust axis is steered, the heading is given up.
    RotorLoss,
}

/// What the vehicle is asked for, and so which law flies it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Target {
    /// A goal or a point of a trajectory, by the cascade.
    Reference(PositionReference),
    /// An attitude and a thrust, by the attitude controller alone. When a reference follows, the position and altitude
    /// controllers take over the vehicle where it is.
    Attitude(AttitudeTarget),
    /// A reference without a rotor that is known to be lost: followed in position and velocity as it is, as far as three
    /// rotors can; the heading is given up.
    WithoutRotor {
        /// Index of the lost rotor in the airframe's layout.
        lost: usize,
        /// Where to be.
        reference: PositionReference,
    },
}

/// All inputs of a control loop but its measurements.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ControlInputs {
    /// What is asked for.
    pub target: Target,
    /// The way that the reference of [`Target::Reference`] takes, if that is known and it is not shaped.
    pub plan: Option<ReferencePlan>,
    /// Whether the rotors turn.
    pub armed: bool,
    /// Switches the shaper on or off; the reference goes on from where it is and as it moves. `None` leaves it as it is: at
    /// the start, as configured.
    pub shaping: Option<bool>,
    /// z of the ground below the vehicle, NED, m: nothing is learned of a flight close to it, nor before a vehicle has left the place where
    /// it stood. If the measured height may be wrong, pass a ground that is higher (smaller z) by that much.
    pub ground_z_m: f64,
}

/// Inputs as a function of time; any `Fn(u64) -> ControlInputs` of microseconds, or constant [`ControlInputs`].
pub trait ControlSignal {
    /// The inputs at `time_us`.
    fn at(&self, time_us: u64) -> ControlInputs;

    /// The same, to be looked at: inputs that are there already are not copied.
    fn with<R>(&self, time_us: u64, look: impl FnOnce(&ControlInputs) -> R) -> R {
        look(&self.at(time_us))
    }
}

impl ControlSignal for ControlInputs {
    fn at(&self, _time_us: u64) -> ControlInputs {
        *self
    }

    fn with<R>(&self, _time_us: u64, look: impl FnOnce(&ControlInputs) -> R) -> R {
        look(self)
    }
}

impl<F: Fn(u64) -> ControlInputs> ControlSignal for F {
    fn at(&self, time_us: u64) -> ControlInputs {
        self(time_us)
    }
}

impl Target {
    /// The law that flies it.
    pub fn law(&self) -> ControlLaw {
        match self {
            Self::Reference(_) => ControlLaw::Cascade,
            Self::Attitude(_) => ControlLaw::Attitude,
            Self::WithoutRotor { .. } => ControlLaw::RotorLoss,
        }
    }

    fn not_finite(&self) -> Option<&'static str> {
        match self {
            Self::Reference(reference) | Self::WithoutRotor { reference, .. } => reference.not_finite(),
            Self::Attitude(target) => (!target.is_finite()).then_some("attitude_target"),
        }
    }
}

impl ControlInputs {
    /// Armed, with what is asked for, and the shaper as it is.
    pub fn armed(target: Target) -> Self {
        Self { target, plan: None, armed: true, shaping: None, ground_z_m: 0.0 }
    }

    /// Refuses what no law can fly.
    pub(crate) fn check(&self, time_us: u64) -> Result<(), ControlError> {
        if let Some(name) = self.target.not_finite() {
            return Err(ControlError::InputNotFinite { name, time_us });
        }
        if self.plan.as_ref().is_some_and(|plan| !plan.is_finite()) {
            return Err(ControlError::InputNotFinite { name: "reference.plan", time_us });
        }
        if !self.ground_z_m.is_finite() {
            return Err(ControlError::InputNotFinite { name: "ground_z", time_us });
        }
        if self.shaping == Some(true) && !cfg!(feature = "shaper") {
            return Err(ControlError::NoShaper);
        }
        Ok(())
    }
}
