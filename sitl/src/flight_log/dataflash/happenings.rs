//! Messages of what has happened since the last look: modes, arming, events, errors, missions, origins.

use vehicle::plan::PlanKind;
use vehicle::{Cause, LandedState};

use super::bytes::{ARM, CAM, CAM_KINDS, CMD, ERR, EV, MODE, ORGN, numbers};
use super::sensors::{WEEK_MS, gps_ms_at};
use crate::flight_log::LogSource;

/// ArduCopter's numbers of events.
const ARMED: f64 = 10.0;
const DISARMED: f64 = 11.0;
const LAND_COMPLETE: f64 = 18.0;
const SET_HOME: f64 = 25.0;
const NOT_LANDED: f64 = 28.0;
/// … of what errors come from …
const FAILSAFE_RADIO: f64 = 5.0;
const FAILSAFE_BATTERY: f64 = 6.0;
const FAILSAFE_GROUND_STATION: f64 = 8.0;
const FAILSAFE_FENCE: f64 = 9.0;
const CRASH_CHECK: f64 = 12.0;
const FAILSAFE_ESTIMATOR: f64 = 17.0;
const THRUST_LOSS: f64 = 27.0;
/// … and of what has happened to them.
const RESOLVED: f64 = 0.0;
const OCCURRED: f64 = 1.0;
/// Reasons of a mode.
const UNKNOWN_REASON: f64 = 0.0;
/// Kinds of an origin.
const ESTIMATOR_ORIGIN: f64 = 0.0;
const HOME: f64 = 1.0;

/// What was so at the last look.
#[derive(Clone, Debug, PartialEq)]
pub struct Happenings {
    /// Its number: some of our modes are one of ArduCopter's.
    mode: Option<u32>,
    armed: Option<bool>,
    landed: Option<bool>,
    crashed: bool,
    home_m: Option<[f64; 3]>,
    mission: Option<u32>,
    causes: Vec<Cause>,
    /// How many images have been written.
    images: u32,
}

impl Happenings {
    /// Nothing has been seen yet: what is so at the first look is written, too.
    pub fn new() -> Self {
        Self {
            mode: None,
            armed: None,
            landed: None,
            crashed: false,
            home_m: None,
            mission: None,
            causes: Vec::new(),
            images: 0,
        }
    }

    /// Appends what has happened.
    pub fn look(&mut self, into: &mut Vec<u8>, source: &LogSource<'_>) {
        let (vehicle, time) = (source.vehicle, source.vehicle.time_us() as f64);
        let mode = vehicle.identity().custom_mode(vehicle.shown_mode());
        if self.mode.replace(mode) != Some(mode) {
            let number = f64::from(mode);
            numbers(into, MODE, "QMBB", &[time, number, number, UNKNOWN_REASON]);
        }
        let armed = vehicle.is_armed();
        if self.armed.replace(armed) != Some(armed) {
            numbers(into, ARM, "QBIBB", &[time, f64::from(u8::from(armed)), 0.0, 0.0, 0.0]);
            numbers(into, EV, "QB", &[time, if armed { ARMED } else { DISARMED }]);
        }
        let landed = vehicle.landed_state() == LandedState::OnGround;
        if self.landed.replace(landed) != Some(landed) {
            numbers(into, EV, "QB", &[time, if landed { LAND_COMPLETE } else { NOT_LANDED }]);
        }
        if !std::mem::replace(&mut self.crashed, vehicle.has_crashed()) && self.crashed {
            numbers(into, ERR, "QBB", &[time, CRASH_CHECK, OCCURRED]);
        }
        self.look_at_causes(into, source);
        self.look_at_places(into, source);
        self.look_at_images(into, source);
    }

