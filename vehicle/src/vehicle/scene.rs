//! A vehicle made by hand, for tests of single machines.

use nalgebra::Vector3;
use quadrotor::{Activity, BatteryOutput, Belief, Configuration, EasedLimits, Outputs, PositionReference};

use super::conduct::Conduct;
use super::home::Home;
use super::motion::at_rest;
use super::proposal::{Proposal, Request};
use super::receiver::Pilot;
use super::situation::Situation;
use super::steering::Steering;
use super::surface_tracking::Surface;
use crate::estimation::{InstrumentHealth, Validity};
use crate::fence::Zones;
use crate::identity::Identity;
use crate::mode::Mode;
use crate::plan::Place;
use crate::surroundings::Terrain;
use crate::world::{Geodetic, LocalFrame};

/// Everything that a situation refers to.
pub struct Scene {
    pub identity: Identity,
    pub conduct: Conduct,
    pub configuration: Configuration,
    pub limits: EasedLimits,
    pub zones: Zones,
    pub rally_points: Vec<Place>,
    /// Known and true.
    pub outputs: Outputs,
    pub armed: bool,
    pub mode: Mode,
    pub steering: Steering,
    pub home: Home,
    pub validity: Validity,
    pub landed: bool,
    pub comes_down: bool,
    pub lost_rotor: Option<usize>,
    pub landing_target_m: Option<[f64; 2]>,
    pub surface: Option<Surface>,
    pub set_points_are_recent: bool,
    pub mission_goes_on: bool,
    pub has_trail: bool,
    pub rotor_command_rad_s: [f64; 4],
    pub wind_m_s: Vector3<f64>,
    pub pilot: Pilot,
    pub terrain: Terrain,
    frame: LocalFrame,
}

impl Scene {
    /// The scene of a vehicle with ArduPilot's conventions and defaults.
    pub fn of_ardupilot(mut self) -> Self {
        (self.identity, self.conduct) = (Identity::ArduPilot, Conduct::new(true));
        self
    }

    /// It hovers at a place, NED, m, by position, in the hold mode.
    pub fn hovering_at(position_m: [f64; 3]) -> Self {
        let setpoint = PositionReference::goal(position_m, 0.0);
        let configuration = Configuration::default();
        let hover_rad_s = configuration.airframe.hover_rotor_speed_rad_s();
        let origin = Geodetic { latitude_deg: 47.4, longitude_deg: 8.5, altitude_m: 488.0 };
        Self {
            identity: Identity::Px4,
            conduct: Conduct::new(false),
            configuration,
            limits: EasedLimits::new(&configuration.limits),
            zones: Zones::default(),
            rally_points: Vec::new(),
            outputs: Outputs {
                time_us: 100_000_000,
                position_m: position_m.into(),
                velocity_m_s: Vector3::zeros(),
                acceleration_m_s2: Vector3::zeros(),
                body_velocity_m_s: Vector3::zeros(),
                attitude_rad: Vector3::zeros(),
                quaternion: [1.0, 0.0, 0.0, 0.0],
                body_rate_rad_s: Vector3::zeros(),
                thrust_n: configuration.airframe.weight_n(),
                torque_n_m: Vector3::zeros(),
                battery: BatteryOutput::default(),
                rotor_speed_rad_s: [hover_rad_s; 4],
                tilt_reference_rad: [0.0; 2],
                setpoint,
                tracking_error_m: Vector3::zeros(),
                yaw_error_rad: 0.0,
                activity: Activity::default(),
                belief: Belief::configured(&configuration),
            },
            armed: true,
            mode: Mode::Hold,
            steering: Steering::Goal(setpoint),
            home: Home { position_m: Vector3::zeros(), yaw_rad: 0.0, set_by_user: false },
            validity: Validity {
                tilt: true,
                heading: true,
                horizontal_velocity: true,
                vertical_velocity: true,
                horizontal_position: true,
                vertical_position: true,
            },
            landed: false,
            comes_down: false,
            lost_rotor: None,
            landing_target_m: None,
            surface: None,
            set_points_are_recent: false,
            mission_goes_on: false,
            has_trail: false,
            rotor_command_rad_s: [hover_rad_s; 4],
            wind_m_s: Vector3::zeros(),
            pilot: Pilot::default(),
            terrain: Terrain::default(),
            frame: LocalFrame::new(origin),
        }
    }

