//! What is checked before arming.

use serde::{Deserialize, Serialize};

use super::arming_obstacle::ArmingSubject;

/// ArduPilot's parameters of arming.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct ArmingSettings {
    /// Checks that are made, as the parameter adds them up; 0: none (ARMING_CHECK).
    pub checks: i32,
    /// Checks that are skipped, likewise; −1: all (ARMING_SKIPCHK).
    pub skipped: i32,
    /// Mission items that are required, as the parameter adds them up (ARMING_MIS_ITEMS).
    pub required_items: u32,
    /// Whether its place must be known in every mode (ARMING_NEED_LOC).
    pub needs_place: bool,
    /// Whether the safety switch is on at the start (BRD_SAFETY_DEFLT).
    pub is_safe_at_the_start: bool,
}

impl Default for ArmingSettings {
    fn default() -> Self {
        Self { checks: 1, skipped: 0, required_items: 0, needs_place: false, is_safe_at_the_start: false }
    }
}

impl ArmingSettings {
    /// Whether nothing is checked that an expert may leave out.
    pub fn skips_all(&self) -> bool {
        self.checks == 0 || self.skipped == -1
    }

    /// Whether what is about a subject is left out. What flying needs in any case has no bit.
    pub fn skips(&self, subject: ArmingSubject) -> bool {
        const ALL: i32 = 1;
        let Some(bit) = bit(subject) else { return false };
        self.skipped & bit != 0 || self.checks & (ALL | bit) == 0
    }
}

/// The bit of a subject in ArduPilot's parameters.
fn bit(subject: ArmingSubject) -> Option<i32> {
    let number = match subject {
        ArmingSubject::Barometer => 1,
        ArmingSubject::Magnetometer => 2,
        ArmingSubject::Gps => 3,
        ArmingSubject::Gyroscope | ArmingSubject::Accelerometer => 4,
        ArmingSubject::Battery => 8,
        _ => return None,
    };
    Some(1 << number)
}

#[cfg(test)]
mod tests {
    use super::{ArmingSettings, ArmingSubject};

    /// The bits as ArduPilot documents them: 2 barometer, 4 compass, 8 GPS, 16 inertial unit, 256 battery; 1 is all of ARMING_CHECK.
    #[test]
    fn single_checks_are_left_out_by_either_parameter() {
        let all = [
            (ArmingSubject::Barometer, 2),
            (ArmingSubject::Magnetometer, 4),
            (ArmingSubject::Gps, 8),
            (ArmingSubject::Accelerometer, 16),
            (ArmingSubject::Gyroscope, 16),
            (ArmingSubject::Battery, 256),
        ];
        for (subject, bit) in all {
            let settings = |checks, skipped| ArmingSettings { checks, skipped, ..ArmingSettings::default() };
            assert!(!settings(1, 0).skips(subject), "{subject:?}");
            assert!(
                settings(1, bit).skips(subject) && !settings(1, !bit & 0xfffff).skips(subject),
                "{subject:?}"
            );
            assert!(settings(0x11e & !bit, 0).skips(subject), "{subject:?}");
            assert!(!settings(bit, 0).skips(subject) && !settings(bit | 1, 0).skips(subject), "{subject:?}");
            assert!(
                !settings(2048, -2).skips(ArmingSubject::Position),
                "no check of an estimate is left out"
            );
        }
    }
}