    /// CAM: where an image was taken, with the attitude of the vehicle.
    fn look_at_images(&mut self, into: &mut Vec<u8>, source: &LogSource<'_>) {
        let vehicle = source.vehicle;
        let camera = vehicle.equipment().camera();
        let since = std::mem::replace(&mut self.images, camera.triggers());
        for image in camera.images_after(since) {
            let place = vehicle.frame().to_geodetic(&image.position_m);
            let by_gps_m = source.fix().map_or(place.altitude_m, |fix| fix.place.altitude_m);
            let gps_ms = gps_ms_at(vehicle, image.time_us);
            let [roll, pitch, yaw] = image.attitude_rad.data.0[0].map(f64::to_degrees);
            let number = f64::from(image.trigger & u32::from(u16::MAX));
            let when =
                [image.time_us as f64, 0.0, number, (gps_ms % WEEK_MS) as f64, (gps_ms / WEEK_MS) as f64];
            let above_home_m = image.home_z_m - image.position_m.z;
            let at = [place.latitude_deg, place.longitude_deg, place.altitude_m, above_home_m, by_gps_m];
            let values: Vec<f64> =
                when.into_iter().chain(at).chain([roll, pitch, yaw.rem_euclid(360.0)]).collect();
            numbers(into, CAM, CAM_KINDS, &values);
        }
    }

    fn look_at_causes(&mut self, into: &mut Vec<u8>, source: &LogSource<'_>) {
        let time = source.vehicle.time_us() as f64;
        let present: Vec<Cause> = source.vehicle.failsafe().present().collect();
        let before = std::mem::replace(&mut self.causes, present.clone());
        let changes = |of: &[Cause], other: &[Cause], code: f64| {
            let changed: Vec<(f64, f64)> = of
                .iter()
                .filter(|cause| !other.contains(cause))
                .filter_map(|cause| Some((subsystem(*cause)?, code)))
                .collect();
            changed
        };
        let mut all = changes(&present, &before, OCCURRED);
        all.extend(changes(&before, &present, RESOLVED));
        for (subsystem, code) in all {
            numbers(into, ERR, "QBB", &[time, subsystem, code]);
        }
    }

    fn look_at_places(&mut self, into: &mut Vec<u8>, source: &LogSource<'_>) {
        let (vehicle, time) = (source.vehicle, source.vehicle.time_us() as f64);
        let home_m: [f64; 3] = vehicle.home().position_m.into();
        let before = self.home_m.replace(home_m);
        if before != Some(home_m) {
            let frame = vehicle.frame();
            let home = frame.to_geodetic(&vehicle.home().position_m);
            if before.is_none() {
                let origin = frame.origin();
                let place = [origin.latitude_deg, origin.longitude_deg, origin.altitude_m];
                numbers(into, ORGN, "QBLLe", &[time, ESTIMATOR_ORIGIN, place[0], place[1], place[2]]);
            } else {
                numbers(into, EV, "QB", &[time, SET_HOME]);
            }
            let place = [home.latitude_deg, home.longitude_deg, home.altitude_m];
            numbers(into, ORGN, "QBLLe", &[time, HOME, place[0], place[1], place[2]]);
        }
        let plan = vehicle.plans().get(PlanKind::Mission);
        if self.mission.replace(plan.id()) == Some(plan.id()) {
            return;
        }
        for index in 0..plan.items().len() {
            let Some(item) = vehicle.plan_item(PlanKind::Mission, index) else { continue };
            let head = [time, plan.items().len() as f64, index as f64, f64::from(item.command)];
            let tail = [item.position[0], item.position[1], item.position[2], f64::from(item.frame)];
            let values: Vec<f64> = head.into_iter().chain(item.parameters).chain(tail).collect();
            numbers(into, CMD, "QHHHffffLLfB", &values);
        }
    }
}

/// What ArduCopter counts a cause to.
fn subsystem(cause: Cause) -> Option<f64> {
    match cause {
        Cause::RotorFailure => Some(THRUST_LOSS),
        Cause::PositionLost => Some(FAILSAFE_ESTIMATOR),
        Cause::BatteryEmergency | Cause::BatteryCritical | Cause::BatteryLow => Some(FAILSAFE_BATTERY),
        Cause::PilotLost => Some(FAILSAFE_RADIO),
        Cause::Fence => Some(FAILSAFE_FENCE),
        Cause::GroundStationLost => Some(FAILSAFE_GROUND_STATION),
        Cause::HighWind | Cause::SetPointsLost => None,
    }
}
