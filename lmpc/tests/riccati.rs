//! The Riccati solver against analytic solutions, another solver's numbers and its own equation.

use lmpc::{
    DesignError, Dlqr, riccati_residual, solve_riccati, spectral_radius, uncontrollable_eigenvalues,
    unobservable_eigenvalues,
};
use nalgebra::{DMatrix, dmatrix};
use proptest::prelude::*;

mod common;
use common::{paper_plants, relative_difference};

#[test]
fn scalar_equation_has_its_closed_form_solution() {
    // p = a²p − a²b²p²/(r + b²p) + q  ⇔  b²p² + (r − a²r − q b²) p − q r = 0
    for (a, b, q, r) in
        [(1.0, 1.0, 1.0, 1.0), (2.0, 0.1, 0.0, 3.0), (0.0, 1.0, 2.0, 1.0), (-1.5, 4.0, 1e-6, 1e3)]
    {
        let linear: f64 = r - a * a * r - q * b * b;
        let p = (-linear + (linear * linear + 4.0 * b * b * q * r).sqrt()) / (2.0 * b * b);
        let solved = solve_riccati(&dmatrix![a], &dmatrix![b], &dmatrix![q], &dmatrix![r]);
        if q == 0.0 {
            // An unstable mode without weight is undetectable: the optimum would let it go.
            assert!(matches!(solved, Err(DesignError::Undetectable { .. })), "{solved:?}");
        } else {
            assert!((solved.unwrap()[0] - p).abs() < 1e-12 * p, "a = {a}");
        }
    }
}

#[test]
fn double_integrator_has_its_closed_form_gain() {
    // x₁⁺ = x₁ + x₂, x₂⁺ = x₂ + u, Q = diag(1, 0), R = r → 0: deadbeat in two samples, K = [1 2].
    let dlqr = Dlqr::new(
        &dmatrix![1.0, 1.0; 0.0, 1.0],
        &dmatrix![0.0; 1.0],
        &dmatrix![1.0, 0.0; 0.0, 0.0],
        &dmatrix![1e-12],
        1.0,
    )
    .unwrap();
    assert!((dlqr.gain() - dmatrix![1.0, 2.0]).amax() < 1e-5);
}

/// SciPy 1.17 `solve_discrete_are`, to its printed digits.
#[test]
fn scipy_val_paper_altitude() {
    let [(_, model), ..] = paper_plants();
    let q = model.c().transpose() * model.c();
    let dlqr = Dlqr::new(model.a(), model.b(), &q, &dmatrix![1.0], 1.0).unwrap();
    let p = dmatrix![
        1205.545184325197, 326.90519287227187, 108.95257009618979;
        326.90519287227187, 124.79667715610998, 22.908441176913037;
        108.95257009618979, 22.908441176913037, 15.270075835701556
    ];
    assert!(relative_difference(dlqr.cost(), &p) < 1e-10);
    let k = dmatrix![13.331396682800518, 5.422570875624785, 0.873040633605175];
    assert!(relative_difference(dlqr.gain(), &k) < 1e-10);
}

/// SciPy 1.17 `solve_discrete_are` for a full R, a singular Q and no special structure.
#[test]
fn scipy_val_two_inputs_with_full_r() {
    let dlqr = Dlqr::new(
        &dmatrix![1.2, 0.3, 0.0; 0.0, 0.5, -1.1; 0.4, 0.0, 0.9],
        &dmatrix![1.0, 0.0; 0.0, 0.5; 0.2, -1.0],
        &dmatrix![1.0, 0.0, 0.0; 0.0, 0.0, 0.0; 0.0, 0.0, 2.0],
        &dmatrix![1.0, 0.2; 0.2, 0.5],
        1.0,
    )
    .unwrap();
    let k = dmatrix![
        0.8138079866170259, 0.23757277428406545, 0.00230141929584952;
        -0.21009399950974456, 0.05630926921067943, -0.7888630935441168
    ];
    assert!(relative_difference(dlqr.gain(), &k) < 1e-12);
}

/// A random matrix with entries in ±1.
fn matrix(rows: usize, columns: usize) -> impl Strategy<Value = DMatrix<f64>> {
    prop::collection::vec(-1.0..1.0, rows * columns)
        .prop_map(move |entries| DMatrix::from_vec(rows, columns, entries))
}

