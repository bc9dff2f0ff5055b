//! What a vehicle is made from.

use quadrotor::Configuration;
use serde::{Deserialize, Serialize};

use super::battery::{Battery, full_voltage_v};
use super::battery_pack::BatteryPack;
use super::boot_fault::BootFault;
use super::conduct::Conduct;
use crate::equipment::EquipmentVoice;
use crate::estimation::SensorSettings;
use crate::fault::ScheduledFault;
use crate::foreign::ForeignDescription;
use crate::identity::Identity;
use crate::mode::Mode;
use crate::plan::Plans;
use crate::surroundings::Surroundings;
use crate::world::{Geodetic, WindSettings};

/// Everything that a vehicle is made from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct VehicleSettings {
    /// Whose conventions it follows.
    pub identity: Identity,
    /// The closed loop. Ground and shaper are always on; the initial state is at rest on the ground.
    pub configuration: Configuration,
    /// Its own parameters.
    pub conduct: Conduct,
    /// Where the local frame has its origin, on the ground; the start is where `configuration` has it from there.
    pub origin: Geodetic,
    /// Heading at the start, rad.
    pub heading_rad: f64,
    /// The wind.
    pub wind: WindSettings,
    /// The battery; its capacity is the one of `conduct`.
    #[serde(default)]
    pub battery: BatteryPack,
    /// What breaks when.
    #[serde(default)]
    pub faults: Vec<ScheduledFault>,
    /// What it knows its motion by.
    #[serde(default)]
    pub sensors: SensorSettings,
    /// What it is to fly, and where it may.
    #[serde(default)]
    pub plans: Plans,
    /// Whether it arms and starts its mission by itself as soon as it can.
    #[serde(default)]
    pub autostart: bool,
    /// What stands and flies around it.
    #[serde(default)]
    pub surroundings: Surroundings,
    /// What flies in place of our plant or closed loop, if anything does.
    #[serde(default)]
    pub foreign: Option<ForeignDescription>,
    /// Who speaks for camera and gimbal.
    #[serde(default)]
    pub equipment: EquipmentVoice,
}

impl VehicleSettings {
    /// Parameters of its behaviour at the start, in the wind and with the battery that there are then.
    pub fn conduct_at_start(&self) -> Conduct {
        let full_battery_v =
            full_voltage_v(&self.flown_configuration().airframe, &Battery::new(self.battery));
        Conduct { simulated: self.conduct.simulated.since(&self.wind, full_battery_v), ..self.conduct }
    }

    /// The default vehicle, at the default place, in calm air, with ideal sensors and nothing to fly.
    pub fn new(identity: Identity) -> Self {
        Self {
            identity,
            configuration: Configuration::default(),
            conduct: Conduct::new(identity.is_ardupilot()),
            origin: Geodetic::default(),
            heading_rad: 0.0,
            wind: WindSettings::default(),
            battery: BatteryPack::default(),
            faults: Vec::new(),
            sensors: SensorSettings::default(),
            plans: Plans::default(),
            autostart: false,
            surroundings: Surroundings::default(),
            foreign: None,
            equipment: EquipmentVoice::default(),
        }
    }

    /// The mode after a boot.
    pub fn mode_at_boot(&self) -> Mode {
        let chosen = self.identity.mode(u32::from(self.conduct.initial_mode));
        chosen.filter(|_| self.identity.is_ardupilot()).unwrap_or(self.identity.first_mode())
    }

    /// What a boot finds that only another one mends.
    pub(super) fn boot_fault(&self) -> BootFault {
        let barometers = if self.identity.is_ardupilot() { self.conduct.simulated.barometers } else { 1 };
        BootFault::with_barometers(barometers)
    }

    /// The closed loop as the vehicle flies it: with ground and shaper, at rest with its heading.
    pub fn flown_configuration(&self) -> Configuration {
        let mut configuration = self.configuration;
        configuration.environment.ground_plane = true;
        configuration.reference.shaping = true;
        // Speeds are commanded here: they are to be flown.
        configuration.limits.full_speed = true;
        configuration.initial.attitude_rad[2] = self.heading_rad;
        configuration
    }
}
