//! ArduPilot's packed parameter file, which MAVProxy and mavlink tools read and write, and PX4's clients, too.
//!
//! Header: magic 0x671b, number of parameters, total number, each 16 bits. Then per parameter: a byte with the type,
//! a byte with the length of the name's beginning that is the previous name's (low half) and of its rest less one
//! (high half), the rest of the name, the value. A bit of the type's byte says that the default follows the value. What is written has the
//! length of the file in place of the total number.

use crate::codec::Payload;
use crate::context::Context;
use vehicle::parameters::Value;

/// The file, as a plain path.
pub const PATH: &str = "@PARAM/param.pck";
/// Bytes of the largest file that is taken.
pub const LARGEST: usize = 1 << 17;

const MAGIC: u16 = 0x671b;
/// The same with defaults.
const MAGIC_WITH_DEFAULTS: u16 = 0x671c;
const HEADER: usize = 6;
const HAS_DEFAULT: u8 = 1 << 4;
const INT8: u8 = 1;
const INT16: u8 = 2;
const INT32: u8 = 3;
const REAL32: u8 = 4;

/// What a client asks for behind a question mark, as ArduPilot's do: `?withdefaults=1&start=100&count=50`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Extent {
    with_defaults: bool,
    start: usize,
    count: usize,
}

impl Extent {
    /// All parameters, without defaults.
    pub const ALL: Self = Self { with_defaults: false, start: 0, count: usize::MAX };

    /// What options ask for, up to one that is not known or is not a number.
    pub fn read(options: &str) -> Self {
        let mut extent = Self::ALL;
        for option in options.split('&') {
            let Some((name, Ok(number))) = option.split_once('=').map(|(name, text)| (name, text.parse()))
            else {
                break;
            };
            match name {
                "withdefaults" => extent.with_defaults = number != 0,
                "start" => extent.start = number,
                "count" => extent.count = number,
                _ => break,
            }
        }
        extent
    }
}

/// Parameters, packed. A default is what the vehicle was started with; it follows the value where the two differ.
pub fn pack(context: &Context, extent: Extent) -> Vec<u8> {
    let total = context.parameters.table().entries().len();
    let numbers = extent.start.min(total)..extent.start.saturating_add(extent.count).min(total);
    let mut bytes = Vec::with_capacity(8 + 16 * numbers.len());
    let magic = if extent.with_defaults { MAGIC_WITH_DEFAULTS } else { MAGIC };
    for number in [magic, numbers.len() as u16, total as u16] {
        bytes.extend(number.to_le_bytes());
    }
    let mut previous = "";
    for index in numbers {
        let Some(value) = context.parameters.value(index, &context.vehicle) else { continue };
        let Some(entry) = context.parameters.table().entries().get(index) else { continue };
        let initial = context.parameters.initial().get(index);
        let default = initial.filter(|initial| extent.with_defaults && **initial != value);
        let name = entry.id;
        let shared = name.bytes().zip(previous.bytes()).take_while(|(one, other)| one == other).count();
        // The rest has at least one letter, and each half of the byte holds 15.
        let shared = shared.min(name.len().saturating_sub(1)).min(15);
        let rest = name.as_bytes().get(shared..).unwrap_or_default();
        let kind = match value {
            Value::Integer(_) => INT32,
            Value::Real(_) => REAL32,
        };
        bytes.push(if default.is_some() { kind | HAS_DEFAULT } else { kind });
        bytes.push(shared as u8 | (rest.len().saturating_sub(1) as u8) << 4);
        bytes.extend(rest);
        bytes.extend(value.bytes());
        bytes.extend(default.iter().flat_map(|default| default.bytes()));
        previous = name;
    }
    bytes
}

/// Names and values of a packed file, unchecked.
///
/// # Errors
/// What is wrong with the file.
pub fn unpack(bytes: &[u8]) -> Result<Vec<(String, f64)>, String> {
    let header = Payload::new(bytes);
    let (magic, count) = (header.u16(0), usize::from(header.u16(2)));
    if magic != MAGIC && magic != MAGIC_WITH_DEFAULTS {
        return Err(format!(
            "it begins with {magic:#06x}, not with {MAGIC:#06x} or {MAGIC_WITH_DEFAULTS:#06x}"
        ));
    }
    let mut rest = bytes.get(HEADER..).unwrap_or_default();
    let (mut values, mut previous) = (Vec::new(), Vec::new());
    while values.len() < count {
        // Zeros fill up blocks.
        if let Some((0, filled)) = rest.split_first() {
            rest = filled;
            continue;
        }
        let number = values.len() + 1;
        let (name, value, left) = unpack_one(rest, &previous)
            .ok_or(format!("parameter {number} of {count} is cut off or wrong"))?;
        rest = left;
        values.push((String::from_utf8_lossy(&name).into_owned(), value));
        previous = name;
    }
    Ok(values)
}

/// The next parameter: name, value, and what follows.
fn unpack_one<'a>(bytes: &'a [u8], previous: &[u8]) -> Option<(Vec<u8>, f64, &'a [u8])> {
    let (&[kind, lengths], rest) = bytes.split_first_chunk()?;
    let (fresh, rest) = rest.split_at_checked(usize::from(lengths >> 4) + 1)?;
    let name = [previous.get(..usize::from(lengths & 0xf))?, fresh].concat();
    let (value, size) = match kind & 0xf {
        INT8 => (f64::from(i8::from_le_bytes(*rest.first_chunk()?)), 1),
        INT16 => (f64::from(i16::from_le_bytes(*rest.first_chunk()?)), 2),
        INT32 => (f64::from(i32::from_le_bytes(*rest.first_chunk()?)), 4),
        REAL32 => (f64::from(f32::from_le_bytes(*rest.first_chunk()?)), 4),
        _ => return None,
    };
    let default = if kind & HAS_DEFAULT != 0 { size } else { 0 };
    Some((name, value, rest.get(size + default..)?))
}
