//! What the closed loop is told, tick by tick.

use nalgebra::{UnitQuaternion, Vector2, Vector3};
use quadrotor::{AttitudeTarget, EasedLimits, Heading, Inputs, Outputs, PositionReference, Simulation};

use super::motion::{Motion, at_rest};
use super::path_steering::PathSteering;
use super::set_point::{AttitudeSetPoint, AxisTarget, PositionSetPoint, YawTarget};

/// A body-rate command may lead the vehicle by this angle, rad, and no further.
const RATE_LEAD_RAD: f64 = 0.5;

/// The present way of steering.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(clippy::large_enum_variant)] // There is one of it.
pub enum Steering {
    /// Rotors idle, level, on the ground.
    Idle {
        /// Heading, rad.
        yaw_rad: f64,
    },
    /// To a place, through the shaper.
    Goal(PositionReference),
    /// Along a planned way.
    Path(PathSteering),
    /// A moving reference, as it is.
    Motion(Motion),
    /// An attitude and a thrust.
    Attitude {
        /// As asked for.
        set_point: AttitudeSetPoint,
        /// The attitude that is tracked now.
        reference: UnitQuaternion<f64>,
    },
    /// Down on the rotors that are left.
    Descent {
        /// The one that is lost, front (0) to left (3).
        lost_rotor: usize,
        /// Where and how fast.
        reference: PositionReference,
    },
}

/// The ways of steering, without their data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SteeringKind {
    /// Rotors idle.
    Idle,
    /// Position and heading.
    Position,
    /// Attitude and thrust.
    Attitude,
    /// Position without heading.
    Descent,
}

/// What the attitude controller tracks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrackedAttitude {
    /// FRD into NED.
    pub attitude: UnitQuaternion<f64>,
    /// FRD, rad/s.
    pub body_rate_rad_s: Vector3<f64>,
    /// Share of the thrust that the rotors can make, 0 to 1.
    pub thrust: f64,
}

impl Steering {
    /// Without the data.
    pub fn kind(&self) -> SteeringKind {
        match self {
            Self::Idle { .. } => SteeringKind::Idle,
            Self::Goal(_) | Self::Path(_) | Self::Motion(_) => SteeringKind::Position,
            Self::Attitude { .. } => SteeringKind::Attitude,
            Self::Descent { .. } => SteeringKind::Descent,
        }
    }

    /// What it is asked for by position, axis by axis.
    pub(super) fn asked(&self) -> Option<PositionSetPoint> {
        match self {
            Self::Goal(goal) => Some(PositionSetPoint {
                axes: goal.position_m.data.0[0].map(AxisTarget::Position),
                yaw: YawTarget::Angle(goal.yaw_rad),
            }),
            Self::Motion(motion) => Some(motion.set_point()),
            Self::Idle { .. } | Self::Path(_) | Self::Attitude { .. } | Self::Descent { .. } => None,
        }
    }

    /// Where it leads, NED, m, if it leads to a place.
    pub(super) fn destination_m(&self) -> Option<Vector3<f64>> {
        match self {
            Self::Path(path) => Some(path.end().position_m),
            _ => self.asked()?.place(),
        }
    }

    /// Whether its heading follows something that moves.
    pub(super) fn follows_heading(&self) -> bool {
        match self {
            Self::Goal(goal) => goal.yaw_rate_rad_s != 0.0,
            Self::Motion(motion) => matches!(motion.set_point().yaw, YawTarget::Follow(..)),
            Self::Idle { .. } | Self::Path(_) | Self::Attitude { .. } | Self::Descent { .. } => false,
        }
    }

    /// Whether it turns to a heading, rad, that changes at a rate, rad/s, already, or to none that does, bit for bit.
    pub(super) fn turns_to(&self, heading: Option<(f64, f64)>) -> bool {
        let goal = match self {
            Self::Goal(goal) => Heading { yaw_acceleration_rad_s2: 0.0, ..Heading::of(goal) },
            Self::Path(path) => path.goal(),
            Self::Motion(_) => return false,
            Self::Idle { .. } | Self::Attitude { .. } | Self::Descent { .. } => return true,
        };
        let (yaw_rad, yaw_rate_rad_s, yaw_acceleration_rad_s2) = match heading {
            Some((yaw_rad, rate_rad_s)) => (yaw_rad, rate_rad_s, 0.0),
            None => (goal.yaw_rad, 0.0, goal.yaw_acceleration_rad_s2),
        };
        [
            (goal.yaw_rad, yaw_rad),
            (goal.yaw_rate_rad_s, yaw_rate_rad_s),
            (goal.yaw_acceleration_rad_s2, yaw_acceleration_rad_s2),
        ]
        .iter()
        .all(|(has, asked)| f64::to_bits(*has) == f64::to_bits(*asked))
    }

