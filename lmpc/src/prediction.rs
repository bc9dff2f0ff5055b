//! The prediction of the state as a function of the Laguerre coefficients η, and its cost.

use nalgebra::DMatrix;

use crate::laguerre::InputBasis;
use crate::validate::{self, symmetrized};
use crate::{DesignError, LaguerreBasis};

/// The quadratic cost J = ηᵀΩη + 2ηᵀΨx + const of (48)–(50), over a horizon of N_p samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Prediction {
    omega: DMatrix<f64>,
    psi: DMatrix<f64>,
}

impl Prediction {
    /// For x(k+1) = A x + B Δu with one Laguerre basis per input, stage weights Q and R, and the weight
    /// `terminal` instead of Q on the state at N_p = `horizon` if there is one.
    ///
    /// With a terminal weight the moves are charged up to N_p, beyond which the terminal weight stands
    /// for them; without one they are charged over all time, which by orthonormality is R_L = R ⊗ I.
    ///
    /// # Errors
    /// [`DesignError::Dimension`], [`DesignError::ElementNotFinite`], [`DesignError::BasisCount`],
    /// [`DesignError::HorizonTooShort`].
    pub fn new(
        a: &DMatrix<f64>,
        b: &DMatrix<f64>,
        q: &DMatrix<f64>,
        r: &DMatrix<f64>,
        bases: &[LaguerreBasis],
        horizon: usize,
        terminal: Option<&DMatrix<f64>>,
    ) -> Result<Self, DesignError> {
        let (states, inputs) = (a.nrows(), b.ncols());
        validate::shape("A", a, (states, states))?;
        validate::shape("B", b, (states, inputs))?;
        validate::shape("Q", q, (states, states))?;
        validate::shape("R", r, (inputs, inputs))?;
        if let Some(p) = terminal {
            validate::shape("P", p, (states, states))?;
        }
        check_horizon(inputs, bases, horizon)?;

        let mut input_basis = InputBasis::new(bases);
        let terms = input_basis.terms();
        let mut phi_t = DMatrix::zeros(states, terms);
        let mut a_m = DMatrix::identity(states, states);
        let mut omega = if terminal.is_none() { moves_cost(bases, r)? } else { DMatrix::zeros(terms, terms) };
        let mut psi = DMatrix::zeros(terms, states);
        for m in 1..=horizon {
            let l_t = input_basis.row();
            if terminal.is_some() {
                omega += l_t.transpose() * r * &l_t;
            }
            // φ(m)ᵀ = A φ(m−1)ᵀ + B L(m−1)ᵀ: the sum of (46), term by term
            phi_t = a * phi_t + b * l_t;
            a_m = a * a_m;
            let weight = terminal.filter(|_| m == horizon).unwrap_or(q);
            // Ω = Σ φ(m) Q φ(m)ᵀ + R_L,  Ψ = Σ φ(m) Q Aᵐ   (50)
            let phi_q = phi_t.transpose() * weight;
            omega += &phi_q * &phi_t;
            psi += phi_q * &a_m;
            input_basis.advance();
        }
        validate::finite("Ω", &omega)?;
        validate::finite("Ψ", &psi)?;
        Ok(Self { omega: symmetrized(&omega), psi })
    }

    /// Ω, ΣN×ΣN, symmetric.
    pub fn omega(&self) -> &DMatrix<f64> {
        &self.omega
    }

    /// Ψ, ΣN×(n+q).
    pub fn psi(&self) -> &DMatrix<f64> {
        &self.psi
    }
}

fn check_horizon(inputs: usize, bases: &[LaguerreBasis], horizon: usize) -> Result<(), DesignError> {
    if bases.len() != inputs {
        return Err(DesignError::BasisCount { expected: inputs, actual: bases.len() });
    }
    let terms = bases.iter().map(LaguerreBasis::terms).max().unwrap_or(0);
    if horizon < terms {
        return Err(DesignError::HorizonTooShort { horizon, terms });
    }
    Ok(())
}

/// R_L = Σ L(m) R L(m)ᵀ over all m ≥ 0: block (i, j) is R_ij Σ L_i(m) L_j(m)ᵀ.
fn moves_cost(bases: &[LaguerreBasis], r: &DMatrix<f64>) -> Result<DMatrix<f64>, DesignError> {
    let terms = bases.iter().map(LaguerreBasis::terms).sum();
    let mut cost = DMatrix::zeros(terms, terms);
    let mut row = 0;
    for (i, basis_i) in bases.iter().enumerate() {
        let mut column = 0;
        for (j, basis_j) in bases.iter().enumerate() {
            if r[(i, j)] != 0.0 {
                let block = basis_i.gram(basis_j)? * r[(i, j)];
                cost.view_mut((row, column), block.shape()).copy_from(&block);
            }
            column += basis_j.terms();
        }
        row += basis_i.terms();
    }
    Ok(cost)
}
