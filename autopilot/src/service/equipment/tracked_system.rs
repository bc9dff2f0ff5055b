//! Another system as the region of interest: the vehicle and its gimbal look at where it says that it is.

use mavlink::dialects::ardupilotmega::MavCmd;
use vehicle::equipment::{GimbalMode, Operation};
use vehicle::plan::{Altitude, Look, Place};
use vehicle::world::Geodetic;
use vehicle::{Refusal, Vehicle};

use crate::codec::{Command, Frame, degrees, id};
use crate::context::Context;
use crate::envelope::Origin;
use crate::service::{CommandEntry, Outcome, Progress, Service};

const DO_SET_ROI_SYSID: u16 = MavCmd::MAV_CMD_DO_SET_ROI_SYSID as u16;
const COMMANDS: &[CommandEntry] = &[CommandEntry::action(DO_SET_ROI_SYSID)];

/// The system that is looked at, and where it was seen.
#[derive(Clone, Copy, Debug, Default)]
pub struct TrackedSystem {
    system: Option<u8>,
    seen: Option<Look>,
    /// When it was seen last, µs; `None`: the gimbal has been told to stay where it was.
    seen_us: Option<u64>,
}

/// ArduPilot's gimbals stay where they are once the system has not been heard for so long, µs.
const STALE_US: u64 = 3_000_000;

impl Service for TrackedSystem {
    fn summary(&self) -> &'static str {
        "Another system as the region of interest"
    }

    fn listens(&self) -> &'static [u32] {
        &[id::GLOBAL_POSITION_INT]
    }

    fn commands(&self) -> &'static [CommandEntry] {
        COMMANDS
    }

    /// GLOBAL_POSITION_INT of the system that is looked at.
    fn receive(&mut self, context: &mut Context, origin: &Origin, frame: &Frame) {
        if self.system != Some(origin.system) {
            return;
        }
        let vehicle = &mut context.vehicle;
        // Something else was named, or the rotors have stopped, since it was seen.
        if self.seen.is_some_and(|seen| !vehicle.looks_at(&seen)) {
            *self = Self::default();
            return;
        }
        if let Some(look) = place(vehicle, frame) {
            // One that stayed where it was tracks again, wherever the system is.
            if self.seen_us.is_none() {
                let _tracks = vehicle.operate(&Operation::SetGimbalMode(GimbalMode::Region));
            }
            vehicle.look(Some(&look));
            (self.seen, self.seen_us) = (Some(look), Some(vehicle.time_us()));
        }
    }

    fn is_busy(&self) -> bool {
        self.seen_us.is_some()
    }

    fn tick(&mut self, context: &mut Context) {
        let vehicle = &mut context.vehicle;
        let stale = self.seen_us.is_some_and(|seen_us| vehicle.time_us() > seen_us + STALE_US);
        if stale && vehicle.identity().is_ardupilot() {
            self.seen_us = None;
            let still = self.seen.is_some_and(|seen| vehicle.looks_at(&seen));
            if still && vehicle.equipment().gimbal().tracks() {
                // Staying is never refused.
                let _stays = vehicle.operate(&Operation::HoldGimbal);
            }
        }
    }

    /// DO_SET_ROI_SYSID: system; 0 is none.
    fn command(&mut self, _context: &mut Context, _origin: &Origin, command: &Command) -> Outcome {
        let system = command.whole(1).and_then(|system| u8::try_from(system).ok());
        let system =
            system.ok_or_else(|| Refusal::denied("DO_SET_ROI_SYSID requires a system from 0 to 255"))?;
        *self = Self { system: (system > 0).then_some(system), ..Self::default() };
        Ok(Progress::Done)
    }
}

/// Where a GLOBAL_POSITION_INT is.
fn place(vehicle: &Vehicle, frame: &Frame) -> Option<Look> {
    let payload = frame.payload();
    let place = Geodetic {
        latitude_deg: degrees(payload.i32(4)),
        longitude_deg: degrees(payload.i32(8)),
        altitude_m: f64::from(payload.i32(12)) / 1e3,
    };
    if !place.is_valid() {
        return None;
    }
    let [x, y, z] = vehicle.frame().to_local_m(&place).data.0[0];
    Some(Look::At(Place { horizontal_m: Some([x, y]), altitude: Some(Altitude::Down(z)) }))
}
