//! Discrete Laguerre functions.

use alloc::vec::Vec;

use nalgebra::{DMatrix, DVector};

use crate::DesignError;
use crate::stein::solve_stein;

/// N discrete Laguerre functions with scaling factor a, (38)–(43): l₁(k) … l_N(k), orthonormal over
/// k = 0, 1, 2, …
///
/// With a = 0 the functions are unit pulses and LMPC is the classical MPC with control horizon N.
#[derive(Clone, Debug, PartialEq)]
pub struct LaguerreBasis {
    scale: f64,
    a_l: DMatrix<f64>,
    initial: DVector<f64>,
}

impl LaguerreBasis {
    /// N = `terms` functions with scaling factor a = `scale`.
    ///
    /// # Errors
    /// [`DesignError::NoLaguerreTerms`], [`DesignError::LaguerreScale`] unless 0 ≤ a < 1.
    pub fn new(terms: usize, scale: f64) -> Result<Self, DesignError> {
        if terms == 0 {
            return Err(DesignError::NoLaguerreTerms);
        }
        if !(0.0..1.0).contains(&scale) {
            return Err(DesignError::LaguerreScale { value: scale });
        }
        let a = scale;
        let beta = 1.0 - a * a;

        // (42): a on the diagonal, (−a)^(i−j−1) β below it
        let a_l = DMatrix::from_fn(terms, terms, |i, j| match i.cmp(&j) {
            core::cmp::Ordering::Less => 0.0,
            core::cmp::Ordering::Equal => a,
            core::cmp::Ordering::Greater => power(-a, i - j - 1) * beta,
        });
        // (41), (43): L(0) = √β [1, −a, a², …]ᵀ
        let initial = DVector::from_fn(terms, |i, _| libm::sqrt(beta) * power(-a, i));

        Ok(Self { scale, a_l, initial })
    }

    /// N = `terms` functions that reach about `control_horizon` samples far: a ≈ e^(−N/N_c) (58).
    ///
    /// # Errors
    /// [`DesignError::ControlHorizon`] unless it is positive and finite, and those of
    /// [`LaguerreBasis::new`].
    pub fn for_control_horizon(terms: usize, control_horizon: f64) -> Result<Self, DesignError> {
        if !(control_horizon > 0.0 && control_horizon.is_finite()) {
            return Err(DesignError::ControlHorizon { value: control_horizon });
        }
        Self::new(terms, libm::exp(-(terms as f64) / control_horizon))
    }

    /// N, the number of functions.
    pub fn terms(&self) -> usize {
        self.initial.len()
    }

    /// a, the scaling factor.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// A_l of (40) and (42), N×N: L(k+1) = A_l L(k).
    pub fn a_l(&self) -> &DMatrix<f64> {
        &self.a_l
    }

    /// L(0) of (41) and (43).
    pub fn initial(&self) -> &DVector<f64> {
        &self.initial
    }

    /// L(k) = A_lᵏ L(0), (40).
    pub fn at(&self, k: usize) -> DVector<f64> {
        let mut l = self.initial.clone();
        for _ in 0..k {
            l = &self.a_l * l;
        }
        l
    }

    /// Σ L_i(k) L_j(k)ᵀ over all k ≥ 0, N_i×N_j: the identity when both are the same basis.
    ///
    /// # Errors
    /// [`DesignError::NotFinite`] when rounding keeps the sum from converging.
    pub fn gram(&self, other: &Self) -> Result<DMatrix<f64>, DesignError> {
        if self == other {
            return Ok(DMatrix::identity(self.terms(), self.terms()));
        }
        let first = &self.initial * other.initial.transpose();
        // Both A_l have all their eigenvalues at a < 1, so the sum converges.
        solve_stein(&self.a_l, &other.a_l, &first)
            .ok_or(DesignError::NotFinite { name: "the sum of products of two Laguerre bases" })
    }
}

fn power(base: f64, exponent: usize) -> f64 {
    (0..exponent).fold(1.0, |product, _| product * base)
}

/// The block row L(m)ᵀ for several inputs: Δu(k+m) = L(m)ᵀ η with each input's functions in its own
/// row and columns, p×ΣN.
#[derive(Clone, Debug)]
pub(crate) struct InputBasis<'a> {
    bases: &'a [LaguerreBasis],
    current: Vec<DVector<f64>>,
}

impl<'a> InputBasis<'a> {
    pub(crate) fn new(bases: &'a [LaguerreBasis]) -> Self {
        Self { bases, current: bases.iter().map(|basis| basis.initial.clone()).collect() }
    }

    pub(crate) fn terms(&self) -> usize {
        self.bases.iter().map(LaguerreBasis::terms).sum()
    }

    /// L(m)ᵀ at the present m.
    pub(crate) fn row(&self) -> DMatrix<f64> {
        let mut row = DMatrix::zeros(self.bases.len(), self.terms());
        let mut offset = 0;
        for (input, l) in self.current.iter().enumerate() {
            row.view_mut((input, offset), (1, l.len())).copy_from(&l.transpose());
            offset += l.len();
        }
        row
    }

    /// m → m + 1.
    pub(crate) fn advance(&mut self) {
        for (basis, l) in self.bases.iter().zip(&mut self.current) {
            *l = &basis.a_l * &*l;
        }
    }
}
