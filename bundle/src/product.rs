//! The FMUs that are written: each model of the library, for each version of FMI.

use std::path::PathBuf;

use fmi::description::{model_description, model_description3, terminals_and_icons, terminals_and_icons3};
use fmi::{Experiment, Model};
use fmu::{ClosedLoop, Controller, QuadrotorPlant};
use xtask::workspace::Workspace;

use crate::failure::Failure;
use crate::picture;

/// A version of FMI.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Version {
    /// 2.0
    Two,
    /// 3.0
    Three,
}

/// A model as an FMU.
pub struct Product {
    /// Name of the file and of the library in it, without extensions.
    pub identifier: &'static str,
    descriptions: [fn() -> String; 2],
    terminals: [fn() -> Option<String>; 2],
    /// Its part of the documentation, in `fmu/assets`.
    pub page: &'static str,
    /// The picture of its default experiment over this time, s, as SVG.
    pub picture: fn(f64) -> Result<String, Failure>,
    /// Outputs that its default experiment is about, for each version.
    shown: [&'static str; 2],
    /// Its default experiment.
    pub default_experiment: Experiment,
}

/// Flies with nothing but a reference: `modelDescription.xml` at the root of the repository is its.
pub const CLOSED_LOOP: Product = Product::of::<ClosedLoop>(
    "closed_loop.html",
    picture::of_default_flight,
    ["position.x position.y position.z", "position"],
);

/// Driven by rotor speeds or thrust and torques.
pub const PLANT: Product = Product::of::<QuadrotorPlant>(
    "plant.html",
    picture::of_default_climb,
    ["altitude velocity.z rotor.speed[1]", "altitude velocity rotor.speed"],
);

/// The controllers without a vehicle.
pub const CONTROLLER: Product = Product::of::<Controller>(
    "controller.html",
    picture::of_default_flight,
    ["setpoint.position.z rotor.command[1]", "setpoint.position rotor.command"],
);

/// All of them.
pub const PRODUCTS: [Product; 3] = [CLOSED_LOOP, CONTROLLER, PLANT];

impl Version {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Two, Self::Three];

    /// What the names of its functions begin with.
    pub fn prefix(self) -> &'static str {
        match self {
            Self::Two => "fmi2",
            Self::Three => "fmi3",
        }
    }

    /// How it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Two => "FMI 2.0",
            Self::Three => "FMI 3.0",
        }
    }
}

impl Product {
    const fn of<M: Model>(
        page: &'static str,
        picture: fn(f64) -> Result<String, Failure>,
        shown: [&'static str; 2],
    ) -> Self {
        Self {
            identifier: M::IDENTITY.model_identifier,
            descriptions: [model_description::<M>, model_description3::<M>],
            terminals: [terminals_and_icons::<M>, terminals_and_icons3::<M>],
            page,
            picture,
            shown,
            default_experiment: M::IDENTITY.default_experiment,
        }
    }

    /// The text of its `modelDescription.xml`.
    pub fn description(&self, version: Version) -> String {
        self.descriptions[version as usize]()
    }

    /// The text of its `terminalsAndIcons.xml`, if it has terminals.
    pub fn terminals(&self, version: Version) -> Option<String> {
        self.terminals[version as usize]()
    }

    /// Outputs that its default experiment is about: vectors are arrays in FMI 3.0.
    pub fn shown(&self, version: Version) -> &'static str {
        self.shown[version as usize]
    }

    /// Where it is written: FMUs of FMI 3.0 have a folder of their own.
    pub fn path(&self, workspace: &Workspace, version: Version) -> PathBuf {
        let folder = match version {
            Version::Two => workspace.fmus(),
            Version::Three => workspace.fmus().join("fmi3"),
        };
        folder.join(format!("{}.fmu", self.identifier))
    }
}

#[cfg(test)]
mod tests {
    use xtask::workspace::Workspace;

    use super::{CLOSED_LOOP, Version};

    /// What the other tasks take for the FMU.
    #[test]
    fn the_file_is_named_after_the_model() {
        let workspace = Workspace::find().expect("cargo knows the workspace");
        assert_eq!(workspace.fmu(), CLOSED_LOOP.path(&workspace, Version::Two));
    }
}
