//! Figures of the three designs, as calculated parameters.

use fmi::Model;
use fmi::variables::Variable;
use quadrotor::CascadeDesign;

use crate::quantities::NUMBER;

/// A model with controllers.
pub(crate) trait Designed {
    /// Its controllers.
    fn design(&self) -> &CascadeDesign;
}

/// What is logged when initialization ends.
pub(crate) fn initialized(design: &CascadeDesign) -> String {
    let radii = design.reports().map(|(name, report)| format!("{name} {:.4}", report.spectral_radius));
    format!("initialized; spectral radii of the closed loops: {}", radii.join(", "))
}

/// One figure of the controller at `$index` of [`quadrotor::CascadeDesign::reports`].
macro_rules! figure {
    ($name:literal, $index:literal, $field:ident, $depends_on:expr, $description:literal) => {
        Variable::calculated($name, $description, $depends_on, &NUMBER, |model: &M| {
            model.design().reports()[$index].1.$field
        })
    };
}

// The models have the loop inside and the drag per believed mass, and bandwidths follow from the whole airframe.
const ALTITUDE: &[&str] =
    &["controller.altitude.", "controller.model", "controller.mass_factor", "airframe."];
const POSITION: &[&str] = &[
    "controller.position.",
    "controller.attitude.",
    "controller.kind",
    "controller.model",
    "controller.mass_factor",
    "airframe.",
];
const ATTITUDE: &[&str] = &["controller.attitude.", "controller.model", "airframe."];

/// Spectral radius, distance from the regulator's and condition number of each design.
#[rustfmt::skip]
pub(crate) const fn figures<M: Model + Designed>() -> [Variable<M>; 9] {
    [
        figure!("controller.altitude.spectral_radius", 0, spectral_radius, ALTITUDE, "Largest magnitude of the closed-loop eigenvalues of the altitude controller's Laguerre design without limits"),
        figure!("controller.altitude.eigenvalue_difference_to_dlqr", 0, eigenvalue_difference_to_dlqr, ALTITUDE, "Spectral radius of the altitude controller's Laguerre design minus that of the infinite-horizon regulator (DLQR)"),
        figure!("controller.altitude.condition_number", 0, condition_number, ALTITUDE, "Condition number of Omega of the altitude controller's Laguerre design"),
        figure!("controller.position.spectral_radius", 1, spectral_radius, POSITION, "Largest magnitude of the closed-loop eigenvalues of the position controller's Laguerre design without limits"),
        figure!("controller.position.eigenvalue_difference_to_dlqr", 1, eigenvalue_difference_to_dlqr, POSITION, "Spectral radius of the position controller's Laguerre design minus that of the infinite-horizon regulator (DLQR)"),
        figure!("controller.position.condition_number", 1, condition_number, POSITION, "Condition number of Omega of the position controller's Laguerre design"),
        figure!("controller.attitude.spectral_radius", 2, spectral_radius, ATTITUDE, "Largest magnitude of the closed-loop eigenvalues of the attitude controller's Laguerre design without limits"),
        figure!("controller.attitude.eigenvalue_difference_to_dlqr", 2, eigenvalue_difference_to_dlqr, ATTITUDE, "Spectral radius of the attitude controller's Laguerre design minus that of the infinite-horizon regulator (DLQR)"),
        figure!("controller.attitude.condition_number", 2, condition_number, ATTITUDE, "Condition number of Omega of the attitude controller's Laguerre design"),
    ]
}
