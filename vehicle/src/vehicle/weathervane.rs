//! ArduPilot's weathervaning: in a wind the vehicle turns until it leans about one axis only.

use serde::{Deserialize, Serialize};

use super::motion::wrapped;
use super::notice::Severity;
use super::proposal::Proposal;
use super::situation::Situation;
use super::tick::TICK_S;
use crate::mode::Mode;

/// It begins when nothing has spoken against it for so long, µs.
const BEGINS_AFTER_US: u64 = 2_000_000;
/// Time constant of the rate, s.
const SMOOTHED_S: f64 = 0.125;
/// The heading that is asked for leads the vehicle by no more than this, rad: it can stop turning there.
const LEAD_RAD: f64 = 0.15;
/// Option of the guided and the automatic mode that allows it.
const ALLOWED: u8 = 128;

/// What is turned into the wind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum IntoWind {
    /// Nothing, but on takeoffs what their parameter says.
    OnlyOnTakeoff,
    /// Nothing.
    Off,
    /// The nose.
    Nose,
    /// The nose or the tail, whichever is nearer.
    NoseOrTail,
    /// A side.
    Side,
    /// The tail.
    Tail,
}

/// Parameters of it (WVANE_…).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct WeathervaneSettings {
    /// What is turned into the wind.
    pub way: IntoWind,
    /// The same on a takeoff; `None`: as elsewhere.
    pub takeoff: Option<IntoWind>,
    /// Rate of turn for a lean, 1/s.
    pub gain_1_s: f64,
    /// A lean that is no reason to turn, rad.
    pub least_lean_rad: f64,
    /// Height above home below which it does not turn, m; 0: none.
    pub least_height_m: f64,
    /// Speeds over the ground and up or down above which it does not turn, m/s; 0: any.
    pub fastest_m_s: f64,
    #[allow(missing_docs)] // With the one above.
    pub fastest_climb_m_s: f64,
    /// Whether pitch turns nose and tail faster.
    pub with_pitch: bool,
}

impl Default for WeathervaneSettings {
    fn default() -> Self {
        Self {
            way: IntoWind::Off,
            takeoff: None,
            gain_1_s: 1.0,
            least_lean_rad: 1.0_f64.to_radians(),
            least_height_m: 0.0,
            fastest_m_s: 2.0,
            fastest_climb_m_s: 1.0,
            with_pitch: false,
        }
    }
}

/// A turn into the wind.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Weathervane {
    /// Since when nothing speaks against it, µs.
    since_us: Option<u64>,
    /// The heading that is asked for, rad, once it turns.
    heading_rad: Option<f64>,
    rate_rad_s: f64,
}

impl Weathervane {
    /// One tick: it decides about the heading where it may. Returns whether it does.
    pub fn step(&mut self, situation: &Situation, proposal: &mut Proposal) -> bool {
        let Some(way) = way(situation) else {
            if self.heading_rad.is_some() {
                proposal.turn_on(None);
            }
            *self = Self::default();
            return false;
        };
        let since_us = *self.since_us.get_or_insert(situation.time_us);
        if situation.time_us - since_us < BEGINS_AFTER_US {
            return false;
        }
        if self.heading_rad.is_none() {
            let name = match way {
                IntoWind::OnlyOnTakeoff | IntoWind::Off => return false,
                IntoWind::Nose => "nose in",
                IntoWind::NoseOrTail => "nose or tail in",
                IntoWind::Side => "side in",
                IntoWind::Tail => "tail in",
            };
            proposal.say(Severity::Info, format!("Weathervane Active: {name}"));
        }
        let settings = &situation.conduct.weathervane;
        let wanted_rad_s = settings.gain_1_s * error_rad(way, situation.outputs.tilt_reference_rad, settings);
        self.rate_rad_s += (wanted_rad_s - self.rate_rad_s) * TICK_S / SMOOTHED_S;
        let limits = situation.limits();
        // A rate from which it stops within the lead.
        let fastest_rad_s =
            libm::sqrt(2.0 * limits.yaw_acceleration_rad_s2 * LEAD_RAD).min(limits.yaw_rate_rad_s);
        let rate_rad_s = self.rate_rad_s.clamp(-fastest_rad_s, fastest_rad_s);
        let now_rad = situation.outputs.attitude_rad.z;
        let before_rad = self.heading_rad.unwrap_or(situation.outputs.setpoint.yaw_rad);
        let lead_rad = wrapped(before_rad + rate_rad_s * TICK_S - now_rad).clamp(-LEAD_RAD, LEAD_RAD);
        self.heading_rad = Some(now_rad + lead_rad);
        proposal.turn_on(Some((now_rad + lead_rad, rate_rad_s)));
        true
    }
}

