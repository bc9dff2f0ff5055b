//! Which messages a link gets, and how often.

use mavlink::dialects::common::{MESSAGE_INTERVAL_DATA, MavMessage};
use vehicle::TICK_US;

use super::{Destination, LinkProfile, Origin, telemetry};
use crate::autopilot::Autopilot;
use crate::codec::Frame;

/// A message that a link gets regularly.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Stream {
    message_id: u32,
    interval_us: u64,
    due_us: u64,
}

/// The messages of one link.
#[derive(Clone, Debug)]
pub struct Streams {
    profile: LinkProfile,
    streams: Vec<Stream>,
}

/// Hz for a ground-station link and for an onboard link; 0 is never.
const RATES: &[(u32, f64, f64)] = &[
    (1, 1.0, 5.0),     // SYS_STATUS
    (2, 1.0, 1.0),     // SYSTEM_TIME
    (24, 1.0, 5.0),    // GPS_RAW_INT
    (30, 15.0, 100.0), // ATTITUDE
    (31, 15.0, 50.0),  // ATTITUDE_QUATERNION
    (32, 10.0, 30.0),  // LOCAL_POSITION_NED
    (33, 5.0, 50.0),   // GLOBAL_POSITION_INT
    (36, 1.0, 10.0),   // SERVO_OUTPUT_RAW
    (42, 1.0, 1.0),    // MISSION_CURRENT
    (49, 0.1, 1.0),    // GPS_GLOBAL_ORIGIN
    (62, 2.0, 10.0),   // NAV_CONTROLLER_OUTPUT
    (74, 4.0, 10.0),   // VFR_HUD
    (83, 2.0, 10.0),   // ATTITUDE_TARGET
    (85, 2.0, 10.0),   // POSITION_TARGET_LOCAL_NED
    (105, 0.0, 50.0),  // HIGHRES_IMU
    (111, 0.0, 10.0),  // TIMESYNC
    (141, 1.0, 10.0),  // ALTITUDE
    (147, 0.5, 0.5),   // BATTERY_STATUS
    (162, 0.5, 1.0),   // FENCE_STATUS
    (230, 0.5, 1.0),   // ESTIMATOR_STATUS
    (241, 0.1, 0.5),   // VIBRATION
    (242, 0.5, 0.5),   // HOME_POSITION
    (245, 1.0, 5.0),   // EXTENDED_SYS_STATE
    (331, 0.0, 30.0),  // ODOMETRY
];

/// Messages of the groups of REQUEST_DATA_STREAM.
const GROUPS: &[(u8, &[u32])] = &[
    (1, &[24, 26, 27, 29]),           // RAW_SENSORS
    (2, &[1, 42, 62, 147, 242, 245]), // EXTENDED_STATUS
    (3, &[36]),                       // RC_CHANNELS
    (6, &[32, 33, 85]),               // POSITION
    (10, &[30, 31]),                  // EXTRA1
    (11, &[74]),                      // EXTRA2
    (12, &[141, 241]),                // EXTRA3
];

/// Longest interval, µs: what MESSAGE_INTERVAL can tell.
const LONGEST_US: u64 = i32::MAX as u64;

impl Streams {
    /// The rates of a profile.
    pub fn new(profile: LinkProfile) -> Self {
        let mut streams = Self { profile, streams: Vec::new() };
        for (message_id, ..) in RATES {
            streams.set(*message_id, streams.default_interval_us(*message_id), 0);
        }
        streams
    }

    fn default_interval_us(&self, message_id: u32) -> Option<u64> {
        let rate = RATES.iter().find(|(id, ..)| *id == message_id).map(|(_, ground, onboard)| match self
            .profile
        {
            LinkProfile::Ground => *ground,
            LinkProfile::Onboard => *onboard,
        })?;
        (rate > 0.0).then(|| (1e6 / rate).round() as u64)
    }

    /// Interval of a message, µs, if the link gets it.
    fn interval_us(&self, message_id: u32) -> Option<u64> {
        self.streams.iter().find(|stream| stream.message_id == message_id).map(|stream| stream.interval_us)
    }

    fn set(&mut self, message_id: u32, interval_us: Option<u64>, time_us: u64) {
        self.streams.retain(|stream| stream.message_id != message_id);
        if let Some(interval_us) = interval_us {
            let interval_us = interval_us.clamp(TICK_US, LONGEST_US);
            self.streams.push(Stream { message_id, interval_us, due_us: time_us });
        }
    }

    /// Messages that are due. Their times are multiples of the interval, so that a rate holds exactly on average.
    fn due(&mut self, time_us: u64, mut send: impl FnMut(u32)) {
        for stream in self.streams.iter_mut().filter(|stream| stream.due_us <= time_us) {
            send(stream.message_id);
            stream.due_us += stream.interval_us;
            if stream.due_us <= time_us {
                stream.due_us = time_us + stream.interval_us;
            }
        }
    }
}

/// Sends what is due on every link.
pub fn stream(autopilot: &mut Autopilot) {
    let time_us = autopilot.vehicle.time_us();
    let mut wanted = Vec::new();
    for (link, streams) in autopilot.streams.iter_mut().enumerate() {
        streams.due(time_us, |message_id| wanted.push((link, message_id)));
    }
    for (link, message_id) in wanted {
        if let Some(message) = telemetry::message(autopilot, message_id) {
            autopilot.send(Destination::Link(link), message);
        }
    }
}

/// MAV_CMD_SET_MESSAGE_INTERVAL on the sender's link: µs, 0 for the default, −1 for never. `false` if there is no such message.
pub fn set(autopilot: &mut Autopilot, origin: &Origin, message_id: u32, interval_us: f64) -> bool {
    if telemetry::message(autopilot, message_id).is_none() || interval_us.is_nan() {
        return false;
    }
    let time_us = autopilot.vehicle.time_us();
    let Some(streams) = autopilot.streams.get_mut(origin.peer.link) else { return false };
    let interval_us = if interval_us == 0.0 {
        streams.default_interval_us(message_id)
    } else {
        (interval_us > 0.0).then_some(interval_us as u64)
    };
    streams.set(message_id, interval_us, time_us);
    true
}

/// MAV_CMD_GET_MESSAGE_INTERVAL: MESSAGE_INTERVAL, 0 for a message that there is not, −1 for one that the link does not get.
pub fn get(autopilot: &mut Autopilot, origin: &Origin, message_id: u16) {
    let number = u32::from(message_id);
    let interval_us = if telemetry::message(autopilot, number).is_none() {
        0
    } else {
        let streams = autopilot.streams.get(origin.peer.link);
        streams.and_then(|streams| streams.interval_us(number)).map_or(-1, |interval_us| interval_us as i32)
    };
    let message = MavMessage::MESSAGE_INTERVAL(MESSAGE_INTERVAL_DATA { interval_us, message_id });
    autopilot.send(Destination::Peer(origin.peer), message);
}

/// REQUEST_DATA_STREAM, the old way.
pub fn request_data_stream(autopilot: &mut Autopilot, origin: &Origin, frame: &Frame) {
    let payload = frame.payload();
    let (rate_hz, group, start) = (payload.u16(0), payload.u8(4), payload.u8(5) != 0);
    let time_us = autopilot.vehicle.time_us();
    let Some(streams) = autopilot.streams.get_mut(origin.peer.link) else { return };
    let interval_us = (start && rate_hz > 0).then(|| 1_000_000 / u64::from(rate_hz));
    for (_, messages) in GROUPS.iter().filter(|(number, _)| group == 0 || group == *number) {
        for message_id in *messages {
            streams.set(*message_id, interval_us, time_us);
        }
    }
}
