//! The loops of the cascade with the controllers that fly.

use lmpc::{PosedProgram, StabilizedMpc};
use quadrotor::{Configuration, HoverLoops, LinearLoop};
use recording::{ONE, TWO};

use crate::Failure;
use crate::flight::{Moment, fly};
use crate::program::{PosedSample, Program};

/// Names of the loops.
pub const NAMES: [&str; 4] = ["position", "altitude", "roll and pitch", "yaw"];

/// A loop with its controller.
pub struct Shipped<const N: usize, const P: usize, const E: usize> {
    /// "position".
    pub name: &'static str,
    /// Model, weights, limits, default design.
    pub linear: LinearLoop,
    /// The controller.
    pub law: StabilizedMpc<N, P, P, E>,
    /// Its program as matrices.
    pub posed: PosedProgram,
}

/// All of them.
pub struct Loops {
    /// North and east.
    pub position: Shipped<12, 2, TWO>,
    /// Down.
    pub altitude: Shipped<3, 1, ONE>,
    /// Roll and pitch.
    pub lean: Shipped<6, 2, TWO>,
    /// Yaw.
    pub turn: Shipped<3, 1, ONE>,
}

impl Loops {
    /// Of the default configuration.
    ///
    /// # Errors
    /// When a loop cannot be designed.
    pub fn new() -> Result<Self, Failure> {
        let loops = HoverLoops::new(&Configuration::default())?;
        Ok(Self {
            position: Shipped::new(NAMES[0], LinearLoop::new(&loops.position)?)?,
            altitude: Shipped::new(NAMES[1], LinearLoop::new(&loops.altitude)?)?,
            lean: Shipped::new(NAMES[2], LinearLoop::new(&loops.lean)?)?,
            turn: Shipped::new(NAMES[3], LinearLoop::new(&loops.turn)?)?,
        })
    }
}

impl<const N: usize, const P: usize, const E: usize> Shipped<N, P, E> {
    fn new(name: &'static str, linear: LinearLoop) -> Result<Self, Failure> {
        let design = linear.design(linear.terms, linear.scale)?;
        let law = StabilizedMpc::new(&design, &linear.limits, linear.slack_cost)?;
        let posed = PosedProgram::new(&design, &linear.limits, linear.slack_cost)?;
        Ok(Self { name, linear, law, posed })
    }

    /// Its flights.
    pub fn flights(&self, quick: bool) -> Vec<Moment<N, P, E>> {
        let (flights, legs) = if quick { (2, 3) } else { (10, 4) };
        fly(&self.linear, &self.law, flights, legs)
    }

    /// Its program at some moments.
    pub fn program(&self, moments: &[Moment<N, P, E>]) -> Program {
        let left = self.posed.left();
        Program {
            name: self.name.to_owned(),
            unknowns: left.ncols(),
            rows: left.nrows(),
            left: left.transpose().as_slice().to_vec(),
            samples: moments.iter().map(|moment| self.posed_sample(moment)).collect(),
        }
    }

    /// Its program at a moment.
    pub fn posed_sample(&self, moment: &Moment<N, P, E>) -> PosedSample {
        let sample = moment.sample(&self.linear.upper);
        let (start, upper) = self.posed.at(&sample, &moment.before.feedback());
        PosedSample {
            flight: moment.flight,
            gradient: (-start).as_slice().to_vec(),
            upper: upper.as_slice().to_vec(),
        }
    }
}

#[cfg(test)]
mod tests {
    use lmpc::Controller;
    use nalgebra::DVector;

    use super::{Loops, Shipped};
    use crate::reference::solutions;

    /// What the peers are given is what the controller solves: the reference's first move is the controller's, at limits and off them.
    fn agrees<const N: usize, const P: usize, const E: usize>(shipped: &Shipped<N, P, E>) {
        let moments: Vec<_> = shipped.flights(true).into_iter().step_by(5).collect();
        let program = shipped.program(&moments);
        let mut limited = 0;
        for (moment, solution) in moments.iter().zip(solutions(&program).unwrap()) {
            let Some(z) = solution else { continue };
            let sample = moment.sample(&shipped.linear.upper);
            let step = shipped.law.step(&mut moment.forgetful(), &sample);
            let expected = shipped.posed.increment(&sample, &DVector::from_vec(z));
            let size = 1.0 + expected.norm();
            assert!(
                (step.increment - expected).norm() < 1e-4 * size,
                "{}: {step:?} {expected}",
                shipped.name
            );
            limited += usize::from(step.active > 0);
        }
        assert!(limited >= 5, "{}: only {limited} samples at a limit", shipped.name);
    }

    #[test]
    fn the_programs_are_those_that_fly() {
        let loops = Loops::new().unwrap();
        agrees(&loops.position);
        agrees(&loops.altitude);
        agrees(&loops.lean);
        agrees(&loops.turn);
    }
}
