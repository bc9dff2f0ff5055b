//! What may be asked of the vehicle.

use nalgebra::Vector3;
use quadrotor::Configuration;

use super::super::change_error::ChangeError;
use super::super::conduct::Conduct;
use super::super::failsafe::Cause;
use super::super::fence_watch::{check_goal, check_set_point};
use super::super::flip::Flip;
use super::super::follow::Follow;
use super::super::guided_heading::Lead;
use super::super::motor_test::MotorTest;
use super::super::notice::{Notice, Refusal, Severity};
use super::super::orbit_request::OrbitRequest;
use super::super::proposal::check_distance;
use super::super::region::RegionOfInterest;
use super::super::reposition::Reposition;
use super::super::set_point::{AxisTarget, PositionSetPoint, SetPoint, YawTarget};
use super::super::situation::Situation;
use super::super::steering::SteeringKind;
use super::super::target::TargetReport;
use super::Vehicle;
use crate::fault::Fault;
use crate::fence::FenceSwitch;
use crate::foreign::ForeignRole;
use crate::mode::{Leader, Mode};
use crate::plan::step::Turn;
use crate::plan::{ChangeSpeed, Look};
use crate::world::wind_drag;

impl Vehicle {
    /// Notices since the last call.
    pub fn take_notices(&mut self) -> Vec<Notice> {
        self.decided.take_notices()
    }

    /// Tells what time it was at the start, µs since 1970.
    pub fn set_unix_start_us(&mut self, unix_start_us: u64) {
        self.setup.set_unix_start_us(unix_start_us);
    }

    /// Takes changed parameters over: those of the closed loop, as [`kept_configuration`](Self::kept_configuration) has them,
    /// and its own. All of them change in flight, too: the closed loop designs its controllers beside the running ones, and
    /// hands over to them at its next sample.
    ///
    /// # Errors
    /// [`ChangeError`]; nothing has changed then.
    pub fn adopt(&mut self, kept: &Configuration, conduct: &Conduct) -> Result<(), ChangeError> {
        let before = self.conduct().simulated;
        if conduct.simulated.errors.need_readings() && self.navigation().is_none() {
            return Err(ChangeError::IdealSensors);
        }
        if conduct.simulated.errors.switches.gps_comes_by_message() && self.navigation().is_none() {
            return Err(ChangeError::IdealReceiver);
        }
        let charge_v = conduct.simulated.battery_v.filter(|volts| before.battery_v != Some(*volts));
        if charge_v.is_some() && kept.airframe.battery.sag {
            return Err(ChangeError::BatteryOfPlant);
        }
        let mut kept = *kept;
        let drag_n_s_m = if conduct.simulated.wind_m_s.unwrap_or(0.0) > before.wind_m_s.unwrap_or(0.0) {
            wind_drag::provide(&mut kept)
        } else {
            None
        };
        if kept != self.kept_configuration() {
            self.reconfigure(&kept)?;
        }
        if conduct.speeds.most_m_s != self.conduct().speeds.most_m_s {
            self.use_speeds(self.machines.speeds.within(conduct.speeds.most_m_s))?;
        }
        self.setup.set_conduct(*conduct);
        let time_us = self.time_us();
        self.machines.pushes.change(&before.pushes, &conduct.simulated.pushes, time_us);
        if let Some(drag) = drag_n_s_m {
            self.decided.say(Severity::Info, wind_drag::provided(&wind_drag::NAMES, drag));
        }
        if let Some(volts) = charge_v {
            let capacity_ah = self.battery_capacity_ah();
            self.machines.battery.charge_to(volts, capacity_ah);
        }
        if conduct.simulated != before {
            self.closed_loop.change_wind(self.setup.wind(), self.conduct().simulated.wind_shape);
        }
        Ok(())
    }

    /// Tells whether a ground station is heard.
    pub fn hear_ground_station(&mut self, heard: bool) {
        self.machines.failsafe.hear_ground_station(heard);
    }

