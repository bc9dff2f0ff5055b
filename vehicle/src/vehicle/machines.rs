//! The machines that the vehicle consists of, each with a state of its own.

use quadrotor::{Configuration, Outputs};

use super::autostart::Autostart;
use super::battery::Battery;
use super::boot_fault::BootFault;
use super::button_watch::ButtonWatch;
use super::commanded_turn::CommandedTurn;
use super::crash_watch::CrashWatch;
use super::failsafe::Failsafe;
use super::fence_margin::FenceMargin;
use super::fence_watch::FenceWatch;
use super::flight_times::FlightTimes;
use super::flip::Flip;
use super::follow::Follow;
use super::ground_flight::GroundFlight;
use super::hold_watch::HoldWatch;
use super::injection::Injection;
use super::landed::LandedState;
use super::landing::Landing;
use super::landing_pilot::LandingPilot;
use super::mission::Mission;
use super::motor_test::MotorTests;
use super::obstacle_watch::ObstacleWatch;
use super::offboard::Offboard;
use super::orbit::Orbit;
use super::parachute_watch::ParachuteWatch;
use super::pilot_turn::PilotTurn;
use super::pilot_watch::PilotWatch;
use super::precision_landing::PrecisionLanding;
use super::pushes::PushClock;
use super::receiver::Receiver;
use super::remote_id::RemoteId;
use super::return_home::Return;
use super::rotor_watch::RotorWatch;
use super::safety_switch::SafetySwitch;
use super::settings::VehicleSettings;
use super::simple_flight::SimpleFlight;
use super::smart_return::SmartReturn;
use super::speeds::Speeds;
use super::stick_climb::StickClimb;
use super::stick_flight::StickFlight;
use super::takeoff::Takeoff;
use super::takeoff_check::TakeoffCheck;
use super::takeoff_consent::TakeoffConsent;
use super::terrain_watch::TerrainWatch;
use super::throw::Throw;
use super::traffic_watch::TrafficWatch;
use super::vibration_watch::VibrationWatch;
use super::weathervane::Weathervane;
use super::zigzag::ZigZag;
use crate::equipment::Equipment;
use crate::mode::Mode;
use crate::plan::Program;

/// All machines. None sees another one: each is shown a situation and asks in a proposal.
#[derive(Debug)]
pub struct Machines {
    /// The start of the mission without a pilot.
    pub autostart: Autostart,
    /// What only a reboot mends.
    pub boot_fault: BootFault,
    /// The safety switch.
    pub safety: SafetySwitch,
    /// What is broken.
    pub injection: Injection,
    /// The battery.
    pub battery: Battery,
    /// Breaches of the fence.
    pub fence: FenceWatch,
    /// Borders of the fence that are near.
    pub fence_margin: FenceMargin,
    /// Missions above a ground that is not known.
    pub terrain: TerrainWatch,
    /// Failsafes.
    pub failsafe: Failsafe,
    /// What is told of accelerometers that are not believed.
    pub vibration: VibrationWatch,
    /// The rotors, and the descent without one.
    pub rotors: RotorWatch,
    /// Whether the position can be held.
    pub hold: HoldWatch,
    /// Crashes.
    pub crash: CrashWatch,
    /// Touch-down and lift-off.
    pub landing: Landing,
    /// When it was armed, took off and landed.
    pub flight_times: FlightTimes,
    /// What the pilot does about a landing.
    pub landing_pilot: LandingPilot,
    /// Tests of single rotors.
    pub motor_tests: MotorTests,
    /// Takeoffs.
    pub takeoff: Takeoff,
    /// What changes the climb rate of the throttle.
    pub climb: StickClimb,
    /// What the rotors have against one.
    pub takeoff_check: TakeoffCheck,
    /// Whether a mission may take off.
    pub consent: TakeoffConsent,
    /// Throws.
    pub throw: Throw,
    /// Flips.
    pub flip: Flip,
    /// The zigzag mode.
    pub zigzag: ZigZag,
    /// The turn into the wind.
    pub weathervane: Weathervane,
    /// The turn by hand.
    pub pilot_turn: PilotTurn,
    /// Pushes that a user gives the vehicle.
    pub pushes: PushClock,
    /// The turn that a command asks for.
    pub turn: CommandedTurn,
    /// What is received of the pilot.
    pub receiver: Receiver,
    /// What the pilot asks for by switches and gestures.
    pub pilot_watch: PilotWatch,
    /// Buttons on the vehicle.
    pub buttons: ButtonWatch,
    /// What the pilot's sticks refer to.
    pub simple: SimpleFlight,
    /// Modes that lean as the sticks say.
    pub stick_flight: StickFlight,
    /// Set-points.
    pub offboard: Offboard,
    /// The flight along the ground to a place that is asked for.
    pub ground_flight: GroundFlight,
    /// The way home.
    pub return_home: Return,
    /// The trail, and the way back on it.
    pub smart_return: SmartReturn,
    /// The target of a landing.
    pub precision: PrecisionLanding,
    /// Orbits.
    pub orbit: Orbit,
    /// The target that is followed.
    pub follow: Follow,
    /// The mission.
    pub mission: Mission,
    /// What stands around.
    pub obstacles: ObstacleWatch,
    /// What flies around.
    pub traffic: TrafficWatch,
    /// What it tells of itself.
    pub remote_id: RemoteId,
    /// Speeds that hold instead of the parameters'.
    pub speeds: Speeds,
    /// Whether its parachute is needed.
    pub parachute: ParachuteWatch,
    /// What it carries.
    pub equipment: Equipment,
}

