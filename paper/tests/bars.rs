//! The bars against flights and numbers computed here. Whether they are kept is tested with the results.

use std::sync::OnceLock;

use paper::bars::{BarResult, Demand, Flyer, Path, Plan, Shape, Track, flown, fly, plans, rms};
use quadrotor::{AirframePreset, Configuration, ControllerKind, Inputs, PositionReference, Simulation};

fn all_plans() -> &'static [Plan] {
    static PLANS: OnceLock<Vec<Plan>> = OnceLock::new();
    PLANS.get_or_init(|| plans(&Configuration::default()))
}

fn plan(name: &str) -> &'static Plan {
    all_plans().iter().find(|plan| plan.name == name).unwrap()
}

fn find<'a>(results: &'a [BarResult], flyer: Flyer, figure: &str) -> &'a BarResult {
    let of = |result: &&BarResult| result.controller == flyer.name() && result.figure.starts_with(figure);
    results.iter().find(of).unwrap()
}

/// Every flight that the controllers are held against, once.
#[test]
fn the_table_has_every_row() {
    let count = |row: &str| all_plans().iter().filter(|plan| plan.row.name() == row).count();
    let rows = [
        ("cruise", 2),
        ("goal", 11),
        ("path", 4),
        ("beyond-limits", 16),
        ("side-force", 2),
        ("mass", 12),
        ("mass-goal", 8),
        ("rotor-lag", 20),
        ("spin", 4),
        ("unforeseen", 11),
    ];
    for (row, flights) in rows {
        assert_eq!(count(row), flights, "{row}");
    }
    assert_eq!(rows.iter().map(|(_, flights)| flights).sum::<usize>(), all_plans().len());
    let mut names: Vec<&str> = all_plans().iter().map(|plan| plan.name.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), all_plans().len());
}

/// A step flown by the engine alone, observed every millisecond with sums written here.
#[test]
fn figures_of_a_step_are_those_of_a_flight_of_ones_own() {
    let goal_m = 5.0;
    let mut configuration = Configuration::default();
    configuration.reference.shaping = false;
    configuration.controllers.governor = false;
    configuration.controllers.kind = ControllerKind::Dlqr;
    let inputs = Inputs { reference: PositionReference::goal([goal_m, 0.0, 0.0], 0.0), ..Inputs::default() };
    let mut simulation = Simulation::new(&configuration, &inputs).unwrap();
    let (mut farthest_m, mut last_away_s, mut squared, mut largest_tilt) = (0.0_f64, 0.0, 0.0, 0.0_f64);
    for millisecond in 1..=25_000_u64 {
        simulation.advance_to(1_000 * millisecond, &inputs).unwrap();
        let outputs = simulation.outputs();
        let distance_m = (outputs.position_m - inputs.reference.position_m).norm();
        farthest_m = farthest_m.max(outputs.position_m.x);
        squared += 1e-3 * distance_m * distance_m;
        if distance_m > 0.02 {
            last_away_s = millisecond as f64 * 1e-3;
        }
        let [phi, theta] = [outputs.attitude_rad.x, outputs.attitude_rad.y];
        largest_tilt = largest_tilt.max((phi.cos() * theta.cos()).acos());
    }
    let results = flown(plan("5 m north"), &[Flyer::Regulator]).results;
    let value = |figure: &str| find(&results, Flyer::Regulator, figure).value.unwrap();
    assert!((value("overshoot") - 100.0 * (farthest_m / goal_m - 1.0)).abs() < 0.01);
    assert!((value("settled") - last_away_s).abs() < 0.011, "{} {last_away_s}", value("settled"));
    assert!((value("integral") / squared - 1.0).abs() < 1e-3);
    assert!(largest_tilt < configuration.limits.tilt_rad && value("beyond a limit") == 0.0);
}

/// Down 20 m the bare regulator falls at three times the sink rate, which is no comparison: the governed one is.
#[test]
fn a_regulator_that_breaks_limits_is_no_comparison() {
    let results = flown(plan("20 m down"), &[Flyer::Regulator, Flyer::GovernedRegulator]).results;
    let of = |flyer, figure| find(&results, flyer, figure);
    assert!(of(Flyer::Regulator, "beyond a limit").value.unwrap() > 100.0);
    let [bare, governed] =
        [Flyer::Regulator, Flyer::GovernedRegulator].map(|flyer| of(flyer, "settled").value.unwrap());
    let bound = of(Flyer::Regulator, "settled").bound.unwrap();
    assert!(bare < governed && (bound - governed).abs() < 0.01, "{bare} {governed} {bound}");
}

