//! What is flown, under which circumstances.

use nalgebra::Vector3;
use quadrotor::{Configuration, Disturbance, Inputs, PositionReference};

use super::flyer::Flyer;
use super::path::Path;

/// A row of the table of bars.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Row {
    /// 300 m at the speed limit.
    Cruise,
    /// Raw goals.
    Goal,
    /// Smooth paths within the limits.
    Path,
    /// Smooth paths beyond the limits.
    BeyondLimits,
    /// A steady side force.
    SideForce,
    /// A wrong mass.
    Mass,
    /// Slow rotors.
    RotorLag,
    /// A spin about the thrust axis.
    Spin,
    /// Raw goals under a wrong mass.
    MassGoal,
    /// What nobody can foresee: goals that jump, positions alone, velocities that are reversed.
    Unforeseen,
}

impl Row {
    /// Name in results.json and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Cruise => "cruise",
            Self::Goal => "goal",
            Self::Path => "path",
            Self::BeyondLimits => "beyond-limits",
            Self::SideForce => "side-force",
            Self::Mass => "mass",
            Self::RotorLag => "rotor-lag",
            Self::Spin => "spin",
            Self::MassGoal => "mass-goal",
            Self::Unforeseen => "unforeseen",
        }
    }
}

/// Where the vehicle is asked to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Demand {
    /// A raw step from the origin, NED, m.
    Goal([f64; 3]),
    /// A trajectory with velocity and acceleration.
    Path(Path),
    /// Points of a trajectory.
    Points(Points),
    /// Raw goals that change each second, this far away at most, m; then the origin.
    Jumps(f64),
    /// North and back at a speed, m/s, that is reversed each 5 s.
    ToAndFro(f64),
}

/// Points of a trajectory as somebody sets them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Points {
    /// The trajectory.
    pub path: Path,
    /// How many derivatives are set with each; with none, they are positions alone.
    pub derivatives: usize,
    /// How often they are set, s.
    pub each_s: f64,
    /// To what all numbers are rounded, m, m/s …; 0 if they are exact.
    pub rounded_to: f64,
}

impl Points {
    /// The point that holds at a time.
    fn reference(&self, time_s: f64) -> PositionReference {
        // A time that rounding put just before an instant is that instant.
        let set_s = (time_s / self.each_s + 1e-6).floor() * self.each_s;
        let rounded = |value: f64| {
            if self.rounded_to > 0.0 { (value / self.rounded_to).round() * self.rounded_to } else { value }
        };
        let given = |order: usize| {
            if order <= self.derivatives {
                self.path.derivative(set_s, order).map(rounded)
            } else {
                Vector3::zeros()
            }
        };
        PositionReference {
            velocity_m_s: given(1),
            acceleration_m_s2: given(2),
            jerk_m_s3: given(3),
            snap_m_s4: given(4),
            ..PositionReference::goal(given(0).into(), 0.0)
        }
    }
}

/// How many goals there are before the last one, the origin.
const JUMPS: usize = 20;
/// Steps of an evenly spread sequence of points in a cube: the reciprocal powers of the real root of g⁴ = g + 1.
const SPREAD: [f64; 3] = [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_2];
/// How long a speed lasts before it is reversed, s.
const LEG_S: f64 = 5.0;

/// The goal of a second, up to a distance from the origin in each horizontal axis and to a third of it in height.
fn jumping_goal_m(reach_m: f64, second: usize) -> [f64; 3] {
    if second >= JUMPS {
        return [0.0; 3];
    }
    let place = |axis: usize| 2.0 * (SPREAD[axis] * (second + 1) as f64).fract() - 1.0;
    [reach_m * place(0), reach_m * place(1), reach_m / 3.0 * place(2)]
}

