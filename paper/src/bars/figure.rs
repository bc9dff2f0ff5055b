//! The figures of a flight, and the bars that they are held against.

use quadrotor::{Airframe, Configuration};

use super::flyer::Flyer;
use super::measures::{largest, mean, rms, swing};
use super::path::START_S;
use super::plan::{Demand, Plan, Row};
use super::plans::PATH_LAST_S;
use super::track::{Moment, Track};

/// One figure of a flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figure {
    /// What it is, with its unit.
    pub name: &'static str,
    /// Its value; infinite where it was not reached.
    pub value: f64,
    /// What it is held against.
    pub bar: Bar,
}

/// What a figure may be at most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bar {
    /// It is not judged.
    None,
    /// A number.
    AtMost(f64),
    /// A number, and no more than with the clipped regulator, with or without the governor, where it breaks no limit by more
    /// than 25 %.
    NoMoreThanRegulator(f64),
    /// So many times the best of our controllers.
    TimesBest(f64),
    /// The same, or a number that is small enough whatever the best reaches.
    TimesBestOr(f64, f64),
}

const OVERSHOOT: &str = "overshoot, %";
/// Name of the settling time.
pub const SETTLED: &str = "settled within 2 cm, s";
/// Name of the figure that the optimum is compared in.
pub const SQUARED_DISTANCE: &str = "integral of the squared distance, m²·s";
/// Name of the figure that says by how much a limit was broken.
pub const EXCESS: &str = "beyond a limit, %";

/// The part of a cruise that counts: between these distances from the start, m.
const CRUISE_M: [f64; 2] = [80.0, 230.0];
/// A regulator that breaks a limit by more than this is no comparison, %.
const COMPARABLE_EXCESS: f64 = 25.0;
/// Slack of comparisons of settling times, s: half of the time between two moments.
const SLACK_S: f64 = 0.005;

fn figure(name: &'static str, value: f64, bar: Bar) -> Figure {
    Figure { name, value, bar }
}

/// The figures of a flight.
pub fn figures(plan: &Plan, track: &Track) -> Vec<Figure> {
    match (plan.row, plan.demand) {
        (Row::Cruise, Demand::Goal(goal_m)) => cruise(plan, track, goal_m),
        (Row::Goal | Row::MassGoal, Demand::Goal(goal_m)) => goal(plan, track, goal_m),
        (Row::RotorLag, Demand::Goal(goal_m)) => rotor_lag(plan, track, goal_m),
        (Row::Unforeseen, _) => unforeseen(plan, track),
        (Row::Path | Row::BeyondLimits | Row::Cruise | Row::Goal | Row::MassGoal | Row::RotorLag, _) => {
            path(plan, track)
        }
        (Row::SideForce, _) => vec![figure(
            "largest distance in the last 5 s, cm",
            100.0 * largest(track.last(5.0), distance),
            Bar::AtMost(5.0),
        )],
        (Row::Mass, _) => mass(plan, track),
        (Row::Spin, _) => spin(plan, track),
    }
}

fn distance(moment: &Moment) -> f64 {
    moment.error_m().norm()
}

fn cruise(plan: &Plan, track: &Track, goal_m: [f64; 3]) -> Vec<Figure> {
    let cruising: Vec<Moment> = track
        .moments
        .iter()
        .filter(|moment| {
            (CRUISE_M[0]..CRUISE_M[1]).contains(&moment.position_m.x) && moment.velocity_m_s.x > 0.0
        })
        .copied()
        .collect();
    let speed = |moment: &Moment| moment.velocity_m_s.xy().norm();
    let limit_m_s = plan.configuration.limits.speed_horizontal_m_s;
    vec![
        figure("swing of the speed, m/s", swing(&cruising, speed), Bar::AtMost(0.1)),
        figure(
            "swing of the pitch, °",
            swing(&cruising, |moment| moment.attitude_rad.y).to_degrees(),
            Bar::AtMost(2.0),
        ),
        figure(
            "mean speed off its limit, %",
            100.0 * (1.0 - mean(&cruising, speed) / limit_m_s).abs(),
            Bar::AtMost(5.0),
        ),
        figure(OVERSHOOT, 100.0 * track.overshoot(goal_m), Bar::AtMost(4.0)),
        figure(EXCESS, excess_percent(plan, track), Bar::AtMost(1.0)),
        figure(SETTLED, track.settled_s(), Bar::None),
    ]
}

