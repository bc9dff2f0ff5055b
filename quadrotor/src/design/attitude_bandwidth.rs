//! How fast the attitude controller closes.

use crate::{Airframe, Configuration, Mixer, PredictionModel};

/// Bandwidth times delay, the rotors' lag and half a sample time. The model knows the delay: the regulator of 0.8 keeps
/// stable when the lag is 3 times as long as believed, or the torque 3 times as large.
const DELAY_SHARE: f64 = 0.8;
/// Largest deviation that is corrected in proportion, rad: beyond it the torque saturates. The program foresees that, so it
/// can be small: a degree and a half of lean moves the vehicle by 0.25 m/s².
const PROPORTIONAL_RAD: f64 = 0.06;

/// The same with the paper's models, which do not know the rotors' lag, and without limits in the program: 6.5 rad/s for
/// the paper's airframe, a fifth of the lag's 33 rad/s, and 3 rad/s about yaw.
const DELAY_SHARE_PROMPT: f64 = 0.2265;
const PROPORTIONAL_PROMPT_RAD: f64 = 0.0765;

/// Share of the largest room of the rotors that is counted on at least. In hover near an end of the rotors' range there is less,
/// and yet the attitude must be held.
const LEAST_ROOM: f64 = 0.1;

/// How fast the attitude controller closes: ω of weights that close a chain of integrators at ω.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AttitudeBandwidth {
    /// Of roll and pitch alike, rad/s: what leans must not depend on the heading.
    pub(crate) lean_rad_s: f64,
    /// Of yaw, rad/s.
    pub(crate) turn_rad_s: f64,
    /// Largest angular acceleration of roll and pitch in hover, the smaller of the two, rad/s².
    pub(crate) available_rad_s2: f64,
    /// How many times longer a turn takes under the largest torque than a lean of the same angle.
    pub(crate) longer: f64,
}

impl AttitudeBandwidth {
    /// From what the airframe can do: ω ≤ c/(T + ΔT/2) with the rotors' lag T, and ω² e ≤ α, the angular acceleration in
    /// hover.
    pub(crate) fn new(configuration: &Configuration, mixer: &Mixer) -> Self {
        let airframe = &configuration.airframe;
        let (share, proportional_rad) = match configuration.controllers.model {
            PredictionModel::InnerLoops => (DELAY_SHARE, PROPORTIONAL_RAD),
            PredictionModel::Paper => (DELAY_SHARE_PROMPT, PROPORTIONAL_PROMPT_RAD),
        };
        let sample_time_s = configuration.controllers.attitude.sample_time_s();
        let fastest = share / (airframe.mean_rotor_lag_s() + sample_time_s / 2.0);
        let [roll, pitch, yaw] = available_rad_s2(airframe, mixer);
        let closed = |acceleration: f64| fastest.min(libm::sqrt(acceleration / proportional_rad));
        let lean = roll.min(pitch);
        // t = 2 √(e/α) from rest to rest.
        Self {
            lean_rad_s: closed(lean),
            turn_rad_s: closed(yaw),
            available_rad_s2: lean,
            longer: libm::sqrt(lean / yaw),
        }
    }
}

/// Largest angular accelerations about each axis alone, rad/s², while the rotors carry the weight.
fn available_rad_s2(airframe: &Airframe, mixer: &Mixer) -> [f64; 3] {
    let hover = mixer.available_torques_n_m(airframe.weight_n(), 0.0);
    let (weakest, strongest) = airframe.thrust_range_n();
    let widest = mixer.largest_torques_n_m((strongest - weakest) / 8.0);
    core::array::from_fn(|axis| hover[axis].max(LEAST_ROOM * widest[axis]) / airframe.inertia_kg_m2[axis])
}

#[cfg(test)]
mod tests {
    use super::AttitudeBandwidth;
    use crate::{Airframe, Configuration, Mixer, PredictionModel};

    fn bandwidth(adjust: impl FnOnce(&mut Configuration)) -> AttitudeBandwidth {
        let mut configuration = Configuration::default();
        adjust(&mut configuration);
        AttitudeBandwidth::new(&configuration, &Mixer::new(&configuration.airframe).expect("a mixer"))
    }

    /// In hover each rotor can lose 6.864655/4 − 0.0675 N: 0.9068 N·m for 0.1063 kg·m² about roll, and 0.1465 N·m for
    /// 0.2122 kg·m² about yaw.
    #[test]
    fn torque_bounds_the_bandwidth_of_the_papers_airframe() {
        let found = bandwidth(|_| ());
        let room_n = 6.864_655 / 4.0 - 0.0675;
        let lean = (2.0 * 0.275 * room_n / 0.1063 / 0.06_f64).sqrt();
        let turn = (4.0 * room_n * 6e-7 / 2.7e-5 / 0.2122 / 0.06_f64).sqrt();
        assert!((found.lean_rad_s - lean).abs() < 1e-12 && (lean - 11.92).abs() < 0.01, "{found:?}");
        assert!((found.longer - lean / turn).abs() < 1e-12);
        assert!((found.turn_rad_s - turn).abs() < 1e-12 && (turn - 3.39).abs() < 0.01, "{found:?}");
    }

    /// 0.8/(0.1 + 0.005) rad/s; manoeuvres take as long as they did.
    #[test]
    fn slow_rotors_bound_it_otherwise() {
        let found = bandwidth(|configuration| configuration.airframe.rotor_time_constant_s = 0.1);
        assert!((found.lean_rad_s - 0.8 / 0.105).abs() < 1e-12, "{found:?}");
        assert!((found.longer - bandwidth(|_| ()).longer).abs() < 1e-12);
    }

    /// Twice the inertia under twice the torque: the same bandwidth; the slower of two axes counts.
    #[test]
    fn it_depends_on_angular_accelerations_alone() {
        let default = bandwidth(|_| ());
        let scaled = bandwidth(|configuration| {
            let airframe = &mut configuration.airframe;
            airframe.mass_kg *= 2.0;
            airframe.thrust_coefficient_n_s2 *= 2.0;
            airframe.torque_coefficient_n_m_s2 *= 2.0;
            airframe.inertia_kg_m2 = airframe.inertia_kg_m2.map(|inertia| 2.0 * inertia);
        });
        assert!((scaled.lean_rad_s - default.lean_rad_s).abs() < 1e-12);
        assert!((scaled.turn_rad_s - default.turn_rad_s).abs() < 1e-12);
        let long = bandwidth(|configuration| configuration.airframe.inertia_kg_m2[1] *= 4.0);
        assert!((long.lean_rad_s - default.lean_rad_s / 2.0).abs() < 1e-12);
    }

    /// Too heavy to hover: the attitude is held with a tenth of the rotors' largest room.
    #[test]
    fn a_vehicle_without_room_has_a_bandwidth_all_the_same() {
        let heavy = Airframe { mass_kg: 2.3, ..Airframe::default() };
        let found = bandwidth(|configuration| configuration.airframe = heavy);
        assert!(found.lean_rad_s > 3.0 && found.turn_rad_s > 0.5, "{found:?}");
    }

    /// What the attitude controller had before its model knew the rotors: 6.5 and 3 rad/s.
    #[test]
    fn the_papers_models_close_more_slowly() {
        let found = bandwidth(|configuration| configuration.controllers.model = PredictionModel::Paper);
        assert!((found.lean_rad_s - 6.47).abs() < 0.01 && (found.turn_rad_s - 3.0).abs() < 0.01, "{found:?}");
    }
}
