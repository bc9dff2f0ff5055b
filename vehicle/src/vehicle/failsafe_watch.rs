//! What the failsafe looks at, and what it asks for.

use super::failsafe::{Action, Cause, Change, Failsafe, Weakness};
use super::failsafe_response::{Response, announced, cleared, crossed, releases_gripper, response};
use super::notice::{Refusal, Severity};
use super::proposal::Proposal;
use super::situation::Situation;
use crate::equipment::Operation;
use crate::fence::Breach;
use crate::mode::{Mode, Needs};

impl Failsafe {
    /// Whether a cause is there now.
    fn finds(&self, situation: &Situation, cause: Cause) -> bool {
        let settings = &situation.conduct.failsafe;
        let remaining = situation.battery_remaining;
        match cause {
            Cause::RotorFailure => situation.lost_rotor.is_some(),
            Cause::PositionLost => {
                // In ArduPilot it lasts until the place is known again, whatever mode it has led to.
                let lasts = situation.identity.is_ardupilot() && self.is_present(cause);
                let by_mode = situation.mode.needs() == Needs::Place;
                let needed = by_mode || lasts || settings.position_lost_everywhere;
                situation.armed && needed && !situation.knows_its_place()
            }
            // ArduPilot does not arm without its radio, either.
            Cause::PilotLost => {
                situation.pilot.missed && (situation.armed || situation.identity.is_ardupilot())
            }
            Cause::BatteryEmergency => remaining < settings.battery_emergency,
            Cause::BatteryCritical => {
                remaining < settings.battery_critical || self.is_weak(Weakness::Critical)
            }
            Cause::BatteryLow => remaining < settings.battery_low || self.is_weak(Weakness::Low),
            Cause::Fence => situation.breach.is_some(),
            Cause::HighWind => settings.wind_m_s > 0.0 && self.wind_m_s() > settings.wind_m_s,
            Cause::GroundStationLost => self.misses_ground_station(),
            Cause::SetPointsLost => false,
        }
    }

    /// Looks at one cause after the other, up to the first that begins or ends, which it returns: what it asks for then is to be
    /// decided before the rest is looked at.
    pub fn watch(
        &mut self,
        situation: &Situation,
        proposal: &mut Proposal,
        causes: &mut core::slice::Iter<Cause>,
    ) -> Option<(Cause, Change)> {
        // That one is told where it is noticed.
        let mut looked_for = causes.filter(|cause| **cause != Cause::SetPointsLost);
        looked_for.find_map(|cause| {
            let present = self.finds(situation, *cause);
            if !present && !self.is_present(*cause) {
                return None;
            }
            let change = self.take_in(situation, proposal, *cause, present);
            change.map(|change| (*cause, change))
        })
    }

    /// Takes in whether a cause is there; announces what that changes, and asks for the action of a cause that begins.
    pub fn take_in(
        &mut self,
        situation: &Situation,
        proposal: &mut Proposal,
        cause: Cause,
        present: bool,
    ) -> Option<Change> {
        // Mostly there is none: what it would lead to is not looked for.
        let change = match self.see(cause, present, situation.time_us) {
            None if present && situation.flies() && self.take_off_with(cause) => Change::Begun,
            change => change?,
        };
        let response = response(situation, cause);
        match change {
            _ if response.action == Action::None => {}
            Change::Begun if response.disarms => {
                proposal.stop_rotors(format!("{} - Disarming", name(situation, cause)));
            }
            Change::Begun => self.act(situation, proposal, cause, response),
            // A rotor that stands tells nothing, and its loss has just ended the flight.
            Change::Ended if cause == Cause::RotorFailure && !situation.armed => {}
            // The flight is over, or the mode needs no place: it is lost all the same.
            Change::Ended if cause == Cause::PositionLost && !situation.knows_its_place() => {}
            Change::Ended => proposal.say(Severity::Info, cleared(situation, cause)),
        }
        Some(change)
    }

