//! The estimator: an error-state extended Kalman filter of attitude, velocity, position and the offsets of gyroscopes
//! and accelerometers (15 states; the crate `fusion-nav`), fed by the instruments.

use fusion_nav::{
    Acceleration, Altitude, AngularRate, Covariance, ErrorState, Eskf, Fusion, ImuSample, MagField, Position,
    PositionNoise, Seconds, SourceHealth, State, StaticSample, StaticWindow, Timestamp, Velocity,
    VelocityNoise,
};
use nalgebra::{Quaternion, UnitQuaternion, Vector2, Vector3};

use super::barometer::BarometerReading;
use super::estimate::{Estimate, TestRatios, Validity};
use super::gps::GpsFix;
use super::inertial::InertialReading;
use super::leap::LeapWatch;
use super::lockout::Lockout;
use super::magnetometer::MagnetometerReading;
use super::release::Release;
use super::tuning::{self, OutsideGates};

/// Time between predictions, µs: the default rate at which PX4 integrates its inertial unit, 200 Hz. It divides the
/// samples of the controllers.
const PREDICTION_US: u64 = 5_000;
/// How fast the controllers are told that the vehicle is elsewhere, m/s, and moves otherwise, m/s²: after 15 s without
/// fixes they then lean by a tenth of a radian.
const POSITION_RELEASE_M_S: f64 = 0.5;
const VELOCITY_RELEASE_M_S2: f64 = 0.5;
/// With less than this left, m, a leap of the position has been told.
const TOLD_M: f64 = 0.1;
/// The antenna sits on the inertial unit.
const NO_LEVER: [f64; 3] = [0.0; 3];

/// The estimator.
#[derive(Clone, Debug)]
pub struct Estimator {
    pub(super) filter: Eskf,
    /// What has been measured at rest, until there is enough to align by.
    pub(super) window: StaticWindow,
    /// Inertial readings since the last prediction.
    pending: Option<ImuSample>,
    /// Time of the last inertial reading and of the last prediction, µs.
    read_us: u64,
    pub(super) predicted_us: u64,
    /// The latest readings that the window has not had yet.
    altitude: Option<Altitude>,
    field: Option<MagField<fusion_nav::Body>>,
    estimate: Estimate,
    pub(super) resets: u32,
    lockout: Lockout,
    leap_watch: LeapWatch,
    /// How many resets there were with the latest fix.
    watched_resets: u32,
    pub(super) position_release: Release,
    pub(super) velocity_release: Release,
    /// Whether a leap of the position is still to be told.
    pub(super) leaps: bool,
    /// With which gates it fuses estimates from outside, if there are any.
    pub(super) outside: Option<OutsideGates>,
    /// Whether that has ever changed.
    pub(super) has_changed: bool,
    /// When something has told the place or the velocity last, µs.
    pub(super) aided_us: Option<u64>,
    /// Whether the next fix tells the place, whatever the filter believes.
    returns: bool,
}

impl Estimator {
    /// One that is told where the vehicle stands. It needs two seconds of rest to align.
    pub fn new(start: Estimate) -> Self {
        let filter = match Eskf::new(tuning::configuration()) {
            Ok(filter) => filter,
            Err(error) => {
                // The settings are constants that a test checks.
                tracing::error!(%error, "the estimator's settings are refused");
                Eskf::default()
            }
        };
        Self {
            filter,
            window: StaticWindow::new(),
            pending: None,
            read_us: 0,
            predicted_us: 0,
            altitude: None,
            field: None,
            estimate: start,
            resets: 0,
            lockout: Lockout::default(),
            leap_watch: LeapWatch::default(),
            watched_resets: 0,
            position_release: Release::new(POSITION_RELEASE_M_S),
            velocity_release: Release::new(VELOCITY_RELEASE_M_S2),
            leaps: false,
            outside: None,
            has_changed: false,
            aided_us: None,
            returns: false,
        }
    }

    /// Positions are the receiver's again, after they were somebody else's: the next fix tells the place.
    pub fn return_to_gps(&mut self) {
        self.returns = true;
    }

    /// Takes a reading of the inertial unit in. Every 5 ms the estimate goes on.
    pub fn inertial(&mut self, reading: &InertialReading) {
        if reading.time_us <= self.read_us {
            return;
        }
        let sample = ImuSample::from_rates(
            Timestamp::from_micros(reading.time_us),
            AngularRate::from_array(single(&reading.body_rate_rad_s)),
            Acceleration::from_array(single(&reading.specific_force_m_s2)),
            Seconds::from_secs((reading.time_us - self.read_us) as f32 / 1e6),
        );
        self.read_us = reading.time_us;
        let pending = self.pending.map_or(sample, |earlier| earlier.accumulate(sample));
        self.pending = Some(pending);
        if reading.time_us - self.predicted_us < PREDICTION_US {
            return;
        }
        let dt_s = (reading.time_us - self.predicted_us) as f64 / 1e6;
        self.predicted_us = reading.time_us;
        self.pending = None;
        if self.filter.is_initialized() {
            let outcome = self.filter.predict(pending);
            if !outcome.is_propagated() {
                tracing::debug!(?outcome, "an inertial reading was not used");
            }
        } else {
            self.align(pending);
        }
        self.read(reading, dt_s);
    }

