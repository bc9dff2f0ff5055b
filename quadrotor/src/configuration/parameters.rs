//! Every number of a [`Configuration`](crate::Configuration) by its public name: the one source of names,
//! units and ranges for the FMU's variables, the vehicle's parameters and the validation.

use crate::configuration::parameter::{Access, Choice, Mutability, Parameter};
use crate::configuration::unit::Unit;
use crate::design::capacities::{MOST_MOVES, MOST_TERMS};
use crate::{AirframePreset, Configuration, ControllerKind, PredictionModel};

/// A real parameter: name, unit, variability, range, place and description.
macro_rules! real {
    ($name:literal, $unit:ident, $mutability:ident, $minimum:literal..=$maximum:literal, $($field:tt).+ $([$index:literal])?, $description:literal) => {
        Parameter {
            name: $name,
            description: $description,
            unit: Unit::$unit,
            mutability: $mutability,
            access: Access::Real {
                minimum: $minimum,
                maximum: $maximum,
                get: |settings: &Self| settings.configuration().$($field).+ $([$index])?,
                set: |settings: &mut Self, value| settings.configuration_mut().$($field).+ $([$index])? = value,
            },
        }
    };
}

macro_rules! integer {
    ($name:literal, $minimum:literal..=$maximum:expr, $($field:tt).+, $description:literal) => {
        Parameter {
            name: $name,
            description: $description,
            unit: Unit::One,
            mutability: STRUCTURAL,
            access: Access::Integer {
                minimum: $minimum,
                maximum: $maximum as i32,
                get: |settings: &Self| i32::try_from(settings.configuration().$($field).+).unwrap_or(i32::MAX),
                set: |settings: &mut Self, value| settings.configuration_mut().$($field).+ = u32::try_from(value).unwrap_or(0),
            },
        }
    };
}

macro_rules! boolean {
    ($name:literal, $mutability:ident, $($field:tt).+, $description:literal) => {
        Parameter {
            name: $name,
            description: $description,
            unit: Unit::One,
            mutability: $mutability,
            access: Access::Boolean {
                get: |settings: &Self| settings.configuration().$($field).+,
                set: |settings: &mut Self, value| settings.configuration_mut().$($field).+ = value,
            },
        }
    };
}

/// Structure and time base of one controller, the same for all three.
macro_rules! sample_time {
    ($name:literal, $controller:ident, $description:literal) => {
        Parameter {
            name: $name,
            description: $description,
            unit: Unit::Second,
            mutability: STRUCTURAL,
            access: Access::Real {
                minimum: 0.001,
                maximum: 1.0,
                get: |settings: &Self| settings.configuration().controllers.$controller.sample_time_s(),
                set: |settings: &mut Self, value| {
                    // Saturates: NaN becomes 0, which is out of range.
                    settings.configuration_mut().controllers.$controller.sample_time_us =
                        libm::round(value * 1e6) as u64;
                },
            },
        }
    };
}

/// What `controller.kind` chooses from.
const CONTROLLER_KINDS: [ControllerKind; 3] =
    [ControllerKind::Lmpc, ControllerKind::StateSpaceMpc, ControllerKind::Dlqr];

static CONTROLLER_KIND: Choice = Choice {
    name: "ControllerKind",
    description: "Controller in use",
    items: &[
        ("lmpc", "Laguerre MPC under limits"),
        ("ssmpc", "State-space MPC under limits"),
        ("dlqr", "Discrete linear-quadratic regulator with integral action"),
    ],
};

/// What `controller.model` chooses from.
const PREDICTION_MODELS: [PredictionModel; 2] = [PredictionModel::InnerLoops, PredictionModel::Paper];

static PREDICTION_MODEL: Choice = Choice {
    name: "PredictionModel",
    description: "Models that the controllers predict with",
    items: &[
        ("inner_loops", "With the loop inside: the attitude with the lag of the rotors"),
        ("paper", "As the paper prints them: inputs act at once"),
    ],
};

