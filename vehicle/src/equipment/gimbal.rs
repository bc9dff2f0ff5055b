//! A gimbal of three axes. Roll and pitch are kept to the horizon; the yaw follows the nose, or is kept from north.

use nalgebra::Vector3;

use super::mount::{GimbalMode, MountSettings};
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

/// Roll, pitch and yaw of ours when it is folded away, rad.
const FOLDED_RAD: [f64; 3] = [0.0, -core::f64::consts::FRAC_PI_2, 0.0];

/// What an axis is to do.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Demand {
    /// Come to an angle, rad, at most so fast, rad/s.
    Angle(f64, f64),
    /// Turn on, rad/s.
    Rate(f64),
}

/// What it is pointed at.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Aim {
    /// The horizon ahead.
    Neutral,
    /// Nothing: it is folded away.
    Retracted,
    /// Angles or rates.
    Demands,
    /// What the vehicle looks at.
    Region,
    /// A place, NED, m, while it is locked on that.
    Place(Vector3<f64>),
    /// Home.
    Home,
    /// Where the pilot's channels point it.
    Radio,
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
    /// The place that it was locked on, NED, m.
    locked_on_m: Option<Vector3<f64>>,
    /// How it is mounted.
    mount: MountSettings,
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
            locked_on_m: None,
            mount: MountSettings::default(),
        }
    }
}

impl Gimbal {
    /// Mounted by these settings, in its first mode.
    pub fn mounted(mount: &MountSettings) -> Self {
        let mut gimbal = Self { mount: *mount, ..Self::default() };
        gimbal.set_mode(mount.resting_mode());
        gimbal
    }

    /// It is mounted so from now on.
    pub fn mount(&mut self, mount: &MountSettings) {
        self.mount = *mount;
    }

    /// Changes to a mode.
    pub fn set_mode(&mut self, mode: GimbalMode) {
        match mode {
            GimbalMode::Retracted => self.retract(),
            GimbalMode::Neutral => self.centre(),
            GimbalMode::Commands => self.stay(),
            GimbalMode::Radio => self.aim = Aim::Radio,
            GimbalMode::Home => self.aim = Aim::Home,
            GimbalMode::Region if self.looked => self.aim = Aim::Region,
            // Without anything to be looked at it stays.
            GimbalMode::Region if self.aim == Aim::Region => self.stay(),
            GimbalMode::Region => {}
        }
    }

    /// Stays at the angles that it has, or that commands ask for.
    pub fn stay(&mut self) {
        if self.aim != Aim::Demands {
            let [roll, pitch, yaw] = self.angles_rad.data.0[0].map(|angle| self.to(angle));
            *self = Self { aim: Aim::Demands, roll, pitch, yaw, yaw_lock: false, ..*self };
        }
    }

    /// Locks on the place at which it looks, on ground as high as home, or on the one that it was locked on before.
    pub fn lock_on(&mut self, around: &Surroundings) {
        let seen = || self.seen_on_the_ground(around);
        if let Some(place_m) = self.locked_on_m.or_else(seen) {
            (self.locked_on_m, self.aim) = (Some(place_m), Aim::Place(place_m));
        }
    }

    /// Looks at a place, NED, m.
    pub fn look_at(&mut self, place_m: Vector3<f64>) {
        self.aim = Aim::Place(place_m);
    }

    /// Looks elsewhere than at the place that it is locked on, which it forgets if that is asked for.
    pub fn look_off(&mut self, forget: bool) {
        self.locked_on_m = self.locked_on_m.filter(|_| !forget);
        if matches!(self.aim, Aim::Place(_)) {
            self.set_mode(self.mount.resting_mode());
        }
    }

