//! The Kalman predictor against a closed form, another solver's numbers and simulated noise.

use lmpc::{
    DesignError, Discretization, KalmanDesign, KalmanPredictor, NoiseCovariance, StateSpace, spectral_radius,
};
use nalgebra::{DMatrix, SVector, Vector1, Vector2, dmatrix};
use proptest::prelude::*;
use rand::{RngExt, SeedableRng, rngs::StdRng};

use crate::common::double_integrators;

const TIME: f64 = 0.05;

fn plant() -> StateSpace {
    double_integrators(&[1.0], TIME, Discretization::ZeroOrderHold)
}

fn noise() -> NoiseCovariance {
    NoiseCovariance {
        state: dmatrix![1e-6, 2e-6; 2e-6, 4e-3],
        measurement: dmatrix![2.5e-3],
        cross: dmatrix![1e-6; 5e-4],
    }
}

#[test]
fn scalar_predictor_has_its_closed_form() {
    // p = a²p + w − a²p²c²/(c²p + v): c²p² + (v − a²v − w c²) p − w v = 0
    let (a, c, w, v): (f64, f64, f64, f64) = (1.1, 0.7, 0.3, 2.0);
    let linear = v - a * a * v - w * c * c;
    let p = (-linear + (linear * linear + 4.0 * c * c * w * v).sqrt()) / (2.0 * c * c);
    let plant = StateSpace::new(dmatrix![a], dmatrix![1.0], dmatrix![c]).unwrap();
    let design = KalmanDesign::new(&plant, &NoiseCovariance::uncorrelated(dmatrix![w], dmatrix![v])).unwrap();
    assert!((design.covariance()[0] - p).abs() < 1e-12);
    assert!((design.gain()[0] - a * p * c / (c * c * p + v)).abs() < 1e-12);
}

/// SciPy 1.17 `solve_discrete_are` with the cross covariance as its `s`.
#[test]
fn scipy_val_with_cross_covariance() {
    let design = KalmanDesign::new(&plant(), &noise()).unwrap();
    let p = dmatrix![0.00100154798292959, 0.0032424847269853; 0.0032424847269853, 0.02485623454451925];
    assert!((design.covariance() - p).amax() < 1e-13);
    assert!((design.gain() - dmatrix![0.3326163813709689; 1.0688086369886396]).amax() < 1e-11);
    // (27) itself: P = W + A P Aᵀ − (A P Cᵀ + Z)(C P Cᵀ + V)⁻¹(Zᵀ + C P Aᵀ)
    let (plant, noise, p) = (plant(), noise(), design.covariance());
    let (a, c) = (plant.a(), plant.c());
    let right = &noise.state + a * p * a.transpose()
        - design.gain() * (noise.cross.transpose() + c * p * a.transpose());
    assert!((p - right).amax() < 1e-13);
}

/// Two standard normal numbers (Box and Muller).
fn normal(random: &mut StdRng) -> [f64; 2] {
    let radius = (-2.0 * (1.0 - random.random::<f64>()).ln()).sqrt();
    let angle = std::f64::consts::TAU * random.random::<f64>();
    [radius * angle.cos(), radius * angle.sin()]
}

