//! Flies set-points that come as JSON on the standard input, from rest on the ground, and answers with the motion at
//! the times that are asked for, one line each:
//!
//! ```text
//! {"shaping": true, "samples_us": [1000000],
//!  "set_points": [{"time_us": 0, "position": [0, 0, -2], "velocity": [0, 0, 0], "acceleration": [0, 0, 0], "yaw": 0.5}]}
//! [x, y, z, v_x, v_y, v_z, phi, theta, psi, p, q, r]
//! ```
//!
//! Without shaping a set-point is a point of a trajectory that runs on: p + (v + a/2 t) t.

use std::error::Error;
use std::io::{Write, read_to_string, stdin, stdout};

use nalgebra::Vector3;
use quadrotor::{Configuration, Inputs, PositionReference, Simulation};
use serde::Deserialize;

#[derive(Deserialize)]
struct Flight {
    shaping: bool,
    set_points: Vec<SetPoint>,
    samples_us: Vec<u64>,
}

#[derive(Clone, Copy, Deserialize)]
struct SetPoint {
    time_us: u64,
    position: [f64; 3],
    velocity: [f64; 3],
    acceleration: [f64; 3],
    yaw: f64,
}

fn main() -> Result<(), Box<dyn Error>> {
    let flight: Flight = serde_json::from_str(&read_to_string(stdin())?)?;
    let mut configuration = Configuration::default();
    configuration.environment.ground_plane = true;
    configuration.reference.shaping = flight.shaping;
    let inputs = |time_us: u64| {
        let latest = flight.set_points.iter().rev().find(|set_point| set_point.time_us <= time_us);
        Inputs {
            armed: latest.is_some(),
            reference: latest
                .map_or(PositionReference::goal([0.0; 3], 0.0), |latest| latest.reference(time_us)),
            ..Inputs::default()
        }
    };
    let mut simulation = Simulation::new(&configuration, &Inputs { armed: false, ..Inputs::default() })?;
    let mut output = stdout().lock();
    for time_us in flight.samples_us {
        simulation.advance_to(time_us, &inputs)?;
        let outputs = simulation.outputs();
        let vectors =
            [outputs.position_m, outputs.velocity_m_s, outputs.attitude_rad, outputs.body_rate_rad_s];
        let numbers: Vec<f64> = vectors.iter().flat_map(|vector| vector.iter().copied()).collect();
        writeln!(output, "{}", serde_json::to_string(&numbers)?)?;
    }
    Ok(())
}

impl SetPoint {
    fn reference(&self, time_us: u64) -> PositionReference {
        let (velocity_m_s, acceleration_m_s2) =
            (Vector3::from(self.velocity), Vector3::from(self.acceleration));
        let t = (time_us - self.time_us) as f64 / 1e6;
        PositionReference {
            position_m: Vector3::from(self.position) + (velocity_m_s + acceleration_m_s2 / 2.0 * t) * t,
            velocity_m_s: velocity_m_s + acceleration_m_s2 * t,
            acceleration_m_s2,
            ..PositionReference::goal([0.0; 3], self.yaw)
        }
    }
}