/// What is to be turned into the wind now, if anything.
fn way(situation: &Situation) -> Option<IntoWind> {
    let (conduct, settings) = (situation.conduct, &situation.conduct.weathervane);
    let options = match situation.mode {
        Mode::Offboard | Mode::Takeoff => conduct.guided_options,
        Mode::Mission | Mode::MissionLanding => conduct.auto_options,
        _ => 0,
    };
    let turns_by_hand = situation.pilot.sticks.is_some_and(|sticks| sticks.turn != 0.0);
    let allowed = situation.identity.is_ardupilot() && options & ALLOWED != 0 && situation.flies();
    if !allowed || turns_by_hand || settings.way == IntoWind::Off || settings.gain_1_s <= 0.0 {
        return None;
    }
    let (velocity_m_s, height_m) =
        (situation.outputs.velocity_m_s, situation.home.position_m.z - situation.outputs.position_m.z);
    let too_fast = |speed_m_s: f64, fastest_m_s: f64| fastest_m_s > 0.0 && speed_m_s > fastest_m_s;
    let too_low = settings.least_height_m > 0.0 && height_m <= settings.least_height_m;
    if too_low
        || too_fast(velocity_m_s.xy().norm(), settings.fastest_m_s)
        || too_fast(velocity_m_s.z.abs(), settings.fastest_climb_m_s)
    {
        return None;
    }
    let special = if situation.mode == Mode::Takeoff { settings.takeoff } else { None };
    let way = special.unwrap_or(settings.way);
    (!matches!(way, IntoWind::Off | IntoWind::OnlyOnTakeoff)).then_some(way)
}

/// The lean, rad, that a turn to the right takes away.
fn error_rad(way: IntoWind, [roll, pitch]: [f64; 2], settings: &WeathervaneSettings) -> f64 {
    let beyond = |lean_rad: f64| (lean_rad.abs() - settings.least_lean_rad).max(0.0);
    // Leaning to the right it stands against a wind from there; with the nose up, against one from behind.
    let with_pitch = |from_ahead: f64| {
        let ahead = settings.with_pitch && from_ahead > settings.least_lean_rad;
        if ahead { roll.abs() + from_ahead - settings.least_lean_rad } else { beyond(roll) }
    };
    let right = if roll < 0.0 { -1.0 } else { 1.0 };
    let same = |flag: bool| if flag { 1.0 } else { -1.0 };
    match way {
        IntoWind::Off | IntoWind::OnlyOnTakeoff => 0.0,
        IntoWind::Nose => right * with_pitch(pitch),
        IntoWind::Tail => -right * with_pitch(-pitch),
        IntoWind::NoseOrTail => same((roll < 0.0) == (pitch > 0.0)) * beyond(roll),
        IntoWind::Side => same((pitch > 0.0) == (roll > 0.0)) * beyond(pitch),
    }
}

#[cfg(test)]
mod tests {
    use super::{IntoWind, Mode, Weathervane, WeathervaneSettings, error_rad};
    use crate::identity::Identity;
    use crate::vehicle::Conduct;
    use crate::vehicle::proposal::Request;
    use crate::vehicle::scene::{Scene, said};

    /// A vehicle that leans against a wind from a direction, in degrees to the right of its nose, turns the part to it that it is to
    /// turn, by the shorter way.
    #[test]
    fn it_turns_the_right_part_by_the_shorter_way() {
        let settings = WeathervaneSettings { with_pitch: true, ..WeathervaneSettings::default() };
        for (way, from_deg, right) in [
            (IntoWind::Nose, 60.0, true),
            (IntoWind::Nose, -60.0, false),
            (IntoWind::Nose, 150.0, true),
            (IntoWind::Tail, 120.0, false),
            (IntoWind::Tail, -120.0, true),
            (IntoWind::Tail, 30.0, false),
            (IntoWind::NoseOrTail, 60.0, true),
            (IntoWind::NoseOrTail, 120.0, false),
            (IntoWind::NoseOrTail, -60.0, false),
            (IntoWind::NoseOrTail, -120.0, true),
            (IntoWind::Side, 60.0, false),
            (IntoWind::Side, 120.0, true),
            (IntoWind::Side, -60.0, true),
            (IntoWind::Side, -120.0, false),
        ] {
            let from_rad = f64::to_radians(from_deg);
            // It leans towards the wind: to the right of it, and nose down to what is ahead.
            let lean = [0.2 * from_rad.sin(), -0.2 * from_rad.cos()];
            let error = error_rad(way, lean, &settings);
            assert_eq!(error > 0.0, right, "{way:?} {from_deg}: {error}");
        }
    }

    #[test]
    fn it_waits_until_it_is_slow_and_tells_once_that_it_turns() {
        let mut scene = Scene::hovering_at([0.0, 0.0, -20.0]);
        (scene.identity, scene.mode, scene.conduct) =
            (Identity::ArduPilot, Mode::Offboard, Conduct::new(true));
        (scene.conduct.weathervane.way, scene.conduct.guided_options) = (IntoWind::Nose, 128);
        scene.outputs.tilt_reference_rad = [0.2, 0.0];
        let mut vane = Weathervane::default();
        let mut fly = |scene: &mut Scene, ticks: usize| -> Vec<Request> {
            (0..ticks)
                .flat_map(|_| {
                    scene.wait_us(1_000);
                    scene.show(|situation, proposal| vane.step(situation, proposal))
                })
                .collect()
        };
        scene.outputs.velocity_m_s.x = 2.5;
        assert!(fly(&mut scene, 3_000).is_empty(), "too fast");
        scene.outputs.velocity_m_s.x = 0.0;
        assert!(fly(&mut scene, 1_999).is_empty(), "not for long enough");
        assert_eq!(said(&fly(&mut scene, 2_000)), ["Weathervane Active: nose in"]);
        scene.conduct.guided_options = 0;
        assert!(fly(&mut scene, 3_000).is_empty(), "not allowed");
    }
}
