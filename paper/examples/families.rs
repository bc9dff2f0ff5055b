//! Flies random flights that nobody has tuned for, by family, and prints how each controller did:
//!
//! ```text
//! cargo run -p paper --example families -- --only upright,small --seeds 60 --csv target/tracks
//! ```
//!
//! References are raw. The figures of a flight are those of its family: how far off its reference the vehicle was over the last 20 s
//! (RMS), how far beyond its goal and beside the straight way to it, when it settled, and how far tilt and speed left their limits.

use std::error::Error;
use std::f64::consts::TAU;
use std::path::PathBuf;

use chacha20::ChaCha8Rng;
use chacha20::rand_core::{Rng, SeedableRng};
use clap::Parser;
use nalgebra::Vector3;
use paper::NOISE;
use paper::bars::{Demand, Flyer, Moment, Path, Plan, Points, Pushes, Row, Shape, Track, fly, largest, rms};
use quadrotor::{Airframe, AirframePreset, Configuration, RotorSpin, Sensors};
use rayon::prelude::*;

/// Flies random flights by family.
#[derive(Parser)]
struct Arguments {
    /// Only these families.
    #[arg(long, value_name = "FAMILY", value_delimiter = ',', value_parser = FAMILIES.map(|family| family.name))]
    only: Vec<String>,
    /// Flights of each family.
    #[arg(long, default_value_t = 40)]
    seeds: u64,
    /// Only the flight with this seed.
    #[arg(long)]
    seed: Option<u64>,
    /// Only these controllers.
    #[arg(long, value_delimiter = ',', value_parser = FLYERS.map(Flyer::key))]
    kind: Vec<String>,
    /// Prints so many of the flights of each family in which the first controller is furthest behind the others.
    #[arg(long, default_value_t = 4)]
    worst: usize,
    /// Writes each flight as a CSV file to this folder.
    #[arg(long, value_name = "DIR")]
    csv: Option<PathBuf>,
}

/// Those who fly raw goals, too.
const FLYERS: [Flyer; 4] =
    [Flyer::LaguerreMpc, Flyer::StateSpaceMpc, Flyer::Regulator, Flyer::GovernedRegulator];

/// Uniform numbers of one flight.
struct Draw(ChaCha8Rng);

