//! The loss of a rotor: found by the rotors' measured speeds, told, and flown down without yaw control.

use nalgebra::{Vector2, Vector3};
use quadrotor::{PositionReference, RotorMonitor};

use super::failsafe::Action;
use super::motion::at_rest;
use super::notice::Severity;
use super::proposal::Proposal;
use super::situation::Situation;
use super::steering::Steering;
use super::tick::TICK_S;
use crate::mode::Mode;

/// It keeps its height at first: until it spins it can neither brake nor stay upright.
const SETTLING_US: u64 = 2_000_000;
/// Then it descends where it is as slow as this, m/s, horizontally …
const SLOW_M_S: f64 = 0.5;
/// … or, in a wind, after this long.
const LONGEST_BRAKING_US: u64 = 15_000_000;
/// Largest sink rate, m/s, and how much slower it sinks with each metre towards the ground, 1/s.
const FASTEST_SINK_M_S: f64 = 1.5;
const SLOWING_PER_S: f64 = 0.4;
/// Lower than this, m, and sinking no faster than this, m/s, for this long, µs, its lowest foot stands.
const TOUCHING_M: f64 = 0.15;
const TOUCHING_M_S: f64 = 0.2;
const TOUCHED_US: u64 = 100_000;

/// So near to home, m, it descends, and so fast it travels there, m/s.
const HOME_M: f64 = 0.5;
const TRAVELS_M_S: f64 = 1.0;

/// A rotor that is known to be lost.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Loss {
    rotor: usize,
    since_us: u64,
    /// North and east, m, of where it holds or descends.
    place_m: Option<[f64; 2]>,
    /// z of where it holds, or flies home, m.
    height_z_m: f64,
    touching_since_us: Option<u64>,
    /// Whether another one is lost, too: then no place can be held, and it sinks at once.
    falls: bool,
}

impl Loss {
    /// Holds the height where the mode does: in place, or on the way home, m. Returns the velocity of that, m/s; `None`: it descends.
    fn stay_up(&mut self, place_m: [f64; 2], situation: &Situation) -> Option<Vector3<f64>> {
        match situation.mode {
            Mode::Hold => Some(Vector3::zeros()),
            Mode::Return => {
                let way_m = situation.home.position_m.xy() - Vector2::from(place_m);
                let distance_m = way_m.norm();
                if distance_m <= HOME_M {
                    return None;
                }
                let velocity_m_s = way_m * (TRAVELS_M_S / distance_m);
                self.place_m = Some((Vector2::from(place_m) + velocity_m_s * TICK_S).into());
                Some(Vector3::new(velocity_m_s.x, velocity_m_s.y, 0.0))
            }
            _ => None,
        }
    }
}

/// What is known of the rotors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RotorWatch {
    monitor: RotorMonitor,
    loss: Option<Loss>,
}

impl RotorWatch {
    /// Begins with rotors at these speeds, rad/s.
    pub fn new(measured_rad_s: [f64; 4]) -> Self {
        Self { monitor: RotorMonitor::new(measured_rad_s), loss: None }
    }

    /// The rotor that is known to be lost: front (0), right, back or left (3).
    pub fn lost_rotor(&self) -> Option<usize> {
        self.loss.map(|loss| loss.rotor)
    }

    /// Whether more than one rotor is known to be lost.
    pub fn falls(&self) -> bool {
        self.loss.is_some_and(|loss| loss.falls)
    }

    /// Looks at the rotors' speeds after a tick of `dt_s`.
    pub fn watch(&mut self, situation: &Situation, proposal: &mut Proposal, dt_s: f64) {
        let measured = situation.truth.rotor_speed_rad_s;
        let Some(command_rad_s) = situation.rotor_command_rad_s.filter(|_| situation.armed) else {
            *self = Self::new(measured);
            return;
        };
        let airframe = &situation.configuration.airframe;
        // A weak battery slows all rotors.
        let share = airframe.battery.speed_share(situation.truth.battery.voltage_v);
        let reachable = command_rad_s.map(|command| command * share);
        let lost = self.monitor.update(airframe, &reachable, &measured, dt_s);
        if let (Some(rotor), None) = (lost, self.loss) {
            self.lose(rotor, situation, proposal);
        }
        let Some(rotor) = self.lost_rotor() else { return };
        let another = self.is_another_lost(rotor);
        if let Some(loss) = self.loss.as_mut().filter(|loss| another && !loss.falls) {
            loss.falls = true;
            proposal.say(Severity::Critical, "More than one rotor lost: falling");
        }
    }

    fn is_another_lost(&self, rotor: usize) -> bool {
        (0..4).any(|other| other != rotor && self.monitor.is_lost(other))
    }

