//! What the pilot's radio does to the vehicle.

use super::super::notice::{Refusal, Severity};
use super::super::pilot_watch::Wish;
use super::super::receiver::{Pilot, Pulses};
use super::super::simple_flight::StickReference;
use super::super::sticks::Sticks;
use super::super::surface_tracking::Tracking;
use super::super::tick::TICK_S;
use super::super::zigzag::End;
use super::Vehicle;
use crate::equipment::{GimbalMode, Operation, ParachuteOrder, Switch};
use crate::fence::FenceSwitch;
use crate::mode::{Leader, Mode};
use crate::plan::{MissionItem, PlanKind, frame};
use crate::radio::{CHANNELS, Function, Position, RadioLossAction, function};

/// Numbers of commands that a switch can add to a mission.
const NAV_WAYPOINT: u16 = 16;
const NAV_LAND: u16 = 21;
const NAV_TAKEOFF: u16 = 22;

impl Vehicle {
    /// The pilot as the vehicle sees him.
    pub fn pilot(&self) -> &Pilot {
        self.machines.receiver.pilot()
    }

    /// The radio sends these pulses from now on, µs; 0 where there is no channel.
    pub fn receive_radio(&mut self, pulses: Pulses) {
        self.machines.receiver.receive(pulses);
    }

    /// Begins or ends a calibration of the radio: until its end sticks and switches mean nothing. Returns whether one was under way.
    pub fn calibrate_radio(&mut self, begins: bool) -> bool {
        self.machines.receiver.calibrate(begins)
    }

    /// What the pilot's radio sends, if there is one.
    pub fn radio(&self) -> Option<Pulses> {
        self.machines.receiver.radio()
    }

    /// Overrides channels of the radio: `None` leaves one as it is, 0 gives it back.
    pub fn override_channels(&mut self, pulses: &[Option<u16>; CHANNELS]) {
        let time_us = self.time_us();
        self.machines.receiver.take_overrides(pulses, time_us);
    }

    /// Takes the pilot's sticks.
    pub fn move_sticks(&mut self, sticks: Sticks) {
        let (identity, time_us) = (self.identity(), self.time_us());
        let settings = self.setup.conduct().radio;
        self.machines.receiver.take_sticks(sticks, identity, &settings, time_us);
    }

    /// Looks at the pilot, and does what he asks for.
    pub(super) fn watch_pilot(&mut self) {
        let (identity, time_us) = (self.identity(), self.time_us());
        let conduct = self.setup.conduct();
        let watched = conduct.failsafe.pilot_lost != RadioLossAction::None;
        let how = (conduct.stick_timeout_s, watched);
        self.machines.receiver.look(identity, &conduct.radio, how, time_us);
        self.watch_buttons();
        let pilot = self.pilot();
        if pilot.lost || pilot.sticks.is_none() {
            self.machines.pilot_watch.rest();
            return;
        }
        let (situation, parts) = self.situation_and_machines();
        for wish in parts.pilot_watch.look(&situation, TICK_S) {
            if let Err(refusal) = self.grant(wish) {
                self.decided.say(Severity::Warning, refusal.to_string());
            }
        }
    }

    /// Does what buttons ask for that have been pressed or released.
    fn watch_buttons(&mut self) {
        let time_us = self.time_us();
        let settings = &self.setup.conduct().radio.buttons;
        for (number, position) in self.machines.buttons.look(settings, time_us) {
            if let Err(refusal) = self.move_switch(number, position) {
                self.decided.say(Severity::Warning, refusal.to_string());
            }
        }
    }

    /// The buttons that are pressed, as bits, and when that has changed last, µs; `None`: never.
    pub fn buttons(&self) -> (u8, Option<u64>) {
        self.machines.buttons.state()
    }

