//! What only a reboot mends (ArduPilot): a barometer that was not found at the start, or a main loop that hangs.

use super::notice::Severity;
use super::proposal::Proposal;
use super::situation::Situation;

/// It is told again after this time, µs.
const AGAIN_US: u64 = 5_000_000;
/// A main loop that hangs for longer, µs, has its rotors stopped.
const PATIENCE_US: u64 = 2_000_000;

/// What is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fault {
    /// There is no barometer.
    NoBarometer,
    /// The main loop hangs since a time, µs, as a client asked for.
    Hangs(u64),
}

/// Whether something is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct BootFault {
    fault: Option<Fault>,
    /// When it is told next, µs.
    told_us: u64,
}

impl BootFault {
    /// At the start, with a number of barometers.
    pub fn with_barometers(count: i8) -> Self {
        Self { fault: (count <= 0).then_some(Fault::NoBarometer), told_us: 0 }
    }

    /// The main loop hangs from a time, µs, on.
    pub fn hang(&mut self, time_us: u64) {
        *self = Self { fault: Some(Fault::Hangs(time_us)), told_us: time_us };
    }

    /// Whether anything is wrong.
    pub fn is_present(&self) -> bool {
        self.fault.is_some()
    }

    /// What speaks against arming.
    pub fn obstacle(&self) -> Option<&'static str> {
        Some(match self.fault? {
            Fault::NoBarometer => "Config Error: no barometer; set SIM_BARO_COUNT to 1 or more, then reboot",
            Fault::Hangs(_) => "Main loop hangs: reboot the vehicle",
        })
    }

    /// One tick: tells it again and again, and stops rotors that nobody controls.
    pub fn watch(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let Some(text) = self.obstacle() else { return };
        if situation.time_us >= self.told_us {
            self.told_us = situation.time_us + AGAIN_US;
            proposal.say(Severity::Critical, text);
        }
        if let Some(Fault::Hangs(since_us)) = self.fault
            && situation.armed
            && situation.time_us >= since_us + PATIENCE_US
        {
            proposal.terminate();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::BootFault;
    use crate::vehicle::proposal::Request;
    use crate::vehicle::scene::{Scene, said};

    #[test]
    fn a_missing_barometer_is_told_every_five_seconds() {
        assert!(!BootFault::with_barometers(1).is_present());
        let mut fault = BootFault::with_barometers(-1);
        let mut scene = Scene::on_the_ground();
        let mut tell = |scene: &mut Scene| said(&scene.show(|s, p| fault.watch(s, p))).len();
        assert_eq!((tell(&mut scene), tell(&mut scene)), (1, 0));
        scene.wait_us(5_000_000);
        assert_eq!(tell(&mut scene), 1);
    }

    #[test]
    fn the_rotors_of_a_hanging_vehicle_stop_after_two_seconds() {
        let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]);
        let mut fault = BootFault::default();
        fault.hang(scene.outputs.time_us);
        let mut stops =
            |scene: &mut Scene| scene.show(|s, p| fault.watch(s, p)).contains(&Request::Terminate);
        assert!(!stops(&mut scene));
        scene.wait_us(2_000_000);
        assert!(stops(&mut scene));
    }
}
