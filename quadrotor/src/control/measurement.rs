//! What a control loop sees of its vehicle.

use serde::{Deserialize, Serialize};

use crate::finite::are_finite;
use crate::{ControlError, RigidBody};

/// The vehicle as it is measured or estimated at one instant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measurement {
    /// Its motion. With [`Sensors::output_feedback`](crate::Sensors) only position and attitude are looked at.
    pub motion: RigidBody,
    /// Speeds of its rotors in the order of the airframe's layout, rad/s. The cascade looks at them when it takes the
    /// vehicle over, flight without a rotor at each sample.
    pub rotor_speed_rad_s: [f64; 4],
}

impl Measurement {
    /// Whether a vehicle can be measured like this: its motion is possible, its rotor speeds are finite.
    pub(crate) fn is_possible(&self) -> bool {
        self.motion.is_possible() && are_finite(&self.rotor_speed_rad_s)
    }

    /// The measurement itself, unless it is impossible.
    pub(crate) fn checked(self, time_us: u64) -> Result<Self, ControlError> {
        if self.is_possible() { Ok(self) } else { Err(ControlError::Measurement { time_us }) }
    }
}

/// Where a control loop reads its measurements: any `FnMut(u64) -> Measurement` of microseconds, or a held
/// [`Measurement`].
pub trait Instruments {
    /// A reading at `time_us`.
    fn read(&mut self, time_us: u64) -> Measurement;

    /// The motion in which the loop takes the vehicle over. A reading, unless something better than one noisy reading is
    /// known.
    fn read_at_takeover(&mut self, time_us: u64) -> Measurement {
        self.read(time_us)
    }
}

impl Instruments for Measurement {
    fn read(&mut self, _time_us: u64) -> Measurement {
        *self
    }
}

impl<F: FnMut(u64) -> Measurement> Instruments for F {
    fn read(&mut self, time_us: u64) -> Measurement {
        self(time_us)
    }
}
