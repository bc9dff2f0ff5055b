//! The instruments of the rig: those of the vehicle, read as often as an autopilot gets them.

use nalgebra::Vector3;
use vehicle::estimation::TrueMotion;
use vehicle::estimation::barometer::{Barometer, BarometerReading};
use vehicle::estimation::gps::{GpsFix, GpsReceiver};
use vehicle::estimation::inertial::InertialUnit;
use vehicle::estimation::magnetometer::{Magnetometer, MagnetometerReading};
use vehicle::world::{LocalFrame, earth_field_ned};

/// Age of a fix when it is told, µs: PX4 counts with this much behind its simulator interface (px4-rc.mavlinksim sets
/// EKF2_GPS_DELAY, later SENS_GPS0_DELAY, to 10 ms).
const GPS_LATENCY_US: u64 = 10_000;

/// What the instruments have said since the last report. Noise is not only true to life: an autopilot takes an
/// instrument that always says the same for a broken one.
#[derive(Clone, Debug, Default)]
pub struct Readings {
    /// Sums of body rate, rad/s, and specific force, m/s², FRD, and their number.
    inertial: (Vector3<f64>, Vector3<f64>, u32),
    /// Last one of the magnetometer.
    pub magnetometer: Option<MagnetometerReading>,
    /// Last one of the barometer.
    pub barometer: Option<BarometerReading>,
    /// A fix that has arrived.
    pub fix: Option<GpsFix>,
}

impl Readings {
    /// Mean body rate, rad/s.
    pub fn body_rate_rad_s(&self) -> Vector3<f64> {
        self.inertial.0 / f64::from(self.inertial.2.max(1))
    }

    /// Mean specific force, FRD, m/s².
    pub fn specific_force_m_s2(&self) -> Vector3<f64> {
        self.inertial.1 / f64::from(self.inertial.2.max(1))
    }
}

/// All instruments.
#[derive(Clone, Debug)]
pub struct Instruments {
    inertial: InertialUnit,
    magnetometer: Magnetometer,
    barometer: Barometer,
    gps: GpsReceiver,
    readings: Readings,
}

impl Instruments {
    /// Instruments that have just been switched on.
    pub fn new(seed: u64) -> Self {
        Self {
            inertial: InertialUnit::new(seed),
            magnetometer: Magnetometer::new(seed),
            barometer: Barometer::new(seed),
            gps: GpsReceiver::new(seed, GPS_LATENCY_US),
            readings: Readings::default(),
        }
    }

    /// Lets them measure, every millisecond.
    pub fn sample(&mut self, motion: &TrueMotion, frame: &LocalFrame) {
        let reading = self.inertial.sample(motion);
        let (rates, forces, count) = &mut self.readings.inertial;
        *rates += reading.body_rate_rad_s;
        *forces += reading.specific_force_m_s2;
        *count += 1;
        let place = || frame.to_geodetic(&motion.position_m);
        let field = self.magnetometer.sample(motion.time_us, &motion.attitude, || earth_field_ned(&place()));
        let altitude_m = frame.origin().altitude_m - motion.position_m.z;
        let pressure = self.barometer.sample(motion.time_us, altitude_m);
        let fix = self.gps.sample(motion);
        let readings = &mut self.readings;
        readings.magnetometer = field.or(readings.magnetometer);
        readings.barometer = pressure.or(readings.barometer);
        readings.fix = fix.or(readings.fix);
    }

    /// What they have said since the last call.
    pub fn take(&mut self) -> Readings {
        std::mem::take(&mut self.readings)
    }
}
