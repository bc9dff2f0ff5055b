//! `cargo xtask microcontroller`: the controllers of the cascade in single precision on an emulated Cortex-M4F.
//!
//! ```text
//! bench recording ─► controllers with flights ─► firmware ─► qemu-system-arm ─► instructions, memory, commands
//! ```

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::bench;
use crate::program::{self, Beside};
use crate::progress::Progress;
use crate::toolchains::{Compiler, Need, SystemEmulator, provide};
use xtask::cargo::cargo;
use xtask::failure::Failure;
use xtask::files;
use xtask::process;
use xtask::workspace::Workspace;

/// What the firmware is built for.
const TARGET: &str = "thumbv7em-none-eabihf";
/// The machine that is emulated: a Cortex-M4 with floating-point unit.
const MACHINE: &str = "mps2-an386";
/// The processor whose load is told, Hz.
const CLOCK_HZ: f64 = 168e6;
/// Cycles that an instruction is taken to last: one in registers, two to four for a load or a taken branch, fourteen for a division. The
/// emulator does not tell.
const CYCLES: f64 = 1.5;
/// By how much of its largest command a controller may differ from double precision.
const APART: f64 = 5e-3;
/// The share of the processor that all controllers may take along their flights.
const LOAD: f64 = 0.1;

/// A line of the firmware about a controller.
#[derive(Clone, Debug, PartialEq)]
struct Flown {
    name: String,
    period_us: f64,
    rows: u64,
    samples: u64,
    limited: u64,
    mean: u64,
    median: u64,
    rare: u64,
    worst: u64,
    stack_bytes: u64,
    furthest: f64,
    largest: f64,
}

/// What the firmware says.
#[derive(Clone, Debug, Default, PartialEq)]
struct Figures {
    code_bytes: u64,
    constant_bytes: u64,
    static_bytes: u64,
    controller_bytes: u64,
    loops: Vec<Flown>,
}

/// Builds the firmware, runs it, and prints what it took; with `peers` what solvers that generate code take for the same flights, too.
pub fn run(workspace: &Workspace, progress: &Progress, install: bool, peers: bool) -> Result<(), Failure> {
    let compiler = match Compiler::find(workspace, TARGET)? {
        Some(compiler) => compiler,
        None => {
            provide(workspace, progress, vec![Need::StandardLibrary(TARGET)], install)?;
            let missing = || Failure::Missing {
                program: format!("Rust's standard library for {TARGET}"),
                remedy: "rustup target add thumbv7em-none-eabihf",
            };
            Compiler::find(workspace, TARGET)?.ok_or_else(missing)?
        }
    };
    let emulator = SystemEmulator::provide(workspace, progress, install)?;
    let recorder = progress
        .timed("Building what records flights", || program::build(workspace, "bench", Beside::Nothing))?;
    let folder = workspace.target("microcontroller");
    files::create_folder(&folder)?;
    let recording = folder.join("recording.bin");
    process::output(
        Command::new(&recorder).arg("recording").arg("--out").arg(&recording),
        "recording flights",
    )?;
    let firmware =
        progress.timed("Building the firmware", || build(workspace, &compiler, &folder, &recording))?;
    let said = progress
        .timed("Flying it in qemu-system-arm", || emulator.output(MACHINE, &firmware, "the firmware"))?;
    let figures = Figures::read(&said)?;
    print!("{}", figures.table());
    figures.judge()?;
    if peers { compare(workspace, progress, &recorder, &emulator) } else { Ok(()) }
}

/// Has peers fly the same flights on the same machine.
fn compare(
    workspace: &Workspace,
    progress: &Progress,
    recorder: &Path,
    emulator: &SystemEmulator,
) -> Result<(), Failure> {
    let (python, _) = bench::environment(workspace, progress)?;
    let folder = workspace.target("microcontroller").join("peers");
    files::create_folder(&folder)?;
    let programs = folder.join("programs.json");
    let mut write = Command::new(recorder);
    write.args(["programs", "--quick", "--out"]).arg(&programs);
    process::output(&mut write, "writing programs")?;
    let mut measure = python.command();
    measure.arg(workspace.root().join("microcontroller").join("peers").join("measure.py"));
    measure.arg(&programs).arg(&folder);
    emulator.tell(&mut measure);
    let status = progress.timed("Running peers in qemu-system-arm", || process::status(&mut measure))?;
    if status.success() { Ok(()) } else { Err(Failure::Ended { what: "measuring peers".to_owned(), status }) }
}

