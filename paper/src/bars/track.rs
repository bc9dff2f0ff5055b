//! What a flight looked like.

use std::path::Path;
use std::{fs, io};

use nalgebra::Vector3;
use quadrotor::{PlantState, Wrench};

/// Time between the moments of a track, µs.
pub const STEP_US: u64 = 10_000;

/// One moment of a flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Time since the start, s.
    pub time_s: f64,
    /// Position in NED, m.
    pub position_m: Vector3<f64>,
    /// Velocity in NED, m/s.
    pub velocity_m_s: Vector3<f64>,
    /// φ, θ, ψ (ZYX), rad.
    pub attitude_rad: Vector3<f64>,
    /// p, q, r in FRD, rad/s.
    pub body_rate_rad_s: Vector3<f64>,
    /// Thrust of the four rotors, N.
    pub thrust_n: f64,
    /// Torques of the four rotors in FRD, N·m.
    pub torque_n_m: Vector3<f64>,
    /// Where the vehicle was asked to be, NED, m.
    pub reference_m: Vector3<f64>,
}

impl Moment {
    /// Of a plant.
    pub fn of(time_s: f64, plant: &PlantState, wrench: &Wrench, reference_m: Vector3<f64>) -> Self {
        let (phi, theta, psi) = plant.body.rotation().euler_angles();
        Self {
            time_s,
            position_m: plant.body.position_m,
            velocity_m_s: plant.body.velocity_m_s,
            attitude_rad: Vector3::new(phi, theta, psi),
            body_rate_rad_s: plant.body.body_rate_rad_s,
            thrust_n: wrench.thrust_n,
            torque_n_m: wrench.torque_n_m,
            reference_m,
        }
    }

    /// Position minus reference, m.
    pub fn error_m(&self) -> Vector3<f64> {
        self.position_m - self.reference_m
    }

    /// Angle between the thrust axis and the vertical, rad: cos = cos φ cos θ.
    pub fn tilt_rad(&self) -> f64 {
        (self.attitude_rad.x.cos() * self.attitude_rad.y.cos()).clamp(-1.0, 1.0).acos()
    }
}

/// A flight, every 10 ms.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Track {
    /// In the order of time.
    pub moments: Vec<Moment>,
}

impl Track {
    /// Writes the flight of a flyer to a file in a folder, which is made where there is none, as [`Self::csv`] has it.
    ///
    /// # Errors
    /// Of the file system.
    pub fn write_csv(&self, folder: &Path, flight: &str, flyer: &str) -> io::Result<()> {
        let flight = flight.replace(|c: char| !c.is_ascii_alphanumeric() && c != '.', "-");
        fs::create_dir_all(folder)?;
        fs::write(folder.join(format!("{flight}-{flyer}.csv")), self.csv())
    }

    /// Its columns as comma-separated values with a header.
    pub fn csv(&self) -> String {
        let mut text = "time,north,east,down,v_north,v_east,v_down,phi,theta,psi,p,q,r,thrust,\
                        torque_phi,torque_theta,torque_psi,reference_north,reference_east,reference_down\n"
            .to_owned();
        for moment in &self.moments {
            let vectors = [
                moment.position_m,
                moment.velocity_m_s,
                moment.attitude_rad,
                moment.body_rate_rad_s,
                Vector3::from_element(moment.thrust_n),
                moment.torque_n_m,
                moment.reference_m,
            ];
            let mut numbers = vec![moment.time_s];
            for (index, vector) in vectors.iter().enumerate() {
                // The thrust is one number.
                numbers.extend(vector.iter().take(if index == 4 { 1 } else { 3 }));
            }
            let row: Vec<String> = numbers.iter().map(ToString::to_string).collect();
            text.push_str(&row.join(","));
            text.push('\n');
        }
        text
    }
}
