//! Designs that instances of one process share.

use std::any::Any;
use std::sync::{Mutex, MutexGuard, PoisonError};

use quadrotor::{Configuration, ConfigurationError, DesignCache, PreparedDesign};

/// How many designs are kept that no instance flies with.
const ROOM: usize = 32;

/// The designs that were asked for latest, and how many instances there are.
static DESIGNS: Mutex<Designs> = Mutex::new(Designs { cache: DesignCache::with_room(ROOM), users: 0 });

struct Designs {
    cache: DesignCache,
    users: usize,
}

fn designs() -> MutexGuard<'static, Designs> {
    DESIGNS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The design of a configuration: made once, as long as there is an instance. Instances that ask at once may each make it.
pub(crate) fn design(configuration: &Configuration) -> Result<PreparedDesign, ConfigurationError> {
    // Designing takes long: meanwhile, others may look.
    let mut known = designs().cache.clone();
    let design = known.design(configuration)?;
    let mut designs = designs();
    if designs.users > 0 {
        designs.cache.keep(&design);
    }
    Ok(design)
}

/// An instance's share in the designs: with the last one they go, so that nothing stays behind in an importer that unloads the library.
pub(crate) fn share() -> Box<dyn Any> {
    designs().users += 1;
    Box::new(Share)
}

struct Share;

impl Drop for Share {
    fn drop(&mut self) {
        let mut designs = designs();
        designs.users -= 1;
        if designs.users == 0 {
            designs.cache = DesignCache::with_room(ROOM);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{design, designs, share};
    use quadrotor::Configuration;

    /// Only this test of the library has shares.
    #[test]
    fn designs_stay_as_long_as_an_instance() {
        let configuration = Configuration::default();
        design(&configuration).expect("flies");
        assert!(designs().cache.find(&configuration).is_none(), "nobody is there to let it go");
        let (one, other) = (share(), share());
        design(&configuration).expect("flies");
        drop(one);
        assert!(designs().cache.find(&configuration).is_some());
        drop(other);
        assert!(designs().cache.find(&configuration).is_none());
    }
}
