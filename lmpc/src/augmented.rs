//! The incremental ("velocity form") model with integral action.

use nalgebra::DMatrix;

use crate::StateSpace;

/// The augmented model (36): x(k+1) = A x(k) + B Δu(k), y(k) = C x(k) with x = \[Δx_m; y\].
///
/// The set-point enters as y − r in the last q entries of x (Wang 2009, chapter 3), which makes every
/// controller designed on this model integrate the output error.
#[derive(Clone, Debug, PartialEq)]
pub struct Augmented {
    a: DMatrix<f64>,
    b: DMatrix<f64>,
    c: DMatrix<f64>,
    plant: StateSpace,
}

impl Augmented {
    /// Augments a plant of n states, p inputs and q outputs to n+q states.
    pub fn new(plant: &StateSpace) -> Self {
        let (n, p, q) = (plant.states(), plant.inputs(), plant.outputs());
        let (a_m, b_m, c_m) = (plant.a(), plant.b(), plant.c());

        // A = [A_m      0]   B = [B_m    ]   C = [0 I]
        //     [C_m A_m  I]       [C_m B_m]
        let mut a = DMatrix::identity(n + q, n + q);
        a.view_mut((0, 0), (n, n)).copy_from(a_m);
        a.view_mut((n, 0), (q, n)).copy_from(&(c_m * a_m));

        let mut b = DMatrix::zeros(n + q, p);
        b.view_mut((0, 0), (n, p)).copy_from(b_m);
        b.view_mut((n, 0), (q, p)).copy_from(&(c_m * b_m));

        let mut c = DMatrix::zeros(q, n + q);
        c.view_mut((0, n), (q, q)).fill_with_identity();

        Self { a, b, c, plant: plant.clone() }
    }

    /// A, (n+q)×(n+q).
    pub fn a(&self) -> &DMatrix<f64> {
        &self.a
    }

    /// B, (n+q)×p.
    pub fn b(&self) -> &DMatrix<f64> {
        &self.b
    }

    /// C, q×(n+q).
    pub fn c(&self) -> &DMatrix<f64> {
        &self.c
    }

    /// The plant it was made from.
    pub fn plant(&self) -> &StateSpace {
        &self.plant
    }

    /// Number of augmented states n+q.
    pub fn states(&self) -> usize {
        self.a.nrows()
    }

    /// Number of inputs p.
    pub fn inputs(&self) -> usize {
        self.b.ncols()
    }
}
