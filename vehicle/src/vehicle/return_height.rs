//! How high a return flies.

use super::situation::Situation;

/// ArduPilot's lowest height of the way, m, and its shallowest cone.
const LOWEST_M: f64 = 0.3;
const SHALLOWEST: f64 = 0.5;

/// Height of the way to a place at a horizontal distance, z, m: never lower than the vehicle is, and not above the fence.
pub(super) fn way_z_m(situation: &Situation, distance_m: f64) -> f64 {
    // What its height counts from.
    let base_z_m =
        if follows_ground(situation) { situation.ground_z_m() } else { situation.home.position_m.z };
    let here_m = base_z_m - situation.outputs.position_m.z;
    let wanted_m = if situation.identity.is_ardupilot() {
        ardupilot_height_m(situation, here_m, distance_m)
    } else {
        px4_height_m(situation, distance_m)
    };
    let mut z_m = situation.outputs.position_m.z.min(base_z_m - wanted_m);
    if let Some(ceiling_z_m) = situation.fence_ceiling_z_m() {
        z_m = z_m.max(ceiling_z_m);
    }
    z_m
}

/// Whether the way follows the ground.
pub(super) fn follows_ground(situation: &Situation) -> bool {
    situation.identity.is_ardupilot()
        && situation.conduct.return_home.above_ground
        && !situation.terrain.is_flat()
}

/// At least a climb, and near home not above a cone that widens with the height.
fn ardupilot_height_m(situation: &Situation, here_m: f64, distance_m: f64) -> f64 {
    let settings = &situation.conduct.return_home;
    let least_m = LOWEST_M.max(here_m + settings.least_climb_m.max(0.0));
    let height_m = situation.conduct.return_height_m.max(least_m);
    if settings.cone_slope < SHALLOWEST {
        return height_m;
    }
    height_m.min((distance_m * settings.cone_slope).max(least_m))
}

/// Near the place it stays below the full height, within a cone, and never so low that it touches the ground on the way.
fn px4_height_m(situation: &Situation, distance_m: f64) -> f64 {
    let conduct = situation.conduct;
    let (height_m, cone_rad) = (conduct.return_height_m, conduct.return_home.cone_rad);
    if distance_m <= conduct.acceptance_radius_m {
        return 2.0 * distance_m;
    }
    let near = distance_m <= conduct.return_near_m && cone_rad > 0.0;
    let wanted_m = if near { height_m.min(distance_m / libm::tan(cone_rad)) } else { height_m };
    wanted_m.max(2.0 * conduct.acceptance_radius_m)
}

#[cfg(test)]
mod tests {
    use super::way_z_m;
    use crate::vehicle::scene::Scene;

    /// Height above home, m, at which it flies home.
    fn height_m(scene: &Scene) -> f64 {
        let situation = scene.situation();
        let distance_m = (situation.outputs.position_m - situation.home.position_m).xy().norm();
        let height_m = situation.home.position_m.z - way_z_m(&situation, distance_m);
        (height_m * 100.0).round() / 100.0
    }

    /// PX4: within RTL_MIN_DIST, 10 m, in a cone of 45°, and at least twice the acceptance radius.
    #[test]
    fn near_home_it_need_not_climb_as_high() {
        for (north_m, present_m, expected_m) in [
            (4.5, 1.0, 4.5),
            (3.0, 1.0, 4.0),
            (1.0, 1.5, 2.0),
            (3.0, 10.0, 10.0),
            (9.5, 1.0, 9.5),
            (10.5, 1.0, 30.0),
        ] {
            let scene = Scene::hovering_at([north_m, 0.0, -present_m]);
            assert_eq!(height_m(&scene), expected_m, "{north_m} m away at {present_m} m");
        }
        let mut wide = Scene::hovering_at([4.5, 0.0, -1.0]);
        wide.conduct.return_home.cone_rad = 0.0;
        assert_eq!(height_m(&wide), 30.0);
    }

    fn ardupilot(position_m: [f64; 3]) -> Scene {
        Scene::hovering_at(position_m).of_ardupilot()
    }

    #[test]
    fn ardupilot_climbs_by_its_cone_and_its_least_climb() {
        // RTL_ALT is 15 m, the cone's slope 3.
        for (north_m, expected_m) in [(40.0, 15.0), (3.0, 9.0), (1.0, 5.0)] {
            assert_eq!(height_m(&ardupilot([north_m, 0.0, -5.0])), expected_m, "{north_m} m away");
        }
        let mut scene = ardupilot([40.0, 0.0, -14.0]);
        scene.conduct.return_home.least_climb_m = 4.0;
        assert_eq!(height_m(&scene), 18.0);
        let mut scene = ardupilot([1.0, 0.0, -5.0]);
        scene.conduct.return_home.cone_slope = 0.0;
        assert_eq!(height_m(&scene), 15.0);
    }
}
