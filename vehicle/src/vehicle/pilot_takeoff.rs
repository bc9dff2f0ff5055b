//! ArduPilot's takeoff by hand: a raised throttle lifts off, and the vehicle climbs on to a height by itself (PILOT_TKOFF_ALT).

use super::motion::approach;
use super::situation::Situation;

/// So near to its height, m, a takeoff is over.
const REACHED_M: f64 = 0.02;
/// How fast the climb ends: its rate per metre that is left, 1/s, and the share of the acceleration that brakes it.
const SLOWING_PER_S: f64 = 0.8;
const BRAKING_SHARE: f64 = 0.5;

/// The height that a takeoff by hand leads to.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct PilotTakeoff {
    /// z, m.
    goal_z_m: Option<f64>,
}

impl PilotTakeoff {
    /// A command leads to z, m.
    pub fn aim(&mut self, z_m: f64) {
        self.goal_z_m = Some(z_m);
    }

    /// Whether one goes on.
    pub fn goes_on(&self) -> bool {
        self.goal_z_m.is_some()
    }

    /// The climb rate that is flown where the pilot asks for one, m/s. A lowered throttle ends the takeoff.
    pub fn climb_m_s(&mut self, situation: &Situation, asked_m_s: f64) -> f64 {
        let conduct = situation.conduct;
        let z_m = situation.outputs.position_m.z;
        let goes_on = conduct.pilot_takeoff_m > 0.0 && situation.identity.is_ardupilot();
        if situation.landed && asked_m_s > 0.0 && goes_on {
            self.goal_z_m = Some(z_m - conduct.pilot_takeoff_m);
        }
        let left_m = |goal_z_m: f64| z_m - goal_z_m;
        self.goal_z_m = self.goal_z_m.filter(|goal| asked_m_s >= 0.0 && left_m(*goal) > REACHED_M);
        self.goal_z_m.map_or(asked_m_s, |goal_z_m| {
            let braking_m_s2 = BRAKING_SHARE * situation.limits().acceleration_vertical_m_s2;
            approach(left_m(goal_z_m), SLOWING_PER_S, braking_m_s2).min(conduct.stick_climb_m_s)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::PilotTakeoff;
    use crate::vehicle::scene::Scene;

    /// A scene on the ground, with a height of 7 m.
    fn scene() -> Scene {
        let mut scene = Scene::on_the_ground().of_ardupilot();
        scene.conduct.pilot_takeoff_m = 7.0;
        scene
    }

    #[test]
    fn it_climbs_on_to_its_height_once_it_has_lifted_off() {
        let mut scene = scene();
        let mut takeoff = PilotTakeoff::default();
        let mut climb = |scene: &Scene, asked_m_s| takeoff.climb_m_s(&scene.situation(), asked_m_s);
        assert_eq!(climb(&scene, 0.0), 0.0, "nothing was asked for");
        assert!(climb(&scene, 0.5) > 1.0);
        assert!(climb(&scene, 0.0) > 1.0, "before it has lifted off, too");
        scene.landed = false;
        scene.come_to([0.0, 0.0, -1.0], [0.0; 3]);
        assert!(climb(&scene, 0.0) > 1.0, "it goes on by itself");
        scene.come_to([0.0, 0.0, -6.9], [0.0; 3]);
        assert!(climb(&scene, 0.0) < 0.1, "it ends gently");
        scene.come_to([0.0, 0.0, -6.99], [0.0; 3]);
        assert_eq!(climb(&scene, 0.0), 0.0);
        scene.come_to([0.0, 0.0, -3.0], [0.0; 3]);
        assert_eq!(climb(&scene, 0.0), 0.0, "it is over");
    }

    #[test]
    fn a_lowered_throttle_ends_it_and_without_a_height_there_is_none() {
        let mut scene = scene();
        let mut takeoff = PilotTakeoff::default();
        takeoff.climb_m_s(&scene.situation(), 1.0);
        scene.landed = false;
        assert_eq!(takeoff.climb_m_s(&scene.situation(), -0.5), -0.5);
        assert_eq!(takeoff.climb_m_s(&scene.situation(), 0.0), 0.0);
        scene.landed = true;
        scene.conduct.pilot_takeoff_m = 0.0;
        assert_eq!(takeoff.climb_m_s(&scene.situation(), 1.0), 1.0);
    }
}
