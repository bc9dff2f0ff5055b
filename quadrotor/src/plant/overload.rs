//! What is stronger than the rotors.

use core::fmt;

use crate::{Airframe, Disturbance};

/// A component of a disturbance that the rotors cannot counter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overload {
    /// Public name of the component: "disturbance.torque.z".
    pub name: &'static str,
    /// Its value, in the unit.
    pub value: f64,
    /// Largest magnitude that the rotors can counter, in the unit.
    pub limit: f64,
    /// SI unit of both.
    pub unit: &'static str,
}

impl fmt::Display for Overload {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, value, limit, unit } = self;
        write!(formatter, "{name} = {value:?} {unit} exceeds what the rotors can counter ({limit:.3} {unit})")
    }
}

impl Disturbance {
    /// The component that exceeds by the largest factor what the rotors of `airframe` can counter with all their thrust, if
    /// any does.
    pub fn overload(&self, airframe: &Airframe) -> Option<Overload> {
        const NAMES: [[&str; 3]; 3] = [
            ["disturbance.force.x", "disturbance.force.y", "disturbance.force.z"],
            ["disturbance.torque.x", "disturbance.torque.y", "disturbance.torque.z"],
            ["wind.velocity.x", "wind.velocity.y", "wind.velocity.z"],
        ];
        let thrust_n = airframe.thrust_range_n().1;
        // A wind pushes as hard as the thrust at thrust / drag; without drag it does not push.
        let wind_m_s = airframe.hover_drag_n_s_m().map(|drag| thrust_n / drag);
        let groups = [
            (self.force_n, [thrust_n; 3], "N"),
            (self.torque_n_m, airframe.largest_torques_n_m(), "N·m"),
            (self.wind_m_s, wind_m_s, "m/s"),
        ];
        let components = NAMES.iter().zip(&groups).flat_map(|(names, (values, limits, unit))| {
            let values = names.iter().zip(values.iter()).zip(limits);
            values.map(|((name, value), limit)| Overload { name, value: *value, limit: *limit, unit })
        });
        let factor = |overload: &Overload| libm::fabs(overload.value) / overload.limit;
        components
            .filter(|overload| factor(overload) > 1.0)
            .max_by(|one, other| factor(one).total_cmp(&factor(other)))
    }
}

impl Airframe {
    /// Largest roll, pitch and yaw torques of the four rotors, N·m, each for itself, from rotors that stand still or turn at
    /// their highest speed.
    fn largest_torques_n_m(&self) -> [f64; 3] {
        let thrust_n = self.thrust_range_n().1 / 4.0;
        let drag_torque_m = self.torque_coefficient_n_m_s2 / self.thrust_coefficient_n_s2;
        let levers_m = [self.arm_length_m, self.arm_length_m, drag_torque_m];
        let allocation = self.layout.allocation();
        core::array::from_fn(|axis| {
            let one_way: f64 = allocation.row(1 + axis).iter().map(|lever| lever.max(0.0)).sum();
            one_way * levers_m[axis] * thrust_n
        })
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use std::string::ToString;

    use nalgebra::Vector3;

    use crate::{Airframe, Disturbance};

    #[test]
    fn largest_excess_is_named_with_what_the_rotors_can_do() {
        let airframe = Airframe::default();
        assert_eq!(Disturbance::default().overload(&airframe), None);
        // k₁ ω² = 5.4675 N each: 21.87 N together, 1.504 N·m about a horizontal axis, 0.243 N·m about the vertical one.
        let weak = Disturbance {
            force_n: Vector3::new(21.8, -21.8, 0.0),
            torque_n_m: Vector3::new(1.5, -1.5, 0.242),
            wind_m_s: Vector3::new(1e9, 0.0, 0.0),
        };
        assert_eq!(weak.overload(&airframe), None);
        let strong = Disturbance {
            force_n: Vector3::new(44.0, 0.0, 0.0),
            torque_n_m: Vector3::new(0.0, 1.6, -1e3),
            ..weak
        };
        let text = strong.overload(&airframe).expect("it is too strong").to_string();
        assert_eq!(
            text,
            "disturbance.torque.z = -1000.0 N·m exceeds what the rotors can counter (0.243 N·m)"
        );
        let windy = Airframe { drag_n_s_m: [0.1, 0.0, 0.0], ..airframe };
        let overload = weak.overload(&windy).expect("it is too strong");
        assert_eq!((overload.name, overload.unit), ("wind.velocity.x", "m/s"));
        assert!((overload.limit - 218.7).abs() < 1e-9, "{overload}");
    }
}
