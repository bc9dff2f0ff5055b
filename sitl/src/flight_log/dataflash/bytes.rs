//! The bytes of DataFlash logs: messages of a fixed length behind a head of three bytes.

use super::field::Field;

/// Marks the begin of a message.
const HEAD: [u8; 2] = [0xa3, 0x95];
/// Bytes of the head with the number of the message.
pub const HEAD_BYTES: usize = 3;

/// Numbers of the messages that describe others and of those that are written when something happens. FMT's is fixed by the format.
pub const FMT: u8 = 128;
pub const PARM: u8 = 32;
pub const MSG: u8 = 35;
pub const CMD: u8 = 45;
pub const FMTU: u8 = 64;
pub const UNIT: u8 = 65;
pub const MULT: u8 = 66;
pub const MODE: u8 = 68;
pub const EV: u8 = 140;
pub const ERR: u8 = 142;
pub const ARM: u8 = 144;
pub const ORGN: u8 = 150;
pub const DSF: u8 = 136;
pub const VER: u8 = 152;
pub const CAM: u8 = 154;

/// A message that is no row of numbers: its number, name, types, labels, units and multipliers.
pub type Described = (u8, &'static str, &'static str, &'static str, &'static str, &'static str);

/// Those messages.
pub const DESCRIBED: [Described; 15] = [
    (FMT, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns", "-b---", "-----"),
    (UNIT, "UNIT", "QbZ", "TimeUS,Id,Label", "s--", "F--"),
    (FMTU, "FMTU", "QBNN", "TimeUS,FmtType,UnitIds,MultIds", "s---", "F---"),
    (MULT, "MULT", "Qbd", "TimeUS,Id,Mult", "s--", "F--"),
    (PARM, "PARM", "QNff", "TimeUS,Name,Value,Default", "s---", "F---"),
    (MSG, "MSG", "QZ", "TimeUS,Message", "s-", "F-"),
    (MODE, "MODE", "QMBB", "TimeUS,Mode,ModeNum,Rsn", "s---", "F---"),
    (EV, "EV", "QB", "TimeUS,Id", "s-", "F-"),
    (ERR, "ERR", "QBB", "TimeUS,Subsys,ECode", "s--", "F--"),
    (ARM, "ARM", "QBIBB", "TimeUS,ArmState,ArmChecks,Forced,Method", "s----", "F----"),
    (ORGN, "ORGN", "QBLLe", "TimeUS,Type,Lat,Lng,Alt", "s-DUm", "F-GGB"),
    (
        CMD,
        "CMD",
        "QHHHffffLLfB",
        "TimeUS,CTot,CNum,CId,Prm1,Prm2,Prm3,Prm4,Lat,Lng,Alt,Frame",
        "s-------DUm-",
        "F-------GG0-",
    ),
    (
        VER,
        "VER",
        "QBHBBBBIZHBBII",
        "TimeUS,BT,BST,Maj,Min,Pat,FWT,GH,FWS,APJ,BU,FV,IMI,ICI",
        "s-------------",
        "F-------------",
    ),
    (
        CAM,
        "CAM",
        CAM_KINDS,
        "TimeUS,I,Img,GPSTime,GPSWeek,Lat,Lng,Alt,RelAlt,GPSAlt,R,P,Y",
        "s#---DUmmmddd",
        "F----GGBBB000",
    ),
    (DSF, "DSF", "QIHIIII", "TimeUS,Dp,Blk,Bytes,FMn,FMx,FAv", "s--b---", "F--0---"),
];

/// Types of CAM.
pub const CAM_KINDS: &str = "QBHIHLLeeefff";

/// Begins a message.
pub fn head(into: &mut Vec<u8>, number: u8) {
    into.extend(HEAD);
    into.push(number);
}

/// Appends a text that fills `room` bytes: cut, or padded with zeros.
pub fn text(into: &mut Vec<u8>, text: &str, room: usize) {
    let bytes = text.bytes().chain(std::iter::repeat(0));
    into.extend(bytes.take(room));
}

/// A message of numbers: their types and values.
pub fn numbers(into: &mut Vec<u8>, number: u8, kinds: &str, values: &[f64]) {
    head(into, number);
    for (kind, value) in kinds.chars().zip(values) {
        Field::put(into, kind, *value);
    }
}

/// FMT: the shape of a message.
pub fn format(into: &mut Vec<u8>, number: u8, name: &str, kinds: &str, labels: &str) {
    let length = HEAD_BYTES + kinds.chars().map(Field::size).sum::<usize>();
    head(into, FMT);
    into.extend([number, length as u8]);
    text(into, name, 4);
    text(into, kinds, 16);
    text(into, labels, 64);
}

/// FMTU: units and multipliers of its fields.
pub fn format_units(into: &mut Vec<u8>, time_us: u64, number: u8, units: &str, multipliers: &str) {
    head(into, FMTU);
    into.extend(time_us.to_le_bytes());
    into.push(number);
    text(into, units, 16);
    text(into, multipliers, 16);
}

/// UNIT: what a letter stands for.
pub fn unit(into: &mut Vec<u8>, time_us: u64, letter: char, name: &str) {
    head(into, UNIT);
    into.extend(time_us.to_le_bytes());
    into.push(letter as u8);
    text(into, name, 64);
}

/// MULT: what a letter stands for.
pub fn multiplier(into: &mut Vec<u8>, time_us: u64, letter: char, factor: f64) {
    head(into, MULT);
    into.extend(time_us.to_le_bytes());
    into.push(letter as u8);
    into.extend(factor.to_le_bytes());
}

/// PARM: a parameter with its value and its default.
pub fn parameter(into: &mut Vec<u8>, time_us: u64, name: &str, value: f32, default: f32) {
    head(into, PARM);
    into.extend(time_us.to_le_bytes());
    text(into, name, 16);
    into.extend(value.to_le_bytes());
    into.extend(default.to_le_bytes());
}

/// VER: who has written the log. `version` are its numbers, major first; readers take ArduCopter's modes by the last but three fields.
pub fn version(into: &mut Vec<u8>, time_us: u64, name: &str, version: [u8; 3]) {
    const SIMULATION: u8 = 3;
    const COPTER: u8 = 2;
    head(into, VER);
    into.extend(time_us.to_le_bytes());
    into.push(SIMULATION);
    into.extend([0, 0]);
    into.extend(version);
    // No kind of release, and no commit of ArduPilot.
    into.extend([0; 5]);
    text(into, name, 64);
    into.extend([0, 0, COPTER, 0]);
    into.extend([0; 8]);
}

/// MSG: lines of at most 64 bytes.
pub fn message(into: &mut Vec<u8>, time_us: u64, line: &str) {
    const ROOM: usize = 64;
    let mut rest = line;
    loop {
        let cut = (0..=rest.len().min(ROOM)).rev().find(|at| rest.is_char_boundary(*at)).unwrap_or(0);
        let (piece, behind) = rest.split_at(cut);
        head(into, MSG);
        into.extend(time_us.to_le_bytes());
        text(into, piece, ROOM);
        if behind.is_empty() || cut == 0 {
            return;
        }
        rest = behind;
    }
}
