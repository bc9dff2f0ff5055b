//! Instruments and estimator together, tick by tick.

use std::collections::VecDeque;

use super::aiding::{Aiding, GpsUse};
use super::barometer::{self, Barometer, BarometerReading};
use super::defect::{Axes, Defect};
use super::estimate::Estimate;
use super::estimator::Estimator;
use super::gps::{self, GpsFix, GpsReceiver, UNKNOWN_M, UNKNOWN_M_S};
use super::inertial::{InertialReading, InertialUnit};
use super::magnetometer::{self, Magnetometer, MagnetometerReading};
use super::sensor_errors::{ErrorSource, SensorErrors};
use super::true_motion::TrueMotion;
use super::tuning::OutsideGates;
use super::vibration::Vibration;
use super::vision::{VisionFusion, VisionReading, VisionTerms};
use super::watch::{Trust, Watch};
use crate::fault::{Faults, Sensor};
use crate::world::{Geodetic, LocalFrame, atmospheric_pressure_pa, earth_field_ned};

/// A vehicle at rest says so to the estimator this often, µs.
const STANDS_PERIOD_US: u64 = 100_000;
/// An inertial unit that repeats itself for longer is broken, µs; the others read more rarely.
const INERTIAL_PATIENCE_US: u64 = 50_000;
const PATIENCE_US: u64 = 500_000;
/// A receiver without a new fix for longer has lost its position, µs.
const FIX_PATIENCE_US: u64 = 1_000_000;
/// The same of estimates from outside.
const VISION_PATIENCE_US: u64 = 1_000_000;
/// Most estimates from outside that wait for a tick.
const MOST_SEEN: usize = 8;
/// They usually come 30 times a second, µs.
const VISION_PERIOD_US: u64 = 33_333;

/// The latest readings.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Readings {
    /// Inertial unit; zeros before it has said anything.
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
    /// Estimates from outside.
    pub vision: bool,
}

impl InstrumentHealth {
    /// Whether the vertical motion is felt, and something corrects the height.
    pub fn supports_height(&self) -> bool {
        self.accelerometer && (self.gps || self.barometer || self.vision)
    }
}

