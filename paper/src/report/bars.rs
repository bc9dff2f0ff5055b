//! The bars: what is kept, and where Laguerre MPC loses.

use super::Page;
use super::bar_figures::{cruise, deviations, goals, paths};
use crate::bars::{BarResult, EXCESS, Flyer, OptimumResult, SETTLED, SQUARED_DISTANCE};
use crate::results::Results;

/// A controller that is better by less than this share is no better.
const TIE: f64 = 0.1;
/// A limit that is broken by no more than this is kept, %.
const MOST_EXCESS: f64 = 1.0;

pub fn section(page: &mut Page, results: &Results) {
    page.heading("Bars: the closed loop against numbers");
    page.paragraph(
        "Flights of the nonlinear plant with rotor lag and all limits, without the shaper. Each figure has a bar, except those that only \
         inform; ✗ marks a figure that misses its bar. LMPC, SS-MPC and DLQR fly without the governor, “DLQR, governed” \
         with it. “Geometric” is the controller of Lee, Leok and McClamroch (2010) with feed-forward from differential flatness, \
         sampled at 100 Hz; the limits of tilt and speed bound its feedback, but not the feed-forward, and it flies motions only. Paths begin at rest with a ramp of 5 s, 5 s later \
         the 20 s begin over which errors count. Figure-eights are x = A sin ωt, y = A/2 sin 2ωt. Settling times may not be longer than \
         those of either DLQR, unless that breaks a limit by more than 25 %; paths beyond the limits and references that nobody can foresee may cost 10 % more than with the best of our controllers, and \
         beyond the limits no path may be left by more than twice its width. Sample times are \
         those of this machine.",
    );
    summary(page, &results.bars);
    page.figures(vec![
        cruise(&results.shown),
        goals(&results.shown),
        paths(&results.shown),
        deviations(&results.shown),
    ]);
    page.subheading("All figures");
    table(page, &results.bars);
    page.subheading("Where LMPC loses");
    losses(page, &results.bars);
    page.subheading("The optimum");
    optimum(page, results);
}

/// The results of one figure of one flight, of everyone.
fn figures(bars: &[BarResult]) -> Vec<Vec<&BarResult>> {
    let mut figures: Vec<Vec<&BarResult>> = Vec::new();
    for bar in bars {
        let same = |figure: &&mut Vec<&BarResult>| {
            figure.first().is_some_and(|other| other.flight == bar.flight && other.figure == bar.figure)
        };
        match figures.iter_mut().find(same) {
            Some(figure) => figure.push(bar),
            None => figures.push(vec![bar]),
        }
    }
    figures
}

fn summary(page: &mut Page, bars: &[BarResult]) {
    let mut rows: Vec<&str> = Vec::new();
    for bar in bars {
        if !rows.contains(&bar.row) {
            rows.push(bar.row);
        }
    }
    let cell = |row: &str, flyer: Flyer| {
        let of = || bars.iter().filter(|bar| bar.row == row && bar.controller == flyer.name());
        let judged = of().filter(|bar| bar.passed.is_some()).count();
        let passed = of().filter(|bar| bar.passed == Some(true)).count();
        if judged == 0 { "–".to_owned() } else { format!("{passed} of {judged}") }
    };
    let table: Vec<Vec<String>> = rows
        .into_iter()
        .map(|row| {
            let cells = Flyer::ALL.into_iter().map(|flyer| cell(row, flyer));
            std::iter::once(row.to_owned()).chain(cells).collect()
        })
        .collect();
    page.table(&header("bars kept"), &table);
}

