//! What may be asked about plans: to replace one, and to fly the mission.

use super::super::notice::{Refusal, Severity};
use super::super::plans::{check_rally_points, check_reach, check_way, keeps_inside};
use super::Vehicle;
use crate::mode::Mode;
use crate::plan::item_search::{LARGEST_TAG, landing_start, tagged_item};
use crate::plan::{MissionItem, PlanFault, PlanKind, Site, check, compile, return_path};

impl Vehicle {
    /// Replaces a plan.
    ///
    /// # Errors
    /// [`PlanFault`]; the old plan stays then.
    pub fn set_plan(&mut self, kind: PlanKind, items: Vec<MissionItem>) -> Result<(), PlanFault> {
        self.take_plan(kind, items, false)
    }

    /// Replaces a plan by one that goes on where the old one is.
    ///
    /// # Errors
    /// [`PlanFault`]; the old plan stays then.
    pub fn amend_plan(&mut self, kind: PlanKind, items: Vec<MissionItem>) -> Result<(), PlanFault> {
        self.take_plan(kind, items, true)
    }

    /// Looks at all plans again: their places on the map are elsewhere in the local frame now.
    pub(super) fn plan_again(&mut self) {
        for kind in PlanKind::ALL {
            let items = self.plans().get(kind).items().to_vec();
            if items.is_empty() {
                continue;
            }
            if let Err(fault) = self.amend_plan(kind, items) {
                let (name, reason) = (kind.name(), fault.located(self.identity()));
                self.decided.say(Severity::Warning, format!("{name} does not fit the origin: {reason}"));
            }
        }
    }

    fn take_plan(&mut self, kind: PlanKind, items: Vec<MissionItem>, amended: bool) -> Result<(), PlanFault> {
        let site = self.site();
        check::plan(kind, &items, &site)?;
        match kind {
            PlanKind::Mission => return self.take_mission(items, &site, amended),
            PlanKind::Fence => self.plans.take_fence(items, &site)?,
            PlanKind::Rally => {
                let points = compile::rally_points(&items, &site);
                check_rally_points(&self.situation(), &points)?;
                self.plans.take_rally_points(items, points);
            }
        }
        if let Err(fault) = keeps_inside(&self.situation(), self.machines.mission.program(), false) {
            self.warn_of_mission(&fault);
        }
        Ok(())
    }

    fn take_mission(&mut self, items: Vec<MissionItem>, site: &Site, amended: bool) -> Result<(), PlanFault> {
        let program = compile::mission(&items, site);
        // Of one that is flown, the step goes on that is flown.
        let begins = !amended && self.mode() != Mode::Mission;
        check_way(&self.situation(), &program, begins)?;
        self.plans.take_mission(items);
        let situation = self.situation();
        let reached = check_reach(&situation, &program);
        if let Err(fault) = reached.and_then(|()| keeps_inside(&situation, &program, begins)) {
            self.warn_of_mission(&fault);
        }
        self.consult(|parts, situation, proposal| {
            parts.mission.replace(situation, proposal, program, amended);
        });
        Ok(())
    }

    fn warn_of_mission(&mut self, fault: &PlanFault) {
        let reason = fault.located(self.identity());
        self.decided.say(Severity::Warning, format!("Mission cannot be flown: {reason}"));
    }

    /// Starts the mission, or goes on with it; `first` names the item to begin with.
    ///
    /// # Errors
    /// [`Refusal`] without a mission, for one that the fence forbids, for an item that there is not, and when only landing is left.
    pub fn start_mission(&mut self, first: Option<usize>) -> Result<(), Refusal> {
        self.enter_mission(first)?;
        self.machines.consent.give();
        Ok(())
    }

    /// The same without consent to a takeoff.
    pub(super) fn enter_mission(&mut self, first: Option<usize>) -> Result<(), Refusal> {
        let situation = self.situation();
        let stands = situation.armed && situation.landed && situation.mode != Mode::Mission;
        let restarts = situation.conduct.mission_restarts;
        let takes_off = self.has_mission() && self.machines.mission.begins_with_takeoff(restarts);
        if situation.identity.is_ardupilot() && stands && self.has_mission() && !takes_off {
            return Err(Refusal::Failed("Auto: Missing Takeoff Cmd".to_owned()));
        }
        self.fly_mission(first)?;
        self.machines.failsafe.release();
        Ok(())
    }

    /// The same by itself: what the failsafe does goes on.
    fn fly_mission(&mut self, first: Option<usize>) -> Result<(), Refusal> {
        self.may_enter(Mode::Mission)?;
        self.situation().refuse_without_rotor()?;
        self.consult(|parts, situation, proposal| parts.mission.start(situation, proposal, first))
    }

