//! Where PX4 follows a target: as its parameters say, and as the pilot has moved that with the sticks since.

use super::follow_settings::FollowSettings;
use super::motion::wrapped;
use super::sticks::Sticks;

/// What full sticks change in a second: PX4's height, m, distance, m, and angle, rad.
const CLIMB_M_S: f64 = 1.5;
const RETREAT_M_S: f64 = 2.0;
const TURN_RAD_S: f64 = 1.5;
/// A vehicle that is behind by more than what a stick changes in this time, s, is waited for.
const AHEAD_S: f64 = 0.5;
/// Sticks move heights and distances between these, m.
const LEAST_M: f64 = 1.0;
const MOST_M: f64 = 100.0;

/// A place beside the target.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct FollowPlace {
    /// The parameters that it comes from: height, distance and angle.
    told: [f64; 3],
    /// Height above what the parameters say, m.
    pub height_m: f64,
    /// Horizontal distance from the target, m.
    pub distance_m: f64,
    /// Angle from where the target goes, rad.
    pub angle_rad: f64,
    /// How fast the sticks change the height and the distance, m/s.
    pub climb_m_s: f64,
    /// Away from the target, m/s.
    pub retreat_m_s: f64,
}

/// How far the vehicle is from its place.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct FollowErrors {
    /// Vertically, m.
    pub height_m: f64,
    /// Along the line from the target, m.
    pub distance_m: f64,
    /// Around the target, rad: where it is, and where its way around has come to.
    pub bearing_rad: f64,
    /// What is left of its way around, rad.
    pub left_rad: f64,
}

impl FollowPlace {
    /// Parameters that have changed replace what sticks have moved.
    pub fn heed(&mut self, settings: &FollowSettings) {
        let told = [settings.height_m, settings.distance_m, settings.angle_rad];
        if self.told != told {
            let [height_m, distance_m, angle_rad] = told;
            *self = Self { told, height_m, distance_m, angle_rad, ..Self::default() };
        }
    }

    /// The throttle lifts it, the pitch stick takes it away from the target, the roll stick around it, for a time, s. Sticks are without their
    /// dead zones.
    pub fn adjust(&mut self, sticks: &Sticks, errors: &FollowErrors, dt_s: f64) {
        let before_m = [self.height_m, self.distance_m];
        if errors.height_m.abs() < CLIMB_M_S * AHEAD_S {
            self.height_m = moved(self.height_m, sticks.up * CLIMB_M_S * dt_s);
        }
        if errors.distance_m.abs() < RETREAT_M_S * AHEAD_S {
            self.distance_m = moved(self.distance_m, sticks.forward * RETREAT_M_S * dt_s);
        }
        self.climb_m_s = (self.height_m - before_m[0]) / dt_s;
        self.retreat_m_s = (self.distance_m - before_m[1]) / dt_s;
        if errors.bearing_rad.abs().max(errors.left_rad.abs()) < TURN_RAD_S * AHEAD_S {
            self.angle_rad = wrapped(self.angle_rad + sticks.right * TURN_RAD_S * dt_s);
        }
    }
}

/// Parameters may be farther than sticks go.
fn moved(value_m: f64, change_m: f64) -> f64 {
    (value_m + change_m).clamp(value_m.min(LEAST_M), value_m.max(MOST_M))
}

#[cfg(test)]
mod tests {
    use super::{FollowErrors, FollowPlace, LEAST_M, MOST_M};
    use crate::vehicle::FollowSettings;
    use crate::vehicle::stick_settings::StickSettings;
    use crate::vehicle::sticks::Sticks;

    fn place() -> FollowPlace {
        let mut place = FollowPlace::default();
        place.heed(&FollowSettings { angle_rad: 0.0, ..FollowSettings::default() });
        place
    }

    fn held(place: &mut FollowPlace, sticks: Sticks, seconds: f64) {
        for _ in 0..(seconds * 100.0).round() as usize {
            let sticks = sticks.live(&StickSettings::default());
            place.adjust(&sticks, &FollowErrors::default(), 0.01);
        }
    }

    #[test]
    fn sticks_move_it_at_px4s_speeds_and_between_its_bounds() {
        let mut there = place();
        held(&mut there, Sticks { up: 1.0, forward: 1.0, right: 1.0, turn: 0.0 }, 2.0);
        assert!((there.height_m - 11.0).abs() < 1e-9 && (there.distance_m - 12.0).abs() < 1e-9, "{there:?}");
        assert!((there.angle_rad - 3.0).abs() < 1e-9, "{there:?}");
        assert!((there.climb_m_s - 1.5).abs() < 1e-9 && (there.retreat_m_s - 2.0).abs() < 1e-9, "{there:?}");
        held(&mut there, Sticks { up: -1.0, forward: 1.0, ..Sticks::default() }, 100.0);
        assert_eq!((there.climb_m_s, there.retreat_m_s), (0.0, 0.0));
        assert_eq!((there.height_m, there.distance_m), (LEAST_M, MOST_M));
        let mut there = place();
        held(&mut there, Sticks { up: 0.05, forward: -0.05, right: 0.05, turn: 1.0 }, 10.0);
        assert_eq!(there, place(), "within the dead zone");
    }

    #[test]
    fn a_vehicle_that_is_behind_is_waited_for_and_new_parameters_count() {
        let mut there = place();
        let behind = FollowErrors { height_m: 1.0, distance_m: -1.5, left_rad: 0.8, bearing_rad: 0.0 };
        there.adjust(&Sticks { up: 1.0, forward: 1.0, right: 1.0, turn: 0.0 }, &behind, 1.0);
        assert_eq!(there, place());
        held(&mut there, Sticks { up: 1.0, ..Sticks::default() }, 1.0);
        there.heed(&FollowSettings { angle_rad: 0.0, ..FollowSettings::default() });
        assert!((there.height_m - 9.5).abs() < 1e-9, "the parameters are as they were: {there:?}");
        there.heed(&FollowSettings { angle_rad: 1.0, ..FollowSettings::default() });
        assert_eq!((there.height_m, there.angle_rad), (8.0, 1.0));
    }
}
