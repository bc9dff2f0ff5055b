//! Plant, instruments and their time, without a socket and without a clock.

use autopilot::codec::hil_state_quaternion;
use mavlink::dialects::ardupilotmega::MavMessage;
use nalgebra::Vector3;
use quadrotor::{
    CascadeDesign, ConfigurationError, Disturbance, GRAVITY_M_S2, Plant, PlantInputs, PlantState,
    SimulationError,
};
use vehicle::estimation::TrueMotion;
use vehicle::foreign::{ForeignModel, drive};
use vehicle::surroundings::Terrain;
use vehicle::world::{LocalFrame, Wind};
use vehicle::{FlightError, TICK_US, VehicleSettings};

use super::actuator_controls::ActuatorControls;
use super::instruments::Instruments;
use super::messages;
use super::mount::Mount;
use super::mounting::Mounting;
use crate::record::Digest;

/// From one HIL_SENSOR to the next, µs: PX4's 250 Hz.
pub const STEP_US: u64 = 4_000;
/// HEARTBEAT, µs.
const HEARTBEAT_US: u64 = 1_000_000;
/// HIL_STATE_QUATERNION unless something else is asked for, µs.
const TRUTH_US: u64 = 20_000;
/// Motors stop when controls have not come for so long, µs, as speed controllers do without a signal.
const SIGNAL_LOSS_US: u64 = 200_000;

/// A vehicle on the ground, its rotors at rest.
#[derive(Debug)]
pub struct Rig {
    mounting: Mounting,
    frame: LocalFrame,
    wind: Wind,
    instruments: Instruments,
    plant: Plant,
    state: PlantState,
    terrain: Terrain,
    /// What moves in place of our plant, if anything does, and its acceleration, m/s².
    foreign: Option<(Box<dyn ForeignModel>, Vector3<f64>)>,
    time_us: u64,
    command_rad_s: [f64; 4],
    controlled_us: Option<u64>,
    truth_us: Option<u64>,
    digest: Digest,
}

impl Rig {
    /// A rig on the ground at the origin.
    ///
    /// # Errors
    /// [`ConfigurationError`] if the vehicle cannot fly, or its rotors do not turn as the autopilot's motors.
    pub fn new(settings: &VehicleSettings, mount: Mount) -> Result<Self, ConfigurationError> {
        let placed = Self::placed(settings, mount)?;
        let mounting = Mounting::new(mount, &placed.configuration.airframe.layout)?;
        let configuration = placed.flown_configuration();
        // Its checks are those of the airframe, too.
        CascadeDesign::new(&configuration)?;
        Ok(Self {
            mounting,
            frame: LocalFrame::new(settings.origin),
            wind: Wind::new(settings.wind),
            terrain: settings.surroundings.terrain.clone(),
            instruments: Instruments::new(settings.wind.seed),
            plant: Plant::new(&configuration.airframe, &configuration.environment),
            state: PlantState::at_rest(&configuration.initial),
            foreign: None,
            time_us: 0,
            command_rad_s: [0.0; 4],
            controlled_us: None,
            truth_us: Some(TRUTH_US),
            digest: Digest::default(),
        })
    }

    /// The vehicle as it stands in the world: the autopilot's nose has the heading of the settings.
    ///
    /// # Errors
    /// [`ConfigurationError`] if its rotors do not turn as the autopilot's motors.
    pub fn placed(settings: &VehicleSettings, mount: Mount) -> Result<VehicleSettings, ConfigurationError> {
        let mounting = Mounting::new(mount, &settings.configuration.airframe.layout)?;
        Ok(VehicleSettings { heading_rad: settings.heading_rad - mounting.yaw_rad, ..settings.clone() })
    }

    /// The same rig with a plant from elsewhere, where that starts.
    pub fn flown_by(mut self, model: Box<dyn ForeignModel>) -> Self {
        let start = model.description().start;
        self.state.body = start.body;
        self.state.rotor_speed_rad_s = start.rotor_speed_rad_s.unwrap_or_default();
        self.foreign = Some((model, start.acceleration_m_s2.unwrap_or_default()));
        self
    }

    /// Simulation time, µs.
    pub fn time_us(&self) -> u64 {
        self.time_us
    }

    /// Rotors and rigid body.
    pub fn plant(&self) -> &PlantState {
        &self.state
    }

    /// Digest of the flight so far.
    pub fn digest(&self) -> Digest {
        self.digest
    }