fn build(
    workspace: &Workspace,
    compiler: &Compiler,
    folder: &Path,
    recording: &Path,
) -> Result<PathBuf, Failure> {
    let target_folder = folder.join("build");
    let mut build = cargo();
    build.args(["build", "--quiet", "--release", "--locked", "--target-dir"]).arg(&target_folder);
    compiler.apply(&mut build);
    build.env("RECORDING", recording);
    // Its folder has the settings of the processor.
    build.current_dir(workspace.root().join("microcontroller").join("firmware"));
    process::output(&mut build, "building the firmware")?;
    Ok(target_folder.join(TARGET).join("release").join("firmware"))
}

impl Figures {
    /// Of the lines that the firmware prints.
    fn read(said: &str) -> Result<Self, Failure> {
        let mut figures = Self::default();
        for line in said.lines() {
            let fields: Vec<&str> = line.split('\t').collect();
            let number = |field: &str| -> Result<f64, Failure> {
                field.parse().map_err(|_| Failure::Answer {
                    what: "the firmware",
                    detail: format!("{field:?} in {line:?} is not a number"),
                })
            };
            match fields[..] {
                ["flash", code, constants] => {
                    figures.code_bytes = number(code)? as u64;
                    figures.constant_bytes = number(constants)? as u64;
                }
                ["memory", variables, controllers] => {
                    figures.static_bytes = number(variables)? as u64;
                    figures.controller_bytes = number(controllers)? as u64;
                }
                ["loop", name, ref numbers @ ..] => {
                    let numbers = numbers.iter().map(|field| number(field)).collect::<Result<Vec<_>, _>>()?;
                    figures.loops.push(Flown::of(name, &numbers).ok_or_else(|| Failure::Answer {
                        what: "the firmware",
                        detail: format!("{line:?} has {} numbers", numbers.len()),
                    })?);
                }
                _ => println!("{line}"),
            }
        }
        Ok(figures)
    }

    fn table(&self) -> String {
        let mut table = format!("{:<15}", "controller");
        for title in
            ["limits", "samples", "at limits", "mean", "median", "99 %", "worst", "load", "stack", "off by"]
        {
            let _ = write!(table, "{title:>10}");
        }
        table.push('\n');
        for flown in &self.loops {
            let _ = write!(table, "{:<15}", flown.name);
            let steps = [flown.mean, flown.median, flown.rare, flown.worst];
            for number in [flown.rows, flown.samples, flown.limited].into_iter().chain(steps) {
                let _ = write!(table, "{number:>10}");
            }
            let (load, apart) = (100.0 * flown.load(), flown.apart());
            let _ = writeln!(table, "{load:>9.2}%{:>10}{apart:>10.0e}", flown.stack_bytes);
        }
        let stack_bytes = self.loops.iter().map(|flown| flown.stack_bytes).max().unwrap_or_default();
        let _ = writeln!(
            table,
            "instructions of a step; together {:.1} % of a Cortex-M4F at {:.0} MHz, at {CYCLES} cycles per instruction\n\
             flash: {} bytes of code, {} of constants; memory: {} bytes of variables, {} of controllers, {stack_bytes} of stack",
            100.0 * self.load(),
            CLOCK_HZ / 1e6,
            self.code_bytes,
            self.constant_bytes,
            self.static_bytes,
            self.controller_bytes
        );
        table
    }

    fn load(&self) -> f64 {
        self.loops.iter().map(Flown::load).sum()
    }

