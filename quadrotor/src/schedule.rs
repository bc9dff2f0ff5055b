//! How far the integration may step.

use crate::{Plant, PlantInputs, PlantState};

/// Longest integration step, µs: on the ground, which is stiff, and in flight that is not calm.
const SHORT_STEP_US: u64 = 1_000;
/// Longest integration step of calm flight, µs.
pub(crate) const LONG_STEP_US: u64 = 5_000;
/// The same, s.
pub(crate) const LONG_STEP_S: f64 = LONG_STEP_US as f64 / 1e6;

/// The first look at the inputs after `time_us`. Each point of the integration grid is one.
pub(crate) fn next_look_us(time_us: u64) -> u64 {
    (time_us / SHORT_STEP_US + 1) * SHORT_STEP_US
}

/// The first point of the integration grid after `time_us`, at which the plant is in this state and begins to be acted on by these inputs.
pub(crate) fn next_point_us(
    time_us: u64,
    plant: &Plant,
    (state, inputs): (&PlantState, &PlantInputs),
) -> u64 {
    point_after_us(time_us, plant.is_calm(state, inputs))
}

/// The same for a plant that is known to be calm or not.
pub(crate) fn point_after_us(time_us: u64, is_calm: bool) -> u64 {
    if is_calm { (time_us / LONG_STEP_US + 1) * LONG_STEP_US } else { next_look_us(time_us) }
}

#[cfg(test)]
mod tests {
    use super::{next_look_us, next_point_us};
    use crate::{Airframe, Environment, InitialState, Plant, PlantInputs, PlantState};

    #[test]
    fn looks_are_a_millisecond_apart_and_later_than_now() {
        for (time_us, next_us) in
            [(0, 1_000), (1, 1_000), (999, 1_000), (1_000, 2_000), (12_345_678, 12_346_000)]
        {
            assert_eq!(next_look_us(time_us), next_us);
        }
    }

    #[test]
    fn points_are_a_millisecond_apart_on_the_ground_and_five_in_the_air() {
        let airframe = Airframe::default();
        let plant = Plant::new(&airframe, &Environment { ground_plane: true });
        let next_us = |time_us, z_m| {
            let initial = InitialState { position_m: [0.0, 0.0, z_m], ..InitialState::default() };
            let state = PlantState::hovering(&initial, &airframe);
            next_point_us(time_us, &plant, (&state, &PlantInputs::rotor_speeds(state.rotor_speed_rad_s)))
        };
        for (time_us, next_short_us, next_long_us) in [
            (0, 1_000, 5_000),
            (4_999, 5_000, 5_000),
            (5_000, 6_000, 10_000),
            (12_346_000, 12_347_000, 12_350_000),
        ] {
            assert_eq!((next_us(time_us, 0.0), next_us(time_us, -9.0)), (next_short_us, next_long_us));
        }
    }
}
