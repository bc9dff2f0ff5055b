//! All flights of the table of bars.

use std::f64::consts::PI;

use quadrotor::{Airframe, Configuration, GRAVITY_M_S2, Limits, Sensors, commanded_tilt_rad};

use super::path::{Path, START_S, Shape};
use super::plan::{Demand, Plan, Points, Pushes, Row};

/// Raw goals: name, place in NED, m, and how long the flight is, s.
const GOALS: [(&str, [f64; 3], f64); 11] = [
    ("1 m north", [1.0, 0.0, 0.0], 20.0),
    ("5 m north", [5.0, 0.0, 0.0], 25.0),
    ("20 m north", [20.0, 0.0, 0.0], 30.0),
    ("100 m north", [100.0, 0.0, 0.0], 40.0),
    ("5 m up", [0.0, 0.0, -5.0], 25.0),
    ("5 m down", [0.0, 0.0, 5.0], 25.0),
    ("20 m up", [0.0, 0.0, -20.0], 30.0),
    ("20 m down", [0.0, 0.0, 20.0], 30.0),
    ("5 m north, 5 m east, 5 m up", [5.0, 5.0, -5.0], 25.0),
    ("20 m north, 20 m east, 10 m down", [20.0, 20.0, 10.0], 30.0),
    ("3 m south, 7 m east, 10 m up", [-3.0, 7.0, -10.0], 30.0),
];
/// Paths within wide limits.
const PATHS: [(Shape, f64, f64); 4] = [
    (Shape::FigureEight, 6.0, 0.7),
    (Shape::FigureEight, 6.0, 0.85),
    (Shape::Circle, 4.0, 1.2),
    (Shape::Circle, 4.0, 1.5),
];
/// Paths beyond limits of 1 rad and 20 m/s.
const STEEP_PATHS: [(Shape, f64, f64); 5] = [
    (Shape::FigureEight, 8.0, 1.0),
    (Shape::FigureEight, 8.0, 1.6),
    (Shape::FigureEight, 5.0, 2.0),
    (Shape::FigureEight, 1.0, 3.3),
    (Shape::Circle, 8.0, 1.6),
];
/// Paths beyond the default limits, and the first within them by 2°. Those that climb need more thrust, or less, than there is.
const FAST_PATHS: [(Shape, f64, f64); 9] = [
    (Shape::FigureEight, 6.0, 0.7),
    (Shape::FigureEight, 6.0, 0.85),
    (Shape::FigureEight, 6.0, 1.2),
    (Shape::FigureEight, 3.0, 1.2),
    (Shape::FigureEight, 3.0, 2.0),
    (Shape::Circle, 4.0, 1.5),
    (Shape::TiltedCircle, 3.0, 1.5),
    (Shape::UprightEight, 4.0, 1.2),
    (Shape::UprightEight, 4.0, 2.0),
];
/// Paths that a steady force takes beyond the default limits.
const PUSHED_PATHS: [(Shape, f64, f64); 2] = [(Shape::FigureEight, 6.0, 0.6), (Shape::Circle, 4.0, 1.1)];
/// The force against them, N.
const PUSH_N: f64 = 2.0;
/// Paths of which positions alone are given.
const BARE_PATHS: [(Shape, f64, f64); 3] =
    [(Shape::Circle, 5.0, 0.5), (Shape::Circle, 4.0, 1.0), (Shape::FigureEight, 6.0, 0.5)];
/// The last digit of a degree with seven decimals, as MAVLink has them, m.
const DEGREES_M: f64 = 0.011;
/// How far away goals are that jump each second, m.
const JUMPS_M: [f64; 2] = [4.0, 30.0];
/// Speeds that are reversed, m/s.
const REVERSED_M_S: [f64; 3] = [2.0, 5.0, 7.5];
/// The last seconds of a path, over which its error counts.
pub const PATH_LAST_S: f64 = 20.0;
/// Time on a path between its start and the part that counts, s.
const PATH_SETTLING_S: f64 = 5.0;
/// The force against a cruise of the paper's airframe, N.
const HEADWIND_N: f64 = 1.0;
/// Side forces as shares of the weight, with the limit of tilt, rad.
const SIDE_FORCES: [(f64, f64); 2] = [(0.5, 0.6), (0.6, 0.7)];
/// Mass that the controllers believe in over the true one.
const MASS_FACTORS: [f64; 4] = [0.5, 0.75, 1.25, 1.5];
/// Those under which raw goals are flown.
const GOAL_MASS_FACTORS: [f64; 2] = [0.5, 1.5];
/// Raw goals under a wrong mass, by their index.
const MASS_GOALS: [usize; 4] = [1, 5, 6, 9];
/// Raw goals with slow rotors, by their index.
const LAGGED_GOALS: [usize; 5] = [1, 2, 4, 5, 8];
/// Rotor time constants, s.
const ROTOR_LAGS_S: [f64; 4] = [0.02, 0.05, 0.1, 0.15];
/// Spins about the thrust axis, rad/s.
const SPINS_RAD_S: [f64; 4] = [5.0, 10.0, 15.0, 20.0];
/// Noise of a vehicle that measures position and attitude only, m, rad.
const OUTPUT_NOISE: (f64, f64) = (0.02, 0.005);

