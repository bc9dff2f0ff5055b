//! An oscillator in the plane, ẋ = ω J x + u with J = (0 −1; 1 0): states, derivatives and inputs are vectors.

use fmi::variables::{Array, Field, Quantity, Signal, Variable};
use fmi::{Continuous, Experiment, Identity, Model, SavedStateFormat, Seed, Words};
use serde::{Deserialize, Serialize};

type Pair = [f64; 2];

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Parameters {
    frequency_rad_s: f64,
    initial: Pair,
}

impl Default for Parameters {
    fn default() -> Self {
        Self { frequency_rad_s: 2.0, initial: [1.0, 0.0] }
    }
}

/// The state at the present, with the input that led there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct State {
    time_us: u64,
    x: Pair,
    u: Pair,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Oscillator {
    parameters: Parameters,
    state: State,
}

pub struct Outputs {
    x: Pair,
    rate: Pair,
}

const PERIOD_US: u64 = 1_000;

impl Oscillator {
    fn rate(&self, x: Pair, u: Pair) -> Pair {
        let frequency = self.parameters.frequency_rad_s;
        [u[0] - frequency * x[1], u[1] + frequency * x[0]]
    }

    /// One step of Heun's method.
    fn step(&mut self, time_us: u64, u: Pair) {
        let h = (time_us - self.state.time_us) as f64 * 1e-6;
        let x = self.state.x;
        let first = self.rate(x, u);
        let second = self.rate([0, 1].map(|i| x[i] + h * first[i]), u);
        self.state = State { time_us, x: [0, 1].map(|i| x[i] + 0.5 * h * (first[i] + second[i])), u };
    }
}

impl Model for Oscillator {
    const IDENTITY: Identity = Identity {
        name: "Oscillator",
        model_identifier: "oscillator",
        description: "An oscillator in the plane",
        version: "1.0",
        author: "The authors of the tests",
        copyright: "Copyright (c) 2026 The authors of the tests",
        license: "MIT OR Apache-2.0",
        generation_tool: "the tests",
        date: "2026-11-21T00:00:00Z",
        default_experiment: Experiment { stop_time_s: 5.0, step_size_s: 0.05 },
        longest_step_s: 1800.0,
        saved_state: SavedStateFormat { magic: *b"OSCILLAT", version: 1 },
        words: Words::GENERAL,
    };
    const VARIABLES: &'static [&'static [Variable<Self>]] = &[&VARIABLES];
    const ARRAYS: &'static [&'static [Array]] = &[&[
        Array::new("u", "Inputs: first, second", &["u[1]", "u[2]"]),
        Array::new("x", "States: first, second", &["x[1]", "x[2]"]),
        Array::new("der(x)", "Time derivatives of the states", &["der(x[1])", "der(x[2])"]),
        Array::new("initial", "Initial states: first, second", &["initial[1]", "initial[2]"]),
    ]];
    const CONTINUOUS: Option<&'static dyn Continuous<Self>> = Some(&Equations);
    const OUTPUT_RATES: Option<fn(&Self) -> Outputs> = Some(|model| {
        let rate = model.rate(model.state.x, model.state.u);
        Outputs { x: rate, rate: model.rate(rate, [0.0; 2]) }
    });
    type Parameters = Parameters;
    type Inputs = Pair;
    type State = State;
    type Outputs = Outputs;
    type Error = String;

    fn new(parameters: &Parameters, inputs: &Pair) -> Result<Self, String> {
        Self::from_state(parameters, &State { time_us: 0, x: parameters.initial, u: *inputs })
    }

    fn from_state(parameters: &Parameters, state: &State) -> Result<Self, String> {
        Ok(Self { parameters: parameters.clone(), state: state.clone() })
    }

    fn state(&self) -> State {
        self.state.clone()
    }

    fn time_us(&self) -> u64 {
        self.state.time_us
    }

    fn advance_to(&mut self, time_us: u64, inputs: &impl Fn(u64) -> Pair) -> Result<(), String> {
        while self.state.time_us < time_us {
            let next_us = (self.state.time_us / PERIOD_US + 1) * PERIOD_US;
            self.step(next_us.min(time_us), inputs(self.state.time_us));
        }
        Ok(())
    }

    fn outputs(&self) -> Outputs {
        Outputs { x: self.state.x, rate: self.rate(self.state.x, self.state.u) }
    }
}

