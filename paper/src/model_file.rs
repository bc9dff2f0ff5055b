//! A model and its design choices, in a TOML file.

use lmpc::{Augmented, LaguerreBasis, StateSpace, Weighting, Weights};
use nalgebra::DMatrix;
use serde::Deserialize;

use crate::design::{DesignResult, design};
use crate::error::Error;

/// ```toml
/// # z̈ = G, forward Euler, 0.05 s: the paper's altitude model (9)
/// a = [[1.0, 0.05], [0.0, 1.0]]
/// b = [[0.0], [0.05]]
/// c = [[1.0, 0.0]]
/// r = [[1.0]]              # weight of the increments
/// q = [[0, 0, 0], [0, 0, 0], [0, 0, 1]]  # weight of [Δx; y − r]; without it CᵀC
/// terms = [5]              # N of each input
/// scale = [0.8187]         # a of each input
/// prediction_horizon = 100 # N_p
/// alpha = 1.2
/// lambda = 1.0             # 1 if left out
/// weighting = "exponential" # or "terminal", "literal"; exponential if left out
/// ```
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModelFile {
    a: Vec<Vec<f64>>,
    b: Vec<Vec<f64>>,
    c: Vec<Vec<f64>>,
    q: Option<Vec<Vec<f64>>>,
    r: Vec<Vec<f64>>,
    terms: Vec<usize>,
    scale: Vec<f64>,
    prediction_horizon: usize,
    #[serde(default = "one")]
    alpha: f64,
    #[serde(default = "one")]
    lambda: f64,
    #[serde(default)]
    weighting: Recipe,
}

/// How the weights vary over the horizon; see [`Weighting`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Recipe {
    #[default]
    Exponential,
    Terminal,
    Literal,
}

fn one() -> f64 {
    1.0
}

impl ModelFile {
    /// Reads the text of a model file.
    ///
    /// # Errors
    /// [`Error::Model`] with the invalid line.
    pub fn parse(text: &str) -> Result<Self, Error> {
        toml::from_str(text).map_err(|error| Error::Model {
            name: "model file".to_owned(),
            reason: error.to_string().trim_end().to_owned(),
        })
    }

    /// Designs the controller.
    ///
    /// # Errors
    /// [`Error::Model`] for a ragged matrix or lists of different length, [`Error::Design`].
    pub fn design(&self) -> Result<DesignResult, Error> {
        let plant = StateSpace::new(matrix("a", &self.a)?, matrix("b", &self.b)?, matrix("c", &self.c)?)?;
        let model = Augmented::new(&plant);
        let q = match &self.q {
            Some(q) => matrix("q", q)?,
            None => model.c().transpose() * model.c(),
        };
        let weights = Weights::new(&model, q, matrix("r", &self.r)?)?;
        if self.terms.len() != self.scale.len() {
            let reason = format!("has {} entries; terms has {}", self.scale.len(), self.terms.len());
            return Err(Error::Model { name: "scale".to_owned(), reason });
        }
        let bases = self
            .terms
            .iter()
            .zip(&self.scale)
            .map(|(&terms, &scale)| LaguerreBasis::new(terms, scale))
            .collect::<Result<Vec<_>, _>>()?;
        let weighting = match self.weighting {
            Recipe::Exponential => Weighting::exponential(self.alpha, self.lambda),
            Recipe::Terminal => Weighting::Terminal { lambda: self.lambda },
            Recipe::Literal => Weighting::Literal { alpha: self.alpha },
        };
        Ok(design(&model, &weights, &bases, self.prediction_horizon, weighting)?)
    }
}

fn matrix(name: &str, rows: &[Vec<f64>]) -> Result<DMatrix<f64>, Error> {
    let columns = rows.first().map_or(0, Vec::len);
    if let Some(ragged) = rows.iter().position(|row| row.len() != columns) {
        let reason =
            format!("row {} has {} entries; the first has {columns}", ragged + 1, rows[ragged].len());
        return Err(Error::Model { name: name.to_owned(), reason });
    }
    Ok(DMatrix::from_fn(rows.len(), columns, |row, column| rows[row][column]))
}
