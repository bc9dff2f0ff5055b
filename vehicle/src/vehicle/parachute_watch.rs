//! When the parachute is released by itself: ArduCopter's check for lost control, a sink rate, and rotors that cannot carry the vehicle.

use super::crash_watch::{LEAST_ERROR_RAD, attitude_error_rad, keeps_a_lean};
use super::lasting::Lasting;
use super::situation::Situation;

/// Control is lost after so long, µs.
const LOST_US: u64 = 1_000_000;

/// What has been seen of a vehicle with a parachute.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct ParachuteWatch {
    uncontrolled: Lasting,
    sinking: Lasting,
}

impl ParachuteWatch {
    /// Whether control is lost in the air. `falls` tells that more than one rotor is lost.
    pub fn is_needed(&mut self, situation: &Situation, falls: bool) -> bool {
        let settings = &situation.conduct.equipment.parachute;
        if !settings.enabled || !situation.armed || situation.landed || !reaches(situation) {
            *self = Self::default();
            return false;
        }
        let sink_m_s = situation.outputs.velocity_m_s.z;
        let off = keeps_a_lean(situation) && attitude_error_rad(situation) > LEAST_ERROR_RAD;
        let uncontrolled = self.uncontrolled.update(off && sink_m_s > 0.0, situation.time_us, LOST_US);
        let too_fast = settings.fastest_m_s > 0.0 && sink_m_s > settings.fastest_m_s;
        let sinking = self.sinking.update(too_fast, situation.time_us, LOST_US);
        uncontrolled || sinking || falls
    }
}

/// Whether the vehicle is high enough for the parachute.
pub fn reaches(situation: &Situation) -> bool {
    let height_m = situation.home.position_m.z - situation.outputs.position_m.z;
    let least_m = situation.conduct.equipment.parachute.least_height_m;
    least_m <= 0.0 || height_m >= least_m
}

#[cfg(test)]
mod tests {
    use super::ParachuteWatch;
    use crate::vehicle::scene::Scene;

    fn scene(height_m: f64) -> Scene {
        let mut scene = Scene::hovering_at([0.0, 0.0, -height_m]).of_ardupilot();
        scene.conduct.equipment.parachute.enabled = true;
        scene
    }

    #[test]
    fn it_is_needed_where_control_is_lost_high_enough() {
        for (height_m, enabled, needed) in [(20.0, true, true), (9.0, true, false), (20.0, false, false)] {
            let mut scene = scene(height_m);
            scene.conduct.equipment.parachute.enabled = enabled;
            assert_eq!(ParachuteWatch::default().is_needed(&scene.situation(), true), needed);
            assert!(!ParachuteWatch::default().is_needed(&scene.situation(), false));
        }
    }

    #[test]
    fn it_is_needed_once_the_vehicle_has_sunk_too_fast_for_a_second() {
        let (mut scene, mut watch) = (scene(50.0), ParachuteWatch::default());
        scene.conduct.equipment.parachute.fastest_m_s = 5.0;
        scene.outputs.velocity_m_s.z = 6.0;
        assert!(!watch.is_needed(&scene.situation(), false));
        scene.wait_us(999_999);
        assert!(!watch.is_needed(&scene.situation(), false));
        scene.wait_us(1);
        assert!(watch.is_needed(&scene.situation(), false));
    }
}