    fn lose(&mut self, rotor: usize, situation: &Situation, proposal: &mut Proposal) {
        let number = rotor + 1;
        let settings = &situation.conduct.failsafe;
        if situation.landed && settings.rotor_failure > Action::Warn {
            proposal.stop_rotors(format!("Disarmed: rotor {number} failed"));
            return;
        }
        let alone = !self.is_another_lost(rotor);
        let what = match settings.rotor_failure {
            Action::Land if alone => ": descending without yaw control",
            Action::Hold if alone => ": holding without yaw control",
            Action::Return if alone => ": returning without yaw control",
            _ => "",
        };
        proposal.say(Severity::Critical, format!("Rotor {number} lost{what}"));
        let since_us = situation.time_us;
        // The failsafe sees it, and lands or terminates; if it only warns, the mode goes on with the rotors that are left.
        let height_z_m = situation.outputs.position_m.z;
        self.loss =
            Some(Loss { rotor, since_us, place_m: None, height_z_m, touching_since_us: None, falls: false });
    }

    /// One tick of the descent on the rotors that are left.
    pub fn descend(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let Some(loss) = &mut self.loss else { return };
        let (time_us, now) = (situation.time_us, situation.outputs);
        let lasting_us = time_us - loss.since_us;
        let slow = now.velocity_m_s.xy().norm() < SLOW_M_S && lasting_us >= SETTLING_US;
        if loss.place_m.is_none() && (slow || lasting_us >= LONGEST_BRAKING_US) {
            loss.place_m = Some(now.position_m.xy().into());
            loss.height_z_m = now.position_m.z;
        }
        let feet = situation.felt();
        let height_m = situation.true_ground_z_m() - feet.position_m.z;
        let touching = height_m < TOUCHING_M && feet.velocity_m_s.z < TOUCHING_M_S;
        loss.touching_since_us = if touching { loss.touching_since_us.or(Some(time_us)) } else { None };
        if loss.touching_since_us.is_some_and(|since_us| time_us - since_us >= TOUCHED_US) {
            proposal.stop_rotors(format!("Disarmed: landed without rotor {}", loss.rotor + 1));
            return;
        }
        if loss.falls {
            let reference = PositionReference {
                velocity_m_s: Vector3::new(0.0, 0.0, FASTEST_SINK_M_S),
                ..at_rest(now.position_m, now.attitude_rad.z)
            };
            proposal.steer(Steering::Descent { lost_rotor: loss.rotor, reference });
            return;
        }
        let stays_up = loss.place_m.and_then(|place_m| loss.stay_up(place_m, situation));
        let reference = match (loss.place_m, stays_up) {
            (Some([x, y]), Some(velocity_m_s)) => PositionReference {
                velocity_m_s,
                ..at_rest(Vector3::new(x, y, loss.height_z_m), now.attitude_rad.z)
            },
            (Some([x, y]), None) => {
                let landing = situation.conduct.land_speed_m_s;
                let sink = landing + SLOWING_PER_S * (situation.ground_z_m() - now.position_m.z - 2.0);
                let sink = sink.clamp(landing.min(FASTEST_SINK_M_S), FASTEST_SINK_M_S);
                PositionReference {
                    velocity_m_s: Vector3::new(0.0, 0.0, sink),
                    ..at_rest(Vector3::new(x, y, now.position_m.z), now.attitude_rad.z)
                }
            }
            (None, _) => at_rest(now.position_m, now.attitude_rad.z),
        };
        proposal.steer(Steering::Descent { lost_rotor: loss.rotor, reference });
    }
}

#[cfg(test)]
mod tests {
    use super::{Mode, RotorWatch, TOUCHED_US};
    use crate::vehicle::failsafe::Action;
    use crate::vehicle::proposal::Request;
    use crate::vehicle::scene::{Scene, said};
    use crate::vehicle::steering::Steering;

    const TICK_S: f64 = 0.001;

    /// Rotor 2 stops while the mixer goes on asking for its speed; returns what is asked for until the loss is known.
    fn lose_a_rotor(watch: &mut RotorWatch, scene: &mut Scene) -> Vec<Request> {
        scene.outputs.rotor_speed_rad_s[1] = 0.0;
        for _ in 0..2_000 {
            scene.wait_us(1_000);
            let requests = scene.show(|situation, proposal| watch.watch(situation, proposal, TICK_S));
            if !requests.is_empty() {
                scene.lost_rotor = watch.lost_rotor();
                return requests;
            }
        }
        panic!("not noticed")
    }

    fn descend(watch: &mut RotorWatch, scene: &mut Scene) -> Vec<Request> {
        scene.show(|situation, proposal| watch.descend(situation, proposal))
    }

