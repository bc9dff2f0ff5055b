//! Contact with a ground that is level below the vehicle: at z = 0 unless the inputs say otherwise.

use nalgebra::Vector3;

use crate::plant::differentiation::real::{Real, Valued, constant};
use crate::plant::events::branches::{Branches, ByValue};
use crate::plant::events::switch::Switch;
use crate::plant::orientation::Orientation;
use crate::plant::rigid_body::{External, RigidBody};
use crate::{Airframe, GRAVITY_M_S2};

/// Natural frequency of the vehicle on its four feet, rad/s: it rests 4 mm deep, and the integration
/// step of 1 ms resolves the contact fifty times over.
const CONTACT_FREQUENCY_RAD_S: f64 = 50.0;
/// Critically damped: a landing does not bounce.
const CONTACT_DAMPING_RATIO: f64 = 1.0;
/// Rubber on concrete.
const FRICTION_COEFFICIENT: f64 = 0.7;
/// Slip speed at which friction is fully developed, m/s; it keeps the equations smooth.
const FRICTION_SLIP_M_S: f64 = 0.1;
/// Deepest that a foot may start, m. A level vehicle at rest settles from here without leaving the ground, whatever its
/// mass; from 3 cm on the contact would throw it up.
const DEEPEST_START_M: f64 = 0.01;

/// Force, NED, N, and torque, FRD, N·m, of the ground on the four feet. There is one below, or above, each rotor, level with
/// the centre of mass, so that a vehicle at rest on the ground is at its height, `ground_z_m`, but for the compliance.
///
/// The friction is that of feet that slip: proportional to a slow slip, and zero at rest. [`HoldingMargins`] decide when
/// static friction holds the vehicle instead. `reach_m` is [`Airframe::reach_m`].
pub(crate) fn contact<T: Real>(
    airframe: &Airframe,
    body: &RigidBody<T>,
    ground_z_m: T,
    reach_m: f64,
    branches: &mut impl Branches<T>,
) -> External<T> {
    let mut total = External::default();
    // No foot can touch the ground in any attitude.
    if branches.may_skip(body.position_m.z - ground_z_m, -reach_m) {
        return total;
    }
    let orientation = body.orientation();
    for (index, foot) in feet(airframe).into_iter().enumerate() {
        let foot = constant(foot);
        let depth = depth_m(body, ground_z_m, &orientation, &foot);
        if branches.may_skip(depth, 0.0) {
            continue;
        }
        let footing = Footing::new(airframe, body, &orientation, &foot, depth);
        let Some(normal) = footing.normal_n(airframe, index, branches) else { continue };
        let (x, y) = (footing.velocity_m_s.x, footing.velocity_m_s.y);
        let slip = x.hypot(y);
        let full = T::constant(FRICTION_SLIP_M_S);
        let slides = branches.exceeds(Switch::Slides(index), slip, full, FRICTION_SLIP_M_S);
        let limit = normal * FRICTION_COEFFICIENT;
        let friction = if slides { limit / slip } else { limit / FRICTION_SLIP_M_S };
        let force = Vector3::new(-friction * x, -friction * y, -normal);
        total.force_n += force;
        total.torque_n_m += foot.cross(&orientation.in_body(&force));
    }
    total
}

/// How far static friction is from letting the vehicle go, or from holding it.
pub(crate) struct HoldingMargins {
    /// By how much it slips more slowly than sliding friction needs to develop, m/s; nothing is held from zero on.
    pub(crate) slip_m_s: f64,
    /// What the foot with the least load bears, N; nothing is held from zero down.
    pub(crate) least_load_n: f64,
    /// What the feet can take beyond the pull, N; nothing is held below zero.
    pub(crate) grip_n: f64,
}