    fn grant(&mut self, wish: Wish) -> Result<(), Refusal> {
        match wish {
            Wish::Mode(custom) => self.set_custom_mode(custom),
            Wish::Function(function, position) => self.do_function(function, position),
            Wish::Unknown(number) => {
                Err(Refusal::Unsupported(format!("RC switch function {number} is not available")))
            }
            Wish::Arm => self.arm(false),
            // ArduPilot lets the pilot stop the rotors in the air where the throttle is the thrust.
            Wish::Disarm if self.identity().is_ardupilot() && self.mode().is_flown_by_thrust() => {
                self.disarm_by("Disarmed by rudder")
            }
            Wish::Disarm => self.disarm(false),
            Wish::TakeOver(mode) => {
                self.decided.say(Severity::Info, "Pilot took over using sticks");
                self.set_mode(mode)
            }
        }
    }

    fn disarm_by(&mut self, why: &str) -> Result<(), Refusal> {
        if self.is_armed() {
            self.stop_rotors(why);
        }
        Ok(())
    }

    /// Changes to a mode by its custom mode.
    ///
    /// # Errors
    /// [`Refusal`] of a mode that there is not, or that cannot be flown now.
    pub fn set_custom_mode(&mut self, custom_mode: u32) -> Result<(), Refusal> {
        let identity = self.identity();
        if let Some(absent) = identity.absent_mode(custom_mode) {
            let reason = format!("{} mode is not available: {}", absent.name, absent.instead);
            return Err(Refusal::Unsupported(reason));
        }
        let Some(mode) = identity.mode(custom_mode) else {
            let names: Vec<_> = identity.selectable_modes().map(|known| identity.mode_name(known)).collect();
            // PX4's main and sub-modes are bytes of the number.
            let number =
                if identity.is_ardupilot() { custom_mode.to_string() } else { format!("{custom_mode:#x}") };
            let there_are = names.join(", ");
            return Err(Refusal::Unsupported(format!(
                "Mode {number} is not available; available: {there_are}"
            )));
        };
        self.set_mode(mode)
    }

    /// Does what a switch does, by ArduPilot's number, that has come to a position.
    ///
    /// # Errors
    /// [`Refusal`] of a function that there is not, and of what cannot be done now.
    pub fn move_switch(&mut self, number: u32, position: Position) -> Result<(), Refusal> {
        let unknown = || Refusal::Unsupported(format!("RC switch function {number} is not available"));
        self.do_function(function(number).ok_or_else(unknown)?, position)
    }

    /// Does what a switch does that has come to a position.
    ///
    /// # Errors
    /// [`Refusal`] of what cannot be done now.
    pub fn do_function(&mut self, function: Function, position: Position) -> Result<(), Refusal> {
        match (function, position) {
            (Function::Mode(number), Position::High) => self.set_custom_mode(number),
            (Function::Mode(number), _) => self.leave_mode(number),
            (Function::ZigZagEnd, position) => {
                self.choose_end(position);
                Ok(())
            }
            (Function::SaveWaypoint, Position::High) => self.save_waypoint(),
            (Function::Fence, position) => {
                self.switch_fence(FenceSwitch::on(position == Position::High));
                Ok(())
            }
            (Function::ResetMission, Position::High) => self.set_mission_item(0, true),
            (Function::ClearMission, Position::High) => self.clear_mission(),
            (Function::SaveWaypoint | Function::ResetMission | Function::ClearMission, _) => Ok(()),
            (Function::EmergencyStop, Position::High) | (Function::ArmingOrStop, Position::Low) => {
                self.disarm_by("Emergency stop: rotors stopped")
            }
            (Function::Arming | Function::ArmingOrStop, Position::High) => self.arm(false),
            (Function::Arming | Function::ArmingOrStop | Function::Overrides, Position::Middle) => Ok(()),
            (Function::Arming, Position::Low) | (Function::Disarming, Position::High) => {
                self.disarm_by("Disarmed by switch")
            }
            (Function::EmergencyStop | Function::Disarming, _) => Ok(()),
            (Function::Simple | Function::SuperSimple, position) => {
                let reference = StickReference::of(position, function == Function::SuperSimple);
                self.machines.simple.choose(reference);
                Ok(())
            }
            (
                Function::Rangefinder | Function::Proximity | Function::Traffic | Function::Overrides,
                position,
            ) => {
                self.switch_instrument(function, position == Position::High);
                Ok(())
            }
            (
                Function::Image
                | Function::Video
                | Function::Gripper
                | Function::Relay(_)
                | Function::RetractGimbal
                | Function::LockGimbal
                | Function::LandingGear
                | Function::ParachuteEnable
                | Function::ParachuteRelease,
                position,
            ) => operation(function, position).map_or(Ok(()), |operation| self.operate(&operation)),
            (Function::SurfaceTracking, position) => self.choose_surface(position),
            (Function::PrecisionLoiter, position) => {
                self.machines.precision.let_loiter(position == Position::High);
                Ok(())
            }
            (Function::SourceSet, position) => {
                self.use_source_set(match position {
                    Position::Low => 0,
                    Position::Middle => 1,
                    Position::High => 2,
                });
                Ok(())
            }
            (Function::Parachute, position) => {
                self.switch_parachute(position);
                Ok(())
            }
        }
    }

