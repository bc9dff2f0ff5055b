//! Flies the table of bars, to tune with:
//!
//! ```text
//! cargo run -p paper --example bars -- --only goal --kind lmpc,dlqr --set controller.position.terms=7 --csv target/tracks
//! ```

use std::collections::BTreeMap;
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use clap::Parser;
use paper::bars::{BarResult, Flyer, Optimum, Plan, flown, judged_random_flights, plans, sample_times};
use paper::shaped_flights;
use quadrotor::{Access, AirframePreset, Configuration, PARAMETERS};
use rayon::prelude::*;

/// Flies the table of bars and prints its figures.
#[derive(Parser)]
struct Arguments {
    /// Flies this airframe with its default limits and weights: paper, crazyflie, hummingbird, iris, heavy.
    #[arg(long, value_name = "NAME", default_value = "paper")]
    airframe: String,
    /// Changes a parameter of the FMU, as NAME=VALUE; can be repeated.
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// Only flights whose row or name contains one of these words, separated by semicolons.
    #[arg(long, value_delimiter = ';')]
    only: Vec<String>,
    /// Only these controllers: lmpc, ssmpc, dlqr, governed, geometric.
    #[arg(long, value_delimiter = ',')]
    kind: Vec<String>,
    /// Writes each flight as a CSV file to this folder.
    #[arg(long, value_name = "DIR")]
    csv: Option<PathBuf>,
    /// Flies so many random flights of each controller as well.
    #[arg(long, value_name = "FLIGHTS")]
    random: Option<u32>,
    /// Times the controllers as well; in a release build.
    #[arg(long)]
    time: bool,
    /// Measures the optimal flights in a file of xtask/python/optimum.py as well.
    #[arg(long, value_name = "OPTIMUM.json")]
    optimum: Option<PathBuf>,
    /// Prints only what Laguerre MPC fails.
    #[arg(long)]
    failed: bool,
    /// Lists the flights, and exits.
    #[arg(long)]
    list: bool,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    let preset = AirframePreset::ALL.into_iter().find(|preset| preset.name() == arguments.airframe);
    let airframe =
        preset.ok_or_else(|| format!("no airframe is called {:?}", arguments.airframe))?.airframe();
    let mut configuration = Configuration::for_airframe(&airframe)?;
    for setting in &arguments.set {
        set(&mut configuration, setting)?;
    }
    let flyers: Vec<Flyer> = Flyer::ALL
        .into_iter()
        .filter(|flyer| arguments.kind.is_empty() || arguments.kind.iter().any(|key| key == flyer.key()))
        .collect();
    let all = plans(&configuration);
    let mut plans = all.clone();
    plans.retain(|plan| {
        let named =
            |word: &String| plan.row.name().contains(word.as_str()) || plan.name.contains(word.as_str());
        arguments.only.is_empty() || arguments.only.iter().any(named)
    });
    if arguments.list {
        for plan in &plans {
            println!("{:14} {}", plan.row.name(), plan.name);
        }
        return Ok(());
    }
    let flights: Vec<_> = plans.par_iter().map(|plan| (plan, flown(plan, &flyers))).collect();
    let mut results = Vec::new();
    for (plan, flown) in flights {
        if let Some(folder) = &arguments.csv {
            for (flyer, track) in &flown.tracks {
                track.write_csv(folder, &plan.name, flyer.key())?;
            }
        }
        results.push(flown.results);
    }
    if let Some(count) = arguments.random {
        let flown = |flyer: &Flyer| shaped_flights(flyer.name(), &flyer.applied(&configuration), count);
        let cascades = flyers.iter().filter(|flyer| **flyer != Flyer::Geometric);
        results.push(cascades.flat_map(|flyer| judged_random_flights(&flown(flyer), flyer.name())).collect());
    }
    if arguments.time {
        results.push(sample_times(&configuration, &flyers));
    }
    for results in &results {
        print_flight(results, &flyers, arguments.failed);
    }
    if let Some(path) = &arguments.optimum {
        print_optima(&Optimum::parse(&fs::read_to_string(path)?)?, &all, arguments.csv.as_deref())?;
    }
    let lmpc = || results.iter().flatten().filter(|result| result.controller == Flyer::LaguerreMpc.name());
    let judged = lmpc().filter(|result| result.passed.is_some()).count();
    let passed = lmpc().filter(|result| result.passed == Some(true)).count();
    println!("\nLMPC keeps {passed} of {judged} bars");
    Ok(())
}

