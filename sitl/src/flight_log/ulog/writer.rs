//! A log in ULog.

use autopilot::Autopilot;
use autopilot::service::version;
use vehicle::Severity;
use vehicle::parameters::Value;

use super::bytes::{self, Definitions};
use super::row::Row;
use super::topics::TOPICS;
use crate::flight_log::LogSource;
use crate::flight_log::format::LogWriter;

/// PX4's number of the meaning of topics: from 2 on, readers look for places of the GPS receiver in degrees.
const DATA_FORMAT: u32 = 2;
/// Bytes of the time at the front of a row.
const TIMESTAMP: usize = 8;

/// Writes topics, and remembers what it has written last of each.
#[derive(Debug)]
pub struct ULogWriter {
    last: Vec<Row>,
}

impl ULogWriter {
    /// Nothing is written yet.
    pub fn new() -> Self {
        Self { last: vec![Row::default(); TOPICS.len()] }
    }
}

impl LogWriter for ULogWriter {
    fn begin(&mut self, autopilot: &Autopilot, parameters: &[Value]) -> Vec<u8> {
        let mut definitions = Definitions::new(autopilot.vehicle().time_us());
        definitions.information("sys_name", "lmpc-sitl");
        definitions.information("ver_hw", "LMPC_SITL");
        definitions.information("ver_sw", concat!("lmpc-sitl ", env!("CARGO_PKG_VERSION")));
        definitions.number("ver_data_format", DATA_FORMAT);
        definitions.number("ver_sw_release", version());
        definitions.information("sys_uuid", &format!("lmpc-sitl-{:03}", autopilot.system_id()));
        for topic in TOPICS {
            definitions.topic(topic.name, &format!("uint64_t timestamp;{}", topic.fields));
        }
        for (entry, value) in autopilot.parameter_table().entries().iter().zip(parameters) {
            definitions.parameter(entry.id, *value);
        }
        definitions.finish()
    }

    fn parameter(&mut self, into: &mut Vec<u8>, _time_us: u64, id: &str, value: Value) {
        bytes::parameter(into, id, value);
    }

    fn text(&mut self, into: &mut Vec<u8>, time_us: u64, severity: Severity, line: &str) {
        bytes::text(into, severity.level(), time_us, line);
    }

    fn sample(&mut self, into: &mut Vec<u8>, source: &LogSource<'_>) {
        let time_us = source.vehicle.time_us();
        let mut row = Row::default();
        for ((number, topic), last) in (0..).zip(TOPICS).zip(&mut self.last) {
            let due = time_us.is_multiple_of(topic.period_us);
            // The first sample of all topics stands at the beginning.
            if !due && !topic.on_change && !last.0.is_empty() {
                continue;
            }
            row.0.clear();
            row.u64(time_us);
            (topic.sample)(source, &mut row);
            if due || last.0.get(TIMESTAMP..) != row.0.get(TIMESTAMP..) {
                bytes::data(into, number, &row.0);
                last.0.clone_from(&row.0);
            }
        }
    }

    fn mark(&self, into: &mut Vec<u8>, _time_us: u64, dropped_us: Option<u64>) {
        if let Some(dropped_us) = dropped_us {
            bytes::dropout(into, dropped_us / 1000);
        }
        bytes::sync(into);
    }
}
