//! Set-points in the local frame, after frames and masks have been resolved.

use nalgebra::{UnitQuaternion, Vector3};
use quadrotor::Limits;

/// What one axis of the local frame is asked to do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AxisTarget {
    /// Go to a position, m, and stay.
    Position(f64),
    /// Reach a velocity, m/s, within the limits, and keep it; zero holds the place.
    Velocity(f64),
    /// Accelerate, m/s², within the limits of speed.
    Acceleration(f64),
    /// A point of a trajectory, as it is: position, m, velocity, m/s, acceleration, m/s², jerk, m/s³.
    Track {
        /// Position, m.
        position_m: f64,
        /// Velocity, m/s.
        velocity_m_s: f64,
        /// Acceleration, m/s².
        acceleration_m_s2: f64,
        /// Jerk, m/s³; zero on all axes is one that is not known.
        jerk_m_s3: f64,
    },
}

impl AxisTarget {
    /// Brake and stay.
    pub const HOLD: Self = Self::Velocity(0.0);
}

/// What the heading is asked to do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum YawTarget {
    /// Stay.
    Hold,
    /// Turn to an angle, rad, the short way.
    Angle(f64),
    /// Turn to an angle, rad, that changes at a rate, rad/s, the short way.
    Follow(f64, f64),
    /// Keep turning, rad/s.
    Rate(f64),
    /// A point of a trajectory: angle, rad, and rate, rad/s.
    Track(f64, f64),
}

/// A set-point for position and heading, NED.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PositionSetPoint {
    /// North, east, down.
    pub axes: [AxisTarget; 3],
    /// Heading.
    pub yaw: YawTarget,
}

impl PositionSetPoint {
    /// Brake and stay.
    pub const HOLD: Self = Self { axes: [AxisTarget::HOLD; 3], yaw: YawTarget::Hold };

    /// The place that it asks for, whatever the heading is.
    pub fn place(&self) -> Option<Vector3<f64>> {
        match self.axes {
            [AxisTarget::Position(x), AxisTarget::Position(y), AxisTarget::Position(z)] => {
                Some(Vector3::new(x, y, z))
            }
            _ => None,
        }
    }

    /// Whether it is only a place to be: then it goes through the shaper.
    pub fn goal(&self) -> Option<Vector3<f64>> {
        match self.yaw {
            YawTarget::Hold | YawTarget::Angle(_) => self.place(),
            _ => None,
        }
    }

    /// Whether it asks for velocities alone, as sticks do.
    pub fn is_velocity(&self) -> bool {
        self.axes.iter().all(|axis| matches!(axis, AxisTarget::Velocity(_)))
    }

    /// Whether it leads upwards from z, m: on the ground nothing else takes off.
    pub fn leads_up(&self, z_m: f64) -> bool {
        const NEAR_M: f64 = 0.3;
        const SLOW: f64 = 0.05;
        let [_, _, down] = self.axes;
        match down {
            AxisTarget::Position(z) => z < z_m - NEAR_M,
            AxisTarget::Velocity(v) => v < -SLOW,
            AxisTarget::Acceleration(a) => a < -SLOW,
            AxisTarget::Track { position_m, velocity_m_s, .. } => {
                position_m < z_m - NEAR_M || velocity_m_s < -SLOW
            }
        }
    }

    /// The same with the velocities of its trajectory within the limits of speed: the rest of the way is left to the
    /// controllers, which keep the limits, too.
    pub fn within(mut self, limits: &Limits) -> Self {
        let speed = |axis: &AxisTarget| match axis {
            AxisTarget::Track { velocity_m_s, .. } => *velocity_m_s,
            _ => 0.0,
        };
        let [north, east, _] = self.axes.each_ref().map(speed);
        let horizontal = libm::hypot(north, east);
        let share = if horizontal > limits.speed_horizontal_m_s {
            limits.speed_horizontal_m_s / horizontal
        } else {
            1.0
        };
        for (index, axis) in self.axes.iter_mut().enumerate() {
            if let AxisTarget::Track { velocity_m_s, .. } = axis {
                *velocity_m_s = match index {
                    2 => velocity_m_s.clamp(-limits.speed_up_m_s, limits.speed_down_m_s),
                    _ => *velocity_m_s * share,
                };
            }
        }
        self
    }

    /// Whether something in it runs on for ever: without news it has to end. A vehicle on the way to a place goes on to it, and turns as
    /// it was asked to.
    pub fn runs_on(&self) -> bool {
        let moves = |axis: &AxisTarget| match *axis {
            AxisTarget::Position(_) => false,
            AxisTarget::Velocity(v) => v != 0.0,
            AxisTarget::Acceleration(_) => true,
            AxisTarget::Track { velocity_m_s, acceleration_m_s2, .. } => {
                velocity_m_s != 0.0 || acceleration_m_s2 != 0.0
            }
        };
        let turns = matches!(self.yaw, YawTarget::Rate(_) | YawTarget::Track(..));
        let to_a_place = self.axes.iter().all(|axis| matches!(axis, AxisTarget::Position(_)));
        self.axes.iter().any(moves) || turns && !to_a_place
    }
}

/// A set-point for attitude and thrust.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AttitudeSetPoint {
    /// The attitude, FRD into NED; `None`: turn on from the present one at the body rates.
    pub attitude: Option<UnitQuaternion<f64>>,
    /// Body rates, FRD, rad/s; fed forward if there is an attitude.
    pub body_rate_rad_s: Vector3<f64>,
    /// Share of the thrust that the rotors can make, 0 to 1.
    pub thrust: f64,
}

/// A set-point of the offboard mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SetPoint {
    /// Position and heading.
    Position(PositionSetPoint),
    /// A place that is given above the ground, and a heading: the way there follows the ground.
    AboveGround(PositionSetPoint),
    /// Attitude and thrust.
    Attitude(AttitudeSetPoint),
}

impl SetPoint {
    /// Position and heading, if it asks for these.
    pub fn position(&self) -> Option<&PositionSetPoint> {
        match self {
            Self::Position(position) | Self::AboveGround(position) => Some(position),
            Self::Attitude(_) => None,
        }
    }

    /// Whether it asks for a heading.
    pub fn turns(&self) -> bool {
        self.position().is_none_or(|position| position.yaw != YawTarget::Hold)
    }
}
