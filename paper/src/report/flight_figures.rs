//! Figures of flights.

use quadrotor::Outputs;

use crate::figures::{COLOURS, Figure, Line, Panel, Path, REFERENCE, Scale, line_chart, path_figure};
use crate::flights::{FlightResult, Mission, Moment, loops, tilt_rad};

const WIDE: [f64; 2] = [520.0, 250.0];
const LOOPS: [&str; 3] = ["altitude", "position", "attitude"];

/// A name for files and clip paths.
fn key(mission: Mission) -> &'static str {
    match mission {
        Mission::Smooth => "smooth",
        Mission::Step => "step",
        Mission::BareStep => "bare-step",
    }
}

fn points(result: &FlightResult, value: impl Fn(&Moment) -> f64) -> Vec<[f64; 2]> {
    result.moments.iter().map(|moment| [moment.time_s, value(moment)]).collect()
}

/// One line per flight.
fn lines(flown: &[&FlightResult], value: impl Fn(&Moment) -> f64) -> Vec<Line> {
    let line = |(index, result): (usize, &&FlightResult)| {
        Line::new(result.controller.clone(), COLOURS[index % COLOURS.len()], points(result, &value))
    };
    flown.iter().enumerate().map(line).collect()
}

/// What was asked for.
fn reference(flown: &[&FlightResult], value: impl Fn(&Moment) -> f64) -> Vec<Line> {
    let first = flown.iter().find(|result| !result.moments.is_empty());
    first
        .map(|result| Line::new("reference", REFERENCE, points(result, value)).dashed())
        .into_iter()
        .collect()
}

fn north_east_up(position: &nalgebra::Vector3<f64>) -> [f64; 3] {
    [position.x, position.y, -position.z]
}

/// Figure 5.
pub fn path(mission: Mission, flown: &[&FlightResult]) -> Figure {
    let mut paths: Vec<Path> = Vec::new();
    for (index, result) in flown.iter().enumerate() {
        let points = result.moments.iter().map(|moment| north_east_up(&moment.outputs.position_m));
        paths.push((Line::new(result.controller.clone(), COLOURS[index], Vec::new()), points.collect()));
    }
    if mission == Mission::Smooth
        && let Some(result) = flown.first()
    {
        let points = result.moments.iter().map(|moment| north_east_up(&moment.reference.0));
        paths.push((Line::new("reference", REFERENCE, Vec::new()).dashed(), points.collect()));
    }
    Figure {
        name: format!("figure5-{}", key(mission)),
        caption: "Figure 5: the path, with its shadow on the ground.".to_owned(),
        svg: path_figure("The path in space", &paths),
    }
}

/// Figures 6 and 7.
pub fn axes(mission: Mission, flown: &[&FlightResult]) -> Figure {
    type Value = fn(&Moment) -> f64;
    let axes: [(&str, &str, Value, Value); 4] = [
        ("x", "north, m", |m| m.outputs.position_m.x, |m| m.reference.0.x),
        ("y", "east, m", |m| m.outputs.position_m.y, |m| m.reference.0.y),
        ("z", "altitude −z, m", |m| -m.outputs.position_m.z, |m| -m.reference.0.z),
        ("ψ", "heading ψ, rad", |m| m.outputs.attitude_rad.z, |m| m.reference.1),
    ];
    let panels = axes.map(|(title, label, value, asked)| {
        let mut all = lines(flown, value);
        all.extend(reference(flown, asked));
        Panel::new(title, "time, s", label, all).with_span(0.05)
    });
    let name = format!("figure6-7-{}", key(mission));
    Figure {
        caption: "Figures 6 and 7: position and heading.".to_owned(),
        svg: line_chart(&name, "Position and heading over time", 2, WIDE, &panels),
        name,
    }
}

/// Tracking errors.
pub fn errors(mission: Mission, flown: &[&FlightResult]) -> Figure {
    // A step's error is metres, a smooth flight's fractions of a millimetre.
    let (factor, unit) = if mission == Mission::Smooth { (1e3, "mm") } else { (1.0, "m") };
    let error = |axis: usize| move |m: &Moment| factor * (m.outputs.position_m[axis] - m.reference.0[axis]);
    let mut panels: Vec<Panel> = ["north", "east", "down"]
        .into_iter()
        .enumerate()
        .map(|(axis, name)| {
            Panel::new(name, "time, s", &format!("error, {unit}"), lines(flown, error(axis))).with_span(0.1)
        })
        .collect();
    let heading = |m: &Moment| {
        1e3 * (m.outputs.attitude_rad.z - m.reference.1)
            .sin()
            .atan2((m.outputs.attitude_rad.z - m.reference.1).cos())
    };
    panels.push(Panel::new("heading", "time, s", "error, mrad", lines(flown, heading)).with_span(0.1));
    let name = format!("errors-{}", key(mission));
    Figure {
        caption: "Tracking errors: flown minus reference.".to_owned(),
        svg: line_chart(&name, "Tracking errors over time", 2, WIDE, &panels),
        name,
    }
}

/// Control effort.
pub fn effort(mission: Mission, flown: &[&FlightResult]) -> Figure {
    let of = |value: fn(&Outputs) -> f64| lines(flown, move |m: &Moment| value(&m.outputs));
    let panels = [
        Panel::new("thrust", "time, s", "F, N", of(|o| o.thrust_n)).with_span(1.0),
        Panel::new("tilt of the thrust axis", "time, s", "tilt, °", of(|o| tilt_rad(o).to_degrees()))
            .with_span(1.0),
        Panel::new("pitch torque", "time, s", "τ_θ, N·m", of(|o| o.torque_n_m.y)).with_span(0.1),
        Panel::new("yaw torque", "time, s", "τ_ψ, N·m", of(|o| o.torque_n_m.z)).with_span(0.02),
    ];
    let name = format!("effort-{}", key(mission));
    Figure {
        caption: "Control effort of the rotors together.".to_owned(),
        svg: line_chart(&name, "Control effort over time", 2, WIDE, &panels),
        name,
    }
}

