//! Solves quadratic programs that come as JSON, one per line of the standard input, and answers each with a line:
//!
//! ```text
//! {"h": [[2, 0], [0, 2]], "f": [-2, -5], "g": [[1, 2]], "bounds": [6]}
//! {"outcome":"Optimal","x":[0.8,2.6],"multipliers":[0.2],"active":[0],"iterations":1}
//! ```
//!
//! min ½ xᵀHx + fᵀx subject to G x ≤ bounds, with up to 24 unknowns.

use std::error::Error;
use std::io::{BufRead, Write, stdin, stdout};

use lmpc::{Outcome, QuadraticProgram, WarmStart};
use nalgebra::{DMatrix, SVector};
use serde::{Deserialize, Serialize};

const CAPACITY: usize = 24;
const ITERATION_LIMIT: u32 = 10_000;

#[derive(Deserialize)]
struct Problem {
    h: Vec<Vec<f64>>,
    f: Vec<f64>,
    g: Vec<Vec<f64>>,
    bounds: Vec<f64>,
}

#[derive(Serialize)]
struct Answer {
    outcome: Outcome,
    x: Vec<f64>,
    /// Of the active constraints, in their order.
    multipliers: Vec<f64>,
    active: Vec<usize>,
    iterations: u32,
}

fn matrix(rows: &[Vec<f64>], columns: usize) -> Result<DMatrix<f64>, Box<dyn Error>> {
    if rows.iter().any(|row| row.len() != columns) {
        return Err(format!("a row does not have {columns} numbers").into());
    }
    Ok(DMatrix::from_row_iterator(rows.len(), columns, rows.iter().flatten().copied()))
}

fn solve(problem: &Problem) -> Result<Answer, Box<dyn Error>> {
    let unknowns = problem.f.len();
    let (h, g) = (matrix(&problem.h, unknowns)?, matrix(&problem.g, unknowns)?);
    let program = QuadraticProgram::<CAPACITY>::new(&h, &g)?;
    let mut f = SVector::<f64, CAPACITY>::zeros();
    f.rows_mut(0, unknowns).copy_from_slice(&problem.f);
    let mut warm_start = WarmStart::default();
    let solution = program.solve(&f, &problem.bounds, &mut warm_start, ITERATION_LIMIT);
    Ok(Answer {
        outcome: solution.outcome,
        x: solution.x.iter().take(unknowns).copied().collect(),
        multipliers: solution.multipliers.iter().take(solution.active).copied().collect(),
        active: warm_start.constraints().collect(),
        iterations: solution.iterations,
    })
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut out = stdout().lock();
    for line in stdin().lock().lines() {
        let answer = solve(&serde_json::from_str(&line?)?)?;
        writeln!(out, "{}", serde_json::to_string(&answer)?)?;
    }
    Ok(())
}
