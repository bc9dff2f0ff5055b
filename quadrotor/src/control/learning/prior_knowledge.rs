//! What is known of mass, drag and forces before a flight shows anything.

use nalgebra::SVector;

use crate::Configuration;
use crate::control::learning::bounded_estimate::Prior;

/// Learned: μ, the airframe's mass over the learned one; κ, drag per mass along north, east and down, 1/s; d, the
/// acceleration by other forces, NED, m/s².
pub(super) const UNKNOWNS: usize = 7;
pub(super) type Unknowns = SVector<f64, UNKNOWNS>;

/// Range of the learned mass, as a multiple of the airframe's.
const MASS_RANGE: [f64; 2] = [0.4, 2.5];
/// Share of the rotors' largest thrust that a learned mass may weigh.
const LIFTED_SHARE: f64 = 0.9;
/// Most drag per mass, 1/s, unless half of that of the airframe is more. Published ones of quadrotors are from 0.1 to 1.
const MOST_DRAG_1_S: f64 = 2.0;
/// Most acceleration by other forces, m/s².
pub(super) const MOST_FORCE_M_S2: f64 = 30.0;

/// Deviations before anything is learned. A payload or a wrong model is taken for as likely as a force of a third of the weight:
/// at first a vertical push counts as both, and what the thrust then does to the acceleration tells which it was.
const MASS_DEVIATION: f64 = 0.3;
pub(super) const DRAG_DEVIATION_1_S: f64 = 0.2;
const FORCE_DEVIATION_M_S2: f64 = 3.0;
/// How fast each may wander, per √s: the thrust sags with the battery, drag stays as it is, the wind changes.
const MASS_WANDERING: f64 = 0.003;
const DRAG_WANDERING_1_S: f64 = 0.003;
const FORCE_WANDERING_M_S2: f64 = 0.3;

/// What a configuration believes in.
pub(super) fn believed(configuration: &Configuration) -> Unknowns {
    let mut mean = Unknowns::zeros();
    mean[0] = 1.0 / configuration.controllers.mass_factor;
    mean.fixed_rows_mut::<3>(1).copy_from(&configuration.drag_1_s());
    mean
}

/// Range of the learned mass, as a multiple of the airframe's: one that flies is lifted by its rotors, with some to lean. What weighs
/// more is a force.
fn mass_range(configuration: &Configuration) -> [f64; 2] {
    let [lightest, heaviest] = MASS_RANGE;
    let (_, strongest_n) = configuration.airframe.thrust_range_n();
    let lifted = LIFTED_SHARE * strongest_n / configuration.airframe.weight_n();
    let believed = configuration.controllers.mass_factor;
    [lightest, heaviest.min(lifted).max(1.0).max(believed)]
}

/// How well what a configuration believes in is known.
pub(super) fn prior(configuration: &Configuration) -> Prior<UNKNOWNS> {
    let [lightest, heaviest] = mass_range(configuration);
    let mut most = each(1.0 / lightest, MOST_DRAG_1_S, MOST_FORCE_M_S2);
    for (axis, drag_1_s) in configuration.drag_1_s().iter().enumerate() {
        most[1 + axis] = most[1 + axis].max(2.0 * drag_1_s);
    }
    Prior {
        deviation: each(MASS_DEVIATION, DRAG_DEVIATION_1_S, FORCE_DEVIATION_M_S2),
        range: [each(1.0 / heaviest, 0.0, -MOST_FORCE_M_S2), most],
    }
}

/// Time in which what was learned of each fades, s: the variance grows by 2σ²/T per second.
pub(super) fn memory_s() -> Unknowns {
    let memory_s = |deviation: f64, wandering: f64| 2.0 * deviation * deviation / (wandering * wandering);
    each(
        memory_s(MASS_DEVIATION, MASS_WANDERING),
        memory_s(DRAG_DEVIATION_1_S, DRAG_WANDERING_1_S),
        memory_s(FORCE_DEVIATION_M_S2, FORCE_WANDERING_M_S2),
    )
}

fn each(mass: f64, drag: f64, force: f64) -> Unknowns {
    Unknowns::from_fn(|i, _| match i {
        0 => mass,
        1..4 => drag,
        _ => force,
    })
}
