//! The models of one library: an importer names the one that it wants by its GUID.

use crate::component::Component;
use crate::identity::guid;
use crate::instance::Instance;
use crate::logger::Logger;
use crate::model::Model;

/// A model of a library.
pub struct LibraryModel {
    name: &'static str,
    guid: fn() -> String,
    instance: fn(Logger) -> Box<dyn Component>,
}

impl LibraryModel {
    /// The entry of `M`.
    pub const fn of<M: Model>() -> Self {
        Self {
            name: M::IDENTITY.name,
            guid: guid::<M>,
            instance: |logger| Box::new(Instance::<M>::new(logger)),
        }
    }

    /// Name of the model.
    pub(crate) fn name(&self) -> &'static str {
        self.name
    }

    /// The GUID of its description.
    pub(crate) fn guid(&self) -> String {
        (self.guid)()
    }

    /// A new instance.
    pub(crate) fn instance(&self, logger: Logger) -> Box<dyn Component> {
        (self.instance)(logger)
    }
}
