//! An FMU of FMI 2.0 for co-simulation, called as an importer in C calls it.

use std::fs;
use std::path::Path;

use importer::{Fmu, Instance};
use serde::Serialize;

use crate::Failure;
use crate::median::median;
use crate::stopwatch::Stopwatch;

/// Communication step, s.
const STEP_S: f64 = 1e-3;
/// Instances by which memory is measured.
const INSTANCES: usize = 40;

/// Times are medians of repetitions, each over many steps.
#[derive(Serialize)]
pub struct Figures {
    step_s: f64,
    steps: u32,
    outputs: usize,
    /// ns per step.
    step_ns: f64,
    /// ns per step after which the outputs are read.
    step_and_outputs_ns: f64,
    /// ns to instantiate and initialize, with the file unpacked and the library loaded.
    initialize_ns: f64,
    /// Bytes by which the process grows with an instance.
    memory_bytes: Option<f64>,
}

/// Measures an FMU of which some outputs are read.
///
/// # Errors
/// When it cannot be loaded, or a call fails.
pub fn measure(file: &Path, outputs: &[String], quick: bool) -> Result<Figures, Failure> {
    let fmu = Fmu::open(file)?;
    let references = outputs
        .iter()
        .map(|name| {
            let variable = fmu.description().variable(name);
            Ok(variable.ok_or_else(|| format!("{} has no variable {name}", file.display()))?.reference)
        })
        .collect::<Result<Vec<u32>, Failure>>()?;
    let repetitions = if quick { 5 } else { 11 };
    let steps = if quick { 2_000 } else { 20_000 };
    // The library stays loaded as long as this one lives.
    let first = initialized(&fmu)?;
    let watch = Stopwatch::calibrated();
    let mut made = Vec::new();
    for _ in 0..repetitions {
        let mut instance = Ok(None);
        made.push(watch.time(|| instance = initialized(&fmu).map(Some)));
        drop(instance?);
    }
    let memory_bytes = memory(&fmu)?;
    let mut stepped = Vec::new();
    let mut read = Vec::new();
    for _ in 0..repetitions {
        stepped.push(stepping(&fmu, steps, &[])?);
        read.push(stepping(&fmu, steps, &references)?);
    }
    drop(first);
    Ok(Figures {
        step_s: STEP_S,
        steps,
        outputs: outputs.len(),
        step_ns: median(stepped),
        step_and_outputs_ns: median(read),
        initialize_ns: median(made),
        memory_bytes,
    })
}

fn initialized(fmu: &Fmu) -> Result<Instance, Failure> {
    let mut instance = fmu.instantiate("bench", |_| {})?;
    instance.set_up(0.0, None)?;
    instance.enter_initialization()?;
    instance.exit_initialization()?;
    Ok(instance)
}

/// ns per step.
fn stepping(fmu: &Fmu, steps: u32, references: &[u32]) -> Result<f64, Failure> {
    let mut instance = initialized(fmu)?;
    let mut values = vec![0.0; references.len()];
    let mut stepped = Ok(());
    let taken_ns = Stopwatch::free().time(|| {
        stepped = (0..steps).try_for_each(|step| {
            instance.step(f64::from(step) * STEP_S, STEP_S)?;
            instance.reals(references, &mut values)
        });
    });
    stepped?;
    Ok(taken_ns / f64::from(steps))
}

/// Bytes per instance by the resident memory of this process; `None` where that cannot be read.
fn memory(fmu: &Fmu) -> Result<Option<f64>, Failure> {
    let before = resident();
    let instances = (0..INSTANCES).map(|_| initialized(fmu)).collect::<Result<Vec<_>, _>>()?;
    let grown = resident().zip(before).map(|(after, before)| (after - before) / INSTANCES as f64);
    drop(instances);
    Ok(grown)
}

fn resident() -> Option<f64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    Some(line.split_whitespace().next()?.parse::<f64>().ok()? * 1024.0)
}
