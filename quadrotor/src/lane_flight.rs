//! Flights that go on side by side in one thread.

use core::array::from_fn;

use crate::plant::lanes::LANES;
use crate::{InputSignal, PlantState, Simulation, SimulationError};

/// From so many vehicles on a step of all lanes takes less time than a step of each.
const WORTHWHILE: usize = 3;

/// A vehicle that flies side by side with others of the same plant.
pub(crate) struct LaneFlight<'a, S> {
    simulation: &'a mut Simulation,
    failure: &'a mut Option<SimulationError>,
    /// Where it flies to, µs.
    time_us: u64,
    inputs: S,
    /// Whether all later inputs are those that were sampled.
    are_known: bool,
    /// Where its plant flies to, µs, if it has not come to its end.
    next_us: Option<u64>,
}

impl<'a, S: InputSignal> LaneFlight<'a, S> {
    /// Of a vehicle, and where to tell why it could not go on, to a time, µs, under these inputs.
    pub(crate) fn new(
        simulation: &'a mut Simulation,
        failure: &'a mut Option<SimulationError>,
        (time_us, inputs): (u64, S),
    ) -> Self {
        Self { simulation, failure, time_us, inputs, are_known: false, next_us: None }
    }

    /// Refuses a time that has passed.
    fn check_order(&mut self) {
        if let Err(failure) = self.simulation.check_order(self.time_us) {
            self.fail(failure);
        }
    }

    /// Samples at its last event if that is due, and looks for its next event on its way.
    fn look_ahead(&mut self) {
        if self.failure.is_some() {
            return;
        }
        match self.simulation.next_event_us(self.time_us, &self.inputs, &mut self.are_known) {
            Ok(next_us) => self.next_us = next_us,
            Err(failure) => self.fail(failure),
        }
    }

    fn fail(&mut self, failure: SimulationError) {
        *self.failure = Some(failure);
        self.next_us = None;
    }

    /// Time to its next event, µs.
    fn interval_us(&self) -> Option<u64> {
        Some(self.next_us? - self.simulation.event_us())
    }

    /// Flies to its next event, if there is one, with the plant that has stepped there or steps now.
    fn arrive(&mut self, stepped: Option<PlantState>) {
        let Some(next_us) = self.next_us else { return };
        let plant = stepped.unwrap_or_else(|| self.simulation.plant_at(next_us));
        if let Err(failure) = self.simulation.arrive(next_us, plant) {
            self.fail(failure);
        }
    }

    /// Has come to its end, unless it has failed.
    fn rest(&mut self) {
        if self.failure.is_none() {
            self.simulation.rest_at(self.time_us);
        }
    }
}

/// Flies up to [`LANES`] vehicles of one plant on, each as [`Simulation::advance_to`] does, bit for bit: at each event all of them sample
/// one after the other, and then their plants step at once.
pub(crate) fn advance_lanes<S: InputSignal>(flights: &mut [LaneFlight<'_, S>]) {
    flights.iter_mut().for_each(LaneFlight::check_order);
    loop {
        flights.iter_mut().for_each(LaneFlight::look_ahead);
        let Some(first) = flights.iter().position(|flight| flight.next_us.is_some()) else { break };
        let stepped = stepped(flights, first);
        for (flight, stepped) in flights.iter_mut().zip(stepped) {
            flight.arrive(stepped);
        }
    }
    flights.iter_mut().for_each(LaneFlight::rest);
}

/// Plants at the next events of the `first` vehicle and of all that step by the same time, if they can step at once.
fn stepped<S: InputSignal>(flights: &[LaneFlight<'_, S>], first: usize) -> [Option<PlantState>; LANES] {
    let interval_us = |lane: usize| flights.get(lane).and_then(LaneFlight::interval_us);
    let together: [bool; LANES] = from_fn(|lane| interval_us(lane) == interval_us(first));
    let many = together.iter().filter(|one| **one).count() >= WORTHWHILE;
    let Some(interval_us) = interval_us(first).filter(|_| many) else { return [None; LANES] };
    // The first one flies in lanes that nobody has, too.
    let in_lane = |lane: usize| &*flights[if together[lane] { lane } else { first }].simulation;
    let stepped = in_lane(first).plant().step_side_by_side(
        &from_fn(|lane| *in_lane(lane).state_at_event()),
        &from_fn(|lane| in_lane(lane).plant_inputs()),
        interval_us as f64 / 1e6,
    );
    stepped.map_or([None; LANES], |states| from_fn(|lane| together[lane].then_some(states[lane])))
}
