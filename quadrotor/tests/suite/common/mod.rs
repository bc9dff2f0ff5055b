//! Flights that several tests share.

pub mod dormand_prince;
pub mod numbers;
pub mod physics;
pub mod trajectory;

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use quadrotor::{
    Configuration, ControlLoop, ControlSignal, ControllerKind, InputSignal, Inputs, Measurement, Outputs,
    PlantState, PositionReference, Sensors, Simulation,
};

/// The controllers that are compared.
pub const KINDS: [ControllerKind; 3] =
    [ControllerKind::Lmpc, ControllerKind::StateSpaceMpc, ControllerKind::Dlqr];

/// Observation interval of the flights, µs.
pub const STEP_US: u64 = 10_000;

/// The paper's flight as a goal: 5 m north, 5 m east, 10 m up.
pub const GOAL_M: [f64; 3] = [5.0, 5.0, -10.0];

/// Constant inputs: armed, towards a goal.
pub fn goal(position_m: [f64; 3], yaw_rad: f64) -> Inputs {
    Inputs { reference: PositionReference::goal(position_m, yaw_rad), ..Inputs::default() }
}

/// A configuration whose references go straight to the controllers.
pub fn unshaped() -> Configuration {
    let mut configuration = Configuration::default();
    configuration.reference.shaping = false;
    configuration
}

/// The same by a controller of a kind, with the whole state or with outputs alone.
pub fn unshaped_by(kind: ControllerKind, output_feedback: bool) -> Configuration {
    let mut configuration = unshaped();
    configuration.controllers.kind = kind;
    configuration.sensors.output_feedback = output_feedback;
    configuration
}

/// Noise of all states: 2 cm, 5 cm/s, 5 mrad and 20 mrad/s.
pub fn noisy() -> Sensors {
    Sensors {
        position_noise_m: 0.02,
        velocity_noise_m_s: 0.05,
        attitude_noise_rad: 0.005,
        body_rate_noise_rad_s: 0.02,
        ..Sensors::default()
    }
}

/// The quintic time law 10 s³ − 15 s⁴ + 6 s⁵ with s = t/duration, and its two derivatives: at rest at
/// both ends.
pub fn quintic(time_s: f64, duration_s: f64) -> [f64; 3] {
    let s = (time_s / duration_s).clamp(0.0, 1.0);
    [
        s.powi(3) * (10.0 - 15.0 * s + 6.0 * s * s),
        30.0 * s * s * (1.0 - s).powi(2) / duration_s,
        60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) / duration_s.powi(2),
    ]
}

/// A smooth flight to a goal with feed-forward of velocity and acceleration.
pub fn smooth_flight(goal_m: [f64; 3], yaw_rad: f64, duration_s: f64) -> impl InputSignal {
    move |time_us: u64| {
        let [position, velocity, acceleration] = quintic(time_us as f64 * 1e-6, duration_s);
        let way = Vector3::from(goal_m);
        Inputs {
            reference: PositionReference {
                position_m: way * position,
                velocity_m_s: way * velocity,
                acceleration_m_s2: way * acceleration,
                yaw_rad: yaw_rad * position,
                ..PositionReference::goal([0.0; 3], 0.0)
            },
            ..Inputs::default()
        }
    }
}

/// Flies for `duration_s` and shows every observation to `see`.
pub fn fly(
    configuration: &Configuration,
    inputs: &impl InputSignal,
    duration_s: f64,
    mut see: impl FnMut(&Outputs),
) -> Simulation {
    let mut simulation = Simulation::new(configuration, &inputs.at(0)).unwrap();
    let steps = (duration_s * 1e6) as u64 / STEP_US;
    for step in 1..=steps {
        simulation.advance_to(step * STEP_US, inputs).unwrap();
        see(&simulation.outputs());
    }
    simulation
}

/// What exact sensors say of a plant.
pub fn exact(state: &PlantState) -> Measurement {
    Measurement { motion: state.body, rotor_speed_rad_s: state.rotor_speed_rad_s }
}

