//! Keeps the height above a surface that the rangefinder sees where the pilot asks for none (ArduPilot: SURFTRAK_MODE, PX4: MPC_ALT_MODE).

use libm::exp;
use serde::{Deserialize, Serialize};

use super::situation::Situation;

/// A surface that is further from the one before than this, m, is another one, or a false reading: ArduPilot's limit.
const LEAP_M: f64 = 2.0;
/// Another surface is believed once it has been seen so often in a row: ArduPilot's number.
const LEAPS: u8 = 3;
/// A surface that has not been seen for longer, µs, is gone: ArduPilot's time.
const GONE_US: u64 = 1_000_000;
/// How fast an error of the height is corrected, 1/s.
const GAIN_PER_S: f64 = 0.5;
/// A climb that is braked to this, m/s, is over: the height that is kept is that of then.
const SETTLED_M_S: f64 = 0.1;
/// PX4 begins to hold the height above the ground when slower than half of this, m/s, and ends it when faster (MPC_HOLD_MAX_XY).
const STANDING_M_S: f64 = 0.8;

/// When the height above the surface is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Tracking {
    /// Never.
    #[default]
    Off,
    /// Whenever the rangefinder sees the ground.
    Ground,
    /// By a rangefinder that looks up: there is none, so never.
    Ceiling,
    /// While the vehicle stands in the air and no stick moves it.
    Standing,
}

/// Parameters of it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SurfaceSettings {
    /// When.
    pub tracking: Tracking,
    /// Time constant with which heights of the surface are taken in, s (ArduPilot: SURFTRAK_TC).
    pub smoothing_s: f64,
}

impl Default for SurfaceSettings {
    fn default() -> Self {
        Self { tracking: Tracking::Off, smoothing_s: 1.0 }
    }
}

impl SurfaceSettings {
    /// The defaults of both autopilots. PX4 has no time constant, but limits that do the same.
    pub fn new(ardupilot: bool) -> Self {
        if ardupilot {
            Self { tracking: Tracking::Ground, smoothing_s: 1.0 }
        } else {
            Self { tracking: Tracking::Standing, smoothing_s: 0.3 }
        }
    }
}

/// What the rangefinder sees below.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// z, where the vehicle takes itself to be, m.
    pub z_m: f64,
    /// When it was measured, µs.
    pub time_us: u64,
}

/// The surface, and the height above it.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct SurfaceTracking {
    followed: Option<Followed>,
    /// Whether it stands in the air.
    stands: bool,
}

/// What is followed.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Followed {
    /// As it was seen and believed last.
    seen: Surface,
    /// When it was read last, believed or not, µs.
    read_us: u64,
    /// z as it is followed, m.
    z_m: f64,
    /// Readings in a row that are elsewhere.
    leaps: u8,
    /// Height above it that is kept, m.
    kept_m: f64,
    /// Whether a climb that was asked for goes on, or is braked.
    climbs: bool,
}

impl Followed {
    fn begin(situation: &Situation, seen: Surface) -> Self {
        let kept_m = seen.z_m - situation.outputs.position_m.z;
        Self { seen, read_us: seen.time_us, z_m: seen.z_m, leaps: 0, kept_m, climbs: true }
    }

    /// Takes a reading in. Another surface that is believed moves nothing: the height above it is kept from then on.
    fn read(&mut self, situation: &Situation, surface: Surface) {
        if surface.time_us == self.read_us {
            return;
        }
        self.read_us = surface.time_us;
        if (surface.z_m - self.seen.z_m).abs() < LEAP_M {
            (self.seen, self.leaps) = (surface, 0);
            return;
        }
        self.leaps += 1;
        if self.leaps >= LEAPS {
            *self = Self::begin(situation, surface);
        }
    }

    /// Goes after the surface for `dt_s`, and tells how fast it rises, m/s.
    fn rise_m_s(&mut self, smoothing_s: f64, dt_s: f64) -> f64 {
        let moved_m = (self.seen.z_m - self.z_m) * (1.0 - exp(-dt_s / smoothing_s));
        self.z_m += moved_m;
        -moved_m / dt_s
    }
}

impl SurfaceTracking {
    /// Another mode begins, or the rotors stop.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// The climb rate that is flown where the pilot asks for one, m/s, for `dt_s`.
    pub fn climb_m_s(&mut self, situation: &Situation, asked_m_s: f64, dt_s: f64) -> f64 {
        let wanted = self.is_wanted(situation);
        let is_there =
            |followed: &Followed| situation.time_us.saturating_sub(followed.seen.time_us) <= GONE_US;
        self.followed = self.followed.filter(|followed| wanted && is_there(followed));
        if let Some(surface) = situation.surface.filter(|_| wanted) {
            let begin = || Followed::begin(situation, surface);
            self.followed.get_or_insert_with(begin).read(situation, surface);
        }
        let Some(followed) = &mut self.followed else { return asked_m_s };
        let rises_m_s = followed.rise_m_s(situation.conduct.surroundings.surface.smoothing_s, dt_s);
        let height_m = followed.z_m - situation.outputs.position_m.z;
        let climbs_m_s = -situation.outputs.velocity_m_s.z - rises_m_s;
        followed.climbs = asked_m_s != 0.0 || followed.climbs && climbs_m_s.abs() > SETTLED_M_S;
        if followed.climbs {
            followed.kept_m = height_m;
        }
        asked_m_s + rises_m_s + GAIN_PER_S * (followed.kept_m - height_m)
    }

