//! Sticks do not lead over the fence: ArduPilot's avoidance (AVOID_ENABLE).

use nalgebra::{Vector2, Vector3};

use super::set_point::{AxisTarget, PositionSetPoint};
use super::situation::Situation;
use crate::fence::{Fence, Shape, distance_to};
use crate::mode::Mode;

/// Of AVOID_ENABLE.
const FENCE: u8 = 1;
/// How fast the speed towards a border falls with the room, 1/s.
const GAIN_PER_S: f64 = 1.0;
/// Share of the acceleration that braking plans with.
const SHARE: f64 = 0.5;
/// A difference of speed that does not matter, m/s.
const SMALL_M_S: f64 = 1e-6;
/// Faster towards a border than it may be by this, m/s, it brakes that before anything else.
const TOO_FAST_M_S: f64 = 0.5;
/// How far apart places are whose room is compared, m.
const APART_M: f64 = 0.05;

/// Whether sticks lead the vehicle now, and are kept from leading it over the fence: not on its way to a place.
pub fn keeps_sticks_inside(situation: &Situation) -> bool {
    let has_sticks = situation.pilot.sticks.is_some() || situation.pilot.released;
    let by_sticks = || situation.steering.asked().is_some_and(|asked| asked.is_velocity());
    matches!(situation.mode, Mode::Position | Mode::ZigZag) && applies(situation) && has_sticks && by_sticks()
}

fn applies(situation: &Situation) -> bool {
    situation.identity.is_ardupilot()
        && situation.conduct.surroundings.avoided & FENCE != 0
        && !situation.landed
}

/// A velocity that leads over the fence, or into its margin, is slowed down; one that begins there leads back.
pub fn keep_inside(situation: &Situation, set_point: PositionSetPoint) -> PositionSetPoint {
    let Some(fence) = situation.fence().filter(|_| applies(situation)) else { return set_point };
    let [AxisTarget::Velocity(north), AxisTarget::Velocity(east), AxisTarget::Velocity(down)] =
        set_point.axes
    else {
        return set_point;
    };
    let over_ground = lead_over_ground(situation, &fence, Vector2::new(north, east));
    let down = keep_height(situation, &fence, down);
    let velocity = Vector3::new(over_ground.x, over_ground.y, down);
    PositionSetPoint { axes: velocity.data.0[0].map(AxisTarget::Velocity), ..set_point }
}

/// The velocity over ground that is steered to. Who comes too fast towards a border brakes that first: what the sticks ask for
/// sideways would take its share of the acceleration, and of the way that is left.
fn lead_over_ground(situation: &Situation, fence: &Fence, asked: Vector2<f64>) -> Vector2<f64> {
    let now = situation.outputs.velocity_m_s.xy();
    let kept = keep_over_ground(situation, fence, now);
    if (now - kept).norm() > TOO_FAST_M_S { kept } else { keep_over_ground(situation, fence, asked) }
}

/// In a corner what one side leaves may lead over the other: they are looked at in turns, so often at most.
const TURNS: usize = 8;

fn keep_over_ground(situation: &Situation, fence: &Fence, velocity: Vector2<f64>) -> Vector2<f64> {
    let mut velocity = velocity;
    for _ in 0..TURNS {
        let kept = kept_once(situation, fence, velocity);
        if (kept - velocity).norm() < SMALL_M_S {
            return kept;
        }
        velocity = kept;
    }
    velocity
}

