//! A target below that is seen, by a simulated sensor or by a companion computer: landings go to it, and ArduPilot's precision loiter
//! stays above it.

use nalgebra::Vector3;

use super::notice::Severity;
use super::precision_settings::PrecisionSettings;
use super::proposal::Proposal;
use super::set_point::{AxisTarget, PositionSetPoint};
use super::situation::Situation;
use crate::world::Geodetic;

/// The simulated sensor looks this often, µs.
const LOOK_US: u64 = 40_000;
/// A target counts once it has been seen for so long, µs: that of ArduPilot's estimator.
const SETTLED_US: u64 = 2_000_000;
/// One that has not been seen for so long, µs, is lost.
const LOST_US: u64 = 2_000_000;
/// Time constant with which a new sighting counts beside those before, s.
const SMOOTHING_S: f64 = 0.3;
/// A sighting this far from those before, m, is another target.
const ELSEWHERE_M: f64 = 2.0;
/// A sighting this far beside the vehicle, m, is a mistake.
const FARTHEST_M: f64 = 100.0;
/// Sticks that are deflected less are centred.
const CENTRED: f64 = 0.02;

/// What a companion computer has seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sighting {
    /// In a direction, FRD, at a distance, m, if that is known.
    Direction(Vector3<f64>, Option<f64>),
    /// From the vehicle, level, forwards, to the right and down, m.
    Level(Vector3<f64>),
}

/// The target.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct PrecisionLanding {
    /// Where it is, NED, m, since when it is seen, and when it was seen last, µs.
    target: Option<(Vector3<f64>, u64, u64)>,
    /// Whether it has been told that it counts.
    told: bool,
    /// Whether a switch of the pilot lets Loiter stay above it.
    loiters: bool,
}

impl PrecisionLanding {
    /// Where the target is, NED, m, if there is one that counts.
    pub fn target_m(&self) -> Option<Vector3<f64>> {
        self.target.filter(|_| self.told).map(|(target_m, ..)| target_m)
    }

    /// North and east of it, m, if landings go to it.
    pub fn place_m(&self, settings: &PrecisionSettings) -> Option<[f64; 2]> {
        self.target_m().filter(|_| settings.enabled).map(|target_m| target_m.xy().into())
    }

    /// When it was seen last, µs.
    pub fn seen_us(&self) -> Option<u64> {
        self.target.map(|(.., seen_us)| seen_us)
    }

    /// Lets Loiter stay above it, or not.
    pub fn let_loiter(&mut self, loiters: bool) {
        self.loiters = loiters;
    }

    /// Takes what a companion computer sees.
    pub fn take(&mut self, situation: &Situation, range_m: Option<f64>, sighting: Sighting) {
        let outputs = situation.outputs;
        let way_m = match sighting {
            Sighting::Level(way_m) => {
                nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), outputs.attitude_rad.z) * way_m
            }
            Sighting::Direction(direction, distance_m) => {
                let direction = outputs.orientation() * direction;
                let height_m = situation.home.position_m.z - outputs.position_m.z;
                let below_m = range_m.unwrap_or(height_m);
                // What is told to be beside or above the vehicle is nowhere without a distance.
                let along_m = distance_m.or((direction.z > 0.1).then(|| below_m / direction.z));
                let Some(along_m) = along_m else { return };
                direction * along_m
            }
        };
        if way_m.xy().norm() < FARTHEST_M {
            self.see(outputs.position_m + way_m, situation.time_us);
        }
    }

    /// Looks for the simulated target, and tells what has been found or lost.
    pub fn watch(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let (settings, time_us) = (&situation.conduct.precision, situation.time_us);
        if settings.sees() && time_us.is_multiple_of(LOOK_US) {
            self.look(situation, settings);
        }
        let Some((_, since_us, seen_us)) = self.target else { return };
        let counts = settings.enabled && time_us <= seen_us + LOST_US;
        if !counts {
            (self.target, self.told) = (None, false);
            proposal.say(Severity::Info, "PrecLand: Target Lost");
        } else if since_us == seen_us && time_us == seen_us {
            proposal.say(Severity::Info, "PrecLand: Target Found");
        } else if !self.told && seen_us >= since_us + SETTLED_US {
            self.told = true;
            proposal.say(Severity::Info, "PrecLand: Init Complete");
        }
    }

    /// In Loiter, with centred sticks, stays above the target if the pilot's switch says so.
    pub fn stay_above(&self, situation: &Situation, proposal: &mut Proposal) {
        let centred = |deflection: f64| deflection.abs() < CENTRED;
        let free =
            situation.pilot.sticks.is_none_or(|sticks| centred(sticks.forward) && centred(sticks.right));
        let target_m = situation.landing_target_m.filter(|_| self.loiters && free && !situation.landed);
        if let (Some(target_m), Some(asked)) = (target_m, proposal.steering().asked()) {
            proposal.follow(situation, &above(target_m, asked));
        }
    }

    fn look(&mut self, situation: &Situation, settings: &PrecisionSettings) {
        let origin = situation.frame.origin();
        let at_start = settings.latitude_deg == 0.0 && settings.longitude_deg == 0.0;
        let place = Geodetic {
            latitude_deg: if at_start { origin.latitude_deg } else { settings.latitude_deg },
            longitude_deg: if at_start { origin.longitude_deg } else { settings.longitude_deg },
            altitude_m: origin.altitude_m + settings.height_m,
        };
        let way_m = situation.frame.to_local_m(&place) - situation.truth.position_m;
        if settings.is_in_beam(way_m.xy().norm(), way_m.z) {
            self.see(situation.outputs.position_m + way_m, situation.time_us);
        }
    }

    fn see(&mut self, place_m: Vector3<f64>, time_us: u64) {
        self.target = Some(match self.target {
            Some((target_m, since_us, seen_us)) if (place_m - target_m).xy().norm() < ELSEWHERE_M => {
                let dt_s = time_us.saturating_sub(seen_us) as f64 / 1e6;
                let share = dt_s / (SMOOTHING_S + dt_s);
                (target_m + (place_m - target_m) * share, since_us, time_us)
            }
            // It counts already: it has moved, or it is another one.
            Some((_, since_us, _)) => (place_m, since_us, time_us),
            None => (place_m, time_us, time_us),
        });
    }
}