impl Readings {
    /// What instruments without errors would show of a motion at a place.
    pub fn exact(motion: &TrueMotion, place: &Geodetic) -> Self {
        let time_us = motion.time_us;
        let field = earth_field_ned(place);
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

/// What may be wrong with each instrument.
#[derive(Clone, Debug)]
struct Defects {
    gyroscope: Defect<Axes>,
    accelerometer: Defect<Axes>,
    magnetometer: Defect<MagnetometerReading>,
    barometer: Defect<BarometerReading>,
    gps: Defect<GpsFix>,
}

/// Instruments and estimator.
#[derive(Clone, Debug)]
pub struct Navigation {
    inertial: InertialUnit,
    gps: GpsReceiver,
    /// A fix from outside that has not been looked at.
    received: Option<GpsFix>,
    /// Estimates from outside that have not been looked at.
    seen: VecDeque<VisionReading>,
    vision: VisionFusion,
    /// What is fused.
    aiding: Aiding,
    barometer: Barometer,
    magnetometer: Magnetometer,
    estimator: Estimator,
    vibration: Vibration,
    readings: Readings,
    defects: Defects,
    errors: ErrorSource,
    gyroscope_watch: Watch,
    accelerometer_watch: Watch,
    barometer_watch: Watch,
    magnetometer_watch: Watch,
    gps_watch: Watch,
    vision_watch: Watch,
    barometer_trust: Trust,
    magnetometer_trust: Trust,
    gps_trust: Trust,
    vision_trust: Trust,
    time_us: u64,
}

impl Navigation {
    /// Switched on under a seed, at a place and a heading that the estimator is told.
    pub fn new(seed: u64, start: Estimate) -> Self {
        Self {
            inertial: InertialUnit::new(seed),
            gps: GpsReceiver::new(seed, gps::LATENCY_US),
            received: None,
            seen: VecDeque::with_capacity(MOST_SEEN),
            vision: VisionFusion::default(),
            aiding: Aiding::default(),
            barometer: Barometer::new(seed),
            magnetometer: Magnetometer::new(seed),
            estimator: Estimator::new(start),
            vibration: Vibration::default(),
            readings: Readings::default(),
            defects: Defects {
                gyroscope: Defect::new(Sensor::Gyroscope, seed),
                accelerometer: Defect::new(Sensor::Accelerometer, seed),
                magnetometer: Defect::new(Sensor::Magnetometer, seed),
                barometer: Defect::new(Sensor::Barometer, seed),
                gps: Defect::new(Sensor::Gps, seed),
            },
            errors: ErrorSource::new(seed),
            gyroscope_watch: Watch::default(),
            accelerometer_watch: Watch::default(),
            barometer_watch: Watch::default(),
            magnetometer_watch: Watch::default(),
            gps_watch: Watch::default(),
            vision_watch: Watch::default(),
            barometer_trust: Trust::default(),
            magnetometer_trust: Trust::default(),
            gps_trust: Trust::default(),
            vision_trust: Trust::default(),
            time_us: 0,
        }
    }

    /// One tick: the vehicle moves like this, with these faults and errors, and stands or not.
    pub fn step(
        &mut self,
        motion: &TrueMotion,
        frame: &LocalFrame,
        faults: &Faults,
        errors: &SensorErrors,
        aiding: &Aiding,
        stands: bool,
    ) {
        let time_us = motion.time_us;
        self.time_us = time_us;
        self.choose(aiding);
        let errors = Some(errors).filter(|errors| **errors != SensorErrors::default());
        self.read_inertial(motion, faults, errors);
        self.read_barometer(motion, frame, faults, errors);
        self.read_magnetometer(motion, frame, faults, errors);
        self.read_gps(motion, frame, faults, errors);
        self.fuse_vision(stands);
        if stands && time_us.is_multiple_of(STANDS_PERIOD_US) {
            self.estimator.stands(time_us);
        }
    }

    fn read_barometer(
        &mut self,
        motion: &TrueMotion,
        frame: &LocalFrame,
        faults: &Faults,
        errors: Option<&SensorErrors>,
    ) {
        let mut altitude_m = frame.origin().altitude_m - motion.position_m.z;
        if let Some(errors) = errors.filter(|_| motion.time_us.is_multiple_of(barometer::PERIOD_US)) {
            altitude_m += self.errors.height_m(errors, barometer::PERIOD_US as f64 / 1e6);
        }
        let reading = self.barometer.sample(motion.time_us, altitude_m);
        let fault = faults.sensor(Sensor::Barometer);
        if let Some(reading) = reading.and_then(|reading| self.defects.barometer.tell(reading, fault)) {
            self.barometer_watch.update(motion.time_us, [reading.pressure_pa, 0.0, 0.0]);
            let fitted = self.estimator.barometer(&reading);
            self.barometer_trust.update(fitted, barometer::PERIOD_US);
            self.readings.barometer = Some(reading);
        }
    }

    fn read_magnetometer(
        &mut self,
        motion: &TrueMotion,
        frame: &LocalFrame,
        faults: &Faults,
        errors: Option<&SensorErrors>,
    ) {
        let field = || earth_field_ned(&frame.to_geodetic(&motion.position_m));
        let reading = self.magnetometer.sample(motion.time_us, &motion.attitude, field);
        let reading = reading.map(|reading| match errors {
            Some(errors) => {
                MagnetometerReading { field_gauss: self.errors.field(errors, reading.field_gauss), ..reading }
            }
            None => reading,
        });
        let fault = faults.sensor(Sensor::Magnetometer);
        if let Some(reading) = reading.and_then(|reading| self.defects.magnetometer.tell(reading, fault)) {
            self.magnetometer_watch.update(motion.time_us, reading.field_gauss.into());
            let is_fused = !self.has_vision_heading();
            if is_fused || !self.estimator.is_aligned() {
                let fitted = self.estimator.magnetometer(&reading);
                self.magnetometer_trust.update(fitted, magnetometer::PERIOD_US);
            }
            self.readings.magnetometer = Some(reading);
        }
    }

    fn read_gps(
        &mut self,
        motion: &TrueMotion,
        frame: &LocalFrame,
        faults: &Faults,
        errors: Option<&SensorErrors>,
    ) {
        let fault = faults.sensor(Sensor::Gps);
        let rate_hz = match errors {
            Some(errors) => {
                self.gps.set(errors.gps_rate_hz, u64::from(errors.gps_latency_ms) * 1000);
                errors.gps_rate_hz
            }
            None => {
                self.gps.set(gps::RATE_HZ, gps::LATENCY_US);
                gps::RATE_HZ
            }
        };
        let by_message = errors.is_some_and(|errors| errors.switches.gps_comes_by_message());
        let received = self.received.take().filter(|_| by_message);
        let simulated = self.gps.sample(motion).filter(|_| !by_message);
        let simulated = simulated.and_then(|fix| match errors {
            Some(errors) => self.errors.fix(errors, fix, frame.origin().latitude_deg),
            None => Some(fix),
        });
        let period_us = match (received, self.readings.gps) {
            (Some(fix), Some(before)) => fix.time_us.saturating_sub(before.time_us).min(FIX_PATIENCE_US),
            _ => 1_000_000 / u64::from(rate_hz),
        };
        if let Some(fix) = received.or(simulated).and_then(|fix| self.defects.gps.tell(fix, fault)) {
            let starts_again = errors.is_none_or(|errors| errors.switches.starts_again);
            let fitted = fix.is_accurate()
                && used(&fix, self.aiding.gps).is_none_or(|fix| self.estimator.gps(&fix, starts_again));
            self.gps_trust.update(fitted, period_us);
            // Who measures better than a receiver may say the same again.
            let news = if by_message { [fix.time_us as f64, 0.0, 0.0] } else { fix.position_m.into() };
            self.gps_watch.update(motion.time_us, news);
            self.readings.gps = Some(fix);
        }
    }

    /// Fuses what is to be fused from now on.
    fn choose(&mut self, aiding: &Aiding) {
        let before = std::mem::replace(&mut self.aiding, *aiding);
        if before == *aiding {
            return;
        }
        self.estimator.fuse_outside_with(aiding.vision.map(|vision| OutsideGates {
            position: vision.position_gate.max(1.0),
            velocity: vision.velocity_gate.max(1.0),
        }));
        if before.vision.map(|vision| vision.uses) != aiding.vision.map(|vision| vision.uses)
            || before.gps != aiding.gps
        {
            self.vision.begin_anew();
        }
        if aiding.gps.position && !before.gps.position {
            self.estimator.return_to_gps();
        }
    }

    /// Fuses the estimates from outside that have come.
    fn fuse_vision(&mut self, stands: bool) {
        let Some(settings) = self.aiding.vision else {
            self.seen.clear();
            return;
        };
        if self.estimator.can_fuse() && self.estimator.estimate().time_us == self.time_us {
            self.vision.remember(&self.estimator);
        }
        let gps_works = self.gps_watch.is_alive(self.time_us, FIX_PATIENCE_US);
        let beside_gps = self.aiding.gps.position && gps_works;
        let terms = VisionTerms { now_us: self.time_us, settings, beside_gps, stands };
        while let Some(reading) = self.seen.pop_front() {
            let fitted = self.vision.fuse(&mut self.estimator, &reading, &terms);
            self.vision_trust.update(fitted, VISION_PERIOD_US);
            if settings.uses.wants(&reading) {
                self.vision_watch.update(self.time_us, [self.time_us as f64, 0.0, 0.0]);
            }
        }
    }

    /// An estimate comes from outside, to be looked at with the next tick.
    pub fn receive_vision(&mut self, reading: VisionReading) {
        if self.seen.len() < MOST_SEEN {
            self.seen.push_back(reading);
        }
    }

    /// What is fused.
    pub fn aiding(&self) -> &Aiding {
        &self.aiding
    }

    /// Whether the heading is that of estimates from outside.
    pub fn has_vision_heading(&self) -> bool {
        self.aiding.vision.is_some_and(|vision| self.vision.has_heading(self.time_us, &vision))
    }

    /// A fix comes from outside, to be looked at with the next tick.
    pub fn receive_fix(&mut self, fix: GpsFix) {
        self.received = Some(fix);
    }

    /// A reading needs both of its halves.
    fn read_inertial(&mut self, motion: &TrueMotion, faults: &Faults, errors: Option<&SensorErrors>) {
        let time_us = motion.time_us;
        let mut reading = self.inertial.sample(motion);
        if let Some(errors) = errors {
            reading.body_rate_rad_s = self.errors.rate(errors, reading.body_rate_rad_s);
            reading.specific_force_m_s2 = self.errors.force(errors, reading.specific_force_m_s2);
        }
        let rate = Axes { time_us, axes: reading.body_rate_rad_s };
        let force = Axes { time_us, axes: reading.specific_force_m_s2 };
        let rate = self.defects.gyroscope.tell(rate, faults.sensor(Sensor::Gyroscope));
        let force = self.defects.accelerometer.tell(force, faults.sensor(Sensor::Accelerometer));
        if let Some(rate) = rate {
            self.gyroscope_watch.update(time_us, rate.axes.into());
        }
        if let Some(force) = force {
            self.accelerometer_watch.update(time_us, force.axes.into());
        }
        let (Some(rate), Some(force)) = (rate, force) else { return };
        let inertial =
            InertialReading { time_us, body_rate_rad_s: rate.axes, specific_force_m_s2: force.axes };
        self.vibration.update(&inertial);
        self.estimator.inertial(&inertial);
        self.readings.inertial = inertial;
    }

    /// The estimate.
    pub fn estimate(&self) -> &Estimate {
        self.estimator.estimate()
    }

    /// The estimator.
    pub fn estimator(&self) -> &Estimator {
        &self.estimator
    }

    /// The latest readings.
    pub fn readings(&self) -> &Readings {
        &self.readings
    }

    /// What the receiver says, whether the estimator believes it or not, if it says anything new.
    pub fn latest_fix(&self) -> Option<&GpsFix> {
        self.readings.gps.as_ref().filter(|_| self.gps_watch.is_alive(self.time_us, FIX_PATIENCE_US))
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
        InstrumentHealth {
            gyroscope: self.gyroscope_watch.is_alive(self.time_us, INERTIAL_PATIENCE_US),
            accelerometer: self.accelerometer_watch.is_alive(self.time_us, INERTIAL_PATIENCE_US),
            magnetometer: self.magnetometer_watch.is_alive(self.time_us, PATIENCE_US)
                && self.magnetometer_trust.is_deserved(),
            barometer: self.barometer_watch.is_alive(self.time_us, PATIENCE_US)
                && self.barometer_trust.is_deserved(),
            gps: self.gps_watch.is_alive(self.time_us, FIX_PATIENCE_US) && self.gps_trust.is_deserved(),
            vision: self.aiding.vision.is_some()
                && self.vision_watch.is_alive(self.time_us, VISION_PATIENCE_US)
                && self.vision_trust.is_deserved(),
        }
    }
}

/// What is used of a fix, if anything.
fn used(fix: &GpsFix, gps: GpsUse) -> Option<GpsFix> {
    let unless_used = |is_used: bool, accuracy: f64, unknown: f64| if is_used { accuracy } else { unknown };
    (gps.position || gps.height || gps.velocity).then(|| GpsFix {
        horizontal_accuracy_m: unless_used(gps.position, fix.horizontal_accuracy_m, UNKNOWN_M),
        vertical_accuracy_m: unless_used(gps.height, fix.vertical_accuracy_m, UNKNOWN_M),
        velocity_accuracy_m_s: unless_used(gps.velocity, fix.velocity_accuracy_m_s, UNKNOWN_M_S),
        climb_accuracy_m_s: unless_used(gps.velocity, fix.climb_accuracy_m_s, UNKNOWN_M_S),
        ..*fix
    })
}
