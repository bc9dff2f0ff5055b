//! The vehicle under the failsafe.

use super::{Action, Cause, Change, Failsafe};
use crate::mode::Mode;
use crate::vehicle::notice::{Refusal, Severity};
use crate::vehicle::state::{TICK_US, Vehicle};
use crate::vehicle::steering::SteeringKind;

/// Gusts shorter than this, s, are no high wind.
const WIND_TIME_CONSTANT_S: f64 = 2.0;

impl Vehicle {
    /// The failsafe.
    pub fn failsafe(&self) -> &Failsafe {
        &self.failsafe
    }

    /// Tells whether a ground station is heard.
    pub fn hear_ground_station(&mut self, heard: bool) {
        self.failsafe.ground_station = Some(heard);
    }

    /// Looks at all causes, and acts on those that begin.
    pub(in crate::vehicle) fn watch(&mut self) {
        let dt_s = TICK_US as f64 / 1e6;
        let share = dt_s / (WIND_TIME_CONSTANT_S + dt_s);
        self.failsafe.wind_m_s += share * (self.wind_m_s.norm() - self.failsafe.wind_m_s);
        for cause in Cause::ALL {
            // Those are told where they are noticed.
            if cause == Cause::SetPointsLost {
                continue;
            }
            let present = self.is_present(cause);
            self.see(cause, present);
        }
    }

    /// Takes in whether a cause is there.
    pub(in crate::vehicle) fn see(&mut self, cause: Cause, present: bool) {
        match self.failsafe.see(cause, present, self.time_us()) {
            Some(Change::Begun) => self.begin(cause),
            Some(Change::Ended) if self.conduct.failsafe.action(cause) > Action::None => {
                self.say(Severity::Info, format!("Failsafe: {} is over", lower(cause)));
            }
            _ => {}
        }
    }

    /// Whether there is a flight that could be ended, or flown otherwise.
    fn flies(&self) -> bool {
        self.armed && self.steering.kind() != SteeringKind::Idle
    }

    fn is_present(&self, cause: Cause) -> bool {
        let settings = &self.conduct.failsafe;
        let remaining = self.battery_remaining();
        match cause {
            Cause::RotorFailure => self.lost_rotor().is_some(),
            Cause::PositionLost => self.armed && !self.knows_its_place(),
            Cause::BatteryEmergency => remaining < settings.battery_emergency,
            Cause::BatteryCritical => remaining < settings.battery_critical,
            Cause::BatteryLow => remaining < settings.battery_low,
            Cause::Fence => self.fence_record.now.is_some(),
            Cause::HighWind => settings.wind_m_s > 0.0 && self.failsafe.wind_m_s > settings.wind_m_s,
            Cause::GroundStationLost => self.failsafe.ground_station == Some(false),
            Cause::SetPointsLost => false,
        }
    }

    fn begin(&mut self, cause: Cause) {
        if cause == Cause::Fence {
            self.count_breach();
        }
        let action = self.conduct.failsafe.action(cause);
        if action == Action::None {
            return;
        }
        let flying = self.flies();
        let acts = flying && self.failsafe.goes_before(action, Action::of_mode(self.mode));
        let why = cause.name();
        let severity = if action > Action::Warn { Severity::Critical } else { Severity::Warning };
        tracing::debug!(cause = why, action = action.name(), flying, acts, "failsafe");
        let details = self.details(cause);
        if !acts {
            let meanwhile = match (flying, action > Action::Warn) {
                (true, true) => format!(": goes on in {} mode", self.identity.mode_name(self.mode)),
                _ => String::new(),
            };
            self.say(severity, format!("Failsafe: {why}{details}{meanwhile}"));
            return;
        }
        self.say(severity, format!("Failsafe: {why}{details}: {}", action.name()));
        self.failsafe.engage(cause, action);
        match action.mode() {
            Some(mode) => self.enter(mode),
            None => self.terminate(),
        }
    }

    fn details(&self, cause: Cause) -> String {
        match cause {
            Cause::BatteryLow | Cause::BatteryCritical | Cause::BatteryEmergency => {
                format!(" ({:.0} %)", 100.0 * self.battery_remaining())
            }
            Cause::HighWind => format!(" ({:.1} m/s)", self.failsafe.wind_m_s),
            Cause::Fence => self.fence_record.now.map(|breach| format!(" ({breach})")).unwrap_or_default(),
            Cause::PositionLost => match self.failed_instruments().join(", ") {
                failed if failed.is_empty() => failed,
                failed if self.instrument_health().gyroscope => format!(" ({failed} failed)"),
                failed => format!(" ({failed} failed: no attitude can be held)"),
            },
            _ => String::new(),
        }
    }

    /// What of the causes speaks against arming.
    pub(in crate::vehicle) fn failsafe_obstacles(&self) -> Vec<String> {
        let speaks = |cause: &Cause| {
            // These have obstacles of their own, or are for the flight only.
            let others = matches!(
                cause,
                Cause::RotorFailure | Cause::PositionLost | Cause::SetPointsLost | Cause::BatteryLow
            );
            !others && self.conduct.failsafe.action(*cause) > Action::Warn
        };
        self.failsafe.present().filter(speaks).map(|cause| format!("failsafe: {}", lower(cause))).collect()
    }

    /// Whether a user may choose a mode now.
    ///
    /// # Errors
    /// [`Refusal::TemporarilyRejected`] while the place is not known.
    pub(in crate::vehicle) fn may_enter(&self, mode: Mode) -> Result<(), Refusal> {
        if !self.flies() || mode == Mode::Land {
            return Ok(());
        }
        let lost = self.failsafe.is_present(Cause::PositionLost);
        if lost && self.conduct.failsafe.position_lost >= Action::Land {
            let name = self.identity.mode_name(mode);
            return Err(Refusal::later(format!("{name} rejected: position lost, only landing is left")));
        }
        Ok(())
    }
}

fn lower(cause: Cause) -> String {
    cause.name().to_lowercase()
}