proptest! {
    /// Any solvable problem leaves a residual at rounding level, P ≥ 0 and a stable loop, also for
    /// Q = CᵀC of rank one and singular A.
    #[test]
    fn residual_vanishes_and_the_loop_is_stable(
        (n, scale, a, b, c) in (1usize..7, 0.1..3.0)
            .prop_flat_map(|(n, scale)| (Just(n), Just(scale), matrix(n, n), matrix(n, 2), matrix(1, n))),
        singular in any::<bool>(),
    ) {
        let mut a: DMatrix<f64> = a * scale;
        if singular {
            a.column_mut(0).fill(0.0);
        }
        let q = c.transpose() * &c;
        let r = DMatrix::identity(2, 2);
        match solve_riccati(&a, &b, &q, &r) {
            Ok(p) => {
                prop_assert!(riccati_residual(&a, &b, &q, &r, &p) < 1e-9);
                prop_assert!(p.clone().symmetric_eigenvalues().min() > -1e-9 * p.amax());
                let dlqr = Dlqr::new(&a, &b, &q, &r, 1.0).unwrap();
                let radius = spectral_radius("A − BK", &(&a - &b * dlqr.gain())).unwrap();
                prop_assert!(radius < 1.0 + 1e-9, "{radius}");
            }
            // Random pairs are controllable and observable with probability one, but may be close to not.
            Err(error) => {
                let weak = matches!(
                    error,
                    DesignError::Uncontrollable { .. } | DesignError::Undetectable { .. } | DesignError::Riccati { .. }
                );
                prop_assert!(weak && n > 1, "{error}");
            }
        }
    }

    /// A degree of stability keeps its promise.
    #[test]
    fn degree_of_stability_bounds_the_eigenvalues(lambda in 0.6..1.0, weight in 0.01..100.0) {
        for (name, model) in paper_plants() {
            let q = model.c().transpose() * model.c();
            let r = DMatrix::identity(model.inputs(), model.inputs()) * weight;
            let dlqr = Dlqr::new(model.a(), model.b(), &q, &r, lambda).unwrap();
            let radius = spectral_radius("A − BK", &(model.a() - model.b() * dlqr.gain())).unwrap();
            prop_assert!(radius < lambda, "{name}: {radius}");
        }
    }
}

#[test]
fn uncontrollable_and_undetectable_modes_are_found() {
    let one = dmatrix![1.0];
    // The second mode, 1.5, is cut off from the input, then from the cost.
    let a = dmatrix![0.5, 1.0; 0.0, 1.5];
    let reached = solve_riccati(&a, &dmatrix![1.0; 0.0], &DMatrix::identity(2, 2), &one);
    assert!(
        matches!(reached, Err(DesignError::Uncontrollable { re, .. }) if (re - 1.5).abs() < 1e-9),
        "{reached:?}"
    );
    let a_transposed = a.transpose();
    let seen = solve_riccati(&a_transposed, &dmatrix![1.0; 1.0], &dmatrix![1.0, 0.0; 0.0, 0.0], &one);
    assert!(matches!(seen, Err(DesignError::Undetectable { re, .. }) if (re - 1.5).abs() < 1e-9), "{seen:?}");
    // A stable mode that is cut off does no harm.
    let stable = dmatrix![1.5, 1.0; 0.0, 0.5];
    assert!(solve_riccati(&stable, &dmatrix![1.0; 0.0], &DMatrix::identity(2, 2), &one).is_ok());
    assert_eq!(uncontrollable_eigenvalues(&stable, &dmatrix![1.0; 0.0]).unwrap()[0].re, 0.5);
    assert_eq!(unobservable_eigenvalues(&stable.transpose(), &dmatrix![1.0, 0.0]).unwrap()[0].re, 0.5);
    // Integrator chains stay controllable at small sample times.
    let dt = 1e-4;
    let chain = dmatrix![1.0, dt; 0.0, 1.0];
    assert!(uncontrollable_eigenvalues(&chain, &dmatrix![0.0; dt]).unwrap().is_empty());
}

#[test]
fn wrong_weights_are_refused_by_name() {
    let (a, b) = (dmatrix![1.0, 1.0; 0.0, 1.0], dmatrix![0.0; 1.0]);
    let q = dmatrix![1.0, 0.0; 0.0, 0.0];
    let refused = |q: &DMatrix<f64>, r: f64| solve_riccati(&a, &b, q, &dmatrix![r]).unwrap_err();
    assert_eq!(refused(&q, 0.0), DesignError::NotPositiveDefinite { name: "R" });
    assert_eq!(refused(&q, -1.0), DesignError::NotPositiveDefinite { name: "R" });
    assert_eq!(refused(&q, f64::NAN), DesignError::NotFinite { name: "R" });
    assert!(matches!(refused(&(-&q), 1.0), DesignError::NotPositiveSemidefinite { name: "Q", .. }));
    assert!(matches!(
        refused(&dmatrix![1.0, 0.5; 0.0, 1.0], 1.0),
        DesignError::NotSymmetric { name: "Q", .. }
    ));
    assert!(matches!(refused(&dmatrix![1.0], 1.0), DesignError::Dimension { name: "Q", .. }));
    for lambda in [0.0, -1.0, 1.1, f64::NAN] {
        let error = Dlqr::new(&a, &b, &q, &dmatrix![1.0], lambda).unwrap_err();
        assert!(matches!(error, DesignError::Lambda { .. }), "{error}");
    }
}