    /// Where its view meets the ground, NED, m; `None` above the horizon.
    fn seen_on_the_ground(&self, around: &Surroundings) -> Option<Vector3<f64>> {
        let [_, pitch_rad, _] = self.angles_rad.data.0[0];
        let heading_rad = self.yaw_in(true, around.attitude_rad.z);
        let ahead = libm::cos(pitch_rad);
        let view = Vector3::new(
            ahead * libm::cos(heading_rad),
            ahead * libm::sin(heading_rad),
            -libm::sin(pitch_rad),
        );
        let below_m = around.home_m.z - around.position_m.z;
        (view.z > 0.0 && below_m > 0.0).then(|| around.position_m + view * (below_m / view.z))
    }

    /// Whether the pilot's channels point it.
    pub fn is_pointed_by_radio(&self) -> bool {
        self.aim == Aim::Radio
    }

    /// A demand for an angle, rad, as fast as it can.
    fn to(&self, angle_rad: f64) -> Demand {
        Demand::Angle(angle_rad, self.mount.limits().rate_rad_s)
    }

    /// Roll and pitch to the horizon and yaw from the nose, rad.
    pub fn angles_rad(&self) -> Vector3<f64> {
        self.angles_rad
    }

    /// How fast these change, rad/s.
    pub fn rates_rad_s(&self) -> Vector3<f64> {
        self.rates_rad_s
    }

    /// Whether its yaw is told from north.
    pub fn is_locked(&self) -> bool {
        // ArduPilot tells the yaw of its mounts from the nose.
        self.is_kept_from_north() && !self.mount.is_set_up()
    }

    /// Whether its yaw is kept from north.
    fn is_kept_from_north(&self) -> bool {
        self.yaw_lock || matches!(self.aim, Aim::Region | Aim::Place(_) | Aim::Home)
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
        let limits = self.mount.limits();
        let at = |angle: f64, [low, high]: [f64; 2]| angle <= low || angle >= high;
        let [roll, pitch, _] = self.angles_rad.data.0[0];
        // The yaw goes round and round.
        [at(roll, limits.roll_rad), at(pitch, limits.pitch_rad), false]
    }

