//! Images that the autopilot triggers: by the distance flown, or by time.

use nalgebra::{Vector2, Vector3};

use super::capture::SHORTEST_S;

/// The camera is swung to one side and the other between images.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oblique {
    /// How many positions there are.
    pub positions: u32,
    /// Roll of the outermost ones, rad.
    pub roll_rad: f64,
    /// Pitch of all of them, rad.
    pub pitch_rad: f64,
}

impl Oblique {
    /// Roll at one of the positions, rad.
    pub fn roll_at(&self, number: u32) -> f64 {
        let last = self.positions.saturating_sub(1);
        if last == 0 {
            return 0.0;
        }
        let share = f64::from(number % self.positions) / f64::from(last);
        self.roll_rad * (2.0 * share - 1.0)
    }
}

/// What triggers.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Rhythm {
    /// So far, m, from where it was triggered last.
    Distance { distance_m: f64, last_m: Option<Vector2<f64>> },
    /// A time, µs, after it was triggered last.
    Interval { interval_us: u64, next_us: u64 },
}

/// The trigger.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Trigger {
    rhythm: Option<Rhythm>,
    enabled: bool,
    paused: bool,
    oblique: Option<Oblique>,
}

impl Trigger {
    /// Whether it will trigger by itself.
    pub fn is_on(&self) -> bool {
        self.enabled && !self.paused && self.rhythm.is_some()
    }

    /// Swings of the camera between images.
    pub fn oblique(&self) -> Option<&Oblique> {
        self.oblique.as_ref()
    }

    /// Triggers each time so far, m, has been flown, from the first place on if that is asked for; 0 ends it.
    pub fn by_distance(&mut self, distance_m: f64, here_m: Option<&Vector3<f64>>, oblique: Option<Oblique>) {
        let last_m = here_m.map(|here_m| here_m.xy());
        let rhythm = (distance_m > 0.0).then_some(Rhythm::Distance { distance_m, last_m });
        *self = Self { rhythm, enabled: rhythm.is_some(), paused: false, oblique };
    }

    /// Triggers each time an interval, s, is over; 0 ends it.
    pub fn by_interval(&mut self, interval_s: f64, now_us: u64) {
        let interval_us = if interval_s > 0.0 { (interval_s.max(SHORTEST_S) * 1e6) as u64 } else { 0 };
        let rhythm = (interval_us > 0).then_some(Rhythm::Interval { interval_us, next_us: now_us });
        *self = Self { rhythm, enabled: rhythm.is_some(), paused: false, oblique: None };
    }

    /// Switches it on or off, and lets it pause.
    pub fn control(&mut self, enabled: Option<bool>, paused: Option<bool>) {
        self.enabled = enabled.unwrap_or(self.enabled);
        self.paused = paused.unwrap_or(self.paused);
    }

    /// Whether an image is due here and now.
    pub fn is_due(&mut self, here_m: &Vector3<f64>, now_us: u64) -> bool {
        if !self.is_on() {
            return false;
        }
        match &mut self.rhythm {
            Some(Rhythm::Distance { distance_m, last_m }) => {
                let here_m = here_m.xy();
                let due = last_m.is_none_or(|last_m| (here_m - last_m).norm() >= *distance_m);
                if due {
                    *last_m = Some(here_m);
                }
                due
            }
            Some(Rhythm::Interval { interval_us, next_us }) => {
                let due = now_us >= *next_us;
                if due {
                    *next_us = now_us + *interval_us;
                }
                due
            }
            None => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Oblique, Trigger, Vector3};

    #[test]
    fn distance_counts_horizontally_and_a_pause_stops_it() {
        let mut trigger = Trigger::default();
        let at = |x: f64| Vector3::new(x, 0.0, -x);
        trigger.by_distance(5.0, None, None);
        let due: Vec<_> = (0..20).filter(|x| trigger.is_due(&at(f64::from(*x)), 0)).collect();
        assert_eq!(due, [0, 5, 10, 15]);
        trigger.by_distance(5.0, Some(&at(0.0)), None);
        trigger.control(None, Some(true));
        assert!(!trigger.is_due(&at(7.0), 0), "it pauses");
        trigger.control(None, Some(false));
        assert!(trigger.is_due(&at(7.0), 0));
        trigger.control(Some(false), None);
        assert!(!trigger.is_due(&at(70.0), 0), "it is off");
        trigger.by_distance(0.0, None, None);
        trigger.control(Some(true), None);
        assert!(!trigger.is_due(&at(70.0), 0), "nothing to trigger by");
    }

    #[test]
    fn swings_are_even_and_come_back() {
        let oblique = Oblique { positions: 3, roll_rad: 0.5, pitch_rad: 0.0 };
        let rolls: Vec<_> = (0..4).map(|number| oblique.roll_at(number)).collect();
        assert_eq!(rolls, [-0.5, 0.0, 0.5, -0.5]);
    }
}
