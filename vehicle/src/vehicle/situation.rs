//! What the machines see of the vehicle: a read-only view of one moment.

use nalgebra::Vector3;
use quadrotor::{Configuration, EasedLimits, Limits, Outputs};

use super::conduct::Conduct;
use super::failsafe::{Action, FenceDatum, FenceParts};
use super::home::Home;
use super::notice::Refusal;
use super::receiver::Pilot;
use super::region::RegionOfInterest;
use super::steering::{Steering, SteeringKind};
use super::surface_tracking::Surface;
use crate::estimation::{InstrumentHealth, Validity};
use crate::fault::Sensor;
use crate::fence::{Breach, Fence, Zones};
use crate::identity::Identity;
use crate::mode::{Mode, Needs};
use crate::plan::{Place, Site};
use crate::surroundings::Terrain;
use crate::world::LocalFrame;

/// The vehicle as it is now. It consists of references and small copies: it is made anew for every call of a machine behind which it may
/// have changed, and a test of one machine can make it by hand.
#[derive(Clone, Copy, Debug)]
pub struct Situation<'a> {
    /// Simulation time, µs after the start.
    pub time_us: u64,
    /// Time of the start since 1970, µs.
    pub unix_start_us: u64,
    /// Whose conventions it follows.
    pub identity: Identity,
    /// Parameters of its behaviour.
    pub conduct: &'a Conduct,
    /// The closed loop's configuration, with the limits that are in force.
    pub configuration: &'a Configuration,
    /// Limits that references keep, and larger ones that the present motion began with.
    pub limits: &'a EasedLimits,
    /// The local frame.
    pub frame: &'a LocalFrame,
    /// The ground.
    pub terrain: &'a Terrain,
    /// The zones of the fence plan.
    pub zones: &'a Zones,
    /// The rally points.
    pub rally_points: &'a [Place],
    /// What the closed loop shows, as far as the vehicle knows its motion.
    pub outputs: &'a Outputs,
    /// What the closed loop shows in truth.
    pub truth: &'a Outputs,
    /// What of its motion is known well enough to fly by.
    pub validity: Validity,
    /// Which instruments work.
    pub health: InstrumentHealth,
    /// Whether it flies by instruments and an estimator; otherwise by the truth, or by what the controllers measure.
    pub estimates: bool,
    /// Down, m/s, by the latest fix of the receiver, if it flies by instruments and has one.
    pub fix_velocity_down_m_s: Option<f64>,
    /// Rotor speeds that the mixer commands, rad/s; `None` while a closed loop from elsewhere flies.
    pub rotor_command_rad_s: Option<[f64; 4]>,
    /// Velocity of the air, NED, m/s.
    pub wind_m_s: Vector3<f64>,
    /// Remaining share of the battery, as the gauge has it.
    pub battery_remaining: f64,
    /// Its voltage, and that without the drop that the current makes, V.
    pub battery_voltage_v: f64,
    #[allow(missing_docs)] // With the one above.
    pub battery_resting_v: f64,
    /// Its remaining charge, mA·h.
    pub battery_left_mah: f64,
    /// Whether the rotors may turn.
    pub armed: bool,
    /// The mode.
    pub mode: Mode,
    /// How it is steered. A machine that steers reads the working copy in its proposal instead.
    pub steering: &'a Steering,
    /// Home.
    pub home: &'a Home,
    /// What its nose is turned to where nothing else asks for a heading.
    pub region: Option<RegionOfInterest>,
    /// Whether it stands on the ground.
    pub landed: bool,
    /// Whether it comes down to the ground to land.
    pub comes_down: bool,
    /// Whether the pilot's sticks have moved the place of the landing.
    pub landing_is_moved: bool,
    /// The rotor that is known to be lost: front (0), right, back or left (3).
    pub lost_rotor: Option<usize>,
    /// North and east of a target that landings go to, m.
    pub landing_target_m: Option<[f64; 2]>,
    /// What the rangefinder sees below, if it sees anything.
    pub surface: Option<Surface>,
    /// What of the fence is breached, or is about to be.
    pub breach: Option<Breach>,
    /// Whether that still lies ahead.
    pub fence_is_ahead: bool,
    /// Whether the fence is switched on, by hand or by itself.
    pub fence_is_on: bool,
    /// Parts of it that are switched off, by the bits of ArduPilot's parameter.
    pub fence_parts_off: u8,
    /// Whether its floor counts.
    pub fence_floor_counts: bool,
    /// Whether the latest set-point is young enough to fly on.
    pub set_points_are_recent: bool,
    /// Whether the set-point that is steered to asks for a heading.
    pub set_point_turns: bool,
    /// The pilot.
    pub pilot: Pilot,
    /// Whether there is a way back that it came.
    pub has_trail: bool,
    /// Whether the mission goes on by itself on the ground.
    pub mission_goes_on: bool,
    /// Whether a mission on the ground may take off: ArduPilot's waits for a raised throttle or a command.
    pub mission_may_take_off: bool,
}