    #[test]
    fn rotors_that_answer_are_not_lost() {
        let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]);
        let mut watch = RotorWatch::new(scene.outputs.rotor_speed_rad_s);
        for _ in 0..2_000 {
            let requests = scene.show(|situation, proposal| watch.watch(situation, proposal, TICK_S));
            assert!(requests.is_empty() && watch.lost_rotor().is_none());
        }
    }

    /// It holds its height as long as its mode does; on the way home it moves on towards it, and sinks there.
    #[test]
    fn a_lost_rotor_holds_or_comes_home_where_its_mode_does() {
        for (mode, velocity_m_s) in [(Mode::Hold, [0.0, 0.0, 0.0]), (Mode::Return, [-0.6, -0.8, 0.0])] {
            let mut scene = Scene::hovering_at([3.0, 4.0, -10.0]);
            let mut watch = RotorWatch::new(scene.outputs.rotor_speed_rad_s);
            lose_a_rotor(&mut watch, &mut scene);
            scene.mode = mode;
            scene.wait_us(3_000_000);
            descend(&mut watch, &mut scene);
            let velocity = |scene: &Scene| match &scene.steering {
                Steering::Descent { reference, .. } => reference.velocity_m_s,
                other => panic!("{other:?}"),
            };
            let error = velocity(&scene) - nalgebra::Vector3::from(velocity_m_s);
            assert!(error.norm() < 1e-9, "{mode:?}: {:?}", velocity(&scene));
            for _ in 0..10_000 {
                scene.wait_us(1_000);
                descend(&mut watch, &mut scene);
            }
            assert_eq!(velocity(&scene).z > 0.5, mode == Mode::Return, "{mode:?}: {:?}", velocity(&scene));
        }
    }

    #[test]
    fn a_lost_rotor_is_told_and_flown_down() {
        let mut scene = Scene::hovering_at([3.0, 4.0, -10.0]);
        let mut watch = RotorWatch::new(scene.outputs.rotor_speed_rad_s);
        let requests = lose_a_rotor(&mut watch, &mut scene);
        assert_eq!(said(&requests), ["Rotor 2 lost: descending without yaw control"]);
        assert_eq!(watch.lost_rotor(), Some(1));
        // Where the failsafe holds it does not sink; it lands here.
        scene.mode = Mode::Land;
        // First it settles at its height, then it sinks.
        assert!(descend(&mut watch, &mut scene).is_empty());
        let sink_m_s = |scene: &Scene| match &scene.steering {
            Steering::Descent { lost_rotor: 1, reference } => reference.velocity_m_s.z,
            other => panic!("{other:?}"),
        };
        assert_eq!(sink_m_s(&scene), 0.0);
        scene.wait_us(3_000_000);
        descend(&mut watch, &mut scene);
        assert!(sink_m_s(&scene) > 1.0);
        // On its feet for a moment, the rotors stop.
        scene.come_to([3.0, 4.0, -0.05], [0.0; 3]);
        assert!(descend(&mut watch, &mut scene).is_empty());
        scene.wait_us(TOUCHED_US);
        let landed = Request::StopRotors("Disarmed: landed without rotor 2".to_owned());
        assert_eq!(descend(&mut watch, &mut scene), [landed]);
    }

    #[test]
    fn on_the_ground_the_rotors_stop_and_nothing_is_lost() {
        let mut scene = Scene::on_the_ground();
        let mut watch = RotorWatch::new(scene.outputs.rotor_speed_rad_s);
        let requests = lose_a_rotor(&mut watch, &mut scene);
        assert_eq!(requests, [Request::StopRotors("Disarmed: rotor 2 failed".to_owned())]);
        assert_eq!(watch.lost_rotor(), None);
    }

    #[test]
    fn a_second_one_is_told_once_and_disarming_forgets_both() {
        let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]);
        scene.conduct.failsafe.rotor_failure = Action::Warn;
        let mut watch = RotorWatch::new(scene.outputs.rotor_speed_rad_s);
        assert_eq!(said(&lose_a_rotor(&mut watch, &mut scene)), ["Rotor 2 lost"]);
        scene.outputs.rotor_speed_rad_s[3] = 0.0;
        let mut lines = Vec::new();
        for _ in 0..2_000 {
            lines.extend(scene.show(|situation, proposal| watch.watch(situation, proposal, TICK_S)));
        }
        assert_eq!(said(&lines), ["More than one rotor lost: falling"]);
        scene.armed = false;
        scene.show(|situation, proposal| watch.watch(situation, proposal, TICK_S));
        assert_eq!(watch.lost_rotor(), None);
    }
}
