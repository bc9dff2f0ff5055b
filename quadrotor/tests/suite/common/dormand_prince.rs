//! An integrator of its own: Dormand and Prince's pair of orders 5 and 4 with steps by its error estimate, stopped at events.

use quadrotor::{Plant, PlantInputs, PlantMode, PlantState, Switch};

type Numbers = [f64; PlantState::LEN];

const NODES: [&[f64]; 6] = [
    &[1.0 / 5.0],
    &[3.0 / 40.0, 9.0 / 40.0],
    &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
    &[19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0],
    &[9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
    &[35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];
/// Weights of the fifth order minus those of the fourth.
const ERROR: [f64; 7] =
    [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0];

/// A flight from event to event.
pub struct Flight<'a> {
    pub plant: &'a Plant,
    pub inputs: PlantInputs,
    pub mode: PlantMode,
    pub state: PlantState,
    pub time_s: f64,
    /// How many events there were.
    pub events: usize,
    /// Relative to the nominal of each number.
    tolerance: f64,
}

impl<'a> Flight<'a> {
    pub fn new(plant: &'a Plant, state: &PlantState, inputs: &PlantInputs, tolerance: f64) -> Self {
        let mode = plant.mode(state, inputs);
        let (mode, state) = plant.event(mode, state, inputs);
        Self { plant, inputs: *inputs, mode, state, time_s: 0.0, events: 0, tolerance }
    }

    /// Other inputs from now on: an event of the importer's.
    pub fn set_inputs(&mut self, inputs: &PlantInputs) {
        self.inputs = *inputs;
        (self.mode, self.state) = self.plant.event(self.mode, &self.state, inputs);
    }

    pub fn fly_to(&mut self, end_s: f64) {
        let mut h_s: f64 = 1e-3;
        while self.time_s < end_s {
            h_s = h_s.min(end_s - self.time_s);
            let (next, error) = self.step(h_s);
            if error > 1.0 {
                h_s *= (0.9 * error.powf(-0.2)).max(0.2);
                continue;
            }
            let event = self.signs(&next) != self.signs(&self.state);
            let (taken_s, next) = if event { self.located(h_s) } else { (h_s, next) };
            self.time_s = if taken_s == end_s - self.time_s { end_s } else { self.time_s + taken_s };
            self.state = next;
            if event {
                self.events += 1;
                assert!(self.events < 1_000, "events without end at {} s: {:?}", self.time_s, self.mode);
                (self.mode, self.state) = self.plant.event(self.mode, &self.state, &self.inputs);
            } else {
                h_s *= (0.9 * error.max(1e-10).powf(-0.2)).clamp(0.2, 5.0);
            }
        }
    }

    fn signs(&self, state: &PlantState) -> [bool; Switch::COUNT] {
        self.plant.event_indicators(self.mode, state, &self.inputs).map(|indicator| indicator > 0.0)
    }

    /// The end of the shortest step after which an indicator has changed its sign, by bisection.
    fn located(&self, h_s: f64) -> (f64, PlantState) {
        let before = self.signs(&self.state);
        let (mut early_s, mut late_s) = (0.0, h_s);
        for _ in 0..60 {
            let middle_s = (early_s + late_s) / 2.0;
            if self.signs(&self.step(middle_s).0) == before { early_s = middle_s } else { late_s = middle_s }
        }
        (late_s, self.step(late_s).0)
    }

    /// One step and its error, as a multiple of the tolerance.
    fn step(&self, h_s: f64) -> (PlantState, f64) {
        let start = self.state.to_array();
        let slope = |numbers: Numbers| -> Numbers {
            self.plant.derivative_in(self.mode, &PlantState::from_array(numbers), &self.inputs).to_array()
        };
        let mut slopes = vec![slope(start)];
        let mut next = start;
        for weights in NODES {
            next = std::array::from_fn(|i| {
                start[i] + h_s * weights.iter().zip(&slopes).map(|(w, slope)| w * slope[i]).sum::<f64>()
            });
            slopes.push(slope(next));
        }
        let nominal = PlantState::nominal(self.plant.airframe()).to_array();
        let error = (0..PlantState::LEN).map(|i| {
            let error: f64 = ERROR.iter().zip(&slopes).map(|(w, slope)| w * slope[i]).sum();
            (h_s * error / (self.tolerance * nominal[i].max(next[i].abs()))).abs()
        });
        (PlantState::from_array(next), error.fold(0.0, f64::max))
    }
}
