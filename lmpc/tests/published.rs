//! Numbers printed in Wang 2009, "Model Predictive Control System Design and Implementation Using MATLAB",
//! chapter 1. With a = 0 the Laguerre functions are unit pulses and LMPC is the classical MPC with
//! control horizon N, so that its examples apply.

use lmpc::{Augmented, LaguerreBasis, Prediction, StateSpace, eigenvalues};
use nalgebra::{DMatrix, dmatrix};

/// Examples 1.1 to 1.3: x⁺ = 0.8 x + 0.1 u, y = x, N_p = 10, N_c = 4.
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
