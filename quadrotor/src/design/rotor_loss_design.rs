//! The control laws for the loss of each rotor.

use alloc::vec::Vec;

use crate::control::rotor_loss::RotorLossLaw;
use crate::{Configuration, ConfigurationError, ControlError, ValueRange};

/// The control laws for the loss of each rotor, as far as the airframe has them.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RotorLossDesign {
    laws: [Result<RotorLossLaw, ConfigurationError>; 4],
}

impl RotorLossDesign {
    pub(crate) fn new(configuration: &Configuration) -> Self {
        let mut known = Vec::with_capacity(4);
        let law = |lost| {
            let law = RotorLossLaw::new(configuration, lost, &known);
            known.extend(law.clone());
            law
        };
        Self { laws: core::array::from_fn(law) }
    }

    /// Whether two configurations have the same laws, which are about thrusts: neither the mass nor what makes the thrusts is in them.
    pub(crate) fn is_same(one: &Configuration, other: &Configuration) -> bool {
        let depends = |configuration: &Configuration| {
            let airframe = &configuration.airframe;
            (
                (airframe.arm_length_m, airframe.layout),
                airframe.inertia_kg_m2,
                airframe.mean_rotor_lag_s(),
                configuration.controllers.attitude.sample_time_us,
            )
        };
        depends(one) == depends(other)
    }

    /// The law for the loss of a rotor.
    pub(crate) fn of(&self, lost: usize) -> Result<&RotorLossLaw, ControlError> {
        let law = self.laws.get(lost).ok_or(ControlError::NoSuchRotor { rotor: lost })?;
        law.as_ref().map_err(|_| ControlError::NoRotorLossLaw { rotor: lost })
    }

    /// Why there is no law for the loss of a rotor, if there is none.
    pub(crate) fn check(&self, lost: usize) -> Result<(), ConfigurationError> {
        let range = ValueRange { minimum: 0.0, maximum: 3.0, unit: "" };
        let no_such_rotor = ConfigurationError::OutOfRange { name: "lost_rotor", value: lost as f64, range };
        match self.laws.get(lost) {
            None => Err(no_such_rotor),
            Some(Ok(_)) => Ok(()),
            Some(Err(error)) => Err(error.clone()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::RotorLossDesign;
    use crate::control::rotor_loss::RotorLossLaw;
    use crate::{Airframe, Configuration, RotorLayout};

    /// What a law needs to know of the airframe: what is taken over after a change is what would be designed.
    #[test]
    fn the_laws_depend_on_places_inertia_lag_and_sample_time_alone() {
        let configuration = Configuration::default();
        let design = RotorLossDesign::new(&configuration);
        let others: [fn(&mut Configuration); 6] = [
            |other| other.airframe.mass_kg *= 2.0,
            |other| other.airframe.thrust_coefficient_n_s2 *= 2.0,
            |other| other.airframe.rotor_speed_max_rad_s *= 2.0,
            |other| other.airframe.drag_n_s_m = [0.1; 3],
            |other| other.airframe.centre_of_gravity_m = [0.01; 3],
            |other| other.controllers.attitude.output_weight *= 2.0,
        ];
        let those: [fn(&mut Configuration); 5] = [
            |other| other.airframe.arm_length_m *= 2.0,
            |other| other.airframe.layout = RotorLayout::h(1.3),
            |other| other.airframe.inertia_kg_m2[2] *= 1.1,
            |other| other.airframe.rotor_time_constant_s *= 2.0,
            |other| other.controllers.attitude.sample_time_us *= 2,
        ];
        let changes =
            others.map(|change| (change, true)).into_iter().chain(those.map(|change| (change, false)));
        for (index, (change, is_same)) in changes.enumerate() {
            let mut other = configuration;
            change(&mut other);
            assert_eq!(RotorLossDesign::is_same(&configuration, &other), is_same, "change {index}");
            assert_eq!(RotorLossDesign::new(&other) == design, is_same, "change {index}");
        }
    }

    /// In an "H" and with moments of inertia that differ, and where all rotors are alike.
    #[test]
    fn what_is_known_for_another_rotor_is_what_would_be_designed() {
        let different = Airframe { inertia_kg_m2: [0.1, 0.11, 0.2], ..Airframe::default() };
        let stretched = Airframe { layout: RotorLayout::h(1.3), ..Airframe::default() };
        for airframe in [Airframe::default(), different, stretched] {
            let configuration = Configuration { airframe, ..Configuration::default() };
            let together = RotorLossDesign::new(&configuration).laws;
            for (lost, law) in together.iter().enumerate() {
                assert_eq!(*law, RotorLossLaw::new(&configuration, lost, &[]));
                assert!(law.is_ok());
            }
        }
    }
}