fn excess_percent(plan: &Plan, track: &Track) -> f64 {
    100.0 * track.limit_excess(&plan.configuration.limits, &plan.configuration.airframe).max(0.0)
}

/// When a raw goal should be reached, s.
fn soon_s(goal_m: [f64; 3]) -> f64 {
    match goal_m {
        [5.0, 0.0, 0.0] => 5.5,
        [20.0, 0.0, 0.0] => 8.0,
        _ => f64::INFINITY,
    }
}

fn goal(plan: &Plan, track: &Track, goal_m: [f64; 3]) -> Vec<Figure> {
    let settled_s = soon_s(goal_m);
    vec![
        figure(OVERSHOOT, 100.0 * track.overshoot(goal_m), Bar::AtMost(4.0)),
        figure(SETTLED, track.settled_s(), Bar::NoMoreThanRegulator(settled_s)),
        figure(EXCESS, excess_percent(plan, track), Bar::AtMost(1.0)),
        figure(SQUARED_DISTANCE, track.squared_distance_m2_s(), Bar::None),
        figure("largest distance off the axes of the step, cm", 100.0 * track.off_axis_m(goal_m), Bar::None),
    ]
}

fn path(plan: &Plan, track: &Track) -> Vec<Figure> {
    let counted = track.last(PATH_LAST_S);
    let (most_rms_cm, most_cm) = match plan.demand {
        // Bounded: no farther away than twice the width of the path.
        Demand::Path(path) if plan.row == Row::BeyondLimits => {
            (Bar::TimesBest(1.1), Bar::AtMost(400.0 * path.size_m))
        }
        Demand::Path(path) => (Bar::AtMost(path.bar_cm()), Bar::None),
        _ => (Bar::None, Bar::None),
    };
    vec![
        figure("RMS distance, cm", 100.0 * rms(counted, distance), most_rms_cm),
        figure("largest distance, cm", 100.0 * largest(counted, distance), most_cm),
        figure("largest distance in the start, cm", 100.0 * largest(start(track), distance), Bar::None),
        figure("largest tilt, °", largest(counted, Moment::tilt_rad).to_degrees(), Bar::None),
    ]
}

/// Nobody who streams positions alone asks for less, cm.
const CLOSE_CM: f64 = 0.5;

fn unforeseen(plan: &Plan, track: &Track) -> Vec<Figure> {
    let counted = track.last(PATH_LAST_S);
    let mut figures = vec![
        figure("RMS distance, cm", 100.0 * rms(counted, distance), Bar::TimesBestOr(1.1, CLOSE_CM)),
        figure("largest distance, cm", 100.0 * largest(counted, distance), Bar::None),
        figure(EXCESS, excess_percent(plan, track), Bar::AtMost(1.0)),
    ];
    if matches!(plan.demand, Demand::Jumps(_)) {
        figures.push(figure(SETTLED, track.settled_s(), Bar::None));
    }
    figures
}

fn start(track: &Track) -> &[Moment] {
    let end = track.moments.partition_point(|moment| moment.time_s < START_S);
    &track.moments[..end]
}

fn mass(plan: &Plan, track: &Track) -> Vec<Figure> {
    let last = track.last(15.0);
    let noisy = plan.configuration.sensors.position_noise_m > 0.0;
    // Noise of 2 cm moves a vehicle whose mass is known by 2.5 cm.
    let most_cm = if noisy { 2.5 } else { 1.0 };
    let bob = |moment: &Moment| moment.error_m().z;
    let sway = |moment: &Moment| moment.error_m().xy().norm();
    vec![
        figure("RMS of the height's error at the end, cm", 100.0 * rms(last, bob), Bar::AtMost(most_cm)),
        figure("RMS of the horizontal error at the end, cm", 100.0 * rms(last, sway), Bar::AtMost(most_cm)),
        figure("largest distance in the last 15 s, cm", 100.0 * largest(last, distance), Bar::None),
    ]
}

