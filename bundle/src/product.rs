//! The FMUs that are written, each of one model of the library.

use fmi::description::{model_description, model_description3};
use fmi::{Experiment, Model};
use fmu::ClosedLoop;

/// An FMU.
pub struct Product {
    /// Name of the file and of the library in it, without extensions.
    pub identifier: &'static str,
    /// The text of its `modelDescription.xml`.
    pub description: fn() -> String,
    /// That of its FMI 3.0 version.
    pub description3: fn() -> String,
    /// Its part of the documentation, in `fmu/assets`.
    pub page: &'static str,
    /// Outputs that its default experiment is about.
    pub shown: &'static str,
    /// Its default experiment.
    pub default_experiment: Experiment,
}

/// Flies with nothing but a reference: `modelDescription.xml` at the root of the repository is its.
pub const CLOSED_LOOP: Product =
    Product::of::<ClosedLoop>("closed_loop.html", "position.x position.y position.z");

/// All of them.
pub const PRODUCTS: [Product; 1] = [CLOSED_LOOP];

impl Product {
    const fn of<M: Model>(page: &'static str, shown: &'static str) -> Self {
        Self {
            identifier: M::IDENTITY.model_identifier,
            description: model_description::<M>,
            description3: model_description3::<M>,
            page,
            shown,
            default_experiment: M::IDENTITY.default_experiment,
        }
    }
}

#[cfg(test)]
mod tests {
    use xtask::workspace::Workspace;

    use super::CLOSED_LOOP;

    /// What the other tasks take for the FMU.
    #[test]
    fn the_file_is_named_after_the_model() {
        let workspace = Workspace::find().expect("cargo knows the workspace");
        let name = format!("{}.fmu", CLOSED_LOOP.identifier);
        assert_eq!(workspace.fmu(), workspace.fmus().join(name));
    }
}
