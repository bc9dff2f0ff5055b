//! What a reference requires of the thrust.

use nalgebra::{Vector2, Vector3};

use crate::control::cascade::most_horizontal;
use crate::design::controller_limits::{holding_horizontal_m_s2, reference_tilt_rad};
use crate::{Configuration, PositionReference};

/// A horizontal acceleration of less, m/s², has no direction: what it turns with would have no bounds.
const NOTHING_M_S2: f64 = 1e-6;

/// Acceleration that thrust and gravity must make for a reference to be followed against the drag, and how it changes, NED. A
/// reference that leans farther than the limits allow requires the largest lean in its direction, and moves as that does: feedback
/// would otherwise have to cancel a motion of the attitude that nobody can follow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RequiredThrust {
    /// m/s².
    pub(crate) acceleration_m_s2: Vector3<f64>,
    /// Its derivative, m/s³.
    pub(crate) jerk_m_s3: Vector3<f64>,
    /// The derivative of that, m/s⁴.
    pub(crate) snap_m_s4: Vector3<f64>,
}

impl RequiredThrust {
    /// Of a reference: a + D v and its derivatives, shortened to a largest lean, rad.
    pub(crate) fn of(configuration: &Configuration, reference: &PositionReference, lean_rad: f64) -> Self {
        Self::whole(configuration, reference).within_lean(configuration, lean_rad)
    }

    /// Whether a reference leans farther than can be followed.
    pub(crate) fn is_beyond_lean(configuration: &Configuration, reference: &PositionReference) -> bool {
        let whole = Self::whole(configuration, reference);
        let horizontal_m_s2 = whole.acceleration_m_s2.xy().norm();
        let lean_rad = reference_tilt_rad(configuration);
        horizontal_m_s2 > NOTHING_M_S2
            && horizontal_m_s2 > whole.most_horizontal_m_s2(configuration, lean_rad)
    }

    /// a + D v and its derivatives.
    pub(crate) fn whole(configuration: &Configuration, reference: &PositionReference) -> Self {
        let drag_1_s = configuration.drag_1_s();
        let against = |motion: &Vector3<f64>, slower: &Vector3<f64>| motion + drag_1_s.component_mul(slower);
        Self {
            acceleration_m_s2: against(&reference.acceleration_m_s2, &reference.velocity_m_s),
            jerk_m_s3: against(&reference.jerk_m_s3, &reference.acceleration_m_s2),
            snap_m_s4: against(&reference.snap_m_s4, &reference.jerk_m_s3),
        }
    }

    /// Shortened to a largest lean, rad.
    pub(crate) fn within_lean(&self, configuration: &Configuration, lean_rad: f64) -> Self {
        self.leaning_at_most(|| self.most_horizontal_m_s2(configuration, lean_rad))
    }

    /// The largest horizontal acceleration beside the vertical one, under a lean in rad, m/s².
    pub(crate) fn most_horizontal_m_s2(&self, configuration: &Configuration, lean_rad: f64) -> f64 {
        let vertical_m_s2 = self.acceleration_m_s2.z;
        most_horizontal(vertical_m_s2, lean_rad).min(holding_horizontal_m_s2(configuration, -vertical_m_s2))
    }

