//! README's table of figures, from the results.

use serde_json::Value;
use xtask::failure::Failure;

/// Loops whose step is compared with the best peer.
const LOOPS: [&str; 2] = ["position", "roll and pitch"];

/// The table in Markdown.
///
/// # Errors
/// When the results lack a figure.
pub fn table(results: &Value) -> Result<String, Failure> {
    let heading = format!("measured by `cargo xtask bench`{}", reservation(&results["machine"]));
    let mut text = format!("| {heading} | LMPC | best peer |\n| --- | --- | --- |\n");
    for name in LOOPS {
        let of = find(results.get("control"), "name", name).ok_or_else(|| lacks(name))?;
        let solvers = of.get("solvers").and_then(Value::as_array).ok_or_else(|| lacks(name))?;
        let cold = |entry: &&Value| entry["warm"] == false && entry["failures"] == 0;
        let times = |entry: &Value| {
            let limited = &entry["times_ns"]["limited"];
            Some((limited["median"].as_f64()?, limited["p99"].as_f64()?))
        };
        let ours = solvers.iter().filter(cold).find(|entry| entry["solver"] == "ours").and_then(times);
        let (ours, p99) = ours.ok_or_else(|| lacks(name))?;
        let peers = solvers.iter().filter(cold).filter(|entry| entry["solver"] != "ours");
        let best = peers
            .filter_map(|entry| Some((times(entry)?, entry["solver"].as_str()?)))
            .min_by(|a, b| a.0.0.total_cmp(&b.0.0));
        let best = best.map_or_else(
            || "none".to_owned(),
            |((median, p99), solver)| format!("{solver}: {}, {}", duration(median), duration(p99)),
        );
        let rows = of["rows"].as_u64().unwrap_or_default();
        text.push_str(&format!(
            "| {name} step at its {rows} limits, cold: median, p99 | {}, {} | {best} |\n",
            duration(ours),
            duration(p99)
        ));
    }
    text.push_str(&engine(&results["engine"])?);
    Ok(text)
}

/// What makes figures provisional.
fn reservation(machine: &Value) -> String {
    let build = machine["build"].as_str().unwrap_or("release");
    match (build, machine["quick"] == true) {
        ("release", false) => String::new(),
        ("release", true) => ", quickly".to_owned(),
        (build, quick) => {
            format!(", provisional: profile {build}{}", if quick { ", quickly" } else { "" })
        }
    }
}

/// The row of the engine.
fn engine(engine: &Value) -> Result<String, Failure> {
    let ours = engine["ours"]["closed_loop_ns"].as_f64().ok_or_else(|| lacks("engine"))?;
    let peers = engine["peers"].as_object().into_iter().flatten();
    let best = peers
        .filter_map(|(name, peer)| Some((peer["s_per_s"].as_f64()? * 1e9, name)))
        .min_by(|a, b| a.0.total_cmp(&b.0));
    let best = best.map_or_else(|| "none".to_owned(), |(ns, name)| format!("{name}: {}", duration(ns)));
    Ok(format!("| one simulated second, plant and controllers | {} | {best} |\n", duration(ours)))
}

fn find<'a>(list: Option<&'a Value>, key: &str, value: &str) -> Option<&'a Value> {
    list?.as_array()?.iter().find(|entry| entry[key] == value)
}

fn lacks(what: &str) -> Failure {
    Failure::Figures {
        file: "bench/results/results.json",
        detail: format!("has no figures of {what}: measure with `cargo xtask bench --publish`"),
    }
}

/// With a unit, to two digits.
fn duration(ns: f64) -> String {
    let (value, unit) = match ns {
        ns if ns >= 1e6 => (ns / 1e6, "ms"),
        ns if ns >= 1e3 => (ns / 1e3, "µs"),
        ns => (ns, "ns"),
    };
    if value < 10.0 { format!("{value:.1} {unit}") } else { format!("{value:.0} {unit}") }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::{duration, table};

    #[test]
    fn the_best_peer_is_the_fastest_that_solves_all() {
        let solver = |name: &str, failures: u32, median: f64| {
            json!({"solver": name, "warm": false, "failures": failures,
                   "times_ns": {"limited": {"median": median, "p99": 2.0 * median}}})
        };
        let of = |name: &str| {
            let solvers = [
                solver("ours", 0, 1000.0),
                solver("fails", 3, 10.0),
                solver("slow", 0, 9e3),
                solver("quick", 0, 4e3),
            ];
            json!({"name": name, "rows": 44, "solvers": solvers})
        };
        let results = json!({
            "control": [of("position"), of("roll and pitch")],
            "engine": {"ours": {"closed_loop_ns": 3e5}, "peers": {"other": {"s_per_s": 0.01}}},
            "machine": {"build": "dev", "quick": false},
        });
        let table = table(&results).unwrap();
        assert_eq!(table.lines().count(), 5, "{table}");
        assert!(
            table.starts_with("| measured by `cargo xtask bench`, provisional: profile dev | LMPC |"),
            "{table}"
        );
        let line = "| roll and pitch step at its 44 limits, cold: median, p99 | 1.0 µs, 2.0 µs | quick: 4.0 µs, 8.0 µs |";
        assert!(table.contains(line), "{table}");
        assert!(table.contains("| 300 µs | other: 10 ms |"), "{table}");
    }

    #[test]
    fn results_without_figures_are_refused() {
        let error = table(&json!({"control": []})).unwrap_err().to_string();
        assert!(error.contains("no figures of position"), "{error}");
    }

    #[test]
    fn durations_have_two_digits() {
        assert_eq!([153.2, 4_321.0, 12_345.0, 7.0e6].map(duration), ["153 ns", "4.3 µs", "12 µs", "7.0 ms"]);
    }
}