fn header(first: &'static str) -> Vec<&'static str> {
    std::iter::once(first).chain(Flyer::ALL.map(Flyer::name)).collect()
}

/// A number with three digits or so.
fn number(value: f64) -> String {
    let digits = match value.abs() {
        size if size >= 100.0 => 0,
        size if size >= 10.0 => 1,
        _ => 2,
    };
    format!("{value:.digits$}").replace('-', "−")
}

fn table(page: &mut Page, bars: &[BarResult]) {
    let mut rows = Vec::new();
    for figure in figures(bars) {
        let Some(first) = figure.first() else { continue };
        let bound = figure.iter().find_map(|bar| bar.bound);
        let cell = |flyer: Flyer| {
            let Some(bar) = figure.iter().find(|bar| bar.controller == flyer.name()) else {
                return "–".to_owned();
            };
            let value = bar.value.map_or("never".to_owned(), number);
            if bar.passed == Some(false) { format!("{value} ✗") } else { value }
        };
        let names = [format!("{}: {}", first.row, first.flight), first.figure.to_owned()];
        let bound = bound.map_or(String::new(), number);
        rows.push(names.into_iter().chain([bound]).chain(Flyer::ALL.map(cell)).collect());
    }
    let columns: Vec<&str> =
        ["flight", "figure", "at most"].into_iter().chain(Flyer::ALL.map(Flyer::name)).collect();
    page.table(&columns, &rows);
    for lost in bars.iter().filter(|bar| bar.lost.is_some()) {
        let reason = lost.lost.as_deref().unwrap_or_default();
        page.paragraph(&format!("{}, {}: {reason}.", lost.flight, lost.controller));
    }
}

/// Bars that LMPC misses, and judged figures in which another controller is clearly better, whatever limits it breaks.
fn losses(page: &mut Page, bars: &[BarResult]) {
    let mut rows = Vec::new();
    for figure in figures(bars) {
        let Some(lmpc) = figure.iter().find(|bar| bar.controller == Flyer::LaguerreMpc.name()) else {
            continue;
        };
        let valued = figure.iter().filter_map(|bar| Some((bar.value?, *bar)));
        let Some((least, best)) = valued.min_by(|one, other| one.0.total_cmp(&other.0)) else { continue };
        let value = lmpc.value.unwrap_or(f64::INFINITY);
        let missed = lmpc.passed == Some(false);
        // A value far below its bar is no loss, whoever has less.
        let bound = lmpc.bound.unwrap_or(f64::INFINITY);
        let beaten = value > TIE * bound && value > (1.0 + TIE) * least && lmpc.passed.is_some();
        if missed || beaten {
            rows.push(vec![
                format!("{}: {}", lmpc.row, lmpc.flight),
                lmpc.figure.to_owned(),
                lmpc.value.map_or("never".to_owned(), number),
                lmpc.bound.map_or(String::new(), number),
                if missed { "missed" } else { "kept" }.to_owned(),
                format!("{}: {}{}", best.controller, number(least), broken(bars, best)),
            ]);
        }
    }
    if rows.is_empty() {
        page.paragraph("LMPC keeps every bar, and no other controller is clearly better in any of them.");
        return;
    }
    page.paragraph(
        "Bars that LMPC misses, and judged figures in which another controller is better by more than 10 %, also where it breaks limits. \
         Values below a tenth of their bar count as equal.",
    );
    page.table(&["flight", "figure", "LMPC", "at most", "bar", "best"], &rows);
}

/// By how much the controller of a figure breaks limits in its flight, if it does.
fn broken(bars: &[BarResult], best: &BarResult) -> String {
    let is_same = |bar: &&BarResult| {
        (bar.row, &bar.flight, &bar.controller) == (best.row, &best.flight, &best.controller)
    };
    let excess = bars.iter().filter(is_same).find(|bar| bar.figure == EXCESS).and_then(|bar| bar.value);
    match excess {
        Some(percent) if percent > MOST_EXCESS => format!(" (limits broken by {} %)", number(percent)),
        _ => String::new(),
    }
}

fn optimum(page: &mut Page, results: &Results) {
    if results.optimum.is_empty() {
        page.paragraph("It was not computed in this run.");
        return;
    }
    page.paragraph(
        "The best flights that IPOPT finds for three raw steps with the whole nonlinear plant as model, by direct multiple shooting with \
         commands that change every 0.04 s or so: once with the least integral of the squared distance from the goal, once with the least \
         time after which the vehicle stays within 2 cm. They keep the limits on tilt, speed and thrust and those of the rotors at every \
         node and halfway between nodes; the limits on rate and acceleration of the tilt command do not apply to them. No feedback can be better. The numbers are those of \
         the commands flown on this program's plant.",
    );
    let rows: Vec<Vec<String>> =
        results.optimum.iter().map(|optimum| optimum_row(optimum, &results.bars)).collect();
    let columns: Vec<&str> = ["flight", "what is least", "optimum"]
        .into_iter()
        .chain(Flyer::ALL.into_iter().filter(|flyer| *flyer != Flyer::Geometric).map(Flyer::name))
        .chain(["solved in, s"])
        .collect();
    page.table(&columns, &rows);
}

fn optimum_row(optimum: &OptimumResult, bars: &[BarResult]) -> Vec<String> {
    let fastest = optimum.objective == "settling time";
    let (figure, least) = if fastest {
        (SETTLED, optimum.settled_s)
    } else {
        (SQUARED_DISTANCE, Some(optimum.squared_distance_m2_s))
    };
    let cell = |flyer: Flyer| {
        let of = |bar: &&BarResult| {
            bar.flight == optimum.flight && bar.controller == flyer.name() && bar.figure == figure
        };
        match (bars.iter().find(of).and_then(|bar| bar.value), least) {
            (Some(value), Some(least)) => {
                format!("{} (+{:.0} %)", number(value), 100.0 * (value / least - 1.0))
            }
            _ => "–".to_owned(),
        }
    };
    let cascades = Flyer::ALL.into_iter().filter(|flyer| *flyer != Flyer::Geometric);
    [optimum.flight.clone(), figure.to_owned(), least.map_or("–".to_owned(), number)]
        .into_iter()
        .chain(cascades.map(cell))
        .chain([format!("{:.1}", optimum.computed_in_s)])
        .collect()
}
