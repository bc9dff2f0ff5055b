//! What the controllers steer by, and how they came to their last inputs.

use fmi::Model;
use fmi::variables::{Choice, Variable};
use quadrotor::{Activity, Belief, ControllerActivity, Outputs, PositionReference};

use super::rows::{at_least, count, outcome, output};
use crate::quantities::{ACCELERATION, ANGLE, DRAG_COEFFICIENT, MASS, POSITION, VELOCITY};

/// Outputs with those of the controllers among them.
pub(crate) trait Steered {
    /// φ and θ that the position controller asks of the attitude controller, rad.
    fn tilt_reference_rad(&self) -> [f64; 2];
    /// The reference that the cascade tracks, after shaping.
    fn setpoint(&self) -> &PositionReference;
    /// How the controllers came to their last inputs.
    fn activity(&self) -> &Activity;
    /// What the controllers take the vehicle for.
    fn belief(&self) -> &Belief;
}

impl Steered for Outputs {
    fn tilt_reference_rad(&self) -> [f64; 2] {
        self.tilt_reference_rad
    }

    fn setpoint(&self) -> &PositionReference {
        &self.setpoint
    }

    fn activity(&self) -> &Activity {
        &self.activity
    }

    fn belief(&self) -> &Belief {
        &self.belief
    }
}

/// What `controller.….status` chooses from.
const STATUS: Choice = Choice {
    name: "ControllerStatus",
    description: "Status of a controller's last step",
    items: &[
        ("optimal", "Optimal within all limits"),
        ("relaxed", "No input satisfies all limits: their violation is minimized with the cost"),
        ("iteration_limit", "The solver reached its iteration limit: the previous input is held"),
        ("held", "A value was not finite: the previous input is held"),
    ],
};

/// Items of an enumeration are counted from one.
fn number(activity: &ControllerActivity) -> i32 {
    i32::from(activity.status.severity()) + 1
}

const fn status<M: Model>(
    name: &'static str,
    get: fn(&M::Outputs) -> i32,
    description: &'static str,
) -> Variable<M> {
    outcome(name, STATUS, get, description)
}

// A name that a model does not have stands for nothing.
const HEADING: &[&str] = &["initial.attitude.", "measured.attitude.", "measurement.attitude"];

/// Tilt references and set-point.
#[rustfmt::skip]
pub(crate) const fn set_points<M: Model<Outputs: Steered>>() -> [Variable<M>; 12] {
    [
        output("tilt_reference.phi", &ANGLE, &[], |outputs: &M::Outputs| outputs.tilt_reference_rad()[0], "Roll angle commanded by the position controller"),
        output("tilt_reference.theta", &ANGLE, &[], |outputs: &M::Outputs| outputs.tilt_reference_rad()[1], "Pitch angle commanded by the position controller"),
        output("setpoint.position.x", &POSITION, &["armed", "reference.position.x", "reference.shaping", "initial.position.x", "measured.position.x"], |outputs: &M::Outputs| outputs.setpoint().position_m.x, "Position set-point north, after shaping"),
        output("setpoint.position.y", &POSITION, &["armed", "reference.position.y", "reference.shaping", "initial.position.y", "measured.position.y"], |outputs: &M::Outputs| outputs.setpoint().position_m.y, "Position set-point east, after shaping"),
        output("setpoint.position.z", &POSITION, &["armed", "reference.position.z", "reference.shaping", "initial.position.z", "measured.position.z"], |outputs: &M::Outputs| outputs.setpoint().position_m.z, "Position set-point down, after shaping"),
        output("setpoint.velocity.x", &VELOCITY, &["armed", "reference.velocity.x", "reference.shaping"], |outputs: &M::Outputs| outputs.setpoint().velocity_m_s.x, "Velocity set-point north, after shaping"),
        output("setpoint.velocity.y", &VELOCITY, &["armed", "reference.velocity.y", "reference.shaping"], |outputs: &M::Outputs| outputs.setpoint().velocity_m_s.y, "Velocity set-point east, after shaping"),
        output("setpoint.velocity.z", &VELOCITY, &["armed", "reference.velocity.z", "reference.shaping"], |outputs: &M::Outputs| outputs.setpoint().velocity_m_s.z, "Velocity set-point down, after shaping"),
        output("setpoint.acceleration.x", &ACCELERATION, &["armed", "reference.acceleration.x", "reference.shaping"], |outputs: &M::Outputs| outputs.setpoint().acceleration_m_s2.x, "Acceleration set-point north, after shaping"),
        output("setpoint.acceleration.y", &ACCELERATION, &["armed", "reference.acceleration.y", "reference.shaping"], |outputs: &M::Outputs| outputs.setpoint().acceleration_m_s2.y, "Acceleration set-point east, after shaping"),
        output("setpoint.acceleration.z", &ACCELERATION, &["armed", "reference.acceleration.z", "reference.shaping"], |outputs: &M::Outputs| outputs.setpoint().acceleration_m_s2.z, "Acceleration set-point down, after shaping"),
        output("setpoint.yaw", &ANGLE, HEADING, |outputs: &M::Outputs| outputs.setpoint().yaw_rad, "Heading set-point, after shaping"),
    ]
}

