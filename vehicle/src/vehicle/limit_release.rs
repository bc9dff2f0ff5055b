//! When limits that have been lowered in flight begin to hold for the references that the vehicle makes.

use quadrotor::Limits;

use super::fence_watch::{breach_ahead, stopping_place_m};
use super::motion::acceleration_fits;
use super::situation::Situation;
use super::steering::{Steering, SteeringKind};

/// How often that is looked at, µs.
const PERIOD_US: u64 = 20_000;
/// A stop that is less than this, m, from another one is as safe.
const FARTHER_M: f64 = 0.05;

/// Whether limits have been lowered and the motion can keep them from now on: its acceleration can be taken out within them, and a
/// stop within them is as safe as one within the limits that it began with.
///
/// A way to a goal is the closed loop's plan, which knows itself when it keeps them. Another reference without a plan is judged by its
/// present motion: a plan of larger limits, in which the closed loop is easing, may have no acceleration now and need them later.
pub fn is_fitting(situation: &Situation, easing: bool) -> bool {
    if !situation.limits.is_eased() || !situation.time_us.is_multiple_of(PERIOD_US) {
        return false;
    }
    if !situation.armed || situation.steering.kind() != SteeringKind::Position {
        return true;
    }
    let wanted = situation.limits();
    let fits = match situation.steering {
        Steering::Motion(motion) => motion.fits(wanted),
        Steering::Goal(_) => !easing,
        _ => !easing && takes_acceleration_out(situation, wanted),
    };
    fits && stops_as_safely(situation, wanted)
}

fn takes_acceleration_out(situation: &Situation, limits: &Limits) -> bool {
    let acceleration = situation.outputs.setpoint.acceleration_m_s2;
    let (horizontal, vertical) = (acceleration.xy().norm(), acceleration.z.abs());
    acceleration_fits(horizontal, 0.0, limits.acceleration_horizontal_m_s2, limits.jerk_horizontal_m_s3)
        && acceleration_fits(vertical, 0.0, limits.acceleration_vertical_m_s2, limits.jerk_vertical_m_s3)
}

/// Whether a stop within limits leads neither into the ground nor through the fence, unless it ends where any stop does.
fn stops_as_safely(situation: &Situation, wanted: &Limits) -> bool {
    let largest = situation.braking_limits();
    let [later_m, sooner_m] = [wanted, &largest].map(|limits| stopping_place_m(situation, limits));
    if (later_m - sooner_m).norm() < FARTHER_M {
        return true;
    }
    let grounded = later_m.z > situation.terrain.z_below_m(&later_m);
    let bounded = situation.fence().is_some_and(|fence| fence.bounds());
    !(grounded || bounded && breach_ahead(situation, wanted).is_some())
}
