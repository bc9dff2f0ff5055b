//! What a reference requires of the thrust.

use nalgebra::{Vector2, Vector3};

use crate::control::cascade::{most_horizontal, surely_horizontal, vertical_range};
use crate::design::controller_limits::{LEAST_HORIZONTAL_M_S2, holding_horizontal_m_s2, reference_tilt_rad};
use crate::{Configuration, GRAVITY_M_S2, Limits, PositionReference};

/// A horizontal acceleration of less, m/s², has no direction: what it turns with would have no bounds.
const NOTHING_M_S2: f64 = 1e-6;

/// Acceleration that thrust and gravity must make for a reference to be followed against the drag, and how it changes, NED. A
/// reference that asks for more than the limits allow requires the most that they do, and moves as that does: no more thrust than there
/// is, up and down, and beside it the largest lean in its direction. Feedback would otherwise have to cancel a motion of the attitude that
/// nobody can follow; where a thrust points that is nearly nothing, or down, it would turn the vehicle over.
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
    /// Of a reference: a + D v and its derivatives, within the thrust and a largest lean, rad.
    pub(crate) fn of(configuration: &Configuration, reference: &PositionReference, lean_rad: f64) -> Self {
        Self::whole(configuration, reference).within(configuration, lean_rad)
    }

    /// Whether it is more thrust, or less, than there is.
    pub(crate) fn is_beyond_thrust(&self, configuration: &Configuration) -> bool {
        let (up, down) = level_range(configuration);
        !(up..=down).contains(&self.acceleration_m_s2.z)
    }

    /// Whether it leans at most by a share of what can be followed.
    pub(crate) fn leans_at_most(&self, configuration: &Configuration, share: f64) -> bool {
        let horizontal_m_s2 = self.acceleration_m_s2.xy().norm();
        let lean_rad = reference_tilt_rad(configuration);
        horizontal_m_s2 <= NOTHING_M_S2
            || horizontal_m_s2 <= share * self.most_horizontal_m_s2(configuration, lean_rad)
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

    /// With a share of its vertical motion.
    pub(crate) fn with_vertical(&self, share: f64) -> Self {
        let each = |whole: &Vector3<f64>| Vector3::new(whole.x, whole.y, share * whole.z);
        Self {
            acceleration_m_s2: each(&self.acceleration_m_s2),
            jerk_m_s3: each(&self.jerk_m_s3),
            snap_m_s4: each(&self.snap_m_s4),
        }
    }

    /// Within the thrust and a largest lean, rad.
    pub(crate) fn within(&self, configuration: &Configuration, lean_rad: f64) -> Self {
        let within = self.within_thrust(configuration);
        if within.surely_leans_less(configuration, lean_rad) {
            return within;
        }
        within.leaning_at_most(
            || within.most_horizontal_m_s2(configuration, lean_rad),
            |most_m_s2| within.motion_of_most(configuration, most_m_s2, lean_rad),
        )
    }

    /// Within the vertical accelerations that the thrust gives a level vehicle.
    pub(crate) fn within_thrust(&self, configuration: &Configuration) -> Self {
        let (up, down) = level_range(configuration);
        let vertical_m_s2 = self.acceleration_m_s2.z.clamp(up, down);
        if vertical_m_s2 == self.acceleration_m_s2.z {
            return *self;
        }
        let with = |whole: &Vector3<f64>, vertical: f64| Vector3::new(whole.x, whole.y, vertical);
        Self {
            acceleration_m_s2: with(&self.acceleration_m_s2, vertical_m_s2),
            jerk_m_s3: with(&self.jerk_m_s3, 0.0),
            snap_m_s4: with(&self.snap_m_s4, 0.0),
        }
    }

    /// The largest horizontal acceleration beside the vertical one, under a lean in rad, m/s².
    pub(crate) fn most_horizontal_m_s2(&self, configuration: &Configuration, lean_rad: f64) -> f64 {
        let vertical_m_s2 = self.acceleration_m_s2.z;
        most_horizontal(vertical_m_s2, lean_rad).min(holding_horizontal_m_s2(configuration, -vertical_m_s2))
    }

    /// Whether it is plain that it leans less, rad, which most do.
    fn surely_leans_less(&self, configuration: &Configuration, lean_rad: f64) -> bool {
        let vertical_m_s2 = self.acceleration_m_s2.z;
        let least_m_s2 = surely_horizontal(vertical_m_s2, lean_rad)
            .min(holding_horizontal_m_s2(configuration, -vertical_m_s2));
        self.acceleration_m_s2.xy().norm_squared() <= least_m_s2 * least_m_s2
    }

    /// The two derivatives of the largest horizontal acceleration m under a lean, rad:
    ///
    /// ```text
    /// w = g − a_z
    /// m = w tan(lean),  m′ = w′ tan(lean),  m″ = w″ tan(lean)         as far as the lean allows,
    /// m² = s² − w²,  m m′ = −w w′,  m m″ = −w w″ − w′² − m′²         as far as the thrust s does
    /// ```
    ///
    /// The least that is commanded however weak the rotors are does not change. Near it the circle of the thrust is steep: no lean follows
    /// faster than its limits allow.
    fn motion_of_most(&self, configuration: &Configuration, m: f64, lean_rad: f64) -> [f64; 2] {
        if m == most_horizontal(self.acceleration_m_s2.z, lean_rad) {
            return self.motion_of_leaning(m);
        }
        if m <= LEAST_HORIZONTAL_M_S2 {
            return [0.0, 0.0];
        }
        let [w, w_rate, w_bend] = self.carrying();
        let rate = -w * w_rate / m;
        let bend = -(w * w_bend + w_rate * w_rate + rate * rate) / m;
        let Limits { tilt_rate_rad_s, tilt_acceleration_rad_s2, .. } = configuration.limits;
        let within = |value: f64, limit: f64| value.clamp(-GRAVITY_M_S2 * limit, GRAVITY_M_S2 * limit);
        [within(rate, tilt_rate_rad_s), within(bend, tilt_acceleration_rad_s2)]
    }

    /// The two derivatives of a horizontal acceleration m beside which the lean stays the same: those of w m/w.
    pub(crate) fn motion_of_leaning(&self, m: f64) -> [f64; 2] {
        let [w, w_rate, w_bend] = self.carrying();
        let tangent = if w > NOTHING_M_S2 { m / w } else { 0.0 };
        [tangent * w_rate, tangent * w_bend]
    }

    /// w = g − a_z and its derivatives.
    pub(crate) fn carrying(&self) -> [f64; 3] {
        [GRAVITY_M_S2 - self.acceleration_m_s2.z, -self.jerk_m_s3.z, -self.snap_m_s4.z]
    }

    /// The same with a horizontal acceleration of at most m, which is only asked for if there is one, as its two derivatives are if it is
    /// cut off:
    ///
    /// ```text
    /// a = r n,  r′ = n·j,  n′ = (j − r′ n)/r,  r″ = n·s + r |n′|²,  n″ = (s − 2 r′ n′ − r″ n)/r
    /// (m n)′ = m′ n + m n′,  (m n)″ = m″ n + 2 m′ n′ + m n″
    /// ```
    pub(crate) fn leaning_at_most(
        &self,
        most_m_s2: impl FnOnce() -> f64,
        motion: impl FnOnce(f64) -> [f64; 2],
    ) -> Self {
        let [a, j, s] = [self.acceleration_m_s2, self.jerk_m_s3, self.snap_m_s4].map(|part| part.xy());
        // Mostly nothing is cut off, which squares tell.
        let squared = a.norm_squared();
        if squared <= NOTHING_M_S2 * NOTHING_M_S2 {
            return *self;
        }
        let m = most_m_s2();
        if squared <= m * m {
            return *self;
        }
        let r = libm::hypot(a.x, a.y);
        // A direction that nothing is left of does not turn.
        if !r.is_finite() || r <= m {
            return *self;
        }
        let [m_rate, m_bend] = motion(m);
        let n = a / r;
        let grows = n.dot(&j);
        let turns = (j - n * grows) / r;
        let bends = n.dot(&s) + r * turns.norm_squared();
        let twists = (s - turns * (2.0 * grows) - n * bends) / r;
        let with = |horizontal: Vector2<f64>, whole: &Vector3<f64>| {
            Vector3::new(horizontal.x, horizontal.y, whole.z)
        };
        Self {
            acceleration_m_s2: with(n * m, &self.acceleration_m_s2),
            jerk_m_s3: with(n * m_rate + turns * m, &self.jerk_m_s3),
            snap_m_s4: with(n * m_bend + turns * (2.0 * m_rate) + twists * m, &self.snap_m_s4),
        }
    }
}