/// An event is where the first state changes its sign; nothing happens there.
struct Equations;

impl Continuous<Oscillator> for Equations {
    fn event_indicators(&self) -> usize {
        2
    }

    fn states(&self, model: &Oscillator, states: &mut [f64]) {
        states.copy_from_slice(&model.state.x);
    }

    fn set_states(&self, model: &mut Oscillator, states: &[f64]) {
        model.state.x = [states[0], states[1]];
    }

    fn derivatives(&self, model: &Oscillator, inputs: &Pair, derivatives: &mut [f64]) {
        derivatives.copy_from_slice(&model.rate(model.state.x, *inputs));
    }

    fn outputs(&self, model: &Oscillator, inputs: &Pair) -> Outputs {
        Outputs { x: model.state.x, rate: model.rate(model.state.x, *inputs) }
    }

    fn indicators(&self, model: &Oscillator, _inputs: &Pair, indicators: &mut [f64]) {
        indicators.copy_from_slice(&model.state.x);
    }

    fn update(&self, _model: &mut Oscillator, _inputs: &Pair) -> bool {
        false
    }

    fn tangent(&self, model: &Oscillator, _inputs: &Pair, seed: &Seed<Oscillator>) -> Outputs {
        let dx = [seed.states[0], seed.states[1]];
        Outputs { x: dx, rate: model.rate(dx, seed.inputs) }
    }

    fn dependencies(&self, unknown: &str) -> &'static [&'static str] {
        match unknown {
            "x[1]" => &["x[1]"],
            "x[2]" => &["x[2]"],
            "der(x[1])" => &["x[2]", "u[1]"],
            _ => &["x[1]", "u[2]"],
        }
    }
}

const NUMBER: Quantity =
    Quantity { name: "Number", description: "A number", unit: None, display_unit: None, nominal: 1.0 };

/// An input at an index.
macro_rules! input {
    ($name:literal, $description:literal, $index:literal) => {
        Row::input(
            $name,
            $description,
            Field::Real {
                quantity: &NUMBER,
                minimum: -10.0,
                maximum: 10.0,
                get: |inputs: &Pair| inputs[$index],
                set: |inputs: &mut Pair, value| inputs[$index] = value,
            },
        )
    };
}

/// A state at an index.
macro_rules! state {
    ($name:literal, $description:literal, $initial:literal, $index:literal) => {
        Row::output(
            $name,
            $description,
            &[$initial],
            Signal::Real {
                quantity: &NUMBER,
                minimum: None,
                maximum: None,
                get: |outputs| outputs.x[$index],
            },
        )
    };
}

/// An initial state at an index.
macro_rules! initial {
    ($name:literal, $description:literal, $index:literal) => {
        Row::fixed(
            $name,
            $description,
            Field::Real {
                quantity: &NUMBER,
                minimum: -10.0,
                maximum: 10.0,
                get: |parameters: &Parameters| parameters.initial[$index],
                set: |parameters: &mut Parameters, value| parameters.initial[$index] = value,
            },
        )
    };
}

type Row = Variable<Oscillator>;

const VARIABLES: [Row; 9] = [
    input!("u[1]", "First input", 0),
    input!("u[2]", "Second input", 1),
    state!("x[1]", "First state", "initial[1]", 0),
    state!("x[2]", "Second state", "initial[2]", 1),
    Row::derivative(
        "der(x[1])",
        "Time derivative of the first state",
        "x[1]",
        &["u[1]", "initial[2]", "frequency"],
        &NUMBER,
        |outputs| outputs.rate[0],
    ),
    Row::derivative(
        "der(x[2])",
        "Time derivative of the second state",
        "x[2]",
        &["u[2]", "initial[1]", "frequency"],
        &NUMBER,
        |outputs| outputs.rate[1],
    ),
    initial!("initial[1]", "First initial state", 0),
    initial!("initial[2]", "Second initial state", 1),
    Row::tunable(
        "frequency",
        "Angular frequency",
        Field::Real {
            quantity: &NUMBER,
            minimum: 0.0,
            maximum: 100.0,
            get: |parameters| parameters.frequency_rad_s,
            set: |parameters, value| parameters.frequency_rad_s = value,
        },
    ),
];
