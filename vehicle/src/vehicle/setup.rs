//! What the vehicle has been given: conventions, behaviour, place and time.

use super::conduct::Conduct;
use super::settings::VehicleSettings;
use crate::estimation::aiding::Aiding;
use crate::identity::Identity;
use crate::surroundings::Terrain;
use crate::world::{Geodetic, LocalFrame, ToldFrame, WindSettings};

/// What only a user changes.
#[derive(Clone, Debug)]
pub struct Setup {
    identity: Identity,
    conduct: Conduct,
    /// How often that was set.
    conduct_revision: u64,
    /// Where the simulated world is, and where the vehicle takes it to be.
    world: LocalFrame,
    frame: LocalFrame,
    told: ToldFrame,
    /// Whether a client has said where the origin is.
    origin_is_told: bool,
    /// The set of sources that the estimator uses, from 0.
    source_set: usize,
    terrain: Terrain,
    /// What it started with: the wind, and the voltage of the full battery, V.
    wind: WindSettings,
    full_battery_v: f64,
    unix_start_us: u64,
}

impl Setup {
    /// Starts at an unknown time of day.
    pub fn new(settings: &VehicleSettings, full_battery_v: f64) -> Self {
        let frame = LocalFrame::new(settings.origin);
        let told = ToldFrame::new(frame);
        let (identity, wind) = (settings.identity, settings.wind);
        let conduct = settings.conduct;
        let terrain = settings.surroundings.terrain.clone();
        let unix_start_us = 0;
        let mut setup = Self {
            identity,
            conduct,
            conduct_revision: 0,
            world: frame,
            frame,
            told,
            origin_is_told: false,
            source_set: 0,
            terrain,
            wind,
            full_battery_v,
            unix_start_us,
        };
        setup.set_conduct(conduct);
        setup
    }

    /// The wind of now, as the parameters have it.
    pub fn wind(&self) -> WindSettings {
        self.conduct.simulated.wind(&self.wind)
    }

    /// Whose conventions it follows.
    pub fn identity(&self) -> Identity {
        self.identity
    }

    /// Parameters of its behaviour.
    pub fn conduct(&self) -> &Conduct {
        &self.conduct
    }

    /// A number that changes whenever these may have changed.
    pub fn conduct_revision(&self) -> u64 {
        self.conduct_revision
    }

    /// Changes the parameters of its behaviour.
    pub fn set_conduct(&mut self, conduct: Conduct) {
        let simulated = conduct.simulated.since(&self.wind, self.full_battery_v);
        self.conduct = Conduct { simulated, ..conduct };
        self.conduct_revision += 1;
    }

    /// What the estimator fuses.
    pub fn aiding(&self) -> Aiding {
        self.conduct.aiding.aiding(self.identity, self.source_set)
    }

    /// Changes the set of sources that the estimator uses, from 0.
    pub fn use_source_set(&mut self, source_set: usize) {
        self.source_set = source_set;
    }

    /// The frame of the simulated world.
    pub fn world(&self) -> &LocalFrame {
        &self.world
    }

    /// The vehicle, which did not know where its local frame is, is told. Its local positions stay the same.
    pub fn tell_origin(&mut self, origin: Geodetic) {
        self.frame = LocalFrame::new(origin);
        self.told = ToldFrame::new(self.frame);
        self.origin_is_told = true;
    }

    /// Whether a client has said where the origin is.
    pub fn origin_is_told(&self) -> bool {
        self.origin_is_told
    }

    /// The local frame.
    pub fn frame(&self) -> &LocalFrame {
        &self.frame
    }

    /// The local frame in which clients count.
    pub fn told_frame(&self) -> &ToldFrame {
        &self.told
    }

    /// Moves the origin of the local frame in which clients count.
    pub fn move_origin(&mut self, origin: Geodetic) {
        self.told.move_to(origin);
    }

    /// The ground.
    pub fn terrain(&self) -> &Terrain {
        &self.terrain
    }

    /// Time of the start since 1970, µs.
    pub fn unix_start_us(&self) -> u64 {
        self.unix_start_us
    }

    /// Tells what time it was at the start, µs since 1970.
    pub fn set_unix_start_us(&mut self, unix_start_us: u64) {
        self.unix_start_us = unix_start_us;
    }
}