    /// Charges the battery, or discharges it, to a share of its capacity.
    ///
    /// # Errors
    /// [`Refusal::Denied`] while the rotors follow the voltage of a battery of their own.
    pub fn refill_battery(&mut self, share: f64) -> Result<(), Refusal> {
        if self.kept_configuration().airframe.battery.sag {
            return Err(Refusal::denied("Battery reset denied: the rotors drain a battery of their own"));
        }
        let capacity_ah = self.battery_capacity_ah();
        self.machines.battery.refill(share, capacity_ah);
        Ok(())
    }

    /// Switches the fence.
    pub fn switch_fence(&mut self, switch: FenceSwitch) {
        let parts = self.conduct().failsafe.fence_parts;
        let is_on = self.situation().fence_is_on;
        let enabled = self.machines.fence.switch(switch, is_on, parts);
        match switch {
            FenceSwitch::FloorOff => {
                self.decided.say(Severity::Info, "Fence floor disabled");
                return;
            }
            // The rest stays on, by hand or by itself.
            FenceSwitch::PartsOff(_) | FenceSwitch::PartsOn(_) if enabled && is_on => return,
            _ => {}
        }
        let mut conduct = *self.conduct();
        if conduct.failsafe.fence_enabled != enabled {
            conduct.failsafe.fence_enabled = enabled;
            self.setup.set_conduct(conduct);
            self.decided.say(Severity::Info, if enabled { "Fence enabled" } else { "Fence disabled" });
        }
    }

    /// Breaks a unit, or mends it, as a client asks.
    ///
    /// # Errors
    /// [`Refusal::Denied`] while the parameter SYS_FAILURE_EN forbids it, [`Refusal::Unsupported`] when it would change nothing.
    pub fn inject(&mut self, fault: &Fault) -> Result<(), Refusal> {
        if !self.conduct().failure_injection {
            return Err(Refusal::denied("Failure injection rejected: set SYS_FAILURE_EN to 1"));
        }
        if self.navigation().is_none() && fault.needs_readings() {
            let reason =
                "ideal sensors can only be off, stuck or intermittent; start with --sensors realistic";
            return Err(Refusal::Unsupported(format!("Failure injection: {fault}: {reason}")));
        }
        if let Some(model) =
            self.foreign().filter(|model| fault.is_of_rotors() && model.role == ForeignRole::ClosedLoop)
        {
            let reason = format!(
                "{} flies as the closed loop, and its rotors take no faults; only a plant's do",
                model.name
            );
            return Err(Refusal::Unsupported(format!("Failure injection: {fault}: {reason}")));
        }
        self.consult(|parts, _, proposal| parts.injection.inject(fault, proposal));
        Ok(())
    }

    /// Turns rotors on the ground, one after the other.
    ///
    /// # Errors
    /// [`Refusal`] in the air, while armed, for a rotor that there is not, and while what flies is from elsewhere.
    pub fn test_motors(&mut self, test: &MotorTest) -> Result<(), Refusal> {
        if let Some(model) = self.foreign() {
            return Err(Refusal::Unsupported(format!("Motor Test: the rotors are those of {}", model.name)));
        }
        if self.is_safe() {
            return Err(Refusal::Failed("Motor Test: safety switch is on; switch it off first".to_owned()));
        }
        self.consult(|parts, situation, proposal| parts.motor_tests.begin(situation, proposal, test))
    }

    /// Whether the safety switch keeps everything still.
    pub fn is_safe(&self) -> bool {
        self.machines.safety.is_on()
    }

    /// Switches the safety switch.
    ///
    /// # Errors
    /// [`Refusal::Failed`] on while armed.
    pub fn switch_safety(&mut self, on: bool) -> Result<(), Refusal> {
        let armed = self.is_armed();
        self.machines.safety.switch(on, armed)?;
        if on {
            self.end_motor_test();
        }
        Ok(())
    }

    /// Ends a test of rotors.
    pub fn end_motor_test(&mut self) {
        self.consult(|parts, _, proposal| parts.motor_tests.end(proposal));
    }

