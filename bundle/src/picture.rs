//! A picture of the default flight, flown by the engine when the FMU is built.

use quadrotor::{Configuration, Inputs, Outputs, Simulation};

use crate::chart::{Chart, Line, Svg};
use crate::failure::Failure;

/// End of the flight, s.
const DURATION_S: u64 = 12;
/// Time between two points of a line, µs.
const INTERVAL_US: u64 = 50_000;

const NORTH: &str = "#0072b2";
const EAST: &str = "#d55e00";
const UP: &str = "#009e73";
const ROTORS: [&str; 4] = ["#0072b2", "#d55e00", "#56b4e9", "#e69f00"];

/// The flight as SVG: position over time against its reference, and rotor speeds.
pub fn of_default_flight() -> Result<String, Failure> {
    let flight = fly()?;
    let axis = |of: &dyn Fn(&Outputs) -> f64| -> Vec<(f64, f64)> {
        flight.iter().map(|outputs| (outputs.time_us as f64 * 1e-6, of(outputs))).collect()
    };
    let duration = DURATION_S as f64;
    let mut svg = Svg::new(760.0, 520.0);
    svg.draw(&Chart {
        place: (60.0, 20.0, 560.0, 270.0),
        x_range: (0.0, duration),
        y_range: (0.0, 11.0),
        x_step: 2.0,
        y_step: 2.0,
        x_title: "",
        y_title: "position, m",
        lines: vec![
            // North and east are the same in this flight: the one below is wider.
            Line::solid(axis(&|o| o.position_m.x), NORTH, 5.0, "north"),
            Line::solid(axis(&|o| o.position_m.y), EAST, 2.0, "east"),
            Line::solid(axis(&|o| -o.position_m.z), UP, 2.0, "up (−z)"),
            Line::dashed(axis(&|o| o.setpoint.position_m.x)),
            Line::dashed(axis(&|o| -o.setpoint.position_m.z)),
        ],
    });
    let names = Configuration::default().airframe.layout.names();
    let rotors = (0..4)
        .map(|rotor| Line::solid(axis(&|o| o.rotor_speed_rad_s[rotor]), ROTORS[rotor], 1.6, names[rotor]));
    svg.draw(&Chart {
        place: (60.0, 320.0, 560.0, 140.0),
        x_range: (0.0, duration),
        y_range: (0.0, 500.0),
        x_step: 2.0,
        y_step: 100.0,
        x_title: "time, s",
        y_title: "rotor speed, rad/s",
        lines: rotors.collect(),
    });
    Ok(svg.finish())
}

fn fly() -> Result<Vec<Outputs>, Failure> {
    let inputs = Inputs::default();
    let mut simulation = Simulation::new(&Configuration::default(), &inputs)?;
    let mut flight = vec![simulation.outputs()];
    for point in 1..=DURATION_S * 1_000_000 / INTERVAL_US {
        simulation.advance_to(point * INTERVAL_US, &inputs)?;
        flight.push(simulation.outputs());
    }
    Ok(flight)
}
