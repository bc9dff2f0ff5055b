//! Instruments and estimator together, tick by tick.

use super::barometer::{Barometer, BarometerReading};
use super::estimate::Estimate;
use super::estimator::Estimator;
use super::gps::{GpsFix, GpsReceiver};
use super::inertial::{InertialReading, InertialUnit};
use super::magnetometer::{Magnetometer, MagnetometerReading};
use super::true_motion::TrueMotion;
use super::vibration::Vibration;
use super::watch::Watch;
use crate::world::{LocalFrame, atmospheric_pressure_pa, earth_field_ned};

/// A vehicle at rest says so to the estimator this often, µs.
const STANDS_PERIOD_US: u64 = 100_000;
/// An inertial unit that repeats itself for longer is broken, µs; the others read more rarely.
const INERTIAL_PATIENCE_US: u64 = 50_000;
const PATIENCE_US: u64 = 500_000;
/// A source that the filter has rejected for longer is not believed, s.
const REJECTION_PATIENCE_S: f64 = 2.0;

/// The latest readings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Readings {
    /// Inertial unit.
    pub inertial: InertialReading,
    /// GPS receiver, once it has had a fix.
    pub gps: Option<GpsFix>,
    /// Barometer.
    pub barometer: Option<BarometerReading>,
    /// Magnetometer.
    pub magnetometer: Option<MagnetometerReading>,
}

/// Which instruments work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InstrumentHealth {
    /// Gyroscopes.
    pub gyroscope: bool,
    /// Accelerometers.
    pub accelerometer: bool,
    /// Magnetometer.
    pub magnetometer: bool,
    /// Barometer.
    pub barometer: bool,
    /// GPS receiver.
    pub gps: bool,
}

impl Readings {
    /// What instruments without errors would show.
    pub fn exact(motion: &TrueMotion, frame: &LocalFrame) -> Self {
        let time_us = motion.time_us;
        let place = frame.to_geodetic(&motion.position_m);
        let field = earth_field_ned(&place);
        Self {
            inertial: InertialReading {
                time_us,
                body_rate_rad_s: motion.body_rate_rad_s,
                specific_force_m_s2: motion.specific_force_m_s2,
            },
            gps: Some(GpsFix::exact(motion)),
            barometer: Some(BarometerReading {
                time_us,
                pressure_pa: atmospheric_pressure_pa(place.altitude_m),
            }),
            magnetometer: Some(MagnetometerReading {
                time_us,
                field_gauss: motion.attitude.inverse_transform_vector(&field),
            }),
        }
    }
}

impl InstrumentHealth {
    /// All of them.
    pub const ALL: Self =
        Self { gyroscope: true, accelerometer: true, magnetometer: true, barometer: true, gps: true };
}

/// Instruments and estimator.
#[derive(Clone, Debug)]
pub struct Navigation {
    inertial: InertialUnit,
    gps: GpsReceiver,
    barometer: Barometer,
    magnetometer: Magnetometer,
    estimator: Estimator,
    vibration: Vibration,
    readings: Option<Readings>,
    gyroscope_watch: Watch,
    accelerometer_watch: Watch,
    barometer_watch: Watch,
    magnetometer_watch: Watch,
    time_us: u64,
}

impl Navigation {
    /// Switched on under a seed, at a place and a heading that the estimator is told.
    pub fn new(seed: u64, start: Estimate) -> Self {
        Self {
            inertial: InertialUnit::new(seed),
            gps: GpsReceiver::new(seed),
            barometer: Barometer::new(seed),
            magnetometer: Magnetometer::new(seed),
            estimator: Estimator::new(start),
            vibration: Vibration::default(),
            readings: None,
            gyroscope_watch: Watch::default(),
            accelerometer_watch: Watch::default(),
            barometer_watch: Watch::default(),
            magnetometer_watch: Watch::default(),
            time_us: 0,
        }
    }

    /// One tick: the vehicle moves like this, and stands or not.
    pub fn step(&mut self, motion: &TrueMotion, frame: &LocalFrame, stands: bool) {
        let time_us = motion.time_us;
        self.time_us = time_us;
        let inertial = self.inertial.sample(motion);
        self.gyroscope_watch.update(time_us, inertial.body_rate_rad_s.into());
        self.accelerometer_watch.update(time_us, inertial.specific_force_m_s2.into());
        self.vibration.update(&inertial);
        self.estimator.inertial(&inertial);
        let before = self.readings;
        let readings = self.readings.insert(Readings {
            inertial,
            gps: before.and_then(|readings| readings.gps),
            barometer: before.and_then(|readings| readings.barometer),
            magnetometer: before.and_then(|readings| readings.magnetometer),
        });
        let altitude_m = frame.origin().altitude_m - motion.position_m.z;
        if let Some(reading) = self.barometer.sample(time_us, altitude_m) {
            self.barometer_watch.update(time_us, [reading.pressure_pa, 0.0, 0.0]);
            self.estimator.barometer(&reading);
            readings.barometer = Some(reading);
        }
        let field = || earth_field_ned(&frame.to_geodetic(&motion.position_m));
        if let Some(reading) = self.magnetometer.sample(time_us, &motion.attitude, field) {
            self.magnetometer_watch.update(time_us, reading.field_gauss.into());
            self.estimator.magnetometer(&reading);
            readings.magnetometer = Some(reading);
        }
        if let Some(fix) = self.gps.sample(motion) {
            self.estimator.gps(&fix);
            readings.gps = Some(fix);
        }
        if stands && time_us.is_multiple_of(STANDS_PERIOD_US) {
            self.estimator.stands(time_us);
        }
    }

    /// The estimate.
    pub fn estimate(&self) -> &Estimate {
        self.estimator.estimate()
    }

    /// The estimator.
    pub fn estimator(&self) -> &Estimator {
        &self.estimator
    }

    /// The latest readings; none before the first tick.
    pub fn readings(&self) -> Option<&Readings> {
        self.readings.as_ref()
    }

    /// How much the accelerometers shake.
    pub fn vibration(&self) -> &Vibration {
        &self.vibration
    }

    /// How often each accelerometer was beyond its range.
    pub fn clipped(&self) -> [u32; 3] {
        self.inertial.clipped()
    }

    /// Which instruments work, and are believed.
    pub fn health(&self) -> InstrumentHealth {
        let diagnostics = self.estimator.diagnostics();
        let believed = |source: &fusion_nav::SourceHealth| {
            source.time_since_accepted.is_none_or(|time| f64::from(time.as_secs()) <= REJECTION_PATIENCE_S)
        };
        let fix = self.readings.and_then(|readings| readings.gps);
        let fresh = fix.is_some_and(|fix| fix.is_fresh(self.time_us));
        InstrumentHealth {
            gyroscope: self.gyroscope_watch.is_alive(self.time_us, INERTIAL_PATIENCE_US),
            accelerometer: self.accelerometer_watch.is_alive(self.time_us, INERTIAL_PATIENCE_US),
            magnetometer: self.magnetometer_watch.is_alive(self.time_us, PATIENCE_US)
                && believed(&diagnostics.mag_heading),
            barometer: self.barometer_watch.is_alive(self.time_us, PATIENCE_US)
                && believed(&diagnostics.baro_altitude),
            gps: fresh && believed(&diagnostics.gnss_position) && believed(&diagnostics.gnss_velocity),
        }
    }
}
