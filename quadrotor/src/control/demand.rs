//! How much a reference demands of what the limits and the rotors allow.

use nalgebra::Vector2;

use crate::control::required_thrust::{RequiredThrust, level_range};
use crate::design::controller_limits::thrust_range_n;
use crate::{Configuration, GRAVITY_M_S2, PositionReference, commanded_tilt_rad};

/// How many times the limits of lean, tilt rate and tilt acceleration are followed as they are asked for: feedback and
/// [`FollowedWay`](crate::control::followed_way::FollowedWay) do with peaks. Of what the thrust allows up and down no more is followed: more
/// on one side than on the other would push the vehicle to that side.
pub(crate) const FOLLOWED: f64 = 1.3;
/// Share of the angular acceleration that the rotors have in hover which is followed, whatever the limits allow: feedback that has none
/// left turns the vehicle over.
const OF_AVAILABLE: f64 = 0.9;
/// Share of that which a vertical motion may use where its thrust swings at a lean: the horizontal motion and feedback have the rest.
const SWUNG: f64 = 0.35;
/// The largest acceleration down that is followed, as a share of gravity: what thrust is left turns the vehicle.
const FALLEN: f64 = 0.8;
/// Share of the room that is left beside more thrust than in hover which is counted on: feedback needs the same torque there.
const OF_ROOM: f64 = 0.8;
/// Share of the room of the rotors in hover that turns the vehicle at any thrust.
const LEAST_ROOM: f64 = 0.05;
/// Halvings with which it is searched how far a way must be narrowed: to within 0.005.
const HALVINGS: usize = 12;
/// Less than this, m/s², is not divided by.
const LEAST_M_S2: f64 = 1e-3;
/// The most that counts of what is asked for: a single point that asks for anything is no way.
const MOST_ASKED: f64 = 20.0;

/// The largest multiples of what is followed as it is that a reference asks for, horizontally and vertically. Horizontally it is what it asks
/// for beside the share of its vertical motion that is followed.
///
/// A lean l = a/w, w being the vertical part of the thrust, turns as
///
/// ```text
/// l′ = (j − l w′)/w,  l″ = (s − 2 l′ w′ − l w″)/w
/// ```
///
/// Beside more thrust than in hover the rotors have less room to turn the vehicle. Whatever leans swings with its thrust: of the vertical
/// motion, no more is followed than what turns the lean of the reference, as far as it is within the limit, with a share of the rate and of
/// the acceleration.
pub(crate) fn asked(
    configuration: &Configuration,
    available_rad_s2: f64,
    reference: &PositionReference,
    vertical_share: f64,
) -> Vector2<f64> {
    let limits = &configuration.limits;
    let (up_m_s2, down_m_s2) = level_range(configuration);
    let whole = RequiredThrust::whole(configuration, reference);
    let vertical_m_s2 = whole.acceleration_m_s2.z;
    let followed_m_s2 = if vertical_m_s2 > 0.0 { down_m_s2.min(FALLEN * GRAVITY_M_S2) } else { -up_m_s2 };
    let followed = whole.with_vertical(vertical_share).within_thrust(configuration);
    let most_m_s2 = followed.most_horizontal_m_s2(configuration, commanded_tilt_rad(configuration));
    let rate_rad_s = FOLLOWED * limits.tilt_rate_rad_s;
    let most_rad_s2 = |carried_m_s2: f64| {
        let available_rad_s2 = available_rad_s2 * room_share(configuration, carried_m_s2);
        (FOLLOWED * limits.tilt_acceleration_rad_s2).min(OF_AVAILABLE * available_rad_s2)
    };

    let [w, w_rate, w_bend] = followed.carrying();
    let lean = followed.acceleration_m_s2.xy() / w;
    let rate = (followed.jerk_m_s3.xy() - lean * w_rate) / w;
    let bend = (followed.snap_m_s4.xy() - rate * (2.0 * w_rate) - lean * w_bend) / w;
    let level_m_s2 = followed.acceleration_m_s2.xy().norm();
    let leant = level_m_s2 / (FOLLOWED * most_m_s2.max(LEAST_M_S2));
    // A narrower way leans less, takes less thrust, and leaves the rotors more room.
    let turned = least_fitting(bend.norm(), |multiple| most_rad_s2(libm::hypot(level_m_s2 / multiple, w)));
    let horizontal = leant.max(rate.norm() / rate_rad_s).max(turned);

    let [_, w_rate, w_bend] = whole.carrying();
    let swing = (w_rate.abs() / rate_rad_s).max(w_bend.abs() / most_rad_s2(w)) / GRAVITY_M_S2;
    let swung = lean.norm().min(most_m_s2 / w) * swing / SWUNG;
    let vertical = swung.max(vertical_m_s2.abs() / followed_m_s2.max(LEAST_M_S2));
    Vector2::new(horizontal, vertical).map(|asked| asked.min(MOST_ASKED))
}

/// How much of the angular acceleration that the rotors have in hover they have beside a thrust that accelerates by so much, m/s²: what none of
/// them can give any more turns nothing.
fn room_share(configuration: &Configuration, accelerated_m_s2: f64) -> f64 {
    let airframe = &configuration.airframe;
    let (weakest_n, strongest_n) = airframe.thrust_range_n();
    let weight_n = airframe.weight_n();
    let (_, most_n) = thrust_range_n(configuration);
    let thrust_n = (airframe.mass_kg * accelerated_m_s2).min(most_n);
    let hover_n = (weight_n - weakest_n).min(strongest_n - weight_n);
    if hover_n > 0.0 {
        (OF_ROOM * (strongest_n - thrust_n) / hover_n).clamp(LEAST_ROOM, 1.0)
    } else {
        LEAST_ROOM
    }
}

/// The least multiple m of what is followed as it is at which asked/m is within `most(m)`, or what is asked for as a share of `most(1)`.
fn least_fitting(asked: f64, most: impl Fn(f64) -> f64) -> f64 {
    let whole = asked / most(1.0);
    if whole <= 1.0 {
        return whole;
    }
    let (mut low, mut high) = (1.0, MOST_ASKED);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if asked > middle * most(middle) { low = middle } else { high = middle }
    }
    high
}

#[cfg(test)]
pub(crate) mod tests {
    use super::room_share;
    use crate::{Configuration, GRAVITY_M_S2};

    /// Rotors that make 2.4 weights.
    pub(crate) fn weaken(configuration: &mut Configuration) {
        let airframe = &mut configuration.airframe;
        let strongest_n = 2.4 * airframe.weight_n();
        airframe.rotor_speed_max_rad_s *= libm::sqrt(strongest_n / airframe.thrust_range_n().1);
    }

    /// Rotors that make 2.4 weights and at least 0.039 can each lose 0.961 of the weight in hover. Beside 1.6 weights, 0.8 of 0.8 weights are
    /// counted on; 0.8 of the strongest thrust is the most that is used.
    #[test]
    fn the_room_of_the_rotors_shrinks_with_their_thrust() {
        let mut configuration = Configuration::default();
        configuration.limits.thrust_max = 20.0;
        weaken(&mut configuration);
        let of = |weights: f64| room_share(&configuration, weights * GRAVITY_M_S2);
        assert_eq!([0.0, 0.5, 1.0].map(of), [1.0; 3]);
        for (weights, share) in [(1.6, 0.8 * 0.8 / 0.960_668), (1.92, 0.8 * 0.48 / 0.960_668)] {
            assert!((of(weights) - share).abs() < 1e-6, "{} {share}", of(weights));
        }
        assert!((of(3.0) - of(1.92)).abs() < 1e-12);
    }
}
