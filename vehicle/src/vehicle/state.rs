//! The vehicle's state and one tick of it.

use std::collections::VecDeque;

use nalgebra::Vector3;
use quadrotor::{
    Configuration, ConfigurationError, Disturbance, Inputs, Outputs, PositionReference, Simulation,
    SimulationError,
};
use serde::{Deserialize, Serialize};

use super::battery::Battery;
use super::conduct::Conduct;
use super::failsafe::Failsafe;
use super::fence::FenceRecord;
use super::home::Home;
use super::landed::{LandedDetector, LandedState};
use super::mission::Mission;
use super::notice::{Notice, Severity};
use super::offboard::SetPoints;
use super::region::RegionOfInterest;
use super::return_home::ReturnPhase;
use super::rotor_loss::RotorWatch;
use super::set_point::PositionSetPoint;
use super::speeds::Speeds;
use super::steering::{Steering, SteeringKind};
use super::sticks::Sticks;
use crate::estimation::{Estimate, IdealSensors, Navigation, SensorModel, SensorSettings};
use crate::fault::{Faults, ScheduledFault};
use crate::fence::Zones;
use crate::identity::Identity;
use crate::mode::Mode;
use crate::plan::{Place, PlanKind, Plans, Site, compile, zones};
use crate::world::{Geodetic, LocalFrame, Wind, WindSettings};

/// Length of a tick, µs: requests take effect, and telemetry is sampled, on this grid of simulation time.
pub const TICK_US: u64 = 1_000;

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
    /// What breaks when.
    #[serde(default)]
    pub faults: Vec<ScheduledFault>,
    /// What it knows its motion by.
    #[serde(default)]
    pub sensors: SensorSettings,
    /// What it is to fly, and where it may.
    #[serde(default)]
    pub plans: Plans,
}

/// The vehicle.
#[derive(Debug)]
pub struct Vehicle {
    pub(super) identity: Identity,
    pub(super) conduct: Conduct,
    pub(super) simulation: Simulation,
    /// What the closed loop shows, as far as the vehicle knows it.
    pub(super) outputs: Outputs,
    /// What it shows in truth.
    pub(super) truth: Outputs,
    /// Instruments and estimator, unless the truth is known.
    pub(super) navigation: Option<Navigation>,
    pub(super) ideal_sensors: IdealSensors,
    pub(super) frame: LocalFrame,
    /// Time of the start since 1970, µs.
    pub(super) unix_start_us: u64,
    pub(super) wind: Wind,
    pub(super) wind_m_s: Vector3<f64>,
    pub(super) battery: Battery,
    pub(super) faults: Faults,
    /// Those to come, the next one first.
    pub(super) scheduled_faults: VecDeque<ScheduledFault>,
    pub(super) rotors: RotorWatch,
    pub(super) landed: LandedDetector,
    pub(super) home: Home,
    pub(super) armed: bool,
    /// Whether the last flight was ended in the air; until it is armed again.
    pub(super) terminated: bool,
    pub(super) mode: Mode,
    pub(super) steering: Steering,
    pub(super) set_points: SetPoints,
    pub(super) sticks: Option<(Sticks, u64)>,
    /// z of the goal of a takeoff, m.
    pub(super) takeoff_z_m: Option<f64>,
    pub(super) return_phase: ReturnPhase,
    /// Whether it has flown since it was armed.
    pub(super) flown: bool,
    /// Since when it has been armed and on the ground, µs.
    pub(super) grounded_since_us: u64,
    pub(super) notices: Vec<Notice>,
    pub(super) plans: Plans,
    pub(super) fence_zones: Zones,
    pub(super) rally_points: Vec<Place>,
    pub(super) fence_record: FenceRecord,
    pub(super) failsafe: Failsafe,
    /// The way of a return: north and east, m, the place to land at last.
    pub(super) return_way_m: VecDeque<[f64; 2]>,
    pub(super) mission: Mission,
    pub(super) speeds: Speeds,
    pub(super) region: Option<RegionOfInterest>,
}

