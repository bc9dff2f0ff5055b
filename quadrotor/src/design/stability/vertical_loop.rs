//! The altitude controller with the rotors' lag.

use alloc::vec::Vec;

use lmpc::DesignError;
use nalgebra::SVector;

use crate::Configuration;
use crate::control::thrust_lag::ThrustLag;
use crate::design::stability::loop_events::{LoopEvent, loop_events, period_s};
use crate::design::stability::motion::{Motions, vertical};
use crate::design::stability::moving_axis::{Moving, MovingAxis};
use crate::design::stability::small_signal::{Reading, SmallSignal};

/// Number of states: the rotors' acceleration, the commanded one, and the axis.
pub(crate) const VERTICAL: usize = 2 + Moving::SIZE;
/// Places of the commanded acceleration and of the position among them.
pub(crate) const COMMAND: usize = 1;
pub(crate) const POSITION: usize = 2 + Moving::POSITION;

/// The altitude controller with the rotors' lag.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct VerticalLoop {
    moving: MovingAxis<3>,
    events: Vec<LoopEvent>,
    motions: Motions<4>,
    believed: f64,
    /// Share of a deviation of the rotors' speed that is left after a sample of the attitude controller.
    kept: f64,
}

impl VerticalLoop {
    /// Of the altitude controller.
    ///
    /// # Errors
    /// [`DesignError::ElementNotFinite`].
    pub(crate) fn new(configuration: &Configuration, moving: MovingAxis<3>) -> Result<Self, DesignError> {
        let controllers = &configuration.controllers;
        let events = loop_events(controllers.altitude.sample_time_us, controllers.attitude.sample_time_us);
        let durations = events.iter().map(|event| event.duration_us);
        let motions = Motions::new(durations, |duration_s| vertical(configuration, duration_s))?;
        Ok(Self {
            moving,
            events,
            motions,
            believed: controllers.mass_factor,
            kept: ThrustLag::of(configuration).kept(),
        })
    }
}

impl SmallSignal<VERTICAL> for VerticalLoop {
    fn events(&self) -> usize {
        self.events.len()
    }

    fn period_s(&self) -> f64 {
        period_s(&self.events)
    }

    fn after(&self, state: &SVector<f64, VERTICAL>, event: usize, noise: &Reading) -> SVector<f64, VERTICAL> {
        let (mut acceleration, mut command) = (state[0], state[1]);
        let mut moving = Moving::from_values(&core::array::from_fn(|i| state[2 + i]));
        let present = &self.events[event];
        if present.outer {
            let achieved = [acceleration / self.believed, 0.0, 0.0, 0.0];
            self.moving.sample(&mut moving, present, [noise.position, noise.velocity], achieved, 0.0);
        }
        if present.inner {
            let wanted = moving.feedback;
            command = self.believed * wanted;
            let mean = (acceleration + command + (acceleration - command) * self.kept) / 2.0;
            let noise = [noise.position, noise.velocity];
            self.moving.predict(&mut moving, mean / self.believed, noise);
        }
        let before = [moving.position, moving.velocity, acceleration, command];
        [moving.position, moving.velocity, acceleration, _] = self.motions.after(event, before);
        SVector::from_iterator([acceleration, command].into_iter().chain(moving.values()))
    }
}
