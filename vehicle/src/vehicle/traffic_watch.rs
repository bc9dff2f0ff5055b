//! Other aircraft: who is heard, who comes too near, and what is done then.

use nalgebra::{Vector2, Vector3};

use super::conduct::Conduct;
use super::failsafe::Action;
use super::notice::Severity;
use super::obstacle_watch::separation_m;
use super::proposal::Proposal;
use super::situation::Situation;
use super::surroundings_settings::TrafficSettings;
use crate::mode::Mode;
use crate::surroundings::{Aircraft, ScriptedAircraft};

/// Transponders are heard once a second.
const HEARD_US: u64 = 1_000_000;
/// Traffic is judged this often, µs.
const JUDGED_US: u64 = 100_000;
/// After so long without a message an aircraft is none, s.
const LOST_S: f64 = 5.0;
/// Aircraft that are remembered.
const MOST: usize = 50;
/// A threat must be gone for so long, µs, before it counts as over.
const OVER_US: u64 = 2_000_000;
/// A threat is reported this often, µs.
const REPORTED_US: u64 = 1_000_000;

/// How near traffic comes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Default)]
pub enum Threat {
    /// Not near.
    #[default]
    None,
    /// It may come near.
    Low,
    /// Too near.
    High,
}

/// An aircraft that comes near.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Encounter {
    /// The aircraft.
    pub aircraft: Aircraft,
    /// How near.
    pub threat: Threat,
    /// What is done about it.
    pub action: Action,
    /// When it is nearest, s from now.
    pub nearest_s: f64,
    /// Horizontal distance then, m.
    pub horizontal_m: f64,
    /// Vertical distance then, m.
    pub vertical_m: f64,
}

/// What is known of other aircraft.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct TrafficWatch {
    scripted: Vec<ScriptedAircraft>,
    /// By their addresses.
    aircraft: Vec<Aircraft>,
    threat: Threat,
    /// Since when nothing is as near as that any more, µs.
    easing_us: Option<u64>,
    /// The mode that was left for an action, and the one that was entered.
    interrupted: Option<(Mode, Mode)>,
    /// To be told to clients.
    report: Option<Encounter>,
    reported_us: Option<u64>,
}

impl TrafficWatch {
    /// With the simulation's own aircraft.
    pub fn new(scripted: Vec<ScriptedAircraft>) -> Self {
        Self { scripted, ..Self::default() }
    }

    /// Everyone who is heard, by their addresses.
    pub fn aircraft(&self) -> &[Aircraft] {
        &self.aircraft
    }

    /// What is to be told of a threat, once.
    pub fn take_report(&mut self) -> Option<Encounter> {
        self.report.take()
    }

    /// Hears an aircraft. The one that is farthest from a place, NED, m, is forgotten if there are too many.
    pub fn hear(&mut self, aircraft: Aircraft, here_m: &Vector3<f64>) {
        match self.aircraft.binary_search_by_key(&aircraft.id, |known| known.id) {
            Ok(place) => {
                if let Some(known) = self.aircraft.get_mut(place) {
                    *known = aircraft;
                }
            }
            Err(place) => self.aircraft.insert(place, aircraft),
        }
        if self.aircraft.len() > MOST {
            let far = |one: &&Aircraft| (one.position_m - here_m).norm_squared();
            let farthest = self.aircraft.iter().max_by(|one, other| far(one).total_cmp(&far(other)));
            if let Some(id) = farthest.map(|one| one.id) {
                self.aircraft.retain(|one| one.id != id);
            }
        }
    }

    /// Whether it is time, µs, to look at the traffic.
    pub fn is_due(time_us: u64) -> bool {
        time_us.is_multiple_of(JUDGED_US)
    }

    /// Hears who is there, and acts when somebody comes too near, when it is due.
    pub fn watch(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let (time_us, settings) = (situation.time_us, &situation.conduct.surroundings.traffic);
        if !Self::is_due(time_us) {
            return;
        }
        if time_us.is_multiple_of(HEARD_US) && settings.heard {
            let heard: Vec<_> = self.scripted.iter().filter_map(|aircraft| aircraft.at(time_us)).collect();
            heard.into_iter().for_each(|aircraft| self.hear(aircraft, &situation.outputs.position_m));
        }
        self.aircraft.retain(|aircraft| aircraft.age_s(time_us) <= LOST_S);
        let worst = self.worst(situation).filter(|_| settings.enabled && settings.heard);
        self.change(
            situation,
            proposal,
            worst.map_or(Threat::None, |encounter| encounter.threat),
            worst.as_ref(),
        );
        let due = self.reported_us.is_none_or(|reported_us| time_us >= reported_us + REPORTED_US);
        if let Some(encounter) = worst.filter(|encounter| due && is_told(encounter, settings)) {
            (self.report, self.reported_us) = (Some(encounter), Some(time_us));
        }
    }