    /// Pauses: PX4 holds in its own mode for that, ArduPilot within the mission's mode or the guided one.
    ///
    /// # Errors
    /// [`Refusal`] when it cannot hold now.
    pub fn pause(&mut self) -> Result<(), Refusal> {
        if !self.identity().is_ardupilot() {
            return self.set_mode(Mode::Hold);
        }
        match self.mode() {
            Mode::Mission => {
                self.consult(|parts, situation, proposal| parts.mission.pause(situation, proposal));
                Ok(())
            }
            Mode::Offboard | Mode::Takeoff if self.situation().flies() => {
                self.leave_takeoff();
                self.consult(|parts, situation, proposal| {
                    parts.offboard.pause(&mut parts.ground_flight, situation, proposal);
                });
                Ok(())
            }
            mode => {
                let name = self.identity().mode_name(mode);
                Err(Refusal::Failed(format!(
                    "Pause rejected in {name} mode: only Auto and Guided, in flight"
                )))
            }
        }
    }

    /// Goes on with what was paused: in ArduPilot's guided mode the way to its goal, else the item at which the mission was left.
    ///
    /// # Errors
    /// [`Refusal`] when nothing was paused.
    pub fn continue_mission(&mut self) -> Result<(), Refusal> {
        if self.mode() == Mode::Offboard && self.machines.offboard.is_paused() {
            self.consult(|parts, situation, proposal| {
                parts.offboard.resume(&mut parts.ground_flight, situation, proposal);
            });
            return Ok(());
        }
        self.machines.mission.may_continue()?;
        self.start_mission(None)
    }

    /// Goes on with the item behind a tag.
    ///
    /// # Errors
    /// [`Refusal`] without such a tag, and as [`Vehicle::set_mission_item`].
    pub fn jump_to_tag(&mut self, tag: f64) -> Result<(), Refusal> {
        if !(0.0..=LARGEST_TAG).contains(&tag) {
            return Err(Refusal::denied(format!("Jump denied: tag {tag} is outside 0 to {LARGEST_TAG}")));
        }
        let items = self.plans().get(PlanKind::Mission).items();
        let index = tagged_item(items, tag)
            .ok_or_else(|| Refusal::Failed(format!("Jump rejected: no item has tag {tag}")))?;
        self.set_mission_item(index, false)
    }

    /// Goes on with the nearest landing of the mission: what follows DO_LAND_START.
    ///
    /// # Errors
    /// [`Refusal`] without such a landing, and as [`Vehicle::start_mission`].
    pub fn start_landing(&mut self) -> Result<(), Refusal> {
        let (site, here_m) = (self.site(), self.outputs().position_m);
        let start = landing_start(self.plans().get(PlanKind::Mission).items(), &site, &here_m);
        self.join(start, "Landing rejected: the mission has no DO_LAND_START")?;
        self.machines.failsafe.release();
        Ok(())
    }

    /// Goes on with the mission's way back, what follows DO_RETURN_PATH_START, where that is nearest.
    ///
    /// # Errors
    /// [`Refusal`] without such a way, and as [`Vehicle::start_mission`].
    pub fn start_return_path(&mut self) -> Result<(), Refusal> {
        let (site, here_m) = (self.site(), self.outputs().position_m);
        let joined = return_path::joined(self.plans().get(PlanKind::Mission).items(), &site, &here_m);
        self.join(joined, "Return path rejected: the mission has no DO_RETURN_PATH_START")?;
        self.machines.failsafe.release();
        Ok(())
    }

    /// Goes on with the mission's way back, or else with its landing (Auto RTL).
    ///
    /// # Errors
    /// [`Refusal`] without either, and as [`Vehicle::start_mission`].
    pub(super) fn return_by_mission(&mut self) -> Result<(), Refusal> {
        self.join_landing()?;
        self.machines.failsafe.release();
        Ok(())
    }

    /// The same by itself: what the failsafe does goes on.
    pub(super) fn join_landing(&mut self) -> Result<(), Refusal> {
        let (site, here_m) = (self.site(), self.outputs().position_m);
        let items = self.plans().get(PlanKind::Mission).items();
        let joined = return_path::joined(items, &site, &here_m);
        self.join(
            joined.or_else(|| landing_start(items, &site, &here_m)),
            "Auto RTL rejected: the mission has neither DO_RETURN_PATH_START nor DO_LAND_START",
        )
    }

    /// Goes on with an item; `refusal` says why there is none.
    fn join(&mut self, index: Option<usize>, refusal: &str) -> Result<(), Refusal> {
        let index = index.ok_or_else(|| Refusal::Failed(refusal.to_owned()))?;
        self.fly_mission(Some(index))?;
        if self.identity().is_ardupilot() {
            self.machines.mission.land();
        }
        Ok(())
    }

    /// Makes an item the current one; with `reset` the jumps count anew.
    ///
    /// # Errors
    /// [`Refusal`] for an item that there is not.
    pub fn set_mission_item(&mut self, index: usize, reset: bool) -> Result<(), Refusal> {
        self.consult(|parts, situation, proposal| {
            parts.mission.set_current(situation, proposal, index, reset)
        })
    }
}
