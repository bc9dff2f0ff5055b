//! What can be asked of the equipment.

use nalgebra::Vector3;

use super::camera::CameraMode;
use super::lens::Drive;
use super::mount::GimbalMode;
use super::parachute::ParachuteOrder;
use super::trigger::Oblique;

/// How a relay is switched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Switch {
    /// On.
    On,
    /// Off.
    Off,
    /// To the other state.
    Toggle,
}

/// Where the gimbal is to point, or how fast it is to turn. What is `None` stays as it is.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Pointing {
    /// Angle to the horizon, rad.
    pub roll_rad: Option<f64>,
    /// Angle to the horizon, rad, positive up.
    pub pitch_rad: Option<f64>,
    /// Angle from the nose, or from north where the yaw is locked, rad.
    pub yaw_rad: Option<f64>,
    /// Rate, rad/s; without an angle it turns on and on.
    pub pitch_rate_rad_s: Option<f64>,
    /// Rate, rad/s; without an angle it turns on and on.
    pub yaw_rate_rad_s: Option<f64>,
    /// Whether the yaw is kept from north, or follows the nose.
    pub yaw_lock: bool,
}

/// What can be asked of the equipment.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)] // The sentences of the variants name their fields.
pub enum Operation {
    /// Moves a servo, counted from 1, to a pulse, µs.
    SetServo { channel: u8, pulse_us: u16 },
    /// Moves a servo to a pulse, µs, and back, so many times, each in a period, s.
    RepeatServo { channel: u8, pulse_us: u16, cycles: u32, period_s: f64 },
    /// Moves servos from the first free one on, −1 to 1 of their range.
    SetActuators([Option<f64>; 4]),
    /// Switches a relay, counted from 0.
    SetRelay { relay: u8, to: Switch },
    /// Switches a relay there and back, so many times, each in a period, s.
    RepeatRelay { relay: u8, cycles: u32, period_s: f64 },
    /// Grabs, or releases.
    Grip { grabs: bool },
    /// Takes images, one each interval, s; 0 images: until it is stopped.
    Capture { interval_s: f64, count: u32 },
    /// Takes no more of them.
    StopCapture,
    /// Takes one now.
    Shoot,
    /// Takes one each time so far, m, has been flown, and one at once; 0 ends it.
    TriggerByDistance { distance_m: f64, at_once: bool, oblique: Option<Oblique> },
    /// Takes one each interval, s; 0 ends it.
    TriggerByTime { interval_s: f64 },
    /// Switches that trigger on or off, pauses it, and counts anew.
    ControlTrigger { enabled: Option<bool>, paused: Option<bool>, reset: bool },
    /// Records a video, or ends that.
    Record(bool),
    /// Changes the mode.
    SetCameraMode(CameraMode),
    /// Zooms.
    Zoom(Drive),
    /// Focuses.
    Focus(Drive),
    /// Sets mode, zoom and focus to what they were at the start.
    ResetCamera,
    /// Empties the storage, and counts images anew if that is asked for.
    Format { reset_count: bool },
    /// Points the gimbal.
    Point(Pointing),
    /// Points it forward, to the horizon.
    CentreGimbal,
    /// Folds it away.
    RetractGimbal,
    /// Lets others point it, or at something else.
    SetGimbalMode(GimbalMode),
    /// Keeps it at its angles.
    HoldGimbal,
    /// Locks it on the place on the ground that it sees, or on the one that it was locked on before.
    LockGimbal,
    /// Points the gimbal at a place, NED, m.
    LookAt(Vector3<f64>),
    /// Lets go of that place, and forgets it if that is asked for.
    UnlockGimbal { forget: bool },
    /// Moves the landing gear.
    MoveLandingGear { down: bool },
    /// Asks something of the parachute.
    Parachute(ParachuteOrder),
}
