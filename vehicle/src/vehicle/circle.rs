//! A flight around a centre: one mechanism for the turns of a mission and for the orbit mode.

use core::f64::consts::TAU;

use nalgebra::Vector3;
use quadrotor::Limits;

use super::motion::wrapped;
use super::set_point::{AxisTarget, PositionSetPoint, YawTarget};

/// Share of the horizontal acceleration that speeds up and brakes along a circle.
const TANGENTIAL: f64 = 0.2;

/// A point that goes around a centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    centre_m: Vector3<f64>,
    radius_m: f64,
    /// +1 clockwise seen from above, −1 the other way.
    direction: f64,
    /// Angle of the start seen from the centre, rad from north.
    start_rad: f64,
    /// Way around that is flown, rad.
    flown_rad: f64,
    speed_m_s: f64,
    /// How fast the radius grows, m/s, and that, m/s².
    widens_m_s: f64,
    widening_m_s2: f64,
}

impl Circle {
    /// Around a centre, NED, m, from the point of the circle that is next to a place. A negative radius, m, goes counter-clockwise
    /// seen from above.
    pub fn new(centre_m: Vector3<f64>, near_m: &Vector3<f64>, radius_m: f64) -> Self {
        let off = near_m - centre_m;
        let start_rad = if off.xy().norm() > 1e-6 { libm::atan2(off.y, off.x) } else { 0.0 };
        Self::starting_at(centre_m, start_rad, radius_m)
    }

    /// The same from an angle, rad from north seen from the centre.
    pub fn starting_at(centre_m: Vector3<f64>, start_rad: f64, radius_m: f64) -> Self {
        Self {
            centre_m,
            radius_m: radius_m.abs(),
            direction: radius_m.signum(),
            start_rad,
            flown_rad: 0.0,
            speed_m_s: 0.0,
            widens_m_s: 0.0,
            widening_m_s2: 0.0,
        }
    }

    /// The centre, NED, m.
    pub fn centre_m(&self) -> Vector3<f64> {
        self.centre_m
    }

    /// Radius, m.
    pub fn radius_m(&self) -> f64 {
        self.radius_m
    }

    /// Whether it goes clockwise seen from above.
    pub fn is_clockwise(&self) -> bool {
        self.direction > 0.0
    }

    /// Way around that is flown, rad.
    pub fn flown_rad(&self) -> f64 {
        self.flown_rad
    }

    /// Speed along the circle, m/s.
    pub fn speed_m_s(&self) -> f64 {
        self.speed_m_s
    }

    /// Acceleration, m/s², that speeds up and brakes along it.
    pub fn tangential_m_s2(limits: &Limits) -> f64 {
        TANGENTIAL * limits.acceleration_horizontal_m_s2
    }

    /// The fastest, m/s, that points no more than a share of the horizontal acceleration to the centre.
    pub fn fastest_m_s(&self, share: f64, limits: &Limits) -> f64 {
        let centripetal_m_s2 = share * limits.acceleration_horizontal_m_s2;
        libm::sqrt(centripetal_m_s2 * self.radius_m).min(limits.speed_horizontal_m_s)
    }

    fn angle_rad(&self) -> f64 {
        self.start_rad + self.direction * self.flown_rad
    }

    /// Where it is now, NED, m.
    pub fn position_m(&self) -> Vector3<f64> {
        self.place_m(self.angle_rad())
    }

    /// Where it is after so much more of the way around, rad; NED, m.
    pub fn ahead_m(&self, around_rad: f64) -> Vector3<f64> {
        self.place_m(self.angle_rad() + self.direction * around_rad)
    }

    /// A place of it at an angle, rad from north seen from the centre; NED, m.
    pub fn place_m(&self, angle_rad: f64) -> Vector3<f64> {
        let (sin, cos) = libm::sincos(angle_rad);
        self.centre_m + Vector3::new(cos, sin, 0.0) * self.radius_m
    }

    /// Heading towards the centre, rad.
    pub fn heading_rad(&self) -> f64 {
        wrapped(self.angle_rad() + TAU / 2.0)
    }

    /// Heading along the way around, rad.
    pub fn heading_of_travel_rad(&self) -> f64 {
        wrapped(self.angle_rad() + self.direction * TAU / 4.0)
    }

    /// Rate of either heading, rad/s.
    pub fn yaw_rate_rad_s(&self) -> f64 {
        self.direction * self.speed_m_s / self.radius_m
    }

    /// Grows for `dt_s` with a speed, m/s.
    pub fn widen(&mut self, widens_m_s: f64, dt_s: f64) {
        self.widening_m_s2 = (widens_m_s - self.widens_m_s) / dt_s;
        self.widens_m_s = widens_m_s;
        self.radius_m += widens_m_s * dt_s;
    }

    /// Goes on for `dt_s` and changes its speed towards another one, m/s, with at most a braking, m/s². The nose points to the centre.
    pub fn advance(
        &mut self,
        wanted_m_s: f64,
        braking_m_s2: f64,
        limits: &Limits,
        dt_s: f64,
    ) -> PositionSetPoint {
        let tangential = Self::tangential_m_s2(limits);
        let change = (wanted_m_s - self.speed_m_s).clamp(-braking_m_s2 * dt_s, tangential * dt_s);
        self.speed_m_s += change;
        self.flown_rad += self.speed_m_s / self.radius_m * dt_s;
        self.set_point(change / dt_s)
    }

    /// Position r and its derivatives, with v along the circle and ω = v/r: ṙ outwards and v along it; r̈ − v²/r outwards and v̇ + ṙ ω along it.
    fn set_point(&self, tangential_m_s2: f64) -> PositionSetPoint {
        let (sin, cos) = libm::sincos(self.angle_rad());
        let outward = Vector3::new(cos, sin, 0.0);
        let along = Vector3::new(-sin, cos, 0.0) * self.direction;
        let position_m = self.position_m();
        let rate_rad_s = self.speed_m_s / self.radius_m;
        let velocity_m_s = along * self.speed_m_s + outward * self.widens_m_s;
        let acceleration_m_s2 = along * (tangential_m_s2 + self.widens_m_s * rate_rad_s)
            - outward * (self.speed_m_s * self.speed_m_s / self.radius_m - self.widening_m_s2);
        let axes = core::array::from_fn(|axis| AxisTarget::Track {
            position_m: position_m[axis],
            velocity_m_s: velocity_m_s[axis],
            acceleration_m_s2: acceleration_m_s2[axis],
            jerk_m_s3: 0.0,
        });
        PositionSetPoint { axes, yaw: YawTarget::Track(self.heading_rad(), self.yaw_rate_rad_s()) }
    }
}
