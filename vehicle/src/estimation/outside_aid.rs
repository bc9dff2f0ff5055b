//! What the estimator does with estimates from outside, step by step. `vision/fusion.rs` says when.
//!
//! The filter has one source of positions, velocities and headings from outside, that of a GPS receiver. It believes that a receiver's
//! errors last; those of vision it takes for white, so that it gets other settings while there is vision.

use fusion_nav::{
    Altitude, AltitudeNoise, Attitude, ErrorState, Eskf, HeadingNoise, Position, PositionNoise, Quaternion,
    Radians, State, StaticWindow, Status, Timestamp, Velocity, VelocityNoise,
};
use nalgebra::{UnitQuaternion, Vector2, Vector3};

use super::estimator::{Estimator, double, fitted, single};
use super::gps::{self, GpsFix, UNKNOWN_M, UNKNOWN_M_S};
use super::tuning::{self, OutsideGates};
use super::vision::Moment;

/// A vehicle that nothing from outside has told its place or its velocity for longer knows neither, µs: EKF2_NOAID_TOUT.
const PATIENCE_US: u64 = 5_000_000;

/// A place, or a part of one, to which the estimate moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// North and east, m, and the standard deviation, m.
    pub horizontal: Option<(Vector2<f64>, f64)>,
    /// Down, m, and the standard deviation, m.
    pub down: Option<(f64, f64)>,
}

impl Estimator {
    /// Fuses with other gates while there is vision, or as without it.
    pub fn fuse_outside_with(&mut self, gates: Option<OutsideGates>) {
        if self.outside == gates {
            return;
        }
        let mut filter = match Eskf::new(tuning::configuration_for(gates)) {
            Ok(filter) => filter,
            Err(error) => {
                tracing::warn!(%error, "the estimator's settings are refused");
                return;
            }
        };
        if !self.has_changed && self.filter.state().status != Status::DeadReckoning {
            self.note_aid();
        }
        self.outside = gates;
        self.has_changed = true;
        // Without a heading there is nothing to go on with.
        if self.filter.is_aligned() {
            let time = Timestamp::from_micros(self.predicted_us);
            if let Err(error) = filter.initialize_from(self.filter.state(), *self.filter.covariance(), time) {
                tracing::warn!(%error, "the estimator begins anew");
            } else if let Some(reference) = self.filter.baro_reference() {
                let is_kept = filter.set_baro_reference(reference, reference_noise());
                tracing::trace!(is_kept, "the barometer's reference");
            }
        }
        self.window = StaticWindow::new();
        self.filter = filter;
    }

    /// Takes a position, NED, m, with its horizontal and vertical standard deviations, m; tells which half fitted. `place_m` is where on
    /// the vehicle it was measured, FRD, m.
    pub fn fuse_position(
        &mut self,
        time_us: u64,
        position_m: &Vector3<f64>,
        deviations_m: [f64; 2],
        place_m: [f64; 3],
    ) -> [bool; 2] {
        let before = self.filter.state();
        let fits = self.filter_position(time_us, position_m, deviations_m, place_m);
        self.hold_back(&before);
        fits
    }

    /// Takes a velocity, NED, m/s, with its horizontal and vertical standard deviations, m/s; tells whether it fitted.
    pub fn fuse_velocity(
        &mut self,
        time_us: u64,
        velocity_m_s: &Vector3<f64>,
        deviations_m_s: [f64; 2],
        place_m: [f64; 3],
    ) -> bool {
        let before = self.filter.state();
        let fits = self.filter_velocity(time_us, velocity_m_s, deviations_m_s, place_m);
        self.hold_back(&before);
        fits
    }

    /// Hands a position to the filter, as [`fuse_position`](Self::fuse_position) takes it, and tells which half fitted.
    pub(super) fn filter_position(
        &mut self,
        time_us: u64,
        position_m: &Vector3<f64>,
        [horizontal_m, vertical_m]: [f64; 2],
        place_m: [f64; 3],
    ) -> [bool; 2] {
        let outcome = self.filter.fuse_gnss_position(
            Timestamp::from_micros(time_us),
            Position::from_array(single(position_m)),
            PositionNoise::horizontal_vertical(horizontal_m as f32, vertical_m as f32),
            Position::from_array(place_m.map(|axis| axis as f32)),
        );
        self.resets += u32::from(outcome.is_reset());
        self.leaps |= outcome.is_reset();
        let fits = [fitted(outcome.horizontal), fitted(outcome.height)];
        if fits[0] && horizontal_m < UNKNOWN_M {
            self.note_aid();
        }
        fits
    }

