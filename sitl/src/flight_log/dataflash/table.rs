//! The messages that are written regularly.

use vehicle::TICK_US;

use super::estimates::{XKF1, XKF2, XKF3, XKF4};
use super::field::Field;
use super::motion::{ANG, ATT, CTUN, POS, PSCD, PSCE, PSCN, RATE, SIM};
use super::power::{BAT, MOTB, PM, RCIN, RCOU};
use super::sensors::{BARO, GPA, GPS, IMU, MAG, PL, PRX, PRXR, RFND, VIBE};
use crate::flight_log::LogSource;

/// Bits of LOG_BITMASK.
const ATTITUDE_FAST: u8 = 0;
const ATTITUDE_MEDIUM: u8 = 1;
const GPS_BIT: u8 = 2;
const PERFORMANCE: u8 = 3;
const CONTROL_TUNING: u8 = 4;
const NAVIGATION_TUNING: u8 = 5;
const RADIO: u8 = 6;
const INERTIAL: u8 = 7;
const CURRENT: u8 = 9;
const MOTOR_OUTPUT: u8 = 10;
const COMPASS: u8 = 13;
const MOTOR_BATTERY: u8 = 17;
const INERTIAL_FAST: u8 = 18;

/// Periods, µs. Those that are longer are multiples of the grid of the log; the shortest is that of ArduCopter's control loop.
const LOOP_US: u64 = 2_500;
const FAST_US: u64 = 10_000;
const INERTIAL_US: u64 = 40_000;
const MEDIUM_US: u64 = 100_000;
const RECEIVER_US: u64 = 200_000;
const SLOW_US: u64 = 1_000_000;

/// A message that is written regularly.
#[derive(Clone, Copy, Debug)]
pub struct Message {
    /// Its number in the log.
    pub number: u8,
    /// Its name: at most four letters.
    pub name: &'static str,
    /// Its fields behind `TimeUS`.
    pub fields: &'static [Field],
    /// How often it is written, µs, by the bits of LOG_BITMASK: the fastest that is set counts. Without bits it is always written.
    pub periods: &'static [(Option<u8>, u64)],
    /// Whether there is something to be written.
    pub applies: fn(&LogSource<'_>) -> bool,
}

impl Message {
    /// How often it is written with a value of LOG_BITMASK, µs.
    pub fn period_us(&self, bits: u32) -> Option<u64> {
        let set = |bit: &Option<u8>| bit.is_none_or(|bit| bits >> bit & 1 == 1);
        self.periods.iter().filter(|(bit, _)| set(bit)).map(|(_, period_us)| *period_us).min()
    }

    /// Whether it is due at a time, µs, with a value of LOG_BITMASK.
    pub fn is_due(&self, time_us: u64, bits: u32) -> bool {
        self.period_us(bits).is_some_and(|period_us| is_due(time_us, period_us))
    }

    /// A line of its description: a letter for the time, and those of its fields.
    pub fn letters(&self, first: char, of: fn(&Field) -> char) -> String {
        std::iter::once(first).chain(self.fields.iter().map(of)).collect()
    }

    /// Names of its fields.
    pub fn labels(&self) -> String {
        let names = self.fields.iter().map(|field| field.name);
        std::iter::once("TimeUS").chain(names).collect::<Vec<_>>().join(",")
    }
}

const fn message(
    number: u8,
    name: &'static str,
    fields: &'static [Field],
    periods: &'static [(Option<u8>, u64)],
) -> Message {
    Message { number, name, fields, periods, applies: |_| true }
}

impl Message {
    /// The same, which is written only where there is what it is of.
    const fn when(self, applies: fn(&LogSource<'_>) -> bool) -> Self {
        Self { applies, ..self }
    }
}

const ATTITUDE: &[(Option<u8>, u64)] = &[(Some(ATTITUDE_FAST), FAST_US), (Some(ATTITUDE_MEDIUM), MEDIUM_US)];
const CONTROL: &[(Option<u8>, u64)] = &[(Some(CONTROL_TUNING), MEDIUM_US)];
const NAVIGATION: &[(Option<u8>, u64)] = &[(Some(NAVIGATION_TUNING), MEDIUM_US)];
const RECEIVER: &[(Option<u8>, u64)] = &[(Some(GPS_BIT), RECEIVER_US)];
const ALWAYS: &[(Option<u8>, u64)] = &[(None, MEDIUM_US)];

/// All of them. Their numbers are ours: readers go by names.
pub static MESSAGES: &[Message] = &[
    message(1, "ATT", ATT, ATTITUDE),
    message(2, "RATE", RATE, ATTITUDE),
    message(3, "POS", POS, ALWAYS),
    message(4, "CTUN", CTUN, CONTROL),
    message(5, "PSCN", PSCN, NAVIGATION),
    message(6, "PSCE", PSCE, NAVIGATION),
    message(7, "PSCD", PSCD, NAVIGATION),
    message(8, "SIM", SIM, ALWAYS),
    message(9, "GPS", GPS, RECEIVER),
    message(10, "GPA", GPA, RECEIVER),
    message(11, "IMU", IMU, &[(Some(INERTIAL_FAST), FAST_US), (Some(INERTIAL), INERTIAL_US)]),
    message(12, "VIBE", VIBE, &[(Some(INERTIAL), MEDIUM_US)]),
    message(13, "BARO", BARO, ALWAYS),
    message(14, "MAG", MAG, &[(Some(COMPASS), MEDIUM_US)]),
    message(15, "BAT", BAT, &[(Some(CURRENT), MEDIUM_US)]),
    message(16, "RCOU", RCOU, &[(Some(MOTOR_OUTPUT), MEDIUM_US)]),
    message(17, "MOTB", MOTB, &[(Some(MOTOR_BATTERY), SLOW_US)]),
    message(18, "PM", PM, &[(Some(PERFORMANCE), SLOW_US)]),
    message(19, "XKF1", XKF1, ALWAYS),
    message(20, "XKF2", XKF2, ALWAYS),
    message(21, "XKF3", XKF3, ALWAYS),
    message(22, "XKF4", XKF4, ALWAYS),
    message(23, "RCIN", RCIN, &[(Some(RADIO), MEDIUM_US)]),
    message(24, "RFND", RFND, ALWAYS).when(|source| source.vehicle.has_rangefinder()),
    message(25, "PL", PL, ALWAYS).when(|source| source.vehicle.conduct().precision.enabled),
    message(26, "PRX", PRX, CONTROL).when(measures_around),
    message(27, "PRXR", PRXR, CONTROL)
        .when(|source| measures_around(source) && source.vehicle.conduct().log.proximity_raw),
    message(28, "ANG", ANG, &[(Some(ATTITUDE_FAST), LOOP_US), (Some(ATTITUDE_MEDIUM), MEDIUM_US)]),
];

fn measures_around(source: &LogSource<'_>) -> bool {
    source.vehicle.has_proximity() && source.vehicle.measures_around()
}

/// Whether something is due at a time, µs, between the times of the grid.
pub fn is_due_between(time_us: u64, bits: u32) -> bool {
    is_due(time_us, LOOP_US) && MESSAGES.iter().any(|message| message.period_us(bits) == Some(LOOP_US))
}

/// Whether a time, µs, is the first tick of a period, µs.
fn is_due(time_us: u64, period_us: u64) -> bool {
    time_us % period_us < TICK_US
}