/// The error of the predictor on simulated noise, correlated as designed, has the covariance P.
#[test]
fn error_covariance_is_the_designs() {
    let (plant, noise) = (plant(), noise());
    let design = KalmanDesign::new(&plant, &noise).unwrap();
    let predictor = KalmanPredictor::<2, 1, 1>::new(&plant, &design).unwrap();
    let mut joint = DMatrix::zeros(3, 3);
    joint.view_mut((0, 0), (2, 2)).copy_from(&noise.state);
    joint.view_mut((0, 2), (2, 1)).copy_from(&noise.cross);
    joint.view_mut((2, 0), (1, 2)).copy_from(&noise.cross.transpose());
    joint[(2, 2)] = noise.measurement[0];
    let root = joint.cholesky().unwrap().l();

    let mut random = StdRng::seed_from_u64(7);
    let (mut x, mut estimate) = (Vector2::new(1.0, -1.0), Vector2::zeros());
    let (mut sum, mut count) = (DMatrix::zeros(2, 2), 0.0);
    for sample in 0..400_000 {
        let [n1, n2] = normal(&mut random);
        let [n3, _] = normal(&mut random);
        let drawn = &root * DMatrix::from_column_slice(3, 1, &[n1, n2, n3]);
        let u = (f64::from(sample) * 0.01).sin();
        let y = x.x + drawn[2];
        estimate = predictor.predict(&estimate, &Vector1::new(u), &Vector1::new(y));
        x = Vector2::new(x.x + TIME * x.y + TIME * TIME / 2.0 * u + drawn[0], x.y + TIME * u + drawn[1]);
        if sample > 1000 {
            let error = x - estimate;
            sum += DMatrix::from_column_slice(2, 1, error.as_slice())
                * DMatrix::from_row_slice(1, 2, error.as_slice());
            count += 1.0;
        }
    }
    let measured = sum / count;
    let relative = (&measured - design.covariance()).amax() / design.covariance().amax();
    assert!(relative < 0.02, "{measured} instead of {}", design.covariance());
}

proptest! {
    /// The error dynamics A − KC is stable whatever the noise.
    #[test]
    fn the_predictor_is_stable(w in 1e-8..1.0, v in 1e-6..10.0, correlation in -0.9..0.9) {
        let plant = plant();
        let noise = NoiseCovariance {
            state: dmatrix![w * 1e-3, 0.0; 0.0, w],
            measurement: dmatrix![v],
            cross: dmatrix![0.0; correlation * (w * v).sqrt()],
        };
        let design = KalmanDesign::new(&plant, &noise).unwrap();
        let radius = spectral_radius("A − KC", &(plant.a() - design.gain() * plant.c())).unwrap();
        prop_assert!(radius < 1.0);
    }

    #[test]
    fn absurd_measurements_are_survived(
        values in prop::array::uniform4(prop_oneof![any::<f64>(), Just(f64::NAN), Just(f64::INFINITY)]),
    ) {
        let design = KalmanDesign::new(&plant(), &noise()).unwrap();
        let predictor = KalmanPredictor::<2, 1, 1>::new(&plant(), &design).unwrap();
        let estimate = SVector::from([0.3, -0.2]);
        let next = predictor.predict(&estimate, &Vector1::new(values[0]), &Vector1::new(values[1]));
        prop_assert!(next.iter().all(|x| x.is_finite()));
    }
}

/// A broken measurement is left out; a broken input leaves the estimate where it was.
#[test]
fn what_is_not_finite_is_left_out_of_the_prediction() {
    let design = KalmanDesign::new(&plant(), &noise()).unwrap();
    let predictor = KalmanPredictor::<2, 1, 1>::new(&plant(), &design).unwrap();
    let estimate = SVector::from([0.3, -0.2]);
    let open_loop = SVector::from([0.3 - TIME * 0.2 + TIME * TIME / 2.0 * 4.0, -0.2 + TIME * 4.0]);
    for broken in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let blind = predictor.predict(&estimate, &Vector1::new(4.0), &Vector1::new(broken));
        assert!((blind - open_loop).norm() < 1e-15, "{blind}");
        assert_eq!(predictor.predict(&estimate, &Vector1::new(broken), &Vector1::new(0.3)), estimate);
    }
    // A measurement as predicted corrects nothing.
    let agreed = predictor.predict(&estimate, &Vector1::new(4.0), &Vector1::new(0.3));
    assert!((agreed - open_loop).norm() < 1e-15);
}

