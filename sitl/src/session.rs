//! The running program: the fleet under the wall clock, until it is told to stop.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use crate::configuration::Settings;
use crate::failure::Failure;
use crate::fleet::{Clock, Fleet, Member};
use crate::live::{LivePage, open_viewer};
use crate::ready;
use crate::summary::{Flight, Summary};
use crate::terminal::{Panel, of_fleet};

/// Longest rest between two looks at the links.
const REST: Duration = Duration::from_millis(1);
/// The same while a set-point is expected: a client's answer must not wait for us.
const SHORT_REST: Duration = Duration::from_micros(20);

/// A fleet with its clocks.
#[derive(Debug)]
pub struct Session {
    settings: Settings,
    fleet: Fleet,
    page: Option<LivePage>,
}

impl Session {
    /// Opens links and files.
    ///
    /// # Errors
    /// [`Failure`] of the first thing that cannot be used.
    pub fn new(settings: Settings) -> Result<Self, Failure> {
        let since_1970 = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        let ready_file = settings.ready_file.as_deref();
        ready_file.map(ready::forget).transpose()?;
        // A taken port is found before files are written.
        let viewer = settings.view.as_ref().map(|address| open_viewer(address, None)).transpose()?;
        let mut fleet = Fleet::open(&settings, since_1970.as_micros() as u64)?;
        let page = viewer.map(|viewer| LivePage::new(viewer, &mut fleet, Instant::now()));
        let url = page.as_ref().map(LivePage::pilot_url);
        ready_file.map(|path| ready::write(path, &fleet, url.as_deref())).transpose()?;
        Ok(Self { settings, fleet, page })
    }

    /// The address of the live page for a pilot, if there is one.
    pub fn pilot_url(&self) -> Option<String> {
        self.page.as_ref().map(LivePage::pilot_url)
    }

    /// The vehicles and their links.
    pub fn fleet(&self) -> &Fleet {
        &self.fleet
    }

    /// Flies until it is told to stop, the asked time is over, or no vehicle is left, and ends the files however the flights
    /// went.
    pub fn run(self, stop: &Arc<AtomicBool>) -> Summary {
        let Self { settings, mut fleet, mut page } = self;
        let start = Instant::now();
        fly(&settings, &mut fleet, page.as_mut(), start, stop);
        let (members, incomplete) = fleet.finish(Instant::now());
        let flights = members
            .iter()
            .map(|member| Flight {
                system_id: member.autopilot().system_id(),
                time_us: member.time_us(),
                digest: member.digest().value(),
            })
            .collect();
        let losses = members.iter().filter_map(Member::loss).cloned().collect();
        Summary { wall: start.elapsed(), flights, losses, incomplete }
    }
}

/// Flies until it is told to stop, the asked time is over, or no vehicle is left.
fn fly(
    settings: &Settings,
    fleet: &mut Fleet,
    mut page: Option<&mut LivePage>,
    start: Instant,
    stop: &Arc<AtomicBool>,
) {
    let mut clocks: Vec<Clock> = settings
        .clocks()
        .into_iter()
        .map(|members| Clock::new(settings.speed, members, settings.end_us, start))
        .collect();
    let mut panel = Panel::new(start, settings.no_panel);
    let several = clocks.len() as u32;
    while !stop.load(Ordering::Relaxed) && !clocks.iter().all(|clock| clock.is_over(fleet)) {
        fleet.receive(Instant::now());
        fleet.hear_radios(Instant::now());
        // Answers do not wait for the flight.
        fleet.flush();
        let now = Instant::now();
        if let Some(page) = &mut page {
            page.take_orders(fleet, &mut clocks, now);
        }
        let mut behind = false;
        for clock in &mut clocks {
            if !clock.is_over(fleet) {
                behind |= clock.advance(fleet, now, several);
            }
        }
        let expected = fleet.keep_in_step(now);
        fleet.keep_links_alive(now);
        fleet.keep_logs(now);
        fleet.transfer(now);
        fleet.flush();
        if let Some(page) = &mut page {
            page.show(fleet, &clocks, now);
        }
        panel.update(now, fleet.time_us(), |form| {
            fleet.catch_up_all(now);
            of_fleet(fleet, form)
        });
        if !behind {
            std::thread::sleep(if expected { SHORT_REST } else { REST });
        }
    }
    panel.clear();
}