impl HoldingMargins {
    /// Of a body under a `pull`, which is all force and torque but the ground's and gravity: all feet must carry load, it must
    /// slip more slowly than sliding friction needs to develop, and the feet together must be able to take the pull.
    pub(crate) fn new(airframe: &Airframe, body: &RigidBody, ground_z_m: f64, pull: &External) -> Self {
        let orientation = body.orientation();
        let footings = feet(airframe).map(|foot| {
            let depth = depth_m(body, ground_z_m, &orientation, &foot);
            Footing::new(airframe, body, &orientation, &foot, depth)
        });
        let load_n: f64 = footings
            .iter()
            .enumerate()
            .map(|(index, footing)| footing.normal_n(airframe, index, &mut ByValue).unwrap_or(0.0))
            .sum();
        // A foot at the nearest rotor bears |f|/4 + |τ|/4r of at most μ N/4. With an offset centre of gravity the feet bear
        // unequal loads, and this is an approximation.
        let nearest_m = airframe.arm_length_m * airframe.layout.nearest();
        let demand_n = pull.force_n.xy().norm() + libm::fabs(pull.torque_n_m.z) / nearest_m;
        Self {
            slip_m_s: FRICTION_SLIP_M_S - slip_m_s(body, airframe.reach_m()),
            least_load_n: footings.iter().map(Footing::pressing_n).fold(f64::INFINITY, f64::min),
            grip_n: FRICTION_COEFFICIENT * load_n - demand_n,
        }
    }

    /// Whether static friction holds the vehicle where it is.
    pub(crate) fn is_held(&self) -> bool {
        self.slip_m_s > 0.0 && self.least_load_n > 0.0 && self.grip_n >= 0.0
    }

    /// The least of them, as a share of what is usual.
    pub(crate) fn least(&self, airframe: &Airframe) -> f64 {
        let weight_n = airframe.weight_n();
        (self.slip_m_s / FRICTION_SLIP_M_S)
            .min(4.0 * self.least_load_n / weight_n)
            .min(self.grip_n / weight_n)
    }
}

/// Whether the vehicle is so high, or so fast along the ground, that static friction cannot hold it under any pull.
pub(crate) fn cannot_be_held<T: Valued>(body: &RigidBody<T>, ground_z_m: f64, reach_m: f64) -> bool {
    is_farther_than(0.0, body, ground_z_m, reach_m) || slip_m_s(body, reach_m) >= FRICTION_SLIP_M_S
}

/// How fast the outermost foot may slip along the ground, m/s.
fn slip_m_s<T: Valued>(body: &RigidBody<T>, reach_m: f64) -> f64 {
    let velocity_m_s = body.velocity_m_s.map(T::value);
    velocity_m_s.xy().norm() + libm::fabs(body.body_rate_rad_s.z.value()) * reach_m
}

/// The greatest z, NED, m, from which a flight can start above ground at `ground_z_m` in the attitude of this body: there the lowest foot
/// touches the ground. In whole millimetres, so that what a message prints is allowed.
pub(crate) fn greatest_start_z_m(airframe: &Airframe, body: &RigidBody, ground_z_m: f64) -> f64 {
    let rotation = body.rotation();
    let lowest_foot_m =
        feet(airframe).iter().map(|foot| (rotation * foot).z).fold(f64::NEG_INFINITY, f64::max);
    libm::floor(1e3 * (ground_z_m + DEEPEST_START_M - lowest_foot_m)) / 1e3
}

/// Whether each foot is farther above the ground than `way_m`, m, in any attitude.
pub(crate) fn is_farther_than<T: Valued>(
    way_m: f64,
    body: &RigidBody<T>,
    ground_z_m: f64,
    reach_m: f64,
) -> bool {
    body.position_m.z.value() - ground_z_m < -(reach_m + way_m)
}

/// Feet in line with the rotors, FRD from the centre of mass, m.
#[inline]
fn feet(airframe: &Airframe) -> [Vector3<f64>; 4] {
    airframe.rotor_places_m().map(|place| Vector3::new(place.x, place.y, 0.0))
}

/// How deep a foot, FRD from the centre of mass, m, is in the ground, m.
fn depth_m<T: Real>(
    body: &RigidBody<T>,
    ground_z_m: T,
    orientation: &Orientation<T>,
    foot: &Vector3<T>,
) -> T {
    body.position_m.z - ground_z_m + orientation.in_world(foot).z
}

/// No foot pushes harder, N: 200 g, so that a fall from any height stays a number.
#[inline]
fn strongest_n(airframe: &Airframe) -> f64 {
    200.0 * airframe.mass_kg * GRAVITY_M_S2
}

/// A foot and the ground.
struct Footing<T> {
    /// Force of the spring, N: negative above the ground.
    spring_n: T,
    /// Force of spring and damper, N.
    load_n: T,
    /// NED, m/s.
    velocity_m_s: Vector3<T>,
}

