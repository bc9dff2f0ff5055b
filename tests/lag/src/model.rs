//! A first-order lag, τ ẏ = k u − y, with a variable of each kind. In co-simulation the input is sampled every millisecond.

use fmi::variables::{Choice, Field, Quantity, Signal, Unit, Variable};
use fmi::{Continuous, Experiment, Identity, Model, SavedStateFormat, Seed, Words};
use serde::{Deserialize, Serialize};

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Parameters {
    pub time_constant_s: f64,
    pub gain: f64,
    pub limit: f64,
    pub sign: i32,
    pub divisor: i32,
}

impl Default for Parameters {
    fn default() -> Self {
        Self { time_constant_s: 0.5, gain: 2.0, limit: 50.0, sign: 1, divisor: 1 }
    }
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Inputs {
    pub u: f64,
    pub hold: bool,
}

impl Default for Inputs {
    fn default() -> Self {
        Self { u: 1.0, hold: false }
    }
}

/// The lag at its last sample, and the present.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct State {
    time_us: u64,
    sample_us: u64,
    y: f64,
    u: f64,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Lag {
    parameters: Parameters,
    state: State,
}

pub struct Outputs {
    y: f64,
    rate: f64,
    samples: u32,
    direction: i32,
    settled: bool,
}

const PERIOD_US: u64 = 1_000;
/// So near to its goal it has settled.
const NEAR: f64 = 0.01;

impl Lag {
    /// k, signed and divided.
    fn slope(&self) -> f64 {
        let p = &self.parameters;
        let sign = if p.sign == 1 { 1.0 } else { -1.0 };
        sign * p.gain / f64::from(p.divisor)
    }

    /// k u, the value that it goes to.
    fn goal(&self) -> f64 {
        self.slope() * self.state.u
    }

    /// All outputs when y goes to `goal`.
    fn towards(&self, y: f64, goal: f64) -> Outputs {
        let rest = goal - y;
        Outputs {
            y,
            rate: rest / self.parameters.time_constant_s,
            samples: u32::try_from(self.state.sample_us / PERIOD_US).unwrap_or(u32::MAX),
            direction: if rest < 0.0 { 2 } else { 1 },
            settled: rest.abs() < NEAR,
        }
    }

    /// The exact solution for a constant input, from the last sample on.
    fn y_at(&self, time_us: u64) -> f64 {
        let elapsed_s = (time_us - self.state.sample_us) as f64 * 1e-6;
        let goal = self.goal();
        goal + (self.state.y - goal) * (-elapsed_s / self.parameters.time_constant_s).exp()
    }
}

impl Model for Lag {
    const IDENTITY: Identity = Identity {
        name: "Lag",
        model_identifier: "lag",
        description: "A first-order lag",
        version: "1.0",
        author: "The authors of the tests",
        copyright: "Copyright (c) 2026 The authors of the tests",
        license: "MIT OR Apache-2.0",
        generation_tool: "the tests",
        date: "2026-11-21T00:00:00Z",
        default_experiment: Experiment { stop_time_s: 5.0, step_size_s: 0.05 },
        longest_step_s: 1800.0,
        saved_state: SavedStateFormat { magic: *b"LAGSTATE", version: 1 },
        words: Words::GENERAL,
    };
    const VARIABLES: &'static [&'static [Variable<Self>]] = &[&VARIABLES];
    const CONTINUOUS: Option<&'static dyn Continuous<Self>> = Some(&Equations);
    const OUTPUT_RATES: Option<fn(&Self) -> Outputs> = Some(|lag| lag.towards(lag.outputs().rate, 0.0));
    type Parameters = Parameters;
    type Inputs = Inputs;
    type State = State;
    type Outputs = Outputs;
    type Error = String;

    fn new(parameters: &Parameters, inputs: &Inputs) -> Result<Self, String> {
        Self::from_state(parameters, &State { time_us: 0, sample_us: 0, y: 0.0, u: inputs.u })
    }

    fn from_state(parameters: &Parameters, state: &State) -> Result<Self, String> {
        if parameters.gain > parameters.limit {
            return Err(format!("gain = {} must be at most limit = {}", parameters.gain, parameters.limit));
        }
        if state.time_us.checked_sub(state.sample_us).is_none_or(|elapsed_us| elapsed_us > PERIOD_US) {
            return Err("the sample is not the last".to_owned());
        }
        Ok(Self { parameters: parameters.clone(), state: state.clone() })
    }

    fn state(&self) -> State {
        self.state.clone()
    }

    fn time_us(&self) -> u64 {
        self.state.time_us
    }

    fn advance_to(&mut self, time_us: u64, inputs: &impl Fn(u64) -> Inputs) -> Result<(), String> {
        while self.state.time_us < time_us {
            if self.state.time_us == self.state.sample_us {
                let now = inputs(self.state.sample_us);
                self.state.u = if now.hold { self.state.u } else { now.u };
            }
            let next_us = self.state.sample_us + PERIOD_US;
            if next_us <= time_us {
                self.state.y = self.y_at(next_us);
                self.state.sample_us = next_us;
            }
            self.state.time_us = next_us.min(time_us);
            if self.state.y.abs() > self.parameters.limit {
                return Err(format!("y = {} is past the limit", self.state.y));
            }
        }
        Ok(())
    }

