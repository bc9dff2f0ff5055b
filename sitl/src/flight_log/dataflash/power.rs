//! Battery, radio, motors, and the program itself.

use super::field::{Field, field, instance};
use crate::flight_log::LogSource;

fn pulse_us(source: &LogSource<'_>, motor: usize) -> f64 {
    source.pulses_us().get(motor).copied().unwrap_or(0.0)
}

/// The battery.
pub const BAT: &[Field] = &[
    instance("Inst"),
    field("Volt", 'f', 'v', '0', |source| source.vehicle.battery().voltage_v()),
    field("VoltR", 'f', 'v', '0', |source| source.vehicle.battery().voltage_v()),
    field("Curr", 'f', 'A', '0', |source| source.vehicle.battery().current_a()),
    field("CurrTot", 'f', 'a', 'C', |source| source.vehicle.battery().drawn_ah() * 1e3),
    field("EnrgTot", 'f', 'X', '0', |source| source.vehicle.battery().energy_j() / 3600.0),
    field("Temp", 'c', 'O', 'B', |_| 0.0),
    field("Res", 'f', 'w', '0', |_| 0.0),
    field("RemPct", 'B', '%', '0', |source| (100.0 * source.vehicle.battery_remaining()).round()),
    field("H", 'B', '-', '-', |_| 1.0),
];

fn channel_us(source: &LogSource<'_>, channel: usize) -> f64 {
    let pulses = source.vehicle.pilot().pulses;
    pulses.and_then(|pulses| pulses.get(channel).copied()).map_or(0.0, f64::from)
}

/// Channels of the pilot's radio, µs.
pub const RCIN: &[Field] = &[
    field("C1", 'H', 'Y', '-', |source| channel_us(source, 0)),
    field("C2", 'H', 'Y', '-', |source| channel_us(source, 1)),
    field("C3", 'H', 'Y', '-', |source| channel_us(source, 2)),
    field("C4", 'H', 'Y', '-', |source| channel_us(source, 3)),
    field("C5", 'H', 'Y', '-', |source| channel_us(source, 4)),
    field("C6", 'H', 'Y', '-', |source| channel_us(source, 5)),
    field("C7", 'H', 'Y', '-', |source| channel_us(source, 6)),
    field("C8", 'H', 'Y', '-', |source| channel_us(source, 7)),
    field("C9", 'H', 'Y', '-', |source| channel_us(source, 8)),
    field("C10", 'H', 'Y', '-', |source| channel_us(source, 9)),
    field("C11", 'H', 'Y', '-', |source| channel_us(source, 10)),
    field("C12", 'H', 'Y', '-', |source| channel_us(source, 11)),
    field("C13", 'H', 'Y', '-', |source| channel_us(source, 12)),
    field("C14", 'H', 'Y', '-', |source| channel_us(source, 13)),
];

fn servo_us(source: &LogSource<'_>, output: usize) -> f64 {
    f64::from(source.vehicle.output_us(output))
}

/// Outputs of motors and servos, µs; 0 where nothing drives one.
pub const RCOU: &[Field] = &[
    field("C1", 'H', 'Y', '-', |source| pulse_us(source, 0)),
    field("C2", 'H', 'Y', '-', |source| pulse_us(source, 1)),
    field("C3", 'H', 'Y', '-', |source| pulse_us(source, 2)),
    field("C4", 'H', 'Y', '-', |source| pulse_us(source, 3)),
    field("C5", 'H', 'Y', '-', |source| servo_us(source, 5)),
    field("C6", 'H', 'Y', '-', |source| servo_us(source, 6)),
    field("C7", 'H', 'Y', '-', |source| servo_us(source, 7)),
    field("C8", 'H', 'Y', '-', |source| servo_us(source, 8)),
    field("C9", 'H', 'Y', '-', |source| servo_us(source, 9)),
    field("C10", 'H', 'Y', '-', |source| servo_us(source, 10)),
    field("C11", 'H', 'Y', '-', |source| servo_us(source, 11)),
    field("C12", 'H', 'Y', '-', |source| servo_us(source, 12)),
    field("C13", 'H', 'Y', '-', |source| servo_us(source, 13)),
    field("C14", 'H', 'Y', '-', |source| servo_us(source, 14)),
];

/// The mixer: nothing is compensated or limited by the battery.
pub const MOTB: &[Field] = &[
    field("LiftMax", 'f', '-', '-', |_| 1.0),
    field("BatVolt", 'f', '-', '-', |_| 1.0),
    field("ThLimit", 'f', '-', '-', |_| 1.0),
    field("ThrAvMx", 'f', '-', '-', |_| 1.0),
    field("FailFlags", 'B', '-', '-', |source| if source.vehicle.lost_rotor().is_some() { 1.0 } else { 2.0 }),
];

/// The simulation's loop: a thousand ticks a second, none of which is late.
pub const PM: &[Field] = &[
    field("LR", 'H', 'z', '-', |_| 1000.0),
    field("NLon", 'H', '-', '-', |_| 0.0),
    field("NL", 'H', '-', '-', |_| 1000.0),
    field("MaxT", 'I', 's', 'F', |_| 1000.0),
    field("Mem", 'I', 'b', '0', |_| 0.0),
    field("Load", 'H', '%', 'A', |_| 0.0),
    field("ErrL", 'H', '-', '-', |_| 0.0),
    field("IntE", 'I', '-', '-', |_| 0.0),
    field("ErrC", 'I', '-', '-', |_| 0.0),
    field("SPIC", 'I', '-', '-', |_| 0.0),
    field("I2CC", 'I', '-', '-', |_| 0.0),
    field("I2CI", 'I', '-', '-', |_| 0.0),
    field("Ex", 'I', 's', 'F', |_| 0.0),
];
