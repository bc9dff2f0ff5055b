//! Vehicles, the clients of each, and the watch over them.

mod chance;
mod channel;
mod client;
mod figures;
mod flight_plan;
mod site;
mod task;
mod watch;

use std::time::Instant;

pub use figures::Figures;
#[allow(unused_imports)] // A test looks at it.
pub use figures::leak;
use site::Site;
use sitl::configuration::{Arguments, Settings};
#[allow(unused_imports)] // A test looks at it.
pub use watch::{Stays, Watch};

/// What to fly.
pub struct Options {
    pub vehicles: u8,
    pub end_us: u64,
    pub seed: u64,
    /// Share of the messages that is lost, each way.
    pub loss: f64,
}

/// Flies them all to the end.
pub fn run(options: &Options) -> Figures {
    let start = Instant::now();
    let arguments = Arguments {
        vehicles: Some(options.vehicles),
        seed: Some(options.seed),
        home: Some("47.397742,8.545594,488,30".parse().expect("a place")),
        ..Arguments::default()
    };
    let settings = Settings::resolve(&arguments).expect("settings");
    let site = |(number, own)| Site::new(options, own, number);
    let mut sites: Vec<Site> = (0..).zip(settings.vehicles).map(site).collect();
    let mut figures = Figures::new(options);
    let mut time_us = 0;
    while time_us < options.end_us {
        // A second of each in turn: they do not see one another.
        let until_us = (time_us + 1_000_000).min(options.end_us);
        for site in &mut sites {
            site.fly_to(until_us, &mut figures);
        }
        time_us = until_us;
        figures.sample_memory(time_us);
    }
    sites.iter_mut().for_each(|site| site.close(&mut figures));
    figures.finish(start.elapsed());
    figures
}