    /// Turns the motors as told from now on: 0 is the lowest speed of an armed rotor, 1 the highest, linear between.
    pub fn control(&mut self, controls: &ActuatorControls) {
        let airframe = self.plant.airframe();
        let (lowest, highest) = (airframe.rotor_speed_min_rad_s, airframe.rotor_speed_max_rad_s);
        let speed = |motor: f64| if controls.armed { lowest + motor * (highest - lowest) } else { 0.0 };
        self.command_rad_s = self.mounting.rotors(controls.motors.map(speed));
        self.controlled_us = Some(self.time_us);
    }

    /// Asks for HIL_STATE_QUATERNION in an interval, µs, in whole steps; zero for the usual one, `None` for none.
    pub fn set_truth_interval(&mut self, interval_us: Option<u64>) {
        self.truth_us = interval_us.map(|interval_us| match interval_us {
            0 => TRUTH_US,
            _ => interval_us.div_ceil(STEP_US).saturating_mul(STEP_US),
        });
    }

    /// Flies one step on. What the autopilot is told after it.
    ///
    /// # Errors
    /// [`FlightError`]
    pub fn step(&mut self) -> Result<Vec<MavMessage>, FlightError> {
        let signal = self.controlled_us.is_some_and(|since_us| self.time_us < since_us + SIGNAL_LOSS_US);
        if !signal {
            self.command_rad_s = [0.0; 4];
        }
        let goal_us = self.time_us + STEP_US;
        let mut motion = self.motion(&Vector3::zeros());
        let mut wind_m_s = Vector3::zeros();
        while self.time_us < goal_us {
            let height_m = self.ground_z_m() - self.state.body.position_m.z;
            wind_m_s = self.wind.velocity_m_s(self.time_us, height_m);
            self.state = self.moved(&self.inputs(wind_m_s))?;
            self.time_us += TICK_US;
            if self.state.has_diverged() {
                return Err(SimulationError::Diverged { time_us: self.time_us, overload: None }.into());
            }
            self.digest.update_with(self.time_us, &self.state);
            motion = self.motion(&wind_m_s);
            self.instruments.sample(&motion, &self.frame);
        }
        Ok(self.report(&motion, &wind_m_s))
    }

    /// The state after a tick.
    fn moved(&mut self, inputs: &PlantInputs) -> Result<PlantState, FlightError> {
        let Some((model, acceleration_m_s2)) = &mut self.foreign else {
            return Ok(self.plant.step(&self.state, inputs, TICK_US as f64 / 1e6));
        };
        let span = (self.time_us, TICK_US);
        let driven = drive(model.as_mut(), &self.plant, &self.state, inputs, span)?;
        *acceleration_m_s2 = driven.acceleration_m_s2;
        Ok(driven.state)
    }

    /// What acts on the plant.
    fn inputs(&self, wind_m_s: Vector3<f64>) -> PlantInputs {
        let disturbance = Disturbance { wind_m_s, ..Disturbance::default() };
        let ground_z_m = self.ground_z_m();
        PlantInputs { disturbance, ground_z_m, ..PlantInputs::rotor_speeds(self.command_rad_s) }
    }

    /// z of the ground below, m.
    fn ground_z_m(&self) -> f64 {
        self.terrain.z_below_m(&self.state.body.position_m)
    }

    fn report(&mut self, motion: &TrueMotion, wind_m_s: &Vector3<f64>) -> Vec<MavMessage> {
        let readings = self.instruments.take();
        let mut told = Vec::new();
        if self.time_us.is_multiple_of(HEARTBEAT_US) {
            told.push(messages::heartbeat());
        }
        if self.truth_us.is_some_and(|interval_us| self.time_us.is_multiple_of(interval_us)) {
            told.push(hil_state_quaternion(motion, &self.frame.to_geodetic(&motion.position_m), wind_m_s));
        }
        told.extend(readings.fix.map(|fix| messages::gps(&fix, &self.frame)));
        // Last: it makes the autopilot's time pass.
        told.push(messages::sensor(self.time_us, &readings));
        told
    }

    /// What happens to the autopilot's instruments, in its axes.
    fn motion(&self, wind_m_s: &Vector3<f64>) -> TrueMotion {
        let body = &self.state.body;
        let acceleration = match &self.foreign {
            Some((_, acceleration_m_s2)) => *acceleration_m_s2,
            None => self.plant.acceleration_m_s2(&self.state, &self.inputs(*wind_m_s)),
        };
        let gravity = Vector3::new(0.0, 0.0, GRAVITY_M_S2);
        let mount = self.mounting.rotation();
        let attitude = body.rotation() * mount;
        TrueMotion {
            time_us: self.time_us,
            position_m: body.position_m,
            velocity_m_s: body.velocity_m_s,
            attitude,
            body_rate_rad_s: mount.inverse_transform_vector(&body.body_rate_rad_s),
            specific_force_m_s2: attitude.inverse_transform_vector(&(acceleration - gravity)),
        }
    }
}
