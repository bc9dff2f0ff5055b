//! How much of the force along the thrust the thrust does not explain.

use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use crate::finite::are_finite;

/// Share of the averages that must be filled for a small deviation to be one.
const FILLED: f64 = 0.6;
/// While little was seen, a mass alone is behind forces that deviate from the plane by up to this share of their change …
const EXACTNESS: f64 = 0.01;
/// … and so much more, m/s².
const LEAST_M_S2: f64 = 0.005;
/// Share of the averages that must be filled after a jump for a plane to tell a mass from a force.
const BEGUN: f64 = 0.2;
/// How many times faster the deviation is smoothed than averaged.
const QUICKNESS: f64 = 3.0;
/// A variance of which so little is left follows from others.
const DEPENDENT: f64 = 1e-6;

/// The plane f = α − μ t − κ w through the specific force f along the thrust, the thrust t per mass and the speed w along it of the last
/// seconds, by least squares.
///
/// Whatever the mass is, and the drag along the thrust, and whatever steady force there is beside them, such a plane goes through all of
/// them. What does not lie in it is another force that changes. The controllers answer that force with thrust, so that it passes for an
/// error of the mass.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct ThrustFit {
    /// Averages of t, w and f.
    mean: Vector3<f64>,
    /// Their covariance.
    covariance: Matrix3<f64>,
    /// How much of the averages is filled: 1 after a long time.
    filled: f64,
    /// Deviation of the forces from the plane, smoothed: what has just jumped hardly counts, m/s².
    deviation_m_s2: f64,
    begun: Begun,
    /// Whether anything but a mass has shown since it began.
    is_doubted: bool,
}

/// What a plane begins with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
enum Begun {
    /// A flight, of which too little was seen.
    Flying,
    /// A jump of mass or force, since which too little was seen to tell which.
    Jumping,
    /// It was long ago.
    LongAgo,
}

impl ThrustFit {
    /// Nothing was seen.
    pub(crate) fn new() -> Self {
        Self {
            mean: Vector3::zeros(),
            covariance: Matrix3::zeros(),
            filled: 0.0,
            deviation_m_s2: 0.0,
            begun: Begun::Flying,
            is_doubted: false,
        }
    }

    /// Begins another plane. The forces go on to change as they did.
    pub(crate) fn begin_anew(&mut self) {
        let begun = if self.begun == Begun::Jumping { Begun::Jumping } else { Begun::Flying };
        *self = Self { deviation_m_s2: self.deviation_m_s2, begun, ..Self::new() };
    }

    /// Mass or force have jumped.
    pub(crate) fn jump(&mut self) {
        self.begun = Begun::Jumping;
        self.begin_anew();
    }

    /// Whether what has been seen may as well be a force that changes as another mass. Either looks like a plane for a while; a mass does
    /// so exactly, and from the first on.
    pub(crate) fn is_in_doubt(&self) -> bool {
        match self.begun {
            Begun::Flying => self.is_doubted,
            Begun::Jumping => self.is_doubted || self.filled <= BEGUN,
            Begun::LongAgo => false,
        }
    }

    /// Takes a share of the present, t, w and f, into the averages, under noise of the sensors, m/s²; all that has been seen counts alike
    /// until they are filled. A plane through little tells only that forces change, not that they do not.
    ///
    /// Returns how far the forces deviate from the plane, m/s²: smoothed, or at present, where a jump counts at once, if that is more.
    /// What leads out of the numbers begins another plane.
    pub(crate) fn see(&mut self, present: &Vector3<f64>, share_of_all: f64, noise_m_s2: f64) -> f64 {
        self.filled += (1.0 - self.filled) * share_of_all;
        let share = share_of_all / self.filled;
        let off = present - self.mean;
        self.mean += off * share;
        // About the new mean, which has gone a share of the way: (1 − s)(⟨x xᵀ⟩ + s x xᵀ).
        self.covariance = (self.covariance + off * (off * share).transpose()) * (1.0 - share);
        if !are_finite(self.covariance.as_slice()) {
            self.begin_anew();
            return self.deviation_m_s2;
        }
        if self.filled > FILLED {
            self.begun = Begun::LongAgo;
        }
        let [force_m_s2, by_thrust_m_s2, present_m_s2] = self.deviations_m_s2();
        // Little is explained by anything: here by the thrust alone.
        self.is_doubted |= by_thrust_m_s2 > LEAST_M_S2 + noise_m_s2 + EXACTNESS * force_m_s2;
        let change_m_s2 = present_m_s2 - self.deviation_m_s2;
        if change_m_s2 > 0.0 || self.filled > FILLED {
            self.deviation_m_s2 += change_m_s2 * (QUICKNESS * share_of_all).min(1.0);
        }
        self.deviation_m_s2.max(present_m_s2)
    }

    /// Deviation of the forces from the plane, smoothed: what has just jumped hardly counts, m/s².
    pub(crate) fn deviation_m_s2(&self) -> f64 {
        self.deviation_m_s2
    }

    /// Deviation of f, and what is left of it when t, and then w, are eliminated: √(c_ff − c_xfᵀ C_xx⁻¹ c_xf) with x = (t, w).
    fn deviations_m_s2(&self) -> [f64; 3] {
        let mut left = self.covariance;
        let mut squares = [left[(2, 2)]; 3];
        for pivot in 0..2 {
            let variance = left[(pivot, pivot)];
            // One that follows from those before it explains no more than they do.
            if variance > DEPENDENT * self.covariance[(pivot, pivot)] {
                let column = left.column(pivot).into_owned();
                // Compiled, the quotient may be calculated beforehand: not by zero.
                left -= column * (column / variance.max(f64::MIN_POSITIVE)).transpose();
            }
            squares[pivot + 1] = left[(2, 2)].max(0.0);
        }
        squares.map(libm::sqrt)
    }

