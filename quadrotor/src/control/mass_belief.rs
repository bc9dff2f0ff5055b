//! What a change of the mass that the controllers believe in does to accelerations.

use nalgebra::{Vector1, Vector2, Vector3};

use crate::{Controllers, GRAVITY_M_S2};

/// Another `controller.mass_factor`, for an unchanged vehicle.
///
/// A commanded acceleration a stands for the thrust F b = m (g e₃ − a). When m changes and the thrust must not,
/// g e₃ − a changes in proportion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MassBelief {
    /// The mass believed before as a multiple of the mass believed now.
    ratio: f64,
}

impl MassBelief {
    /// `None` when the factor stays as it is: the thrust of another true mass is another one.
    pub(crate) fn changed(before: &Controllers, after: &Controllers) -> Option<Self> {
        let ratio = before.mass_factor / after.mass_factor;
        (before.mass_factor != after.mass_factor).then_some(Self { ratio })
    }

    /// A horizontal acceleration.
    pub(crate) fn horizontal(&self, acceleration_m_s2: &Vector2<f64>) -> Vector2<f64> {
        acceleration_m_s2 * self.ratio
    }

    /// A vertical acceleration, down.
    pub(crate) fn vertical(&self, acceleration_m_s2: &Vector1<f64>) -> Vector1<f64> {
        acceleration_m_s2.map(|down| GRAVITY_M_S2 - (GRAVITY_M_S2 - down) * self.ratio)
    }

    /// By how much an acceleration that contains this thrust per believed mass, m/s², grows.
    pub(crate) fn growth_under(&self, thrust_m_s2: &Vector3<f64>) -> Vector3<f64> {
        // (g e₃ − T r) − (g e₃ − T)
        thrust_m_s2 * (1.0 - self.ratio)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Vector1, Vector2, Vector3};

    use super::MassBelief;
    use crate::{Controllers, GRAVITY_M_S2};

    #[test]
    fn the_thrust_stays_the_same() {
        let before = Controllers::default();
        let after = Controllers { mass_factor: 1.25, ..before };
        assert_eq!(MassBelief::changed(&before, &before), None);
        let belief = MassBelief::changed(&before, &after).expect("another factor");
        let thrust = |mass: f64, a: &Vector3<f64>| (Vector3::z() * GRAVITY_M_S2 - a) * mass;
        let a = Vector3::new(1.0, -2.0, 0.7);
        let (horizontal, vertical) =
            (belief.horizontal(&Vector2::new(a.x, a.y)), belief.vertical(&Vector1::new(a.z)));
        let translated = Vector3::new(horizontal.x, horizontal.y, vertical.x);
        assert!((thrust(1.25, &translated) - thrust(1.0, &a)).norm() < 1e-12);
        let grown = a + belief.growth_under(&thrust(1.0, &a));
        assert!((grown - translated).norm() < 1e-12);
    }
}
