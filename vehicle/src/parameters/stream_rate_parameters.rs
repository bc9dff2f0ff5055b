//! ArduPilot's names of the rates of groups of messages.

use super::ConductParameter;
use super::conduct_parameter::whole;

/// The rate of a group on a link: the link, the end of the name, the field, what is shown until it is set, and what the group has.
macro_rules! rate {
    ($link:literal, $name:literal, $field:ident, $shown:literal, $what:literal) => {
        ConductParameter {
            id: concat!("SR", $link, "_", $name),
            get: |conduct| f64::from(conduct.stream_rates.0[$link].$field.unwrap_or($shown)),
            set: |conduct, value| {
                let whole = value.fract() == 0.0;
                if whole {
                    conduct.stream_rates.0[$link].$field = Some(value as u8);
                }
                whole
            },
            unit: "Hz",
            text: concat!(
                "Rate of ",
                $what,
                " on link ",
                $link,
                "; until it is first changed, each message has its own rate"
            ),
            ..whole!("", 0..=50, told_loops, u8, "")
        }
    };
}

macro_rules! link {
    ($link:literal, $shown:literal) => {
        [
            rate!($link, "RAW_SENS", raw_sensors, $shown, "inertial sensors and pressure"),
            rate!($link, "EXT_STAT", extended_status, $shown, "system status, GPS and mission"),
            rate!($link, "RC_CHAN", rc_channels, $shown, "radio and servos"),
            rate!($link, "POSITION", position, $shown, "position"),
            rate!($link, "EXTRA1", extra1, $shown, "attitude"),
            rate!($link, "EXTRA2", extra2, $shown, "speeds"),
            rate!($link, "EXTRA3", extra3, $shown, "estimator, battery and range finder"),
        ]
    };
}

/// Link by link. ArduPilot's simulation shows 4 Hz on its first link.
pub static STREAM_RATE_PARAMETERS: &[[ConductParameter; 7]] = &[link!(0, 4), link!(1, 0), link!(2, 0)];
