//! Printed numbers of others. With a = 0 the Laguerre functions are unit pulses and LMPC is the classical
//! increment-based MPC with control horizon N, so that its examples apply.
//!
//! The examples of Wang 2009, "Model Predictive Control System Design and Implementation Using MATLAB", with
//! a ≠ 0 (chapters 3 and 4) are printed as plots; the data of one of them stands at the end with the numbers of an
//! independent NumPy computation.

use lmpc::{
    Augmented, Dlqr, LaguerreBasis, LmpcDesign, Prediction, StateSpace, Weighting, Weights, eigenvalues,
};
use nalgebra::{DMatrix, dmatrix};

/// Wang 2009, examples 1.2 and 1.5: x⁺ = 0.8 x + 0.1 u, y = x, N_p = 10, N_c = 4.
fn prediction(weight: f64) -> (Augmented, Prediction) {
    let model = Augmented::new(&StateSpace::new(dmatrix![0.8], dmatrix![0.1], dmatrix![1.0]).unwrap());
    let q = model.c().transpose() * model.c();
    let pulses = [LaguerreBasis::new(4, 0.0).unwrap()];
    let prediction = Prediction::new(model.a(), model.b(), &q, &dmatrix![weight], &pulses, 10, None).unwrap();
    (model, prediction)
}

#[test]
fn wang_val_prediction_matrices() {
    let (_, prediction) = prediction(0.0);
    // ΦᵀΦ and ΦᵀF, to four printed digits.
    let omega = dmatrix![
        1.1541, 1.0407, 0.9116, 0.7726;
        1.0407, 0.9549, 0.8475, 0.7259;
        0.9116, 0.8475, 0.7675, 0.6674;
        0.7726, 0.7259, 0.6674, 0.5943
    ];
    let psi = dmatrix![9.2325, 3.2147; 8.3259, 2.7684; 7.2927, 2.3355; 6.1811, 1.9194];
    assert!((prediction.omega() - omega).amax() < 5.1e-5);
    assert!((prediction.psi() - psi).amax() < 5.1e-5);
}

/// K = first row of (ΦᵀΦ + r I)⁻¹ ΦᵀF and the closed-loop eigenvalues, with and without weight on the moves.
#[test]
fn wang_val_gains_and_closed_loop_eigenvalues() {
    let gain = |prediction: &Prediction| -> DMatrix<f64> {
        prediction.omega().clone().lu().solve(prediction.psi()).unwrap().rows(0, 1).into_owned()
    };
    let (model, unweighted) = prediction(0.0);
    let k = gain(&unweighted);
    assert!((&k - dmatrix![8.0, 10.0]).amax() < 1e-3, "{k}");
    for eigenvalue in eigenvalues("A − BK", &(model.a() - model.b() * k)).unwrap() {
        assert!(eigenvalue.re.hypot(eigenvalue.im) < 1e-5, "deadbeat: {eigenvalue}");
    }

    let (model, weighted) = prediction(10.0);
    let k = gain(&weighted);
    assert!((&k - dmatrix![0.6939, 0.2453]).amax() < 5.1e-5, "{k}");
    for eigenvalue in eigenvalues("A − BK", &(model.a() - model.b() * k)).unwrap() {
        assert!((eigenvalue.re - 0.8530).abs() < 5.1e-5, "{eigenvalue}");
        assert!((eigenvalue.im.abs() - 0.0542).abs() < 5.1e-5, "{eigenvalue}");
    }
}

/// A generalised predictive controller with dead time, y(k) = 0.8 y(k−1) + 0.4 u(k−2), N_p = 4, one move, weight
/// 0.1: figures of the worked homework that the repository billtubbs/mpc-code tests itself against.
#[test]
fn gpc_val_dead_time() {
    let plant =
        StateSpace::new(dmatrix![0.8, 0.4; 0.0, 0.0], dmatrix![0.0; 1.0], dmatrix![1.0, 0.0]).unwrap();
    let model = Augmented::new(&plant);
    let q = model.c().transpose() * model.c();
    let pulse = [LaguerreBasis::new(1, 0.0).unwrap()];
    let prediction = Prediction::new(model.a(), model.b(), &q, &dmatrix![0.1], &pulse, 4, None).unwrap();
    assert!((prediction.omega()[0] - (0.1 + 1.63098)).abs() < 5.1e-6);
    // Ψ on [Δy, Δu(k−1), y]: coefficients of y(k−1), Δu(k−1) and of y(k), which holds the first and the last.
    let psi = prediction.psi();
    assert!((psi[0] - 4.2864).abs() < 5.1e-5);
    assert!((psi[1] - 2.1432).abs() < 5.1e-5);
    assert!((psi[0] + psi[2] - 6.3824).abs() < 5.1e-5);
}

/// The example of Altair Compose's help page of `dlqr`.
#[test]
fn compose_val_dlqr() {
    let (a, b) = (dmatrix![9.0, 0.2; 0.0, 8.0], dmatrix![0.0; 1.0]);
    let dlqr = Dlqr::new(&a, &b, &dmatrix![2.0, 1.0; 1.0, 2.0], &dmatrix![1.0], 1.0).unwrap();
    let k = dlqr.gain();
    assert!((k[0] - 394.61003).abs() < 1e-5 && (k[1] - 16.76761).abs() < 1e-5, "{k}");
    let p = dlqr.cost();
    assert!((p[(0, 0)] / 1.04036e7 - 1.0).abs() < 1e-5 && (p[(0, 1)] / 2.34349e5 - 1.0).abs() < 1e-5);
    assert!((p[(1, 1)] / 5.34387e3 - 1.0).abs() < 1e-5);
    let mut poles: Vec<f64> =
        eigenvalues("A − BK", &(&a - &b * k)).unwrap().iter().map(|pole| pole.re).collect();
    poles.sort_by(f64::total_cmp);
    assert!((poles[0] - 0.11073).abs() < 5.1e-6 && (poles[1] - 0.12166).abs() < 5.1e-6, "{poles:?}");
}

/// Wang 2009, examples 3.2 to 3.4: x⁺ = 0.8 x + 0.6 u, a = 0.6, N_p = 16. The book plots the trajectories; the
/// gains are an independent NumPy computation's.
#[test]
fn numpy_val_wangs_laguerre_example() {
    let model = Augmented::new(&StateSpace::new(dmatrix![0.8], dmatrix![0.6], dmatrix![1.0]).unwrap());
    for (weight, terms, k) in [
        (1.0, 1, [0.57895431, 0.17022587]),
        (1.0, 2, [0.85299554, 0.45986031]),
        (1.0, 3, [0.87596305, 0.61063832]),
        (1.0, 4, [0.84279511, 0.61949005]),
        (1.0, 5, [0.83512598, 0.61270565]),
        (0.1, 5, [1.15541440, 1.14853836]),
    ] {
        let weights = Weights::output(&model, 1.0, weight).unwrap();
        let basis = [LaguerreBasis::new(terms, 0.6).unwrap()];
        let design =
            LmpcDesign::new(&model, &weights, &basis, 16, Weighting::Literal { alpha: 1.0 }).unwrap();
        let expected = DMatrix::from_row_slice(1, 2, &k);
        assert!((design.gain() - expected).amax() < 1e-8, "R = {weight}, N = {terms}: {}", design.gain());
    }
}
