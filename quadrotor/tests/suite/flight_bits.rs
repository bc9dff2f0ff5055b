//! The closed loop's doubles: flights that were recorded fly again.
//!
//! A change that is to leave the numbers alone keeps every digest. One that changes them by rounding keeps the motions, and records
//! the digests anew:
//!
//! ```text
//! RECORD_FLIGHTS=1 cargo test -p quadrotor --test suite flight_bits::
//! ```

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use nalgebra::{UnitQuaternion, Vector3};
use quadrotor::{
    AirframePreset, AttitudeTarget, Configuration, ControllerKind, InputSignal, Inputs, Outputs, PlantState,
    PositionReference, PredictionModel, ReferencePlan, RotorFault, Sensors, Simulation,
};
use serde::{Deserialize, Serialize};

use crate::common::physics::all_physics;
use crate::common::{GOAL_M, goal, smooth_flight, unshaped};

/// Times at which a flight is looked at, µs: mostly between two events.
const LOOK_US: u64 = 9_700;
/// Time between two of the recorded motions, µs.
const SECOND_US: u64 = 1_000_000;
/// What rounding may have grown to within a flight, relative to each number's usual magnitude.
const ROUNDING: f64 = 1e-6;

/// A flight as it was recorded.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Recorded {
    /// FNV-1a over the bits of all that was seen, in hexadecimal digits.
    digest: String,
    /// The plant's numbers at every second.
    motions: Vec<Vec<f64>>,
}

/// FNV-1a over the bits of what is seen.
struct Digest(u64);

