//! Laguerre functions against their definitions.

use lmpc::{DesignError, LaguerreBasis};
use nalgebra::{DMatrix, dmatrix};
use proptest::prelude::*;

/// (42), (43) element by element, for N = 5.
#[test]
fn matrices_are_the_papers_for_five_terms() {
    let a: f64 = 0.8187;
    let b = 1.0 - a * a;
    let basis = LaguerreBasis::new(5, a).unwrap();
    let expected = dmatrix![
        a, 0.0, 0.0, 0.0, 0.0;
        b, a, 0.0, 0.0, 0.0;
        -a * b, b, a, 0.0, 0.0;
        a.powi(2) * b, -a * b, b, a, 0.0;
        -a.powi(3) * b, a.powi(2) * b, -a * b, b, a
    ];
    assert!((basis.a_l() - expected).amax() < 1e-15);
    let initial = DMatrix::from_column_slice(5, 1, &[1.0, -a, a.powi(2), -a.powi(3), a.powi(4)]) * b.sqrt();
    assert!((basis.initial() - initial).amax() < 1e-15);
}

/// Independent route: the impulse responses of the transfer functions (38), run as difference equations.
fn impulse_responses(terms: usize, a: f64, samples: usize) -> Vec<Vec<f64>> {
    // √(1−a²)/(1 − a z⁻¹)
    let mut response: Vec<f64> = (0..samples).map(|k| (1.0 - a * a).sqrt() * a.powi(k as i32)).collect();
    let mut all = vec![response.clone()];
    for _ in 1..terms {
        // times (z⁻¹ − a)/(1 − a z⁻¹):  y(k) = a y(k−1) + u(k−1) − a u(k)
        let mut next = vec![0.0; samples];
        for k in 0..samples {
            let (y, u) = if k > 0 { (next[k - 1], response[k - 1]) } else { (0.0, 0.0) };
            next[k] = a * y + u - a * response[k];
        }
        response = next;
        all.push(response.clone());
    }
    all
}

proptest! {
    #[test]
    fn functions_are_the_impulse_responses_of_38(terms in 1usize..10, a in 0.0..0.95) {
        let basis = LaguerreBasis::new(terms, a).unwrap();
        let expected = impulse_responses(terms, a, 60);
        for k in [0, 1, 2, 17, 59] {
            let l = basis.at(k);
            for (i, response) in expected.iter().enumerate() {
                prop_assert!((l[i] - response[k]).abs() < 1e-12, "l_{}({k}) = {} and {}", i + 1, l[i], response[k]);
            }
        }
    }

    /// Σ L(k) L(k)ᵀ = I
    #[test]
    fn functions_are_orthonormal(terms in 1usize..9, a in 0.0..0.9) {
        let basis = LaguerreBasis::new(terms, a).unwrap();
        let mut sum = DMatrix::zeros(terms, terms);
        let mut l = basis.initial().clone();
        for _ in 0..2000 {
            sum += &l * l.transpose();
            l = basis.a_l() * l;
        }
        prop_assert!((sum - DMatrix::identity(terms, terms)).amax() < 1e-10);
    }

    /// The closed form of Σ L_i(k) L_j(k)ᵀ against the sum itself.
    #[test]
    fn gram_matrix_of_two_bases_is_their_sum(n in 1usize..6, m in 1usize..6, a in 0.0..0.9, b in 0.0..0.9) {
        let (one, other) = (LaguerreBasis::new(n, a).unwrap(), LaguerreBasis::new(m, b).unwrap());
        let (mut l, mut k) = (one.initial().clone(), other.initial().clone());
        let mut sum = DMatrix::zeros(n, m);
        for _ in 0..2000 {
            sum += &l * k.transpose();
            l = one.a_l() * l;
            k = other.a_l() * k;
        }
        prop_assert!((one.gram(&other).unwrap() - sum).amax() < 1e-10);
    }
}

/// Tables 2 and 3, printed to four digits. Their last digits are truncated here and there, not rounded.
#[test]
fn scale_for_a_control_horizon_is_the_papers() {
    let table_2 =
        [(10.0, 5, 0.6065), (15.0, 5, 0.7165), (20.0, 5, 0.7788), (25.0, 5, 0.8187), (50.0, 5, 0.9048)];
    let table_3 =
        [(30.0, 1, 0.9672), (30.0, 3, 0.9048), (30.0, 5, 0.8465), (30.0, 7, 0.7919), (30.0, 9, 0.7408)];
    for (control_horizon, terms, printed) in table_2.into_iter().chain(table_3) {
        let basis = LaguerreBasis::for_control_horizon(terms, control_horizon).unwrap();
        assert!(
            (basis.scale() - printed).abs() < 1e-4,
            "N = {terms}, N_c = {control_horizon}: {}",
            basis.scale()
        );
    }
}

#[test]
fn a_scale_of_zero_gives_unit_pulses() {
    let basis = LaguerreBasis::new(3, 0.0).unwrap();
    for k in 0..5 {
        let pulse: Vec<f64> = (0..3).map(|i| f64::from(i == k)).collect();
        assert_eq!(basis.at(k as usize).as_slice(), pulse, "L({k})");
    }
}

#[test]
fn wrong_bases_are_refused() {
    assert_eq!(LaguerreBasis::new(0, 0.5), Err(DesignError::NoLaguerreTerms));
    for scale in [-0.1, 1.0, 1.5, f64::NAN] {
        assert!(
            matches!(LaguerreBasis::new(3, scale), Err(DesignError::LaguerreScale { .. })),
            "a = {scale}"
        );
    }
    for horizon in [0.0, -3.0, f64::NAN, f64::INFINITY] {
        let basis = LaguerreBasis::for_control_horizon(3, horizon);
        assert!(matches!(basis, Err(DesignError::ControlHorizon { .. })), "N_c = {horizon}");
    }
}