/// Where a vehicle is that flies north and back, and how fast.
fn to_and_fro(speed_m_s: f64, time_s: f64) -> PositionReference {
    let (legs, into_s) = ((time_s / LEG_S) as u64, time_s % LEG_S);
    let (north_m, north_m_s) = if legs.is_multiple_of(2) {
        (speed_m_s * into_s, speed_m_s)
    } else {
        (speed_m_s * (LEG_S - into_s), -speed_m_s)
    };
    PositionReference {
        velocity_m_s: Vector3::x() * north_m_s,
        ..PositionReference::goal([north_m, 0.0, 0.0], 0.0)
    }
}

/// Rates of the swings of gusts, rad/s, none of which is a multiple of another.
const SWINGS_RAD_S: [f64; 5] = [0.3, 0.7, 1.3, 2.9, 5.1];
/// When a torque comes and goes, s.
const TORQUE_S: core::ops::Range<f64> = 5.0..15.0;

/// Forces and torques that come and go.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pushes {
    /// Largest force of each of the swings of gusts along each axis, N.
    pub gust_n: f64,
    /// A torque from 5 to 15 s, FRD, N·m.
    pub torque_n_m: [f64; 3],
}

impl Pushes {
    /// The force of gusts at a time, NED, N.
    fn force_n(&self, time_s: f64) -> Vector3<f64> {
        Vector3::from_fn(|axis, _| {
            let axis = axis as f64;
            let swings = SWINGS_RAD_S.into_iter().zip(0_u8..).map(|(rate_rad_s, at)| {
                let phase_rad = 2.1 * f64::from(at) + axis;
                (rate_rad_s * (1.0 + 0.13 * axis) * time_s + phase_rad).sin()
            });
            self.gust_n * swings.sum::<f64>()
        })
    }

    fn torque_n_m(&self, time_s: f64) -> Vector3<f64> {
        if TORQUE_S.contains(&time_s) { self.torque_n_m.into() } else { Vector3::zeros() }
    }
}

/// One flight.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// The row that it belongs to.
    pub row: Row,
    /// Its name, unique.
    pub name: String,
    /// Vehicle, limits and weights; the kind of controller is the flyer's.
    pub configuration: Configuration,
    /// What is asked for.
    pub demand: Demand,
    /// A steady force from the start, NED, N.
    pub force_n: [f64; 3],
    /// What comes and goes beside it.
    pub pushes: Pushes,
    /// How long, s.
    pub duration_s: f64,
}

impl Plan {
    /// Whether a flyer can do it: the geometric controller follows motions only.
    pub fn can_be_flown_by(&self, flyer: Flyer) -> bool {
        flyer != Flyer::Geometric || !matches!(self.demand, Demand::Goal(_))
    }

    /// What is asked for at a time.
    pub fn reference(&self, time_s: f64) -> PositionReference {
        match self.demand {
            Demand::Goal(goal_m) => PositionReference::goal(goal_m, 0.0),
            Demand::Path(path) => path.reference(time_s),
            Demand::Points(points) => points.reference(time_s),
            Demand::Jumps(reach_m) => PositionReference::goal(jumping_goal_m(reach_m, time_s as usize), 0.0),
            Demand::ToAndFro(speed_m_s) => to_and_fro(speed_m_s, time_s),
        }
    }

    /// Where the vehicle should be at a time, NED, m.
    pub fn place_m(&self, time_s: f64) -> Vector3<f64> {
        match self.demand {
            Demand::Points(points) => points.path.derivative(time_s, 0),
            _ => self.reference(time_s).position_m,
        }
    }

    /// What pushes at a time.
    pub fn disturbance(&self, time_s: f64) -> Disturbance {
        Disturbance {
            force_n: Vector3::from(self.force_n) + self.pushes.force_n(time_s),
            torque_n_m: self.pushes.torque_n_m(time_s),
            ..Disturbance::default()
        }
    }

    /// All inputs of a closed loop.
    pub fn inputs(&self, time_us: u64) -> Inputs {
        let time_s = time_us as f64 * 1e-6;
        Inputs {
            reference: self.reference(time_s),
            disturbance: self.disturbance(time_s),
            ..Inputs::default()
        }
    }
}