    /// Hands a velocity to the filter, as [`fuse_velocity`](Self::fuse_velocity) takes it, and tells whether it fitted.
    pub(super) fn filter_velocity(
        &mut self,
        time_us: u64,
        velocity_m_s: &Vector3<f64>,
        [horizontal_m_s, vertical_m_s]: [f64; 2],
        place_m: [f64; 3],
    ) -> bool {
        let outcome = self.filter.fuse_gnss_velocity(
            Timestamp::from_micros(time_us),
            Velocity::from_array(single(velocity_m_s)),
            VelocityNoise::horizontal_vertical(horizontal_m_s as f32, vertical_m_s as f32),
            Position::from_array(place_m.map(|axis| axis as f32)),
        );
        self.resets += u32::from(outcome.is_reset());
        if fitted(outcome) && horizontal_m_s < UNKNOWN_M_S {
            self.note_aid();
        }
        fitted(outcome)
    }

    /// Takes a heading, rad, with its standard deviation, rad; tells whether it fitted.
    pub fn fuse_heading(&mut self, time_us: u64, heading_rad: f64, deviation_rad: f64) -> bool {
        let heading = Radians::from_radians(heading_rad as f32);
        let noise = HeadingNoise::from_sigma(deviation_rad as f32);
        fitted(self.filter.fuse_gnss_heading(Timestamp::from_micros(time_us), heading, noise))
    }

    /// Standard deviation of the estimated heading, rad.
    pub fn heading_deviation_rad(&self) -> f64 {
        libm::sqrt(f64::from(self.filter.attitude_variance().heading))
    }

    /// What the filter knows now.
    pub fn moment(&self) -> Moment {
        let state = self.filter.state();
        Moment {
            time_us: self.predicted_us,
            position_m: double(state.position.to_array()),
            velocity_m_s: double(state.velocity.to_array()),
            attitude: attitude_of(&state),
        }
    }

    /// Moves the estimate to a place at once. A vehicle that stands is told there, too, at once; by and by otherwise. Returns by how
    /// much it has moved, m.
    pub fn move_to(&mut self, place: &Place, stands: bool) -> Vector3<f64> {
        let before = self.filter.state();
        let before_m = double(before.position.to_array());
        let variance = |state| f64::from(self.filter.covariance().variance(state));
        let kept_m = |state| libm::sqrt(variance(state)) as f32;
        let (mut there_m, mut deviations_m) = (
            before_m,
            [ErrorState::PositionNorth, ErrorState::PositionEast, ErrorState::PositionDown].map(kept_m),
        );
        if let Some((horizontal_m, deviation_m)) = place.horizontal {
            (there_m.x, there_m.y) = (horizontal_m.x, horizontal_m.y);
            (deviations_m[0], deviations_m[1]) = (deviation_m as f32, deviation_m as f32);
        }
        if let Some((down_m, deviation_m)) = place.down {
            there_m.z = down_m;
            deviations_m[2] = deviation_m as f32;
        }
        let [north, east, down] = deviations_m;
        let noise = PositionNoise::from_sigma(north, east, down);
        if !self.filter.reset_position_to(Position::from_array(single(&there_m)), noise) {
            tracing::debug!(?there_m, "the estimate does not move there");
            return Vector3::zeros();
        }
        let moved_m = there_m - before_m;
        if let (Some(_), Some(reference)) = (place.down, self.filter.baro_reference()) {
            let shifted = Altitude::from_meters(reference.as_meters() + moved_m.z as f32);
            let is_kept = self.filter.set_baro_reference(shifted, reference_noise());
            tracing::trace!(is_kept, "the barometer's reference moves along");
        }
        self.resets += 1;
        self.tell_leap(&before, stands, place.horizontal.is_some());
        if place.horizontal.is_some() {
            self.note_aid();
        }
        moved_m
    }