/// Status, active constraints and iterations of the three controllers.
#[rustfmt::skip]
pub(crate) const fn activity<M: Model<Outputs: Steered>>() -> [Variable<M>; 12] {
    [
        status("controller.altitude.status", |outputs: &M::Outputs| number(&outputs.activity().altitude), "Status of the altitude controller's last step"),
        count("controller.altitude.active_constraints", |outputs: &M::Outputs| outputs.activity().altitude.active, "Number of limits that were active in the altitude controller's last step, or clipped its input"),
        count("controller.altitude.iterations", |outputs: &M::Outputs| outputs.activity().altitude.iterations, "Solver iterations in the altitude controller's last step"),
        status("controller.position.status", |outputs: &M::Outputs| number(&outputs.activity().position), "Status of the position controller's last step"),
        count("controller.position.active_constraints", |outputs: &M::Outputs| outputs.activity().position.active, "Number of limits that were active in the position controller's last step, or clipped its input"),
        count("controller.position.iterations", |outputs: &M::Outputs| outputs.activity().position.iterations, "Solver iterations in the position controller's last step"),
        status("controller.attitude.status", |outputs: &M::Outputs| number(&outputs.activity().attitude), "Status of the attitude controller's last step"),
        count("controller.attitude.active_constraints", |outputs: &M::Outputs| outputs.activity().attitude.active, "Number of limits that were active in the attitude controller's last step, or clipped its input"),
        count("controller.attitude.iterations", |outputs: &M::Outputs| outputs.activity().attitude.iterations, "Solver iterations in the attitude controller's last step"),
        count("controller.altitude.status_number", |outputs: &M::Outputs| number(&outputs.activity().altitude) as u32, "controller.altitude.status as an integer, for importers without enumerations"),
        count("controller.position.status_number", |outputs: &M::Outputs| number(&outputs.activity().position) as u32, "controller.position.status as an integer, for importers without enumerations"),
        count("controller.attitude.status_number", |outputs: &M::Outputs| number(&outputs.activity().attitude) as u32, "controller.attitude.status as an integer, for importers without enumerations"),
    ]
}

const MASS_BELIEVED: &[&str] = &["airframe.preset", "airframe.mass", "controller.mass_factor"];

/// What the controllers take the vehicle for.
#[rustfmt::skip]
pub(crate) const fn belief<M: Model<Outputs: Steered>>() -> [Variable<M>; 4] {
    [
        at_least(output("controller.believed_mass", &MASS, MASS_BELIEVED, |outputs: &M::Outputs| outputs.belief().mass_kg, "Mass that the controllers go by: as learned in flight, or as configured"), 0.0),
        output("controller.believed_drag.x", &DRAG_COEFFICIENT, &["airframe.preset", "airframe.drag.x"], |outputs: &M::Outputs| outputs.belief().drag_n_s_m.x, "Drag coefficient north that the controllers go by: as learned in flight, or as configured"),
        output("controller.believed_drag.y", &DRAG_COEFFICIENT, &["airframe.preset", "airframe.drag.y"], |outputs: &M::Outputs| outputs.belief().drag_n_s_m.y, "Drag coefficient east that the controllers go by: as learned in flight, or as configured"),
        output("controller.believed_drag.z", &DRAG_COEFFICIENT, &["airframe.preset", "airframe.drag.z"], |outputs: &M::Outputs| outputs.belief().drag_n_s_m.z, "Drag coefficient down that the controllers go by: as learned in flight, or as configured"),
    ]
}