/// All flights for a configuration, whose limits hold where a flight does not change them.
pub fn plans(configuration: &Configuration) -> Vec<Plan> {
    let mut base = *configuration;
    base.reference.shaping = false;
    let mut plans = cruises(&base);
    plans.extend(goals(&base));
    plans.extend(paths(&base));
    plans.extend(beyond_limits(&base));
    plans.extend(side_forces(&base));
    plans.extend(masses(&base));
    plans.extend(mass_goals(&base));
    plans.extend(rotor_lags(&base));
    plans.extend(spins(&base));
    plans.extend(unforeseen(&base));
    plans
}

fn plan(
    row: Row,
    name: impl Into<String>,
    configuration: &Configuration,
    demand: Demand,
    duration_s: f64,
) -> Plan {
    Plan {
        row,
        name: name.into(),
        configuration: *configuration,
        demand,
        force_n: [0.0; 3],
        pushes: Pushes::default(),
        duration_s,
    }
}

fn cruises(base: &Configuration) -> Vec<Plan> {
    let goal = Demand::Goal([300.0, 0.0, 0.0]);
    let calm = plan(Row::Cruise, "300 m, calm", base, goal, 60.0);
    // The same share of the weight for each airframe, to a millinewton.
    let share = base.airframe.weight_n() / Airframe::default().weight_n();
    let force_n = (1e3 * HEADWIND_N * share).round() / 1e3;
    let against =
        Plan { name: format!("300 m against {force_n} N"), force_n: [-force_n, 0.0, 0.0], ..calm.clone() };
    vec![calm, against]
}

fn goals(base: &Configuration) -> Vec<Plan> {
    GOALS
        .into_iter()
        .map(|(name, goal_m, duration_s)| plan(Row::Goal, name, base, Demand::Goal(goal_m), duration_s))
        .collect()
}

/// A flight along a path, from rest at its beginning.
fn on_path(row: Row, name: String, base: &Configuration, path: Path) -> Plan {
    let mut configuration = *base;
    configuration.initial.position_m = path.derivative(0.0, 0).into();
    plan(row, name, &configuration, Demand::Path(path), START_S + PATH_SETTLING_S + PATH_LAST_S)
}

fn path_name(path: &Path) -> String {
    let shape = match path.shape {
        Shape::FigureEight => "figure-eight",
        Shape::Circle => "circle",
        Shape::TiltedCircle => "tilted circle",
        Shape::UprightEight => "upright figure-eight",
    };
    format!("{shape} of {} m at {} rad/s", path.size_m, path.rate_rad_s)
}

/// A configuration with limits that no path within the rotors' thrust reaches, except for tilt and speed.
fn wide(base: &Configuration, tilt_rad: f64, speed_horizontal_m_s: f64) -> Configuration {
    let limits = Limits {
        tilt_rad,
        tilt_rate_rad_s: 20.0,
        // Close to half of what the rotors give in hover, above which it is refused.
        tilt_acceleration_rad_s2: 2.0 * base.limits.tilt_acceleration_rad_s2,
        thrust_min: 0.1,
        thrust_max: 10.0,
        speed_horizontal_m_s,
        speed_up_m_s: 20.0,
        speed_down_m_s: 20.0,
        jerk_horizontal_m_s3: 100.0,
        jerk_vertical_m_s3: 100.0,
        ..base.limits
    };
    let mut configuration = Configuration { limits, ..*base };
    // More than the tilt gives would be refused.
    configuration.limits.acceleration_horizontal_m_s2 =
        (0.9 * GRAVITY_M_S2 * commanded_tilt_rad(&configuration).tan()).min(20.0);
    configuration
}

fn paths(base: &Configuration) -> Vec<Plan> {
    let wide = wide(base, 1.2, 20.0);
    PATHS
        .into_iter()
        .map(|(shape, size_m, rate_rad_s)| {
            let path = Path { shape, size_m, rate_rad_s };
            on_path(Row::Path, path_name(&path), &wide, path)
        })
        .collect()
}

