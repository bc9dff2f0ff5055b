//! A pilot of ArduPilot's changes its circle: forwards makes it smaller, to the right makes it faster clockwise.

use super::situation::Situation;
use super::tick::TICK_S;

/// How fast a full stick changes the rate, rad/s².
const CHANGE_RAD_S2: f64 = core::f64::consts::PI / 180.0;
/// The largest rate, rad/s.
const FASTEST_RAD_S: f64 = core::f64::consts::FRAC_PI_2;

/// What the sticks do to a circle.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct CirclePilot {
    /// How fast it widens, m/s.
    widens_m_s: f64,
    /// Whether the stick is deflected that has stopped the circle, or begun it.
    changes_rate: bool,
}

impl CirclePilot {
    /// Whether the sticks change the circle, or have and it still moves outwards or inwards.
    pub fn acts(&mut self, situation: &Situation) -> bool {
        let deflected = forward_right(situation).is_some_and(|sticks| sticks != [0.0; 2]);
        self.changes_rate &= deflected;
        deflected || self.widens_m_s != 0.0
    }

    /// How fast the circle widens, m/s: the speed of missions for a full stick, within an acceleration, m/s².
    pub fn widen(
        &mut self,
        situation: &Situation,
        radius_m: f64,
        least_m: f64,
        acceleration_m_s2: f64,
    ) -> f64 {
        let limits = situation.limits();
        let asked_m_s =
            forward_right(situation).map_or(0.0, |[forward, _]| -forward * limits.speed_horizontal_m_s);
        // Towards the least radius only as fast as it can stop there.
        let inwards_m_s = libm::sqrt(2.0 * acceleration_m_s2 * (radius_m - least_m).max(0.0));
        let step_m_s = acceleration_m_s2 * TICK_S;
        self.widens_m_s += (asked_m_s.max(-inwards_m_s) - self.widens_m_s).clamp(-step_m_s, step_m_s);
        self.widens_m_s
    }

    /// The rate, rad/s, positive clockwise. Through a stop it goes only after the stick was let go.
    pub fn rate_rad_s(&mut self, situation: &Situation, rate_rad_s: f64) -> f64 {
        let right = forward_right(situation).map_or(0.0, |[_, right]| right);
        if right == 0.0 {
            self.changes_rate = false;
            return rate_rad_s;
        }
        let changed = rate_rad_s + right * CHANGE_RAD_S2 * TICK_S;
        let wanted = if rate_rad_s > 0.0 {
            changed.clamp(0.0, FASTEST_RAD_S)
        } else if rate_rad_s < 0.0 {
            changed.clamp(-FASTEST_RAD_S, 0.0)
        } else if self.changes_rate {
            0.0
        } else {
            changed
        };
        self.changes_rate = true;
        wanted
    }
}

/// The sticks without their dead zones, where they count.
fn forward_right(situation: &Situation) -> Option<[f64; 2]> {
    let counts = situation.identity.is_ardupilot() && situation.conduct.orbit.sticks_change_it();
    let sticks = situation.pilot.present_sticks().filter(|_| counts)?;
    let live = sticks.live(&situation.conduct.sticks);
    Some([live.forward, live.right])
}

#[cfg(test)]
mod tests {
    use super::{CHANGE_RAD_S2, CirclePilot};
    use crate::vehicle::scene::Scene;
    use crate::vehicle::sticks::Sticks;

    fn circling(sticks: Sticks) -> Scene {
        let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]).of_ardupilot();
        scene.pilot.sticks = Some(sticks);
        scene
    }

    /// ArduCopter changes the rate by one degree per second in a second, and stops at zero until the stick was let go.
    #[test]
    fn the_rate_changes_by_a_degree_per_second_each_second_and_stops_at_zero() {
        let mut scene = circling(Sticks { right: -1.0, ..Sticks::default() });
        let mut pilot = CirclePilot::default();
        let mut rate = 1.5 * CHANGE_RAD_S2;
        let fly = |pilot: &mut CirclePilot, scene: &Scene, rate: &mut f64, ticks: usize| {
            (0..ticks).for_each(|_| *rate = pilot.rate_rad_s(&scene.situation(), *rate));
        };
        fly(&mut pilot, &scene, &mut rate, 1_000);
        assert!((rate - 0.5 * CHANGE_RAD_S2).abs() < 1e-9, "{rate}");
        fly(&mut pilot, &scene, &mut rate, 2_000);
        assert_eq!(rate, 0.0);
        scene.pilot.sticks = Some(Sticks::default());
        fly(&mut pilot, &scene, &mut rate, 1);
        scene.pilot.sticks = Some(Sticks { right: -1.0, ..Sticks::default() });
        fly(&mut pilot, &scene, &mut rate, 1_000);
        assert!((rate + CHANGE_RAD_S2).abs() < 1e-9, "the other way: {rate}");
        scene.conduct.orbit.options = 0;
        fly(&mut pilot, &scene, &mut rate, 1_000);
        assert!((rate + CHANGE_RAD_S2).abs() < 1e-9, "not with this option: {rate}");
    }

    #[test]
    fn the_circle_never_gets_smaller_than_its_least_radius() {
        let scene = circling(Sticks { forward: 1.0, ..Sticks::default() });
        let (mut pilot, mut radius_m) = (CirclePilot::default(), 10.0);
        for _ in 0..20_000 {
            radius_m += pilot.widen(&scene.situation(), radius_m, 1.0, 0.5) * 1e-3;
            assert!(radius_m > 0.99, "{radius_m}");
        }
        assert!(radius_m < 1.01, "{radius_m}");
    }
}
