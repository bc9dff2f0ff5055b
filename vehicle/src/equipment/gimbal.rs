//! A gimbal of three axes. Roll and pitch are kept to the horizon; the yaw follows the nose, or is kept from north.

use nalgebra::Vector3;

use super::operation::Pointing;
use super::surroundings::Surroundings;
use crate::wrapped;

/// Angles that it reaches, rad, and how fast it turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GimbalLimits {
    /// Roll to the horizon.
    pub roll_rad: [f64; 2],
    /// Pitch to the horizon, positive up.
    pub pitch_rad: [f64; 2],
    /// Yaw from the nose.
    pub yaw_rad: [f64; 2],
    /// Of each axis, rad/s.
    pub rate_rad_s: f64,
}

/// Where the parts that are folded away point, rad.
const FOLDED_RAD: f64 = -core::f64::consts::FRAC_PI_2;

/// What an axis is to do.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Demand {
    /// Come to an angle, rad, at most so fast, rad/s.
    Angle(f64, f64),
    /// Turn on, rad/s.
    Rate(f64),
}

/// What it is pointed at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Aim {
    /// The horizon ahead.
    Neutral,
    /// Nothing: it is folded away.
    Retracted,
    /// Angles or rates.
    Demands,
    /// What the vehicle looks at.
    Region,
}

/// The gimbal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gimbal {
    aim: Aim,
    roll: Demand,
    pitch: Demand,
    /// From the nose, or from north while it is locked.
    yaw: Demand,
    yaw_lock: bool,
    /// Roll, pitch, and yaw from the nose, rad.
    angles_rad: Vector3<f64>,
    rates_rad_s: Vector3<f64>,
    /// Whether the vehicle looked at something.
    looked: bool,
}

impl GimbalLimits {
    /// Those of the gimbal.
    pub const OURS: Self = Self {
        roll_rad: [-core::f64::consts::FRAC_PI_4, core::f64::consts::FRAC_PI_4],
        pitch_rad: [-core::f64::consts::FRAC_PI_2 * 1.5, core::f64::consts::FRAC_PI_4],
        yaw_rad: [-core::f64::consts::PI, core::f64::consts::PI],
        rate_rad_s: core::f64::consts::PI,
    };
}

/// So near to its angle, rad, an axis rests.
const RESTS_RAD: f64 = 1e-9;

impl Default for Gimbal {
    fn default() -> Self {
        let ahead = Demand::Angle(0.0, GimbalLimits::OURS.rate_rad_s);
        Self {
            aim: Aim::Neutral,
            roll: ahead,
            pitch: ahead,
            yaw: ahead,
            yaw_lock: false,
            angles_rad: Vector3::zeros(),
            rates_rad_s: Vector3::zeros(),
            looked: false,
        }
    }
}

impl Gimbal {
    /// Roll and pitch to the horizon and yaw from the nose, rad.
    pub fn angles_rad(&self) -> Vector3<f64> {
        self.angles_rad
    }

    /// How fast these change, rad/s.
    pub fn rates_rad_s(&self) -> Vector3<f64> {
        self.rates_rad_s
    }

    /// Whether its yaw is kept from north.
    pub fn is_locked(&self) -> bool {
        self.yaw_lock || self.aim == Aim::Region
    }

    /// Whether it points to the horizon ahead.
    pub fn is_neutral(&self) -> bool {
        self.aim == Aim::Neutral
    }

    /// Whether it is folded away.
    pub fn is_retracted(&self) -> bool {
        self.aim == Aim::Retracted
    }

    /// Whether it points at what the vehicle looks at.
    pub fn tracks(&self) -> bool {
        self.aim == Aim::Region
    }

    /// Whether roll, pitch and yaw are at a limit that holds them back.
    pub fn at_limit(&self) -> [bool; 3] {
        let limits = GimbalLimits::OURS;
        let at = |angle: f64, [low, high]: [f64; 2]| angle <= low || angle >= high;
        let [roll, pitch, _] = self.angles_rad.data.0[0];
        // The yaw goes round and round.
        [at(roll, limits.roll_rad), at(pitch, limits.pitch_rad), false]
    }

    /// Points it.
    pub fn point(&mut self, to: &Pointing, heading_rad: f64) {
        let fastest = GimbalLimits::OURS.rate_rad_s;
        let [roll_rad, pitch_rad, _] = self.angles_rad.data.0[0];
        let demand = |angle: Option<f64>, rate: Option<f64>, now: Demand, held: f64| match (angle, rate) {
            (Some(angle), rate) => {
                let asked = rate.map(f64::abs).filter(|rate| *rate > 0.0);
                Demand::Angle(angle, asked.unwrap_or(fastest).min(fastest))
            }
            (None, Some(rate)) => Demand::Rate(rate.clamp(-fastest, fastest)),
            // What is not mentioned stays where it is.
            (None, None) => match now {
                Demand::Angle(..) if self.aim == Aim::Demands => now,
                _ => Demand::Angle(held, fastest),
            },
        };
        let held_yaw_rad = self.yaw_in(to.yaw_lock, heading_rad);
        let same_frame = self.yaw_lock == to.yaw_lock && self.aim == Aim::Demands;
        let yaw_now = if same_frame { self.yaw } else { Demand::Angle(held_yaw_rad, fastest) };
        let level = Demand::Angle(0.0, fastest);
        self.roll = to.roll_rad.map_or(level, |roll| demand(Some(roll), None, level, roll_rad));
        self.pitch = demand(to.pitch_rad, to.pitch_rate_rad_s, self.pitch, pitch_rad);
        self.yaw = demand(to.yaw_rad, to.yaw_rate_rad_s, yaw_now, held_yaw_rad);
        (self.aim, self.yaw_lock) = (Aim::Demands, to.yaw_lock);
    }