    /// The same with a horizontal acceleration of at most `most_m_s2`, which is only asked for if there is one:
    ///
    /// ```text
    /// a = r n,  r′ = n·j,  n′ = (j − r′ n)/r,  r″ = n·s + r |n′|²,  n″ = (s − 2 r′ n′ − r″ n)/r
    /// ```
    pub(crate) fn leaning_at_most(&self, most_m_s2: impl FnOnce() -> f64) -> Self {
        let [a, j, s] = [self.acceleration_m_s2, self.jerk_m_s3, self.snap_m_s4].map(|part| part.xy());
        // Mostly nothing is cut off, which squares tell.
        let squared = a.norm_squared();
        if squared <= NOTHING_M_S2 * NOTHING_M_S2 {
            return *self;
        }
        let most_m_s2 = most_m_s2();
        if squared <= most_m_s2 * most_m_s2 {
            return *self;
        }
        let r = libm::hypot(a.x, a.y);
        // A direction that nothing is left of does not turn.
        if !r.is_finite() || r <= most_m_s2 {
            return *self;
        }
        let n = a / r;
        let grows = n.dot(&j);
        let turns = (j - n * grows) / r;
        let bends = n.dot(&s) + r * turns.norm_squared();
        let twists = (s - turns * (2.0 * grows) - n * bends) / r;
        let with = |horizontal: Vector2<f64>, whole: &Vector3<f64>| {
            Vector3::new(horizontal.x, horizontal.y, whole.z)
        };
        Self {
            acceleration_m_s2: with(n * most_m_s2, &self.acceleration_m_s2),
            jerk_m_s3: with(turns * most_m_s2, &self.jerk_m_s3),
            snap_m_s4: with(twists * most_m_s2, &self.snap_m_s4),
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use nalgebra::Vector3;

    use super::RequiredThrust;
    use crate::guidance::known_motion::motion;
    use crate::{Configuration, PositionReference, commanded_tilt_rad};

    /// A spiral whose acceleration grows and turns, with its derivatives by the product rule in the complex plane: b e^{ct}.
    fn spiral(time_s: f64) -> PositionReference {
        let (growth, turn) = (0.3, 1.7);
        motion(|order| {
            let size = 6.0 * libm::exp(growth * time_s) * libm::hypot(growth, turn).powi(order);
            let angle = turn * time_s + f64::from(order) * libm::atan2(turn, growth);
            Vector3::new(size * libm::cos(angle), size * libm::sin(angle), 0.0)
        })
    }

    /// A vehicle with a drag of its own along each axis.
    pub(crate) fn dragged() -> Configuration {
        let mut configuration = Configuration::default();
        configuration.airframe.drag_n_s_m = [0.4, 0.25, 0.1];
        configuration
    }

    /// Central differences of each part give the next one: of a reference within the lean against its drag, and of one beyond.
    #[test]
    fn each_part_is_the_derivative_of_the_one_before() {
        const H: f64 = 1e-4;
        let of =
            |time_s: f64| RequiredThrust::of(&dragged(), &spiral(time_s), commanded_tilt_rad(&dragged()));
        for time_s in [-5.0, -4.0, 0.0, 1.0] {
            let [before, now, after] = [of(time_s - H), of(time_s), of(time_s + H)];
            let slope =
                |part: fn(&RequiredThrust) -> Vector3<f64>| (part(&after) - part(&before)) / (2.0 * H);
            let jerk = slope(|required| required.acceleration_m_s2) - now.jerk_m_s3;
            let snap = slope(|required| required.jerk_m_s3) - now.snap_m_s4;
            assert!(jerk.norm() < 1e-5 && snap.norm() < 1e-5, "{time_s}: {jerk} {snap}");
        }
    }

    /// Within the lean a reference requires what it asks for and its drag; beyond, the largest lean in the same direction.
    #[test]
    fn what_cannot_be_leant_is_shortened() {
        let configuration = dragged();
        let lean_rad = 0.5;
        let largest = libm::tan(lean_rad) * crate::GRAVITY_M_S2;
        for (time_s, whole) in [(-5.0, true), (0.0, false)] {
            let reference = spiral(time_s);
            let drag = Vector3::new(0.4, 0.25, 0.1).component_mul(&reference.velocity_m_s);
            let asked = reference.acceleration_m_s2 + drag / configuration.airframe.mass_kg;
            let required = RequiredThrust::of(&configuration, &reference, lean_rad).acceleration_m_s2;
            let expected = if whole { asked } else { asked * (largest / asked.norm()) };
            assert_eq!(asked.norm() < largest, whole);
            assert!((required - expected).norm() < 1e-9, "{required} {expected}");
        }
    }
}
