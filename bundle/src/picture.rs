//! Pictures of the default flights, flown by the engine when the FMUs are built.

use fmu::Commands;
use quadrotor::{Configuration, Inputs, Outputs, PlantInputs, PlantSimulation, PlantState, Simulation};

use crate::chart::{Chart, Line, Svg};
use crate::failure::Failure;

/// Time between two points of a line, µs.
const INTERVAL_US: u64 = 50_000;

const NORTH: &str = "#8ecae6";
const EAST: &str = "#d55e00";
const UP: &str = "#009e73";
/// Width and dashes of the rotors' lines, which lie upon one another for most of the flight: what is below is wider.
const STROKES: [(f64, &str); 4] = [(6.0, "none"), (4.0, "14 6"), (2.5, "6 4"), (1.4, "2 3")];
const ROTORS: [&str; 4] = ["#8ecae6", "#d55e00", "#0072b2", "#111111"];

/// The flight of this duration as SVG: position over time against its reference, and rotor speeds.
pub fn of_default_flight(duration_s: f64) -> Result<String, Failure> {
    let flight = fly(duration_s)?;
    let axis = |of: &dyn Fn(&Outputs) -> f64| -> Vec<(f64, f64)> {
        flight.iter().map(|outputs| (outputs.time_us as f64 * 1e-6, of(outputs))).collect()
    };
    let mut svg = Svg::new(640.0, 560.0);
    svg.draw(&Chart {
        place: (62.0, 20.0, 430.0, 290.0),
        x_range: (0.0, duration_s),
        y_range: (0.0, 11.0),
        x_step: 2.0,
        y_step: 2.0,
        x_title: "",
        y_title: "position, m",
        lines: vec![
            // North and east are the same in this flight: the one below is wider.
            Line::new(axis(&|o| o.position_m.x), NORTH, 6.0, "none", "north"),
            Line::new(axis(&|o| o.position_m.y), EAST, 2.0, "9 4", "east"),
            Line::new(axis(&|o| -o.position_m.z), UP, 2.0, "none", "up (−z)"),
            Line::dashed(axis(&|o| o.setpoint.position_m.x)),
            Line::dashed(axis(&|o| -o.setpoint.position_m.z)),
        ],
    });
    let names = Configuration::default().airframe.layout.names();
    let rotors = (0..4).map(|rotor| {
        let (width, dashes) = STROKES[rotor];
        Line::new(axis(&|o| o.rotor_speed_rad_s[rotor]), ROTORS[rotor], width, dashes, names[rotor])
    });
    svg.draw(&Chart {
        place: (62.0, 350.0, 430.0, 155.0),
        x_range: (0.0, duration_s),
        y_range: (0.0, 500.0),
        x_step: 2.0,
        y_step: 100.0,
        x_title: "time, s",
        y_title: "rotor speed, rad/s",
        lines: rotors.collect(),
    });
    Ok(svg.finish())
}

/// The climb of the plant as SVG: altitude and rate of climb.
pub fn of_default_climb(duration_s: f64) -> Result<String, Failure> {
    let configuration = Configuration::default();
    let start = PlantState::hovering(&configuration.initial, &configuration.airframe);
    let inputs = PlantInputs::rotor_speeds(Commands::default().rotor_rad_s);
    let mut plant = PlantSimulation::new(&configuration, &start, &inputs)?;
    let (mut altitude, mut climb) = (Vec::new(), Vec::new());
    for point in 0..=(duration_s * 1e6) as u64 / INTERVAL_US {
        plant.advance_to(point * INTERVAL_US, &|_| inputs)?;
        let (time_s, outputs) = ((point * INTERVAL_US) as f64 * 1e-6, plant.outputs());
        altitude.push((time_s, -outputs.position_m.z));
        climb.push((time_s, -outputs.velocity_m_s.z));
    }
    let mut svg = Svg::new(640.0, 260.0);
    svg.draw(&Chart {
        place: (62.0, 20.0, 430.0, 190.0),
        x_range: (0.0, duration_s),
        y_range: (0.0, 35.0),
        x_step: 2.0,
        y_step: 5.0,
        x_title: "time, s",
        y_title: "m, m/s",
        lines: vec![
            Line::new(altitude, UP, 2.0, "none", "altitude (−z)"),
            Line::new(climb, EAST, 2.0, "9 4", "rate of climb"),
        ],
    });
    Ok(svg.finish())
}

fn fly(duration_s: f64) -> Result<Vec<Outputs>, Failure> {
    let inputs = Inputs::default();
    let mut simulation = Simulation::new(&Configuration::default(), &inputs)?;
    let mut flight = vec![simulation.outputs()];
    for point in 1..=(duration_s * 1e6) as u64 / INTERVAL_US {
        simulation.advance_to(point * INTERVAL_US, &inputs)?;
        flight.push(simulation.outputs());
    }
    Ok(flight)
}