    fn act(&mut self, situation: &Situation, proposal: &mut Proposal, cause: Cause, response: Response) {
        let Response { action, goes_on, .. } = response;
        let flying = situation.flies();
        let acts = flying && goes_on.is_none() && self.goes_before(action, Action::of_mode(situation.mode));
        let why = format!("{}{}", name(situation, cause), self.details(situation, cause));
        tracing::debug!(cause = why, ?action, flying, acts, "failsafe");
        if !flying && action > Action::Warn && cause.leaves_no_choice() {
            self.wait_for_takeoff(cause);
        }
        if !acts {
            let meanwhile = match (flying, goes_on) {
                (true, Some(words)) => format!(" - {words}"),
                (true, None) if action > Action::Warn => {
                    format!(": staying in {} mode", situation.identity.mode_name(situation.mode))
                }
                _ => String::new(),
            };
            proposal.say(severity(action), format!("{why}{meanwhile}"));
            return;
        }
        proposal.say(severity(action), format!("{why}: {}", action.doing()));
        if releases_gripper(situation, cause) {
            proposal.operate(Operation::Grip { grabs: false });
        }
        self.engage(cause, action);
        match action.mode() {
            // What it does already goes on.
            Some(mode) if mode == situation.mode && mode != Mode::Mission => {}
            Some(Mode::Mission) => proposal.join_landing(),
            Some(mode) => proposal.enter(mode),
            None if action == Action::Disarm => proposal.stop_rotors("Disarmed by failsafe"),
            None => proposal.terminate(),
        }
    }

    /// Feels the battery: whether its voltage or charge is below a limit, and whether it is there at all. Returns a text for a pilot
    /// whose battery is gone.
    pub fn feel_battery(&mut self, situation: &Situation) -> Option<String> {
        let limits = &situation.conduct.failsafe.battery_limits;
        let missing = limits.is_missing();
        let news = self.miss_battery(missing && situation.armed);
        if missing {
            return news.then(|| {
                let used_mah = 1e3 * situation.conduct.battery_capacity_ah - situation.battery_left_mah;
                format!(
                    "Battery 1 is missing, last: {:.2}V used {:.0} mAh",
                    situation.battery_voltage_v, used_mah
                )
            });
        }
        let voltage_v =
            if limits.at_rest { situation.battery_resting_v } else { situation.battery_voltage_v };
        let late_us = (limits.low_s * 1e6) as u64;
        for (weakness, volts, mah) in [
            (Weakness::Low, limits.low_v, limits.low_mah),
            (Weakness::Critical, limits.critical_v, limits.critical_mah),
        ] {
            let lasting = self.lasts(weakness, voltage_v < volts, situation.time_us, late_us);
            self.set_weak(weakness, lasting || situation.battery_left_mah < mah);
        }
        None
    }

    /// Announces that the fence, which was announced as ahead, has been crossed.
    pub fn tell_crossing(&self, situation: &Situation, proposal: &mut Proposal, breach: Breach) {
        let action = situation.conduct.failsafe.action(Cause::Fence);
        if action != Action::None {
            let what = crossed(situation, breach);
            proposal.say(severity(action), format!("{what} ({breach})"));
        }
    }

    fn details(&self, situation: &Situation, cause: Cause) -> String {
        match cause {
            Cause::BatteryLow | Cause::BatteryCritical | Cause::BatteryEmergency => {
                format!(" ({:.0} %)", 100.0 * situation.battery_remaining)
            }
            Cause::HighWind => format!(" ({:.1} m/s)", self.wind_m_s()),
            Cause::Fence if situation.fence_is_ahead => String::new(),
            Cause::Fence => situation.breach.map(|breach| format!(" ({breach})")).unwrap_or_default(),
            Cause::PositionLost => match situation.failed_instruments().join(", ") {
                failed if failed.is_empty() => failed,
                failed if situation.health.gyroscope => format!(" ({failed} failed)"),
                failed => format!(" ({failed} failed: cannot hold attitude)"),
            },
            _ => String::new(),
        }
    }