    /// The encounter that is the worst, of those the soonest.
    fn worst(&self, situation: &Situation) -> Option<Encounter> {
        let encounters = self.aircraft.iter().map(|aircraft| encounter(situation, aircraft));
        let threats = encounters.filter(|encounter| encounter.threat > Threat::None);
        threats.max_by(|one, other| {
            one.threat.cmp(&other.threat).then(other.nearest_s.total_cmp(&one.nearest_s))
        })
    }

    fn change(
        &mut self,
        situation: &Situation,
        proposal: &mut Proposal,
        threat: Threat,
        worst: Option<&Encounter>,
    ) {
        if threat >= self.threat {
            self.easing_us = None;
            let begins = threat > std::mem::replace(&mut self.threat, threat);
            if let Some(encounter) = worst.filter(|encounter| begins && encounter.threat == Threat::High) {
                self.act(situation, proposal, encounter);
            }
            return;
        }
        let since_us = *self.easing_us.get_or_insert(situation.time_us);
        if situation.time_us - since_us >= OVER_US {
            let before = std::mem::replace(&mut self.threat, threat);
            self.easing_us = None;
            if before == Threat::High {
                self.recover(situation, proposal);
            }
        }
    }

    fn act(&mut self, situation: &Situation, proposal: &mut Proposal, encounter: &Encounter) {
        let action = encounter.action;
        if action == Action::None {
            return;
        }
        let place_m = &situation.outputs.position_m;
        let [horizontal_m, vertical_m] = separation_m(&encounter.aircraft, place_m, situation.time_us);
        let is_above = encounter.aircraft.position_at_m(situation.time_us).z < place_m.z;
        let side = if is_above { "above" } else { "below" };
        let enters = action.mode().filter(|_| situation.flies() && action > Action::of_mode(situation.mode));
        let doing = if enters.is_some() { action.doing() } else { Action::Warn.doing() };
        let name = encounter.aircraft.name();
        proposal.say(
            if enters.is_some() { Severity::Critical } else { Severity::Warning },
            format!("Traffic alert: {name}, {horizontal_m:.0} m away, {vertical_m:.0} m {side}: {doing}"),
        );
        if let Some(mode) = enters {
            self.interrupted = Some((situation.mode, mode));
            proposal.enter(mode);
        }
    }

    /// The threat is over: what follows is the pilot's, if he has taken over.
    fn recover(&mut self, situation: &Situation, proposal: &mut Proposal) {
        proposal.say(Severity::Info, "Traffic alert over");
        let Some((before, entered)) = self.interrupted.take() else { return };
        let recovery = situation.conduct.surroundings.traffic.recovery;
        if situation.flies()
            && situation.mode == entered
            && let Some(mode) = recovery.mode(before).filter(|mode| *mode != entered)
        {
            proposal.enter(mode);
        }
    }
}

/// What is not acted upon is told only if the settings say so.
fn is_told(encounter: &Encounter, settings: &TrafficSettings) -> bool {
    match encounter.threat {
        Threat::None => false,
        Threat::Low => settings.warns,
        Threat::High => settings.action > Action::None,
    }
}

/// How near an aircraft comes.
fn encounter(situation: &Situation, aircraft: &Aircraft) -> Encounter {
    let Conduct { surroundings, .. } = situation.conduct;
    let settings = &surroundings.traffic;
    let between_m = aircraft.position_at_m(situation.time_us) - situation.outputs.position_m;
    let speed_m_s = aircraft.velocity_m_s - situation.outputs.velocity_m_s;
    let nearest_s = nearest_s(&between_m.xy(), &speed_m_s.xy());
    let approach = |ahead_s: f64| {
        let at_s = nearest_s.min(ahead_s);
        let horizontal_m = (between_m.xy() + speed_m_s.xy() * at_s).norm();
        [horizontal_m, vertical_m(between_m.z, speed_m_s.z, ahead_s)]
    };
    let within = |[horizontal_m, vertical_m]: [f64; 2], near_m: f64, near_vertical_m: f64| {
        horizontal_m < near_m && vertical_m < near_vertical_m
    };
    let high = within(approach(settings.ahead_s), settings.near_m, settings.near_vertical_m);
    let low = settings.warns
        && within(approach(settings.warning_ahead_s), settings.warning_m, settings.warning_vertical_m);
    let [horizontal_m, vertical_m] = approach(settings.ahead_s.max(settings.warning_ahead_s));
    let height_m = situation.home.position_m.z - situation.outputs.position_m.z;
    let action =
        if height_m < settings.least_height_m { settings.action.min(Action::Warn) } else { settings.action };
    let threat = match (high, low) {
        (true, _) => Threat::High,
        (false, true) => Threat::Low,
        (false, false) => Threat::None,
    };
    let action = if threat == Threat::High { action } else { Action::Warn.min(action) };
    Encounter { aircraft: *aircraft, threat, action, nearest_s, horizontal_m, vertical_m }
}

