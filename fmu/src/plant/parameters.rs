//! The parameters.

use fmi::variables::{Choice, Field, Variable};

use super::QuadrotorPlant;
use super::settings::{Drive, Settings};
use crate::tables::parameters::{Selection, table, tunable};

/// What `actuation` chooses from.
const ACTUATION: Choice = Choice {
    name: "Actuation",
    description: "What drives the plant",
    items: &[
        ("rotor_speeds", "Commanded rotor speeds, which the rotors follow with their lag"),
        ("wrench", "Thrust and torques at once, in place of the rotors"),
    ],
};

/// What the parameters of the configuration do not have.
#[rustfmt::skip]
pub(super) const OWN: [Variable<QuadrotorPlant>; 2] = [
    Variable::fixed("actuation", "What drives the plant: 1 = rotor_speeds (rotor.command, followed with the rotors' lag), 2 = wrench (command.thrust and command.torque, which act at once)", Field::Enumeration {
        choice: ACTUATION,
        get: |settings: &Settings| match settings.drive {
            Drive::RotorSpeeds => 1,
            Drive::Wrench => 2,
        },
        set: |settings: &mut Settings, value| settings.drive = if value == 2 { Drive::Wrench } else { Drive::RotorSpeeds },
    }),
    Variable::fixed("initial.hovering", "true: the rotors begin at the speed that carries the weight; false: they begin at rest. With actuation = wrench they are at rest", Field::Boolean {
        get: |settings: &Settings| settings.hovering,
        set: |settings: &mut Settings, value| settings.hovering = value,
    }),
];

/// A plant has no use for the range of commands.
const PLANT: Selection = Selection {
    of: &["airframe.", "environment.", "initial."],
    without: &["airframe.rotor.speed_min", "airframe.rotor.speed_max"],
};
const COUNT: usize = PLANT.count::<Settings>();

/// What may change in flight: a load is dropped by a change of the mass.
const IN_FLIGHT: Selection = Selection { of: &["airframe."], without: &["airframe.preset"] };

/// Those of the configuration.
pub(super) const TABLE: [Variable<QuadrotorPlant>; COUNT] = tunable(table(PLANT), IN_FLIGHT);

/// The enumeration of its own, as an integer.
pub(super) const NUMBERS: [Variable<QuadrotorPlant>; 1] = [Variable::number(
    "actuation_number",
    "actuation by its number, which wins over the name; 0: as actuation says",
    "actuation",
)];
