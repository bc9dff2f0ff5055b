//! Designs that were asked for lately.

use alloc::vec::Vec;

use crate::{Configuration, ConfigurationError, PARAMETERS, PreparedDesign};

/// The designs that were asked for latest, so that each configuration is designed once.
///
/// A configuration is known when all of its numbers have the same bits: the design is the one that it would get anew.
///
/// ```
/// use quadrotor::{Configuration, DesignCache};
///
/// let mut cache = DesignCache::with_room(16);
/// let design = cache.design(&Configuration::default())?;
/// assert_eq!(cache.find(&Configuration::default()), Some(design));
/// # Ok::<(), quadrotor::ConfigurationError>(())
/// ```
#[derive(Clone, Debug)]
pub struct DesignCache {
    room: usize,
    /// The latest one last.
    known: Vec<PreparedDesign>,
}

impl DesignCache {
    /// An empty cache with room for so many designs of about 90 kB each, which live as long as it or a flight with them.
    pub const fn with_room(room: usize) -> Self {
        Self { room, known: Vec::new() }
    }

    /// The design of a configuration, if it is known.
    pub fn find(&mut self, configuration: &Configuration) -> Option<PreparedDesign> {
        let place = self.known.iter().rposition(|known| is_same(known.configuration(), configuration))?;
        let design = self.known.remove(place);
        self.known.push(design.clone());
        Some(design)
    }

    /// Keeps a design, in place of the one that was not asked for the longest if there is no room.
    pub fn keep(&mut self, design: &PreparedDesign) {
        if self.room == 0 || self.find(design.configuration()).is_some() {
            return;
        }
        if self.known.len() >= self.room {
            self.known.remove(0);
        }
        self.known.push(design.clone());
    }

    /// The design of a configuration: the known one, or a new one, which is kept. What a new one has in common with the one that was asked
    /// for last is [taken over](PreparedDesign::adapted) from that.
    ///
    /// # Errors
    /// Those of [`PreparedDesign::new`].
    pub fn design(&mut self, configuration: &Configuration) -> Result<PreparedDesign, ConfigurationError> {
        if let Some(design) = self.find(configuration) {
            return Ok(design);
        }
        let design = match self.known.last() {
            Some(latest) => latest.adapted(configuration)?,
            None => PreparedDesign::new(configuration)?,
        };
        self.keep(&design);
        Ok(design)
    }
}

/// Whether two configurations are the same, bit for bit. Equal ones can differ in the signs of their zeros.
pub(crate) fn is_same(one: &Configuration, other: &Configuration) -> bool {
    one == other && bits(one).eq(bits(other))
}

/// The bits of all parameters, and of the rotors' places.
fn bits(configuration: &Configuration) -> impl Iterator<Item = u64> + '_ {
    let rotors = configuration.airframe.layout.rotors.iter();
    let places = rotors.flat_map(|rotor| [rotor.x.to_bits(), rotor.y.to_bits()]);
    PARAMETERS.iter().map(|parameter| parameter.access.bits(configuration)).chain(places)
}

impl Configuration {
    /// A number that is equal for configurations that are equal bit for bit, and hardly ever for others: a key for finding equal ones
    /// among many. Other versions of this crate may return other numbers.
    pub fn fingerprint(&self) -> u64 {
        hashed(bits(self))
    }
}

/// A number that is equal for equal bits, and hardly ever for others: FNV-1a by words.
pub(crate) fn hashed(bits: impl Iterator<Item = u64>) -> u64 {
    // The turn brings the upper bits, in which numbers differ most, to all others.
    bits.fold(0xcbf2_9ce4_8422_2325, |hash: u64, bits| {
        (hash.rotate_left(23) ^ bits).wrapping_mul(0x0100_0000_01b3)
    })
}

#[cfg(test)]
mod tests {
    use alloc::collections::BTreeSet;
    use alloc::sync::Arc;

    use super::DesignCache;
    use crate::{Configuration, ControllerKind, PredictionModel, PreparedDesign, RotorLayout};

    fn of_mass(mass_kg: f64) -> Configuration {
        let mut configuration = Configuration::default();
        configuration.airframe.mass_kg = mass_kg;
        configuration
    }

    fn are_one(one: &PreparedDesign, other: &PreparedDesign) -> bool {
        Arc::ptr_eq(&one.design, &other.design)
    }

