//! The models of one library: an importer names the one that it wants by its GUID.

use crate::component::Component;
use crate::identity::guid;
use crate::instance::Instance;
use crate::lifecycle::Kind;
use crate::logger::Logger;
use crate::model::Model;

/// A model of a library.
pub struct LibraryModel {
    name: &'static str,
    exchanges: bool,
    guid: fn() -> String,
    instance: fn(Kind, Logger) -> Box<dyn Component>,
}

impl LibraryModel {
    /// The entry of `M`.
    pub const fn of<M: Model>() -> Self {
        Self {
            name: M::IDENTITY.name,
            exchanges: M::CONTINUOUS.is_some(),
            guid: guid::<M>,
            instance: |kind, logger| Box::new(Instance::<M>::new(kind, logger)),
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

    /// Whether it supports model exchange.
    pub(crate) fn exchanges(&self) -> bool {
        self.exchanges
    }

    /// A new instance.
    pub(crate) fn instance(&self, kind: Kind, logger: Logger) -> Box<dyn Component> {
        (self.instance)(kind, logger)
    }
}