fn beyond_limits(base: &Configuration) -> Vec<Plan> {
    let flight = |what: &str, configuration: &Configuration, (shape, size_m, rate_rad_s)| {
        let path = Path { shape, size_m, rate_rad_s };
        on_path(Row::BeyondLimits, format!("{}, {what}", path_name(&path)), configuration, path)
    };
    let steep = wide(base, 1.0, 20.0);
    let pushed = format!("default limits, against {PUSH_N} N");
    let push = |plan: Plan| Plan { force_n: [-PUSH_N, 0.0, 0.0], ..plan };
    let mut plans = Vec::new();
    plans.extend(STEEP_PATHS.map(|path| flight("tilt 1.0 rad, speed 20 m/s", &steep, path)));
    plans.extend(FAST_PATHS.map(|path| flight("default limits", base, path)));
    plans.extend(PUSHED_PATHS.map(|path| push(flight(&pushed, base, path))));
    plans
}

fn side_forces(base: &Configuration) -> Vec<Plan> {
    SIDE_FORCES
        .into_iter()
        .map(|(share, tilt_rad)| {
            let mut configuration = *base;
            configuration.limits.tilt_rad = tilt_rad;
            let name = format!("east by {share} of the weight, tilt {tilt_rad} rad");
            let hold = plan(Row::SideForce, name, &configuration, Demand::Goal([0.0; 3]), 30.0);
            Plan { force_n: [0.0, share * base.airframe.weight_n(), 0.0], ..hold }
        })
        .collect()
}

fn masses(base: &Configuration) -> Vec<Plan> {
    let (position_noise_m, attitude_noise_rad) = OUTPUT_NOISE;
    let noisy = Sensors { output_feedback: true, position_noise_m, attitude_noise_rad, ..Sensors::default() };
    let measurements = [
        ("full state", Sensors::default()),
        ("outputs", Sensors { output_feedback: true, ..Sensors::default() }),
        ("noisy outputs", noisy),
    ];
    let mut plans = Vec::new();
    for (what, sensors) in measurements {
        for factor in MASS_FACTORS {
            let mut configuration = Configuration { sensors, ..*base };
            configuration.controllers.mass_factor = factor;
            let name = format!("mass believed {factor} of the true one, {what}");
            plans.push(plan(Row::Mass, name, &configuration, Demand::Goal([2.0, 0.0, -2.0]), 50.0));
        }
    }
    plans
}

fn mass_goals(base: &Configuration) -> Vec<Plan> {
    let mut plans = Vec::new();
    for factor in GOAL_MASS_FACTORS {
        let mut configuration = *base;
        configuration.controllers.mass_factor = factor;
        for (name, goal_m, duration_s) in MASS_GOALS.map(|index| GOALS[index]) {
            let name = format!("{name}, mass believed {factor} of the true one");
            plans.push(plan(Row::MassGoal, name, &configuration, Demand::Goal(goal_m), duration_s));
        }
    }
    plans
}

fn rotor_lags(base: &Configuration) -> Vec<Plan> {
    let mut plans = Vec::new();
    for lag_s in ROTOR_LAGS_S {
        let mut configuration = *base;
        configuration.airframe.rotor_time_constant_s = lag_s;
        for (name, goal_m, duration_s) in LAGGED_GOALS.map(|index| GOALS[index]) {
            let name = format!("{name}, rotor lag {lag_s} s");
            plans.push(plan(Row::RotorLag, name, &configuration, Demand::Goal(goal_m), duration_s));
        }
    }
    plans
}

fn spins(base: &Configuration) -> Vec<Plan> {
    SPINS_RAD_S
        .into_iter()
        .map(|spin_rad_s| {
            let mut configuration = *base;
            configuration.initial.body_rate_rad_s = [0.0, 0.0, spin_rad_s];
            // A spin that begins upright could not tell whether tilt is controlled.
            configuration.initial.attitude_rad = [PI / 36.0, 0.0, 0.0];
            plan(
                Row::Spin,
                format!("spin of {spin_rad_s} rad/s"),
                &configuration,
                Demand::Goal([0.0; 3]),
                90.0,
            )
        })
        .collect()
}

fn unforeseen(base: &Configuration) -> Vec<Plan> {
    let mut plans = Vec::new();
    for reach_m in JUMPS_M {
        let name = format!("goals within {reach_m} m that jump each second");
        plans.push(plan(Row::Unforeseen, name, base, Demand::Jumps(reach_m), 30.0));
    }
    for (shape, size_m, rate_rad_s) in BARE_PATHS {
        let path = Path { shape, size_m, rate_rad_s };
        for (rounded, rounded_to) in [("", 0.0), (" rounded to 1.1 cm", DEGREES_M)] {
            let name = format!("{}, positions{rounded} at 10 Hz", path_name(&path));
            let whole = on_path(Row::Unforeseen, name, base, path);
            let points = Points { path, derivatives: 0, each_s: 0.1, rounded_to };
            plans.push(Plan { demand: Demand::Points(points), ..whole });
        }
    }
    for speed_m_s in REVERSED_M_S {
        let name = format!("{speed_m_s} m/s, reversed each 5 s");
        plans.push(plan(Row::Unforeseen, name, base, Demand::ToAndFro(speed_m_s), 30.0));
    }
    plans
}
