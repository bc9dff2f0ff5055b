//! The bars of the random flights.

use super::result::BarResult;
use crate::robustness::RobustnessResult;

/// Most flights that may break the speed limit by more than 1 %, %.
const SPEED_BROKEN: f64 = 5.0;
/// Largest median error, cm.
const MEDIAN_CM: f64 = 3.0;

/// Holds the shaped random flights of a controller against their bars.
pub fn judged(flights: &RobustnessResult, controller: &str) -> Vec<BarResult> {
    let percent = |count: u32| 100.0 * f64::from(count) / f64::from(flights.flights.max(1));
    [
        (
            "speed limit broken by more than 1 %, % of the flights",
            percent(flights.speed_violations),
            SPEED_BROKEN,
        ),
        ("tilt limit broken by more than 1 %, % of the flights", percent(flights.tilt_violations), 0.0),
        ("not arrived, % of the flights", percent(flights.flights - flights.arrived), 0.0),
        ("median error, cm", 100.0 * flights.median_m, MEDIAN_CM),
    ]
    .into_iter()
    .map(|(figure, value, bound)| BarResult {
        row: "random",
        flight: format!("{} random flights, shaped", flights.flights),
        controller: controller.to_owned(),
        figure,
        value: Some(value).filter(|value| value.is_finite()),
        bound: Some(bound),
        passed: Some(value <= bound),
        lost: None,
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::judged;
    use crate::robustness::RobustnessResult;

    #[test]
    fn counts_become_shares_and_medians_centimetres() {
        let flights = RobustnessResult {
            controller: "LMPC".to_owned(),
            mission: "shaped",
            flights: 200,
            arrived: 199,
            worst_m: None,
            median_m: 0.025,
            p95_m: None,
            violations: 12,
            tilt_violations: 0,
            speed_violations: 12,
            distances_m: Vec::new(),
        };
        let values: Vec<(Option<f64>, Option<bool>)> =
            judged(&flights, "LMPC").iter().map(|result| (result.value, result.passed)).collect();
        assert_eq!(
            values,
            [
                (Some(6.0), Some(false)),
                (Some(0.0), Some(true)),
                (Some(0.5), Some(false)),
                (Some(2.5), Some(true))
            ]
        );
    }
}