    /// Whether it is asked for body rates, and for no attitude.
    pub(super) fn is_by_rates(&self) -> bool {
        matches!(self, Self::Attitude { set_point, .. } if set_point.attitude.is_none())
    }

    fn lost_rotor(&self) -> Option<usize> {
        match self {
            Self::Descent { lost_rotor, .. } => Some(*lost_rotor),
            _ => None,
        }
    }

    /// Steers by position from now on. Places go through the shaper, the rest is a moving reference that takes over
    /// where the present one is.
    pub fn follow(&mut self, set_point: &PositionSetPoint, outputs: &Outputs) {
        let now = self.present(outputs);
        if let Some(goal) = set_point.goal() {
            let yaw_rad = match (set_point.yaw, &self) {
                (YawTarget::Angle(angle), _) => angle,
                // An unfinished turn goes on.
                (_, Self::Goal(goal)) => goal.yaw_rad,
                (_, Self::Path(path)) => path.goal().yaw_rad,
                _ => now.yaw_rad,
            };
            *self = Self::Goal(at_rest(goal, yaw_rad));
            return;
        }
        match self {
            Self::Motion(motion) => motion.ask(*set_point, outputs.time_us),
            _ => *self = Self::Motion(Motion::from(now, *set_point, outputs.time_us)),
        }
    }

    /// Steers by attitude from now on.
    pub fn follow_attitude(&mut self, set_point: &AttitudeSetPoint, outputs: &Outputs) {
        let before = match self {
            Self::Attitude { reference, .. } => *reference,
            _ => outputs.orientation(),
        };
        let reference = set_point.attitude.unwrap_or(before);
        *self = Self::Attitude { set_point: *set_point, reference };
    }

    /// The motion to take over: that of the reference, or of the vehicle if it does not follow one.
    pub(super) fn present(&self, outputs: &Outputs) -> PositionReference {
        match self {
            Self::Goal(_) | Self::Path(_) | Self::Motion(_) => outputs.setpoint,
            Self::Idle { .. } | Self::Attitude { .. } | Self::Descent { .. } => PositionReference {
                velocity_m_s: outputs.velocity_m_s,
                ..at_rest(outputs.position_m, outputs.attitude_rad.z)
            },
        }
    }

    /// Moves a reference that only stays where it is, or goes as sticks say, with the position that is known, m north and east.
    /// Returns whether it is one.
    pub fn slide(&mut self, slid_m: &Vector2<f64>) -> bool {
        let Self::Motion(motion) = self else { return false };
        motion.slide(slid_m);
        true
    }

    /// Where it comes to rest, if it is to.
    pub(super) fn resting_place_m(&self) -> Option<Vector3<f64>> {
        let end = match self {
            Self::Goal(goal) => *goal,
            Self::Path(path) => path.end(),
            _ => return None,
        };
        (end.velocity_m_s.norm() == 0.0).then_some(end.position_m)
    }

    /// Whether it goes by position, and nowhere above z, m.
    pub(super) fn stays_below(&self, z_m: f64) -> bool {
        let leads_up = |goal_z_m: f64| {
            let axes = [AxisTarget::HOLD, AxisTarget::HOLD, AxisTarget::Position(goal_z_m)];
            PositionSetPoint { axes, yaw: YawTarget::Hold }.leads_up(z_m)
        };
        match self {
            Self::Goal(goal) => !leads_up(goal.position_m.z),
            Self::Path(path) => !leads_up(path.highest_z_m()),
            Self::Motion(motion) => !motion.leads_up(z_m),
            Self::Idle { .. } | Self::Attitude { .. } | Self::Descent { .. } => false,
        }
    }

