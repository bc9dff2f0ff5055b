//! When an estimate from outside is fused, and when the vehicle takes itself to be where it says.
//!
//! The first reading, one after a silence, and one whose counter of resets has changed tell a new place. Without GPS the estimate moves
//! there. With GPS, or with another reference of height, the difference is an offset that later readings are corrected by, and that
//! follows slowly, so that vision tells changes and the reference where they add up to. Velocities are the same wherever one begins:
//! they have to fit.

use nalgebra::{UnitQuaternion, Vector3};

use super::super::estimator::Estimator;
use super::super::gps::{UNKNOWN_M, UNKNOWN_M_S};
use super::super::outside_aid::Place;
use super::motion_history::MotionHistory;
use super::reading::{Measured, VelocityFrame, VisionReading, deviation};
use super::settings::VisionSettings;
use crate::wrapped;

/// After a silence of this long, µs, the next reading begins anew.
const SILENCE_US: u64 = 1_000_000;
/// The most that a position, m, a velocity, m/s, or a heading, rad, may be uncertain and still count: ArduPilot's bounds.
const LEAST_CERTAIN_M: f64 = 100.0;
const LEAST_CERTAIN_M_S: f64 = 100.0;
const LEAST_CERTAIN_RAD: f64 = 1.5;
/// With GPS beside it, a position is not better than this, m: PX4's EKF2_GPS_P_NOISE.
const BESIDE_GPS_M: f64 = 0.5;
/// A heading that differs by more standard deviations than this when it begins is taken over at once.
const HEADING_GATE: f64 = 3.0;
/// Time constants with which offsets, and the turn of a frame that points anywhere, follow, s.
const OFFSET_S: f64 = 10.0;
const TURN_S: f64 = 30.0;
/// Readings farther apart than this, s, count as if they were not.
const LONGEST_STEP_S: f64 = 0.2;

/// What a reading comes into.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VisionTerms {
    /// Time of now, µs.
    pub now_us: u64,
    /// How it is used.
    pub settings: VisionSettings,
    /// Whether GPS tells the place, too.
    pub beside_gps: bool,
    /// Whether the vehicle stands on the ground, disarmed.
    pub stands: bool,
}

/// When the last pose came, µs, and its counter of resets.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
struct Succession(Option<(u64, u8)>);

/// How a reading follows the one before.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Step {
    begins: bool,
    dt_s: f64,
}

/// What is remembered between readings.
#[derive(Clone, Debug, Default)]
pub struct VisionFusion {
    history: MotionHistory,
    poses: Succession,
    /// By how much a frame that points anywhere is turned against north, rad.
    turn_rad: f64,
    /// What is added to positions, NED, m.
    offset_m: Vector3<f64>,
    /// When a heading was fused last, µs.
    heading_us: Option<u64>,
}

impl VisionTerms {
    /// When a reading of now was taken, µs.
    fn taken_us(&self) -> u64 {
        self.now_us.saturating_sub(self.settings.delay_us)
    }
}

impl Succession {
    fn step(&mut self, now_us: u64, resets: u8) -> Step {
        let before = self.0.replace((now_us, resets));
        let silent_us = before.map(|(heard_us, _)| now_us.saturating_sub(heard_us));
        let moved = before.is_some_and(|(_, counted)| counted != resets);
        let dt_s = silent_us.map_or(0.0, |silent_us| silent_us as f64 / 1e6).min(LONGEST_STEP_S);
        Step { begins: moved || silent_us.is_none_or(|silent_us| silent_us > SILENCE_US), dt_s }
    }
}

impl VisionFusion {
    /// Remembers what the estimator knows now.
    pub fn remember(&mut self, estimator: &Estimator) {
        self.history.remember(estimator.moment());
    }

    /// Readings begin anew: they are used otherwise than before.
    pub fn begin_anew(&mut self) {
        *self = Self { history: std::mem::take(&mut self.history), ..Self::default() };
    }

    /// Whether the heading is theirs, so that the compass is not fused.
    pub fn has_heading(&self, now_us: u64, settings: &VisionSettings) -> bool {
        let lately = |heading_us: u64| now_us.saturating_sub(heading_us) <= SILENCE_US;
        settings.uses.heading
            && self.heading_us.is_some_and(|heading_us| settings.excludes_compass || lately(heading_us))
    }

    /// Fuses a reading; tells whether what was fused fitted.
    pub fn fuse(&mut self, estimator: &mut Estimator, reading: &VisionReading, terms: &VisionTerms) -> bool {
        let settings = &terms.settings;
        if settings.check(reading).is_err() {
            return false;
        }
        if self.history.nearest(terms.taken_us()).is_none() {
            return false;
        }
        let pose = (reading.position.is_some() || reading.attitude.is_some())
            .then(|| self.poses.step(terms.now_us, reading.resets));
        let mut fits = true;
        if let (Some(step), Some((attitude, variance))) = (pose, &reading.attitude) {
            fits &= self.fuse_attitude(estimator, reading, terms, step, (attitude, *variance));
        }
        if let (Some(step), Some(position)) = (pose, &reading.position) {
            fits &= self.fuse_position(estimator, reading, terms, step, position);
        }
        if let Some((frame, velocity)) = &reading.velocity {
            fits &= self.fuse_velocity(estimator, terms, *frame, velocity);
        }
        fits
    }