    /// Whether a user may choose a mode now.
    ///
    /// # Errors
    /// [`Refusal::TemporarilyRejected`] while the place is not known.
    pub(super) fn may_enter(&self, mode: Mode) -> Result<(), Refusal> {
        self.machines.failsafe.may_enter(&self.situation(), mode)
    }

    /// Changes the mode.
    ///
    /// # Errors
    /// [`Refusal`] when the mode cannot be flown now.
    pub fn set_mode(&mut self, mode: Mode) -> Result<(), Refusal> {
        self.may_enter(mode)?;
        let situation = self.situation();
        let identity = situation.identity;
        let flying = situation.steering.kind() != SteeringKind::Idle;
        if mode != Mode::Land {
            situation.refuse_without_rotor()?;
        }
        // What only the lost pilot could fly would fall.
        if identity.is_ardupilot() && situation.armed && situation.pilot.lost && mode.is_flown_by_thrust() {
            let name = identity.mode_name(mode);
            return Err(Refusal::Failed(format!("{name} mode rejected: in RC failsafe")));
        }
        if mode.leader() == Leader::Sticks && !matches!(mode, Mode::Position | Mode::ZigZag) {
            self.refuse_leaning(mode)?;
        }
        match mode {
            Mode::Takeoff => return self.take_off(None),
            Mode::Mission => return self.enter_mission(None),
            Mode::MissionLanding if !situation.flies() => {
                return Err(Refusal::Failed("Auto RTL mode rejected: not flying".to_owned()));
            }
            Mode::MissionLanding => return self.return_by_mission(),
            Mode::Offboard if !identity.is_ardupilot() && !situation.set_points_are_recent => {
                return Err(Refusal::later("Offboard mode rejected: no recent set-point"));
            }
            Mode::Follow => Follow::may_begin(&situation)?,
            Mode::Flip => Flip::may_begin(&situation)?,
            Mode::Throw if situation.armed => {
                return Err(Refusal::Failed("Throw mode rejected: disarm first".to_owned()));
            }
            Mode::SmartReturn => self.machines.smart_return.may_begin()?,
            Mode::Land | Mode::Return if situation.armed && !flying => {
                return Err(Refusal::later(format!(
                    "{} mode rejected: on the ground",
                    identity.mode_name(mode)
                )));
            }
            _ => {}
        }
        if self.returns_from_fence(&situation) {
            return Err(Refusal::Failed(format!(
                "{} mode rejected: returning from a fence breach; FENCE_OPTIONS allows it",
                identity.mode_name(mode)
            )));
        }
        // Asked again it goes on as it does.
        self.machines.failsafe.release();
        if mode != self.mode() {
            self.enter(mode);
        } else if mode == Mode::Hold {
            self.consult(|_, situation, proposal| proposal.hold(situation));
        }
        Ok(())
    }

    /// Whether the fence's failsafe flies back from a breach, and nobody is to stop that.
    fn returns_from_fence(&self, situation: &Situation) -> bool {
        let acts = self.machines.failsafe.engaged().is_some_and(|(cause, _)| cause == Cause::Fence);
        let crossed = situation.breach.is_some() && !situation.fence_is_ahead;
        let keeps = situation.conduct.failsafe.fence_options.keeps_mode && situation.fence_is_on;
        keeps && acts && crossed && situation.armed && !situation.landed
    }

    /// Refuses a mode in which sticks lean the vehicle, if something else flies it or it would leap off the ground.
    fn refuse_leaning(&self, mode: Mode) -> Result<(), Refusal> {
        let situation = self.situation();
        let name = situation.identity.mode_name(mode);
        let follows = self.foreign().filter(|model| model.role == ForeignRole::ClosedLoop);
        if let Some(model) = follows {
            let reason = format!("{} follows positions, not attitudes or thrust", model.name);
            return Err(Refusal::denied(format!("{name} mode denied: {reason}")));
        }
        let by_thrust = mode.is_flown_by_thrust() && !situation.mode.is_flown_by_thrust();
        let hover = situation.configuration.airframe.hover_thrust_share();
        let leaps = situation.pilot.sticks.is_some_and(|sticks| {
            sticks.thrust(situation.conduct, hover, situation.identity.is_ardupilot()) > hover / 2.0
        });
        if situation.armed && situation.landed && by_thrust && leaps {
            return Err(Refusal::later(format!("{name} mode rejected: throttle too high")));
        }
        Ok(())
    }