    /// What of the causes speaks against arming.
    pub fn obstacles(&self, situation: &Situation) -> impl Iterator<Item = String> {
        let speaks = |cause: &Cause| {
            // These have obstacles of their own, or are for the flight only.
            let others = matches!(
                cause,
                Cause::RotorFailure | Cause::PositionLost | Cause::SetPointsLost | Cause::BatteryLow
            );
            // ArduPilot says what of the fence it is.
            let told = *cause == Cause::Fence && situation.identity.is_ardupilot();
            !others && !told && situation.conduct.failsafe.action(*cause) > Action::Warn
        };
        self.present().filter(speaks).map(|cause| format!("failsafe: {}", lower(cause)))
    }

    /// Whether an armed vehicle on the ground may take off.
    ///
    /// # Errors
    /// [`Refusal::TemporarilyRejected`] while the place is not known: it would only land again. [`Refusal::Failed`] in ArduPilot.
    pub fn may_take_off(&self, situation: &Situation) -> Result<(), Refusal> {
        let ardupilot = situation.identity.is_ardupilot();
        let acts = ardupilot || situation.conduct.failsafe.position_lost >= Action::Altitude;
        if !situation.armed || !acts || situation.can_fly(Mode::Takeoff) {
            return Ok(());
        }
        let reason = "Takeoff rejected: position lost, only landing is possible";
        Err(if ardupilot { Refusal::Failed(reason.to_owned()) } else { Refusal::later(reason) })
    }

    /// Whether a user may choose a mode now.
    ///
    /// # Errors
    /// [`Refusal::TemporarilyRejected`] while the place is not known; [`Refusal::Failed`] on the ground, where ArduPilot refuses it of an
    /// armed vehicle.
    pub fn may_enter(&self, situation: &Situation, mode: Mode) -> Result<(), Refusal> {
        let stands = situation.armed && !situation.flies() && situation.identity.is_ardupilot();
        if stands && mode.needs() == Needs::Place && !situation.can_fly(mode) {
            let name = situation.identity.mode_name(mode);
            return Err(Refusal::Failed(format!("{name} mode rejected: requires position")));
        }
        if !situation.flies() || mode == Mode::Land {
            return Ok(());
        }
        let lost =
            !situation.can_fly(mode) || mode.needs() == Needs::Place && self.is_present(Cause::PositionLost);
        if lost && situation.conduct.failsafe.position_lost >= Action::Altitude {
            let name = situation.identity.mode_name(mode);
            return Err(Refusal::later(format!(
                "{name} mode rejected: position lost, only landing is possible"
            )));
        }
        Ok(())
    }
}

/// What has happened, for the pilot.
fn name(situation: &Situation, cause: Cause) -> String {
    announced(situation, cause).unwrap_or_else(|| cause.name().to_owned())
}

/// How severe a cause with this action is.
fn severity(action: Action) -> Severity {
    if action > Action::Warn { Severity::Critical } else { Severity::Warning }
}

fn lower(cause: Cause) -> String {
    cause.name().to_lowercase()
}

#[cfg(test)]
mod tests {
    use super::{Action, Cause, Failsafe, Mode};
    use crate::vehicle::proposal::Request;
    use crate::vehicle::scene::{Scene, said};

    fn take_in(failsafe: &mut Failsafe, scene: &mut Scene, cause: Cause, present: bool) -> Vec<Request> {
        scene.show(|situation, proposal| {
            failsafe.take_in(situation, proposal, cause, present);
        })
    }

