//! The models of one library: an importer names the one that it wants by its GUID.

use crate::component::Component;
use crate::identity::guid;
use crate::instance::Instance;
use crate::layout::Layout;
use crate::lifecycle::Kind;
use crate::logger::Logger;
use crate::model::Model;
use crate::variables::check_arrays;

/// A model of a library.
pub struct LibraryModel {
    name: &'static str,
    exchanges: bool,
    guid: fn() -> String,
    layout: fn() -> Layout,
    instance: fn(Kind, Logger) -> Box<dyn Component>,
}

impl LibraryModel {
    /// The entry of `M`. It does not compile if elements of an array in [`Model::ARRAYS`] are not neighbours in the table of variables.
    pub const fn of<M: Model>() -> Self {
        const { check_arrays::<M>() };
        Self {
            name: M::IDENTITY.name,
            exchanges: M::CONTINUOUS.is_some(),
            guid: guid::<M>,
            layout: Layout::of::<M>,
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

    /// The variables as FMI 3.0 has them.
    pub(crate) fn layout(&self) -> Layout {
        (self.layout)()
    }

    /// A new instance.
    pub(crate) fn instance(&self, kind: Kind, logger: Logger) -> Box<dyn Component> {
        (self.instance)(kind, logger)
    }
}

/// The model with this GUID; if there is none, a list of those that there are.
pub(crate) fn find<'a>(models: &'a [LibraryModel], guid: &str) -> Result<&'a LibraryModel, String> {
    models.iter().find(|model| model.guid() == guid).ok_or_else(|| {
        let known = models.iter().map(|model| format!("{} ({})", model.guid(), model.name()));
        known.collect::<Vec<_>>().join(", ")
    })
}