    /// What the attitude controller tracks: the set-point, or else what the outer controllers ask for.
    pub(super) fn tracked_attitude(&self, outputs: &Outputs, strongest_n: f64) -> TrackedAttitude {
        if let Self::Attitude { set_point, reference } = self {
            let AttitudeSetPoint { body_rate_rad_s, thrust, .. } = *set_point;
            return TrackedAttitude { attitude: *reference, body_rate_rad_s, thrust };
        }
        let level = [0.0; 2];
        let idle = matches!(self, Self::Idle { .. });
        let [phi, theta] = if idle { level } else { outputs.tilt_reference_rad };
        TrackedAttitude {
            attitude: UnitQuaternion::from_euler_angles(phi, theta, outputs.setpoint.yaw_rad),
            body_rate_rad_s: Vector3::zeros(),
            thrust: outputs.thrust_n / strongest_n,
        }
    }

    /// Writes what the closed loop is asked for in the tick that begins now: target, plan, shaping and lost rotor. The rest of the inputs
    /// stays.
    pub fn apply(
        &mut self,
        simulation: &Simulation,
        limits: &EasedLimits,
        outputs: &Outputs,
        dt_s: f64,
        inputs: &mut Inputs,
    ) {
        let strongest_n = simulation.configuration().airframe.thrust_range_n().1;
        let lost_rotor = self.lost_rotor().filter(|rotor| can_fly_without(simulation, *rotor));
        inputs.lost_rotor = lost_rotor;
        (inputs.plan, inputs.attitude_target, inputs.shaping) = (None, None, None);
        match self {
            Self::Idle { yaw_rad } => {
                inputs.reference = at_rest(outputs.position_m, *yaw_rad);
                inputs.attitude_target = Some(AttitudeTarget {
                    attitude: UnitQuaternion::from_euler_angles(0.0, 0.0, *yaw_rad),
                    body_rate_rad_s: Vector3::zeros(),
                    thrust_n: 0.0,
                });
            }
            Self::Attitude { set_point, reference } => {
                if set_point.attitude.is_none() {
                    *reference = turned_on(reference, set_point, &outputs.orientation(), dt_s);
                }
                inputs.reference = at_rest(outputs.position_m, outputs.attitude_rad.z);
                inputs.attitude_target = Some(AttitudeTarget {
                    attitude: *reference,
                    body_rate_rad_s: set_point.body_rate_rad_s,
                    thrust_n: set_point.thrust * strongest_n,
                });
            }
            Self::Descent { reference, .. } => inputs.reference = *reference,
            Self::Goal(goal) => (inputs.reference, inputs.shaping) = (*goal, Some(true)),
            Self::Path(path) => {
                inputs.reference = path.reference(limits.wanted(), outputs.time_us);
                (inputs.plan, inputs.shaping) = (Some(path.plan()), Some(false));
            }
            Self::Motion(motion) => {
                (inputs.reference, inputs.shaping) = (motion.reference(outputs.time_us), Some(false));
                motion.step(&limits.largest(), dt_s);
            }
        }
    }
}

/// Whether there is a control law for the loss of a rotor. An airframe that has none flies on with the cascade.
fn can_fly_without(simulation: &Simulation, rotor: usize) -> bool {
    let checked = simulation.control().check_loss_of(rotor);
    if let Err(error) = &checked {
        tracing::error!(%error, "no flight without a rotor");
    }
    checked.is_ok()
}

/// The reference of a body-rate command: turned on at that rate, near the vehicle.
fn turned_on(
    reference: &UnitQuaternion<f64>,
    set_point: &AttitudeSetPoint,
    actual: &UnitQuaternion<f64>,
    dt_s: f64,
) -> UnitQuaternion<f64> {
    let ahead = reference * UnitQuaternion::from_scaled_axis(set_point.body_rate_rad_s * dt_s);
    let lead = (actual.inverse() * ahead).scaled_axis();
    let angle = lead.norm();
    let near = if angle > RATE_LEAD_RAD {
        actual * UnitQuaternion::from_scaled_axis(lead * (RATE_LEAD_RAD / angle))
    } else {
        ahead
    };
    UnitQuaternion::new_normalize(near.into_inner())
}
