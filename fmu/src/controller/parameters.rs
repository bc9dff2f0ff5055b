//! The parameters: those of the configuration that the controllers look at, and what is measured.

use std::borrow::Cow;

use fmi::variables::Variable;
use quadrotor::{Configuration, ConfigurationError, Configured};
use serde::{Deserialize, Serialize};

use super::{Controller, Measurements};
use crate::tables::parameters::{Selection, table};

/// Parameters of the controllers.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct ControllerParameters {
    /// The vehicle as they take it for, and their settings.
    pub configuration: Configuration,
    /// What they measure.
    pub measurements: Measurements,
}

impl Configured for ControllerParameters {
    fn configuration(&self) -> &Configuration {
        &self.configuration
    }

    fn configuration_mut(&mut self) -> &mut Configuration {
        &mut self.configuration
    }
}

/// Far above any ground, m: where the flight begins is not known here, and the ground is only looked at once it flies.
const ABOVE_GROUND_M: f64 = -1e6;

impl ControllerParameters {
    /// The configuration that flies.
    pub(super) fn resolved(&self) -> Result<Configuration, ConfigurationError> {
        let mut configuration = self.configuration.resolved()?;
        configuration.initial.position_m[2] = ABOVE_GROUND_M;
        Ok(configuration)
    }

    /// With the values of the preset.
    pub(super) fn as_read(&self) -> Cow<'_, Self> {
        Cow::Owned(Self { configuration: self.configuration.as_read(), ..*self })
    }
}

/// All but what only a plant knows: the physics that the controllers do not expect, where the flight begins, and the source of its noise.
const SELECTION: Selection = Selection {
    of: &[""],
    without: &[
        "airframe.inertia.xy",
        "airframe.inertia.xz",
        "airframe.inertia.yz",
        "airframe.centre_of_gravity.",
        "airframe.rotor.fall_time_ratio",
        "airframe.rotor.drag_coefficient",
        "airframe.rotor.inflow_coefficient",
        "airframe.rotor.lift_coefficient",
        "airframe.rotor.radius",
        "airframe.rotor.ground_effect",
        "airframe.body_drag.",
        "airframe.battery.",
        "initial.",
        "sensor.seed",
    ],
};
const COUNT: usize = SELECTION.count::<ControllerParameters>();

/// One variable for each of them.
pub(super) const TABLE: [Variable<Controller>; COUNT] = table(SELECTION);

/// What the controllers did not look at before: it comes last, so that no value reference has moved.
const ADDED: Selection = Selection { of: &["airframe.rotor.fall_time_ratio"], without: &[] };
const ADDED_COUNT: usize = ADDED.count::<ControllerParameters>();

/// One variable for each of these.
pub(super) const ADDED_TABLE: [Variable<Controller>; ADDED_COUNT] = table(ADDED);