    /// Takes a fix in, and tells whether it fitted. `starts_again` tells whether a receiver that goes on contradicting the inertial unit
    /// is believed in its place.
    pub fn gps(&mut self, fix: &GpsFix, starts_again: bool) -> bool {
        if !self.filter.is_initialized() {
            return true;
        }
        if std::mem::take(&mut self.returns) {
            self.move_to_fix(fix);
            return true;
        }
        let fix = &self.seen(fix);
        let before = self.filter.state();
        let place_noise = [fix.horizontal_accuracy_m, fix.vertical_accuracy_m];
        let motion_noise = [fix.velocity_accuracy_m_s, fix.climb_accuracy_m_s];
        let place = self.filter_position(fix.time_us, &fix.position_m, place_noise, NO_LEVER);
        let motion = self.filter_velocity(fix.time_us, &fix.velocity_m_s, motion_noise, NO_LEVER);
        self.hold_back(&before);
        if self.lockout.update(fix, motion) && starts_again {
            self.start_again(fix);
        }
        self.follow_leap(fix);
        place == [true; 2] && motion
    }

    /// Moves to a receiver that has leapt and stays there, whether the filter rejects it or not.
    fn follow_leap(&mut self, fix: &GpsFix) {
        let resets = std::mem::replace(&mut self.watched_resets, self.resets);
        if self.outside.is_some() || !fix.tells_place() || resets != self.resets {
            // Somebody else tells the place, too, or it is not the receiver that has leapt.
            self.leap_watch = LeapWatch::default();
            return;
        }
        let innovation = self.filter.diagnostics().gnss_position.innovation;
        let Some([north_m, east_m]) = innovation.as_ref().and_then(|off| off.values().first_chunk()) else {
            return;
        };
        if self.leap_watch.update(fix, Vector2::new(*north_m, *east_m).cast()) {
            self.move_to_fix(fix);
        }
    }

    /// Takes a pressure in, and tells whether it fitted.
    pub fn barometer(&mut self, reading: &BarometerReading) -> bool {
        let altitude = Altitude::from_meters(reading.altitude_m() as f32);
        if !self.filter.is_initialized() {
            self.altitude = Some(altitude);
            return true;
        }
        let time = Timestamp::from_micros(reading.time_us);
        let noise = tuning::altitude_noise(reading.pressure_pa);
        let before = self.filter.state();
        let outcome = self.filter.fuse_baro_altitude(time, altitude, noise);
        self.hold_back(&before);
        fitted(outcome)
    }

    /// Takes a magnetic field in, and tells whether it fitted.
    pub fn magnetometer(&mut self, reading: &MagnetometerReading) -> bool {
        let field = MagField::from_array(single(&reading.field_gauss));
        if !self.filter.is_initialized() {
            self.field = Some(field);
            return true;
        }
        let time = Timestamp::from_micros(reading.time_us);
        fitted(self.filter.fuse_mag_heading(time, field, tuning::heading_noise()))
    }

    /// The vehicle stands: it has no velocity.
    pub fn stands(&mut self, time_us: u64) {
        if self.filter.is_initialized() {
            let noise = VelocityNoise::horizontal_vertical(tuning::STILL_M_S, tuning::STILL_M_S);
            let outcome = self.filter.fuse_stationary(Timestamp::from_micros(time_us), noise);
            tracing::trace!(?outcome, "the vehicle stands");
        }
    }

    /// The estimate of the last prediction.
    pub fn estimate(&self) -> &Estimate {
        &self.estimate
    }

    /// Whether it fuses: it has measured at rest what it begins with.
    pub fn can_fuse(&self) -> bool {
        self.filter.is_initialized()
    }

    /// Whether it has found its attitude.
    pub fn is_aligned(&self) -> bool {
        self.filter.is_aligned()
    }

    /// Covariance of the errors of position and velocity (NED), attitude (FRD), and offsets.
    pub fn covariance(&self) -> &Covariance {
        self.filter.covariance()
    }

    /// What the filter has made of each source.
    pub fn diagnostics(&self) -> &fusion_nav::Diagnostics {
        self.filter.diagnostics()
    }