    /// Points it to the horizon ahead.
    pub fn centre(&mut self) {
        let ahead = Demand::Angle(0.0, GimbalLimits::OURS.rate_rad_s);
        *self = Self { aim: Aim::Neutral, roll: ahead, pitch: ahead, yaw: ahead, yaw_lock: false, ..*self };
    }

    /// Folds it away.
    pub fn retract(&mut self) {
        self.centre();
        self.pitch = Demand::Angle(FOLDED_RAD, GimbalLimits::OURS.rate_rad_s);
        self.aim = Aim::Retracted;
    }

    /// Yaw from the nose, or from north, rad.
    pub fn yaw_in(&self, from_north: bool, heading_rad: f64) -> f64 {
        wrapped(self.angles_rad.z + if from_north { heading_rad } else { 0.0 })
    }

    /// Whether it stays where it is while the vehicle looks, or not.
    pub fn rests(&self, looks: bool) -> bool {
        let still = |demand: Demand, angle: f64| match demand {
            Demand::Angle(to, _) => wrapped(to - angle).abs() < RESTS_RAD,
            Demand::Rate(rate) => rate == 0.0,
        };
        let [roll, pitch, yaw] = self.angles_rad.data.0[0];
        looks == self.looked
            && !self.is_locked()
            && still(self.roll, roll)
            && still(self.pitch, pitch)
            && still(self.yaw, yaw)
            && self.rates_rad_s == Vector3::zeros()
    }

    /// Moves on by a time, s.
    pub fn step(&mut self, around: &Surroundings, dt_s: f64) {
        self.notice_region(around);
        let limits = GimbalLimits::OURS;
        let fastest = limits.rate_rad_s;
        let (mut roll, mut pitch, mut yaw) = (self.roll, self.pitch, self.yaw);
        if self.aim == Aim::Region {
            let [pitch_rad, yaw_rad] = direction(around).unwrap_or([0.0, around.attitude_rad.z]);
            (roll, pitch) = (Demand::Angle(0.0, fastest), Demand::Angle(pitch_rad, fastest));
            yaw = Demand::Angle(yaw_rad, fastest);
        }
        let before_rad = self.angles_rad;
        let heading_rad = around.attitude_rad.z;
        let now_yaw_rad = self.yaw_in(self.is_locked(), heading_rad);
        let yaw_step = step_of(yaw, now_yaw_rad, true, dt_s);
        self.angles_rad.x = moved(before_rad.x, step_of(roll, before_rad.x, false, dt_s), limits.roll_rad);
        self.angles_rad.y = moved(before_rad.y, step_of(pitch, before_rad.y, false, dt_s), limits.pitch_rad);
        self.angles_rad.z = wrapped(before_rad.z + yaw_step);
        let change = self.angles_rad - before_rad;
        self.rates_rad_s = Vector3::new(change.x, change.y, wrapped(change.z)) / dt_s;
        self.keep_lock(heading_rad);
    }

    /// While the yaw is locked and turns on by a rate, the angle that it has is the one that is kept.
    fn keep_lock(&mut self, heading_rad: f64) {
        if let (Demand::Rate(rate), true) = (self.yaw, self.yaw_lock)
            && rate == 0.0
        {
            self.yaw = Demand::Angle(self.yaw_in(true, heading_rad), GimbalLimits::OURS.rate_rad_s);
        }
    }

    /// Begins to track what the vehicle looks at, and ends that with it.
    fn notice_region(&mut self, around: &Surroundings) {
        match (around.looks, self.looked) {
            (true, false) => self.aim = Aim::Region,
            (false, true) if self.aim == Aim::Region => self.centre(),
            _ => {}
        }
        self.looked = around.looks;
    }

    /// Tracks what the vehicle looks at again: another place was named.
    pub fn track(&mut self) {
        self.looked = false;
    }
}

/// Pitch and yaw from north to what is looked at, rad.
fn direction(around: &Surroundings) -> Option<[f64; 2]> {
    let way = around.region_m? - around.position_m;
    let level_m = way.xy().norm();
    let pitch_rad = libm::atan2(-way.z, level_m);
    let yaw_rad = if level_m > 1e-3 { libm::atan2(way.y, way.x) } else { around.attitude_rad.z };
    Some([pitch_rad, yaw_rad])
}

