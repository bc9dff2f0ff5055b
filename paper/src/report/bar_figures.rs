//! Figures of the bars.

use crate::bars::{Moment, ShownFlight};
use crate::figures::{COLOURS, Figure, Line, Panel, REFERENCE, line_chart};

const WIDE: [f64; 2] = [520.0, 250.0];
/// Moments per point of a line.
const THINNING: usize = 5;

fn find<'a>(shown: &'a [ShownFlight], flight: &str) -> Option<&'a ShownFlight> {
    shown.iter().find(|shown| shown.flight == flight)
}

/// A line per controller.
fn lines(shown: &[ShownFlight], flight: &str, point: impl Fn(&Moment) -> [f64; 2]) -> Vec<Line> {
    let tracks = find(shown, flight).map_or(&[][..], |shown| &shown.tracks);
    let line = |(index, (name, track)): (usize, &(String, crate::bars::Track))| {
        let points = track.moments.iter().step_by(THINNING).map(&point).collect();
        Line::new(name.clone(), COLOURS[index % COLOURS.len()], points)
    };
    tracks.iter().enumerate().map(line).collect()
}

/// Until a time, s; what comes later is left out.
fn until(mut lines: Vec<Line>, end: f64) -> Vec<Line> {
    for line in &mut lines {
        line.points.retain(|[x, _]| *x <= end);
    }
    lines
}

/// 300 m at the speed limit.
pub fn cruise(shown: &[ShownFlight]) -> Figure {
    let flight = "300 m, calm";
    let speed = lines(shown, flight, |moment| [moment.time_s, moment.velocity_m_s.x]);
    let pitch = lines(shown, flight, |moment| [moment.time_s, moment.attitude_rad.y.to_degrees()]);
    let panels = [
        Panel::new("speed", "time, s", "north, m/s", until(speed, 50.0)).with_range(-2.0, 14.0),
        Panel::new("pitch", "time, s", "θ, °", until(pitch, 50.0)).with_range(-40.0, 40.0),
    ];
    Figure {
        name: "bars-cruise".to_owned(),
        caption: "A raw goal 300 m north: the speed limit is 8 m/s.".to_owned(),
        svg: line_chart("bars-cruise", "Cruise at the speed limit", 2, WIDE, &panels),
    }
}

/// Raw steps, with their optima.
pub fn goals(shown: &[ShownFlight]) -> Figure {
    let distance = |flight: &str, end: f64| {
        until(lines(shown, flight, |moment| [moment.time_s, 100.0 * moment.error_m().norm()]), end)
    };
    let north = |flight: &str, end: f64| {
        until(lines(shown, flight, |moment| [moment.time_s, moment.position_m.x]), end)
    };
    let panels = [
        Panel::new("5 m north", "time, s", "north, m", north("5 m north", 8.0)).with_range(0.0, 6.0),
        Panel::new("20 m north", "time, s", "north, m", north("20 m north", 12.0)).with_range(0.0, 27.0),
        Panel::new("5 m north", "time, s", "distance, cm", distance("5 m north", 8.0)).with_range(0.0, 50.0),
        Panel::new(
            "5 m north, 5 m east, 5 m up",
            "time, s",
            "distance, cm",
            distance("5 m north, 5 m east, 5 m up", 8.0),
        )
        .with_range(0.0, 100.0),
    ];
    Figure {
        name: "bars-goals".to_owned(),
        caption: "Raw goals. “Least …” are the flights of the nonlinear solver, where it was run.".to_owned(),
        svg: line_chart("bars-goals", "Raw goals", 2, WIDE, &panels),
    }
}

/// Figure-eights.
pub fn paths(shown: &[ShownFlight]) -> Figure {
    let flights = [
        ("6 m at 0.85 rad/s, wide limits", "figure-eight of 6 m at 0.85 rad/s", 10.0),
        (
            "8 m at 1 rad/s, tilt limit 1.0 rad",
            "figure-eight of 8 m at 1 rad/s, tilt 1.0 rad, speed 20 m/s",
            20.0,
        ),
    ];
    let mut panels = Vec::new();
    for (title, flight, half_m) in flights {
        let mut path = lines(shown, flight, |moment| [moment.position_m.y, moment.position_m.x]);
        for line in &mut path {
            line.points.retain(|[east, _]| east.abs() <= half_m);
        }
        if let Some((_, track)) = find(shown, flight).and_then(|shown| shown.tracks.first()) {
            let points = track.moments.iter().step_by(THINNING);
            let asked = points.map(|moment| [moment.reference_m.y, moment.reference_m.x]).collect();
            path.push(Line::new("reference", REFERENCE, asked).dashed());
        }
        panels.push(Panel::new(title, "east, m", "north, m", path).with_range(-half_m, half_m));
        let error = lines(shown, flight, |moment| [moment.time_s, 100.0 * moment.error_m().norm().max(1e-5)]);
        panels.push(Panel::new(title, "time, s", "distance, cm", error).logarithmic().with_range(1e-2, 1e4));
    }
    Figure {
        name: "bars-paths".to_owned(),
        caption: "Figure-eights within the limits, and one that needs more tilt than its limit.".to_owned(),
        svg: line_chart("bars-paths", "Figure-eights", 2, WIDE, &panels),
    }
}

/// A wrong mass.
pub fn deviations(shown: &[ShownFlight]) -> Figure {
    let flight = "mass believed 0.5 of the true one, full state";
    let height = lines(shown, flight, |moment| [moment.time_s, -moment.position_m.z]);
    let north = lines(shown, flight, |moment| [moment.time_s, moment.position_m.x]);
    let panels = [
        Panel::new("height", "time, s", "m", height).with_span(0.5),
        Panel::new("north", "time, s", "m", north).with_span(0.5),
    ];
    Figure {
        name: "bars-mass".to_owned(),
        caption: "A step of 2 m north and 2 m up with controllers that believe in half of the mass."
            .to_owned(),
        svg: line_chart("bars-mass", "Half of the mass", 2, WIDE, &panels),
    }
}