    /// Low is the ground, the middle nothing, and high what is above, which nothing sees.
    fn choose_surface(&mut self, position: Position) -> Result<(), Refusal> {
        let tracking = match position {
            Position::Low if self.has_rangefinder() => Tracking::Ground,
            Position::Middle => Tracking::Off,
            Position::Low => {
                return Err(Refusal::Failed("SurfaceTracking: no downward rangefinder".to_owned()));
            }
            Position::High => {
                return Err(Refusal::Failed("SurfaceTracking: no upward rangefinder".to_owned()));
            }
        };
        let mut conduct = *self.conduct();
        conduct.surroundings.surface.tracking = tracking;
        self.setup.set_conduct(conduct);
        Ok(())
    }

    /// Low disables the parachute, the middle enables it, and high releases it, too.
    fn switch_parachute(&mut self, position: Position) {
        let enabled = position != Position::Low;
        self.order_parachute(if enabled { ParachuteOrder::Enable } else { ParachuteOrder::Disable });
        if position == Position::High {
            self.order_parachute(ParachuteOrder::Release);
        }
    }

    /// Low is A and high B of the zigzag mode, the middle is the pilot's.
    fn choose_end(&mut self, position: Position) {
        if self.mode() != Mode::ZigZag {
            return;
        }
        self.consult(|parts, situation, proposal| match position {
            Position::Low => parts.zigzag.choose(End::A, situation, proposal),
            Position::Middle => parts.zigzag.stop(situation, proposal),
            Position::High => parts.zigzag.choose(End::B, situation, proposal),
        });
    }

    fn clear_mission(&mut self) -> Result<(), Refusal> {
        if self.mode() == Mode::Mission && self.is_armed() {
            return Err(Refusal::later("Mission not cleared: leave Auto or disarm first"));
        }
        self.set_plan(PlanKind::Mission, Vec::new()).map_err(|fault| {
            Refusal::Failed(format!("Mission not cleared: {}", fault.located(self.identity())))
        })?;
        self.decided.say(Severity::Info, "Mission cleared");
        Ok(())
    }

    /// Switches what measures around, or what is done about it.
    fn switch_instrument(&mut self, function: Function, on: bool) {
        match function {
            Function::Rangefinder => self.machines.obstacles.switch_rangefinder(on),
            Function::Proximity => self.machines.obstacles.switch_proximity(on),
            Function::Overrides => self.machines.receiver.switch_overrides(on),
            _ => {
                let mut conduct = *self.conduct();
                conduct.surroundings.traffic.enabled = on;
                self.setup.set_conduct(conduct);
            }
        }
    }

    /// Back to the mode of the mode switch, if it is in the one that a switch has entered.
    fn leave_mode(&mut self, number: u32) -> Result<(), Refusal> {
        let identity = self.identity();
        if identity.custom_mode(self.mode()) != number {
            return Ok(());
        }
        let (situation, parts) = self.situation_and_machines();
        match parts.pilot_watch.switched_mode(&situation) {
            Some(custom) => self.set_custom_mode(custom),
            None => self.set_mode(identity.first_mode()),
        }
    }