/// What is asked for, above a target, north and east, m.
fn above([x, y]: [f64; 2], asked: PositionSetPoint) -> PositionSetPoint {
    let [_, _, down] = asked.axes;
    PositionSetPoint { axes: [AxisTarget::Position(x), AxisTarget::Position(y), down], yaw: asked.yaw }
}

#[cfg(test)]
mod tests {
    use core::f64::consts::FRAC_PI_2;

    use super::{PrecisionLanding, Sighting, Vector3};
    use crate::vehicle::precision_settings::{BeaconBeam, PrecisionSettings};
    use crate::vehicle::scene::{Scene, said};

    fn scene(sensor: u8) -> Scene {
        let mut scene = Scene::hovering_at([3.0, 4.0, -10.0]).of_ardupilot();
        scene.conduct.precision =
            PrecisionSettings { enabled: true, sensor, simulated: true, ..PrecisionSettings::default() };
        scene.wait_us(40_000);
        scene
    }

    fn watch(landing: &mut PrecisionLanding, scene: &mut Scene) -> Vec<String> {
        let requests = scene.show(|situation, proposal| landing.watch(situation, proposal));
        said(&requests).into_iter().map(str::to_owned).collect()
    }

    #[test]
    fn a_target_is_found_counts_after_a_while_and_is_lost() {
        let (mut scene, mut landing) = (scene(4), PrecisionLanding::default());
        let mut told = Vec::new();
        for _ in 0..52 {
            told.extend(watch(&mut landing, &mut scene));
            scene.wait_us(40_000);
        }
        assert_eq!(told, ["PrecLand: Target Found", "PrecLand: Init Complete"]);
        assert!(landing.target_m().is_some_and(|target_m| target_m.norm() < 1e-9));
        scene.conduct.precision.simulated = false;
        scene.wait_us(2_000_001);
        assert_eq!(watch(&mut landing, &mut scene), ["PrecLand: Target Lost"]);
        assert_eq!(landing.target_m(), None);
    }

    #[test]
    fn loiter_stays_above_a_target_only_while_landings_go_to_it() {
        let (mut scene, place_m) = (scene(4), Vector3::new(1.0, 2.0, 0.0));
        let landing = PrecisionLanding { target: Some((place_m, 0, 0)), told: true, loiters: true };
        for (enabled, goal_m) in [(false, [3.0, 4.0, -10.0]), (true, [1.0, 2.0, -10.0])] {
            scene.conduct.precision.enabled = enabled;
            scene.landing_target_m = landing.place_m(&scene.conduct.precision);
            scene.show(|situation, proposal| landing.stay_above(situation, proposal));
            assert_eq!(scene.goal_m(), Some(goal_m), "{enabled}");
        }
    }

    #[test]
    fn a_direction_leads_to_the_ground_or_so_far_as_it_says() {
        let (mut scene, diagonal) = (scene(1), Vector3::new(0.6, 0.0, 0.8));
        scene.outputs.attitude_rad.z = FRAC_PI_2;
        let half = FRAC_PI_2 / 2.0;
        scene.outputs.quaternion = [half.cos(), 0.0, 0.0, half.sin()];
        for (sighting, range_m, expected) in [
            (Sighting::Direction(diagonal, None), None, [3.0, 11.5, 0.0]),
            (Sighting::Direction(diagonal, None), Some(8.0), [3.0, 10.0, -2.0]),
            (Sighting::Direction(diagonal, Some(5.0)), Some(8.0), [3.0, 7.0, -6.0]),
            (Sighting::Level(Vector3::new(1.0, 2.0, 9.0)), None, [1.0, 5.0, -1.0]),
        ] {
            let mut landing = PrecisionLanding::default();
            landing.take(&scene.situation(), range_m, sighting);
            let (target_m, ..) = landing.target.expect("a target");
            assert!((target_m - Vector3::from(expected)).norm() < 1e-9, "{target_m} {expected:?}");
        }
        let mut landing = PrecisionLanding::default();
        landing.take(&scene.situation(), None, Sighting::Direction(Vector3::x(), None));
        assert_eq!(landing.target, None, "beside, and no distance");
        landing.take(&scene.situation(), None, Sighting::Direction(Vector3::x(), Some(101.0)));
        assert_eq!(landing.target, None, "too far");
    }

    #[test]
    fn the_beam_has_its_shape() {
        let of = |beam| PrecisionSettings { beam, ..PrecisionSettings::default() };
        for (beam, beside_m, above_m, seen) in [
            (BeaconBeam::Cylinder, 9.0, 1.0, true),
            (BeaconBeam::Cylinder, 11.0, 1.0, false),
            (BeaconBeam::Cylinder, 0.0, 16.0, false),
            (BeaconBeam::Cone, 9.0, 14.0, true),
            (BeaconBeam::Cone, 9.0, 1.0, false),
            (BeaconBeam::Sphere, 8.0, 5.0, true),
            (BeaconBeam::Sphere, 8.0, 7.0, false),
        ] {
            assert_eq!(of(beam).is_in_beam(beside_m, above_m), seen, "{beam:?} {beside_m} {above_m}");
        }
    }
}