/// Vertical accelerations, m/s², that the thrust gives a level vehicle, up to down. Holding the height is among them, whatever mass is believed
/// in.
pub(crate) fn level_range(configuration: &Configuration) -> (f64, f64) {
    let (up, down) = vertical_range(configuration, 1.0);
    (up.min(0.0), down.max(0.0))
}

#[cfg(test)]
pub(crate) mod tests {
    use nalgebra::Vector3;

    use super::RequiredThrust;
    use crate::guidance::known_motion::motion;
    use crate::{AirframePreset, Configuration, GRAVITY_M_S2, Limits, PositionReference, commanded_tilt_rad};

    /// A spiral whose acceleration grows and turns, with its derivatives by the product rule in the complex plane: b e^{ct}. Its vertical
    /// part is `climb` times as large.
    fn rising_spiral(time_s: f64, climb: f64) -> PositionReference {
        let (growth, turn) = (0.3, 1.7);
        motion(|order| {
            let size = 6.0 * libm::exp(growth * time_s) * libm::hypot(growth, turn).powi(order);
            let angle = turn * time_s + f64::from(order) * libm::atan2(turn, growth);
            Vector3::new(size * libm::cos(angle), size * libm::sin(angle), climb * size * libm::cos(angle))
        })
    }

    fn spiral(time_s: f64) -> PositionReference {
        rising_spiral(time_s, 0.0)
    }

