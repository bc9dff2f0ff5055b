//! The vehicle's state and one tick of it.

mod ardupilot_arming;
mod arming;
mod decision;
mod equipment;
mod home_requests;
mod lead;
mod long_tick;
mod look_back;
mod outputs;
mod parachute;
mod pilot;
mod plan_requests;
mod plan_start;
mod queries;
mod reboot;
mod requests;
mod surroundings;
mod takeoff_requests;

use nalgebra::{Vector2, Vector3};
use quadrotor::ConfigurationError;

use self::long_tick::LongTick;
use super::battery::{capacity_ah, full_voltage_v};
use super::closed_loop::{ClosedLoop, Conditions};
use super::decided::Decided;
use super::home::Home;
use super::machines::Machines;
use super::perception::Perception;
use super::plans::KnownPlans;
use super::settings::VehicleSettings;
use super::setup::Setup;
use super::situation::Situation;
use super::tick::{TICK_S, TICK_US};
use crate::FlightError;
use crate::estimation::{Estimate, Navigation, SensorModel};
use crate::foreign::ForeignModel;
use crate::mode::Mode;
use crate::plan::{PlanKind, Site, compile};
use crate::world::LocalFrame;

/// The vehicle.
#[derive(Debug)]
pub struct Vehicle {
    setup: Setup,
    closed_loop: ClosedLoop,
    perception: Perception,
    plans: KnownPlans,
    decided: Decided,
    machines: Machines,
    /// The long tick that is being flown.
    tick: Option<LongTick>,
    /// How long the latest tick has lasted, s.
    lasted_s: f64,
}

impl Vehicle {
    /// A vehicle at rest on the ground, disarmed.
    ///
    /// # Errors
    /// As [`Simulation::new`](quadrotor::Simulation::new).
    pub fn new(settings: &VehicleSettings) -> Result<Self, ConfigurationError> {
        Ok(Self::around(settings, closed_loop(settings)?))
    }

    /// The same, flown by a closed loop or a plant from elsewhere.
    ///
    /// # Errors
    /// [`FlightError`] if ours cannot be built, or the model starts nowhere.
    pub fn flown_by(settings: &VehicleSettings, model: Box<dyn ForeignModel>) -> Result<Self, FlightError> {
        let closed_loop = closed_loop(settings)?;
        Ok(Self::around(settings, closed_loop.flown_by(model)?))
    }

    fn around(settings: &VehicleSettings, closed_loop: ClosedLoop) -> Self {
        let configuration = settings.flown_configuration();
        let home_m = Vector3::from(configuration.initial.position_m);
        let perception = Perception::new(&closed_loop, navigation(settings, home_m));
        let frame = LocalFrame::new(settings.origin);
        let home = Home { position_m: home_m, yaw_rad: settings.heading_rad, set_by_user: false };
        let site = Site {
            identity: settings.identity,
            frame,
            home_m,
            terrain: settings.surroundings.terrain.clone(),
        };
        let program = compile::mission(settings.plans.get(PlanKind::Mission).items(), &site);
        let machines = Machines::new(settings, &configuration, perception.truth(), program);
        let full_battery_v = full_voltage_v(&configuration.airframe, &machines.battery);
        let mut vehicle = Self {
            setup: Setup::new(settings, full_battery_v),
            closed_loop,
            perception,
            plans: KnownPlans::new(settings.plans.clone(), &site),
            decided: Decided::new(settings.mode_at_boot(), home),
            machines,
            tick: None,
            lasted_s: TICK_S,
        };
        vehicle.announce_plans();
        let most_m_s = vehicle.conduct().speeds.most_m_s;
        vehicle.use_speeds_or_say(vehicle.machines.speeds.within(most_m_s));
        vehicle
    }

