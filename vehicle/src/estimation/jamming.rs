//! A jammed GPS receiver: at first it has no fix, and then fixes that come and go and lie, and that it does not trust itself.

use nalgebra::Vector3;

use super::gps::GpsFix;
use super::noise::Noise;

/// How long it has none at first, µs. Assumed: seconds are usual.
const SILENT_US: u64 = 3_000_000;
/// A jammer that comes after such a time, µs, is another one.
const GAP_US: u64 = 1_000_000;
/// Fewer satellites than this make no fix.
const FEWEST: u8 = 4;
/// Most satellites that it takes itself to see.
const MOST: u8 = 16;
// Standard deviations of what it says. Assumed: so large that nobody can take them for a place.
/// How far the place leaps from fix to fix, m, and the largest distance.
const LEAP_M: f64 = 100.0;
const FARTHEST_M: f64 = 5_000.0;
/// Velocity, m/s.
const VELOCITY_M_S: f64 = 100.0;
/// Satellites.
const SATELLITES: f64 = 5.0;
/// How far off it takes itself to be, m: at least, and the deviation of what comes on top.
const LEAST_INACCURACY_M: f64 = 30.0;
const INACCURACY_M: f64 = 100.0;

/// What the jammer does to the receiver.
#[derive(Clone, Debug, Default)]
pub struct Jamming {
    /// When it began, and when it was there last, µs.
    span_us: Option<[u64; 2]>,
    /// How far the place is off, m.
    off_m: Vector3<f64>,
}

impl Jamming {
    /// What is left of a fix. `None` if nothing is.
    pub fn disturb(&mut self, fix: GpsFix, noise: &mut Noise) -> Option<GpsFix> {
        let going_on = self.span_us.filter(|[_, last_us]| fix.time_us.saturating_sub(*last_us) <= GAP_US);
        let [since_us, _] = going_on.unwrap_or([fix.time_us; 2]);
        self.span_us = Some([since_us, fix.time_us]);
        if fix.time_us.saturating_sub(since_us) < SILENT_US {
            return None;
        }
        self.off_m += noise.vector(LEAP_M);
        self.off_m = self.off_m.map(|off_m| off_m.clamp(-FARTHEST_M, FARTHEST_M));
        let velocity_m_s = noise.vector(VELOCITY_M_S);
        let inaccuracy_m = LEAST_INACCURACY_M + noise.normal(INACCURACY_M).abs();
        let satellites = MOST.min(2 + noise.normal(SATELLITES).abs() as u8);
        (satellites >= FEWEST).then_some(GpsFix {
            position_m: fix.position_m + self.off_m,
            velocity_m_s,
            horizontal_accuracy_m: inaccuracy_m,
            vertical_accuracy_m: inaccuracy_m,
            velocity_accuracy_m_s: VELOCITY_M_S,
            climb_accuracy_m_s: VELOCITY_M_S,
            satellites,
            ..fix
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Jamming;
    use crate::estimation::gps::GpsFix;
    use crate::estimation::noise::{Channel, Noise};

    #[test]
    fn it_is_silent_first_and_lies_then() {
        let (mut jamming, mut noise) = (Jamming::default(), Noise::new(1, Channel::Error));
        let exact = GpsFix::still();
        let mut fixes = Vec::new();
        for tick in 0..200 {
            let fix = GpsFix { time_us: 10_000_000 + tick * 100_000, ..exact };
            fixes.push(jamming.disturb(fix, &mut noise));
        }
        assert!(fixes[..30].iter().all(Option::is_none));
        let said: Vec<_> = fixes[30..].iter().flatten().collect();
        assert!((60..170).contains(&said.len()), "they come and go: {}", said.len());
        assert!(said.iter().all(|fix| fix.horizontal_accuracy_m >= 30.0 && fix.satellites >= 4));
        assert!(said.windows(2).all(|pair| pair[0].position_m != pair[1].position_m));
        let later = GpsFix { time_us: 60_000_000, ..exact };
        assert_eq!(jamming.disturb(later, &mut noise), None, "another jammer");
    }
}