    /// A vehicle with a drag of its own along each axis.
    pub(crate) fn dragged() -> Configuration {
        let mut configuration = Configuration::default();
        configuration.airframe.drag_n_s_m = [0.4, 0.25, 0.1];
        configuration
    }

    /// Central differences of each part give the next one: of a reference within the lean against its drag, of ones beyond that climb and
    /// fall, with more thrust than there is, and with too little of it for the lean.
    #[test]
    fn each_part_is_the_derivative_of_the_one_before() {
        const H: f64 = 1e-4;
        let mut weak = dragged();
        weak.limits.thrust_max = 1.1;
        let (mut within, mut leant, mut cut, mut held) = (0, 0, 0, 0);
        for (configuration, climb) in [(dragged(), 0.0), (dragged(), 0.3), (dragged(), -0.6), (weak, 0.05)] {
            let lean_rad = commanded_tilt_rad(&configuration);
            let of =
                |time_s: f64| RequiredThrust::of(&configuration, &rising_spiral(time_s, climb), lean_rad);
            for time_s in [-5.0, -4.0, -2.5, -1.7, -1.1, 0.0, 1.0] {
                let [before, now, after] = [of(time_s - H), of(time_s), of(time_s + H)];
                let whole = RequiredThrust::whole(&configuration, &rising_spiral(time_s, climb));
                let up_m_s2 = GRAVITY_M_S2 - now.acceleration_m_s2.z;
                let tangent = now.acceleration_m_s2.xy().norm() / up_m_s2;
                let leans_most = (tangent - libm::tan(lean_rad)).abs() < 1e-9;
                within += u32::from(now == whole);
                leant += u32::from(leans_most && now.jerk_m_s3.z != 0.0);
                cut += u32::from(now.acceleration_m_s2.z != whole.acceleration_m_s2.z);
                held += u32::from(now != whole && !leans_most && now.jerk_m_s3.z != 0.0);
                let slope =
                    |part: fn(&RequiredThrust) -> Vector3<f64>| (part(&after) - part(&before)) / (2.0 * H);
                let jerk = slope(|required| required.acceleration_m_s2) - now.jerk_m_s3;
                let snap = slope(|required| required.jerk_m_s3) - now.snap_m_s4;
                assert!(jerk.norm() < 1e-5 && snap.norm() < 1e-5, "{climb} {time_s}: {jerk} {snap}");
            }
        }
        assert!(within > 3 && leant > 3 && cut > 1 && held > 3, "{within} {leant} {cut} {held}");
    }

