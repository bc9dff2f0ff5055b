//! The one place that decides: it carries out what the parts ask for, in the order in which they ask.

use super::failsafe::Failsafe;
use super::mission::Mission;
use super::proposal::{Proposal, Request};
use super::situation::Situation;
use super::speeds::SpeedChange;
use super::state::Vehicle;
use crate::mode::Mode;

/// The parts that have moved.
pub struct Machines<'a> {
    /// The mission.
    pub mission: &'a mut Mission,
    /// Failsafes.
    pub failsafe: &'a mut Failsafe,
}

impl Vehicle {
    /// Shows the situation to a part, and carries out what it asks for.
    pub(super) fn consult<T>(
        &mut self,
        ask: impl FnOnce(&mut Machines, &Situation, &mut Proposal) -> T,
    ) -> T {
        let goes_on = self.mission_goes_on();
        let mut mission = std::mem::take(&mut self.mission);
        let mut failsafe = std::mem::take(&mut self.failsafe);
        let situation = Situation { mission_goes_on: goes_on, ..self.situation() };
        let mut proposal = Proposal::new(&situation);
        let mut parts = Machines { mission: &mut mission, failsafe: &mut failsafe };
        let answer = ask(&mut parts, &situation, &mut proposal);
        (self.mission, self.failsafe) = (mission, failsafe);
        self.decide(proposal);
        answer
    }

    pub(super) fn situation(&self) -> Situation<'_> {
        Situation {
            time_us: self.outputs.time_us,
            unix_start_us: self.unix_start_us,
            identity: self.identity,
            conduct: &self.conduct,
            configuration: self.simulation.configuration(),
            frame: &self.frame,
            plans: &self.plans,
            zones: &self.fence_zones,
            outputs: &self.outputs,
            truth: &self.truth,
            validity: self.validity(),
            health: self.instrument_health(),
            estimates: self.navigation.is_some(),
            fix_velocity_down_m_s: self
                .navigation
                .as_ref()
                .and_then(crate::estimation::Navigation::latest_fix)
                .map(|fix| fix.velocity_m_s.z),
            rotor_command_rad_s: [0.0; 4],
            wind_m_s: self.wind_m_s,
            battery_remaining: self.battery_remaining(),
            armed: self.armed,
            mode: self.mode,
            steering: &self.steering,
            home: &self.home,
            region: self.region,
            landed: self.landed.is_landed(),
            settled: self.landed.is_settled(),
            flown: self.flown,
            lost_rotor: self.lost_rotor(),
            breach: self.fence_record.now,
            set_points_are_recent: self.set_points_are_recent(),
            mission_goes_on: self.mission_goes_on(),
        }
    }

    fn decide(&mut self, proposal: Proposal) {
        let (steering, home, region, requests) = proposal.into_parts();
        self.steering = steering;
        self.home = home;
        self.region = region;
        for request in requests {
            match request {
                Request::Say(notice) => self.notices.push(notice),
                Request::Enter(mode) => self.enter(mode),
                Request::ChangeSpeeds(SpeedChange::Mission(change)) => self.change_mission_speed(&change),
                Request::ChangeSpeeds(SpeedChange::InMission(flown)) => self.apply_mission_speeds(flown),
                Request::ChangeSpeeds(SpeedChange::ForgetMission) => self.forget_mission_speeds(),
                Request::ChangeSpeeds(SpeedChange::ForgetCommands) => self.forget_command_speeds(),
                Request::See(..) | Request::StopRotors(_) | Request::Terminate => {}
            }
        }
    }

    /// Whether the mission goes on by itself on the ground.
    pub(super) fn mission_goes_on(&self) -> bool {
        let started = self.mission.progress() == super::mission::Progress::Started;
        self.mode == Mode::Mission && started && self.flown && self.armed
    }
}