/// What `airframe.preset` chooses from: [`AirframePreset::ALL`].
static AIRFRAME_PRESET: Choice = Choice {
    name: "AirframePreset",
    description: "Airframe with published parameters",
    items: &[
        (AirframePreset::ALL[0].name(), AirframePreset::ALL[0].description()),
        (AirframePreset::ALL[1].name(), AirframePreset::ALL[1].description()),
        (AirframePreset::ALL[2].name(), AirframePreset::ALL[2].description()),
        (AirframePreset::ALL[3].name(), AirframePreset::ALL[3].description()),
        (AirframePreset::ALL[4].name(), AirframePreset::ALL[4].description()),
    ],
};

const TUNABLE: Mutability = Mutability::Tunable;
const STRUCTURAL: Mutability = Mutability::Structural;
const START: Mutability = Mutability::Start;

/// Settings that contain a [`Configuration`], as those of a controller or of a plant alone do.
pub trait Configured: Sized + 'static {
    /// The configuration.
    fn configuration(&self) -> &Configuration;

    /// The configuration, to be changed.
    fn configuration_mut(&mut self) -> &mut Configuration;

    /// All parameters of the configuration, in the order in which they are documented, with their places in these settings.
    #[rustfmt::skip] // One line per parameter reads as the table that it is.
    const PARAMETERS: &'static [Parameter<Self>] = &[
        Parameter {
            name: "airframe.preset",
            description: "Airframe: 1 = paper (0.7 kg), 2 = crazyflie (28 g), 3 = hummingbird (0.7 kg), 4 = iris (1.5 kg), 5 = heavy (10 kg). Parameters of airframe, limits and controller that are at their start values follow it; others keep the value that is set",
            unit: Unit::One,
            mutability: START,
            access: Access::Enumeration {
                choice: &AIRFRAME_PRESET,
                get: |settings: &Self| (1..).zip(AirframePreset::ALL).find(|(_, preset)| *preset == settings.configuration().preset).map_or(1, |(item, _)| item),
                set: |settings: &mut Self, value| {
                    if let Some((_, preset)) = (1..).zip(AirframePreset::ALL).find(|(item, _)| *item == value) {
                        settings.configuration_mut().preset = preset;
                    }
                },
            },
        },
        real!("airframe.mass", Kilogram, STRUCTURAL, 0.005..=50.0, airframe.mass_kg, "Mass m (Table 1)"),
        real!("airframe.arm_length", Metre, STRUCTURAL, 0.02..=5.0, airframe.arm_length_m, "Arm length l from the centre of mass to each rotor (Table 1)"),
        real!("airframe.inertia.x", KilogramSquareMetre, STRUCTURAL, 1e-6..=100.0, airframe.inertia_kg_m2[0], "Moment of inertia J_x about the forward axis (Table 1)"),
        real!("airframe.inertia.y", KilogramSquareMetre, STRUCTURAL, 1e-6..=100.0, airframe.inertia_kg_m2[1], "Moment of inertia J_y about the right axis (Table 1)"),
        real!("airframe.inertia.z", KilogramSquareMetre, STRUCTURAL, 1e-6..=100.0, airframe.inertia_kg_m2[2], "Moment of inertia J_z about the down axis (Table 1)"),
        real!("airframe.inertia.xy", KilogramSquareMetre, STRUCTURAL, -100.0..=100.0, airframe.products_of_inertia_kg_m2[0], "Entry J_xy of the inertia tensor, minus the integral of x y dm; the controllers ignore it"),
        real!("airframe.inertia.xz", KilogramSquareMetre, STRUCTURAL, -100.0..=100.0, airframe.products_of_inertia_kg_m2[1], "Entry J_xz of the inertia tensor, minus the integral of x z dm; the controllers ignore it"),
        real!("airframe.inertia.yz", KilogramSquareMetre, STRUCTURAL, -100.0..=100.0, airframe.products_of_inertia_kg_m2[2], "Entry J_yz of the inertia tensor, minus the integral of y z dm; the controllers ignore it"),
        real!("airframe.centre_of_gravity.x", Metre, STRUCTURAL, -1.0..=1.0, airframe.centre_of_gravity_m[0], "Centre of mass forward of the rotors' centre; the controllers ignore it"),
        real!("airframe.centre_of_gravity.y", Metre, STRUCTURAL, -1.0..=1.0, airframe.centre_of_gravity_m[1], "Centre of mass right of the rotors' centre; the controllers ignore it"),
        real!("airframe.centre_of_gravity.z", Metre, STRUCTURAL, -1.0..=1.0, airframe.centre_of_gravity_m[2], "Centre of mass below the rotors' centre; the controllers ignore it"),
        real!("airframe.rotor.thrust_coefficient", NewtonSecondSquared, STRUCTURAL, 1e-9..=0.1, airframe.thrust_coefficient_n_s2, "k1 of (1): thrust of a rotor is k1 times its squared speed"),
        real!("airframe.rotor.torque_coefficient", NewtonMetreSecondSquared, STRUCTURAL, 1e-11..=0.01, airframe.torque_coefficient_n_m_s2, "k2 of (1): drag torque of a rotor is k2 times its squared speed"),
        real!("airframe.rotor.speed_min", RadianPerSecond, STRUCTURAL, 0.0..=5000.0, airframe.rotor_speed_min_rad_s, "Lowest rotor speed while armed"),
        real!("airframe.rotor.speed_max", RadianPerSecond, STRUCTURAL, 1.0..=10000.0, airframe.rotor_speed_max_rad_s, "Highest rotor speed"),
        real!("airframe.rotor.time_constant", Second, STRUCTURAL, 0.002..=1.0, airframe.rotor_time_constant_s, "Time constant of the first-order rotor lag"),
        real!("airframe.rotor.fall_time_ratio", One, STRUCTURAL, 0.1..=10.0, airframe.rotor_spin.fall_time_ratio, "Time constant of a falling rotor speed as a multiple of airframe.rotor.time_constant"),
        real!("airframe.rotor.inertia", KilogramSquareMetre, STRUCTURAL, 0.0..=1.0, airframe.rotor_spin.inertia_kg_m2, "Moment of inertia of one rotor about its axis: gyroscopic torque and reaction to spin-up; 0 disables both"),
        real!("airframe.rotor.drag_coefficient", NewtonSecondSquaredPerMetre, STRUCTURAL, 0.0..=0.003, airframe.rotor_aerodynamics.drag_coefficient_n_s2_m, "Drag of a rotor in its plane per rotor speed and lateral airspeed; 0 disables it"),
        real!("airframe.rotor.inflow_coefficient", NewtonSecondSquaredPerMetre, STRUCTURAL, 0.0..=0.01, airframe.rotor_aerodynamics.inflow_coefficient_n_s2_m, "Thrust that a rotor loses per rotor speed and climb rate along its axis; 0 disables it"),
        real!("airframe.rotor.lift_coefficient", NewtonSecondSquaredPerSquareMetre, STRUCTURAL, 0.0..=1.0, airframe.rotor_aerodynamics.translational_lift_coefficient_n_s2_m2, "Thrust that a rotor gains per squared lateral airspeed (translational lift); 0 disables it"),
        real!("airframe.rotor.radius", Metre, STRUCTURAL, 0.005..=2.0, airframe.rotor_aerodynamics.radius_m, "Radius of a propeller, for the ground effect"),
        boolean!("airframe.rotor.ground_effect", STRUCTURAL, airframe.rotor_aerodynamics.ground_effect, "Whether rotors gain thrust near the ground (Cheeseman and Bennett); needs environment.ground_plane"),
        real!("airframe.drag.x", NewtonSecondPerMetre, STRUCTURAL, 0.0..=10.0, airframe.drag_n_s_m[0], "Linear drag along north"),
        real!("airframe.drag.y", NewtonSecondPerMetre, STRUCTURAL, 0.0..=10.0, airframe.drag_n_s_m[1], "Linear drag along east"),
        real!("airframe.drag.z", NewtonSecondPerMetre, STRUCTURAL, 0.0..=10.0, airframe.drag_n_s_m[2], "Linear drag along down"),
        real!("airframe.body_drag.x", NewtonSecondPerMetre, STRUCTURAL, 0.0..=10.0, airframe.body_drag_n_s_m[0], "Linear drag along the forward axis of the body, in addition to airframe.drag"),
        real!("airframe.body_drag.y", NewtonSecondPerMetre, STRUCTURAL, 0.0..=10.0, airframe.body_drag_n_s_m[1], "Linear drag along the right axis of the body, in addition to airframe.drag"),
        real!("airframe.body_drag.z", NewtonSecondPerMetre, STRUCTURAL, 0.0..=10.0, airframe.body_drag_n_s_m[2], "Linear drag along the down axis of the body, in addition to airframe.drag"),
        boolean!("airframe.battery.sag", STRUCTURAL, airframe.battery.sag, "Whether rotor speeds scale with the battery's voltage, which falls under load and as the battery is drained"),
        real!("airframe.battery.voltage", Volt, STRUCTURAL, 1.0..=1000.0, airframe.battery.voltage_v, "Voltage of the full battery without load, at which rotors reach their commanded speeds"),
        real!("airframe.battery.resistance", Ohm, STRUCTURAL, 0.0..=10.0, airframe.battery.resistance_ohm, "Internal resistance of the battery with its wiring"),
        real!("airframe.battery.capacity", AmpereSecond, STRUCTURAL, 1.0..=1e7, airframe.battery.capacity_a_s, "Charge of the full battery; 3600 A s are 1 A h"),
        boolean!("environment.ground_plane", START, environment.ground_plane, "Whether there is a ground plane at z = 0; the flight must then start above it"),
        real!("initial.position.x", Metre, START, -1e6..=1e6, initial.position_m[0], "Initial position north"),
        real!("initial.position.y", Metre, START, -1e6..=1e6, initial.position_m[1], "Initial position east"),
        real!("initial.position.z", Metre, START, -1e6..=1e6, initial.position_m[2], "Initial position down"),
        real!("initial.velocity.x", MetrePerSecond, START, -100.0..=100.0, initial.velocity_m_s[0], "Initial velocity north"),
        real!("initial.velocity.y", MetrePerSecond, START, -100.0..=100.0, initial.velocity_m_s[1], "Initial velocity east"),
        real!("initial.velocity.z", MetrePerSecond, START, -100.0..=100.0, initial.velocity_m_s[2], "Initial velocity down"),
        real!("initial.attitude.phi", Radian, START, -6.3..=6.3, initial.attitude_rad[0], "Initial roll angle"),
        real!("initial.attitude.theta", Radian, START, -6.3..=6.3, initial.attitude_rad[1], "Initial pitch angle"),
        real!("initial.attitude.psi", Radian, START, -6.3..=6.3, initial.attitude_rad[2], "Initial heading"),
        real!("initial.body_rate.p", RadianPerSecond, START, -50.0..=50.0, initial.body_rate_rad_s[0], "Initial roll rate"),
        real!("initial.body_rate.q", RadianPerSecond, START, -50.0..=50.0, initial.body_rate_rad_s[1], "Initial pitch rate"),
        real!("initial.body_rate.r", RadianPerSecond, START, -50.0..=50.0, initial.body_rate_rad_s[2], "Initial yaw rate"),
        real!("initial.discharge", One, START, 0.0..=1.0, initial.discharge, "Drawn share of the battery's charge at the start: 0 is full; matters with airframe.battery.sag"),
        boolean!("reference.shaping", START, reference.shaping, "true: the reference is a goal, approached on a jerk-limited profile; false: it is a trajectory point, passed straight to the controllers"),
        Parameter {
            name: "controller.kind",
            description: "Controller: 1 = lmpc (Laguerre MPC), 2 = ssmpc (state-space MPC), 3 = dlqr (discrete linear-quadratic regulator), designed on the same models with the same weights",
            unit: Unit::One,
            mutability: STRUCTURAL,
            access: Access::Enumeration {
                choice: &CONTROLLER_KIND,
                get: |settings: &Self| (1..).zip(CONTROLLER_KINDS).find(|(_, kind)| *kind == settings.configuration().controllers.kind).map_or(1, |(item, _)| item),
                set: |settings: &mut Self, value| {
                    if let Some((_, kind)) = (1..).zip(CONTROLLER_KINDS).find(|(item, _)| *item == value) {
                        settings.configuration_mut().controllers.kind = kind;
                    }
                },
            },
        },
        Parameter {
            name: "controller.model",
            description: "Models that the controllers predict with: 1 = inner_loops (with the loop inside: the attitude with the lag of the rotors), 2 = paper (as the paper prints them, inputs act at once)",
            unit: Unit::One,
            mutability: STRUCTURAL,
            access: Access::Enumeration {
                choice: &PREDICTION_MODEL,
                get: |settings: &Self| (1..).zip(PREDICTION_MODELS).find(|(_, model)| *model == settings.configuration().controllers.model).map_or(1, |(item, _)| item),
                set: |settings: &mut Self, value| {
                    if let Some((_, model)) = (1..).zip(PREDICTION_MODELS).find(|(item, _)| *item == value) {
                        settings.configuration_mut().controllers.model = model;
                    }
                },
            },
        },
        boolean!("controller.governor", STRUCTURAL, controllers.governor, "Whether the regulator (dlqr) sees a distant set-point moved closer, so that the vehicle can brake in time; the predictive controllers foresee their limits and need none"),
        real!("controller.mass_factor", One, STRUCTURAL, 0.5..=1.5, controllers.mass_factor, "Mass in the controllers' model as a multiple of the true mass; with controller.learning, where learning begins"),
        boolean!("controller.learning", STRUCTURAL, controllers.learning, "Whether mass and drag are learned in flight from thrust and acceleration, starting from controller.mass_factor and airframe.drag; false: they stay as configured"),
        sample_time!("controller.altitude.sample_time", altitude, "Sample time of the altitude controller"),
        integer!("controller.altitude.terms", 1..=MOST_TERMS, controllers.altitude.terms, "N: Laguerre terms of the altitude controller"),
        real!("controller.altitude.scale", One, STRUCTURAL, 0.0..=0.99, controllers.altitude.scale, "a: Laguerre scaling factor of the altitude controller"),
        integer!("controller.altitude.prediction_horizon", 1..=1000, controllers.altitude.prediction_horizon, "N_p: prediction horizon of the altitude controller, samples, with ssmpc or controller.model = paper; lmpc with the loops inside predicts without end"),
        integer!("controller.altitude.control_horizon", 1..=MOST_MOVES, controllers.altitude.control_horizon, "N_c: control moves of the altitude controller's state-space MPC"),
        real!("controller.altitude.alpha", One, STRUCTURAL, 1.0..=2.0, controllers.altitude.alpha, "alpha: exponential data weighting of the altitude controller with controller.model = paper; 1 selects the Riccati terminal weight"),
        real!("controller.altitude.lambda", One, STRUCTURAL, 0.5..=1.0, controllers.altitude.lambda, "lambda: degree of stability of the altitude controller"),
        real!("controller.altitude.output_weight", One, TUNABLE, 1e-9..=1e9, controllers.altitude.output_weight[0], "Q: weight of the altitude error; all weights are relative to the bandwidth of their loop, and 1 counts deviations of one size alike"),
        real!("controller.altitude.damping_weight", One, TUNABLE, 0.0..=1e9, controllers.altitude.damping_weight[0], "Q: weight of the vertical speed over the bandwidth"),
        real!("controller.altitude.rate_weight", One, TUNABLE, 0.0..=1e9, controllers.altitude.rate_weight[0], "Q: weight of the vertical acceleration over the square of the bandwidth"),
        real!("controller.altitude.increment_weight", One, TUNABLE, 1e-9..=1e9, controllers.altitude.increment_weight[0], "R: weight of the rate of change of the commanded vertical acceleration G over the cube of the bandwidth"),
        sample_time!("controller.position.sample_time", position, "Sample time of the position controller"),
        integer!("controller.position.terms", 1..=MOST_TERMS, controllers.position.terms, "N: Laguerre terms of the position controller, per input"),
        real!("controller.position.scale", One, STRUCTURAL, 0.0..=0.99, controllers.position.scale, "a: Laguerre scaling factor of the position controller"),
        integer!("controller.position.prediction_horizon", 1..=1000, controllers.position.prediction_horizon, "N_p: prediction horizon of the position controller, samples, with ssmpc or controller.model = paper; lmpc with the loops inside predicts without end"),
        integer!("controller.position.control_horizon", 1..=MOST_MOVES, controllers.position.control_horizon, "N_c: control moves of the position controller's state-space MPC, per input"),
        real!("controller.position.alpha", One, STRUCTURAL, 1.0..=2.0, controllers.position.alpha, "alpha: exponential data weighting of the position controller with controller.model = paper; 1 selects the Riccati terminal weight"),
        real!("controller.position.lambda", One, STRUCTURAL, 0.5..=1.0, controllers.position.lambda, "lambda: degree of stability of the position controller"),
        real!("controller.position.output_weight.x", One, TUNABLE, 1e-9..=1e9, controllers.position.output_weight[0], "Q: weight of the error north, relative to the bandwidth as in altitude"),
        real!("controller.position.output_weight.y", One, TUNABLE, 1e-9..=1e9, controllers.position.output_weight[1], "Q: weight of the error east, relative to the bandwidth as in altitude"),
        real!("controller.position.damping_weight.x", One, TUNABLE, 0.0..=1e9, controllers.position.damping_weight[0], "Q: weight of the speed north over the bandwidth"),
        real!("controller.position.damping_weight.y", One, TUNABLE, 0.0..=1e9, controllers.position.damping_weight[1], "Q: weight of the speed east over the bandwidth"),
        real!("controller.position.rate_weight.x", One, TUNABLE, 0.0..=1e9, controllers.position.rate_weight[0], "Q: weight of the acceleration north over the square of the bandwidth"),
        real!("controller.position.rate_weight.y", One, TUNABLE, 0.0..=1e9, controllers.position.rate_weight[1], "Q: weight of the acceleration east over the square of the bandwidth"),
        real!("controller.position.increment_weight.theta", One, TUNABLE, 1e-9..=1e9, controllers.position.increment_weight[0], "R: weight of the rate of change of the acceleration commanded north, which a pitch gives, over the cube of the bandwidth"),
        real!("controller.position.increment_weight.phi", One, TUNABLE, 1e-9..=1e9, controllers.position.increment_weight[1], "R: weight of the rate of change of the acceleration commanded east, which a roll gives, over the cube of the bandwidth"),
        sample_time!("controller.attitude.sample_time", attitude, "Sample time of the attitude controller"),
        integer!("controller.attitude.terms", 1..=MOST_TERMS, controllers.attitude.terms, "N: Laguerre terms of the attitude controller, per input"),
        real!("controller.attitude.scale", One, STRUCTURAL, 0.0..=0.99, controllers.attitude.scale, "a: Laguerre scaling factor of the attitude controller for roll and pitch; yaw has the same in its own time"),
        integer!("controller.attitude.prediction_horizon", 1..=1000, controllers.attitude.prediction_horizon, "N_p: prediction horizon of the attitude controller for roll and pitch, samples, with ssmpc or controller.model = paper; yaw has the same in its own time"),
        integer!("controller.attitude.control_horizon", 1..=MOST_MOVES, controllers.attitude.control_horizon, "N_c: control moves of the attitude controller's state-space MPC, per input"),
        real!("controller.attitude.alpha", One, STRUCTURAL, 1.0..=2.0, controllers.attitude.alpha, "alpha: exponential data weighting of the attitude controller with controller.model = paper, yaw in its own time; 1 selects the Riccati terminal weight"),
        real!("controller.attitude.lambda", One, STRUCTURAL, 0.5..=1.0, controllers.attitude.lambda, "lambda: degree of stability of the attitude controller for roll and pitch; yaw has the same in its own time"),
        real!("controller.attitude.output_weight.phi", One, TUNABLE, 1e-9..=1e6, controllers.attitude.output_weight[0], "Q: weight of the roll error, relative to the bandwidth as in altitude"),
        real!("controller.attitude.output_weight.theta", One, TUNABLE, 1e-9..=1e6, controllers.attitude.output_weight[1], "Q: weight of the pitch error, relative to the bandwidth as in altitude"),
        real!("controller.attitude.output_weight.psi", One, TUNABLE, 1e-9..=1e6, controllers.attitude.output_weight[2], "Q: weight of the heading error, relative to the bandwidth as in altitude"),
        real!("controller.attitude.damping_weight.phi", One, TUNABLE, 0.0..=1e9, controllers.attitude.damping_weight[0], "Q: weight of the roll rate over the bandwidth"),
        real!("controller.attitude.damping_weight.theta", One, TUNABLE, 0.0..=1e9, controllers.attitude.damping_weight[1], "Q: weight of the pitch rate over the bandwidth"),
        real!("controller.attitude.damping_weight.psi", One, TUNABLE, 0.0..=1e9, controllers.attitude.damping_weight[2], "Q: weight of the yaw rate over the bandwidth"),
        real!("controller.attitude.rate_weight.phi", One, TUNABLE, 0.0..=1e9, controllers.attitude.rate_weight[0], "Q: weight of the roll acceleration over the square of the bandwidth"),
        real!("controller.attitude.rate_weight.theta", One, TUNABLE, 0.0..=1e9, controllers.attitude.rate_weight[1], "Q: weight of the pitch acceleration over the square of the bandwidth"),
        real!("controller.attitude.rate_weight.psi", One, TUNABLE, 0.0..=1e9, controllers.attitude.rate_weight[2], "Q: weight of the yaw acceleration over the square of the bandwidth"),
        real!("controller.attitude.increment_weight.phi", One, TUNABLE, 1e-9..=1e9, controllers.attitude.increment_weight[0], "R: weight of the rate of change of the commanded roll acceleration over the cube of the bandwidth"),
        real!("controller.attitude.increment_weight.theta", One, TUNABLE, 1e-9..=1e9, controllers.attitude.increment_weight[1], "R: weight of the rate of change of the commanded pitch acceleration over the cube of the bandwidth"),
        real!("controller.attitude.increment_weight.psi", One, TUNABLE, 1e-9..=1e9, controllers.attitude.increment_weight[2], "R: weight of the rate of change of the commanded yaw acceleration over the cube of the bandwidth"),
        real!("limits.tilt", Radian, TUNABLE, 0.05..=1.2, limits.tilt_rad, "Largest angle between the thrust axis and the vertical; goals are flown with at most 91 % of it and trajectories with 96 %, the rest is for the attitude to overshoot"),
        real!("limits.tilt_rate", RadianPerSecond, TUNABLE, 0.05..=20.0, limits.tilt_rate_rad_s, "Largest rate of the tilt command"),
        real!("limits.tilt_acceleration", RadianPerSecondSquared, TUNABLE, 0.1..=500.0, limits.tilt_acceleration_rad_s2, "Largest angular acceleration of the tilt command"),
        real!("limits.thrust.min", One, TUNABLE, 0.0..=0.95, limits.thrust_min, "Smallest thrust command of the altitude controller, as a multiple of the weight"),
        real!("limits.thrust.max", One, TUNABLE, 1.05..=10.0, limits.thrust_max, "Largest thrust command of the altitude controller, as a multiple of the weight; never more than 80 % of the largest thrust of the rotors"),
        real!("limits.speed.horizontal", MetrePerSecond, TUNABLE, 0.1..=50.0, limits.speed_horizontal_m_s, "Largest horizontal speed of shaped references, and towards distant goals without shaping"),
        real!("limits.speed.up", MetrePerSecond, TUNABLE, 0.1..=50.0, limits.speed_up_m_s, "Largest climb rate of shaped references, and towards distant goals without shaping"),
        real!("limits.speed.down", MetrePerSecond, TUNABLE, 0.1..=50.0, limits.speed_down_m_s, "Largest sink rate of shaped references, and towards distant goals without shaping"),
        real!("limits.acceleration.horizontal", MetrePerSecondSquared, TUNABLE, 0.1..=20.0, limits.acceleration_horizontal_m_s2, "Largest horizontal acceleration of shaped references"),
        real!("limits.acceleration.vertical", MetrePerSecondSquared, TUNABLE, 0.1..=20.0, limits.acceleration_vertical_m_s2, "Largest vertical acceleration of shaped references"),
        real!("limits.jerk.horizontal", MetrePerSecondCubed, TUNABLE, 0.1..=100.0, limits.jerk_horizontal_m_s3, "Largest horizontal jerk of shaped references"),
        real!("limits.jerk.vertical", MetrePerSecondCubed, TUNABLE, 0.1..=100.0, limits.jerk_vertical_m_s3, "Largest vertical jerk of shaped references"),
        real!("limits.yaw_rate", RadianPerSecond, TUNABLE, 0.01..=10.0, limits.yaw_rate_rad_s, "Largest rate of the heading reference, with and without shaping"),
        real!("limits.yaw_acceleration", RadianPerSecondSquared, TUNABLE, 0.01..=50.0, limits.yaw_acceleration_rad_s2, "Largest angular acceleration of the shaped heading reference"),
        real!("limits.yaw_jerk", RadianPerSecondCubed, TUNABLE, 0.01..=500.0, limits.yaw_jerk_rad_s3, "Largest angular jerk of the shaped heading reference"),
        boolean!("sensor.output_feedback", STRUCTURAL, sensors.output_feedback, "true: only position and attitude are measured, and a Kalman predictor estimates the rest; false: the whole state is measured"),
        real!("sensor.position_noise", Metre, TUNABLE, 0.0..=10.0, sensors.position_noise_m, "Standard deviation of the position noise, per axis"),
        real!("sensor.velocity_noise", MetrePerSecond, TUNABLE, 0.0..=10.0, sensors.velocity_noise_m_s, "Standard deviation of the velocity noise, per axis"),
        real!("sensor.attitude_noise", Radian, TUNABLE, 0.0..=0.5, sensors.attitude_noise_rad, "Standard deviation of the attitude noise, per body axis"),
        real!("sensor.body_rate_noise", RadianPerSecond, TUNABLE, 0.0..=10.0, sensors.body_rate_noise_rad_s, "Standard deviation of the body rate noise, per axis"),
        integer!("sensor.seed", 0..=2147483647, sensors.seed, "Seed of the measurement noise"),
    ];
}

impl Configured for Configuration {
    fn configuration(&self) -> &Configuration {
        self
    }

    fn configuration_mut(&mut self) -> &mut Configuration {
        self
    }
}

/// All parameters, in the order in which they are documented.
pub static PARAMETERS: &[Parameter] = Configuration::PARAMETERS;