    /// Goes somewhere and holds there. In ArduPilot's identity this is its guided mode.
    ///
    /// # Errors
    /// [`Refusal`] on the ground, or too far away.
    pub fn reposition(&mut self, goal: &Reposition) -> Result<(), Refusal> {
        let situation = self.situation();
        situation.refuse_without_rotor()?;
        if situation.steering.kind() == SteeringKind::Idle && !situation.may_be_led() {
            return Err(Refusal::later("Reposition rejected: not flying"));
        }
        let mode = situation.holding_mode();
        self.may_enter(mode)?;
        if *goal == Reposition::default() {
            self.machines.failsafe.release();
            self.enter(mode);
            self.consult(|_, situation, proposal| proposal.follow(situation, &PositionSetPoint::HOLD));
            return Ok(());
        }
        // An axis that is not named stays where its reference is.
        let now = self.asked_place_m();
        let [x, y] = goal.horizontal_m.unwrap_or([now.x, now.y]);
        let target = Vector3::new(x, y, goal.down_m.unwrap_or(now.z));
        check_distance(&target)?;
        check_goal(&situation, "Reposition", &target).map_err(|refusal| match refusal {
            // ArduPilot's answer.
            Refusal::Denied(reason) if situation.identity.is_ardupilot() => Refusal::Failed(reason),
            refusal => refusal,
        })?;
        self.machines.failsafe.release();
        let offboard = &self.machines.offboard;
        let looks = mode == self.mode() && offboard.lead() == Some(Lead::Command) && offboard.looks();
        let before = (*self.decided.steering(), self.machines.ground_flight);
        self.enter(mode);
        let yaw = goal.yaw_rad.map_or(YawTarget::Hold, YawTarget::Angle);
        let axes = target.data.0[0].map(AxisTarget::Position);
        self.consult(|parts, situation, proposal| {
            // A heading that is asked for goes before what was looked at.
            if goal.yaw_rad.is_some() {
                proposal.look_at(None);
            }
            let set_point = PositionSetPoint { axes, yaw };
            if goal.is_above_ground {
                parts.ground_flight.go_on(before, &set_point, situation, proposal);
            } else {
                proposal.follow(situation, &set_point);
            }
            parts.offboard.forget();
            parts.offboard.lead_by(Lead::Command);
            parts.offboard.look(looks);
        });
        Ok(())
    }

    /// Flies around a centre.
    ///
    /// # Errors
    /// [`Refusal`] on the ground, and for a circle that the fence forbids.
    pub fn orbit(&mut self, request: &OrbitRequest) -> Result<(), Refusal> {
        let situation = self.situation();
        situation.refuse_without_rotor()?;
        if situation.steering.kind() == SteeringKind::Idle {
            return Err(Refusal::later("Orbit rejected: not flying"));
        }
        self.may_enter(Mode::Orbit)?;
        if let (Some([x, y]), z) = (request.centre_m, request.down_m.unwrap_or_default()) {
            check_distance(&Vector3::new(x, y, z))?;
        }
        self.machines.orbit.check(&situation, request)?;
        self.machines.failsafe.release();
        if self.mode() != Mode::Orbit {
            self.enter(Mode::Orbit);
        }
        self.consult(|parts, situation, proposal| parts.orbit.ask(request, situation, proposal));
        Ok(())
    }

    /// Hears from the target of the follow mode.
    pub fn hear_target(&mut self, report: &TargetReport) {
        self.consult(|parts, situation, _| parts.follow.hear(report, situation));
    }