/// What every border leaves of a velocity, one after the other.
fn kept_once(situation: &Situation, fence: &Fence, mut velocity: Vector2<f64>) -> Vector2<f64> {
    let margin_m = situation.conduct.failsafe.fence_margin_m;
    let acceleration = situation.limits().acceleration_horizontal_m_s2;
    let here = situation.outputs.position_m.xy();
    let mut keep = |room_m: &dyn Fn(Vector2<f64>) -> f64| {
        let slope = |axis: Vector2<f64>| room_m(here + axis * APART_M) - room_m(here - axis * APART_M);
        let inwards = Vector2::new(slope(Vector2::x()), slope(Vector2::y()));
        let Some(outwards) = (-inwards).try_normalize(f64::EPSILON) else { return };
        let allowed = allowed_m_s(situation, room_m(here) - margin_m, acceleration);
        let too_fast = velocity.dot(&outwards) - allowed;
        if too_fast > 0.0 {
            velocity -= outwards * too_fast;
        }
    };
    if fence.radius_m > 0.0 {
        keep(&|place| fence.radius_m - (place - fence.home_m.xy()).norm());
    }
    for zone in fence.zones_alone() {
        match &zone.shape {
            Shape::Polygon(polygon) if !zone.forbids(here.into()) => {
                for side in polygon.sides() {
                    keep(&|place| distance_to(&side, place.into()));
                }
            }
            _ => keep(&|place| zone.room_m(place.into())),
        }
    }
    if fence.room_in_any_m(here.into()).is_some() {
        keep(&|place| fence.room_in_any_m(place.into()).unwrap_or(f64::NEG_INFINITY));
    }
    velocity
}

/// A velocity down that keeps above the floor, if that counts, and below the ceiling.
fn keep_height(situation: &Situation, fence: &Fence, down_m_s: f64) -> f64 {
    let settings = &situation.conduct.failsafe;
    let height_m = fence.home_m.z - situation.outputs.position_m.z;
    let acceleration = situation.limits().acceleration_vertical_m_s2;
    let allowed = |room_m: f64| allowed_m_s(situation, room_m - settings.fence_margin_m, acceleration);
    let mut down_m_s = down_m_s;
    if fence.height_m > 0.0 {
        down_m_s = down_m_s.max(-allowed(fence.height_m - height_m));
    }
    if situation.fence_parts().floor && situation.fence_floor_counts {
        down_m_s = down_m_s.min(allowed(height_m - situation.fence_floor_m()));
    }
    down_m_s
}

/// The fastest towards a border with so much room before it, m/s; negative beyond it.
pub(super) fn allowed_m_s(situation: &Situation, room_m: f64, acceleration_m_s2: f64) -> f64 {
    if room_m < 0.0 {
        return (GAIN_PER_S * room_m).max(-situation.conduct.surroundings.backing_m_s);
    }
    let brakes_m_s2 = SHARE * acceleration_m_s2;
    let bend_m = brakes_m_s2 / (GAIN_PER_S * GAIN_PER_S);
    if room_m < bend_m {
        return GAIN_PER_S * room_m;
    }
    // Constant braking down to where the gain takes over.
    libm::sqrt(2.0 * brakes_m_s2 * (room_m - 0.5 * bend_m))
}

#[cfg(test)]
mod tests {
    use super::{AxisTarget, PositionSetPoint, keep_inside};
    use crate::fence::{Polygon, Shape, Zone};
    use crate::vehicle::scene::Scene;
    use crate::vehicle::set_point::YawTarget;

