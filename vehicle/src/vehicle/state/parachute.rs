//! What is done with the parachute.

use nalgebra::Vector3;

use super::super::notice::Severity;
use super::super::parachute_watch;
use super::Vehicle;
use crate::equipment::{OutputFunction, ParachuteOrder};

impl Vehicle {
    /// Does what is asked of the parachute. A pilot's release does nothing on the ground, too low, or while it may not open.
    pub fn order_parachute(&mut self, order: ParachuteOrder) {
        match order {
            ParachuteOrder::Enable => self.enable_parachute(true),
            ParachuteOrder::Disable => self.enable_parachute(false),
            ParachuteOrder::Release if !self.conduct().equipment.parachute.enabled => {}
            ParachuteOrder::Release if self.situation().landed => {
                self.decided.say(Severity::Info, "Parachute: Landed");
            }
            ParachuteOrder::Release if !parachute_watch::reaches(&self.situation()) => {
                self.decided.say(Severity::Critical, "Parachute: Too low");
            }
            ParachuteOrder::Release => self.release_parachute(),
        }
    }

    fn enable_parachute(&mut self, enabled: bool) {
        let mut conduct = *self.conduct();
        if conduct.equipment.parachute.enabled != enabled {
            conduct.equipment.parachute.enabled = enabled;
            self.setup.set_conduct(conduct);
        }
        let what = if enabled { "Parachute: Enabled" } else { "Parachute: Disabled" };
        self.decided.say(Severity::Info, what);
    }

    /// Stops the rotors, and lets the parachute open.
    fn release_parachute(&mut self) {
        let time_us = self.time_us();
        if self.machines.equipment.parachute().is_released() {
            return;
        }
        self.machines.equipment.parachute_mut().release(time_us);
        if self.is_armed() {
            self.decided.terminate();
            self.stop_rotors("Parachute: Released");
        }
    }

    /// Releases the parachute where control is lost, and opens it when its output fires.
    pub(super) fn step_parachute(&mut self) {
        let settings = self.conduct().equipment.parachute;
        if settings.enabled {
            let (situation, parts) = self.situation_and_machines();
            if parts.parachute.is_needed(&situation, parts.rotors.falls()) {
                self.release_parachute();
            }
        }
        if !self.equipment().parachute().is_released() {
            return;
        }
        let number = usize::try_from(settings.output).unwrap_or(0);
        let output = self.conduct().equipment.output(number);
        if output.map(|output| output.follows(number)) != Some(OutputFunction::Parachute) {
            return;
        }
        let pulse_us = self.output_us(number);
        if self.machines.equipment.parachute_mut().see_pulse(&settings, pulse_us) {
            self.decided.say(Severity::Critical, "BANG!  Parachute deployed");
        }
    }

    /// The drag of the parachute, NED, N.
    pub(super) fn parachute_drag_n(&self) -> Vector3<f64> {
        let through_air_m_s = self.perception.truth().velocity_m_s - self.wind_m_s();
        let weight_n = self.closed_loop.simulation().configuration().airframe.weight_n();
        self.equipment().parachute().drag_n(&through_air_m_s, weight_n)
    }
}
