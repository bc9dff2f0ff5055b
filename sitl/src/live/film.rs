//! A record as the page shows it: flown again, and looked at as often as a live flight.

use std::io::Write;
use std::path::Path;

use autopilot::Autopilot;
use autopilot::envelope::Destination;
use viewer::{Film, Frame, NewsFrom, Recording, Scene, Text, VehicleNews, VehicleState};

use super::news::{NewsDesk, news_of};
use super::sample::sample;
use super::scene::scene;
use crate::failure::Failure;
use crate::fleet::Overheard;
use crate::record::{Audience, replay_before};
use crate::terminal::aside;

/// Simulation time between two states, µs, unless the record is long.
const PERIOD_US: u64 = 33_000;
/// States of all vehicles: browsers hold all of them.
const MOST_STATES: usize = 200_000;
/// Lines for the pilot.
const MOST_LINES: usize = 1000;

/// Flies a record again, and shows that.
///
/// # Errors
/// Those of [`replay`](crate::record::replay).
pub fn film(path: &Path) -> Result<Recording, Failure> {
    let mut camera = Camera::new();
    replay_before(path, &mut camera)?;
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    Ok(Recording::new(name, camera.film().encode()))
}

/// The film of a record that was opened in the page.
///
/// # Errors
/// What is wrong with the record.
pub fn replayed(record: &[u8]) -> Result<Vec<u8>, String> {
    let kept = tempfile::NamedTempFile::new().and_then(|mut file| file.write_all(record).map(|()| file));
    let file = kept.map_err(|error| format!("cannot keep it for the replay: {error}"))?;
    let mut camera = Camera::new();
    let outcome = aside(|| replay_before(file.path(), &mut camera));
    // The browser knows the file by another name.
    let told = |reason: &str| reason.replace(&*file.path().to_string_lossy(), "RECORD");
    outcome.map_err(|failure| match &failure {
        Failure::Content { reason, .. } => told(reason),
        failure => told(&failure.to_string()),
    })?;
    Ok(camera.film().encode())
}

/// Looks at each vehicle once per period.
#[derive(Debug)]
struct Camera {
    period_us: u64,
    rolls: Vec<Vec<VehicleState>>,
    news: Vec<NewsFrom>,
    desk: NewsDesk,
    scene: Scene,
}

impl Camera {
    fn new() -> Self {
        let (desk, scene) = (NewsDesk::with_lines(MOST_LINES), Scene::default());
        Self { period_us: PERIOD_US, rolls: Vec::new(), news: Vec::new(), desk, scene }
    }

    /// Looks half as often, and forgets every other state.
    fn slow_down(&mut self) {
        self.period_us *= 2;
        for roll in &mut self.rolls {
            let mut index = 0;
            roll.retain(|_| {
                index += 1;
                index % 2 == 1
            });
        }
    }

    fn take_news(&mut self, time_us: u64, news: VehicleNews) {
        let known = self.news.iter().rev().find(|known| known.news.id == news.id);
        if known.is_none_or(|known| known.news != news) {
            self.news.push(NewsFrom { time_s: time_us as f64 / 1e6, news });
        }
    }

    /// What was seen. A vehicle whose record ends before the others' stays as it was.
    fn film(self) -> Film {
        let longest = self.rolls.iter().map(Vec::len).max().unwrap_or(0);
        let last_s = longest.saturating_sub(1) as f64 * self.period_us as f64 / 1e6;
        let frames = (0..longest)
            .map(|index| Frame {
                speed: 1.0,
                pace: 1.0,
                time_s: (index as u64 * self.period_us) as f64 / 1e6,
                vehicles: self
                    .rolls
                    .iter()
                    .filter_map(|roll| roll.get(index).or(roll.last()))
                    .copied()
                    .collect(),
            })
            .collect();
        Film { scene: self.scene, news: self.news, texts: in_order(self.desk.texts(), last_s), frames }
    }
}

/// Lines by their times, numbered anew: vehicles are flown one ahead of the other. What was said after the last frame is seen with it.
fn in_order(mut texts: Vec<Text>, last_s: f64) -> Vec<Text> {
    texts.sort_by(|one, other| one.time_s.total_cmp(&other.time_s));
    for (number, text) in (1..).zip(&mut texts) {
        text.number = number;
        text.time_s = text.time_s.min(last_s);
    }
    texts
}

impl Audience for Camera {
    fn see(&mut self, vehicle: usize, autopilot: &mut Autopilot) {
        let (system, time_us) = (autopilot.system_id(), autopilot.time_us());
        let said = autopilot.take_outgoing().filter(|outgoing| outgoing.to == Destination::Everyone);
        self.desk.hear(said.map(|said| Overheard { system, time_us, message: said.message }).collect());
        if self.rolls.len() <= vehicle {
            self.rolls.resize_with(vehicle + 1, Vec::new);
        }
        let Some(roll) = self.rolls.get_mut(vehicle) else { return };
        if time_us < roll.len() as u64 * self.period_us {
            return;
        }
        roll.push(sample(autopilot, false));
        self.take_news(time_us, news_of(autopilot));
        if self.rolls.iter().map(Vec::len).sum::<usize>() > MOST_STATES {
            self.slow_down();
        }
    }

    fn end(&mut self, vehicles: &[&Autopilot]) {
        self.scene = scene(vehicles.iter().copied());
    }
}