    /// The heading, or what it tells of the frame.
    fn fuse_attitude(
        &mut self,
        estimator: &mut Estimator,
        reading: &VisionReading,
        terms: &VisionTerms,
        step: Step,
        (attitude, variance): (&UnitQuaternion<f64>, f64),
    ) -> bool {
        let settings = &terms.settings;
        let Some(moment) = self.history.nearest(terms.taken_us()) else { return false };
        let heading_rad = attitude.euler_angles().2;
        let off_rad = wrapped(heading_rad - moment.attitude.euler_angles().2);
        // A frame that points anywhere cannot be GPS's.
        if !settings.uses.heading || terms.beside_gps && !reading.points_north {
            if !reading.points_north {
                let share = if step.begins { 1.0 } else { step.dt_s / TURN_S };
                self.turn_rad = wrapped(self.turn_rad + share * wrapped(-off_rad - self.turn_rad));
            }
            return true;
        }
        self.turn_rad = 0.0;
        let told = settings.believes_told_noise;
        let deviation_rad = deviation(variance, settings.heading_noise_rad, LEAST_CERTAIN_RAD, told);
        let certain_rad = libm::hypot(deviation_rad, estimator.heading_deviation_rad());
        let is_elsewhere = off_rad.abs() > HEADING_GATE * certain_rad;
        if step.begins && is_elsewhere && estimator.is_aligned() {
            if estimator.turn_by(off_rad, !reading.points_north) {
                self.history.move_by(&Vector3::zeros(), off_rad);
                self.heading_us = Some(terms.now_us);
            }
            return true;
        }
        let fits = estimator.fuse_heading(terms.taken_us(), heading_rad, deviation_rad);
        if fits {
            self.heading_us = Some(terms.now_us);
        }
        fits
    }

    fn fuse_position(
        &mut self,
        estimator: &mut Estimator,
        reading: &VisionReading,
        terms: &VisionTerms,
        step: Step,
        position: &Measured,
    ) -> bool {
        let (settings, uses) = (&terms.settings, &terms.settings.uses);
        if !uses.horizontal && !uses.vertical {
            return true;
        }
        let (Some(then), now) = (self.history.nearest(terms.taken_us()).copied(), estimator.moment()) else {
            return false;
        };
        let value_m = if reading.points_north { position.value } else { self.turned(&position.value) };
        let place_m = Vector3::from(settings.place_m);
        // Where the inertial unit was, by the reading.
        let unit_m = value_m - then.attitude * place_m;
        let (aside, above) = (terms.beside_gps, !settings.is_height_reference);
        let differs_m = then.position_m - unit_m;
        let share = if step.begins { 1.0 } else { step.dt_s / OFFSET_S };
        let follow = |used: bool, offset_m: f64, differs_m: f64| {
            if used { offset_m + share * (differs_m - offset_m) } else { 0.0 }
        };
        self.offset_m = Vector3::new(
            follow(aside, self.offset_m.x, differs_m.x),
            follow(aside, self.offset_m.y, differs_m.y),
            follow(above, self.offset_m.z, differs_m.z),
        );
        let [mut horizontal_m, vertical_m] =
            position.deviations(settings.position_noise_m, LEAST_CERTAIN_M, settings.believes_told_noise);
        if aside {
            horizontal_m = horizontal_m.max(BESIDE_GPS_M);
        }
        if step.begins {
            let late_s = now.time_us.saturating_sub(terms.taken_us()) as f64 / 1e6;
            let there_m = unit_m + now.velocity_m_s * late_s;
            let moves = [uses.horizontal && !aside, uses.vertical && !above];
            let place = Place {
                horizontal: moves[0].then_some((there_m.xy(), horizontal_m)),
                down: moves[1].then_some((there_m.z, vertical_m)),
            };
            if moves != [false; 2] {
                let shift_m = estimator.move_to(&place, terms.stands);
                self.history.move_by(&shift_m, 0.0);
            }
            return true;
        }
        let deviations_m = [
            if uses.horizontal { horizontal_m } else { UNKNOWN_M },
            if uses.vertical { vertical_m } else { UNKNOWN_M },
        ];
        let fits = estimator.fuse_position(
            terms.taken_us(),
            &(value_m + self.offset_m),
            deviations_m,
            settings.place_m,
        );
        (fits[0] || !uses.horizontal) && (fits[1] || !uses.vertical)
    }

    fn fuse_velocity(
        &self,
        estimator: &mut Estimator,
        terms: &VisionTerms,
        frame: VelocityFrame,
        velocity: &Measured,
    ) -> bool {
        let (settings, uses) = (&terms.settings, &terms.settings.uses);
        if !uses.velocity && !uses.climb {
            return true;
        }
        let Some(then) = self.history.nearest(terms.taken_us()) else { return false };
        let value_m_s = match frame {
            VelocityFrame::North => velocity.value,
            VelocityFrame::Free => self.turned(&velocity.value),
            VelocityFrame::Body => then.attitude * velocity.value,
        };
        let least_m_s = settings.velocity_noise_m_s;
        let [horizontal, vertical] =
            velocity.deviations(least_m_s, LEAST_CERTAIN_M_S, settings.believes_told_noise);
        // A body that leans tells of each axis with the noise of all.
        let vertical = if frame == VelocityFrame::Body { vertical.max(horizontal) } else { vertical };
        let deviations_m_s = [
            if uses.velocity { horizontal } else { UNKNOWN_M_S },
            if uses.climb { vertical } else { UNKNOWN_M_S },
        ];
        estimator.fuse_velocity(terms.taken_us(), &value_m_s, deviations_m_s, settings.place_m)
    }

    /// A vector of a frame that points anywhere, NED.
    fn turned(&self, vector: &Vector3<f64>) -> Vector3<f64> {
        UnitQuaternion::from_axis_angle(&Vector3::z_axis(), self.turn_rad) * vector
    }
}
