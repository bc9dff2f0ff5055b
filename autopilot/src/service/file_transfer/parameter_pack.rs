//! ArduPilot's packed parameter file, which MAVProxy and mavlink tools read.
//!
//! Header: magic 0x671b, number of parameters, total number, each 16 bits. Then per parameter: a byte with the type,
//! a byte with the length of the name's beginning that is the previous name's (low half) and of its rest less one
//! (high half), the rest of the name, the value.

use crate::context::Context;
use vehicle::parameters::Value;

const MAGIC: u16 = 0x671b;
const INT32: u8 = 3;
const REAL32: u8 = 4;

/// All parameters, packed.
pub fn pack(context: &Context) -> Vec<u8> {
    let count = context.parameters.table().entries().len();
    let mut bytes = Vec::with_capacity(8 + 16 * count);
    for number in [MAGIC, count as u16, count as u16] {
        bytes.extend(number.to_le_bytes());
    }
    let mut previous = "";
    for index in 0..count {
        let Some(value) = context.parameters.value(index, &context.vehicle) else { continue };
        let Some(entry) = context.parameters.table().entries().get(index) else { continue };
        let name = entry.id;
        let shared = name.bytes().zip(previous.bytes()).take_while(|(one, other)| one == other).count();
        // The rest has at least one letter, and each half of the byte holds 15.
        let shared = shared.min(name.len().saturating_sub(1)).min(15);
        let rest = name.as_bytes().get(shared..).unwrap_or_default();
        bytes.push(match value {
            Value::Integer(_) => INT32,
            Value::Real(_) => REAL32,
        });
        bytes.push(shared as u8 | (rest.len().saturating_sub(1) as u8) << 4);
        bytes.extend(rest);
        bytes.extend(value.bytes());
        previous = name;
    }
    bytes
}