/// A thousand predictions of a motion, in single precision and in double: no further apart than a ten-thousandth of what moves.
#[test]
fn single_precision_predicts_as_double() {
    let design = KalmanDesign::new(&plant(), &noise()).unwrap();
    let predictor = KalmanPredictor::<2, 1, 1>::new(&plant(), &design).unwrap();
    let single = predictor.to_precision::<f32>();
    let (mut estimate, mut estimate_single) = (Vector2::zeros(), Vector2::<f32>::zeros());
    for k in 0..1000 {
        let phase = f64::from(k) * TIME;
        let (input, measurement) = (Vector1::new(-phase.sin()), Vector1::new(phase.sin()));
        estimate = predictor.predict(&estimate, &input, &measurement);
        estimate_single = single.predict(&estimate_single, &input.cast(), &measurement.cast());
        let apart = (estimate - estimate_single.cast()).norm();
        assert!(apart < 1e-4, "{k}: {apart}");
    }
}

#[test]
fn a_predictor_of_other_sizes_than_its_design_is_refused() {
    let design = KalmanDesign::new(&plant(), &noise()).unwrap();
    let name = |error: DesignError| match error {
        DesignError::Dimension { name, .. } => name,
        other => panic!("{other}"),
    };
    assert_eq!(name(KalmanPredictor::<3, 1, 1>::new(&plant(), &design).unwrap_err()), "A");
    assert_eq!(name(KalmanPredictor::<2, 2, 1>::new(&plant(), &design).unwrap_err()), "B");
    assert_eq!(name(KalmanPredictor::<2, 1, 2>::new(&plant(), &design).unwrap_err()), "C");
    let other = StateSpace::new(dmatrix![0.5], dmatrix![1.0], dmatrix![1.0]).unwrap();
    let noise = NoiseCovariance::uncorrelated(dmatrix![1.0], dmatrix![1.0]);
    let design = KalmanDesign::new(&other, &noise).unwrap();
    assert_eq!(name(KalmanPredictor::<2, 1, 1>::new(&plant(), &design).unwrap_err()), "K");
}

#[test]
fn wrong_covariances_are_refused_by_name() {
    let refused = |state, measurement, cross| {
        KalmanDesign::new(&plant(), &NoiseCovariance { state, measurement, cross }).unwrap_err()
    };
    let (w, v, z) = (noise().state, noise().measurement, noise().cross);
    assert_eq!(
        refused(w.clone(), dmatrix![0.0], z.clone()),
        DesignError::NotPositiveDefinite { name: "V", eigenvalue: 0.0 }
    );
    assert!(matches!(
        refused(w.clone(), v.clone(), &z * 1e3),
        DesignError::NotPositiveSemidefinite { name: "[W Z; Zᵀ V]", .. }
    ));
    assert!(matches!(refused(dmatrix![1.0], v.clone(), z.clone()), DesignError::Dimension { name: "W", .. }));
    assert!(matches!(
        refused(w * f64::NAN, v.clone(), z.clone()),
        DesignError::ElementNotFinite { name: "W", row: 0, column: 0, .. }
    ));
    // The position cannot be told from the velocity alone.
    let blind = StateSpace::new(plant().a().clone(), plant().b().clone(), dmatrix![0.0, 1.0]).unwrap();
    let error = KalmanDesign::new(&blind, &noise()).unwrap_err();
    assert!(matches!(error, DesignError::Undetectable { .. }), "{error}");
}

/// (26) with D u(k) in the measurement is (26) without it on y − D u: both written out, one through the predictor.
#[test]
fn a_direct_term_is_subtracted_from_the_measurement() {
    let (plant, direct) = (plant(), 0.7);
    let design = KalmanDesign::new(&plant, &noise()).unwrap();
    let predictor = KalmanPredictor::<2, 1, 1>::new(&plant, &design).unwrap();
    let (mut estimate, mut expected) = (Vector2::new(0.4, -0.1), dmatrix![0.4; -0.1]);
    for k in 0..30 {
        let (u, y) = (f64::from(k).sin(), f64::from(2 * k).cos());
        let innovation = y - ((plant.c() * &expected)[0] + direct * u);
        expected = plant.a() * &expected + plant.b() * u + design.gain() * innovation;
        estimate = predictor.predict(&estimate, &Vector1::new(u), &Vector1::new(y - direct * u));
        assert!((estimate.x - expected[0]).hypot(estimate.y - expected[1]) < 1e-13, "sample {k}");
    }
}
