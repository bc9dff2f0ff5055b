//! Exact derivatives: the plant's equations hold for any [`real::Real`], and with [`dual::Dual`] they carry a derivative.

pub(crate) mod dual;
pub(crate) mod real;
pub(crate) mod seed;