/// When two are nearest, s from now.
fn nearest_s(between_m: &Vector2<f64>, speed_m_s: &Vector2<f64>) -> f64 {
    let squared = speed_m_s.norm_squared();
    if squared < 1e-6 { 0.0 } else { (-between_m.dot(speed_m_s) / squared).max(0.0) }
}

/// The least vertical distance within a time, m.
fn vertical_m(between_m: f64, speed_m_s: f64, ahead_s: f64) -> f64 {
    if between_m * speed_m_s >= 0.0 {
        between_m.abs()
    } else {
        (between_m.abs() - speed_m_s.abs() * ahead_s).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::{Action, Aircraft, Mode, Threat, TrafficWatch, encounter};
    use crate::identity::Identity;
    use crate::vehicle::Conduct;
    use crate::vehicle::proposal::Request;
    use crate::vehicle::scene::{Scene, said};

    fn aircraft(position_m: [f64; 3], velocity_m_s: [f64; 3], heard_us: u64) -> Aircraft {
        let (position_m, velocity_m_s) = (Vector3::from(position_m), Vector3::from(velocity_m_s));
        Aircraft {
            id: 0xabc,
            callsign: *b"BOB\0\0\0\0\0\0",
            category: 1,
            position_m,
            velocity_m_s,
            heard_us,
            simulated: false,
        }
    }

    fn scene() -> Scene {
        let mut scene = Scene::hovering_at([0.0, 0.0, -50.0]);
        scene.identity = Identity::ArduPilot;
        scene.conduct = Conduct::new(true);
        scene.conduct.surroundings.traffic.enabled = true;
        scene.conduct.surroundings.traffic.action = Action::Return;
        scene
    }

    /// ArduPilot's defaults: 100 m within 30 s is too near, 300 m within 30 s is reported.
    #[test]
    fn the_closest_approach_within_the_time_decides() {
        let scene = scene();
        let time_us = scene.outputs.time_us;
        for (position, velocity, expected) in [
            ([1000.0, 0.0, -50.0], [-40.0, 0.0, 0.0], Threat::High),
            ([1000.0, 0.0, -50.0], [-20.0, 0.0, 0.0], Threat::None),
            ([1000.0, 0.0, -50.0], [-25.0, 0.0, 0.0], Threat::Low),
            ([1000.0, 200.0, -50.0], [-40.0, 0.0, 0.0], Threat::Low),
            ([1000.0, 0.0, -50.0], [40.0, 0.0, 0.0], Threat::None),
            ([50.0, 0.0, -50.0], [0.0; 3], Threat::High),
            ([50.0, 0.0, -250.0], [0.0; 3], Threat::Low),
            ([50.0, 0.0, -250.0], [0.0, 0.0, 5.0], Threat::High),
            ([50.0, 0.0, -450.0], [0.0; 3], Threat::None),
        ] {
            let found = encounter(&scene.situation(), &aircraft(position, velocity, time_us));
            assert_eq!(found.threat, expected, "{position:?} {velocity:?}: {found:?}");
        }
    }

    #[test]
    fn an_alert_says_on_which_side_the_aircraft_is() {
        for (z_m, told) in [(-70.0, "20 m above"), (-30.0, "20 m below")] {
            let mut scene = scene();
            let mut watch = TrafficWatch::default();
            watch.hear(aircraft([60.0, 0.0, z_m], [0.0; 3], scene.outputs.time_us), &Vector3::zeros());
            let mut requests = scene.show(|situation, proposal| watch.watch(situation, proposal));
            requests.retain(|request| matches!(request, Request::Say(_)));
            assert_eq!(said(&requests), [format!("Traffic alert: BOB, 60 m away, {told}: returning")]);
        }
    }

    #[test]
    fn it_acts_once_and_resumes_when_the_threat_is_gone() {
        let mut scene = scene();
        scene.mode = Mode::Mission;
        scene.conduct.surroundings.traffic.recovery = super::super::surroundings_settings::Recovery::Resume;
        let mut watch = TrafficWatch::default();
        let mut modes = Vec::new();
        for tenth in 0..200 {
            if tenth < 50 {
                watch.hear(aircraft([60.0, 0.0, -50.0], [0.0; 3], scene.outputs.time_us), &Vector3::zeros());
            }
            for request in scene.show(|situation, proposal| watch.watch(situation, proposal)) {
                if let Request::Enter(mode) = request {
                    scene.mode = mode;
                    modes.push((tenth, mode));
                }
            }
            scene.wait_us(100_000);
        }
        // Five seconds after the last message it is forgotten, and two seconds later that is over.
        assert_eq!(modes, [(0, Mode::Return), (120, Mode::Mission)]);
    }
}
