//! Wind with gusts.

use chacha20::ChaCha8Rng;
use nalgebra::Vector3;
use rand_distr::{Distribution, StandardNormal};

/// Time between the points of a gust, s.
const STEP_S: f64 = 0.05;
/// Height above ground that the turbulence is that of, m.
const HEIGHT_M: f64 = 10.0;
const FEET_PER_M: f64 = 3.280_84;

/// Wind over time, NED, m/s, linear between points.
#[derive(Clone, Debug, PartialEq)]
pub struct Gusts {
    points_m_s: Vec<Vector3<f64>>,
}

impl Gusts {
    /// Gusts around a mean wind. Lengths and intensities are those of Dryden's model at low altitude (MIL-F-8785C,
    /// 3.7.3.4, in feet): L_w = h, L_u = h/(0.177 + 0.000823 h)^1.2, σ_w = W/10,
    /// σ_u = σ_w/(0.177 + 0.000823 h)^0.4. Each component is a first-order process, as Dryden's along the wind is;
    /// its second-order shape across the wind is left out.
    pub fn new(mean_m_s: Vector3<f64>, duration_s: f64, generator: &mut ChaCha8Rng) -> Self {
        let wind_m_s = mean_m_s.norm();
        let h = HEIGHT_M * FEET_PER_M;
        let shape = 0.177 + 0.000_823 * h;
        let down_m_s = 0.1 * wind_m_s;
        let across_m_s = down_m_s / shape.powf(0.4);
        let length_m = h / shape.powf(1.2) / FEET_PER_M;
        let deviations = Vector3::new(across_m_s, across_m_s, down_m_s);
        let lengths = Vector3::new(length_m, length_m, HEIGHT_M);
        // The vehicle stands in the wind: what passes is the wind itself.
        let kept = lengths.map(|length| (-STEP_S * wind_m_s / length).exp());

        let mut normal = || -> f64 { StandardNormal.sample(generator) };
        let mut gust = deviations.map(|deviation| deviation * normal());
        let count = (duration_s / STEP_S).ceil() as usize + 2;
        let points_m_s = (0..count)
            .map(|_| {
                let point = mean_m_s + gust;
                for axis in 0..3 {
                    let fresh = (1.0 - kept[axis] * kept[axis]).sqrt();
                    gust[axis] = kept[axis] * gust[axis] + fresh * deviations[axis] * normal();
                }
                point
            })
            .collect();
        Self { points_m_s }
    }

    /// The wind at a time.
    pub fn at(&self, time_us: u64) -> Vector3<f64> {
        let place = time_us as f64 * 1e-6 / STEP_S;
        let index = place as usize;
        match (self.points_m_s.get(index), self.points_m_s.get(index + 1)) {
            (Some(one), Some(other)) => one.lerp(other, place - index as f64),
            _ => self.points_m_s.last().copied().unwrap_or_default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use chacha20::ChaCha8Rng;
    use chacha20::rand_core::SeedableRng;
    use nalgebra::Vector3;

    use super::Gusts;

    /// Mean and deviation of many draws, within five standard errors: σ_w = W/10, σ_u = 1.89 σ_w at 10 m.
    #[test]
    fn gusts_are_as_strong_as_they_should_be() {
        let mean = Vector3::new(3.0, 4.0, 0.0);
        let mut generator = ChaCha8Rng::seed_from_u64(1);
        let count = 4000;
        let winds: Vec<Vector3<f64>> =
            (0..count).map(|_| Gusts::new(mean, 1.0, &mut generator).at(700_000)).collect();
        let bound = 5.0 / f64::from(count).sqrt();
        for (axis, deviation) in [(0, 0.945), (1, 0.945), (2, 0.5)] {
            let off = |wind: &Vector3<f64>| (wind[axis] - mean[axis]) / deviation;
            let average = winds.iter().map(off).sum::<f64>() / f64::from(count);
            let variance = winds.iter().map(|wind| off(wind).powi(2)).sum::<f64>() / f64::from(count);
            assert!(average.abs() < bound, "axis {axis}: {average}");
            assert!((variance - 1.0).abs() < 2.0 * bound, "axis {axis}: {variance}");
        }
    }

    #[test]
    fn no_wind_no_gusts() {
        let gusts = Gusts::new(Vector3::zeros(), 2.0, &mut ChaCha8Rng::seed_from_u64(1));
        assert_eq!(gusts.at(1_234_567), Vector3::zeros());
        assert_eq!(gusts.at(u64::MAX), Vector3::zeros());
    }
}
