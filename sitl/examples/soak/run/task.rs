//! One thing that a client does, with the retries of its protocol.

use std::collections::BTreeMap;
use std::rc::Rc;

use autopilot::Autopilot;
use mavlink::dialects::ardupilotmega::{
    MISSION_ACK_DATA, MISSION_COUNT_DATA, MISSION_ITEM_INT_DATA, MISSION_REQUEST_INT_DATA,
    MISSION_REQUEST_LIST_DATA, MavFrame, MavMessage, MavMissionResult, MavMissionType, MavParamType,
    PARAM_REQUEST_LIST_DATA, PARAM_REQUEST_READ_DATA, PARAM_SET_DATA, PositionTargetTypemask,
    SET_POSITION_TARGET_LOCAL_NED_DATA,
};
use nalgebra::Vector3;
use vehicle::LandedState;
use vehicle::estimation::SensorModel;

use super::figures::Figures;

/// What to do.
pub enum Step {
    Pause {
        for_us: u64,
    },
    Command {
        number: u16,
        message: Box<MavMessage>,
    },
    /// Wait until it flies.
    Airborne,
    /// Wait until it has landed and is disarmed.
    Landed,
    Stream {
        goal: [f64; 3],
        for_us: u64,
    },
    /// Wait until it has passed all of these places in turn, has landed and is disarmed.
    Mission {
        places: Vec<[f64; 3]>,
    },
    ReadParameters,
    SetParameter {
        name: &'static str,
        value: f32,
    },
    Upload(Vec<MISSION_ITEM_INT_DATA>),
    Download,
}

/// How it ended.
pub enum Outcome {
    Done,
    /// Something in the way of what follows; nobody's fault.
    Dropped,
    Failed(String),
}

/// A request without an answer is repeated after this, µs, so many times.
const RETRY_US: u64 = 500_000;
const TRIES: u32 = 10;
/// A whole transfer of a plan or of all parameters, and a takeoff, end within this, µs.
const TRANSFER_US: u64 = 60_000_000;
const TAKEOFF_US: u64 = 40_000_000;
/// A way home and a landing, µs.
const LANDING_US: u64 = 240_000_000;
const STREAM_US: u64 = 50_000;
/// A mission that was started has taken off within this, µs, and has ended within that.
const BEGINS_US: u64 = 15_000_000;
const MISSION_US: u64 = 500_000_000;
/// A waypoint was passed nearer than this, m: its acceptance radius, and what gusts or the receiver do to it.
const PASSED_M: f64 = 2.0;
const PASSED_BY_INSTRUMENTS_M: f64 = 14.0;

pub struct Task {
    pub step: Rc<Step>,
    began_us: u64,
    due_us: u64,
    tries: u32,
    values: BTreeMap<u16, String>,
    count: Option<u16>,
    items: Vec<MISSION_ITEM_INT_DATA>,
    passed: usize,
}

/// What a task may look at, and where it leaves what it wants to send.
pub struct Surroundings<'a> {
    pub now_us: u64,
    pub autopilot: &'a Autopilot,
    pub heard: &'a [MavMessage],
    /// The mission that the vehicle should have, if that is known.
    pub mission: &'a mut Option<Vec<MISSION_ITEM_INT_DATA>>,
    pub out: &'a mut Vec<MavMessage>,
    pub figures: &'a mut Figures,
}

impl Task {
    pub fn new(step: Step, now_us: u64) -> Self {
        let (values, items) = (BTreeMap::new(), Vec::new());
        Self {
            step: Rc::new(step),
            began_us: now_us,
            due_us: now_us,
            tries: 0,
            values,
            count: None,
            items,
            passed: 0,
        }
    }