impl Vehicle {
    /// A vehicle at rest on the ground, disarmed.
    ///
    /// # Errors
    /// As [`Simulation::new`].
    pub fn new(settings: &VehicleSettings) -> Result<Self, ConfigurationError> {
        let mut configuration = settings.configuration;
        configuration.environment.ground_plane = true;
        configuration.reference.shaping = true;
        configuration.initial.attitude_rad[2] = settings.heading_rad;
        let navigation = (settings.sensors.model == SensorModel::Realistic).then(|| {
            let start = Estimate::unaligned(configuration.initial.position_m.into(), settings.heading_rad);
            Navigation::new(settings.sensors.seed, start)
        });
        let inputs = Inputs { armed: false, ..Inputs::default() };
        let simulation = Simulation::new(&configuration, &inputs)?;
        let outputs = simulation.outputs();
        let mut scheduled_faults = settings.faults.clone();
        scheduled_faults.sort_by_key(|fault| fault.time_us);
        let frame = LocalFrame::new(settings.origin);
        let home_m = Vector3::from(configuration.initial.position_m);
        let site = Site { identity: settings.identity, frame, home_m };
        // What was taken once is taken again: the plan has been checked where it came from.
        let items = |kind| settings.plans.get(kind).items();
        let fence_zones = zones(items(PlanKind::Fence), &site).unwrap_or_default();
        let rally_points = compile::rally_points(items(PlanKind::Rally), &site);
        let program = compile::mission(items(PlanKind::Mission), &site);
        let mut vehicle = Self {
            identity: settings.identity,
            conduct: settings.conduct,
            frame,
            unix_start_us: 0,
            wind: Wind::new(settings.wind),
            wind_m_s: Vector3::zeros(),
            battery: Battery::default(),
            faults: Faults::default(),
            scheduled_faults: scheduled_faults.into(),
            rotors: RotorWatch::new(outputs.rotor_speed_rad_s),
            landed: LandedDetector::new(-outputs.position_m.z),
            home: Home { position_m: home_m, yaw_rad: settings.heading_rad, set_by_user: false },
            armed: false,
            terminated: false,
            mode: settings.identity.first_mode(),
            steering: Steering::Idle { yaw_rad: settings.heading_rad },
            set_points: SetPoints::default(),
            sticks: None,
            takeoff_z_m: None,
            return_phase: ReturnPhase::Climb,
            flown: false,
            grounded_since_us: 0,
            notices: Vec::new(),
            plans: settings.plans.clone(),
            fence_zones,
            rally_points,
            fence_record: FenceRecord::default(),
            failsafe: Failsafe::default(),
            return_way_m: VecDeque::new(),
            mission: Mission::new(program),
            speeds: Speeds::new(&configuration.limits),
            region: None,
            simulation,
            outputs,
            truth: outputs,
            navigation,
            ideal_sensors: IdealSensors::default(),
        };
        vehicle.outputs = vehicle.known();
        Ok(vehicle)
    }

    /// Flies one tick on.
    ///
    /// # Errors
    /// [`SimulationError`]: the flight has left the range of numbers.
    pub fn tick(&mut self) -> Result<(), SimulationError> {
        self.suffer_scheduled();
        self.watch_fence();
        self.watch();
        if self.armed {
            self.fly();
        }
        let dt_s = TICK_US as f64 / 1e6;
        let time_us = self.outputs.time_us;
        let reference = self.steering.apply(&mut self.simulation, &self.outputs, dt_s)?;
        let height_m = -self.truth.position_m.z;
        self.wind_m_s = self.wind.velocity_m_s(time_us, height_m);
        // The contact's friction grows with the slip; what stands is held by static friction, and does not creep.
        let stands = self.landed.is_landed() && !self.armed;
        let wind_m_s = if stands { Vector3::zeros() } else { self.wind_m_s };
        let disturbance = Disturbance { wind_m_s, ..Disturbance::default() };
        let inputs = Inputs { reference, disturbance, armed: self.armed };
        self.simulation.set_rotor_faults(self.faults.rotors())?;
        self.simulation.set_estimate(self.estimate().map(|estimate| estimate.body))?;
        self.simulation.advance_to(time_us + TICK_US, &inputs)?;
        self.perceive();
        self.watch_rotors(dt_s);

        let airframe = self.simulation.configuration().airframe;
        let capacity_ah = self.conduct.battery_capacity_ah;
        self.battery.fail(self.faults.battery(), capacity_ah);
        self.battery.step(&airframe, &self.outputs.rotor_speed_rad_s, capacity_ah, dt_s);
        let controlled = self.steering.kind() == SteeringKind::Position;
        let stood = self.landed.is_landed();
        self.landed.update(&self.felt(), airframe.weight_n(), self.armed, controlled);
        if self.landed.is_landed() != stood {
            self.touched(!stood);
        }
        self.rest();
        Ok(())
    }

    /// A vehicle that stands, and is not led up, lets its rotors idle. A mission and a takeoff know what they do.
    fn rest(&mut self) {
        let waits = !matches!(self.mode, Mode::Mission | Mode::Takeoff);
        if waits && self.landed.is_settled() && self.steering.stays_below(self.outputs.position_m.z) {
            self.idle();
        }
    }

    /// The vehicle has touched down (`true`) or lifted off.
    fn touched(&mut self, down: bool) {
        if !down {
            self.flown |= self.armed;
            return;
        }
        self.grounded_since_us = self.time_us();
        if self.armed && self.flown {
            self.say(Severity::Info, "Landing detected");
        }
        // An attitude is the pilot's own business.
        if self.steering.kind() == SteeringKind::Position {
            self.idle();
        }
    }

