//! What logs are sampled from, whatever their format.

use autopilot::{Autopilot, COMPONENT};
use quadrotor::Outputs;
use vehicle::Vehicle;
use vehicle::estimation::TestRatios;
use vehicle::world::{Geodetic, heading_deg};

/// What logs are sampled from.
#[derive(Clone, Copy, Debug)]
pub struct LogSource<'a> {
    /// The vehicle.
    pub vehicle: &'a Vehicle,
    /// System id that it is known by.
    pub system_id: u8,
    /// Its component id.
    pub component_id: u8,
}

/// A fix in the resolution of a receiver: 1e-7°, mm, cm/s and, of the course, 0.01°.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoggedFix {
    /// Where; the ellipsoid is the sea level.
    pub place: Geodetic,
    /// m.
    pub horizontal_accuracy_m: f64,
    /// m.
    pub vertical_accuracy_m: f64,
    /// m/s.
    pub velocity_accuracy_m_s: f64,
    /// Over ground, m/s.
    pub speed_m_s: f64,
    /// Down, m/s.
    pub sink_m_s: f64,
    /// Over ground, from north, degrees.
    pub course_deg: f64,
    /// Satellites used.
    pub satellites: u8,
    /// What kind of fix it is, by MAVLink's number.
    pub kind: u8,
}

impl<'a> LogSource<'a> {
    /// The vehicle of an autopilot.
    pub fn of(autopilot: &'a Autopilot) -> Self {
        Self { vehicle: autopilot.vehicle(), system_id: autopilot.system_id(), component_id: COMPONENT }
    }

    /// The latest fix, if it is fresh.
    pub fn fix(&self) -> Option<LoggedFix> {
        let vehicle = self.vehicle;
        let fix = vehicle.readings().gps.filter(|fix| fix.is_fresh(vehicle.time_us()))?;
        let ground_m_s = fix.velocity_m_s.xy();
        let course_deg = heading_deg(libm::atan2(ground_m_s.y, ground_m_s.x));
        Some(LoggedFix {
            place: stepped_place(&vehicle.frame().to_geodetic(&fix.position_m)),
            horizontal_accuracy_m: stepped(fix.horizontal_accuracy_m, 1e3),
            vertical_accuracy_m: stepped(fix.vertical_accuracy_m, 1e3),
            velocity_accuracy_m_s: fix.velocity_accuracy_m_s,
            speed_m_s: stepped(ground_m_s.norm(), 1e2),
            sink_m_s: stepped(fix.velocity_m_s.z, 1e2),
            course_deg: (course_deg * 1e2).floor() / 1e2,
            satellites: fix.satellites,
            kind: vehicle.conduct().simulated.errors.gps_fix_type,
        })
    }

    /// Where a motion is, in steps of 1e-7° and mm, as clients are told it: readers compare the two.
    pub fn place(&self, motion: &Outputs) -> Geodetic {
        stepped_place(&self.vehicle.frame().to_geodetic(&motion.position_m))
    }

    /// Directions from the nose, degrees clockwise from 0 to 360, and distances, m, of what is measured around.
    pub fn seen_around(&self) -> impl Iterator<Item = (f64, f64)> {
        let nose_rad = self.vehicle.outputs().attitude_rad.z;
        let seen_m = self.vehicle.seen_around_m().into_iter();
        seen_m.map(move |way_m| (heading_deg(libm::atan2(way_m.y, way_m.x) - nose_rad), way_m.norm()))
    }

    /// Speeds of the rotors as shares of the fastest, squared: shares of the thrust.
    pub fn motor_shares(&self) -> [f64; 4] {
        self.speed_shares().map(|share| share * share)
    }

    /// The same as pulses, µs.
    pub fn pulses_us(&self) -> [f64; 4] {
        self.speed_shares().map(|share| 1000.0 + 1000.0 * share)
    }

    fn speed_shares(&self) -> [f64; 4] {
        let fastest = self.vehicle.simulation().configuration().airframe.rotor_speed_max_rad_s;
        self.vehicle.outputs().rotor_speed_rad_s.map(|speed| speed / fastest)
    }

    /// Strongest thrust of all rotors, N.
    pub fn strongest_n(&self) -> f64 {
        self.vehicle.simulation().configuration().airframe.thrust_range_n().1
    }

    /// How far measurements are from what the estimator expects; ideal sensors agree with it.
    pub fn test_ratios(&self) -> TestRatios {
        self.vehicle.estimate().map_or_else(TestRatios::default, |estimate| estimate.test_ratios)
    }

    /// Shaking that the accelerometers feel, m/s²: the rigid body has no vibration, so that ideal ones feel none.
    pub fn vibration_m_s2(&self) -> [f64; 3] {
        let navigation = self.vehicle.navigation();
        navigation.map_or([0.0; 3], |navigation| navigation.vibration().level_m_s2().data.0[0])
    }

    /// How often each accelerometer has been at its end.
    pub fn clipped(&self) -> [u32; 3] {
        self.vehicle.navigation().map(|navigation| navigation.clipped()).unwrap_or_default()
    }

    /// Height by the barometer, m, and its pressure, hPa, as clients are told it.
    pub fn barometer(&self) -> (f64, f32) {
        let reading = self.vehicle.readings().barometer;
        reading.map_or((0.0, 0.0), |reading| (reading.altitude_m(), (reading.pressure_pa / 100.0) as f32))
    }

    /// The field that the magnetometer shows, gauss.
    pub fn field_gauss(&self) -> [f64; 3] {
        self.vehicle.readings().magnetometer.map_or([0.0; 3], |reading| reading.field_gauss.data.0[0])
    }
}

/// A value in steps of which so many are a unit: receivers tell no finer ones. Never −0.
pub fn stepped(value: f64, steps: f64) -> f64 {
    (value * steps).round() / steps + 0.0
}

fn stepped_place(place: &Geodetic) -> Geodetic {
    Geodetic {
        latitude_deg: stepped(place.latitude_deg, 1e7),
        longitude_deg: stepped(place.longitude_deg, 1e7),
        altitude_m: stepped(place.altitude_m, 1e3),
    }
}