fn set(configuration: &mut Configuration, setting: &str) -> Result<(), Box<dyn Error>> {
    let (name, value) = setting.split_once('=').ok_or_else(|| format!("{setting}: must be NAME=VALUE"))?;
    let parameter = PARAMETERS
        .iter()
        .find(|parameter| parameter.name == name)
        .ok_or_else(|| format!("{name}: unknown parameter"))?;
    match parameter.access {
        Access::Real { set, .. } => set(configuration, value.parse()?),
        Access::Integer { set, .. } => set(configuration, value.parse()?),
        Access::Boolean { set, .. } => set(configuration, value.parse()?),
        Access::Enumeration { choice, set, .. } => {
            let index = choice.items.iter().position(|(item, _)| *item == value);
            let index = index.ok_or_else(|| format!("{name}: {value} is none of {:?}", choice.items))?;
            set(configuration, i32::try_from(index)? + 1);
        }
    }
    parameter.check(configuration)?;
    Ok(())
}

fn print_flight(results: &[BarResult], flyers: &[Flyer], failed: bool) {
    let mut figures: Vec<&str> = Vec::new();
    let mut cells: BTreeMap<(&str, &str), &BarResult> = BTreeMap::new();
    for result in results {
        if !figures.contains(&result.figure) {
            figures.push(result.figure);
        }
        cells.insert((result.figure, &result.controller), result);
    }
    if failed {
        let fails = |figure: &&str| {
            cells
                .get(&(*figure, Flyer::LaguerreMpc.name()))
                .is_some_and(|result| result.passed == Some(false))
        };
        figures.retain(fails);
        if figures.is_empty() {
            return;
        }
    }
    let Some(first) = results.first() else { return };
    println!("\n{}: {}", first.row, first.flight);
    let header: String = flyers.iter().map(|flyer| format!("{:>15}", flyer.name())).collect();
    println!("  {:54}{:>10}{header}", "", "bar");
    for figure in figures {
        let of = |flyer: &Flyer| cells.get(&(figure, flyer.name())).copied();
        let bound = flyers.iter().find_map(|flyer| of(flyer)?.bound);
        let row: String = flyers.iter().map(|flyer| format!("{:>15}", cell(of(flyer)))).collect();
        println!("  {figure:54}{:>10}{row}", bound.map_or(String::new(), |bound| format!("{bound:.3}")));
    }
    for lost in results.iter().filter_map(|result| Some((&result.controller, result.lost.as_ref()?))) {
        println!("  {}: {}", lost.0, lost.1);
    }
}

fn print_optima(optima: &[Optimum], plans: &[Plan], csv: Option<&Path>) -> Result<(), Box<dyn Error>> {
    for optimum in optima {
        let plan = plans.iter().find(|plan| plan.name == optimum.flight);
        let plan = plan.ok_or_else(|| format!("{}: unknown flight", optimum.flight))?;
        let (result, track) = optimum.measured(plan);
        println!("\n{result:#?}");
        if let Some(folder) = csv {
            track.write_csv(folder, &plan.name, &optimum.objective.replace(' ', "-"))?;
        }
    }
    Ok(())
}

fn cell(result: Option<&BarResult>) -> String {
    let Some(result) = result else { return String::new() };
    let value = result.value.map_or("never".to_owned(), |value| format!("{value:.3}"));
    format!("{value}{}", if result.passed == Some(false) { " !" } else { "  " })
}