    #[test]
    fn a_cause_that_begins_is_announced_then_its_mode_is_asked_for() {
        let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]);
        scene.conduct.failsafe.ground_station_lost = Action::Return;
        let mut failsafe = Failsafe::default();
        failsafe.hear_ground_station(false);
        assert!(failsafe.finds(&scene.situation(), Cause::GroundStationLost));
        let requests = take_in(&mut failsafe, &mut scene, Cause::GroundStationLost, true);
        let [said_first, Request::Enter(Mode::Return)] = requests.as_slice() else { panic!("{requests:?}") };
        assert_eq!(said(std::slice::from_ref(said_first)), ["Ground station lost: returning"]);
        assert_eq!(failsafe.engaged(), Some((Cause::GroundStationLost, Action::Return)));
        // It is there: nothing more to be said.
        assert!(take_in(&mut failsafe, &mut scene, Cause::GroundStationLost, true).is_empty());
    }

    #[test]
    fn a_lost_rotor_is_not_called_mended_after_the_landing() {
        for (armed, lines) in [(true, vec!["Failsafe cleared: no rotor known to be lost"]), (false, vec![])] {
            let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]);
            scene.conduct.failsafe.rotor_failure = Action::Land;
            let mut failsafe = Failsafe::default();
            take_in(&mut failsafe, &mut scene, Cause::RotorFailure, true);
            scene.armed = armed;
            take_in(&mut failsafe, &mut scene, Cause::RotorFailure, false);
            scene.wait_us(10_000_000);
            assert_eq!(
                said(&take_in(&mut failsafe, &mut scene, Cause::RotorFailure, false)),
                lines,
                "{armed}"
            );
        }
    }

    #[test]
    fn a_position_that_is_still_lost_is_not_called_known() {
        for (known, lines) in [(true, vec!["Failsafe cleared: position known"]), (false, vec![])] {
            let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]);
            scene.conduct.failsafe.position_lost = Action::Land;
            scene.validity.horizontal_position = false;
            let mut failsafe = Failsafe::default();
            take_in(&mut failsafe, &mut scene, Cause::PositionLost, true);
            (scene.armed, scene.validity.horizontal_position) = (false, known);
            take_in(&mut failsafe, &mut scene, Cause::PositionLost, false);
            scene.wait_us(10_000_000);
            let requests = take_in(&mut failsafe, &mut scene, Cause::PositionLost, false);
            assert_eq!(said(&requests), lines, "{known}");
        }
    }

    #[test]
    fn what_leaves_no_choice_acts_when_the_vehicle_takes_off_with_it() {
        for (cause, acts) in
            [(Cause::PositionLost, true), (Cause::RotorFailure, true), (Cause::HighWind, false)]
        {
            let mut failsafe = Failsafe::default();
            let mut scene = Scene::on_the_ground();
            let settings = &mut scene.conduct.failsafe;
            (settings.position_lost, settings.rotor_failure, settings.high_wind) =
                (Action::Land, Action::Land, Action::Land);
            let grounded = scene.conduct;
            let requests = take_in(&mut failsafe, &mut scene, cause, true);
            assert!(!requests.contains(&Request::Enter(Mode::Land)), "{cause:?} {requests:?}");
            let mut scene = Scene::hovering_at([0.0, 0.0, -1.0]);
            scene.conduct = grounded;
            for expected in [acts, false] {
                let requests = take_in(&mut failsafe, &mut scene, cause, true);
                assert_eq!(
                    requests.contains(&Request::Enter(Mode::Land)),
                    expected,
                    "{cause:?} {requests:?}"
                );
            }
        }
    }

    #[test]
    fn a_landing_is_not_called_off_and_nothing_happens_on_the_ground() {
        let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]);
        (scene.mode, scene.conduct.failsafe.high_wind) = (Mode::Land, Action::Return);
        let requests = take_in(&mut Failsafe::default(), &mut scene, Cause::HighWind, true);
        assert_eq!(said(&requests), ["High wind (0.0 m/s): staying in Land mode"]);
        let mut scene = Scene::on_the_ground();
        scene.conduct.failsafe.high_wind = Action::Terminate;
        let requests = take_in(&mut Failsafe::default(), &mut scene, Cause::HighWind, true);
        assert_eq!(said(&requests), ["High wind (0.0 m/s)"]);
    }
}
