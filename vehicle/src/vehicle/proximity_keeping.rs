//! Sticks do not lead up to what is measured around: ArduPilot's avoidance (AVOID_ENABLE).

use nalgebra::Vector2;

use super::fence_keeping::allowed_m_s;
use super::set_point::{AxisTarget, PositionSetPoint};
use super::situation::Situation;

/// A velocity that leads into the margin of things, north and east of here, m, is slowed down and slides along them; one that begins there
/// leads away. `None`: other set-points, and those that it leaves as they are.
pub fn keep_away(
    situation: &Situation,
    things_m: &[Vector2<f64>],
    asked: &PositionSetPoint,
) -> Option<PositionSetPoint> {
    let [AxisTarget::Velocity(north), AxisTarget::Velocity(east), down @ AxisTarget::Velocity(_)] =
        asked.axes
    else {
        return None;
    };
    let margin_m = situation.conduct.surroundings.obstacle_distance_m;
    let acceleration = situation.limits().acceleration_horizontal_m_s2;
    let wanted = Vector2::new(north, east);
    let mut velocity = wanted;
    for thing_m in things_m {
        let Some(towards) = thing_m.try_normalize(f64::EPSILON) else { continue };
        let too_fast =
            velocity.dot(&towards) - allowed_m_s(situation, thing_m.norm() - margin_m, acceleration);
        if too_fast > 0.0 {
            velocity -= towards * too_fast;
        }
    }
    let axes = [AxisTarget::Velocity(velocity.x), AxisTarget::Velocity(velocity.y), down];
    (velocity != wanted).then_some(PositionSetPoint { axes, yaw: asked.yaw })
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector2;

    use super::{AxisTarget, PositionSetPoint, keep_away};
    use crate::identity::Identity;
    use crate::surroundings::Reading;
    use crate::vehicle::scene::Scene;
    use crate::vehicle::set_point::YawTarget;
    use crate::vehicle::{Conduct, Vehicle, VehicleSettings};

    /// What is left of a velocity beside a thing that is so far north, m.
    fn beside(north_m: f64, velocity_m_s: [f64; 2]) -> Option<[f64; 2]> {
        let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]);
        scene.conduct = Conduct::new(true);
        let [north, east] = velocity_m_s.map(AxisTarget::Velocity);
        let asked = PositionSetPoint { axes: [north, east, AxisTarget::HOLD], yaw: YawTarget::Hold };
        let kept = keep_away(&scene.situation(), &[Vector2::new(north_m, 0.0)], &asked)?;
        let velocity = |axis| match axis {
            AxisTarget::Velocity(velocity_m_s) => velocity_m_s,
            other => panic!("{other:?}"),
        };
        Some([velocity(kept.axes[0]), velocity(kept.axes[1])])
    }

    /// What a companion computer tells ten times a second at 0.2 m ahead.
    #[test]
    fn a_vehicle_backs_away_at_its_speed() {
        let mut vehicle = Vehicle::new(&VehicleSettings::new(Identity::ArduPilot)).expect("valid settings");
        let mut conduct = *vehicle.conduct();
        conduct.surroundings.proximity_kind = 2;
        vehicle.adopt(&vehicle.kept_configuration(), &conduct).expect("valid");
        let pulses = |throttle_us| {
            core::array::from_fn(|channel| [1500, 1500, throttle_us, 1500].get(channel).copied().unwrap_or(0))
        };
        let fly = |vehicle: &mut Vehicle, seconds: f64| {
            for _ in 0..(seconds * 1000.0) as usize {
                vehicle.tick().expect("the flight goes on");
            }
        };
        vehicle.receive_radio(pulses(1000));
        fly(&mut vehicle, 0.5);
        vehicle.arm(false).expect("in Loiter");
        vehicle.receive_radio(pulses(2000));
        fly(&mut vehicle, 5.0);
        vehicle.receive_radio(pulses(1500));
        fly(&mut vehicle, 5.0);
        let mut go_on = |seconds: u32| {
            let start_m = vehicle.outputs().position_m.x;
            for _ in 0..10 * seconds {
                vehicle.see_ahead(0.0, core::f64::consts::FRAC_PI_4, Reading::At(0.2));
                fly(&mut vehicle, 0.1);
            }
            (start_m - vehicle.outputs().position_m.x) / f64::from(seconds)
        };
        go_on(2);
        // In the mean: it swings about the speed.
        let back_m_s = go_on(4);
        assert!((0.7..0.9).contains(&back_m_s), "{back_m_s}");
    }

    /// The margin is 2 m.
    #[test]
    fn it_slides_along_and_backs_away() {
        assert_eq!(beside(30.0, [5.0, 1.0]), None, "far away");
        let [north, east] = beside(2.5, [5.0, 1.0]).expect("near");
        assert!((north - 0.5).abs() < 1e-9 && east == 1.0, "{north} {east}");
        let [north, _] = beside(0.2, [0.0, 0.0]).expect("within the margin");
        assert!((north + 0.75).abs() < 1e-9, "{north}");
        assert_eq!(beside(2.5, [-5.0, 1.0]), None, "away from it");
    }
}
