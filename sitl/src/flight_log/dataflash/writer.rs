//! A log in DataFlash.

use autopilot::Autopilot;
use autopilot::service::version;
use vehicle::parameters::Value;
use vehicle::{Severity, Vehicle};

use super::bytes::{self, DESCRIBED, DSF};
use super::field::Field;
use super::happenings::Happenings;
use super::table::{MESSAGES, is_due_between};
use super::units::{MULTIPLIERS, UNITS};
use crate::flight_log::LogSource;
use crate::flight_log::format::LogWriter;

/// Readers find the numbers of ArduCopter's modes by this word. No version of it is claimed.
const INTRODUCTION: &str =
    concat!("lmpc-sitl ", env!("CARGO_PKG_VERSION"), " with conventions of ArduCopter");
/// Size of a block in the statistics of the log, bytes: nothing is written in blocks here.
const NO_BLOCKS: f64 = 0.0;

/// Writes messages as they are due, and happenings.
#[derive(Debug)]
pub struct DataFlashWriter {
    happenings: Happenings,
    begun: bool,
    /// Values at the start, by the names of the parameters.
    defaults: Vec<(&'static str, f32)>,
}

impl DataFlashWriter {
    /// Nothing is written yet.
    pub fn new() -> Self {
        Self { happenings: Happenings::new(), begun: false, defaults: Vec::new() }
    }
}

impl LogWriter for DataFlashWriter {
    fn begin(&mut self, autopilot: &Autopilot, parameters: &[Value]) -> Vec<u8> {
        let (mut all, time_us) = (Vec::new(), autopilot.vehicle().time_us());
        let described = DESCRIBED.map(|(number, name, kinds, labels, units, multipliers)| {
            (number, name, kinds.to_owned(), labels.to_owned(), units.to_owned(), multipliers.to_owned())
        });
        let regular = MESSAGES.iter().map(|message| {
            let kinds = message.letters('Q', |field| field.kind);
            let units = message.letters('s', |field| field.unit);
            let multipliers = message.letters('F', |field| field.multiplier);
            (message.number, message.name, kinds, message.labels(), units, multipliers)
        });
        let formats: Vec<_> = described.into_iter().chain(regular).collect();
        for (number, name, kinds, labels, ..) in &formats {
            bytes::format(&mut all, *number, name, kinds, labels);
        }
        for (letter, name) in UNITS {
            bytes::unit(&mut all, time_us, letter, name);
        }
        for (letter, factor) in MULTIPLIERS {
            bytes::multiplier(&mut all, time_us, letter, factor);
        }
        for (number, _, _, _, units, multipliers) in &formats {
            bytes::format_units(&mut all, time_us, *number, units, multipliers);
        }
        let [major, minor, patch, _] = version().to_be_bytes();
        bytes::version(&mut all, time_us, INTRODUCTION, [major, minor, patch]);
        bytes::message(&mut all, time_us, INTRODUCTION);
        let defaults = autopilot.initial_parameters().iter();
        let named = autopilot.parameter_table().entries().iter().zip(defaults);
        self.defaults = named.map(|(entry, value)| (entry.id, value.number() as f32)).collect();
        for ((name, default), value) in self.defaults.iter().zip(parameters) {
            bytes::parameter(&mut all, time_us, name, value.number() as f32, *default);
        }
        all
    }

    fn parameter(&mut self, into: &mut Vec<u8>, time_us: u64, id: &str, value: Value) {
        let default =
            self.defaults.iter().find(|(name, _)| *name == id).map_or(f32::NAN, |(_, value)| *value);
        bytes::parameter(into, time_us, id, value.number() as f32, default);
    }

    fn text(&mut self, into: &mut Vec<u8>, time_us: u64, _severity: Severity, line: &str) {
        bytes::message(into, time_us, line);
    }

    fn is_due_between(&self, vehicle: &Vehicle) -> bool {
        is_due_between(vehicle.time_us(), vehicle.conduct().log.bits)
    }

    fn sample(&mut self, into: &mut Vec<u8>, source: &LogSource<'_>) {
        let (time_us, bits) = (source.vehicle.time_us(), source.vehicle.conduct().log.bits);
        self.happenings.look(into, source);
        // The first sample of all messages stands at the beginning.
        let first = !std::mem::replace(&mut self.begun, true);
        for message in MESSAGES {
            let due = message.is_due(time_us, bits) || first && message.period_us(bits).is_some();
            if !due || !(message.applies)(source) {
                continue;
            }
            bytes::head(into, message.number);
            into.extend(time_us.to_le_bytes());
            for field in message.fields {
                Field::put(into, field.kind, (field.value)(source));
            }
        }
    }

    /// DSF counts what was dropped, ms; without a loss there is no mark.
    fn mark(&self, into: &mut Vec<u8>, time_us: u64, dropped_us: Option<u64>) {
        if let Some(dropped_us) = dropped_us {
            let dropped_ms = (dropped_us / 1000) as f64;
            let values = [time_us as f64, dropped_ms, NO_BLOCKS, 0.0, 0.0, 0.0, 0.0];
            bytes::numbers(into, DSF, "QIHIIII", &values);
        }
    }
}