    /// Turns the estimate about the vertical axis by an angle, rad, at once, and the velocity with it if the frame has turned.
    pub fn turn_by(&mut self, angle_rad: f64, with_frame: bool) -> bool {
        let state = self.filter.state();
        let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle_rad);
        let [w, x, y, z] = {
            let turned = turn * attitude_of(&state);
            [turned.w, turned.i, turned.j, turned.k].map(|part| part as f32)
        };
        let velocity_m_s = double(state.velocity.to_array());
        let velocity_m_s = if with_frame { turn * velocity_m_s } else { velocity_m_s };
        let turned = State {
            attitude: Attitude::from_body_to_ned(Quaternion { w, x, y, z }),
            velocity: Velocity::from_array(single(&velocity_m_s)),
            ..state
        };
        let time = Timestamp::from_micros(self.predicted_us);
        let covariance = *self.filter.covariance();
        if let Err(error) = self.filter.initialize_from(turned, covariance, time) {
            tracing::warn!(%error, "the estimator does not turn");
            return false;
        }
        tracing::debug!(angle_rad, "the estimate turns");
        self.resets += 1;
        true
    }

    /// Moves the estimate to the place of a fix.
    pub(super) fn move_to_fix(&mut self, fix: &GpsFix) {
        let late_s = self.predicted_us.saturating_sub(fix.time_us) as f64 / 1e6;
        let there_m = fix.position_m.xy() + fix.velocity_m_s.xy() * late_s;
        let place = Place { horizontal: Some((there_m, fix.horizontal_accuracy_m)), down: None };
        self.move_to(&place, false);
    }

    /// A fix as the filter has to see it: an error that lasts is in it already while the filter takes errors for white.
    pub(super) fn seen(&self, fix: &GpsFix) -> GpsFix {
        if self.outside.is_none() {
            return *fix;
        }
        let period_s = gps::PERIOD_US as f64 / 1e6;
        let position = |deviation_m: f64| tuning::lasting(deviation_m, gps::POSITION_CORRELATION_S, period_s);
        let velocity =
            |deviation_m_s: f64| tuning::lasting(deviation_m_s, gps::VELOCITY_CORRELATION_S, period_s);
        GpsFix {
            horizontal_accuracy_m: position(fix.horizontal_accuracy_m).min(UNKNOWN_M),
            vertical_accuracy_m: position(fix.vertical_accuracy_m).min(UNKNOWN_M),
            velocity_accuracy_m_s: velocity(fix.velocity_accuracy_m_s).min(UNKNOWN_M_S),
            climb_accuracy_m_s: velocity(fix.climb_accuracy_m_s).min(UNKNOWN_M_S),
            ..*fix
        }
    }

    /// Whether anything from outside has told the place or the velocity lately. The filter knows, unless it has got other settings: then
    /// it has forgotten.
    pub(super) fn is_aided(&self, status: Status) -> bool {
        if !self.has_changed {
            return status != Status::DeadReckoning;
        }
        self.aided_us.is_some_and(|aided_us| self.predicted_us.saturating_sub(aided_us) <= PATIENCE_US)
    }

    /// Something has told the place or the velocity.
    pub(super) fn note_aid(&mut self) {
        self.aided_us = Some(self.predicted_us);
    }

    /// A leap since `before` reaches the controllers by and by, or at once if the vehicle stands.
    fn tell_leap(&mut self, before: &State, stands: bool, horizontal: bool) {
        if stands {
            self.position_release.let_go();
            self.velocity_release.let_go();
        } else {
            self.hold_back(before);
            self.leaps |= horizontal;
        }
    }
}

/// The attitude of a state, FRD into NED.
fn attitude_of(state: &State) -> UnitQuaternion<f64> {
    let q = state.attitude.body_to_ned();
    UnitQuaternion::new_normalize(nalgebra::Quaternion::new(q.w.into(), q.x.into(), q.y.into(), q.z.into()))
}

/// How well the barometer's reference is known that is taken over.
fn reference_noise() -> AltitudeNoise {
    AltitudeNoise::from_sigma(tuning::START_M)
}
