//! A motion capture system: it sees the true motion from a place of its own, and sends what it sees.

use crate::common::failsafe_bench::set;
use crate::common::{Bench, settings};
use mavlink::dialects::ardupilotmega::*;
use nalgebra::{UnitQuaternion, Vector3};
use vehicle::estimation::{SensorModel, SensorSettings};
use vehicle::identity::Identity;

/// Where it counts from, and what it gets wrong.
#[derive(Clone, Copy)]
pub struct Camera {
    /// Its origin in the simulated world, NED, m.
    pub origin_m: [f64; 3],
    /// Where its first axis points, from north, rad.
    pub turn_rad: f64,
    /// Error of its positions, along its axes, m.
    pub error_m: [f64; 3],
    /// How often it has begun anew.
    pub resets: u8,
}

impl Camera {
    /// At the start of the flight, along north.
    pub const ALIGNED: Self = Self { origin_m: [0.0; 3], turn_rad: 0.0, error_m: [0.0; 3], resets: 0 };

    /// The true place as it counts, m.
    pub fn place_m(&self, bench: &Bench) -> Vector3<f64> {
        let truth = bench.autopilot.vehicle().truth();
        self.turn().inverse() * (truth.position_m - Vector3::from(self.origin_m))
            + Vector3::from(self.error_m)
    }

    /// The true attitude in its frame.
    pub fn attitude(&self, bench: &Bench) -> UnitQuaternion<f64> {
        self.turn().inverse() * bench.autopilot.vehicle().truth().orientation()
    }

    /// The true velocity in its frame, m/s.
    pub fn velocity_m_s(&self, bench: &Bench) -> Vector3<f64> {
        self.turn().inverse() * bench.autopilot.vehicle().truth().velocity_m_s
    }

    fn turn(&self) -> UnitQuaternion<f64> {
        UnitQuaternion::from_axis_angle(&Vector3::z_axis(), self.turn_rad)
    }

    /// VISION_POSITION_ESTIMATE of now.
    pub fn estimate(&self, bench: &Bench) -> MavMessage {
        let [x, y, z] = single(self.place_m(bench));
        let (roll, pitch, yaw) = self.attitude(bench).euler_angles();
        MavMessage::VISION_POSITION_ESTIMATE(VISION_POSITION_ESTIMATE_DATA {
            usec: bench.autopilot.vehicle().time_us(),
            x,
            y,
            z,
            roll: roll as f32,
            pitch: pitch as f32,
            yaw: yaw as f32,
            reset_counter: self.resets,
            ..VISION_POSITION_ESTIMATE_DATA::default()
        })
    }

    /// ODOMETRY of now: pose in its frame, velocity in the vehicle's.
    pub fn odometry(&self, bench: &Bench) -> MavMessage {
        let attitude = self.attitude(bench);
        let [x, y, z] = single(self.place_m(bench));
        let [vx, vy, vz] = single(attitude.inverse() * self.velocity_m_s(bench));
        MavMessage::ODOMETRY(ODOMETRY_DATA {
            time_usec: bench.autopilot.vehicle().time_us(),
            frame_id: MavFrame::MAV_FRAME_LOCAL_FRD,
            child_frame_id: MavFrame::MAV_FRAME_BODY_FRD,
            estimator_type: MavEstimatorType::MAV_ESTIMATOR_TYPE_VISION,
            x,
            y,
            z,
            q: [attitude.w as f32, attitude.i as f32, attitude.j as f32, attitude.k as f32],
            vx,
            vy,
            vz,
            reset_counter: self.resets,
            quality: 90,
            ..ODOMETRY_DATA::default()
        })
    }

    /// VISION_SPEED_ESTIMATE of now.
    pub fn speed(&self, bench: &Bench) -> MavMessage {
        let [x, y, z] = single(self.velocity_m_s(bench));
        MavMessage::VISION_SPEED_ESTIMATE(VISION_SPEED_ESTIMATE_DATA {
            usec: bench.autopilot.vehicle().time_us(),
            x,
            y,
            z,
            reset_counter: self.resets,
            ..VISION_SPEED_ESTIMATE_DATA::default()
        })
    }
}

/// A vehicle of an identity with instruments, and parameters.
pub fn started(identity: Identity, parameters: &[(&str, f64)]) -> Bench {
    let mut start = settings(identity);
    start.sensors = SensorSettings { model: SensorModel::Realistic, seed: 1 };
    let mut bench = Bench::of(&start);
    for (name, value) in parameters {
        set(&mut bench, name, *value);
    }
    bench
}

/// Until a time is over.
pub fn never(_: &Bench) -> bool {
    false
}

fn single(vector: Vector3<f64>) -> [f32; 3] {
    vector.data.0[0].map(|axis| axis as f32)
}

/// Thirty looks a second for a time, until a condition holds; whether it did.
pub fn watch(
    bench: &mut Bench,
    seconds: f64,
    see: impl Fn(&Bench) -> Vec<MavMessage>,
    until: impl Fn(&Bench) -> bool,
) -> bool {
    for _ in 0..(seconds * 30.0) as usize {
        for message in see(bench) {
            bench.send(message);
        }
        bench.fly(0.033);
        if until(bench) {
            return true;
        }
    }
    false
}

/// By how much the place that is known differs from one, m.
pub fn off_m(bench: &Bench, place_m: Vector3<f64>) -> f64 {
    (bench.autopilot.vehicle().outputs().position_m - place_m).norm()
}

/// What speaks against arming.
pub fn obstacles(bench: &Bench) -> Vec<String> {
    bench.autopilot.vehicle().arming_obstacles().iter().map(|obstacle| obstacle.text.to_string()).collect()
}