    /// However much is asked for up or down, the thrust is within its limits, and so is the lean.
    #[test]
    fn the_thrust_is_within_its_limits() {
        let configuration = Configuration::default();
        for vertical_m_s2 in [-1e300, -30.0, 8.0, 30.0, 1e300] {
            let reference = PositionReference {
                acceleration_m_s2: Vector3::new(20.0, -10.0, vertical_m_s2),
                jerk_m_s3: Vector3::new(1.0, 2.0, 3.0),
                snap_m_s4: Vector3::new(4.0, 5.0, 6.0),
                ..PositionReference::goal([0.0; 3], 0.0)
            };
            let required = RequiredThrust::of(&configuration, &reference, 0.5);
            let up_m_s2 = GRAVITY_M_S2 - required.acceleration_m_s2.z;
            // 0.6 and 2 of the weight
            let expected = if vertical_m_s2 > 0.0 { 0.6 } else { 2.0 } * GRAVITY_M_S2;
            assert!((up_m_s2 - expected).abs() < 1e-9, "{up_m_s2}");
            assert!(required.acceleration_m_s2.xy().norm() <= libm::tan(0.5) * up_m_s2 + 1e-9);
            assert_eq!((required.jerk_m_s3.z, required.snap_m_s4.z), (0.0, 0.0));
            assert!(RequiredThrust::whole(&configuration, &reference).is_beyond_thrust(&configuration));
        }
    }

    /// A thrust that is cut off at a lean, and that falls meanwhile, leans as far all the time: by differences, its tangent stays.
    #[test]
    fn what_is_cut_off_keeps_its_lean() {
        const STEP_S: f64 = 1e-3;
        let whole = RequiredThrust {
            acceleration_m_s2: Vector3::new(6.0, -3.0, 1.5),
            jerk_m_s3: Vector3::new(-2.0, 1.0, 8.0),
            snap_m_s4: Vector3::new(5.0, 4.0, -30.0),
        };
        let cut = whole.leaning_at_most(|| 4.0, |most_m_s2| whole.motion_of_leaning(most_m_s2));
        let lean = |time_s: f64| {
            let acceleration =
                cut.acceleration_m_s2 + cut.jerk_m_s3 * time_s + cut.snap_m_s4 * (time_s * time_s / 2.0);
            acceleration.xy().norm() / (GRAVITY_M_S2 - acceleration.z)
        };
        let [before, now, after] = [-STEP_S, 0.0, STEP_S].map(lean);
        assert!((now - 4.0 / (GRAVITY_M_S2 - 1.5)).abs() < 1e-12, "{now}");
        assert!(((after - before) / (2.0 * STEP_S)).abs() < 1e-4, "{before} {after}");
        assert!(((after - 2.0 * now + before) / (STEP_S * STEP_S)).abs() < 1e-3, "{before} {now} {after}");
    }

    /// The rotors of an Iris give 14.8 m/s². Where a climb takes nearly all of that, what is left for a lean goes to nothing like a root: its
    /// derivatives are those of a lean that turns as fast as its limits allow.
    #[test]
    fn what_is_left_beside_a_climb_turns_within_the_limits_of_the_tilt() {
        let configuration = Configuration::for_airframe(&AirframePreset::Iris.airframe()).unwrap();
        let Limits { tilt_rate_rad_s, tilt_acceleration_rad_s2, .. } = configuration.limits;
        for climb_m_s2 in [4.7, 4.8, 4.9, 4.93] {
            let reference = PositionReference {
                acceleration_m_s2: Vector3::new(8.0, 0.0, -climb_m_s2),
                jerk_m_s3: Vector3::new(0.0, 0.0, -8.0),
                snap_m_s4: Vector3::new(0.0, 0.0, 140.0),
                ..PositionReference::goal([0.0; 3], 0.0)
            };
            let required = RequiredThrust::of(&configuration, &reference, 1.2);
            assert!(required.acceleration_m_s2.x < 4.0, "{climb_m_s2}: {required:?}");
            assert!(
                required.jerk_m_s3.x.abs() <= GRAVITY_M_S2 * tilt_rate_rad_s,
                "{climb_m_s2}: {required:?}"
            );
            assert!(
                required.snap_m_s4.x.abs() <= GRAVITY_M_S2 * tilt_acceleration_rad_s2,
                "{climb_m_s2}: {required:?}"
            );
        }
    }

    /// Within the lean a reference requires what it asks for and its drag; beyond, the largest lean in the same direction.
    #[test]
    fn what_cannot_be_leant_is_shortened() {
        let configuration = dragged();
        let lean_rad = 0.5;
        let largest = libm::tan(lean_rad) * GRAVITY_M_S2;
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