/// A bar compares with the faster of the two regulators, and says what it compares.
#[test]
fn settling_times_are_held_against_the_regulators() {
    let flyers = [Flyer::LaguerreMpc, Flyer::Regulator, Flyer::GovernedRegulator];
    let results = flown(plan("1 m north"), &flyers).results;
    let of = |flyer| find(&results, flyer, "settled");
    let fastest = of(Flyer::Regulator).value.unwrap().min(of(Flyer::GovernedRegulator).value.unwrap());
    let bound = of(Flyer::LaguerreMpc).bound.unwrap();
    assert!((fastest..fastest + 0.01).contains(&bound), "{bound} {fastest}");
    for result in &results {
        assert_eq!(result.passed, result.bound.map(|bound| result.value.is_some_and(|value| value <= bound)));
    }
}

/// What the geometric controller reaches on the paths: the feed-forward is right, so that errors are millimetres where the
/// rotors can follow. On the fastest circle the yaw torque saturates.
#[test]
fn the_geometric_controller_follows_paths() {
    for (name, most_cm) in [
        ("figure-eight of 6 m at 0.7 rad/s", 0.1),
        ("figure-eight of 6 m at 0.85 rad/s", 0.3),
        ("circle of 4 m at 1.2 rad/s", 0.2),
        ("circle of 4 m at 1.5 rad/s", 4.0),
    ] {
        let results = flown(plan(name), &[Flyer::Geometric]).results;
        let rms_cm = find(&results, Flyer::Geometric, "RMS").value.unwrap();
        assert!(rms_cm < most_cm, "{name}: {rms_cm}");
    }
    assert!(flown(plan("1 m north"), &[Flyer::Geometric]).results.is_empty());
}

/// What a demand that nobody foresees asks for, and where the vehicle should be.
#[test]
fn unforeseen_references_are_what_they_are_called() {
    let bare = plan("circle of 5 m at 0.5 rad/s, positions at 10 Hz");
    for (time_s, set_s) in [(7.25, 7.2), (12.3, 12.3), (19.999, 19.9)] {
        let reference = bare.reference(time_s);
        assert_eq!(reference, PositionReference::goal(reference.position_m.into(), 0.0), "positions alone");
        assert!((reference.position_m - bare.place_m(set_s)).norm() < 1e-9);
        assert!((bare.place_m(time_s).norm() - 5.0).abs() < 1e-12);
    }
    let jumping = plan("goals within 4 m that jump each second");
    let goals_m: Vec<_> =
        (0..20).map(|second| jumping.reference(f64::from(second) + 0.5).position_m).collect();
    for (second, pair) in goals_m.windows(2).enumerate() {
        assert!((pair[1] - pair[0]).norm() > 1.0, "{second}: {pair:?}");
        assert_eq!(jumping.reference(second as f64 + 0.99).position_m, pair[0]);
    }
    assert!(goals_m.iter().all(|goal_m| goal_m.xy().amax() <= 4.0 && goal_m.z.abs() <= 4.0 / 3.0));
    assert_eq!(jumping.reference(25.0).position_m.norm(), 0.0);
    let reversed = plan("2 m/s, reversed each 5 s");
    for (time_s, north_m, north_m_s) in [(3.0, 6.0, 2.0), (6.0, 8.0, -2.0), (11.0, 2.0, 2.0)] {
        let reference = reversed.reference(time_s);
        assert!((reference.position_m.x - north_m).abs() < 1e-12 && reference.velocity_m_s.x == north_m_s);
    }
}

/// What cannot be designed is reported with its reason, and keeps no bar.
#[test]
fn a_flight_that_is_refused_is_lost() {
    let mut refused = plan("1 m north").clone();
    refused.configuration.airframe.mass_kg = -1.0;
    let results = flown(&refused, &[Flyer::LaguerreMpc]).results;
    assert_eq!(results.len(), 1);
    assert_eq!((results[0].value, results[0].passed), (None, Some(false)));
    assert!(results[0].lost.as_deref().unwrap().contains("airframe.mass"), "{results:?}");
}

#[test]
fn a_track_has_a_line_per_moment() {
    let flown = flown(plan("1 m north"), &[Flyer::Regulator]);
    let track: &Track = &flown.tracks[0].1;
    let csv = track.csv();
    assert_eq!(csv.lines().count(), track.moments.len() + 1);
    let columns = csv.lines().next().unwrap().split(',').count();
    assert!(csv.lines().all(|line| line.split(',').count() == columns));
    let last: Vec<f64> =
        csv.lines().last().unwrap().split(',').map(|number| number.parse().unwrap()).collect();
    assert_eq!(last[0], 20.0);
    assert!((last[1] - 1.0).abs() < 1e-3);
}

