//! The climb rate of the modes in which the pilot's throttle asks for one.

use super::pilot_takeoff::PilotTakeoff;
use super::situation::Situation;
use super::surface_tracking::SurfaceTracking;
use super::tick::TICK_S;

/// What changes the climb rate that is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct StickClimb {
    takeoff: PilotTakeoff,
    surface: SurfaceTracking,
}

impl StickClimb {
    /// Another mode begins, or the rotors stop.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// A command takes off to z, m.
    pub fn take_off(&mut self, z_m: f64) {
        self.takeoff.aim(z_m);
    }

    /// Whether a takeoff goes on.
    pub fn takes_off(&self) -> bool {
        self.takeoff.goes_on()
    }

    /// The climb rate that is flown in this tick where the pilot asks for one, m/s. Takeoffs follow no surface.
    pub fn climb_m_s(&mut self, situation: &Situation, asked_m_s: f64) -> f64 {
        let climb_m_s = self.takeoff.climb_m_s(situation, asked_m_s);
        if self.takeoff.goes_on() {
            self.surface.forget();
            return climb_m_s;
        }
        self.surface.climb_m_s(situation, climb_m_s, TICK_S)
    }
}