    fn outputs(&self) -> Outputs {
        self.towards(self.y_at(self.state.time_us), self.goal())
    }
}

/// One state, y. At an event the input is taken that acts while it is held, and what `settled` says.
struct Equations;

impl Equations {
    fn goal(lag: &Lag, inputs: &Inputs) -> f64 {
        lag.slope() * if inputs.hold { lag.state.u } else { inputs.u }
    }
}

impl Continuous<Lag> for Equations {
    fn event_indicators(&self) -> usize {
        1
    }

    fn states(&self, lag: &Lag, states: &mut [f64]) {
        states[0] = lag.state.y;
    }

    fn set_states(&self, lag: &mut Lag, states: &[f64]) {
        lag.state.y = states[0];
    }

    fn derivatives(&self, lag: &Lag, inputs: &Inputs, derivatives: &mut [f64]) {
        derivatives[0] = self.outputs(lag, inputs).rate;
    }

    fn outputs(&self, lag: &Lag, inputs: &Inputs) -> Outputs {
        lag.towards(lag.state.y, Self::goal(lag, inputs))
    }

    fn indicators(&self, lag: &Lag, inputs: &Inputs, indicators: &mut [f64]) {
        indicators[0] = (Self::goal(lag, inputs) - lag.state.y).abs() - NEAR;
    }

    fn update(&self, lag: &mut Lag, inputs: &Inputs) -> bool {
        if !inputs.hold {
            lag.state.u = inputs.u;
        }
        false
    }

    fn tangent(&self, lag: &Lag, inputs: &Inputs, seed: &Seed<Lag>) -> Outputs {
        let du = if inputs.hold { 0.0 } else { seed.inputs.u };
        let dy = seed.states[0];
        lag.towards(dy, lag.slope() * du)
    }

    fn dependencies(&self, unknown: &str) -> &'static [&'static str] {
        match unknown {
            "y" => &["y"],
            "samples" => &[],
            _ => &["y", "u", "hold"],
        }
    }
}

const SECOND: Unit = Unit { name: "s", base: &[("s", "1")], display: &[("ms", 1e3)] };
const TIME: Quantity = Quantity {
    name: "Time",
    description: "Time",
    unit: Some(&SECOND),
    display_unit: Some("ms"),
    nominal: 1.0,
};
const NUMBER: Quantity =
    Quantity { name: "Number", description: "A number", unit: None, display_unit: None, nominal: 1.0 };
const DIRECTION: Choice =
    Choice { name: "Direction", description: "Up or down", items: &[("up", "Up"), ("down", "Down")] };
const GOAL: &[&str] = &["u", "gain", "sign", "divisor"];

/// A real number within a range, at a field of the inputs or parameters.
macro_rules! real {
    ($owner:ident, $quantity:ident, $minimum:literal..=$maximum:literal, $field:ident) => {
        Field::Real {
            quantity: &$quantity,
            minimum: $minimum,
            maximum: $maximum,
            get: |from: &$owner| from.$field,
            set: |into: &mut $owner, value| into.$field = value,
        }
    };
}

type Row = Variable<Lag>;

const VARIABLES: [Row; 14] = [
    Row::input("u", "Input", real!(Inputs, NUMBER, -10.0..=10.0, u)),
    Row::input(
        "hold",
        "Whether the input of the last sample is held",
        Field::Boolean { get: |inputs| inputs.hold, set: |inputs, value| inputs.hold = value },
    ),
    Row::output(
        "y",
        "Output",
        &[],
        Signal::Real { quantity: &NUMBER, minimum: None, maximum: None, get: |outputs| outputs.y },
    ),
    Row::output("samples", "Samples until now", &[], Signal::Count { get: |outputs| outputs.samples }),
    Row::output(
        "direction",
        "Where the output goes",
        GOAL,
        Signal::Enumeration { choice: DIRECTION, get: |outputs| outputs.direction },
    ),
    Row::output("settled", "Whether it is there", GOAL, Signal::Boolean { get: |outputs| outputs.settled }),
    Row::derivative(
        "der(y)",
        "Time derivative of the output",
        "y",
        &["u", "gain", "sign", "divisor", "time_constant"],
        &NUMBER,
        |outputs| outputs.rate,
    ),
    Row::tunable("time_constant", "Time constant", real!(Parameters, TIME, 0.01..=100.0, time_constant_s)),
    Row::tunable("gain", "Gain", real!(Parameters, NUMBER, 0.0..=100.0, gain)),
    Row::fixed(
        "limit",
        "Magnitude of the output that breaks it",
        real!(Parameters, NUMBER, 0.0..=100.0, limit),
    ),
    Row::fixed(
        "sign",
        "Sign of the gain",
        Field::Enumeration { choice: DIRECTION, get: |p| p.sign, set: |p, value| p.sign = value },
    ),
    Row::fixed(
        "divisor",
        "Divisor of the gain",
        Field::Integer { minimum: 1, maximum: 100, get: |p| p.divisor, set: |p, value| p.divisor = value },
    ),
    Row::number("sign_number", "Sign of the gain as an integer", "sign"),
    Row::calculated("corner", "Corner frequency", &["time_constant"], &NUMBER, |lag| {
        lag.parameters.time_constant_s.recip()
    }),
];
