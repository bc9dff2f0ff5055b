//! The Riccati solver against analytic solutions, another solver's numbers and its own equation.

use lmpc::{
    DesignError, Dlqr, riccati_residual, solve_riccati, spectral_radius, uncontrollable_eigenvalues,
    unobservable_eigenvalues,
};
use nalgebra::{DMatrix, dmatrix};
use proptest::prelude::*;

use crate::common::{paper_plants, relative_difference};

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

/// (54) for α > 1 as SciPy 1.17 has it: `solve_discrete_are(A/α, B/α, Q, R)`, and K_w from it. α = 1.2 leaves the paper's
/// altitude unstable: its largest eigenvalue is between 1 and α.
#[test]
fn scipy_val_exponential_weighting() {
    let [(_, model), ..] = paper_plants();
    let q = model.c().transpose() * model.c();
    for (alpha, p, k, radius) in [
        (
            1.2,
            dmatrix![
                40.526670599121374, 9.237364570616094, 7.376337036985669;
                9.237364570616094, 2.66368878415497, 1.1945399841973516;
                7.376337036985669, 1.1945399841973516, 3.2671229585371124
            ],
            dmatrix![0.36055155203300165, 0.11009102778120823, 0.04128615661740345],
            1.019021777981837,
        ),
        (
            1.02,
            dmatrix![
                825.6073852687264, 243.36171098121784, 76.60345572407937;
                243.36171098121784, 99.37906756576879, 17.090355222845382;
                76.60345572407937, 17.090355222845382, 11.728884395918566
            ],
            dmatrix![10.104067085889145, 4.36054910083541, 0.6630091218320759],
            0.9524969868274412,
        ),
    ] {
        let dlqr = Dlqr::exponentially_weighted(model.a(), model.b(), &q, &dmatrix![1.0], alpha).unwrap();
        assert!(relative_difference(dlqr.cost(), &p) < 1e-10, "α = {alpha}");
        assert!(relative_difference(dlqr.gain(), &k) < 1e-10, "α = {alpha}");
        let found = spectral_radius("A − BK", &(model.a() - model.b() * dlqr.gain())).unwrap();
        assert!((found - radius).abs() < 1e-9, "α = {alpha}: {found}");
        assert_eq!(dlqr.radius(), alpha);
    }
    let dlqr = Dlqr::exponentially_weighted(
        &dmatrix![1.2, 0.3, 0.0; 0.0, 0.5, -1.1; 0.4, 0.0, 0.9],
        &dmatrix![1.0, 0.0; 0.0, 0.5; 0.2, -1.0],
        &dmatrix![1.0, 0.0, 0.0; 0.0, 0.0, 0.0; 0.0, 0.0, 2.0],
        &dmatrix![1.0, 0.2; 0.2, 0.5],
        1.5,
    )
    .unwrap();
    let k = dmatrix![
        0.5355128788919987, 0.1412717729945747, 0.07024866279766297;
        -0.24405591226776088, 0.01646290248958202, -0.6251590638180076
    ];
    assert!(relative_difference(dlqr.gain(), &k) < 1e-12);
}

/// A mode inside the circle of radius α may be out of reach, one outside must not.
#[test]
fn exponential_weighting_asks_for_modes_beyond_alpha_alone() {
    let (b, q, r) = (dmatrix![1.0; 0.0], DMatrix::identity(2, 2), dmatrix![1.0]);
    let weighted = |mode: f64| Dlqr::exponentially_weighted(&dmatrix![0.5, 1.0; 0.0, mode], &b, &q, &r, 1.2);
    assert!(weighted(1.1).is_ok());
    assert!(matches!(weighted(1.3), Err(DesignError::Uncontrollable { .. })), "{:?}", weighted(1.3));
    for alpha in [0.99, 0.0, f64::NAN, f64::INFINITY] {
        let error = Dlqr::exponentially_weighted(&q, &b, &q, &r, alpha).unwrap_err();
        assert!(matches!(error, DesignError::Alpha { .. }), "{error}");
    }
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

proptest! {
    /// (57): |λ| < α, and of the transformed loop (55) |λ| < 1.
    #[test]
    fn exponential_weighting_bounds_the_eigenvalues_by_alpha(alpha in 1.0..1.5, weight in 0.01..100.0) {
        for (name, model) in paper_plants() {
            let q = model.c().transpose() * model.c();
            let r = DMatrix::identity(model.inputs(), model.inputs()) * weight;
            let dlqr = Dlqr::exponentially_weighted(model.a(), model.b(), &q, &r, alpha).unwrap();
            let closed = model.a() - model.b() * dlqr.gain();
            let radius = spectral_radius("A − BK", &closed).unwrap();
            prop_assert!(radius < alpha, "{name}: {radius}");
            prop_assert!(spectral_radius("(A − BK)/α", &(closed / alpha)).unwrap() < 1.0);
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
    assert_eq!(refused(&q, 0.0), DesignError::NotPositiveDefinite { name: "R", eigenvalue: 0.0 });
    assert_eq!(refused(&q, -1.0), DesignError::NotPositiveDefinite { name: "R", eigenvalue: -1.0 });
    assert_eq!(
        refused(&q, f64::NAN).to_string(),
        "R contains a value that is not finite: element (0, 0) is NaN"
    );
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
