//! Whether the vehicle can hold its position, or what pushes it needs more tilt or thrust than the limits allow.

use quadrotor::{commanded_thrust_n, commanded_tilt_rad};

use super::notice::Severity;
use super::proposal::Proposal;
use super::situation::Situation;
use super::steering::SteeringKind;

/// Farther than this from its reference, m, the vehicle does not hold its position.
const OFF_M: f64 = 1.0;
/// Nearer than this, m, it holds it again.
const BACK_M: f64 = 0.5;
/// Faster than this, m/s, it approaches its reference: it is about to hold it.
const APPROACHING_M_S: f64 = 0.5;
/// From this share of the largest command on, tilt and thrust count as at their limits: there is nothing left to come back with.
const AT_LIMIT: f64 = 0.97;
/// Either must last this long, µs, before it is announced.
const LASTING_US: u64 = 2_000_000;
/// Wind slower than this, m/s, is not what pushes.
const CALM_M_S: f64 = 1.0;

/// Announces when the vehicle cannot hold its position, and when it can again.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct HoldWatch {
    /// Whether it was announced that it cannot.
    lost: bool,
    /// Since when the opposite of what was announced is seen, µs.
    since_us: Option<u64>,
}

impl HoldWatch {
    /// Looks at the motion after a tick.
    pub fn watch(&mut self, situation: &Situation, proposal: &mut Proposal) {
        if !follows_a_position(situation) {
            *self = Self::default();
            return;
        }
        let changing = if self.lost { is_back(situation) } else { is_pushed_off(situation) };
        if !changing {
            self.since_us = None;
            return;
        }
        let since_us = *self.since_us.get_or_insert(situation.time_us);
        if situation.time_us - since_us < LASTING_US {
            return;
        }
        *self = Self { lost: !self.lost, since_us: None };
        if self.lost {
            proposal.say(Severity::Warning, reason(situation));
        } else {
            proposal.say(Severity::Info, "Holding position again");
        }
    }
}

/// Whether it flies by a position that it knows, and does not come down without a rotor.
fn follows_a_position(situation: &Situation) -> bool {
    situation.armed
        && !situation.landed
        && situation.descends_without_rotor().is_none()
        && situation.steering.kind() == SteeringKind::Position
        && situation.knows_its_place()
}

/// Distance from the reference, m.
fn distance_m(situation: &Situation) -> f64 {
    let now = situation.outputs;
    (now.setpoint.position_m - now.position_m).norm()
}

fn is_back(situation: &Situation) -> bool {
    distance_m(situation) < BACK_M
}

/// Whether it is off its reference, a limit is reached, and it still does not come nearer.
fn is_pushed_off(situation: &Situation) -> bool {
    let now = situation.outputs;
    let distance_m = distance_m(situation);
    if distance_m < OFF_M {
        return false;
    }
    let away = (now.position_m - now.setpoint.position_m) / distance_m;
    let closing_m_s = -away.dot(&(now.velocity_m_s - now.setpoint.velocity_m_s));
    closing_m_s < APPROACHING_M_S && limit_reached(situation).is_some()
}

/// The limit that keeps it from doing more.
fn limit_reached(situation: &Situation) -> Option<&'static str> {
    let now = situation.outputs;
    let [phi, theta] = now.tilt_reference_rad;
    let tilt_rad = libm::acos(libm::cos(phi) * libm::cos(theta));
    if tilt_rad >= AT_LIMIT * commanded_tilt_rad(situation.configuration) {
        return Some("tilt");
    }
    (now.thrust_n >= AT_LIMIT * commanded_thrust_n(situation.configuration)).then_some("thrust")
}