    #[test]
    fn a_known_configuration_gets_the_design_that_there_is() {
        let mut cache = DesignCache::with_room(2);
        let light = cache.design(&of_mass(0.6)).unwrap();
        let heavy = cache.design(&of_mass(0.7)).unwrap();
        assert!(!are_one(&light, &heavy));
        assert!(are_one(&cache.design(&of_mass(0.6)).unwrap(), &light));
        assert_eq!(light, PreparedDesign::new(&of_mass(0.6)).unwrap());
        // The one that was asked for the longest ago makes room.
        cache.design(&of_mass(0.8)).unwrap();
        assert!(cache.find(&of_mass(0.7)).is_none());
        assert!(are_one(&cache.find(&of_mass(0.6)).unwrap(), &light));
    }

    /// Whatever differs: the start, a controller, the airframe, the noise, limits, or nothing that a design depends on.
    #[test]
    fn what_is_taken_over_is_what_would_be_designed() {
        let changes: [fn(&mut Configuration); 9] = [
            |changed| changed.initial.position_m = [3.0, -2.0, -7.0],
            |changed| changed.airframe.mass_kg = 0.7,
            |changed| changed.airframe.layout = RotorLayout::h(1.2),
            |changed| changed.airframe.rotor_time_constant_s = 0.04,
            |changed| changed.controllers.position.terms = 6,
            |changed| changed.controllers.kind = ControllerKind::Dlqr,
            |changed| changed.sensors.position_noise_m = 0.02,
            |changed| changed.limits.tilt_rad = 0.3,
            |changed| changed.environment.ground_plane = true,
        ];
        let mut cache = DesignCache::with_room(1);
        cache.design(&Configuration::default()).unwrap();
        // Each on top of those before, and back.
        let mut changed = Configuration::default();
        for change in changes {
            change(&mut changed);
            assert_eq!(cache.design(&changed).unwrap(), PreparedDesign::new(&changed).unwrap());
        }
        let first = Configuration::default();
        assert_eq!(cache.design(&first).unwrap(), PreparedDesign::new(&first).unwrap());
        // A refusal does not blame what was designed before.
        changed = first;
        changed.controllers.model = PredictionModel::Paper;
        changed.airframe.rotor_time_constant_s = 0.06;
        assert_eq!(cache.design(&changed), PreparedDesign::new(&changed));
        assert!(cache.design(&changed).is_err());
    }

    /// A fleet that starts at different places keeps its controllers once.
    #[test]
    fn another_start_shares_the_controllers() {
        let mut cache = DesignCache::with_room(2);
        let mut configuration = Configuration::default();
        let here = cache.design(&configuration).unwrap();
        configuration.initial.position_m[0] = 5.0;
        let there = cache.design(&configuration).unwrap();
        assert!(!are_one(&here, &there) && Arc::ptr_eq(&here.design.cascade, &there.design.cascade));
        configuration.controllers.position.terms = 6;
        let other = cache.design(&configuration).unwrap();
        assert!(!Arc::ptr_eq(&there.design.cascade, &other.design.cascade));
    }

    #[test]
    fn the_sign_of_a_zero_is_another_configuration() {
        let mut cache = DesignCache::with_room(4);
        let (configuration, mut other) = (Configuration::default(), Configuration::default());
        cache.design(&configuration).unwrap();
        other.initial.position_m[0] = -0.0;
        assert_eq!(configuration, other);
        assert!(cache.find(&other).is_none());
        other = configuration;
        other.airframe.layout.rotors[0].y = -0.0;
        assert_eq!(configuration, other);
        assert!(cache.find(&other).is_none());
    }

    #[test]
    fn fingerprints_are_those_of_the_bits() {
        let fingerprints: BTreeSet<u64> =
            (0..1_000).map(|vehicle| of_mass(0.5 + 1e-6 * f64::from(vehicle)).fingerprint()).collect();
        assert_eq!(fingerprints.len(), 1_000);
        assert_eq!(of_mass(0.6).fingerprint(), of_mass(0.6).fingerprint());
        let mut other = Configuration::default();
        other.airframe.layout.rotors[0].y = -0.0;
        assert_ne!(other.fingerprint(), Configuration::default().fingerprint());
    }

    #[test]
    fn what_cannot_be_designed_is_not_kept() {
        let mut cache = DesignCache::with_room(4);
        assert!(cache.design(&of_mass(-1.0)).is_err());
        assert!(cache.find(&of_mass(-1.0)).is_none());
    }
}