    fn align(&mut self, imu: ImuSample) {
        let sample = StaticSample {
            imu,
            mag: self.field.take(),
            baro: self.altitude.take(),
            ..StaticSample::default()
        };
        if self.window.push(sample).is_err() {
            return;
        }
        if !self.window.is_at_rest(self.filter.config()) {
            self.window = StaticWindow::new();
            return;
        }
        if !self.window.is_long_enough(self.filter.config()) {
            return;
        }
        match self.filter.initialize(&self.window) {
            Ok(_) => {
                let place = Position::from_array(single(&self.estimate.body.position_m));
                let told = PositionNoise::horizontal_vertical(tuning::START_M, tuning::START_M);
                if !self.filter.reset_position_to(place, told) {
                    tracing::warn!(?place, "the estimator does not start here");
                }
            }
            Err(error) => tracing::warn!(%error, "the estimator does not align"),
        }
        self.window = StaticWindow::new();
    }

    /// The receiver is right, and the inertial unit is not what it was: takes its velocity over at once, and looks for the offsets
    /// again. The crate's own recovery takes the velocity over, but goes on believing the offsets.
    fn start_again(&mut self, fix: &GpsFix) {
        let state =
            State { velocity: Velocity::from_array(single(&fix.velocity_m_s)), ..self.filter.state() };
        let doubts = Covariance::from_sigmas(tuning::DOUBTS);
        match self.filter.initialize_from(state, doubts, Timestamp::from_micros(self.predicted_us)) {
            Ok(_) => {
                self.resets += 1;
                self.estimate.restarted_us = Some(self.predicted_us);
            }
            Err(error) => tracing::warn!(%error, "the estimator does not start again"),
        }
    }

    /// Holds back what a measurement has corrected since `before`.
    pub(super) fn hold_back(&mut self, before: &State) {
        let now = self.filter.state();
        let position = double(now.position.to_array()) - double(before.position.to_array());
        let velocity = double(now.velocity.to_array()) - double(before.velocity.to_array());
        self.position_release.hold(&position);
        self.velocity_release.hold(&velocity);
    }

    /// What the filter knows now, `dt_s` after the last time.
    fn read(&mut self, reading: &InertialReading, dt_s: f64) {
        self.estimate.time_us = reading.time_us;
        if !self.filter.is_initialized() {
            return;
        }
        let state = self.filter.state();
        let q = state.attitude.body_to_ned();
        let attitude = Quaternion::new(q.w.into(), q.x.into(), q.y.into(), q.z.into());
        let held_velocity = self.velocity_release.step(dt_s);
        // The position that is told goes on with the velocity that is told.
        self.position_release.hold(&(held_velocity * dt_s));
        let body = &mut self.estimate.body;
        let held_m = self.position_release.held();
        let still_held_m = self.position_release.step(dt_s);
        body.position_m = double(state.position.to_array()) - still_held_m;
        if self.leaps {
            self.estimate.slid_m += (held_m - still_held_m).xy();
            self.leaps = still_held_m.xy().norm() > TOLD_M;
        }
        body.velocity_m_s = double(state.velocity.to_array()) - held_velocity;
        body.attitude = UnitQuaternion::new_normalize(attitude).into_inner();
        body.body_rate_rad_s = reading.body_rate_rad_s - double(state.gyro_bias.to_array());
        let aided = self.is_aided(state.status);
        self.estimate.validity = Validity {
            tilt: state.validity.tilt,
            heading: state.validity.heading,
            horizontal_velocity: state.validity.horizontal_velocity && aided,
            vertical_velocity: state.validity.vertical_velocity,
            horizontal_position: state.validity.horizontal_position && aided,
            vertical_position: state.validity.vertical_position,
        };
        let variance = |state| f64::from(self.filter.covariance().variance(state));
        let horizontal = variance(ErrorState::PositionNorth) + variance(ErrorState::PositionEast);
        self.estimate.horizontal_accuracy_m = libm::sqrt(horizontal / 2.0);
        self.estimate.vertical_accuracy_m = libm::sqrt(variance(ErrorState::PositionDown));
        let diagnostics = self.filter.diagnostics();
        self.estimate.test_ratios = TestRatios {
            velocity: ratio(&diagnostics.gnss_velocity),
            horizontal_position: ratio(&diagnostics.gnss_position),
            height: ratio(&diagnostics.baro_altitude),
            heading: ratio(if diagnostics.gnss_heading.has_been_used() {
                &diagnostics.gnss_heading
            } else {
                &diagnostics.mag_heading
            }),
        };
        self.estimate.resets = self.resets;
    }
}

fn ratio(source: &SourceHealth) -> f64 {
    source.test_ratio.map_or(0.0, f64::from)
}

/// Whether a measurement was what was expected, or has become so.
pub(super) fn fitted(outcome: Fusion) -> bool {
    outcome.is_accepted() || outcome.is_reset()
}

pub(super) fn single(vector: &Vector3<f64>) -> [f32; 3] {
    vector.data.0[0].map(|value| value as f32)
}

pub(super) fn double(vector: [f32; 3]) -> Vector3<f64> {
    Vector3::from(vector.map(f64::from))
}