    /// Turns, and keeps the heading until something else asks for one. The way that it flies goes on.
    ///
    /// # Errors
    /// [`Refusal`] on the ground and in modes that turn by themselves.
    pub fn turn(&mut self, turn: &Turn) -> Result<(), Refusal> {
        let situation = self.situation();
        situation.refuse_without_rotor()?;
        if situation.steering.kind() == SteeringKind::Idle && !situation.may_be_led() {
            return Err(Refusal::later("Turn rejected: not flying"));
        }
        let mode = situation.mode;
        if mode == Mode::Mission {
            self.consult(|parts, situation, _| parts.mission.turn_by_command(turn, situation));
            return Ok(());
        }
        if mode != Mode::Takeoff && mode != situation.holding_mode() {
            let name = situation.identity.mode_name(mode);
            return Err(Refusal::later(format!("Turn rejected in {name} mode")));
        }
        // A heading that is asked for goes before what was looked at.
        self.consult(|parts, situation, proposal| {
            proposal.look_at(None);
            parts.turn.begin(turn, situation);
        });
        Ok(())
    }

    /// Takes a set-point. It proves that its sender is alive in every mode, and is flown in the offboard mode.
    ///
    /// # Errors
    /// [`Refusal`] in ArduPilot's identity on the ground, where only a takeoff lifts off, and outside its mode.
    pub fn set_point(&mut self, set_point: SetPoint) -> Result<(), Refusal> {
        let situation = self.situation();
        if situation.identity.is_ardupilot() {
            let position = set_point.position().is_some();
            match situation.mode {
                Mode::Offboard | Mode::Takeoff => {}
                Mode::GuidedAttitude if !position => {}
                Mode::GuidedAttitude => {
                    let reason = "Guided NoGPS takes attitudes only; use Guided for places and velocities";
                    return Err(Refusal::denied(format!("Set-point denied: {reason}")));
                }
                _ => return Err(Refusal::later("Set-point ignored: not in Guided mode")),
            }
            if position && situation.steering.kind() == SteeringKind::Idle && !situation.may_be_led() {
                return Err(Refusal::later("Set-point ignored: take off first"));
            }
        }
        let follows = self.foreign().filter(|model| model.role == ForeignRole::ClosedLoop);
        if let (SetPoint::Attitude(_), Some(model)) = (&set_point, follows) {
            let reason = format!("{} follows positions, not attitudes or thrust", model.name);
            return Err(Refusal::denied(format!("Set-point denied: {reason}")));
        }
        if let Some(position) = set_point.position() {
            check_set_point(&situation, position)?;
        }
        self.see(Cause::SetPointsLost, false);
        self.leave_takeoff();
        let time_us = self.time_us();
        let another = self.machines.offboard.take(set_point, time_us) && self.identity().is_ardupilot();
        if set_point.turns() || another {
            self.machines.turn.forget();
        }
        Ok(())
    }

    /// ArduPilot takes off in its guided mode: what is asked for there takes over from the takeoff.
    pub(super) fn leave_takeoff(&mut self) {
        if self.identity().is_ardupilot() && self.mode() == Mode::Takeoff {
            self.consult(|parts, _, proposal| {
                parts.takeoff.forget();
                proposal.go_on_in(Mode::Offboard);
            });
        }
    }

    /// Changes a limit of speed until the rotors stop. In a mission it goes before the mission's own, until that changes it again.
    ///
    /// # Errors
    /// [`Refusal`] of a speed that there is not.
    pub fn change_speed(&mut self, change: &ChangeSpeed) -> Result<(), Refusal> {
        let speeds = self.machines.speeds.commanded(change);
        self.use_speeds(speeds).map_err(|error| Refusal::denied(error.to_string()))
    }

    /// Looks at something, `None` at nothing any more: until another one, or until the rotors stop.
    pub fn look(&mut self, look: Option<&Look>) {
        self.consult(|parts, situation, proposal| {
            parts.turn.forget();
            parts.offboard.look(look.is_some());
            let (here_m, home_z_m) = (situation.outputs.position_m, situation.home.position_m.z);
            proposal.look_at(look.map(|look| RegionOfInterest::of(look, &here_m, home_z_m)));
            if look.is_none() && situation.chooses_its_heading() {
                proposal.turn_on(None);
            }
        });
    }
}