    pub(super) fn idle(&mut self) {
        self.steering = Steering::Idle { yaw_rad: self.outputs.attitude_rad.z };
    }

    /// Brakes and holds the place. A vehicle that rests at its goal stays steered to it; one that has not set out yet does
    /// not.
    pub(super) fn hold(&mut self) {
        const NEAR_M: f64 = 0.01;
        const SLOW_M_S: f64 = 0.01;
        let now = &self.outputs.setpoint;
        let rests_at = |goal: &PositionReference| {
            (goal.position_m - now.position_m).norm() < NEAR_M && now.velocity_m_s.norm() < SLOW_M_S
        };
        match &self.steering {
            Steering::Idle { .. } => {}
            Steering::Goal(goal) if rests_at(goal) => {}
            _ => self.follow(&PositionSetPoint::HOLD),
        }
    }

    pub(super) fn follow(&mut self, set_point: &PositionSetPoint) {
        if self.lost_rotor().is_none() {
            self.steering.follow(set_point, &self.outputs);
        }
    }

    pub(super) fn say(&mut self, severity: Severity, text: impl Into<String>) {
        self.notices.push(Notice { severity, text: text.into() });
    }

    /// Notices since the last call.
    pub fn take_notices(&mut self) -> Vec<Notice> {
        std::mem::take(&mut self.notices)
    }

    /// Whose conventions it follows.
    pub fn identity(&self) -> Identity {
        self.identity
    }

    /// Simulation time, µs after the start.
    pub fn time_us(&self) -> u64 {
        self.outputs.time_us
    }

    /// Tells what time it was at the start, µs since 1970.
    pub fn set_unix_start_us(&mut self, unix_start_us: u64) {
        self.unix_start_us = unix_start_us;
    }

    /// Time of the start, µs since 1970.
    pub fn unix_start_us(&self) -> u64 {
        self.unix_start_us
    }

    /// What the closed loop shows, as far as the vehicle knows its motion.
    pub fn outputs(&self) -> &Outputs {
        &self.outputs
    }

    /// What the closed loop shows in truth.
    pub fn truth(&self) -> &Outputs {
        &self.truth
    }

    /// The closed loop.
    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// The local frame.
    pub fn frame(&self) -> &LocalFrame {
        &self.frame
    }

    /// Velocity of the air, NED, m/s.
    pub fn wind_m_s(&self) -> Vector3<f64> {
        self.wind_m_s
    }

    /// The battery.
    pub fn battery(&self) -> &Battery {
        &self.battery
    }

    /// Remaining share of the battery.
    pub fn battery_remaining(&self) -> f64 {
        self.battery.remaining(self.conduct.battery_capacity_ah)
    }

    /// Its own parameters.
    pub fn conduct(&self) -> &Conduct {
        &self.conduct
    }

    /// Changes its own parameters.
    pub fn set_conduct(&mut self, conduct: Conduct) {
        self.conduct = conduct;
    }

    /// Home.
    pub fn home(&self) -> &Home {
        &self.home
    }

    /// Whether the rotors may turn.
    pub fn is_armed(&self) -> bool {
        self.armed
    }

    /// The mode.
    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// How it is steered.
    pub fn steering_kind(&self) -> SteeringKind {
        self.steering.kind()
    }

    /// Attitude and thrust that are tracked now, if it is steered by them.
    pub fn attitude_reference(&self) -> Option<(nalgebra::UnitQuaternion<f64>, Vector3<f64>, f64)> {
        match &self.steering {
            Steering::Attitude { set_point, reference } => {
                Some((*reference, set_point.body_rate_rad_s, set_point.thrust))
            }
            _ => None,
        }
    }

    /// Whether it stands, climbs from the ground, flies or descends to the ground.
    pub fn landed_state(&self) -> LandedState {
        let (climbs, descends) = self.mission.is_vertical();
        match self.mode {
            _ if self.landed.is_landed() => LandedState::OnGround,
            Mode::Mission if climbs => LandedState::TakingOff,
            Mode::Mission if descends => LandedState::Landing,
            Mode::Takeoff => LandedState::TakingOff,
            Mode::Land => LandedState::Landing,
            Mode::Return if self.return_phase == ReturnPhase::Descend => LandedState::Landing,
            _ => LandedState::InAir,
        }
    }

    /// Changes the closed loop, what is fixed in flight only while it is disarmed on the ground.
    pub(super) fn configure(&mut self, configuration: &Configuration) -> Result<(), ConfigurationError> {
        match self.simulation.reconfigure(configuration) {
            Err(ConfigurationError::Fixed { .. }) if !self.armed && self.landed.is_landed() => {
                self.simulation = Simulation::from_state(configuration, *self.simulation.state())?;
                self.truth = self.simulation.outputs();
                self.outputs = self.known();
                Ok(())
            }
            result => result,
        }
    }
}