    /// Points it.
    pub fn point(&mut self, to: &Pointing, heading_rad: f64) {
        let fastest = self.mount.limits().rate_rad_s;
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

    /// Points it ahead: to the horizon, or as it is set up.
    pub fn centre(&mut self) {
        self.turn_to(Aim::Neutral, if self.mount.is_set_up() { self.mount.neutral_rad } else { [0.0; 3] });
    }

    /// Folds it away.
    pub fn retract(&mut self) {
        let folded_rad = if self.mount.is_set_up() { self.mount.folded_rad } else { FOLDED_RAD };
        self.turn_to(Aim::Retracted, folded_rad);
    }

    fn turn_to(&mut self, aim: Aim, angles_rad: [f64; 3]) {
        let [roll, pitch, yaw] = angles_rad.map(|angle| self.to(angle));
        *self = Self { aim, roll, pitch, yaw, yaw_lock: false, ..*self };
    }

    /// Yaw from the nose, or from north, rad.
    pub fn yaw_in(&self, from_north: bool, heading_rad: f64) -> f64 {
        wrapped(self.angles_rad.z + if from_north { heading_rad } else { 0.0 })
    }

    /// Whether it stays where it is while the vehicle looks, or not.
    pub fn rests(&self, looks: bool) -> bool {
        let still = |demand: Demand, angle: f64| match demand {
            Demand::Angle(to, _) => to == angle || wrapped(to - angle).abs() < RESTS_RAD,
            Demand::Rate(rate) => rate == 0.0,
        };
        let [roll, pitch, yaw] = self.angles_rad.data.0[0];
        looks == self.looked
            && !self.is_kept_from_north()
            && self.aim != Aim::Radio
            && still(self.roll, roll)
            && still(self.pitch, pitch)
            && still(self.yaw, yaw)
            && self.rates_rad_s == Vector3::zeros()
    }

    /// Moves on by a time, s.
    pub fn step(&mut self, around: &Surroundings, dt_s: f64) {
        self.mount(&around.mount);
        self.notice_region(around);
        let limits = self.mount.limits();
        let (roll, pitch, yaw) = self.demands(around);
        let before_rad = self.angles_rad;
        let heading_rad = around.attitude_rad.z;
        let now_yaw_rad = self.yaw_in(self.is_kept_from_north(), heading_rad);
        let yaw_step = step_of(yaw, now_yaw_rad, true, dt_s);
        self.angles_rad.x = moved(before_rad.x, step_of(roll, before_rad.x, false, dt_s), limits.roll_rad);
        self.angles_rad.y = moved(before_rad.y, step_of(pitch, before_rad.y, false, dt_s), limits.pitch_rad);
        let [least_rad, most_rad] = limits.yaw_rad;
        self.angles_rad.z = wrapped(before_rad.z + yaw_step).clamp(least_rad, most_rad);
        let change = self.angles_rad - before_rad;
        self.rates_rad_s = Vector3::new(change.x, change.y, wrapped(change.z)) / dt_s;
        self.keep_lock(heading_rad);
    }

    /// What its axes are to do now: roll, pitch, and yaw from north or from the nose.
    fn demands(&self, around: &Surroundings) -> (Demand, Demand, Demand) {
        let place_m = match self.aim {
            Aim::Region => around.region_m,
            Aim::Place(place_m) => Some(place_m),
            Aim::Home => Some(around.home_m),
            Aim::Radio => return self.asked_by_radio(around),
            Aim::Neutral | Aim::Retracted | Aim::Demands => return (self.roll, self.pitch, self.yaw),
        };
        let ahead = [0.0, around.attitude_rad.z];
        let [pitch_rad, yaw_rad] = place_m.map_or(ahead, |place_m| direction(&place_m, around));
        (self.to(0.0), self.to(pitch_rad), self.to(yaw_rad))
    }

    /// Where the pilot's channels point it: angles between its limits, or rates, which end with the radio.
    fn asked_by_radio(&self, around: &Surroundings) -> (Demand, Demand, Demand) {
        let rate_rad_s = around.mount.radio_rate_rad_s;
        let asked = |deflection: f64, [least_rad, most_rad]: [f64; 2]| {
            if rate_rad_s > 0.0 {
                Demand::Rate(if around.radio_is_lost { 0.0 } else { deflection * rate_rad_s })
            } else {
                self.to(least_rad + (deflection + 1.0) / 2.0 * (most_rad - least_rad))
            }
        };
        let ([roll, pitch, yaw], limits) = (around.deflections, self.mount.limits());
        (asked(roll, limits.roll_rad), asked(pitch, limits.pitch_rad), asked(yaw, limits.yaw_rad))
    }

    /// While the yaw is locked and turns on by a rate, the angle that it has is the one that is kept.
    fn keep_lock(&mut self, heading_rad: f64) {
        if let (Demand::Rate(rate), true) = (self.yaw, self.yaw_lock)
            && rate == 0.0
        {
            self.yaw = self.to(self.yaw_in(true, heading_rad));
        }
    }

    /// Begins to track what the vehicle looks at, and ends that with it.
    fn notice_region(&mut self, around: &Surroundings) {
        let looked = core::mem::replace(&mut self.looked, around.looks);
        match (around.looks, looked) {
            (true, false) => self.aim = Aim::Region,
            (false, true) if self.aim == Aim::Region => self.set_mode(around.mount.resting_mode()),
            _ => {}
        }
    }

    /// Tracks what the vehicle looks at again: another place was named.
    pub fn track(&mut self) {
        self.looked = false;
    }
}

/// Pitch and yaw from north to a place, NED, m: rad.
fn direction(place_m: &Vector3<f64>, around: &Surroundings) -> [f64; 2] {
    let way = place_m - around.position_m;
    let level_m = way.xy().norm();
    let pitch_rad = libm::atan2(-way.z, level_m);
    let yaw_rad = if level_m > 1e-3 { libm::atan2(way.y, way.x) } else { around.attitude_rad.z };
    [pitch_rad, yaw_rad]
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
mod tests;