    /// A moment of it; `None` while it goes on.
    pub fn go_on(&mut self, with: &mut Surroundings<'_>) -> Option<Outcome> {
        let elapsed_us = with.now_us - self.began_us;
        let step = Rc::clone(&self.step);
        match &*step {
            Step::Pause { for_us } => (elapsed_us >= *for_us).then_some(Outcome::Done),
            Step::Command { number, message } => self.command(*number, message, with),
            Step::Airborne => airborne(elapsed_us, with),
            Step::Landed => landed(elapsed_us, with),
            Step::Stream { goal, for_us } => {
                if with.now_us >= self.due_us {
                    self.due_us = with.now_us + STREAM_US;
                    with.out.push(set_point(*goal, with.autopilot.system_id()));
                }
                (elapsed_us >= *for_us).then_some(Outcome::Done)
            }
            Step::Mission { places } => self.mission(places, elapsed_us, with),
            Step::ReadParameters => self.read_parameters(with),
            Step::SetParameter { name, value } => self.set_parameter(name, *value, with),
            Step::Upload(items) => self.upload(items, with),
            Step::Download => self.download(with),
        }
    }

    /// Whether a request is due again; it has been asked for too often if that fails.
    fn is_due(&mut self, now_us: u64, what: &str) -> Result<bool, Outcome> {
        if now_us < self.due_us {
            return Ok(false);
        }
        self.tries += 1;
        self.due_us = now_us + RETRY_US;
        if self.tries > TRIES {
            return Err(Outcome::Failed(format!("{what} was not answered in {TRIES} times")));
        }
        Ok(true)
    }

    fn command(&mut self, number: u16, message: &MavMessage, with: &mut Surroundings<'_>) -> Option<Outcome> {
        const ACCEPTED: u8 = 0;
        const TEMPORARILY_REJECTED: u8 = 1;
        const IN_PROGRESS: u8 = 5;
        for heard in with.heard {
            let MavMessage::COMMAND_ACK(ack) = heard else { continue };
            let result = ack.result as u8;
            if ack.command as u32 != u32::from(number) || result == IN_PROGRESS {
                continue;
            }
            *with.figures.commands.entry((number, result)).or_default() += 1;
            return Some(match result {
                ACCEPTED => Outcome::Done,
                TEMPORARILY_REJECTED => Outcome::Dropped,
                // All of them are valid.
                _ => Outcome::Failed(format!("command {number} was answered by {:?}", ack.result)),
            });
        }
        match self.is_due(with.now_us, &format!("command {number}")) {
            Err(failed) => return Some(failed),
            Ok(false) => {}
            Ok(true) => {
                let mut message = message.clone();
                if let MavMessage::COMMAND_LONG(long) = &mut message {
                    long.confirmation = (self.tries - 1) as u8;
                }
                with.out.push(message);
            }
        }
        None
    }

    fn mission(
        &mut self,
        places: &[[f64; 3]],
        elapsed_us: u64,
        with: &mut Surroundings<'_>,
    ) -> Option<Outcome> {
        let vehicle = with.autopilot.vehicle();
        let realistic = with.autopilot.settings().sensors.model == SensorModel::Realistic;
        let near_m = if realistic { PASSED_BY_INSTRUMENTS_M } else { PASSED_M };
        if let Some(place) = places.get(self.passed) {
            let away = vehicle.truth().position_m - Vector3::from(*place);
            self.passed += usize::from(away.norm() < near_m);
        }
        let down = vehicle.landed_state() == LandedState::OnGround && !vehicle.is_armed();
        if down && self.passed == places.len() {
            with.figures.missions += 1;
            return Some(Outcome::Done);
        }
        let late = format!("{:?}: passed {} of {} waypoints", vehicle.mode(), self.passed, places.len());
        let dropped = down && (self.passed > 0 || elapsed_us > BEGINS_US);
        (dropped || elapsed_us > MISSION_US).then_some(Outcome::Failed(late))
    }