impl Digest {
    fn take<'a>(&mut self, values: impl IntoIterator<Item = &'a f64>) {
        for byte in values.into_iter().flat_map(|value| value.to_bits().to_le_bytes()) {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    fn take_reference(&mut self, reference: &PositionReference) {
        self.take(&reference.position_m);
        self.take(&reference.velocity_m_s);
        self.take(&reference.acceleration_m_s2);
        self.take(&[reference.yaw_rad]);
    }

    fn take_outputs(&mut self, outputs: &Outputs) {
        for vector in [
            &outputs.position_m,
            &outputs.velocity_m_s,
            &outputs.acceleration_m_s2,
            &outputs.body_velocity_m_s,
            &outputs.attitude_rad,
            &outputs.body_rate_rad_s,
            &outputs.torque_n_m,
            &outputs.tracking_error_m,
        ] {
            self.take(vector);
        }
        self.take(&outputs.quaternion);
        self.take(&outputs.rotor_speed_rad_s);
        self.take(&outputs.tilt_reference_rad);
        let battery = &outputs.battery;
        self.take(&[outputs.thrust_n, outputs.yaw_error_rad, battery.voltage_v, battery.current_a]);
        self.take_reference(&outputs.setpoint);
    }
}

/// A flight under way, and what was seen of it.
struct Flight {
    simulation: Simulation,
    digest: Digest,
    motions: Vec<Vec<f64>>,
}

impl Flight {
    fn new(configuration: &Configuration, inputs: &Inputs) -> Self {
        let simulation = Simulation::new(configuration, inputs).unwrap();
        Self { simulation, digest: Digest(0xcbf2_9ce4_8422_2325), motions: Vec::new() }
    }

    /// Flies on for whole seconds.
    fn fly(mut self, seconds: u64, inputs: &impl InputSignal) -> Self {
        let begin_us = self.simulation.time_us();
        for second in 1..=seconds {
            let end_us = begin_us + second * SECOND_US;
            while self.simulation.time_us() < end_us {
                let next_us = (self.simulation.time_us() + LOOK_US).min(end_us);
                self.simulation.advance_to(next_us, inputs).unwrap();
                self.digest.take_outputs(&self.simulation.outputs());
                self.digest.take(&self.simulation.plant_state().to_array());
                self.digest.take(&self.simulation.rotor_command_rad_s());
            }
            self.motions.push(self.simulation.plant_state().to_array().to_vec());
        }
        self
    }

    fn reconfigured(mut self, change: impl FnOnce(&mut Configuration)) -> Self {
        let mut configuration = *self.simulation.configuration();
        change(&mut configuration);
        self.simulation.reconfigure(&configuration).unwrap();
        self
    }

    fn recorded(self) -> Recorded {
        Recorded { digest: format!("{:016x}", self.digest.0), motions: self.motions }
    }
}

/// A wind that changes, a force, a torque, and a goal that jumps.
fn eventful(time_us: u64) -> Inputs {
    let mut inputs = if time_us < 2_500_000 { goal(GOAL_M, 0.4) } else { goal([-3.0, 8.0, -6.0], -1.0) };
    inputs.disturbance.force_n.x = libm::sin(time_us as f64 * 3e-6);
    inputs.disturbance.torque_n_m.y = 0.01 * libm::cos(time_us as f64 * 5e-6);
    inputs.disturbance.wind_m_s = Vector3::new(3.0, -2.0 * libm::sin(time_us as f64 * 1e-6), 0.5);
    inputs
}

/// A circle with all its derivatives up to the acceleration.
fn circle(time_us: u64) -> Inputs {
    let (radius_m, rate_rad_s) = (3.0, 0.9);
    let angle = rate_rad_s * time_us as f64 * 1e-6;
    let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
    let around = |x: f64, y: f64| Vector3::new(x, y, 0.0) * radius_m;
    let reference = PositionReference {
        velocity_m_s: around(cosine, sine) * rate_rad_s,
        acceleration_m_s2: around(-sine, cosine) * (rate_rad_s * rate_rad_s),
        ..PositionReference::goal((around(sine, 1.0 - cosine) - Vector3::z() * 4.0).into(), 0.3 * sine)
    };
    Inputs { reference, ..Inputs::default() }
}

fn noisy(kind: ControllerKind) -> Configuration {
    let mut configuration = unshaped();
    configuration.controllers.kind = kind;
    configuration.sensors = Sensors {
        position_noise_m: 0.02,
        velocity_noise_m_s: 0.02,
        attitude_noise_rad: 0.003,
        body_rate_noise_rad_s: 0.01,
        seed: 7,
        ..Sensors::default()
    };
    configuration.airframe.drag_n_s_m = [0.15, 0.15, 0.25];
    configuration
}

fn of_preset(preset: AirframePreset) -> Flight {
    let configuration = Configuration { preset, reference: unshaped().reference, ..Configuration::default() };
    let inputs = goal([1.5, -1.0, -2.0], 0.5);
    Flight::new(&configuration.resolved().unwrap(), &inputs).fly(4, &inputs)
}

/// A take-off, a landing, and rest on the ground, in a wind.
fn from_the_ground() -> Flight {
    let mut configuration = Configuration { airframe: all_physics(), ..unshaped() };
    configuration.environment.ground_plane = true;
    let resting = Inputs { armed: false, ..Inputs::default() };
    let mut flying = goal([0.5, 0.0, -1.0], 0.2);
    flying.disturbance.wind_m_s = Vector3::new(1.0, -1.0, 0.0);
    let landing = |time_us: u64| {
        let height_m = (1.0 - (time_us as f64 * 1e-6 - 4.0) * 0.6).max(-0.1);
        Inputs { armed: time_us < 6_500_000, ..goal([0.5, 0.0, -height_m], 0.2) }
    };
    Flight::new(&configuration, &resting).fly(1, &resting).fly(3, &flying).fly(4, &landing)
}

/// A weak rotor, then one without power that is noticed later.
fn with_faults() -> Flight {
    let faults = |time_us: u64| {
        let mut inputs = goal([1.0, 1.0, -20.0], 0.0);
        if time_us >= 1_000_000 {
            inputs.rotor_faults[1] = Some(RotorFault::Weak { share: 0.8 });
        }
        if time_us >= 2_500_000 {
            inputs.rotor_faults[2] = Some(RotorFault::Off);
        }
        if time_us >= 2_600_000 {
            inputs.lost_rotor = Some(2);
        }
        inputs
    };
    Flight::new(&unshaped(), &faults(0)).fly(5, &faults)
}

/// An attitude target, then the cascade again.
fn by_attitude() -> Flight {
    let steered = |time_us: u64| {
        let target = AttitudeTarget {
            attitude: UnitQuaternion::from_euler_angles(0.2, -0.1, 0.5),
            body_rate_rad_s: Vector3::zeros(),
            thrust_n: 8.0,
        };
        Inputs { attitude_target: (time_us < 1_500_000).then_some(target), ..circle(time_us) }
    };
    Flight::new(&unshaped(), &steered(0)).fly(4, &steered)
}

/// A plan that is known ahead.
fn by_plan() -> Flight {
    let mut from = PositionReference::goal([0.0; 3], 0.0);
    from.jerk_m_s3.x = 1.0;
    let plan = ReferencePlan::new(0, &from);
    let planned =
        |time_us: u64| Inputs { reference: plan.at(time_us), plan: Some(plan), ..Inputs::default() };
    Flight::new(&unshaped(), &planned(0)).fly(3, &planned)
}

/// A payload that is dropped in flight, new weights, and a new sample time.
fn with_changes() -> Flight {
    let mut configuration = noisy(ControllerKind::Lmpc);
    configuration.airframe.mass_kg *= 1.3;
    Flight::new(&configuration, &eventful(0))
        .fly(2, &eventful)
        .reconfigured(|configuration| configuration.airframe.mass_kg /= 1.3)
        .fly(2, &eventful)
        .reconfigured(|configuration| {
            configuration.controllers.position.sample_time_us = 40_000;
            configuration.controllers.attitude.increment_weight *= 1.5;
            configuration.limits.tilt_rad = 0.3;
        })
        .fly(2, &eventful)
}

/// Flies a flight.
type Fly = fn() -> Flight;

/// The flights with their names. The shaper finds roots by the platform's C library: its flight is no other platform's.
fn flights() -> Vec<(&'static str, Fly)> {
    fn straight(configuration: &Configuration, inputs: &impl InputSignal) -> Flight {
        Flight::new(configuration, &inputs.at(0)).fly(5, inputs)
    }
    vec![
        ("default", || straight(&Configuration::default(), &Inputs::default())),
        ("raw goal", || straight(&unshaped(), &Inputs::default())),
        ("smooth", || straight(&unshaped(), &smooth_flight(GOAL_M, 0.5, 4.0))),
        ("circle", || straight(&unshaped(), &circle)),
        ("Laguerre MPC, wind and noise", || straight(&noisy(ControllerKind::Lmpc), &eventful)),
        ("state-space MPC, wind and noise", || straight(&noisy(ControllerKind::StateSpaceMpc), &eventful)),
        ("regulator, wind and noise", || straight(&noisy(ControllerKind::Dlqr), &eventful)),
        ("output feedback", || {
            let mut configuration = noisy(ControllerKind::Lmpc);
            configuration.sensors.output_feedback = true;
            straight(&configuration, &eventful)
        }),
        ("many terms", || {
            let mut configuration = unshaped();
            configuration.controllers.position.terms = 6;
            configuration.controllers.attitude.terms = 6;
            straight(&configuration, &eventful)
        }),
        ("the paper's models", || {
            let mut configuration = unshaped();
            configuration.controllers.model = PredictionModel::Paper;
            straight(&configuration, &smooth_flight(GOAL_M, 0.5, 4.0))
        }),
        ("all physics", || straight(&Configuration { airframe: all_physics(), ..unshaped() }, &eventful)),
        ("from the ground", from_the_ground),
        ("faults", with_faults),
        ("attitude target", by_attitude),
        ("plan", by_plan),
        ("changes", with_changes),
        ("Crazyflie", || of_preset(AirframePreset::Crazyflie)),
        ("Hummingbird", || of_preset(AirframePreset::Hummingbird)),
        ("Iris", || of_preset(AirframePreset::Iris)),
        ("Heavy", || of_preset(AirframePreset::Heavy)),
    ]
}

fn flown() -> BTreeMap<String, Recorded> {
    flights().into_iter().map(|(name, fly)| (name.to_owned(), fly().recorded())).collect()
}

fn file() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/suite/recorded/flights.json")
}