    /// Whether a flight can have had it: saved states may come from anywhere.
    pub(crate) fn is_possible(&self) -> bool {
        let Self { mean, covariance, filled, deviation_m_s2, begun: _, is_doubted: _ } = self;
        are_finite(mean.as_slice())
            && are_finite(covariance.as_slice())
            && covariance.diagonal().iter().all(|variance| *variance >= 0.0)
            && (0.0..=1.0).contains(filled)
            && deviation_m_s2.is_finite()
            && *deviation_m_s2 >= 0.0
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix3, Vector3};

    use super::ThrustFit;

    /// Of 20 s at 50 samples a second, averaged over 3 s.
    fn deviation_m_s2(at: impl Fn(f64) -> [f64; 3]) -> f64 {
        let mut fit = ThrustFit::new();
        for sample in 0..1_000 {
            fit.see(&at(0.02 * f64::from(sample)).into(), 0.02 / 3.0, 0.0);
        }
        assert!(fit.is_possible());
        fit.deviation_m_s2()
    }

    /// Up and down: thrust per mass and speed.
    fn swinging(time_s: f64) -> [f64; 2] {
        [9.8 + 2.0 * (0.9 * time_s).sin(), -1.5 * (0.9 * time_s).cos() + 0.5 * (2.3 * time_s).sin()]
    }

    #[test]
    fn a_wrong_mass_a_drag_and_a_steady_force_are_explained() {
        let deviation = deviation_m_s2(|time_s| {
            let [thrust, speed] = swinging(time_s);
            [thrust, speed, 1.5 - 0.7 * thrust - 0.3 * speed]
        });
        assert!(deviation < 1e-6, "{deviation}");
        assert_eq!(deviation_m_s2(|_| [9.8, 0.0, -9.8]), 0.0);
        let dependent = deviation_m_s2(|time_s| {
            let [thrust, _] = swinging(time_s);
            [thrust, 2.0 * thrust, -thrust]
        });
        assert!(dependent < 1e-6, "{dependent}");
    }

    /// The deviation of a sine is its amplitude over √2.
    #[test]
    fn a_force_that_changes_in_its_own_time_is_not() {
        let deviation = deviation_m_s2(|time_s| {
            let [thrust, speed] = swinging(time_s);
            [thrust, speed, 0.5 * (7.0 * time_s).sin() - thrust]
        });
        assert!((deviation / (0.5 / 2.0_f64.sqrt()) - 1.0).abs() < 0.05, "{deviation}");
    }

    /// A jump is not taken for a force that changes as long as it is new, and the deviation of before is kept when another plane begins.
    #[test]
    fn a_jump_hardly_counts_at_first() {
        let mut fit = ThrustFit::new();
        for sample in 0..200 {
            let force = if sample < 190 { -9.8 } else { -8.8 };
            fit.see(&Vector3::new(9.8, 0.0, force), 0.02 / 3.0, 0.0);
        }
        let before_m_s2 = fit.deviation_m_s2();
        assert!((1e-3..0.05).contains(&before_m_s2), "{before_m_s2}");
        fit.jump();
        assert_eq!(fit.deviation_m_s2(), before_m_s2);
        fit.see(&Vector3::new(9.8, 0.0, -8.8), 0.02 / 3.0, 0.0);
        assert_eq!(fit.deviation_m_s2(), before_m_s2);
    }

    /// Within the first seconds after a jump: a mass, a force, and a force as large as the noise.
    #[test]
    fn a_force_that_changes_after_a_jump_is_in_doubt_and_a_mass_is_not() {
        let mut fits = [ThrustFit::new(); 3];
        assert!(!fits[0].is_in_doubt());
        fits.iter_mut().for_each(ThrustFit::jump);
        for sample in 0..200 {
            let time_s = 0.02 * f64::from(sample);
            let [thrust, speed] = swinging(time_s);
            let pushed = -thrust + (2.9 * time_s).sin();
            for (fit, (force, noise)) in
                fits.iter_mut().zip([(-0.7 * thrust, 0.0), (pushed, 0.0), (pushed, 1.0)])
            {
                fit.see(&Vector3::new(thrust, speed, force), 0.02 / 3.0, noise);
            }
            let is_early = time_s < 0.65;
            assert_eq!([fits[0].is_in_doubt(), fits[2].is_in_doubt()], [is_early; 2], "{time_s} s");
            assert!(fits[1].is_in_doubt() == (time_s < 2.72), "{time_s} s");
        }
        assert!(fits[1].deviation_m_s2() > 0.3, "{:?}", fits[1]);
    }

    /// What leads out of the numbers is forgotten at once.
    #[test]
    fn numbers_out_of_range_begin_another_plane() {
        let mut fit = ThrustFit::new();
        for force in [-9.8, -9.8e200, -9.8] {
            let deviation = fit.see(&Vector3::new(9.8, 0.0, force), 0.02 / 3.0, 0.0);
            assert!(deviation == 0.0 && fit.is_possible(), "{force}: {fit:?}");
        }
    }

    #[test]
    fn what_no_flight_has_is_refused() {
        assert!(ThrustFit::new().is_possible());
        let broken = [
            ThrustFit { mean: Vector3::repeat(f64::NAN), ..ThrustFit::new() },
            ThrustFit { covariance: Matrix3::from_diagonal_element(-1.0), ..ThrustFit::new() },
            ThrustFit { filled: 2.0, ..ThrustFit::new() },
            ThrustFit { deviation_m_s2: -1.0, ..ThrustFit::new() },
        ];
        assert!(broken.iter().all(|fit| !fit.is_possible()));
    }
}
