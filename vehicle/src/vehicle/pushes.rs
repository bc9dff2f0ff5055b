//! Pushes and twists that a user gives the simulated vehicle: ArduPilot's SIM_SHOVE and SIM_TWIST.

use nalgebra::Vector3;
use quadrotor::{Airframe, Outputs};
use serde::{Deserialize, Serialize};

/// An acceleration about or along the axes of the body, FRD, for a while.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Push {
    /// m/s² or rad/s².
    pub acceleration: Vector3<f64>,
    /// How long it lasts from when it is set, ms.
    pub time_ms: u32,
}

/// What a user asks for.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Pushes {
    /// Along the axes.
    pub shove: Push,
    /// About the axes.
    pub twist: Push,
}

/// Until when they last, µs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct PushClock {
    shove_end_us: u64,
    twist_end_us: u64,
}

impl PushClock {
    /// Other pushes are asked for at a time, µs: one whose duration has been changed begins.
    pub fn change(&mut self, before: &Pushes, now: &Pushes, time_us: u64) {
        let end = |push: &Push| time_us + 1000 * u64::from(push.time_ms);
        if now.shove.time_ms != before.shove.time_ms {
            self.shove_end_us = end(&now.shove);
        }
        if now.twist.time_ms != before.twist.time_ms {
            self.twist_end_us = end(&now.twist);
        }
    }

    /// Whether one of them has just ended at a time, µs: its duration is zero from then on.
    pub fn ends(&self, pushes: &Pushes, time_us: u64) -> [bool; 2] {
        [
            pushes.shove.time_ms > 0 && time_us >= self.shove_end_us,
            pushes.twist.time_ms > 0 && time_us >= self.twist_end_us,
        ]
    }

    /// Force, NED, N, and torque, FRD, N·m, of the pushes that last at a time, µs.
    pub fn load(
        &self,
        pushes: &Pushes,
        airframe: &Airframe,
        truth: &Outputs,
        time_us: u64,
    ) -> (Vector3<f64>, Vector3<f64>) {
        let lasting = |push: &Push, end_us: u64| {
            if push.time_ms > 0 && time_us < end_us { push.acceleration } else { Vector3::zeros() }
        };
        let along = lasting(&pushes.shove, self.shove_end_us);
        let about = lasting(&pushes.twist, self.twist_end_us);
        // Mostly nobody pushes.
        let force_n =
            if along == Vector3::zeros() { along } else { truth.orientation() * along * airframe.mass_kg };
        (force_n, about.component_mul(&Vector3::from(airframe.inertia_kg_m2)))
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;
    use quadrotor::Airframe;

    use super::{Push, PushClock, Pushes};
    use crate::vehicle::scene::Scene;

    #[test]
    fn a_push_lasts_from_when_its_duration_is_set() {
        let scene = Scene::hovering_at([0.0, 0.0, -10.0]);
        let push = |time_ms| Pushes {
            shove: Push { acceleration: Vector3::new(0.0, 0.0, -30.0), time_ms },
            twist: Push { acceleration: Vector3::new(40.0, 0.0, 0.0), time_ms },
        };
        let mut clock = PushClock::default();
        clock.change(&push(0), &push(500), 1_000_000);
        let airframe = Airframe::default();
        let load = |time_us| clock.load(&push(500), &airframe, &scene.outputs, time_us);
        let (force_n, torque_n_m) = load(1_499_999);
        assert!((force_n.z + 30.0 * airframe.mass_kg).abs() < 1e-12 && force_n.xy().norm() < 1e-12);
        assert!((torque_n_m.x - 40.0 * airframe.inertia_kg_m2[0]).abs() < 1e-12);
        assert_eq!(load(1_500_000), (Vector3::zeros(), Vector3::zeros()));
        assert_eq!(
            [clock.ends(&push(500), 1_499_999), clock.ends(&push(500), 1_500_000)],
            [[false; 2], [true; 2]]
        );
    }
}