impl<T: Real> Footing<T> {
    fn new(
        airframe: &Airframe,
        body: &RigidBody<T>,
        orientation: &Orientation<T>,
        foot: &Vector3<T>,
        depth: T,
    ) -> Self {
        let mass = airframe.mass_kg / 4.0;
        let stiffness = mass * CONTACT_FREQUENCY_RAD_S * CONTACT_FREQUENCY_RAD_S;
        let damping = 2.0 * CONTACT_DAMPING_RATIO * mass * CONTACT_FREQUENCY_RAD_S;
        let velocity_m_s = body.velocity_m_s + orientation.in_world(&body.body_rate_rad_s.cross(foot));
        let spring_n = depth * stiffness;
        Self { spring_n, load_n: spring_n + velocity_m_s.z * damping, velocity_m_s }
    }

    /// What the foot presses with, N: positive on the ground, which only pushes.
    fn pressing_n(&self) -> T {
        self.load_n.where_greater(self.spring_n, self.spring_n, self.load_n)
    }

    /// What the foot presses with, N, if it does.
    fn normal_n(&self, airframe: &Airframe, index: usize, branches: &mut impl Branches<T>) -> Option<T> {
        let strongest_n = strongest_n(airframe);
        if !branches.exceeds(Switch::Bears(index), self.pressing_n(), T::zero(), airframe.weight_n() / 4.0) {
            return None;
        }
        let strongest = T::constant(strongest_n);
        let hardest = branches.exceeds(Switch::Hardest(index), self.load_n, strongest, strongest_n);
        Some(if hardest { strongest } else { self.load_n })
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{UnitQuaternion, Vector3};

    use super::{HoldingMargins, contact};
    use crate::plant::events::branches::ByValue;
    use crate::{Airframe, Direction, External, GRAVITY_M_S2, RigidBody, Rotor, RotorLayout};

    /// Two long arms and two short ones: reach 2 and nearest 0.5 arm lengths of 0.5 m.
    fn airframe() -> Airframe {
        let [cw, ccw] = [Direction::Clockwise, Direction::Counterclockwise];
        let rotors = [(2.0, 0.0, cw), (0.0, 0.5, ccw), (-2.0, 0.0, cw), (0.0, -0.5, ccw)]
            .map(|(x, y, direction)| Rotor { x, y, direction });
        let layout = RotorLayout { rotors };
        Airframe { mass_kg: 2.0, arm_length_m: 0.5, layout, ..Airframe::default() }
    }

    /// Level, its feet this deep in the ground, with this velocity.
    fn level(depth_m: f64, velocity_m_s: [f64; 3]) -> RigidBody {
        RigidBody {
            position_m: Vector3::new(3.0, -7.0, depth_m),
            velocity_m_s: velocity_m_s.into(),
            attitude: UnitQuaternion::identity().into_inner(),
            body_rate_rad_s: Vector3::zeros(),
        }
    }

    fn force(depth_m: f64, velocity_m_s: [f64; 3]) -> Vector3<f64> {
        let ground =
            contact(&airframe(), &level(depth_m, velocity_m_s), 0.0, airframe().reach_m(), &mut ByValue);
        assert!(ground.torque_n_m.norm() < 1e-9 * (1.0 + ground.force_n.norm()), "level feet share a load");
        ground.force_n
    }

    /// A critically damped spring of 50 rad/s: m ω² d + 2 m ω ḋ, which only pushes, and no foot with more than 200 g.
    #[test]
    fn the_ground_is_a_damped_spring() {
        assert!((force(0.004, [0.0; 3]).z + 2.0 * 2500.0 * 0.004).abs() < 1e-12);
        assert!((force(0.004, [0.0, 0.0, 0.03]).z + 20.0 + 2.0 * 2.0 * 50.0 * 0.03).abs() < 1e-12);
        assert!((force(0.004, [0.0, 0.0, -0.03]).z + 20.0 - 6.0).abs() < 1e-12);
        assert_eq!(force(0.004, [0.0, 0.0, -1.0]).z, 0.0);
        assert_eq!(force(0.0, [0.0, 0.0, 5.0]), Vector3::zeros());
        assert_eq!(force(-0.3, [0.0, 0.0, 5.0]), Vector3::zeros());
        let strongest = force(0.1, [0.0, 0.0, 1e9]).z;
        assert!((strongest + 4.0 * 200.0 * 2.0 * GRAVITY_M_S2).abs() < 1e-6, "{strongest}");
    }

    /// μ N against the slip, developed in proportion to it below 0.1 m/s.
    #[test]
    fn friction_opposes_the_slip() {
        let load = 2.0 * 2500.0 * 0.004;
        for speed in [0.02, 0.1, 3.0] {
            let pulled = force(0.004, [0.6 * speed, -0.8 * speed, 0.0]);
            let size = 0.7 * load * f64::min(speed / 0.1, 1.0);
            assert!(
                (pulled - Vector3::new(-0.6 * size, 0.8 * size, -load)).norm() < 1e-9,
                "{speed}: {pulled}"
            );
        }
    }

    /// Rolled to the right about a height at which only the right foot touches: it pushes back.
    #[test]
    fn a_single_foot_turns_the_vehicle() {
        let roll = 0.2;
        let rotation = UnitQuaternion::from_euler_angles(roll, 0.0, 0.0);
        // The right foot is 0.25 m off the middle.
        let depth = 0.01;
        let mut body = level(depth - 0.25 * libm::sin(roll), [0.0; 3]);
        body.attitude = rotation.into_inner();
        let ground = contact(&airframe(), &body, 0.0, airframe().reach_m(), &mut ByValue);
        let load = 0.5 * 2500.0 * depth;
        assert!((ground.force_n - Vector3::new(0.0, 0.0, -load)).norm() < 1e-9, "{ground:?}");
        let torque = Vector3::new(-0.25 * load * libm::cos(roll), 0.0, 0.0);
        assert!((ground.torque_n_m - torque).norm() < 1e-9, "{ground:?}");
        // A rate about the down axis moves that foot backwards, and friction pulls it forward.
        body.body_rate_rad_s.z = 1.0;
        let spun = contact(&airframe(), &body, 0.0, airframe().reach_m(), &mut ByValue);
        assert!((spun.force_n.x - 0.7 * load).abs() < 1e-9 && spun.torque_n_m.z < 0.0, "{spun:?}");
    }

    fn is_held(airframe: &Airframe, body: &RigidBody, pull: &External) -> bool {
        HoldingMargins::new(airframe, body, 0.0, pull).is_held()
    }

    fn pull(force_n: f64, torque_n_m: f64) -> External {
        External {
            force_n: Vector3::new(0.6 * force_n, 0.8 * force_n, 1e3),
            torque_n_m: Vector3::new(1e3, 1e3, torque_n_m),
        }
    }

    /// Static friction holds up to |f| + |τ|/r = μ N at the nearest foot, r = 0.25 m.
    #[test]
    fn it_is_held_up_to_the_limit_of_force_and_torque_together() {
        let (airframe, body) = (airframe(), level(0.004, [0.0; 3]));
        let most = 0.7 * 2.0 * 2500.0 * 0.004;
        for share in [-1.0, -0.5, 0.0, 0.5, 1.0_f64] {
            let held = |scale: f64| {
                let force_n = scale * most * (1.0 - share.abs());
                is_held(&airframe, &body, &pull(force_n, scale * most * share * 0.25))
            };
            assert!(held(0.999) && !held(1.001), "{share}");
        }
    }

    /// All feet must bear load, and slip by less than 0.1 m/s, the outermost one in a turn, 1 m off.
    #[test]
    fn it_is_held_only_when_it_stands_still_on_all_feet() {
        let airframe = airframe();
        let held = |body: &RigidBody| is_held(&airframe, body, &pull(0.0, 0.0));
        assert!(held(&level(0.004, [0.06, 0.079, 0.0])) && !held(&level(0.004, [0.06, 0.081, 0.0])));
        assert!(!held(&level(0.0, [0.0; 3])) && !held(&level(-2.0, [0.0; 3])));
        // Rising faster than the ground pushes, it bears nothing.
        assert!(!held(&level(0.004, [0.0, 0.0, -1.0])));
        for rate in [-1.0, 1.0] {
            let mut body = level(0.004, [0.03, 0.0, 0.0]);
            body.body_rate_rad_s.z = 0.069 * rate;
            assert!(held(&body));
            body.body_rate_rad_s.z = 0.071 * rate;
            assert!(!held(&body));
        }
        // Pitched by 6 mm over the 2 m from front to back, the front feet are in the air.
        let mut body = level(0.004, [0.0; 3]);
        body.attitude = UnitQuaternion::from_euler_angles(0.0, 0.006, 0.0).into_inner();
        assert!(!held(&body));
    }
}