/// Active limits, iterations and status.
pub fn activity(mission: Mission, flown: &[&FlightResult]) -> Figure {
    let mut panels = Vec::new();
    for (index, name) in LOOPS.into_iter().enumerate() {
        let active = lines(flown, |m: &Moment| f64::from(loops(&m.outputs.activity)[index].active));
        let iterations = lines(flown, |m: &Moment| f64::from(loops(&m.outputs.activity)[index].iterations));
        let status =
            lines(flown, |m: &Moment| f64::from(loops(&m.outputs.activity)[index].status.severity()));
        panels.push(Panel::new(name, "time, s", "active limits", active).with_span(2.0));
        panels.push(Panel::new(name, "time, s", "iterations", iterations).with_span(2.0));
        panels.push(Panel::new(name, "time, s", "status", status).with_range(-0.3, 3.3));
    }
    // What happens, happens in the beginning.
    for line in panels.iter_mut().flat_map(|panel| &mut panel.lines) {
        line.points.retain(|[time_s, _]| *time_s <= 8.0);
        line.width = 1.2;
    }
    let name = format!("activity-{}", key(mission));
    Figure {
        caption: "Constraint activity during the first 8 s: limits that are active over the horizon, or clip an input \
                  behind the controller; iterations of the solver; status 0 optimal, 1 limits relaxed, 2 out of iterations, \
                  3 held. LMPC's attitude controller and DLQR are cut off behind the controller and need no iterations."
            .to_owned(),
        svg: line_chart(&name, "Constraint activity over time", 3, [370.0, 210.0], &panels),
        name,
    }
}

/// Figures 8–13: x, y and z with N = 1 beside N = 9.
pub fn single_axes(mission: Mission, flown: &[&FlightResult]) -> Figure {
    type Value = fn(&Moment) -> f64;
    let axes: [(&str, Value, Value); 3] = [
        ("north x, m", |m| m.outputs.position_m.x, |m| m.reference.0.x),
        ("east y, m", |m| m.outputs.position_m.y, |m| m.reference.0.y),
        ("altitude −z, m", |m| -m.outputs.position_m.z, |m| -m.reference.0.z),
    ];
    let mut panels = Vec::new();
    for (label, value, asked) in axes {
        for terms in [1, 9] {
            let mut all = Vec::new();
            for (colour, alpha, name) in [(COLOURS[0], 1.2, "α = 1.2"), (COLOURS[2], 1.0, "terminal weight")]
            {
                let of = |result: &&&FlightResult| result.n == Some(terms) && result.alpha == Some(alpha);
                if let Some(result) = flown.iter().find(of).filter(|result| result.refused.is_none()) {
                    all.push(Line::new(name, colour, points(result, value)));
                }
            }
            all.extend(reference(flown, asked));
            let refused = if all.len() < 3 { ", α = 1.2 refused" } else { "" };
            panels.push(Panel::new(format!("N = {terms}{refused}"), "time, s", label, all));
        }
    }
    let name = format!("figure8-13-{}", key(mission));
    Figure {
        caption: "Figures 8–13: N = 1 (left) and N = 9 (right), both with a control horizon of 30."
            .to_owned(),
        svg: line_chart(&name, "N = 1 and N = 9 over time", 2, WIDE, &panels),
        name,
    }
}

/// What N costs in flight.
pub fn sweep(swept: &[&FlightResult]) -> Figure {
    let mut panels = Vec::new();
    for mission in [Mission::Smooth, Mission::BareStep] {
        let family = |alpha: f64, value: &dyn Fn(&FlightResult) -> Option<f64>| -> Vec<[f64; 2]> {
            swept
                .iter()
                .filter(|result| result.mission == mission.name() && result.alpha == Some(alpha))
                .map(|result| [f64::from(result.n.unwrap_or(0)), value(result).unwrap_or(f64::NAN)])
                .collect()
        };
        let both = |value: &dyn Fn(&FlightResult) -> Option<f64>| {
            vec![
                Line::new("α = 1.2", COLOURS[0], family(1.2, value)).marked(),
                Line::new("terminal weight", COLOURS[2], family(1.0, value)).marked(),
            ]
        };
        let rms = both(&|result| result.rms_m.map(|rms| 1e3 * rms.iter().map(|e| e * e).sum::<f64>().sqrt()));
        let last = both(&|result| result.final_m.map(|last| 1e3 * last));
        let panel = |what: &str, label: &str, lines: Vec<Line>| {
            let panel = Panel::new(format!("{}: {what}", mission.name()), "N", label, lines);
            Panel { y_scale: Scale::Logarithmic, ..panel }
        };
        panels.push(panel("RMS error", "RMS error, mm", rms));
        panels.push(panel("distance at the end", "from the goal after 20 s, mm", last));
    }
    Figure {
        name: "sweep-terms".to_owned(),
        caption: "N = 1 … 15 with a = e^(−N/30). Above the smooth time law, below the step without governor. A missing point is a \
                  refused design."
            .to_owned(),
        svg: line_chart("sweep-terms", "Flights over N", 2, WIDE, &panels),
    }
}