/// Flies a plant by a control loop that is only told what is measured of it. Each millisecond, `step` takes a time, µs, the plant and
/// rotor commands, rad/s, to the plant a millisecond later.
pub fn fly_plant(
    configuration: &Configuration,
    (mut state, inputs): (PlantState, &impl ControlSignal),
    measured: impl Fn(&PlantState) -> Measurement,
    duration_s: f64,
    mut step: impl FnMut(u64, &PlantState, [f64; 4]) -> PlantState,
) -> (PlantState, ControlLoop) {
    let mut control = ControlLoop::new(configuration, &inputs.at(0), &mut measured(&state), 0).unwrap();
    for time_us in (0..(duration_s * 1e6) as u64).step_by(1_000) {
        let command_rad_s = control.advance_to(time_us, inputs, &mut measured(&state)).unwrap();
        state = step(time_us, &state, command_rad_s);
    }
    (state, control)
}

/// How far from the origin a flight of `duration_s` gets, m.
pub fn farthest_m(configuration: &Configuration, inputs: &impl InputSignal, duration_s: f64) -> f64 {
    let mut farthest_m = 0.0_f64;
    fly(configuration, inputs, duration_s, |outputs| farthest_m = farthest_m.max(outputs.position_m.norm()));
    farthest_m
}

/// Angle between the thrust axis and the vertical, rad.
pub fn tilt_rad(outputs: &Outputs) -> f64 {
    let [w, x, y, z] = outputs.quaternion;
    let rotation = UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z));
    (rotation * Vector3::z()).z.clamp(-1.0, 1.0).acos()
}

/// Extremes of a flight.
#[derive(Debug, Default)]
pub struct Extremes {
    pub tilt_rad: f64,
    pub rotor_speed_rad_s: [f64; 2],
    pub thrust_n: [f64; 2],
    pub horizontal_speed_m_s: f64,
    pub climb_m_s: f64,
    pub sink_m_s: f64,
}

impl Extremes {
    pub fn new() -> Self {
        let none = [f64::INFINITY, f64::NEG_INFINITY];
        Self { rotor_speed_rad_s: none, thrust_n: none, ..Self::default() }
    }

    pub fn see(&mut self, outputs: &Outputs) {
        let widen = |range: &mut [f64; 2], value: f64| *range = [range[0].min(value), range[1].max(value)];
        self.tilt_rad = self.tilt_rad.max(tilt_rad(outputs));
        for speed in outputs.rotor_speed_rad_s {
            widen(&mut self.rotor_speed_rad_s, speed);
        }
        widen(&mut self.thrust_n, outputs.thrust_n);
        self.horizontal_speed_m_s = self.horizontal_speed_m_s.max(outputs.velocity_m_s.xy().norm());
        self.climb_m_s = self.climb_m_s.max(-outputs.velocity_m_s.z);
        self.sink_m_s = self.sink_m_s.max(outputs.velocity_m_s.z);
    }

    /// No rotor and no tilt outside its limits.
    pub fn assert_within(&self, configuration: &Configuration) {
        let airframe = &configuration.airframe;
        let [slowest, fastest] = self.rotor_speed_rad_s;
        assert!(slowest >= airframe.rotor_speed_min_rad_s - 1e-9, "{self:?}");
        assert!(fastest <= airframe.rotor_speed_max_rad_s + 1e-9, "{self:?}");
        assert!(self.tilt_rad <= configuration.limits.tilt_rad, "{self:?}");
    }
}

/// Largest share by which a coordinate went beyond its goal.
pub fn overshoot(outputs: &Outputs, goal_m: [f64; 3]) -> f64 {
    (0..3)
        .filter(|&axis| goal_m[axis] != 0.0)
        .map(|axis| outputs.position_m[axis] / goal_m[axis] - 1.0)
        .fold(0.0, f64::max)
}

/// Distance from a goal, m.
pub fn distance(outputs: &Outputs, goal_m: [f64; 3]) -> f64 {
    (outputs.position_m - Vector3::from(goal_m)).norm()
}
