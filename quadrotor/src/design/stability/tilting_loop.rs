//! The position controller over the closed attitude loop, along one horizontal axis.

use alloc::vec::Vec;

use lmpc::DesignError;
use nalgebra::SVector;

use crate::design::stability::loop_events::{LoopEvent, loop_events, period_s};
use crate::design::stability::motion::{Motions, horizontal};
use crate::design::stability::moving_axis::{Moving, MovingAxis};
use crate::design::stability::small_signal::{Reading, SmallSignal};
use crate::design::stability::turning_axis::{Turning, TurningAxis};
use crate::{Configuration, GRAVITY_M_S2};

/// Number of states.
pub(crate) const TILTING: usize = Turning::SIZE + Moving::SIZE;

/// The position controller over the closed attitude loop, along one horizontal axis. The angle is the lean that
/// accelerates towards positive positions.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct TiltingLoop {
    turning: TurningAxis,
    moving: MovingAxis<6>,
    events: Vec<LoopEvent>,
    motions: Motions<6>,
    /// Mass that the controllers believe in, as a multiple of the true one.
    believed: f64,
    inner_s: f64,
}

impl TiltingLoop {
    /// North (0) or east (1), by leaning about some axis of the body.
    ///
    /// # Errors
    /// [`DesignError::ElementNotFinite`].
    pub(crate) fn new(
        configuration: &Configuration,
        axis: usize,
        moving: MovingAxis<6>,
        turning: TurningAxis,
    ) -> Result<Self, DesignError> {
        let controllers = &configuration.controllers;
        let events = loop_events(controllers.position.sample_time_us, controllers.attitude.sample_time_us);
        let durations = events.iter().map(|event| event.duration_us);
        let motions = Motions::new(durations, |duration_s| horizontal(configuration, axis, duration_s))?;
        Ok(Self {
            turning,
            moving,
            events,
            motions,
            believed: controllers.mass_factor,
            inner_s: controllers.attitude.sample_time_s(),
        })
    }

    fn sample_attitude(&self, turning: &mut Turning, moving: &mut Moving, noise: &Reading) {
        // In hover m g = m_believed (g − G): a lean of a/(g − G).
        let leaning = self.believed / GRAVITY_M_S2;
        let now = moving.feedback * leaning;
        // Between its samples the position controller holds its command.
        let rate = 0.0;
        let modelled = turning.estimate[0] * GRAVITY_M_S2 / self.believed;
        self.turning.sample(turning, [now, rate], [noise.angle, noise.rate]);
        self.moving.predict(moving, modelled, [noise.position, noise.velocity]);
    }
}

impl SmallSignal<TILTING> for TiltingLoop {
    fn events(&self) -> usize {
        self.events.len()
    }

    fn period_s(&self) -> f64 {
        period_s(&self.events)
    }

    fn after(&self, state: &SVector<f64, TILTING>, event: usize, noise: &Reading) -> SVector<f64, TILTING> {
        let mut turning = Turning::from_values(&core::array::from_fn(|i| state[i]));
        let mut moving = Moving::from_values(&core::array::from_fn(|i| state[Turning::SIZE + i]));
        let present = &self.events[event];
        if present.outer {
            let thrust = GRAVITY_M_S2 / self.believed;
            let [angle, rate] = self.turning.seen(&turning, [noise.angle, noise.rate]);
            let [made, asked] = self.turning.accelerations(&turning);
            let achieved = [angle, rate, made, asked].map(|value| value * thrust);
            let unasked = turning.estimate[2] * thrust;
            self.moving.sample(&mut moving, present, [noise.position, noise.velocity], achieved, unasked);
        }
        if present.inner {
            self.sample_attitude(&mut turning, &mut moving, noise);
        }
        let Turning { angle, rate, acceleration, command, .. } = turning;
        let before = [moving.position, moving.velocity, angle, rate, acceleration, command];
        let after = self.motions.after(event, before);
        [moving.position, moving.velocity, turning.angle, turning.rate, turning.acceleration, _] = after;
        let (turning, moving) = (turning.values(), moving.values());
        SVector::from_iterator(turning.into_iter().chain(moving))
    }
}
