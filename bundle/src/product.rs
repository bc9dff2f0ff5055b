//! The FMUs that are written, each of one model of the library.

use fmi::description::model_description;
use fmi::{Experiment, Model};
use fmu::{ClosedLoop, QuadrotorPlant};

use crate::failure::Failure;
use crate::picture;

/// An FMU.
pub struct Product {
    /// Name of the file and of the library in it, without extensions.
    pub identifier: &'static str,
    /// The text of its `modelDescription.xml`.
    pub description: fn() -> String,
    /// Its part of the documentation, in `fmu/assets`.
    pub page: &'static str,
    /// The picture of its default experiment over this time, s, as SVG.
    pub picture: fn(f64) -> Result<String, Failure>,
    /// Outputs that its default experiment is about.
    pub shown: &'static str,
    /// Its default experiment.
    pub default_experiment: Experiment,
}

/// Flies with nothing but a reference: `modelDescription.xml` at the root of the repository is its.
pub const CLOSED_LOOP: Product = Product::of::<ClosedLoop>(
    "closed_loop.html",
    picture::of_default_flight,
    "position.x position.y position.z",
);

/// Driven by rotor speeds or thrust and torques.
pub const PLANT: Product = Product::of::<QuadrotorPlant>(
    "plant.html",
    picture::of_default_climb,
    "altitude velocity.z rotor.speed[1]",
);

/// All of them.
pub const PRODUCTS: [Product; 2] = [CLOSED_LOOP, PLANT];

impl Product {
    const fn of<M: Model>(
        page: &'static str,
        picture: fn(f64) -> Result<String, Failure>,
        shown: &'static str,
    ) -> Self {
        Self {
            identifier: M::IDENTITY.model_identifier,
            description: model_description::<M>,
            page,
            picture,
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