impl Machines {
    /// Whether what flies in a mode comes down to the ground to land.
    pub fn comes_down(&self, mode: Mode) -> bool {
        match mode {
            Mode::Land => true,
            Mode::Mission | Mode::MissionLanding => {
                self.mission.is_vertical().1 || self.mission.returns() && self.return_home.descends()
            }
            Mode::Return => self.return_home.descends(),
            Mode::SmartReturn => self.smart_return.descends(),
            _ => false,
        }
    }

    /// Whether what flies in a mode, armed or not, stands, climbs from the ground, flies or descends to the ground.
    pub fn landed_state(&self, mode: Mode, armed: bool) -> LandedState {
        match mode {
            _ if self.landing.is_landed() => LandedState::OnGround,
            // Its mode may stay that of a landing that has ended.
            _ if !armed => LandedState::InAir,
            Mode::Mission if self.mission.is_vertical().0 => LandedState::TakingOff,
            Mode::Takeoff => LandedState::TakingOff,
            mode if self.comes_down(mode) => LandedState::Landing,
            _ => LandedState::InAir,
        }
    }

    /// Those of a vehicle that is `truth` at first, and whose mission is `program`.
    pub fn new(
        settings: &VehicleSettings,
        configuration: &Configuration,
        truth: &Outputs,
        program: Program,
    ) -> Self {
        Self {
            autostart: Autostart::new(settings.autostart && program.is_flown()),
            boot_fault: settings.boot_fault(),
            safety: SafetySwitch::new(settings.conduct.arming.is_safe_at_the_start),
            injection: Injection::new(settings.faults.clone()),
            battery: Battery::new(settings.battery),
            fence: FenceWatch::default(),
            fence_margin: FenceMargin::default(),
            terrain: TerrainWatch::default(),
            failsafe: Failsafe::default(),
            rotors: RotorWatch::new(truth.rotor_speed_rad_s),
            vibration: VibrationWatch::default(),
            hold: HoldWatch::default(),
            crash: CrashWatch::default(),
            landing: Landing::new(
                settings.surroundings.terrain.z_below_m(&truth.position_m) - truth.position_m.z,
            ),
            flight_times: FlightTimes::default(),
            landing_pilot: LandingPilot::default(),
            motor_tests: MotorTests::default(),
            takeoff: Takeoff::default(),
            climb: StickClimb::default(),
            takeoff_check: TakeoffCheck::default(),
            consent: TakeoffConsent::default(),
            throw: Throw::default(),
            flip: Flip::default(),
            zigzag: ZigZag::default(),
            weathervane: Weathervane::default(),
            pilot_turn: PilotTurn::default(),
            pushes: PushClock::default(),
            turn: CommandedTurn::default(),
            receiver: Receiver::default(),
            pilot_watch: PilotWatch::default(),
            buttons: ButtonWatch::default(),
            simple: SimpleFlight::default(),
            stick_flight: StickFlight::default(),
            offboard: Offboard::default(),
            ground_flight: GroundFlight::default(),
            return_home: Return::default(),
            smart_return: SmartReturn::default(),
            precision: PrecisionLanding::default(),
            orbit: Orbit::default(),
            follow: Follow::default(),
            mission: Mission::new(program),
            obstacles: ObstacleWatch::new(settings.surroundings.obstacles.clone()),
            traffic: TrafficWatch::new(settings.surroundings.aircraft.clone()),
            remote_id: RemoteId::default(),
            speeds: Speeds::new(&configuration.limits),
            parachute: ParachuteWatch::default(),
            equipment: Equipment::new(&settings.conduct.equipment.mount),
        }
    }
}
