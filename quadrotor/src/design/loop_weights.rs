//! Weights of a controller in terms of its bandwidth.

use lmpc::{Augmented, DesignError, Weights};
use nalgebra::{DMatrix, DVector, SVector};

use crate::ControllerSettings;

/// Q and R of a controller whose P outputs are to be closed with the bandwidths ω, rad/s: with errors e of the output, the
/// stage cost is
///
/// ```text
/// w_output e² + w_damping (ė/ω)² + w_rate (ë/ω²)² + w_increment (u̇/ω³)²
/// ```
///
/// in which all terms are of the output's unit, so that weights of 1 count deviations of one size alike, whatever the bandwidth and
/// the airframe. Increments over a sample ΔT stand for derivatives: Δy = ẏ ΔT. The input is an acceleration of the output.
/// Channel by channel, the model's states are the output, its rate, and then others.
///
/// # Errors
/// Those of [`Weights::new`].
pub(crate) fn loop_weights<const P: usize>(
    model: &Augmented,
    settings: &ControllerSettings<P>,
    bandwidth_rad_s: &SVector<f64, P>,
) -> Result<Weights, DesignError> {
    let states = model.plant().states();
    let per_channel = states / P;
    let sample_time_s = settings.sample_time_s();
    let mut q = DVector::zeros(states + P);
    let mut r = DVector::zeros(P);
    for channel in 0..P {
        let omega = bandwidth_rad_s[channel];
        // (1/(ω ΔT))², (1/(ω² ΔT))², (1/(ω³ ΔT))²
        let unit = |power: i32| {
            let scale = libm::pow(omega, f64::from(power)) * sample_time_s;
            1.0 / (scale * scale)
        };
        q[per_channel * channel] = settings.damping_weight[channel] * unit(1);
        q[per_channel * channel + 1] = settings.rate_weight[channel] * unit(2);
        q[states + channel] = settings.output_weight[channel];
        r[channel] = settings.increment_weight[channel] * unit(3);
    }
    Weights::new(model, DMatrix::from_diagonal(&q), DMatrix::from_diagonal(&r))
}

#[cfg(test)]
mod tests {
    extern crate std;

    use lmpc::{Augmented, Discretization};
    use nalgebra::{DMatrix, DVector, Vector1};

    use super::loop_weights;
    use crate::Configuration;
    use crate::design::linear_models::double_integrators;

    /// ω = 2 rad/s, ΔT = 0.05 s: a step of the output of ω ΔT = 0.1 counts like an error of 1, one of the rate like ω² ΔT = 0.2, and
    /// one of the acceleration like ω³ ΔT = 0.4.
    #[test]
    fn deviations_of_one_size_cost_alike() {
        let mut settings = Configuration::default().controllers.altitude;
        settings.sample_time_us = 50_000;
        settings.output_weight = Vector1::new(2.0);
        settings.damping_weight = Vector1::new(3.0);
        settings.rate_weight = Vector1::new(0.5);
        settings.increment_weight = Vector1::new(0.25);
        let plant = double_integrators(&[1.0], 0.05, Discretization::ZeroOrderHold).expect("a model");
        let weights = loop_weights(&Augmented::new(&plant), &settings, &Vector1::new(2.0)).expect("weights");
        let q = DMatrix::from_diagonal(&DVector::from_vec(std::vec![3.0 / 0.01, 0.5 / 0.04, 2.0]));
        assert!((weights.q() - q).amax() < 1e-9, "{}", weights.q());
        assert!((weights.r()[(0, 0)] - 0.25 / 0.16).abs() < 1e-12, "{}", weights.r());
    }
}
