//! The parameters: those of the configuration.

use fmi::variables::Variable;
use quadrotor::Configuration;

use super::ClosedLoop;
use crate::tables::parameters::{Selection, table};

const ALL: Selection = Selection { of: &[""], without: &[] };
const COUNT: usize = ALL.count::<Configuration>();

/// One variable for each number and switch of the configuration.
pub(super) const TABLE: [Variable<ClosedLoop>; COUNT] = table(ALL);
