//! What acts on the closed loop from outside.

use serde::{Deserialize, Serialize};

use crate::{
    AttitudeTarget, ControlInputs, ControlLaw, Disturbance, PositionReference, ReferencePlan, RigidBody,
    RotorFault, SimulationError, Target,
};

/// All inputs of the closed loop. They are looked at each millisecond and whenever a controller samples; what acts on the plant
/// acts from then on.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Inputs {
    /// Where to be.
    pub reference: PositionReference,
    /// The way that the reference takes, if that is known: the controllers look ahead on it. Without effect while shaping is on.
    pub plan: Option<ReferencePlan>,
    /// What pushes.
    pub disturbance: Disturbance,
    /// Whether the rotors turn.
    pub armed: bool,
    /// Flown instead of the reference while there is one. When it goes, the position and altitude controllers take over the
    /// vehicle where it is.
    pub attitude_target: Option<AttitudeTarget>,
    /// Switches the shaper on or off; `None` leaves it as it is: at the start, as configured.
    pub shaping: Option<bool>,
    /// The rotor that is known to be lost, by its index in the airframe's layout: the heading is given up, and the reference
    /// is followed in position and velocity as it is, as far as three rotors can. It goes before an attitude target.
    pub lost_rotor: Option<usize>,
    /// What the controllers take the vehicle's motion for, in place of the true motion and the noise of
    /// [`Sensors`](crate::Sensors). What the predictor of disturbances believes of its errors stays the configured noise. The ground is
    /// taken to be 1 m higher, because an estimated height may be wrong by that much: nothing is learned in the lowest metre or so.
    pub estimate: Option<RigidBody>,
    /// What is wrong with each rotor, in the order of the airframe's layout. Disarmed, all of them come to rest.
    pub rotor_faults: [Option<RotorFault>; 4],
    /// z of the ground below the vehicle, NED, m: see [`PlantInputs::ground_z_m`](crate::PlantInputs::ground_z_m).
    pub ground_z_m: f64,
}

/// An estimated height is off by no more than this, m, as long as a vehicle has its barometer or its receiver.
const ESTIMATED_HEIGHT_M: f64 = 1.0;

/// The paper's flight: armed, to 5 m north, 5 m east, 10 m up, no disturbance, sound rotors, flat ground.
impl Default for Inputs {
    fn default() -> Self {
        Self {
            reference: PositionReference::goal([5.0, 5.0, -10.0], 0.0),
            plan: None,
            disturbance: Disturbance::default(),
            armed: true,
            attitude_target: None,
            shaping: None,
            lost_rotor: None,
            estimate: None,
            rotor_faults: [None; 4],
            ground_z_m: 0.0,
        }
    }
}

/// Inputs as a function of time; any `Fn(u64) -> Inputs` of microseconds, or constant [`Inputs`].
pub trait InputSignal {
    /// The inputs at `time_us` microseconds after the start of the flight.
    fn at(&self, time_us: u64) -> Inputs;

    /// The same, to be looked at: inputs that are there already are not copied.
    fn with<R>(&self, time_us: u64, look: impl FnOnce(&Inputs) -> R) -> R {
        look(&self.at(time_us))
    }

    /// Whether the inputs are the same at all times, so that one look is enough.
    fn is_constant(&self) -> bool {
        false
    }
}

impl InputSignal for Inputs {
    fn at(&self, _time_us: u64) -> Inputs {
        *self
    }

    fn with<R>(&self, _time_us: u64, look: impl FnOnce(&Inputs) -> R) -> R {
        look(self)
    }

    fn is_constant(&self) -> bool {
        true
    }
}

impl<F: Fn(u64) -> Inputs> InputSignal for F {
    fn at(&self, time_us: u64) -> Inputs {
        self(time_us)
    }
}

impl Inputs {
    /// What the control loop is asked for.
    pub fn control(&self) -> ControlInputs {
        let mut inputs = ControlInputs {
            target: match (self.lost_rotor, self.attitude_target) {
                (Some(lost), _) => Target::WithoutRotor { lost, reference: self.reference },
                (None, Some(target)) => Target::Attitude(target),
                (None, None) => Target::Reference(self.reference),
            },
            plan: None,
            armed: self.armed,
            shaping: self.shaping,
            // An estimate of the height may be off.
            ground_z_m: self.ground_z_m - if self.estimate.is_some() { ESTIMATED_HEIGHT_M } else { 0.0 },
        };
        // A plan is large, and mostly there is none to be copied.
        if self.plan.is_some() {
            inputs.plan = self.plan;
        }
        inputs
    }

    /// The law that flies under them.
    pub(crate) fn law(&self) -> ControlLaw {
        match (self.lost_rotor, &self.attitude_target) {
            (Some(_), _) => ControlLaw::RotorLoss,
            (None, Some(_)) => ControlLaw::Attitude,
            (None, None) => ControlLaw::Cascade,
        }
    }

    /// Whether a control loop that shapes a reference goes on with one under them.
    pub(crate) fn keep_to_a_shaped_reference(&self) -> bool {
        self.armed && self.law() == ControlLaw::Cascade && self.plan.is_none() && self.shaping != Some(false)
    }

    /// Refuses what is not finite, the reference also while an attitude is flown. The control loop checks what else it is asked for
    /// itself.
    pub(crate) fn check(&self, time_us: u64) -> Result<(), SimulationError> {
        let wrong = if let Some(name) = self.reference.not_finite() {
            Some(name)
        } else if let Some(name) = self.disturbance.not_finite() {
            Some(name)
        } else if !self.estimate.as_ref().is_none_or(RigidBody::is_possible) {
            Some("estimate")
        } else if !self.rotor_faults.iter().flatten().all(|fault| fault.is_valid()) {
            Some("rotor_faults")
        } else if !self.ground_z_m.is_finite() {
            Some("ground_z")
        } else {
            None
        };
        wrong.map_or(Ok(()), |name| Err(SimulationError::InputNotFinite { name, time_us }))
    }
}