    /// What the machines see of the vehicle now.
    fn situation(&self) -> Situation<'_> {
        let Self { setup, closed_loop, perception, plans, decided, machines, .. } = self;
        situation(setup, closed_loop, perception, plans, decided, machines)
    }

    /// What the machines see of the vehicle now, and the machines.
    fn situation_and_machines(&mut self) -> (Situation<'_>, &mut Machines) {
        let Self { setup, closed_loop, perception, plans, decided, machines, .. } = self;
        (situation(setup, closed_loop, perception, plans, decided, machines), machines)
    }

    /// Flies one tick on.
    ///
    /// # Errors
    /// [`FlightError`]: the flight cannot go on.
    pub fn tick(&mut self) -> Result<(), FlightError> {
        self.fly(1).map(drop)
    }

    /// Flies on, and returns by how many ticks: one, or up to `most` if the vehicle hovers and nothing happens to it. The flight is the
    /// same, however it is divided.
    ///
    /// # Errors
    /// [`FlightError`]: the flight cannot go on.
    pub fn fly(&mut self, most: u64) -> Result<u64, FlightError> {
        let now_us = self.time_us();
        let ended = self.tick.as_ref().filter(|tick| !self.goes_on(tick)).map(|tick| tick.begun_us);
        if let Some(begun_us) = ended {
            self.tick = None;
            self.end_tick(begun_us);
        }
        let goes_on = self.tick.is_some();
        if !goes_on {
            self.begin_tick();
        }
        let (begun_us, end_us) =
            self.tick.as_ref().map_or((now_us, now_us + TICK_US), |tick| (tick.begun_us, tick.end_us));
        let time_us = end_us.min(now_us.saturating_add(most.max(1).saturating_mul(TICK_US)));
        if goes_on {
            self.closed_loop.go_on(time_us)?;
        } else {
            self.advance(time_us - now_us)?;
        }
        self.perceive();
        if time_us == end_us {
            self.tick = None;
            self.end_tick(begun_us);
        }
        Ok((time_us - now_us) / TICK_US)
    }

    /// Decides how it is flown from now on.
    fn begin_tick(&mut self) {
        if self.machines.autostart.is_pending() {
            self.autostart();
        }
        if self.machines.injection.is_due(self.time_us()) {
            self.consult(|parts, situation, proposal| parts.injection.step(situation, proposal));
        }
        self.watch_pilot();
        self.lead();
        if self.machines.motor_tests.is_running() {
            self.consult(|parts, situation, proposal| parts.motor_tests.step(situation, proposal));
        }
        self.tick = self.long_tick();
    }

    /// Looks at where a tick has led to that began at a time, µs.
    fn end_tick(&mut self, begun_us: u64) {
        self.lasted_s = (self.time_us() - begun_us) as f64 / 1e6;
        self.discharge();
        self.look_back();
        self.step_equipment();
        self.step_parachute();
    }

    /// Flies the closed loop as the steering asks, µs.
    fn advance(&mut self, duration_us: u64) -> Result<(), FlightError> {
        self.end_pushes();
        let pushes = &self.setup.conduct().simulated.pushes;
        let airframe = &self.closed_loop.simulation().configuration().airframe;
        let (truth, time_us) = (self.perception.truth(), self.time_us());
        let (push_n, torque_n_m) = self.machines.pushes.load(pushes, airframe, truth, time_us);
        let load = (push_n + self.parachute_drag_n(), torque_n_m);
        let ground_z_m = self.setup.terrain().z_below_m(&truth.position_m);
        let conditions = Conditions {
            load,
            outputs: self.perception.outputs(),
            height_m: ground_z_m - truth.position_m.z,
            ground_z_m,
            armed: self.decided.is_armed(),
            rotor_faults: self.faults().rotors(),
            estimate: self.perception.estimate().map(|estimate| estimate.body),
        };
        let test = self.machines.motor_tests.steering(conditions.outputs, conditions.rotor_faults);
        match test {
            Some((mut steering, rotor_faults)) => {
                let conditions = Conditions { armed: true, rotor_faults, ..conditions };
                self.closed_loop.step(&mut steering, &conditions, duration_us)
            }
            None => self.closed_loop.step(self.decided.steering_to_fly(), &conditions, duration_us),
        }
    }

    /// The duration of a push that has ended is zero from then on, as ArduPilot's simulation shows it.
    fn end_pushes(&mut self) {
        let pushes = &self.setup.conduct().simulated.pushes;
        let ends = self.machines.pushes.ends(pushes, self.time_us());
        if ends == [false; 2] {
            return;
        }
        let mut conduct = *self.setup.conduct();
        let now = &mut conduct.simulated.pushes;
        for (push, ended) in [&mut now.shove, &mut now.twist].into_iter().zip(ends) {
            if ended {
                push.time_ms = 0;
            }
        }
        self.setup.set_conduct(conduct);
    }

    /// Perceives the motion after the tick.
    fn perceive(&mut self) {
        let (closed_loop, faults) = (&self.closed_loop, self.faults());
        let (stands, errors) = (self.stands(), &self.setup.conduct().simulated.errors);
        let aiding = || self.setup.aiding();
        self.perception.step(closed_loop, self.setup.world(), &faults, errors, aiding, stands);
        let slid_m = self.perception.slid_m();
        let slides = slid_m != Vector2::zeros() && self.mode().holds_a_felt_place();
        if slides && self.decided.steering_to_fly().slide(&slid_m) {
            self.closed_loop.slide(&slid_m);
        }
    }

    /// Draws the power of the tick from the battery.
    fn discharge(&mut self) {
        let airframe = &self.closed_loop.simulation().configuration().airframe;
        let capacity_ah = capacity_ah(airframe, self.setup.conduct().battery_capacity_ah);
        let outputs = self.perception.outputs();
        let pack = airframe.battery.sag.then_some(&outputs.battery);
        let Machines { battery, injection, .. } = &mut self.machines;
        battery.fail(injection.faults().battery(), capacity_ah);
        battery.step(airframe, &outputs.rotor_speed_rad_s, pack, capacity_ah, self.lasted_s);
    }

    /// Whether it stands on the ground, disarmed.
    fn stands(&self) -> bool {
        self.machines.landing.is_landed() && !self.decided.is_armed()
    }
}

