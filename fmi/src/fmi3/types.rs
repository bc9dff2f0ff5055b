//! The C types of `fmi3PlatformTypes.h` and `fmi3FunctionTypes.h`.

use std::ffi::{c_char, c_double, c_float, c_int, c_void};

/// `fmi3Instance`: an instance, opaque to the importer.
pub type Instance = *mut c_void;
/// `fmi3InstanceEnvironment`: the importer's own data, opaque to us.
pub type InstanceEnvironment = *mut c_void;
/// `fmi3FMUState`: a saved state, opaque to the importer.
pub type FmuState = *mut c_void;
/// `fmi3ValueReference`
pub type ValueReference = u32;
/// `fmi3Float32`
pub type Float32 = c_float;
/// `fmi3Float64`
pub type Float64 = c_double;
/// `fmi3Int8`
pub type Int8 = i8;
/// `fmi3UInt8`
pub type UInt8 = u8;
/// `fmi3Int16`
pub type Int16 = i16;
/// `fmi3UInt16`
pub type UInt16 = u16;
/// `fmi3Int32`
pub type Int32 = i32;
/// `fmi3UInt32`
pub type UInt32 = u32;
/// `fmi3Int64`, also of enumerations.
pub type Int64 = i64;
/// `fmi3UInt64`
pub type UInt64 = u64;
/// `fmi3Boolean`: the `bool` of C as a byte, so that no value that an importer passes is undefined behaviour. 0 is false, anything
/// else true.
pub type Boolean = u8;
/// `fmi3String`: UTF-8, ended by NUL.
pub type String = *const c_char;
/// `fmi3Byte`
pub type Byte = u8;
/// `fmi3Binary`
pub type Binary = *const Byte;
/// `fmi3Clock`: as [`Boolean`].
pub type Clock = u8;

/// `fmi3True`
pub const TRUE: Boolean = 1;
/// `fmi3False`
pub const FALSE: Boolean = 0;

/// `fmi3DependencyKind`, as the plain integer that C passes.
pub type DependencyKind = c_int;
/// `fmi3IntervalQualifier`, as the plain integer that C passes.
pub type IntervalQualifier = c_int;

/// `fmi3Status`
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum Status {
    /// Success.
    Ok = 0,
    /// A warning; the computation continues.
    Warning = 1,
    /// The call was not successful and changed nothing; another one may be.
    Discard = 2,
    /// The call was rejected, or the run failed.
    Error = 3,
    /// The instance can only be freed.
    Fatal = 4,
}

/// `fmi3LogMessageCallback`: environment, status, category, message.
pub type LogMessageCallback = unsafe extern "C" fn(InstanceEnvironment, Status, String, String);

/// `fmi3IntermediateUpdateCallback`. Never called: `providesIntermediateUpdate` is false.
pub type IntermediateUpdateCallback = unsafe extern "C" fn(
    InstanceEnvironment,
    Float64,
    Boolean,
    Boolean,
    Boolean,
    Boolean,
    *mut Boolean,
    *mut Float64,
);

/// `fmi3ClockUpdateCallback`. Never called: there is no scheduled execution.
pub type ClockUpdateCallback = unsafe extern "C" fn(InstanceEnvironment);
/// `fmi3LockPreemptionCallback` and `fmi3UnlockPreemptionCallback`. Never called.
pub type PreemptionCallback = unsafe extern "C" fn();
