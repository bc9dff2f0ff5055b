//! Designs that are used again.

use std::cell::RefCell;

use quadrotor::{Configuration, ConfigurationError, DesignCache, PreparedDesign};

/// The present one, and one that is only tried.
const ROOM: usize = 2;

thread_local! {
    /// The designs that this thread has asked for latest: of the settings that were checked for the vehicle that they are of, or of the
    /// vehicle before in a fleet, which differs in little.
    static DESIGNS: RefCell<DesignCache> = const { RefCell::new(DesignCache::with_room(ROOM)) };
}

/// The design of a configuration. What the last ones have in common with it is not designed again.
///
/// # Errors
/// Those of [`PreparedDesign::new`].
pub(crate) fn design(configuration: &Configuration) -> Result<PreparedDesign, ConfigurationError> {
    DESIGNS.with_borrow_mut(|designs| designs.design(configuration))
}

#[cfg(test)]
mod tests {
    use std::ptr;

    use crate::identity::Identity;
    use crate::parameters::{ParameterTable, ParameterValues, Speed, Statistics};
    use crate::{Vehicle, VehicleSettings};

    /// A vehicle flies with the design that its parameters were checked with, and one at another start with the same numbers.
    #[test]
    fn what_was_checked_is_not_designed_again() {
        let mut settings = VehicleSettings::new(Identity::Px4);
        let mut values = ParameterValues {
            configuration: settings.flown_configuration(),
            conduct: settings.conduct,
            system_id: 1,
            speed: Speed::Factor(1.0),
            statistics: Statistics::default(),
        };
        let table = ParameterTable::new(settings.identity);
        table.set_together(&[("FRAME_MASS", 0.6)], &mut values).expect("it flies");
        let checked = values.check().expect("it flies");
        settings.configuration = values.configuration;
        let vehicle = Vehicle::new(&settings).expect("it flies");
        // Both refer into the design itself.
        assert!(ptr::eq(checked.configuration(), vehicle.simulation().configuration()));
        settings.configuration.initial.position_m[0] = 5.0;
        let other = Vehicle::new(&settings).expect("it flies");
        assert_eq!(other.simulation().design(), vehicle.simulation().design());
    }
}