/// What nobody can follow is left no farther, in the mean, than by hovering in the middle of it: A √(1/2 + 1/8) RMS from a figure-eight, A
/// from a circle, A √(1 + 1/8) from a tilted one, and A √(1/2 + 1/32) from an upright figure-eight. The rotors of an Iris have little room beside the
/// thrust that large leans take: it had been lost by 119 m on the smallest figure-eight.
#[test]
fn a_path_far_beyond_the_limits_is_no_worse_than_hovering() {
    let others = [AirframePreset::Iris, AirframePreset::Heavy]
        .map(|preset| plans(&Configuration::for_airframe(&preset.airframe()).unwrap()));
    let beyond = all_plans().iter().chain(others.iter().flatten());
    let mut flights = 0;
    for plan in beyond.filter(|plan| plan.row.name() == "beyond-limits") {
        let Demand::Path(path) = plan.demand else { panic!("{}", plan.name) };
        let hovering_m = match path.shape {
            Shape::FigureEight => path.size_m * 0.625_f64.sqrt(),
            Shape::Circle => path.size_m,
            Shape::TiltedCircle => path.size_m * 1.125_f64.sqrt(),
            Shape::UprightEight => path.size_m * 0.53125_f64.sqrt(),
        };
        let results = flown(plan, &[Flyer::LaguerreMpc]).results;
        let away_cm = find(&results, Flyer::LaguerreMpc, "RMS distance").value.unwrap();
        // A way that is narrowed to nearly nothing is up to 1.07 of that off, by the filter that finds its middle, and more while it begins.
        assert!(away_cm < 112.0 * hovering_m, "{}: {away_cm} cm of {hovering_m} m", plan.name);
        flights += 1;
    }
    assert_eq!(flights, 3 * 16);
}

/// A path that an airframe begins at rest, within a limit of the tilt, rad, and 20 m/s.
fn begun_at_rest(preset: AirframePreset, path: Path, tilt_rad: f64) -> Plan {
    let mut configuration = Configuration::for_airframe(&preset.airframe()).unwrap();
    configuration.reference.shaping = false;
    let limits = &mut configuration.limits;
    (limits.tilt_rad, limits.speed_horizontal_m_s) = (tilt_rad, 20.0);
    configuration.initial.position_m = path.derivative(0.0, 0).into();
    let (demand, name) = (Demand::Path(path), format!("{preset:?} {path:?}"));
    Plan { configuration, demand, name, ..plan("figure-eight of 6 m at 0.7 rad/s").clone() }
}

/// Paths that are begun at rest, with limits of 0.7 to 1.1 rad and 20 m/s, on which a plan had been lost for ever where the regulator was not: a circle
/// beyond the limits whose way was given up before it was near, with no room left to return to it, and climbs that were foreseen to take more
/// thrust than there is.
#[test]
fn wide_limits_lose_no_path_that_the_regulator_keeps() {
    use AirframePreset::{Heavy, Iris, Paper};
    for (preset, shape, size_m, rate_rad_s, tilt_rad) in [
        (Heavy, Shape::Circle, 2.22, 3.46, 0.9),
        (Iris, Shape::UprightEight, 2.04, 2.03, 1.0),
        (Iris, Shape::UprightEight, 0.54, 2.65, 1.0),
        (Iris, Shape::UprightEight, 0.19, 4.02, 0.6),
        (Paper, Shape::UprightEight, 0.522, 4.37, 0.6),
    ] {
        let plan = begun_at_rest(preset, Path { shape, size_m, rate_rad_s }, tilt_rad);
        let [ours_m, regulated_m] = [Flyer::LaguerreMpc, Flyer::Regulator].map(|flyer| {
            let track = fly(&plan, flyer).unwrap();
            rms(track.last(20.0), |moment| moment.error_m().norm())
        });
        assert!(ours_m < 1.15 * regulated_m + 0.005, "{}: {ours_m} m, regulator {regulated_m} m", plan.name);
    }
}

/// Small upright figure-eights far beyond the limits are noticed before they turn the vehicle over: some had led it 25 to 38 m away.
#[test]
fn small_and_fast_swings_lead_nobody_far_away() {
    for (size_m, rate_rad_s) in [(0.45, 5.0), (0.5, 4.37), (0.522, 4.2), (0.55, 4.6), (0.6, 4.37)] {
        let path = Path { shape: Shape::UprightEight, size_m, rate_rad_s };
        let plan = begun_at_rest(AirframePreset::Paper, path, 0.6);
        let track = fly(&plan, Flyer::LaguerreMpc).unwrap();
        let farthest_m = track.moments.iter().map(|moment| moment.error_m().norm()).fold(0.0, f64::max);
        assert!(farthest_m < 4.0, "{path:?}: {farthest_m} m");
    }
}
