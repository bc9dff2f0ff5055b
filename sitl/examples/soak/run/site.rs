//! One vehicle and its clients.

use autopilot::Autopilot;
use autopilot::codec::{Frame, Version};
use autopilot::envelope::{Destination, LinkProfile};
use mavlink::dialects::ardupilotmega::MISSION_ITEM_INT_DATA;
use sitl::configuration::MemberSettings;
use sitl::flight_log::{LogSource, Row, TOPICS};
use vehicle::TICK_US;
use vehicle::estimation::SensorModel;
use vehicle::parameters::Speed;
use vehicle::world::WindSettings;

use super::Options;
use super::chance::Chance;
use super::client::Client;
use super::figures::Figures;
use super::watch::{self, Stays, Watch};

/// System ids of the clients: a pilot and two who look on.
const SYSTEMS: [u8; 3] = [255, 254, 253];
/// How often the topics of the flight log are looked at, µs.
const LOG_PERIOD_US: u64 = 100_000;
/// Turns of long answers in a tick.
const TURNS: usize = 10;
/// A.h; nobody changes batteries in an hour of flights.
const BATTERY_AH: f64 = 200.0;

pub struct Site {
    autopilot: Autopilot,
    stays: Stays,
    clients: [Option<Client>; 3],
    /// When the next one comes to each place.
    comes_us: [u64; 3],
    next_peer: u64,
    sequence: u8,
    mission: Option<Vec<MISSION_ITEM_INT_DATA>>,
    loss: f64,
    chance: Chance,
    watch: Watch,
}

impl Site {
    pub fn new(options: &Options, own: MemberSettings, number: u64) -> Self {
        let (calm, realistic) = (number.is_multiple_of(2), number % 5 == 4);
        let mut vehicle = own.vehicle;
        if realistic {
            vehicle.sensors.model = SensorModel::Realistic;
        }
        vehicle.conduct.battery_capacity_ah = BATTERY_AH;
        if !calm {
            vehicle.wind = WindSettings { speed_m_s: 3.0, from_rad: 1.0, gusts_m_s: 0.7, ..vehicle.wind };
            vehicle.configuration.airframe.drag_n_s_m = [0.15; 3];
        }
        let links = [LinkProfile::Ground];
        let autopilot = Autopilot::new(&vehicle, own.system_id, Speed::Factor(1.0), &links, 0)
            .expect("the default airframe");
        Self {
            autopilot,
            stays: Stays::of(calm, realistic),
            clients: [const { None }; 3],
            comes_us: [0, 2_000_000, 4_000_000],
            next_peer: 1,
            sequence: 0,
            mission: None,
            loss: options.loss,
            chance: Chance::new(options.seed.wrapping_mul(1000).wrapping_add(number)),
            watch: Watch::default(),
        }
    }

    pub fn fly_to(&mut self, until_us: u64, figures: &mut Figures) {
        while self.autopilot.vehicle().time_us() < until_us {
            let now_us = self.autopilot.vehicle().time_us();
            self.come_and_go(now_us, figures);
            for client in self.clients.iter_mut().flatten() {
                client.go_on(now_us, &self.autopilot, &mut self.mission, &mut self.chance, figures);
                for (origin, frame) in client.arrived(now_us) {
                    self.autopilot.receive(&origin, &frame);
                }
            }
            self.autopilot.tick().expect("the flight goes on");
            figures.states.update(self.autopilot.vehicle());
            if now_us.is_multiple_of(LOG_PERIOD_US) {
                self.log(figures);
            }
            let clients = &self.clients;
            self.autopilot.transfer(TURNS, |peer| {
                let is_there =
                    clients.iter().flatten().any(|client| client.is_meant(Destination::Peer(peer)));
                is_there.then_some(true)
            });
            let system = self.autopilot.system_id();
            for outgoing in self.autopilot.take_outgoing() {
                self.sequence = self.sequence.wrapping_add(1);
                let sender = (system, outgoing.component);
                let frame = Frame::encode(&outgoing.message, Version::Two, self.sequence, sender);
                let frame = frame.expect("a message of MAVLink 2");
                figures.messages.bytes(frame.bytes());
                for client in self.clients.iter_mut().flatten().filter(|client| client.is_meant(outgoing.to))
                {
                    client.tell(frame.clone(), now_us + TICK_US, &mut self.chance);
                }
            }
            if now_us.is_multiple_of(watch::PERIOD_US) {
                self.watch.look(&self.autopilot, self.stays, figures);
            }
        }
    }

    /// Takes in what a flight log would have now.
    fn log(&self, figures: &mut Figures) {
        let source = LogSource::of(&self.autopilot);
        for topic in TOPICS {
            let mut row = Row::default();
            (topic.sample)(&source, &mut row);
            figures.logged.bytes(row.bytes());
        }
    }

    fn come_and_go(&mut self, now_us: u64, figures: &mut Figures) {
        for (place, client) in self.clients.iter_mut().enumerate() {
            if let Some(gone) = client.take_if(|client| client.leaves_us <= now_us) {
                gone.leave(&self.autopilot, &mut self.mission, figures);
                self.comes_us[place] = now_us + self.chance.seconds_us(0.5, 20.0);
            }
            if client.is_none() && now_us >= self.comes_us[place] {
                let system = SYSTEMS[place];
                *client = Some(Client::new(
                    place == 0,
                    system,
                    self.next_peer,
                    self.loss,
                    now_us,
                    &mut self.chance,
                ));
                self.next_peer += 1;
                figures.clients += 1;
            }
        }
    }

    /// At the end everybody goes.
    pub fn close(&mut self, figures: &mut Figures) {
        for client in self.clients.iter_mut().filter_map(Option::take) {
            client.leave(&self.autopilot, &mut self.mission, figures);
        }
    }
}