impl<'a> Situation<'a> {
    /// Limits that references keep.
    pub fn limits(&self) -> &'a Limits {
        self.limits.wanted()
    }

    /// Limits with which the present motion may brake: lower ones hold only once it can keep them.
    pub fn braking_limits(&self) -> Limits {
        self.limits.largest()
    }

    /// So many seconds from now, µs.
    pub fn after_us(&self, seconds: f64) -> u64 {
        self.time_us.saturating_add((seconds * 1e6) as u64)
    }

    /// Whether there is a flight that could be ended, or flown otherwise.
    pub fn flies(&self) -> bool {
        self.armed && self.steering.kind() != SteeringKind::Idle
    }

    /// Whether commands and set-points may lead it although its rotors idle: in ArduPilot's identity a takeoff that has just been asked
    /// for.
    pub fn may_be_led(&self) -> bool {
        self.armed && self.mode == Mode::Takeoff && self.identity.is_ardupilot()
    }

    /// Whether the mode leaves the heading to the vehicle.
    pub fn chooses_its_heading(&self) -> bool {
        match self.mode {
            Mode::Hold | Mode::Takeoff => true,
            // ArduPilot's guided mode, unless a set-point has a heading of its own.
            Mode::Offboard => self.identity.is_ardupilot() && !self.set_point_turns,
            _ => false,
        }
    }

    /// The mode in which it stays at a place that a command named.
    pub fn holding_mode(&self) -> Mode {
        if self.identity.is_ardupilot() { Mode::Offboard } else { Mode::Hold }
    }

    /// The instruments that do not work, by their names.
    pub fn failed_instruments(&self) -> Vec<&'static str> {
        let works = self.health;
        let instruments = [
            (works.gyroscope, Sensor::Gyroscope),
            (works.accelerometer, Sensor::Accelerometer),
            (works.magnetometer, Sensor::Magnetometer),
            (works.barometer, Sensor::Barometer),
            (works.gps, Sensor::Gps),
        ];
        instruments.into_iter().filter(|(works, _)| !works).map(|(_, sensor)| sensor.name()).collect()
    }

    /// The lost rotor that it comes down without. Not one that is only warned of: then it flies on in its mode as well as three
    /// rotors do.
    pub fn descends_without_rotor(&self) -> Option<usize> {
        self.lost_rotor.filter(|_| self.conduct.failsafe.rotor_failure > Action::Warn)
    }

    /// Refuses what is not flown on the way down without a rotor.
    ///
    /// # Errors
    /// [`Refusal::TemporarilyRejected`] that names the rotor.
    pub fn refuse_without_rotor(&self) -> Result<(), Refusal> {
        match self.descends_without_rotor() {
            Some(rotor) => Err(Refusal::later(format!("Rotor {} lost: only landing is possible", rotor + 1))),
            None => Ok(()),
        }
    }

    /// What the places of plans refer to.
    pub fn site(&self) -> Site {
        Site {
            identity: self.identity,
            frame: *self.frame,
            home_m: self.home.position_m,
            terrain: self.terrain.clone(),
        }
    }

    /// z of the ground below the place where it takes itself to be, m.
    pub fn ground_z_m(&self) -> f64 {
        self.terrain.z_below_m(&self.outputs.position_m)
    }

    /// z of the ground that is truly below it, m.
    pub fn true_ground_z_m(&self) -> f64 {
        self.terrain.z_below_m(&self.truth.position_m)
    }

    /// What the feet feel: the true motion, and the reference as far from it as the controllers believe.
    pub fn felt(&self) -> Outputs {
        let mut felt = *self.truth;
        felt.setpoint.position_m += self.truth.position_m - self.outputs.position_m;
        felt
    }

    /// Whether it knows enough of its motion to hold a place and a height: not without its inertial unit, nor when neither the
    /// receiver nor the barometer is left to correct the height.
    pub fn knows_its_place(&self) -> bool {
        let (known, works) = (self.validity, self.health);
        let estimated = known.tilt && known.horizontal_position && known.vertical_position;
        // Ideal sensors know the rest by themselves.
        let ideal = !self.estimates;
        estimated && (ideal || works.gyroscope && works.supports_height())
    }

    /// Whether it knows enough of its motion to hold a height.
    pub fn knows_its_height(&self) -> bool {
        let (known, works) = (self.validity, self.health);
        let estimated = known.tilt && known.vertical_position;
        let ideal = !self.estimates;
        estimated && (ideal || works.gyroscope && works.supports_height())
    }

    /// Whether it knows enough of its motion for a mode.
    pub fn can_fly(&self, mode: Mode) -> bool {
        match mode.needs() {
            Needs::Attitude => self.validity.tilt && (!self.estimates || self.health.gyroscope),
            Needs::Height => self.knows_its_height(),
            Needs::Place => self.knows_its_place(),
        }
    }

    /// How fast it sinks, m/s: by the estimate, or where nothing supports that any more by the receiver.
    pub fn sink_rate_m_s(&self) -> f64 {
        let by_fix = self.fix_velocity_down_m_s.filter(|_| !self.health.supports_height());
        by_fix.unwrap_or(self.outputs.velocity_m_s.z)
    }

    /// The fence as it is looked at; `None` while it is switched off.
    pub fn fence(&self) -> Option<Fence<'a>> {
        self.fence_is_on.then(|| self.whole_fence())
    }

    /// The parts of the fence that count while it is switched on.
    pub fn fence_parts(&self) -> FenceParts {
        FenceParts::from_bits(self.conduct.failsafe.fence_parts.bits() & !self.fence_parts_off)
    }

    /// The fence, switched on or off.
    pub fn whole_fence(&self) -> Fence<'a> {
        let settings = &self.conduct.failsafe;
        let parts = self.fence_parts();
        let of = |looked_at: bool, limit_m: f64| if looked_at { limit_m } else { 0.0 };
        Fence {
            zones: parts.zones.then_some(self.zones),
            inclusions: settings.fence_inclusions(),
            home_m: self.home.position_m,
            radius_m: of(parts.distance, settings.fence_radius_m),
            height_m: of(parts.height, self.fence_height_m()),
        }
    }

    /// The highest that the fence allows above home, m; 0: any height. One that lies below home forbids all.
    pub fn fence_height_m(&self) -> f64 {
        let settings = &self.conduct.failsafe;
        let limit_m = settings.fence_height_m;
        if limit_m > 0.0 {
            self.above_home_m(settings.fence_height_from, limit_m).max(f64::MIN_POSITIVE)
        } else {
            limit_m
        }
    }

    /// The lowest that the fence allows above home, m.
    pub fn fence_floor_m(&self) -> f64 {
        let settings = &self.conduct.failsafe;
        self.above_home_m(settings.fence_floor_from, settings.fence_floor_m)
    }

    /// A height, m, as one above home.
    fn above_home_m(&self, datum: FenceDatum, height_m: f64) -> f64 {
        let home_z_m = self.home.position_m.z;
        match datum {
            FenceDatum::Home => height_m,
            FenceDatum::SeaLevel => height_m - self.frame.origin().altitude_m + home_z_m,
            FenceDatum::Origin => height_m + home_z_m,
            FenceDatum::Ground => height_m + home_z_m - self.terrain.z_below_m(&self.outputs.position_m),
        }
    }

    /// The highest that the fence allows, z, m, if it bounds the height.
    pub fn fence_ceiling_z_m(&self) -> Option<f64> {
        let fence = self.fence().filter(|fence| fence.height_m > 0.0)?;
        Some(fence.home_m.z - fence.height_m)
    }

    /// What of the fence forbids a place, NED, m.
    pub fn breach_at(&self, place_m: &Vector3<f64>) -> Option<Breach> {
        self.fence()?.breach(place_m)
    }

    /// What of the fence forbids a place or the straight way to it.
    pub fn breach_to(&self, place_m: &Vector3<f64>) -> Option<Breach> {
        self.fence()?.breach_on_way(&self.outputs.position_m, place_m)
    }
}