    fn read_parameters(&mut self, with: &mut Surroundings<'_>) -> Option<Outcome> {
        let (target_system, target_component) = (with.autopilot.system_id(), 1);
        for heard in with.heard {
            let MavMessage::PARAM_VALUE(value) = heard else { continue };
            if value.param_index != u16::MAX {
                self.count = Some(value.param_count);
                self.values.insert(value.param_index, value.param_id.to_str().unwrap_or("?").to_owned());
                self.due_us = with.now_us + RETRY_US;
            }
        }
        if self.count.is_some_and(|count| self.values.len() == usize::from(count)) {
            let table = with.autopilot.parameter_table().entries();
            let right = table.iter().zip(self.values.values()).all(|(entry, name)| entry.id == name.as_str());
            with.figures.parameter_lists += 1;
            return Some(if right && table.len() == self.values.len() {
                Outcome::Done
            } else {
                Outcome::Failed("the list of parameters is not the vehicle's".to_owned())
            });
        }
        if with.now_us - self.began_us > TRANSFER_US {
            return Some(Outcome::Failed(format!("{} parameters in a minute", self.values.len())));
        }
        if with.now_us >= self.due_us {
            self.due_us = with.now_us + RETRY_US;
            match self.count {
                None => with.out.push(MavMessage::PARAM_REQUEST_LIST(PARAM_REQUEST_LIST_DATA {
                    target_system,
                    target_component,
                })),
                Some(count) => {
                    for index in (0..count).filter(|index| !self.values.contains_key(index)) {
                        with.out.push(MavMessage::PARAM_REQUEST_READ(PARAM_REQUEST_READ_DATA {
                            param_index: index as i16,
                            target_system,
                            target_component,
                            ..PARAM_REQUEST_READ_DATA::default()
                        }));
                    }
                }
            }
        }
        None
    }

    fn set_parameter(
        &mut self,
        name: &'static str,
        value: f32,
        with: &mut Surroundings<'_>,
    ) -> Option<Outcome> {
        for heard in with.heard {
            let MavMessage::PARAM_VALUE(told) = heard else { continue };
            if told.param_id.to_str() == Ok(name) && told.param_value == value {
                with.figures.parameters_set += 1;
                return Some(Outcome::Done);
            }
        }
        match self.is_due(with.now_us, name) {
            Err(failed) => return Some(failed),
            Ok(false) => {}
            Ok(true) => with.out.push(MavMessage::PARAM_SET(PARAM_SET_DATA {
                param_value: value,
                target_system: with.autopilot.system_id(),
                target_component: 1,
                param_id: name.into(),
                param_type: MavParamType::MAV_PARAM_TYPE_REAL32,
            })),
        }
        None
    }

    /// MISSION_COUNT, then each item that is asked for, until MISSION_ACK.
    #[allow(deprecated)] // The vehicle may fall back to the older request.
    fn upload(&mut self, items: &[MISSION_ITEM_INT_DATA], with: &mut Surroundings<'_>) -> Option<Outcome> {
        for heard in with.heard {
            let wanted = match heard {
                MavMessage::MISSION_REQUEST_INT(request) => request.seq,
                MavMessage::MISSION_REQUEST(request) => request.seq,
                // A pilot who has left in the middle of an upload is still waited for.
                MavMessage::MISSION_ACK(ack)
                    if self.count.is_none()
                        && ack.mavtype == MavMissionResult::MAV_MISSION_DENIED
                        && with.now_us - self.began_us < TRANSFER_US =>
                {
                    self.tries = 0;
                    continue;
                }
                MavMessage::MISSION_ACK(ack) if usize::from(self.count.unwrap_or(0)) == items.len() => {
                    if ack.mavtype != MavMissionResult::MAV_MISSION_ACCEPTED {
                        return Some(Outcome::Failed(format!("mission refused: {:?}", ack.mavtype)));
                    }
                    *with.mission = Some(items.to_vec());
                    with.figures.uploads += 1;
                    return Some(Outcome::Done);
                }
                _ => continue,
            };
            let Some(item) = items.get(usize::from(wanted)) else { continue };
            // What it has now is neither the old mission nor the new one, until it says so.
            *with.mission = None;
            self.count = self.count.max(Some(wanted + 1));
            self.due_us = with.now_us + 20 * RETRY_US;
            with.out.push(MavMessage::MISSION_ITEM_INT(item.clone()));
        }
        match self.is_due(with.now_us, "the upload of a mission") {
            Err(failed) => return Some(failed),
            Ok(false) => {}
            Ok(true) => with.out.push(MavMessage::MISSION_COUNT(MISSION_COUNT_DATA {
                count: items.len() as u16,
                target_system: with.autopilot.system_id(),
                target_component: 1,
                ..MISSION_COUNT_DATA::default()
            })),
        }
        None
    }