fn rotor_lag(plan: &Plan, track: &Track, goal_m: [f64; 3]) -> Vec<Figure> {
    let lag = plan.configuration.airframe.rotor_time_constant_s;
    let slower = (lag / Airframe::default().rotor_time_constant_s).max(1.0);
    let last = track.last(5.0);
    let settled_s = soon_s(goal_m);
    vec![
        figure(
            "RMS torque at the end, N·m",
            rms(last, |moment| moment.torque_n_m.norm()),
            Bar::AtMost(0.005),
        ),
        figure(
            "RMS body rate at the end, rad/s",
            rms(last, |moment| moment.body_rate_rad_s.norm()),
            Bar::AtMost(0.01),
        ),
        figure(OVERSHOOT, 100.0 * track.overshoot(goal_m), Bar::AtMost(4.0)),
        // The lag is one of the times that the loop is made of: its square root scales milder than all of them together.
        figure(SETTLED, track.settled_s(), Bar::NoMoreThanRegulator(settled_s * slower.sqrt())),
        figure(EXCESS, excess_percent(plan, track), Bar::AtMost(1.0)),
    ]
}

/// Largest yaw torque that the rotors make while they carry the weight, N·m: those of one direction at the least thrust that
/// the others leave them.
fn yaw_torque_n_m(configuration: &Configuration) -> f64 {
    let airframe = &configuration.airframe;
    let (weakest, strongest) = airframe.thrust_range_n();
    let weight = airframe.weight_n();
    // Of two rotors: F₁ + F₂ = m g, τ = (k₂/k₁)(F₁ − F₂).
    let most = (strongest / 2.0).min(weight - weakest / 2.0);
    airframe.torque_coefficient_n_m_s2 / airframe.thrust_coefficient_n_s2 * (2.0 * most - weight)
}

fn spin(plan: &Plan, track: &Track) -> Vec<Figure> {
    let configuration = &plan.configuration;
    let [_, _, spin_rad_s] = configuration.initial.body_rate_rad_s;
    // J_z ṙ = τ: no vehicle in hover stops sooner.
    let least_s = configuration.airframe.inertia_kg_m2[2] * spin_rad_s / yaw_torque_n_m(configuration);
    let turning = |moment: &Moment| moment.body_rate_rad_s.z.abs() > 0.1;
    let stopped_s = match track.moments.iter().rposition(turning) {
        None => 0.0,
        Some(last) => track.moments.get(last + 1).map_or(f64::INFINITY, |moment| moment.time_s),
    };
    vec![
        figure(
            "stopped turning after, as a multiple of the least time",
            stopped_s / least_s,
            Bar::AtMost(2.0),
        ),
        figure("distance at the end, cm", 100.0 * largest(track.last(1.0), distance), Bar::AtMost(5.0)),
        figure("largest distance, m", largest(&track.moments, distance), Bar::None),
        figure("largest tilt, °", largest(&track.moments, Moment::tilt_rad).to_degrees(), Bar::None),
    ]
}

/// Whether a flight is that of a regulator that keeps its limits by and large: without limits everyone would be faster.
fn is_comparable_regulator((flyer, figures): &(Flyer, Vec<Figure>)) -> bool {
    let within = |figure: &Figure| figure.name != EXCESS || figure.value <= COMPARABLE_EXCESS;
    flyer.is_regulator() && figures.iter().all(within)
}

fn is_ours((flyer, _): &(Flyer, Vec<Figure>)) -> bool {
    *flyer != Flyer::Geometric
}

/// The figures of one flight of everyone, with the bars that compare them.
pub fn bound(figure: &Figure, others: &[(Flyer, Vec<Figure>)]) -> Option<f64> {
    let of = |compared: fn(&(Flyer, Vec<Figure>)) -> bool| {
        others
            .iter()
            .filter(|other| compared(other))
            .flat_map(|(_, figures)| figures)
            .filter(|other| other.name == figure.name)
            .map(|other| other.value)
            .fold(f64::INFINITY, f64::min)
    };
    let bound = match figure.bar {
        Bar::None => f64::INFINITY,
        Bar::AtMost(most) => most,
        Bar::NoMoreThanRegulator(most) => most.min(of(is_comparable_regulator) + SLACK_S),
        Bar::TimesBest(times) => times * of(is_ours),
        Bar::TimesBestOr(times, least) => least.max(times * of(is_ours)),
    };
    Some(bound).filter(|bound| bound.is_finite())
}
