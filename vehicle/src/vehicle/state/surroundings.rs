//! What is around the vehicle, as others ask about it and tell of it.

use nalgebra::{Vector2, Vector3};

use super::super::obstacle_watch::{ObstacleWatch, one_direction};
use super::super::precision_landing::{PrecisionLanding, Sighting};
use super::super::remote_id::RemoteId;
use super::super::traffic_watch::{Encounter, TrafficWatch};
use super::Vehicle;
use crate::estimation::gps::GpsFix;
use crate::surroundings::{Aircraft, RangeScan, Reading};

impl Vehicle {
    /// What is measured around.
    pub fn obstacles(&self) -> &ObstacleWatch {
        &self.machines.obstacles
    }

    /// Whether it has a downward rangefinder.
    pub fn has_rangefinder(&self) -> bool {
        self.machines.obstacles.has_rangefinder(&self.situation())
    }

    /// Whether it has what measures around.
    pub fn has_proximity(&self) -> bool {
        self.machines.obstacles.has_proximity(&self.situation())
    }

    /// Whether that measures now.
    pub fn measures_around(&self) -> bool {
        self.machines.obstacles.measures_around(&self.situation())
    }

    /// What is measured around, north and east of here, m.
    pub fn seen_around_m(&self) -> Vec<Vector2<f64>> {
        self.machines.obstacles.seen_m(&self.situation()).unwrap_or_default()
    }

    /// Takes a scan that somebody else has made, with the middle of its first sector at a heading, rad, from north.
    pub fn see_around(&mut self, heading_rad: f64, sectors: [Reading; crate::surroundings::SECTORS]) {
        let outputs = self.outputs();
        let (time_us, position_m) = (outputs.time_us, outputs.position_m);
        self.machines.obstacles.take(RangeScan { time_us, position_m, heading_rad, sectors });
    }

    /// Takes what an instrument measures that looks in a direction: its angle from the nose, rad, its width, rad.
    pub fn see_ahead(&mut self, angle_rad: f64, width_rad: f64, reading: Reading) {
        let outputs = self.outputs();
        let (time_us, position_m) = (outputs.time_us, outputs.position_m);
        let heading_rad = outputs.attitude_rad.z + angle_rad;
        self.machines.obstacles.take(one_direction(time_us, position_m, heading_rad, width_rad, reading));
    }

    /// The target that landings go to.
    pub fn precision_landing(&self) -> &PrecisionLanding {
        &self.machines.precision
    }

    /// Takes what a companion computer sees of the place to land at.
    pub fn see_landing_target(&mut self, sighting: Sighting) {
        if !self.conduct().precision.hears() {
            return;
        }
        let range_m = self.machines.obstacles.below_m();
        let (situation, parts) = self.situation_and_machines();
        parts.precision.take(&situation, range_m, sighting);
    }

    /// Takes a GPS fix from outside, if the receiver is of that kind. Returns whether it is.
    pub fn receive_fix(&mut self, fix: GpsFix) -> bool {
        let taken = self.conduct().simulated.errors.switches.gps_comes_by_message();
        if taken {
            self.perception.receive_fix(fix);
        }
        taken
    }

    /// Who flies around.
    pub fn traffic(&self) -> &TrafficWatch {
        &self.machines.traffic
    }

    /// Hears an aircraft, unless it has no receiver.
    pub fn hear_aircraft(&mut self, aircraft: Aircraft) {
        let here_m: Vector3<f64> = self.outputs().position_m;
        if self.conduct().surroundings.traffic.heard {
            self.machines.traffic.hear(aircraft, &here_m);
        }
    }

    /// What is to be told of traffic that comes near, once.
    pub fn take_encounter(&mut self) -> Option<Encounter> {
        self.machines.traffic.take_report()
    }

    /// What it tells of itself by remote identification.
    pub fn remote_id(&self) -> &RemoteId {
        &self.machines.remote_id
    }

    /// Changes what it tells of itself.
    pub fn remote_id_mut(&mut self) -> &mut RemoteId {
        &mut self.machines.remote_id
    }

    /// What is missing to identify itself, if it should.
    pub fn remote_id_lacks(&self) -> Option<&'static str> {
        self.machines.remote_id.missing(&self.situation())
    }
}