/// By how much an axis that is at an angle, rad, moves in a time, s.
fn step_of(demand: Demand, angle_rad: f64, round: bool, dt_s: f64) -> f64 {
    match demand {
        Demand::Angle(to_rad, fastest) => {
            let left_rad = if round { wrapped(to_rad - angle_rad) } else { to_rad - angle_rad };
            left_rad.clamp(-fastest * dt_s, fastest * dt_s)
        }
        Demand::Rate(rate) => rate * dt_s,
    }
}

fn moved(angle_rad: f64, by_rad: f64, [low, high]: [f64; 2]) -> f64 {
    (angle_rad + by_rad).clamp(low, high)
}

#[cfg(test)]
mod tests {
    use core::f64::consts::{FRAC_PI_2, FRAC_PI_4};

    use super::{Gimbal, GimbalLimits, Pointing, Surroundings, Vector3};

    fn around(yaw_rad: f64) -> Surroundings {
        Surroundings {
            time_us: 0,
            position_m: Vector3::new(0.0, 0.0, -10.0),
            home_z_m: 0.0,
            attitude_rad: Vector3::new(0.0, 0.0, yaw_rad),
            region_m: None,
            looks: false,
        }
    }

    fn settle(gimbal: &mut Gimbal, around: &Surroundings) -> [f64; 3] {
        for _ in 0..3_000 {
            gimbal.step(around, 0.001);
        }
        gimbal.angles_rad().data.0[0]
    }

    fn near(one: [f64; 3], other: [f64; 3]) -> bool {
        one.iter().zip(other).all(|(one, other)| (one - other).abs() < 1e-6)
    }

    #[test]
    fn yaw_follows_the_nose_or_is_kept_from_north() {
        let mut gimbal = Gimbal::default();
        assert!(gimbal.rests(false));
        let down = Pointing { pitch_rad: Some(-FRAC_PI_2), yaw_rad: Some(0.5), ..Pointing::default() };
        gimbal.point(&down, 1.0);
        assert!(near(settle(&mut gimbal, &around(1.0)), [0.0, -FRAC_PI_2, 0.5]));
        assert!(near(settle(&mut gimbal, &around(2.0)), [0.0, -FRAC_PI_2, 0.5]));
        gimbal.point(&Pointing { yaw_lock: true, ..down }, 2.0);
        assert!(near(settle(&mut gimbal, &around(2.0)), [0.0, -FRAC_PI_2, -1.5]));
        assert!(near(settle(&mut gimbal, &around(0.5)), [0.0, -FRAC_PI_2, 0.0]));
        gimbal.centre();
        assert!(near(settle(&mut gimbal, &around(0.5)), [0.0; 3]) && gimbal.rests(false));
    }

    #[test]
    fn it_turns_at_its_rate_and_stops_at_its_limits() {
        let mut gimbal = Gimbal::default();
        let up = Pointing { pitch_rate_rad_s: Some(0.2), yaw_rate_rad_s: Some(-0.3), ..Pointing::default() };
        gimbal.point(&up, 0.0);
        for _ in 0..1_000 {
            gimbal.step(&around(0.0), 0.001);
        }
        assert!(near(gimbal.angles_rad().data.0[0], [0.0, 0.2, -0.3]), "{gimbal:?}");
        assert!((gimbal.rates_rad_s() - Vector3::new(0.0, 0.2, -0.3)).norm() < 1e-6);
        gimbal.point(&Pointing { pitch_rad: Some(FRAC_PI_2), ..Pointing::default() }, 0.0);
        assert_eq!(settle(&mut gimbal, &around(0.0))[1], FRAC_PI_4);
        assert_eq!(gimbal.at_limit(), [false, true, false]);
        gimbal.point(&Pointing { pitch_rad: Some(0.0), ..Pointing::default() }, 0.0);
        gimbal.step(&around(0.0), 0.1);
        assert!((gimbal.rates_rad_s().y + GimbalLimits::OURS.rate_rad_s).abs() < 1e-9, "no faster");
    }

    #[test]
    fn it_tracks_what_is_looked_at() {
        let mut gimbal = Gimbal::default();
        let looking =
            Surroundings { region_m: Some(Vector3::new(0.0, 10.0, 0.0)), looks: true, ..around(0.25) };
        assert!(!gimbal.rests(true));
        assert!(near(settle(&mut gimbal, &looking), [0.0, -FRAC_PI_4, FRAC_PI_2 - 0.25]));
        // Who points it elsewhere takes it off the place, which then ends for it, too.
        gimbal.point(&Pointing { pitch_rad: Some(0.1), yaw_rad: Some(0.0), ..Pointing::default() }, 0.25);
        assert!(near(settle(&mut gimbal, &looking), [0.0, 0.1, 0.0]));
        assert!(near(settle(&mut gimbal, &around(0.25)), [0.0, 0.1, 0.0]));
        settle(&mut gimbal, &looking);
        assert!(gimbal.tracks());
        assert!(near(settle(&mut gimbal, &around(0.25)), [0.0; 3]), "ahead again");
    }
}