    /// Whether all of it is as it must be.
    fn judge(&self) -> Result<(), Failure> {
        let mut wrong = Vec::new();
        if self.loops.len() != 4 {
            wrong.push(format!("{} controllers flew, not 4", self.loops.len()));
        }
        for flown in &self.loops {
            let differs = flown.apart().is_nan() || flown.apart() >= APART;
            if differs || flown.limited == 0 {
                wrong.push(format!(
                    "{}: {:.1e} off double precision (at most {APART:e} allowed), {} samples at limits",
                    flown.name,
                    flown.apart(),
                    flown.limited
                ));
            }
        }
        if self.load() > LOAD {
            wrong.push(format!(
                "{:.1} % of the processor, more than {:.0} %",
                100.0 * self.load(),
                100.0 * LOAD
            ));
        }
        if wrong.is_empty() {
            return Ok(());
        }
        Err(Failure::Answer { what: "the firmware", detail: wrong.join("; ") })
    }
}

impl Flown {
    /// The numbers of a line, in their order.
    fn of(name: &str, numbers: &[f64]) -> Option<Self> {
        let &[period_us, rows, samples, limited, mean, median, rare, worst, stack, furthest, largest] =
            numbers
        else {
            return None;
        };
        Some(Self {
            name: name.to_owned(),
            period_us,
            rows: rows as u64,
            samples: samples as u64,
            limited: limited as u64,
            mean: mean as u64,
            median: median as u64,
            rare: rare as u64,
            worst: worst as u64,
            stack_bytes: stack as u64,
            furthest,
            largest,
        })
    }

    /// The share of the processor along its flights.
    fn load(&self) -> f64 {
        self.mean as f64 * CYCLES / CLOCK_HZ / (self.period_us * 1e-6)
    }

    /// The largest difference of a command to that of double precision, as a share of the largest command.
    fn apart(&self) -> f64 {
        self.furthest / self.largest
    }
}

#[cfg(test)]
mod tests {
    use super::Figures;

    const SAID: &str = "flash\t60000\t9000\nmemory\t120\t40000\n\
        loop\tposition\t50000\t592\t600\t100\t84000\t1000\t9000\t99000\t7000\t0.002\t4.0\n\
        loop\taltitude\t50000\t90\t600\t100\t42000\t1000\t9000\t99000\t7000\t0.002\t4.0\n\
        loop\troll and pitch\t10000\t128\t600\t100\t42000\t1000\t9000\t99000\t7000\t0.002\t4.0\n\
        loop\tyaw\t10000\t40\t600\t100\t5600\t1000\t9000\t99000\t3000\t0.002\t4.0\n";

    /// 1.5 cycles × (84000 + 42000) × 20 Hz + 1.5 × (42000 + 5600) × 100 Hz of 168 MHz: 2.25 % + 4.25 %.
    #[test]
    fn the_load_is_that_of_all_at_their_rates() {
        let figures = Figures::read(SAID).expect("figures");
        assert!((figures.load() - 0.065).abs() < 1e-12, "{}", figures.load());
        assert!(figures.judge().is_ok());
        assert!(figures.table().contains("together 6.5 %"), "{}", figures.table());
    }

    #[test]
    fn what_is_wrong_is_told() {
        let told = |said: &str| {
            Figures::read(said).and_then(|figures| figures.judge()).err().map(|failure| failure.to_string())
        };
        for (from, to, expected) in [
            ("yaw\t10000", "yaw\t1000", "11.0 %"),
            ("0.002\t4.0\nloop\tyaw", "0.03\t4.0\nloop\tyaw", "roll and pitch: 7.5e-3"),
            ("128\t600\t100", "128\t600\t0", "0 samples at limits"),
            ("loop\tyaw", "no\tyaw", "3 controllers flew"),
            ("memory\t120", "memory\tmuch", "\"much\""),
            ("3000\t0.002\t4.0", "3000", "9 numbers"),
        ] {
            let told = told(&SAID.replace(from, to)).unwrap_or_default();
            assert!(told.contains(expected), "{expected}: {told}");
        }
        let none = told(&SAID.replace("0.002", "NaN"));
        assert!(none.is_some_and(|told| told.contains("NaN")));
    }
}