/// How far a flight is from the one that was recorded, relative to each number's usual magnitude.
fn difference(one: &Recorded, other: &Recorded) -> f64 {
    assert_eq!(one.motions.len(), other.motions.len());
    let airframe = Configuration::default().airframe;
    let nominal = PlantState::nominal(&airframe).to_array();
    let motions = one.motions.iter().zip(&other.motions);
    let differences = motions.flat_map(|(one, other)| {
        one.iter().zip(other).zip(nominal).map(|((one, other), usual)| (one - other).abs() / usual)
    });
    differences.fold(0.0, f64::max)
}

#[test]
fn flights_are_those_that_were_recorded() {
    let flown = flown();
    if std::env::var_os("RECORD_FLIGHTS").is_some() {
        std::fs::write(file(), serde_json::to_string_pretty(&flown).unwrap() + "\n").unwrap();
        return;
    }
    let recorded: BTreeMap<String, Recorded> =
        serde_json::from_str(&std::fs::read_to_string(file()).unwrap()).unwrap();
    assert!(flown.keys().eq(recorded.keys()), "record the flights anew");
    for (name, flight) in &flown {
        let difference = difference(flight, &recorded[name]);
        assert!(difference < ROUNDING, "{name}: another flight, by {difference:e}");
    }
    // Bits depend on the C library where the shaper flies, and motions do on no platform.
    if cfg!(all(target_os = "linux", target_arch = "x86_64")) {
        let other = |(name, flight): &(&String, &Recorded)| flight.digest != recorded[*name].digest;
        let others: Vec<_> = flown.iter().filter(other).map(|(name, _)| name).collect();
        assert!(others.is_empty(), "other bits of the same motions: {others:?}; see the head of this file");
    }
}
