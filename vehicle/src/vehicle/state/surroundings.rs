//! What is around the vehicle, as others ask about it and tell of it.

use nalgebra::{Vector2, Vector3};

use super::super::notice::Refusal;
use super::super::obstacle_watch::{ObstacleWatch, one_direction};
use super::super::precision_landing::{PrecisionLanding, Sighting};
use super::super::remote_id::RemoteId;
use super::super::traffic_watch::{Encounter, TrafficWatch};
use super::Vehicle;
use crate::estimation::aiding::Aiding;
use crate::estimation::gps::GpsFix;
use crate::estimation::vision::{VisionReading, VisionRefusal};
use crate::surroundings::{Aircraft, RangeScan, Reading};
use crate::world::{FARTHEST_M, Geodetic};

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

    /// Takes an estimate of its motion from outside, if it is used.
    ///
    /// # Errors
    /// [`VisionRefusal`]: why nothing comes of it.
    pub fn receive_vision(&mut self, reading: VisionReading) -> Result<(), VisionRefusal> {
        if self.navigation().is_none() {
            return Err(VisionRefusal::IdealSensors);
        }
        let settings = self.aiding().vision.ok_or(VisionRefusal::NotUsed)?;
        if !settings.uses.wants(&reading) {
            return Err(VisionRefusal::NotUsed);
        }
        settings.check(&reading)?;
        self.perception.receive_vision(reading.scaled(settings.scale));
        Ok(())
    }

    /// What its estimator fuses.
    pub fn aiding(&self) -> Aiding {
        self.setup.aiding()
    }

    /// Lets its estimator use another set of sources, from 0.
    pub fn use_source_set(&mut self, set: usize) {
        self.setup.use_source_set(set);
    }

    /// Moves the origin of the local frame in which clients count. Where the vehicle is and where it flies stay the same.
    /// A vehicle that flies by vision without GPS learns where on the map it is.
    ///
    /// # Errors
    /// [`Refusal`]: it is no place, or too far away.
    pub fn move_origin(&mut self, origin: Geodetic) -> Result<(), Refusal> {
        if !origin.is_valid() {
            let Geodetic { latitude_deg, longitude_deg, .. } = origin;
            let place = format!("latitude {latitude_deg}, longitude {longitude_deg}");
            return Err(Refusal::denied(format!("Origin refused: {place} is not a valid place")));
        }
        if self.can_be_told_origin() {
            self.setup.tell_origin(origin);
            self.plan_again();
            return Ok(());
        }
        let distance_m = self.frame().to_local_m(&origin).norm();
        if distance_m > FARTHEST_M {
            let (far, most) = (distance_m / 1000.0, FARTHEST_M / 1000.0);
            return Err(Refusal::denied(format!("Origin refused: {far:.0} km away; at most {most} km")));
        }
        self.setup.move_origin(origin);
        Ok(())
    }

    /// Whether it flies by vision, without GPS, so that only a client can tell where on the map it is.
    pub fn can_be_told_origin(&self) -> bool {
        self.navigation().is_some() && self.aiding().vision.is_some() && !self.instrument_health().gps
    }

    /// Whether it knows where on the map its local frame is: a receiver has told it, or a client.
    pub fn knows_origin(&self) -> bool {
        let told = self.setup.origin_is_told();
        told || self.navigation().is_none_or(|navigation| navigation.readings().gps.is_some())
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
