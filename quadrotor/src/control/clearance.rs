//! Whether the ground may touch the vehicle.

use serde::{Deserialize, Serialize};

use crate::{Airframe, Configuration, GRAVITY_M_S2, Measurement, wrench_of_rotors};

/// So high above a ground plane, m, feet that reach down do not touch it.
const CLEARANCE_M: f64 = 0.1;
/// Rotors that make less than this share of the weight do not carry the vehicle, even one that is believed to be half as heavy again as
/// it is.
const CARRYING_SHARE: f64 = 0.6;
/// Slower than this, m/s, a vehicle that its rotors do not carry stands.
const STANDING_M_S: f64 = 0.5;

/// Whether the ground may touch the vehicle.
///
/// A height above a ground plane is as good as the measured one, and an estimate of that may be wrong by more than an arm. A vehicle
/// that stands while its rotors begin to turn stands on the ground, wherever it takes itself to be.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Clearance {
    /// Where the vehicle stood when its rotors began to turn, until it has left that place: z, NED, m.
    stood_z_m: Option<f64>,
}

impl Clearance {
    /// Begins a flight, if there is a ground plane, of a vehicle that has been measured.
    pub(crate) fn take_off(configuration: &Configuration, first: &Measurement) -> Self {
        let stands = configuration.environment.ground_plane
            && !carries(configuration, &first.rotor_speed_rad_s)
            && (configuration.sensors.output_feedback || first.motion.velocity_m_s.norm() < STANDING_M_S);
        Self { stood_z_m: stands.then_some(first.motion.position_m.z) }
    }

    /// Takes in a measured z, NED, m, above a ground plane: whether nothing touches the vehicle there, in any attitude.
    pub(crate) fn observe(&mut self, configuration: &Configuration, ground_z_m: f64, z_m: f64) -> bool {
        let needed_m = needed_m(&configuration.airframe);
        // Where it sinks, there was no ground.
        self.stood_z_m = self.stood_z_m.filter(|stood_z_m| libm::fabs(stood_z_m - z_m) <= needed_m);
        let is_above = !configuration.environment.ground_plane || ground_z_m - z_m > needed_m;
        is_above && self.stood_z_m.is_none()
    }

    /// All positions are elsewhere: by so much more down, m.
    pub(crate) fn shift(&mut self, by_m: f64) {
        self.stood_z_m = self.stood_z_m.map(|stood_z_m| stood_z_m + by_m);
    }

    /// Whether a flight can have had it: saved states may come from anywhere.
    pub(crate) fn is_possible(&self) -> bool {
        self.stood_z_m.is_none_or(f64::is_finite)
    }
}

/// Height above the ground, m, that is needed for nothing to touch.
fn needed_m(airframe: &Airframe) -> f64 {
    airframe.reach_m() + CLEARANCE_M
}

/// Whether rotors of these speeds, rad/s, carry the vehicle: one that is not clear of the ground stands there otherwise.
pub(crate) fn carries(configuration: &Configuration, rotor_speed_rad_s: &[f64; 4]) -> bool {
    let thrust_n = wrench_of_rotors(&configuration.airframe, rotor_speed_rad_s).thrust_n;
    thrust_n > CARRYING_SHARE * configuration.believed_mass_kg() * GRAVITY_M_S2
}

#[cfg(test)]
mod tests {
    use super::{Clearance, carries};
    use crate::{Configuration, Environment, InitialState, Measurement, PlantState};

    /// With rotors at rest.
    fn first() -> Measurement {
        let PlantState { body, rotor_speed_rad_s, .. } = PlantState::at_rest(&InitialState::default());
        Measurement { motion: body, rotor_speed_rad_s }
    }

    /// A vehicle that takes itself to be 2 m up while it stands on the ground.
    #[test]
    fn where_it_stood_is_the_ground() {
        let environment = Environment { ground_plane: true };
        let configuration = Configuration { environment, ..Configuration::default() };
        let mut first = first();
        first.motion.position_m.z = -2.0;
        let mut standing = Clearance::take_off(&configuration, &first);
        first.rotor_speed_rad_s = [configuration.airframe.hover_rotor_speed_rad_s(); 4];
        let mut flying = Clearance::take_off(&configuration, &first);
        let needed_m = configuration.airframe.reach_m() + 0.1;
        // On the ground, above it, down beside it, and on it by the height.
        for (z_m, expected) in [
            (-2.0, [false, true]),
            (-2.01 - needed_m, [true, true]),
            (-1.0, [true, true]),
            (-0.99 * needed_m, [false, false]),
        ] {
            let seen =
                [&mut standing, &mut flying].map(|clearance| clearance.observe(&configuration, 0.0, z_m));
            assert_eq!(seen, expected, "{z_m} m");
        }
        assert!(!carries(&configuration, &[0.0; 4]) && carries(&configuration, &first.rotor_speed_rad_s));
    }

    /// Rotors that are started while the vehicle falls: it is caught below the place where they were started.
    #[test]
    fn a_vehicle_that_falls_did_not_stand() {
        let configuration =
            Configuration { environment: Environment { ground_plane: true }, ..Configuration::default() };
        let mut falling = first();
        falling.motion.position_m.z = -20.0;
        let mut clearance = Clearance::take_off(&configuration, &falling);
        for (z_m, expected) in [(-19.9, false), (-15.0, true), (-20.0, true)] {
            assert_eq!(clearance.observe(&configuration, 0.0, z_m), expected, "{z_m} m");
        }
    }

    #[test]
    fn without_a_ground_plane_nothing_touches() {
        let mut clearance = Clearance::take_off(&Configuration::default(), &first());
        assert!(clearance.observe(&Configuration::default(), 0.0, 0.0));
    }
}