fn reason(situation: &Situation) -> String {
    let wind_m_s = situation.wind_m_s.norm();
    let dragged = situation.configuration.airframe.hover_drag_n_s_m().iter().any(|drag| *drag > 0.0);
    if dragged && wind_m_s >= CALM_M_S {
        format!("Cannot hold position in {wind_m_s:.0} m/s wind")
    } else {
        format!("Cannot hold position: {} limit reached", limit_reached(situation).unwrap_or("tilt"))
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;
    use quadrotor::{commanded_thrust_n, commanded_tilt_rad};

    use super::{HoldWatch, LASTING_US};
    use crate::vehicle::scene::{Scene, said};

    /// Looks for longer than anything must last; what is said.
    fn look(watch: &mut HoldWatch, scene: &mut Scene) -> Vec<String> {
        let mut lines = Vec::new();
        for _ in 0..=LASTING_US / 1_000 {
            let requests = scene.show(|situation, proposal| watch.watch(situation, proposal));
            lines.extend(said(&requests).into_iter().map(str::to_owned));
            scene.wait_us(1_000);
        }
        lines
    }

    /// Off its reference to the north by a distance, m, moving on at a speed, m/s, with a share of the largest tilt command.
    fn off(scene: &mut Scene, distance_m: f64, speed_m_s: f64, tilt: f64) {
        scene.outputs.position_m = scene.outputs.setpoint.position_m + Vector3::new(distance_m, 0.0, 0.0);
        scene.outputs.velocity_m_s.x = speed_m_s;
        scene.outputs.tilt_reference_rad = [0.0, tilt * commanded_tilt_rad(&scene.configuration)];
    }

    #[test]
    fn a_push_beyond_the_tilt_limit_is_announced_once_and_cleared() {
        let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]);
        let mut watch = HoldWatch::default();
        off(&mut scene, 2.0, 0.3, 1.0);
        assert_eq!(look(&mut watch, &mut scene), ["Cannot hold position: tilt limit reached"]);
        assert!(look(&mut watch, &mut scene).is_empty(), "once");
        off(&mut scene, 0.7, -0.3, 0.5);
        assert!(look(&mut watch, &mut scene).is_empty(), "not there yet");
        off(&mut scene, 0.1, 0.0, 0.5);
        assert_eq!(look(&mut watch, &mut scene), ["Holding position again"]);
    }

    #[test]
    fn a_vehicle_that_sinks_at_full_thrust_does_not_hold_its_position() {
        let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]);
        scene.outputs.position_m.z = -8.0;
        scene.outputs.thrust_n = commanded_thrust_n(&scene.configuration);
        let said = look(&mut HoldWatch::default(), &mut scene);
        assert_eq!(said, ["Cannot hold position: thrust limit reached"]);
    }

    #[test]
    fn the_wind_is_named_where_it_pushes() {
        let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]);
        scene.wind_m_s = Vector3::new(0.0, 32.2, 0.0);
        scene.configuration.airframe.drag_n_s_m = [0.15; 3];
        off(&mut scene, 2.0, 0.0, 1.0);
        assert_eq!(look(&mut HoldWatch::default(), &mut scene), ["Cannot hold position in 32 m/s wind"]);
    }

    #[test]
    fn who_comes_nearer_leans_less_or_follows_no_position_is_not_pushed_off() {
        for (distance_m, speed_m_s, tilt) in [(0.9, 0.0, 1.0), (5.0, -2.0, 1.0), (5.0, 0.0, 0.9)] {
            let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]);
            off(&mut scene, distance_m, speed_m_s, tilt);
            assert!(
                look(&mut HoldWatch::default(), &mut scene).is_empty(),
                "{distance_m} {speed_m_s} {tilt}"
            );
        }
        for change in [
            |scene: &mut Scene| scene.armed = false,
            |scene: &mut Scene| scene.landed = true,
            |scene: &mut Scene| scene.lost_rotor = Some(0),
            |scene: &mut Scene| scene.validity.horizontal_position = false,
        ] {
            let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]);
            off(&mut scene, 5.0, 0.0, 1.0);
            change(&mut scene);
            assert!(look(&mut HoldWatch::default(), &mut scene).is_empty());
        }
    }
}
