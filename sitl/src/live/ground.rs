//! The ground as the page draws it: heights at few enough places to be sent at once.

use vehicle::surroundings::Terrain;
use viewer::GroundScene;

/// Most squares along a side.
const MOST_SQUARES: f64 = 100.0;
/// Squares around what heights are given for, where the ground goes on level.
const BORDER: f64 = 15.0;
/// Heights are sent to the centimetre.
const PER_METRE: f64 = 100.0;

/// Heights of uneven ground, with a round length between them.
pub fn ground(terrain: &Terrain) -> Option<GroundScene> {
    let [low_m, high_m] = terrain.extent_m()?;
    let longest_m = (high_m[0] - low_m[0]).max(high_m[1] - low_m[1]);
    let step_m = round_length_m(longest_m / (MOST_SQUARES - 2.0 * BORDER - 2.0));
    let first = low_m.map(|end_m| (end_m / step_m).floor() - BORDER);
    let last = high_m.map(|end_m| (end_m / step_m).ceil() + BORDER);
    let along = |axis: usize| {
        (0..=(last[axis] - first[axis]) as usize).map(move |index| step_m * (first[axis] + index as f64))
    };
    let height_m = |place_m| (-terrain.z_m(place_m) * PER_METRE).round() / PER_METRE;
    let rows_m =
        along(0).map(|north_m| along(1).map(|east_m| height_m([north_m, east_m])).collect()).collect();
    Some(GroundScene { corner_m: first.map(|index| step_m * index), step_m, rows_m })
}

/// The least of 1, 2, 5, 10, 20, 50 … m that is not below a length, m.
fn round_length_m(least_m: f64) -> f64 {
    let decade_m = 10_f64.powf(least_m.max(1.0).log10().floor());
    [1.0, 2.0, 5.0, 10.0]
        .map(|factor| factor * decade_m)
        .into_iter()
        .find(|length_m| *length_m >= least_m)
        .unwrap_or(10.0 * decade_m)
}

#[cfg(test)]
mod tests {
    use vehicle::surroundings::{Hill, Relief, Terrain};

    use super::{MOST_SQUARES, ground};

    #[test]
    fn few_heights_are_those_of_the_hill_at_every_size() {
        for radius_m in [3.0, 40.0, 44.5, 700.0, 1e5] {
            let hill = Hill { centre_m: [10.0, -20.0], radius_m, top_m: 0.0, height_m: 8.0 };
            let scene = ground(&Terrain::new(Relief { grid: None, hills: vec![hill] })).expect("uneven");
            assert!(scene.rows_m.len() <= MOST_SQUARES as usize + 1, "{radius_m}");
            for (row, heights_m) in scene.rows_m.iter().enumerate() {
                assert!(heights_m.len() <= MOST_SQUARES as usize + 1, "{radius_m}");
                for (column, height_m) in heights_m.iter().enumerate() {
                    let north_m = scene.corner_m[0] + scene.step_m * row as f64 - 10.0;
                    let east_m = scene.corner_m[1] + scene.step_m * column as f64 + 20.0;
                    let off = (north_m.hypot(east_m) / radius_m).min(1.0);
                    let expected_m = 4.0 * (1.0 + (std::f64::consts::PI * off).cos());
                    assert!((height_m - expected_m).abs() < 0.0051, "{north_m} {east_m}");
                }
            }
            let edges_m = [&scene.rows_m[0], scene.rows_m.last().expect("rows")];
            assert!(
                edges_m.iter().all(|row| row.iter().all(|height_m| *height_m == 0.0)),
                "the border is level"
            );
        }
        assert_eq!(ground(&Terrain::default()), None);
    }
}