impl Draw {
    fn unit(&mut self) -> f64 {
        f64::from(self.0.next_u32()) / f64::from(u32::MAX)
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// As many small ones as large ones.
    fn scaled(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    fn one_of<T: Copy>(&mut self, all: &[T]) -> T {
        all[(self.0.next_u32() as usize) % all.len()]
    }

    /// A place at a distance, m, at most so steep.
    fn place_m(&mut self, distance_m: f64, steepest_rad: f64) -> [f64; 3] {
        let (heading, climb) = (self.between(0.0, TAU), self.between(-steepest_rad, steepest_rad));
        [
            distance_m * climb.cos() * heading.cos(),
            distance_m * climb.cos() * heading.sin(),
            -distance_m * climb.sin(),
        ]
    }
}

/// A kind of flights.
struct Family {
    name: &'static str,
    change: fn(&mut Draw, &mut Plan),
}

const FAMILIES: [Family; 23] = [
    Family { name: "goal", change: goal },
    Family { name: "wind", change: wind },
    Family { name: "low-tilt", change: low_tilt },
    Family { name: "slow-rate", change: slow_rate },
    Family { name: "slow-rotors", change: slow_rotors },
    Family { name: "path", change: |draw, plan| path(draw, plan, (1.0, 8.0), (0.4, 1.2), &LEVEL) },
    Family { name: "upright", change: |draw, plan| path(draw, plan, (0.5, 6.0), (0.5, 2.5), &CLIMBING) },
    Family { name: "small", change: |draw, plan| path(draw, plan, (0.1, 1.0), (1.5, 4.5), &ALL) },
    Family { name: "wide", change: wide },
    Family { name: "points", change: points },
    Family { name: "rounded", change: rounded },
    Family { name: "jumps", change: jumps },
    Family { name: "to-and-fro", change: to_and_fro },
    Family { name: "tilted-start", change: tilted_start },
    Family { name: "noisy-path", change: noisy_path },
    Family { name: "noisy-goal", change: noisy_goal },
    Family { name: "wrong-mass", change: wrong_mass },
    Family { name: "gusts", change: gusts },
    Family { name: "torque", change: torque },
    Family { name: "noisy-torque", change: noisy_torque },
    Family { name: "physics", change: physics },
    Family { name: "machine-goal", change: |draw, plan| machine(draw, plan, goal) },
    Family { name: "machine-path", change: |draw, plan| machine(draw, plan, slow_path) },
];

const LEVEL: [Shape; 2] = [Shape::FigureEight, Shape::Circle];
const CLIMBING: [Shape; 2] = [Shape::UprightEight, Shape::TiltedCircle];
const ALL: [Shape; 4] = [Shape::FigureEight, Shape::Circle, Shape::UprightEight, Shape::TiltedCircle];

fn goal(draw: &mut Draw, plan: &mut Plan) {
    let distance_m = draw.scaled(1.0, 200.0);
    (plan.demand, plan.duration_s) = (Demand::Goal(draw.place_m(distance_m, 1.0)), 20.0 + distance_m / 1.5);
    let limits = &mut plan.configuration.limits;
    limits.speed_horizontal_m_s *= draw.scaled(0.3, 1.5);
}

fn wind(draw: &mut Draw, plan: &mut Plan) {
    let distance_m = draw.scaled(1.0, 60.0);
    (plan.demand, plan.duration_s) = (Demand::Goal(draw.place_m(distance_m, 0.7)), 30.0 + distance_m);
    let share = draw.between(0.05, 0.25) * plan.configuration.airframe.weight_n();
    plan.force_n = draw.place_m(share, 0.3);
}

fn low_tilt(draw: &mut Draw, plan: &mut Plan) {
    goal(draw, plan);
    plan.configuration.limits.tilt_rad = draw.between(8.0, 20.0).to_radians();
    let most_m_s2 = 0.9 * quadrotor::GRAVITY_M_S2 * quadrotor::commanded_tilt_rad(&plan.configuration).tan();
    let limits = &mut plan.configuration.limits;
    limits.acceleration_horizontal_m_s2 = limits.acceleration_horizontal_m_s2.min(most_m_s2);
}

fn slow_rate(draw: &mut Draw, plan: &mut Plan) {
    goal(draw, plan);
    plan.configuration.limits.tilt_rate_rad_s = draw.scaled(0.4, 2.0);
}

fn slow_rotors(draw: &mut Draw, plan: &mut Plan) {
    goal(draw, plan);
    plan.configuration.airframe.rotor_time_constant_s = draw.scaled(0.03, 0.12);
}

fn path(draw: &mut Draw, plan: &mut Plan, size_m: (f64, f64), rate_rad_s: (f64, f64), shapes: &[Shape]) {
    let path = Path {
        shape: draw.one_of(shapes),
        size_m: draw.scaled(size_m.0, size_m.1),
        rate_rad_s: draw.between(rate_rad_s.0, rate_rad_s.1),
    };
    plan.configuration.initial.position_m = path.derivative(0.0, 0).into();
    (plan.demand, plan.duration_s) = (Demand::Path(path), 30.0);
}

/// Paths under limits that are wider than what most of the airframes can fly.
fn wide(draw: &mut Draw, plan: &mut Plan) {
    path(draw, plan, (0.5, 10.0), (0.7, 3.5), &ALL);
    let limits = &mut plan.configuration.limits;
    (limits.tilt_rad, limits.speed_horizontal_m_s) = (draw.between(0.7, 1.1), 20.0);
}

fn points(draw: &mut Draw, plan: &mut Plan) {
    path(draw, plan, (0.5, 6.0), (0.3, 1.5), &ALL);
    let Demand::Path(path) = plan.demand else { return };
    let derivatives = draw.one_of(&[0, 1, 2]);
    let each_s = draw.one_of(&[0.02, 0.05, 0.1]);
    plan.demand = Demand::Points(Points { path, derivatives, each_s, rounded_to: 0.0 });
}

/// Positions that are rounded to 0.1 mm to 1 cm.
fn rounded(draw: &mut Draw, plan: &mut Plan) {
    path(draw, plan, (0.5, 6.0), (0.2, 1.0), &ALL);
    let Demand::Path(path) = plan.demand else { return };
    let derivatives = draw.one_of(&[0, 0, 1]);
    let each_s = draw.one_of(&[0.02, 0.05, 0.1]);
    plan.demand = Demand::Points(Points { path, derivatives, each_s, rounded_to: draw.scaled(1e-4, 1e-2) });
}

fn jumps(draw: &mut Draw, plan: &mut Plan) {
    (plan.demand, plan.duration_s) = (Demand::Jumps(draw.scaled(1.0, 40.0)), 45.0);
}

fn to_and_fro(draw: &mut Draw, plan: &mut Plan) {
    (plan.demand, plan.duration_s) = (Demand::ToAndFro(draw.scaled(0.5, 9.0)), 40.0);
}

fn tilted_start(draw: &mut Draw, plan: &mut Plan) {
    let distance_m = draw.scaled(0.5, 20.0);
    (plan.demand, plan.duration_s) = (Demand::Goal(draw.place_m(distance_m, 0.5)), 30.0);
    let initial = &mut plan.configuration.initial;
    initial.attitude_rad = [draw.between(-0.5, 0.5), draw.between(-0.5, 0.5), draw.between(-3.0, 3.0)];
    initial.velocity_m_s = draw.place_m(1.0, 1.0).map(|value| 2.0 * value);
}

fn noisy_path(draw: &mut Draw, plan: &mut Plan) {
    path(draw, plan, (0.5, 6.0), (0.3, 1.2), &ALL);
    noisy(draw, plan);
}

fn noisy_goal(draw: &mut Draw, plan: &mut Plan) {
    goal(draw, plan);
    noisy(draw, plan);
}

/// Noise of a good to a bad receiver and inertial unit, with all states measured or outputs alone.
fn noisy(draw: &mut Draw, plan: &mut Plan) {
    let size = draw.scaled(0.1, 1.5);
    let [position_noise_m, velocity_noise_m_s, attitude_noise_rad, body_rate_noise_rad_s] =
        NOISE.map(|deviation| deviation * size);
    plan.configuration.sensors = Sensors {
        output_feedback: draw.one_of(&[false, true]),
        position_noise_m,
        velocity_noise_m_s,
        attitude_noise_rad,
        body_rate_noise_rad_s,
        seed: draw.0.next_u32() % 1000,
    };
}

fn wrong_mass(draw: &mut Draw, plan: &mut Plan) {
    match draw.one_of(&[false, true]) {
        true => path(draw, plan, (0.5, 6.0), (0.3, 1.0), &ALL),
        false => goal(draw, plan),
    }
    plan.configuration.controllers.mass_factor = draw.scaled(0.6, 1.4);
}

fn slow_path(draw: &mut Draw, plan: &mut Plan) {
    path(draw, plan, (0.5, 6.0), (0.3, 1.0), &ALL);
}

/// Forces that swing in their own time, up to 0.6 of the weight in all along each axis.
fn gusts(draw: &mut Draw, plan: &mut Plan) {
    slow_path(draw, plan);
    plan.pushes.gust_n = draw.scaled(0.008, 0.12) * plan.configuration.airframe.weight_n();
}

/// A torque that comes and goes, of up to 0.12 of the weight on the end of an arm.
fn torque(draw: &mut Draw, plan: &mut Plan) {
    slow_path(draw, plan);
    let airframe = &plan.configuration.airframe;
    let most_n_m = draw.scaled(0.01, 0.12) * airframe.weight_n() * airframe.arm_length_m;
    let heading = draw.between(0.0, TAU);
    let yaw_n_m = 0.1 * most_n_m * draw.between(-1.0, 1.0);
    plan.pushes.torque_n_m = [most_n_m * heading.cos(), most_n_m * heading.sin(), yaw_n_m];
}

fn noisy_torque(draw: &mut Draw, plan: &mut Plan) {
    torque(draw, plan);
    noisy(draw, plan);
}

/// Physics that the controllers do not know.
fn physics(draw: &mut Draw, plan: &mut Plan) {
    slow_path(draw, plan);
    let airframe = &mut plan.configuration.airframe;
    let (mass_kg, hover_rad_s) = (airframe.mass_kg, airframe.hover_rotor_speed_rad_s());
    let aerodynamics = &mut airframe.rotor_aerodynamics;
    aerodynamics.drag_coefficient_n_s2_m = draw.between(0.0, 0.05) * mass_kg / hover_rad_s;
    aerodynamics.inflow_coefficient_n_s2_m = draw.between(0.0, 0.1) * mass_kg / hover_rad_s;
    aerodynamics.translational_lift_coefficient_n_s2_m2 = draw.between(0.0, 0.005) * mass_kg;
    airframe.body_drag_n_s_m = [0.03, 0.05, 0.1].map(|drag_1_s| drag_1_s * mass_kg);
    airframe.rotor_spin.fall_time_ratio = draw.between(1.0, 2.0);
    airframe.rotor_spin.inertia_kg_m2 =
        draw.between(0.0, 0.01) * airframe.torque_coefficient_n_m_s2 * hover_rad_s;
}

/// Something else on another machine: of half to twice the size, with moments of inertia, rotors and drag of its own, and out of balance.
fn machine(draw: &mut Draw, plan: &mut Plan, fly: fn(&mut Draw, &mut Plan)) {
    let preset = plan.configuration.airframe;
    let configuration = loop {
        if let Ok(configuration) = Configuration::for_airframe(&of_another_size(draw, &preset)) {
            break configuration;
        }
    };
    plan.configuration = configuration;
    plan.configuration.reference.shaping = false;
    fly(draw, plan);
}

fn of_another_size(draw: &mut Draw, preset: &Airframe) -> Airframe {
    let size = draw.scaled(0.5, 2.0);
    let heavier = size.powi(3) * draw.scaled(0.7, 1.4);
    let (arm_length_m, mass_kg) = (preset.arm_length_m * size, preset.mass_kg * heavier);
    let spread = draw.scaled(0.6, 1.6);
    let inertia_kg_m2 = preset.inertia_kg_m2.map(|inertia| inertia * heavier * size * size * spread);
    Airframe {
        mass_kg,
        arm_length_m,
        inertia_kg_m2,
        products_of_inertia_kg_m2: [(); 3].map(|()| draw.between(-0.02, 0.02) * inertia_kg_m2[0]),
        centre_of_gravity_m: [(); 3].map(|()| draw.between(-0.02, 0.02) * arm_length_m),
        thrust_coefficient_n_s2: preset.thrust_coefficient_n_s2 * heavier * draw.scaled(0.7, 1.6),
        torque_coefficient_n_m_s2: preset.torque_coefficient_n_m_s2 * heavier * size * draw.scaled(0.7, 1.6),
        rotor_time_constant_s: preset.rotor_time_constant_s * draw.scaled(0.5, 1.8),
        rotor_spin: RotorSpin { fall_time_ratio: draw.between(1.0, 2.0), ..preset.rotor_spin },
        drag_n_s_m: [(); 3].map(|()| draw.between(0.0, 0.05) * mass_kg),
        ..*preset
    }
}

/// Numbers of a flight, the smaller the better.
const FIGURES: [&str; 7] =
    ["off, m", "beyond, m", "aside, m", "settled, s", "tilt, °", "speed, share", "vertical, share"];

/// Those of a flight.
fn figures(plan: &Plan, track: &Track) -> [f64; FIGURES.len()] {
    let limits = &plan.configuration.limits;
    let most = |value: &dyn Fn(&Moment) -> f64| largest(&track.moments, value).max(0.0);
    let [beyond_m, aside_m] = match plan.demand {
        Demand::Goal(goal_m) => beside_the_way(track, &Vector3::from(goal_m)),
        _ => [0.0; 2],
    };
    // A reference that is too fast is another's plan.
    let fastest_m_s = match plan.demand {
        Demand::Path(_) | Demand::Points(..) | Demand::ToAndFro(_) => fastest_reference_m_s(track),
        _ => 0.0,
    };
    let speed_m_s = limits.speed_horizontal_m_s.max(fastest_m_s);
    [
        rms(track.last(20.0), |moment| moment.error_m().norm()),
        beyond_m,
        aside_m,
        track.settled_s().min(999.0),
        most(&|moment| moment.tilt_rad() - limits.tilt_rad).to_degrees(),
        most(&|moment| moment.velocity_m_s.xy().norm()) / speed_m_s,
        most(&|moment| {
            (-moment.velocity_m_s.z / limits.speed_up_m_s).max(moment.velocity_m_s.z / limits.speed_down_m_s)
        }),
    ]
}

/// How far beyond a goal, m, and how far beside the level way to it from the origin.
fn beside_the_way(track: &Track, goal_m: &Vector3<f64>) -> [f64; 2] {
    let towards = goal_m.normalize();
    let way = goal_m.xy().try_normalize(1e-9).unwrap_or_default();
    let aside_m = |moment: &Moment| {
        let place_m = moment.position_m.xy();
        (place_m - way * way.dot(&place_m)).norm()
    };
    let beyond_m = largest(&track.moments, |moment| towards.dot(&(moment.position_m - goal_m)));
    [beyond_m.max(0.0), largest(&track.moments, aside_m)]
}

/// The largest horizontal speed of what was asked for, m/s.
fn fastest_reference_m_s(track: &Track) -> f64 {
    let speeds_m_s = track.moments.windows(2).map(|pair| {
        let moved = pair[1].reference_m - pair[0].reference_m;
        moved.xy().norm() / (pair[1].time_s - pair[0].time_s)
    });
    speeds_m_s.fold(0.0, f64::max)
}

/// The flight of a family with a seed, on any of the airframes.
fn plan(family: &Family, seed: u64) -> Result<Plan, Box<dyn Error + Send + Sync>> {
    let mut draw = Draw(ChaCha8Rng::seed_from_u64(seed));
    let preset = draw.one_of(&AirframePreset::ALL);
    let mut configuration = Configuration::for_airframe(&preset.airframe())?;
    configuration.reference.shaping = false;
    let mut plan = Plan {
        row: Row::Unforeseen,
        name: format!("{} {seed} {}", family.name, preset.name()),
        configuration,
        demand: Demand::Goal([0.0; 3]),
        force_n: [0.0; 3],
        pushes: Pushes::default(),
        duration_s: 0.0,
    };
    (family.change)(&mut draw, &mut plan);
    Ok(plan)
}

fn main() -> Result<(), Box<dyn Error + Send + Sync>> {
    let arguments = Arguments::parse();
    let flyers: Vec<Flyer> = FLYERS
        .into_iter()
        .filter(|flyer| arguments.kind.is_empty() || arguments.kind.iter().any(|key| key == flyer.key()))
        .collect();
    let chosen =
        |family: &&Family| arguments.only.is_empty() || arguments.only.iter().any(|name| name == family.name);
    for family in FAMILIES.iter().filter(chosen) {
        let seeds: Vec<u64> =
            arguments.seed.map_or_else(|| (0..arguments.seeds).collect(), |seed| vec![seed]);
        let flights: Vec<Flight> = seeds
            .par_iter()
            .map(|seed| flight(plan(family, *seed)?, &flyers, arguments.csv.as_deref()))
            .collect::<Result<_, _>>()?;
        print_family(family, &flyers, &flights);
        print_worst(&flights, &flyers, arguments.worst);
    }
    Ok(())
}

/// What was flown, and the figures of each flyer.
type Flight = (Plan, Vec<[f64; FIGURES.len()]>);

/// Flies a plan with each flyer; a flight that was lost is infinitely bad.
fn flight(
    plan: Plan,
    flyers: &[Flyer],
    csv: Option<&std::path::Path>,
) -> Result<Flight, Box<dyn Error + Send + Sync>> {
    let mut all = Vec::new();
    for flyer in flyers {
        let Ok(track) = fly(&plan, *flyer) else {
            all.push([f64::INFINITY; FIGURES.len()]);
            continue;
        };
        if let Some(folder) = csv {
            track.write_csv(folder, &plan.name, flyer.key())?;
        }
        all.push(figures(&plan, &track));
    }
    Ok((plan, all))
}

fn print_family(family: &Family, flyers: &[Flyer], flights: &[Flight]) {
    println!("\n{}: median, 90 %, worst of {}", family.name, flights.len());
    let header: String = flyers.iter().map(|flyer| format!("{:>30}", flyer.name())).collect();
    println!("{:14}{header}", "");
    for (at, figure) in FIGURES.iter().enumerate() {
        let cells = (0..flyers.len()).map(|flyer| {
            let mut values: Vec<f64> = flights.iter().map(|(_, figures)| figures[flyer][at]).collect();
            values.sort_by(f64::total_cmp);
            let place = |share: f64| values[((values.len() - 1) as f64 * share).round() as usize];
            format!("{:>12.3}{:>9.3}{:>9.3}", place(0.5), place(0.9), place(1.0))
        });
        println!("  {figure:12}{}", cells.collect::<String>());
    }
}

/// Those in which the first flyer is furthest behind the best of the others.
fn print_worst(flights: &[Flight], flyers: &[Flyer], count: usize) {
    if flyers.len() < 2 {
        return;
    }
    let behind = |figures: &[[f64; FIGURES.len()]]| {
        let best_m = figures[1..].iter().map(|figures| figures[0]).fold(f64::INFINITY, f64::min);
        figures[0][0] / best_m.max(0.02)
    };
    let mut order: Vec<_> = flights.iter().collect();
    order.sort_by(|one, other| behind(&other.1).total_cmp(&behind(&one.1)));
    for (plan, figures) in order.into_iter().take(count) {
        println!("  {}: {:?}", plan.name, plan.demand);
        for (flyer, figures) in flyers.iter().zip(figures) {
            let cells: String = figures.iter().map(|value| format!("{value:10.3}")).collect();
            println!("    {:16}{cells}", flyer.name());
        }
    }
}