/// The closed loop of a vehicle that stands at its start.
fn closed_loop(settings: &VehicleSettings) -> Result<ClosedLoop, ConfigurationError> {
    let configuration = settings.flown_configuration();
    let start_m = Vector3::from(configuration.initial.position_m);
    let ground_z_m = settings.surroundings.terrain.z_below_m(&start_m);
    ClosedLoop::new(&configuration, settings.wind, ground_z_m)
}

/// Instruments and estimator of a vehicle that flies by them, and is told that it stands at a place, NED, m.
fn navigation(settings: &VehicleSettings, start_m: Vector3<f64>) -> Option<Navigation> {
    (settings.sensors.model == SensorModel::Realistic).then(|| {
        let start = Estimate::unaligned(start_m, settings.heading_rad);
        Navigation::new(settings.sensors.seed, start)
    })
}

/// The situation that is shown to the machines of a vehicle.
fn situation<'a>(
    setup: &'a Setup,
    closed_loop: &'a ClosedLoop,
    perception: &'a Perception,
    plans: &'a KnownPlans,
    decided: &'a Decided,
    machines: &Machines,
) -> Situation<'a> {
    let (simulation, outputs) = (closed_loop.simulation(), perception.outputs());
    let (conduct, landing) = (setup.conduct(), &machines.landing);
    let navigation = perception.navigation();
    let capacity_ah = capacity_ah(&simulation.configuration().airframe, conduct.battery_capacity_ah);
    let flies_mission = decided.mode() == Mode::Mission && decided.is_armed() && landing.has_flown();
    Situation {
        time_us: outputs.time_us,
        unix_start_us: setup.unix_start_us(),
        identity: setup.identity(),
        conduct,
        configuration: simulation.configuration(),
        limits: closed_loop.limits(),
        frame: setup.frame(),
        terrain: setup.terrain(),
        zones: plans.zones(),
        rally_points: plans.rally_points(),
        outputs,
        truth: perception.truth(),
        validity: perception.validity(),
        health: perception.health(),
        estimates: navigation.is_some(),
        fix_velocity_down_m_s: navigation.and_then(Navigation::latest_fix).map(|fix| fix.velocity_m_s.z),
        rotor_command_rad_s: closed_loop.rotor_command_rad_s(),
        wind_m_s: closed_loop.wind_m_s(),
        battery_remaining: machines.battery.remaining(capacity_ah),
        battery_voltage_v: machines.battery.voltage_v(),
        battery_resting_v: machines.battery.resting_voltage_v(),
        battery_left_mah: 1e3 * capacity_ah * machines.battery.remaining(capacity_ah),
        armed: decided.is_armed(),
        mode: decided.mode(),
        steering: decided.steering(),
        home: decided.home(),
        region: decided.region(),
        landed: landing.is_landed(),
        comes_down: machines.comes_down(decided.mode()),
        landing_is_moved: machines.landing_pilot.has_moved(),
        lost_rotor: machines.rotors.lost_rotor(),
        landing_target_m: machines.precision.place_m(&conduct.precision),
        surface: machines.obstacles.surface(),
        breach: machines.fence.record().now,
        fence_is_ahead: machines.fence.record().is_ahead,
        fence_is_on: conduct.failsafe.fence_enabled || machines.fence.is_on_by_itself(),
        fence_parts_off: machines.fence.parts_off(),
        fence_floor_counts: machines.fence.floor_counts(),
        set_points_are_recent: machines.offboard.is_recent(outputs.time_us, conduct.set_point_timeout_s),
        set_point_turns: machines.offboard.turns(),
        pilot: machines.simple.seen(
            machines.receiver.pilot(),
            machines.pilot_watch.switch_position(),
            [conduct.radio.simple_slots, conduct.radio.super_simple_slots],
            outputs.attitude_rad.z,
        ),
        has_trail: machines.smart_return.has_trail(),
        mission_goes_on: flies_mission && machines.mission.is_started(),
        mission_may_take_off: !setup.identity().is_ardupilot()
            || machines.consent.is_given()
            || conduct.auto_takes_off_by_itself(),
    }
}
