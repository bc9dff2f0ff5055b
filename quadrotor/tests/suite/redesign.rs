//! What a change of tunable parameters redesigns.

use crate::common::KINDS;
use quadrotor::{
    CascadeDesign, Configuration, ControllerKind, Inputs, PredictionModel, Redesigned, RotorLayout,
    Simulation,
};

const NONE: Redesigned = Redesigned { altitude: false, position: false, attitude: false, estimator: false };

fn redesigned(kind: ControllerKind, change: impl Fn(&mut Configuration)) -> Redesigned {
    let mut configuration = Configuration::default();
    configuration.controllers.kind = kind;
    let mut design = CascadeDesign::new(&configuration).unwrap();
    let mut changed = configuration;
    change(&mut changed);
    let redesigned = design.redesign(&configuration, &changed).unwrap();
    // However it came about, it is the design of the configuration.
    assert_eq!(design, CascadeDesign::new(&changed).unwrap());
    redesigned
}

/// Limits are values at each sample, not part of a design.
#[test]
fn limits_redesign_nothing() {
    let none = redesigned(ControllerKind::Lmpc, |changed| {
        changed.limits.tilt_rad = 0.5;
        changed.limits.speed_horizontal_m_s = 3.0;
        changed.limits.speed_up_m_s = 1.0;
        changed.limits.thrust_max = 1.5;
        changed.limits.yaw_rate_rad_s = 0.2;
    });
    assert_eq!(none, NONE);
}

#[test]
fn weights_redesign_the_controller_that_has_them() {
    for kind in KINDS {
        let altitude = redesigned(kind, |changed| changed.controllers.altitude.increment_weight *= 2.0);
        assert_eq!(altitude, Redesigned { altitude: true, ..NONE });
        let position = redesigned(kind, |changed| changed.controllers.position.output_weight *= 2.0);
        assert_eq!(position, Redesigned { position: true, ..NONE });
        let attitude = redesigned(kind, |changed| changed.controllers.attitude.rate_weight *= 2.0);
        // The position controller predicts the closed attitude loop.
        assert_eq!(attitude, Redesigned { attitude: true, position: true, ..NONE });
    }
}

#[test]
fn another_kind_and_other_models_redesign_all_controllers() {
    let all = Redesigned { altitude: true, position: true, attitude: true, ..NONE };
    assert_eq!(
        redesigned(ControllerKind::Lmpc, |changed| changed.controllers.kind = ControllerKind::Dlqr),
        all
    );
    assert_eq!(
        redesigned(ControllerKind::Lmpc, |changed| changed.controllers.model = PredictionModel::Paper),
        all
    );
}

#[test]
fn noise_redesigns_the_estimator() {
    let estimator = redesigned(ControllerKind::Lmpc, |changed| changed.sensors.position_noise_m = 0.1);
    assert_eq!(estimator, Redesigned { estimator: true, ..NONE });
    // Noisy velocities are filtered.
    let estimator = redesigned(ControllerKind::Lmpc, |changed| changed.sensors.velocity_noise_m_s = 0.1);
    assert_eq!(estimator, Redesigned { estimator: true, ..NONE });
    let estimator = redesigned(ControllerKind::Lmpc, |changed| changed.sensors.body_rate_noise_rad_s = 0.1);
    assert_eq!(estimator, Redesigned { estimator: true, ..NONE });
}

/// The controllers predict the rotors; the attitude controller keeps their limits.
#[test]
fn another_airframe_has_other_controllers() {
    let all = redesigned(ControllerKind::Lmpc, |changed| {
        changed.airframe.layout = RotorLayout::x();
        changed.airframe.rotor_speed_max_rad_s = 400.0;
        changed.airframe.rotor_time_constant_s = 0.02;
    });
    assert_eq!(all, Redesigned { estimator: false, altitude: true, position: true, attitude: true });
    // The altitude controller commands accelerations: the mass is not in its model.
    let heavier = redesigned(ControllerKind::Lmpc, |changed| changed.airframe.mass_kg = 0.8);
    assert_eq!(heavier, Redesigned { attitude: true, position: true, ..NONE });
    assert_eq!(redesigned(ControllerKind::Lmpc, |changed| changed.controllers.mass_factor = 1.2), NONE);
}

/// A configuration that is refused changes nothing, also when some of its controllers could be designed.
#[test]
fn a_refused_change_changes_nothing() {
    let configuration = Configuration::default();
    let mut flight = Simulation::new(&configuration, &Inputs::default()).unwrap();
    let before = flight.clone();
    let mut changed = configuration;
    changed.controllers.altitude.increment_weight *= 2.0;
    changed.limits.tilt_acceleration_rad_s2 = 400.0;
    assert!(flight.reconfigure(&changed).is_err());
    assert_eq!(flight, before);
}