    /// Whether it is wanted now.
    fn is_wanted(&mut self, situation: &Situation) -> bool {
        let moved = situation.pilot.sticks.is_some_and(|sticks| sticks.leans(&situation.conduct.sticks));
        let speed_m_s = situation.outputs.velocity_m_s.xy().norm();
        let fastest_m_s = if self.stands { STANDING_M_S } else { STANDING_M_S / 2.0 };
        self.stands = !moved && speed_m_s < fastest_m_s;
        let wanted = match situation.conduct.surroundings.surface.tracking {
            Tracking::Off | Tracking::Ceiling => false,
            Tracking::Ground => true,
            Tracking::Standing => self.stands,
        };
        wanted && !situation.landed
    }
}

#[cfg(test)]
mod tests {
    use super::{Surface, SurfaceTracking, Tracking};
    use crate::vehicle::scene::Scene;
    use crate::vehicle::sticks::Sticks;

    const TICK_S: f64 = 0.01;

    fn scene(tracking: Tracking) -> Scene {
        let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]);
        scene.conduct.surroundings.surface.tracking = tracking;
        scene.conduct.surroundings.surface.smoothing_s = 0.5;
        scene
    }

    /// Flies an exact vehicle for some seconds above a surface whose z, m, is a function of the time, s; returns its z in the end.
    fn fly(scene: &mut Scene, seconds: f64, asked_m_s: f64, surface_z_m: impl Fn(f64) -> Option<f64>) -> f64 {
        let mut tracking = SurfaceTracking::default();
        let mut z_m = scene.outputs.position_m.z;
        for tick in 0..(seconds / TICK_S) as u32 {
            if tick.is_multiple_of(10) {
                let time_us = scene.outputs.time_us;
                scene.surface = surface_z_m(f64::from(tick) * TICK_S).map(|z_m| Surface { z_m, time_us });
            }
            let climb_m_s = tracking.climb_m_s(&scene.situation(), asked_m_s, TICK_S);
            z_m -= climb_m_s * TICK_S;
            scene.come_to([0.0, 0.0, z_m], [0.0, 0.0, -climb_m_s]);
            scene.wait_us(10_000);
        }
        z_m
    }

    #[test]
    fn the_height_above_a_slope_is_kept() {
        // It rises by half a metre per second for 8 s.
        let slope = |time_s: f64| Some(-0.5 * time_s.min(8.0));
        let z_m = fly(&mut scene(Tracking::Ground), 20.0, 0.0, slope);
        assert!((z_m + 14.0).abs() < 0.02, "{z_m}");
        for tracking in [Tracking::Off, Tracking::Ceiling] {
            assert_eq!(fly(&mut scene(tracking), 20.0, 0.0, slope), -10.0);
        }
    }

    #[test]
    fn a_climb_adds_to_it() {
        let z_m = fly(&mut scene(Tracking::Ground), 4.0, 1.0, |_| Some(0.0));
        assert!((z_m + 14.0).abs() < 0.05, "{z_m}");
    }

    /// A box of 3 m below, and a reading that is wrong once: neither moves the vehicle.
    #[test]
    fn another_surface_is_not_climbed_over() {
        let edge = |time_s: f64| Some(if time_s < 5.0 { 0.0 } else { -3.0 });
        assert!((fly(&mut scene(Tracking::Ground), 20.0, 0.0, edge) + 10.0).abs() < 1e-9);
        let spike = |time_s: f64| Some(if (time_s - 5.0).abs() < 0.01 { -7.0 } else { 0.0 });
        assert!((fly(&mut scene(Tracking::Ground), 20.0, 0.0, spike) + 10.0).abs() < 1e-9);
        // A step that is no higher than a kerb is followed.
        let kerb = |time_s: f64| Some(if time_s < 5.0 { 0.0 } else { -1.0 });
        assert!((fly(&mut scene(Tracking::Ground), 20.0, 0.0, kerb) + 11.0).abs() < 0.02);
    }

    #[test]
    fn out_of_range_nothing_is_followed() {
        let lost = |time_s: f64| (time_s < 5.0).then_some(-0.2 * time_s);
        let z_m = fly(&mut scene(Tracking::Ground), 30.0, 0.0, lost);
        assert!((-11.0..-10.5).contains(&z_m), "{z_m}");
    }

    #[test]
    fn a_vehicle_that_is_moved_keeps_its_altitude_if_it_is_to_stand() {
        let slope = |time_s: f64| Some(-0.5 * time_s.min(8.0));
        let mut moved = scene(Tracking::Standing);
        moved.pilot.sticks = Some(Sticks { forward: 0.5, ..Sticks::default() });
        assert_eq!(fly(&mut moved, 20.0, 0.0, slope), -10.0);
        assert!((fly(&mut scene(Tracking::Standing), 20.0, 0.0, slope) + 14.0).abs() < 0.02);
    }
}