    /// MISSION_REQUEST_LIST, each item in turn, MISSION_ACK; what comes is compared with what was uploaded.
    fn download(&mut self, with: &mut Surroundings<'_>) -> Option<Outcome> {
        let (target_system, target_component) = (with.autopilot.system_id(), 1);
        for heard in with.heard {
            match heard {
                MavMessage::MISSION_COUNT(count) if self.count.is_none() => {
                    self.count = Some(count.count);
                    (self.tries, self.due_us) = (0, with.now_us);
                }
                MavMessage::MISSION_ITEM_INT(item) if usize::from(item.seq) == self.items.len() => {
                    self.items.push(item.clone());
                    (self.tries, self.due_us) = (0, with.now_us);
                }
                _ => {}
            }
        }
        if self.count.is_some_and(|count| usize::from(count) == self.items.len()) {
            with.out.push(MavMessage::MISSION_ACK(MISSION_ACK_DATA {
                target_system,
                target_component,
                mavtype: MavMissionResult::MAV_MISSION_ACCEPTED,
                mission_type: MavMissionType::MAV_MISSION_TYPE_MISSION,
                ..MISSION_ACK_DATA::default()
            }));
            with.figures.downloads += 1;
            let place = |item: &MISSION_ITEM_INT_DATA| (item.command, item.x, item.y, item.z.to_bits());
            let differs = with.mission.as_ref().is_some_and(|mission| {
                mission.len() != self.items.len()
                    || mission.iter().zip(&self.items).any(|(one, other)| place(one) != place(other))
            });
            return Some(if differs {
                Outcome::Failed("the mission came back another".to_owned())
            } else {
                Outcome::Done
            });
        }
        match self.is_due(with.now_us, "the download of a mission") {
            Err(failed) => return Some(failed),
            Ok(false) => {}
            Ok(true) if self.count.is_none() => {
                with.out.push(MavMessage::MISSION_REQUEST_LIST(MISSION_REQUEST_LIST_DATA {
                    target_system,
                    target_component,
                    ..MISSION_REQUEST_LIST_DATA::default()
                }));
            }
            Ok(true) => with.out.push(MavMessage::MISSION_REQUEST_INT(MISSION_REQUEST_INT_DATA {
                seq: self.items.len() as u16,
                target_system,
                target_component,
                ..MISSION_REQUEST_INT_DATA::default()
            })),
        }
        None
    }
}

fn airborne(elapsed_us: u64, with: &Surroundings<'_>) -> Option<Outcome> {
    let vehicle = with.autopilot.vehicle();
    match vehicle.landed_state() {
        LandedState::InAir => Some(Outcome::Done),
        // It was armed by somebody before and has given up waiting, or never was.
        LandedState::OnGround if !vehicle.is_armed() && elapsed_us > 2_000_000 => Some(Outcome::Dropped),
        _ if elapsed_us > TAKEOFF_US => Some(Outcome::Failed("armed, but not in the air".to_owned())),
        _ => None,
    }
}

fn landed(elapsed_us: u64, with: &mut Surroundings<'_>) -> Option<Outcome> {
    let vehicle = with.autopilot.vehicle();
    if vehicle.landed_state() == LandedState::OnGround && !vehicle.is_armed() {
        with.figures.flights += 1;
        return Some(Outcome::Done);
    }
    let late = format!("not landed in {:?}, {:.1} m high", vehicle.mode(), -vehicle.outputs().position_m.z);
    (elapsed_us > LANDING_US).then_some(Outcome::Failed(late))
}

fn set_point([x, y, z]: [f64; 3], target_system: u8) -> MavMessage {
    MavMessage::SET_POSITION_TARGET_LOCAL_NED(SET_POSITION_TARGET_LOCAL_NED_DATA {
        target_system,
        target_component: 1,
        coordinate_frame: MavFrame::MAV_FRAME_LOCAL_NED,
        type_mask: PositionTargetTypemask::from_bits_retain(0b1101_1111_1000),
        x: x as f32,
        y: y as f32,
        z: z as f32,
        ..SET_POSITION_TARGET_LOCAL_NED_DATA::default()
    })
}
