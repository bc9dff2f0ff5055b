//! The service that takes estimates, and says why nothing comes of one.

use std::collections::BTreeSet;

use vehicle::Severity;
use vehicle::estimation::vision::{VisionReading, VisionRefusal};

use super::message::Estimate;
use super::{odometry, pose};
use crate::codec::{Frame, Payload};
use crate::context::Context;
use crate::envelope::Origin;
use crate::service::Service;

/// By how much the length of a quaternion may differ from 1: PX4 is strict, ArduPilot makes it 1.
const PX4_TOLERANCE: f64 = 1e-5;
const ARDUPILOT_TOLERANCE: f64 = 1e-2;

/// Takes them as each autopilot does.
#[derive(Clone, Debug, Default)]
pub struct Vision {
    /// What has been said, by the message and the place of the reason.
    told: BTreeSet<(Estimate, usize)>,
}

/// Why nothing comes of a message, or of its attitude.
enum Nothing {
    ByPx4,
    Frames(String),
    Attitude,
    Refused(VisionRefusal),
}

impl Service for Vision {
    fn summary(&self) -> &'static str {
        "Positions, velocities and headings by motion capture and visual odometry"
    }

    fn messages(&self) -> &'static [u32] {
        Estimate::IDS
    }

    fn receive(&mut self, context: &mut Context, _origin: &Origin, frame: &Frame) {
        let Some(estimate) = Estimate::of_id(frame.message_id()) else { return };
        if let Err(nothing) = take(context, estimate, &frame.payload())
            && self.told.insert((estimate, nothing.place()))
        {
            let text = nothing.said(context, estimate);
            context.say(Severity::Warning, &text);
        }
    }
}

impl Nothing {
    /// A number for the reason.
    fn place(&self) -> usize {
        match self {
            Self::ByPx4 => 0,
            Self::Frames(_) => 1,
            Self::Attitude => 2,
            Self::Refused(VisionRefusal::IdealSensors) => 3,
            Self::Refused(VisionRefusal::NotUsed) => 4,
            Self::Refused(VisionRefusal::Impossible) => 5,
            Self::Refused(VisionRefusal::Poor { .. }) => 6,
        }
    }

    /// The reason with the remedy.
    fn said(&self, context: &Context, estimate: Estimate) -> String {
        let is_ardupilot = context.identity().is_ardupilot();
        let reason = match self {
            Self::ByPx4 => "as by PX4's estimator; send VISION_POSITION_ESTIMATE or ODOMETRY".to_owned(),
            Self::Frames(reason) => reason.clone(),
            Self::Attitude => {
                let name = estimate.name();
                return format!("The attitude of {name} is ignored: its quaternion must have the length 1");
            }
            Self::Refused(VisionRefusal::IdealSensors) => {
                "ideal sensors know the place; start with --sensors realistic".to_owned()
            }
            Self::Refused(VisionRefusal::NotUsed) if !is_ardupilot => {
                "set EKF2_EV_CTRL to fuse it (1 position, 2 height, 4 velocity, 8 heading)".to_owned()
            }
            Self::Refused(VisionRefusal::NotUsed)
                if context.vehicle.conduct().aiding.ardupilot.vision_kind == 0 =>
            {
                "set VISO_TYPE to 1 to fuse it".to_owned()
            }
            Self::Refused(VisionRefusal::NotUsed) => {
                "set EK3_SRC1_POSXY, VELXY, POSZ, VELZ or YAW to 6 to fuse it".to_owned()
            }
            Self::Refused(VisionRefusal::Impossible) => {
                "its numbers must be finite, at most 100 km and 200 m/s".to_owned()
            }
            Self::Refused(VisionRefusal::Poor { quality, least }) => {
                let name = if is_ardupilot { "VISO_QUAL_MIN" } else { "EKF2_EV_QMIN" };
                format!("quality {quality} % is below {name} = {least} %")
            }
        };
        format!("{} is ignored: {reason}", estimate.name())
    }
}

/// Hands an estimate to the vehicle.
fn take(context: &mut Context, estimate: Estimate, payload: &Payload<'_>) -> Result<(), Nothing> {
    let is_ardupilot = context.identity().is_ardupilot();
    if !is_ardupilot && !estimate.is_for_px4() {
        return Err(Nothing::ByPx4);
    }
    let reading = read(estimate, payload, is_ardupilot).map_err(Nothing::Frames)?;
    let is_empty = reading.position.is_none() && reading.velocity.is_none() && reading.attitude.is_none();
    if is_empty && context.vehicle.aiding().vision.is_some() {
        return Err(Nothing::Refused(VisionRefusal::Impossible));
    }
    context.vehicle.receive_vision(reading).map_err(Nothing::Refused)?;
    let uses_heading = context.vehicle.aiding().vision.is_some_and(|vision| vision.uses.heading);
    let lacks_attitude =
        estimate != Estimate::Speed && estimate != Estimate::Delta && reading.attitude.is_none();
    if uses_heading && lacks_attitude { Err(Nothing::Attitude) } else { Ok(()) }
}

/// What a message says.
fn read(estimate: Estimate, payload: &Payload<'_>, is_ardupilot: bool) -> Result<VisionReading, String> {
    match estimate {
        Estimate::Position | Estimate::GlobalPosition => Ok(pose::pose(payload, true)),
        Estimate::Vicon => Ok(pose::pose(payload, false)),
        Estimate::Speed => Ok(pose::speed(payload)),
        Estimate::Mocap => Ok(pose::mocap(payload, ARDUPILOT_TOLERANCE)),
        Estimate::Delta => Ok(pose::delta(payload)),
        Estimate::Odometry if is_ardupilot => odometry::by_ardupilot(payload, ARDUPILOT_TOLERANCE),
        Estimate::Odometry => odometry::by_px4(payload, PX4_TOLERANCE),
    }
}