    fn scene() -> Scene {
        let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]).of_ardupilot();
        let settings = &mut scene.conduct.failsafe;
        (settings.fence_enabled, settings.fence_radius_m, settings.fence_height_m) = (true, 15.0, 30.0);
        settings.fence_margin_m = 3.0;
        scene
    }

    /// The velocity that is left of one.
    fn kept(scene: &Scene, velocity_m_s: [f64; 3]) -> [f64; 3] {
        let asked = PositionSetPoint { axes: velocity_m_s.map(AxisTarget::Velocity), yaw: YawTarget::Hold };
        keep_inside(&scene.situation(), asked).axes.map(|axis| match axis {
            AxisTarget::Velocity(velocity_m_s) => velocity_m_s,
            other => panic!("{other:?}"),
        })
    }

    #[test]
    fn what_leads_outwards_ends_at_the_margin() {
        let mut scene = scene();
        let mut at = |north_m: f64| {
            scene.come_to([north_m, 0.0, -10.0], [0.0; 3]);
            kept(&scene, [5.0, 1.0, 0.0])
        };
        assert!(at(0.0)[0] > at(6.0)[0] && at(6.0)[0] > 1.0, "the nearer, the slower");
        let [north, east, _] = at(11.5);
        assert!((north - 0.5).abs() < 1e-6 && (east - 1.0).abs() < 1e-6, "{north} {east}");
        assert!(at(12.0)[0].abs() < 1e-6);
        assert!((at(14.0)[0] + 0.75).abs() < 1e-6, "it backs away");
        scene.come_to([12.0, 0.0, -10.0], [0.0; 3]);
        assert_eq!(kept(&scene, [-5.0, 0.0, 0.0]), [-5.0, 0.0, 0.0], "inwards it may go");
        scene.conduct.surroundings.avoided = 2;
        assert_eq!(kept(&scene, [5.0, 0.0, 0.0]), [5.0, 0.0, 0.0]);
    }

    /// Coming in fast it keeps what leads along the border until it is slow enough towards it, whatever the sticks ask for.
    #[test]
    fn who_comes_too_fast_brakes_that_first() {
        let mut scene = scene();
        let sideways = [0.0, -5.0, 0.0];
        scene.come_to([8.0, 0.0, -10.0], [7.0, 2.0, 0.0]);
        let [north, east, _] = kept(&scene, sideways);
        assert!((0.0..4.0).contains(&north) && (east - 2.0).abs() < 1e-6, "{north} {east}");
        scene.come_to([8.0, 0.0, -10.0], [north, 2.0, 0.0]);
        assert_eq!(kept(&scene, sideways), sideways);
    }

    /// Two areas far from one another: where one is enough, sticks are free in it.
    #[test]
    fn another_area_leads_nobody_out_of_the_one_that_is_enough() {
        let mut scene = scene();
        let area = |north_m: f64| Zone {
            shape: Shape::Circle { centre_m: [north_m, 0.0], radius_m: 10.0 },
            inclusion: true,
        };
        scene.zones.zones = vec![area(0.0), area(100.0)];
        scene.come_to([-2.0, 0.0, -10.0], [0.0; 3]);
        assert!(kept(&scene, [-1.0, 0.0, 0.0])[0] > 0.0, "it is not where both are");
        scene.conduct.failsafe.fence_options.union = true;
        assert_eq!(kept(&scene, [-1.0, 0.0, 0.0]), [-1.0, 0.0, 0.0]);
        scene.come_to([-7.0, 0.0, -10.0], [0.0; 3]);
        assert!(kept(&scene, [-1.0, 0.0, 0.0])[0].abs() < 1e-6, "it ends at the margin");
    }

    /// In the acute corner of a triangle, a velocity into it is left by neither side.
    #[test]
    fn nothing_leads_into_a_corner() {
        let mut scene = scene();
        let corners = vec![[0.0, 0.0], [20.0, -10.0], [20.0, 10.0]];
        let shape = Shape::Polygon(Polygon::new(corners).expect("a triangle"));
        scene.zones.zones = vec![Zone { shape, inclusion: true }];
        // As far from both sides as the margin, 3 m.
        let corner_m = 3.0 / (0.5_f64.atan()).sin();
        scene.come_to([corner_m, 0.0, -10.0], [0.0; 3]);
        for velocity in [[-2.0, 0.0, 0.0], [-2.0, 1.0, 0.0], [-1.0, 2.0, 0.0]] {
            let [north, east, _] = kept(&scene, velocity);
            let outwards = |side: f64| (-north + 2.0 * side * east) / 5.0_f64.sqrt();
            let most = outwards(1.0).max(outwards(-1.0));
            assert!(most < 0.1, "{velocity:?}: {north} {east}");
        }
    }

    #[test]
    fn a_climb_ends_below_the_ceiling() {
        let mut scene = scene();
        let mut climb = |height_m: f64| {
            scene.come_to([0.0, 0.0, -height_m], [0.0; 3]);
            -kept(&scene, [0.0, 0.0, -2.0])[2]
        };
        assert_eq!(climb(10.0), 2.0);
        assert!((climb(26.5) - 0.5).abs() < 1e-9);
        assert!((climb(29.0) + 0.75).abs() < 1e-9);
    }
}