    /// It stands at home, armed, and its rotors idle.
    pub fn on_the_ground() -> Self {
        let mut scene = Self::hovering_at([0.0; 3]);
        scene.landed = true;
        scene.steering = Steering::Idle { yaw_rad: 0.0 };
        scene.outputs.thrust_n = 0.0;
        scene
    }

    /// The vehicle comes to a place, NED, m, with a velocity, m/s.
    pub fn come_to(&mut self, position_m: [f64; 3], velocity_m_s: [f64; 3]) {
        (self.outputs.position_m, self.outputs.velocity_m_s) = (position_m.into(), velocity_m_s.into());
        self.outputs.setpoint = PositionReference {
            velocity_m_s: velocity_m_s.into(),
            ..at_rest(position_m.into(), self.outputs.setpoint.yaw_rad)
        };
    }

    /// Time goes on.
    pub fn wait_us(&mut self, duration_us: u64) {
        self.outputs.time_us += duration_us;
    }

    /// The situation of now.
    pub fn situation(&self) -> Situation<'_> {
        Situation {
            time_us: self.outputs.time_us,
            unix_start_us: 0,
            identity: self.identity,
            conduct: &self.conduct,
            configuration: &self.configuration,
            limits: &self.limits,
            frame: &self.frame,
            terrain: &self.terrain,
            zones: &self.zones,
            rally_points: &self.rally_points,
            outputs: &self.outputs,
            truth: &self.outputs,
            validity: self.validity,
            health: InstrumentHealth {
                gyroscope: true,
                accelerometer: true,
                magnetometer: true,
                barometer: true,
                gps: true,
                vision: false,
            },
            estimates: true,
            fix_velocity_down_m_s: None,
            rotor_command_rad_s: Some(self.rotor_command_rad_s),
            wind_m_s: self.wind_m_s,
            battery_remaining: 1.0,
            battery_voltage_v: 12.6,
            battery_resting_v: 12.6,
            battery_left_mah: 2200.0,
            armed: self.armed,
            mode: self.mode,
            steering: &self.steering,
            home: &self.home,
            region: None,
            landed: self.landed,
            comes_down: self.comes_down,
            landing_is_moved: false,
            lost_rotor: self.lost_rotor,
            landing_target_m: self.landing_target_m,
            surface: self.surface,
            breach: None,
            fence_is_ahead: false,
            fence_is_on: self.conduct.failsafe.fence_enabled,
            fence_parts_off: 0,
            fence_floor_counts: false,
            set_points_are_recent: self.set_points_are_recent,
            set_point_turns: false,
            pilot: self.pilot,
            has_trail: self.has_trail,
            mission_goes_on: self.mission_goes_on,
            mission_may_take_off: true,
        }
    }

    /// Shows the situation to a machine and steers as it asks. Returns its requests.
    pub fn show<T>(&mut self, ask: impl FnOnce(&Situation, &mut Proposal) -> T) -> Vec<Request> {
        let situation = self.situation();
        let mut proposal = Proposal::new(&situation);
        ask(&situation, &mut proposal);
        let outcome = proposal.into_outcome();
        self.steering = outcome.steering.unwrap_or(self.steering);
        outcome.requests
    }

    /// Where the shaper leads, NED, m, if it leads anywhere.
    pub fn goal_m(&self) -> Option<[f64; 3]> {
        match &self.steering {
            Steering::Goal(goal) => Some(goal.position_m.into()),
            Steering::Path(path) => Some(path.end().position_m.into()),
            _ => None,
        }
    }
}

/// What is said, where nothing else is asked for.
pub fn said(requests: &[Request]) -> Vec<&str> {
    let mut lines = Vec::new();
    for request in requests {
        match request {
            Request::Say(notice) => lines.push(notice.text.as_str()),
            other => panic!("{other:?}"),
        }
    }
    lines
}