    /// Adds the present place to the mission: a waypoint, or with a low throttle a landing; a first one takes off.
    fn save_waypoint(&mut self) -> Result<(), Refusal> {
        let low = self.pilot().sticks.is_some_and(|sticks| sticks.throttle() <= 0.0);
        let mut items = self.plans().get(PlanKind::Mission).items().to_vec();
        let first = items.len() <= usize::from(self.identity().is_ardupilot());
        if self.mode() == Mode::Mission || !self.is_armed() || first && low {
            return Err(Refusal::later("Waypoint not saved: fly there in another mode first"));
        }
        let place = self.frame().to_geodetic(&self.outputs().position_m);
        let height_m = self.home().position_m.z - self.outputs().position_m.z;
        let item = |command: u16| MissionItem {
            frame: frame::GLOBAL_RELATIVE,
            command,
            parameters: [0.0; 4],
            position: [place.latitude_deg, place.longitude_deg, height_m],
            autocontinue: true,
        };
        if first {
            if self.identity().is_ardupilot() && items.is_empty() {
                items.push(self.home_item());
            }
            let takeoff = item(NAV_TAKEOFF);
            items.push(MissionItem { position: [0.0, 0.0, height_m.max(1.0)], ..takeoff });
        }
        items.push(item(if low { NAV_LAND } else { NAV_WAYPOINT }));
        let number = items.len() - 1;
        self.amend_plan(PlanKind::Mission, items).map_err(|fault| {
            Refusal::Failed(format!("Waypoint not saved: {}", fault.located(self.identity())))
        })?;
        self.decided.say(Severity::Info, format!("Waypoint {number} saved"));
        Ok(())
    }

    /// What the pilot's throttle has against arming.
    pub(super) fn throttle_obstacle(&self) -> Option<String> {
        let (situation, conduct) = (self.situation(), self.conduct());
        let sticks = situation.pilot.sticks.filter(|_| situation.mode.leader() == Leader::Sticks)?;
        let by_thrust = situation.mode.is_flown_by_thrust();
        let high = if by_thrust { sticks.throttle() > 0.05 } else { sticks.climb_m_s(conduct) > 0.0 };
        let ardupilot = situation.identity.is_ardupilot();
        (high && !situation.pilot.lost && (by_thrust || ardupilot)).then(|| "throttle too high".to_owned())
    }
}

/// What a switch asks of the equipment in a position.
fn operation(function: Function, position: Position) -> Option<Operation> {
    let on = position == Position::High;
    match (function, position) {
        (Function::Image, Position::High) => Some(Operation::Shoot),
        (Function::Video, Position::High | Position::Low) => Some(Operation::Record(on)),
        (Function::LandingGear, Position::High | Position::Low) => {
            Some(Operation::MoveLandingGear { down: !on })
        }
        (Function::RetractGimbal, Position::High) => Some(Operation::RetractGimbal),
        (Function::RetractGimbal, Position::Low) => Some(Operation::SetGimbalMode(GimbalMode::Radio)),
        (Function::LockGimbal, Position::High) => Some(Operation::LockGimbal),
        (Function::LockGimbal, position) => {
            Some(Operation::UnlockGimbal { forget: position == Position::Low })
        }
        (Function::ParachuteEnable, position) => {
            Some(Operation::Parachute(if on { ParachuteOrder::Enable } else { ParachuteOrder::Disable }))
                .filter(|_| position != Position::Middle)
        }
        (Function::ParachuteRelease, Position::High) => Some(Operation::Parachute(ParachuteOrder::Release)),
        (Function::Gripper, Position::High | Position::Low) => Some(Operation::Grip { grabs: on }),
        (Function::Relay(relay), Position::High | Position::Low) => {
            Some(Operation::SetRelay { relay, to: if on { Switch::On } else { Switch::Off } })
        }
        _ => None,
    }
}
