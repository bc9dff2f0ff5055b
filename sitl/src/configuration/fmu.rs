//! `--fmu FILE`: what flies in place of ours, and what it cannot do.

use vehicle::estimation::SensorModel;
use vehicle::foreign::ForeignRole;
use vehicle::{Notice, Severity, VehicleSettings};

use super::Arguments;
use crate::failure::Failure;
use crate::fmu::{FmuChoice, Mapping, listing};

/// The FMU that is asked for, if one is.
///
/// # Errors
/// [`Failure`] of the map, or of flags that mean nothing without an FMU.
pub(super) fn choice(arguments: &Arguments) -> Result<Option<FmuChoice>, Failure> {
    let Some(path) = &arguments.fmu else {
        for (name, given) in
            [("--map", arguments.map.is_some()), ("--fmu-check", arguments.fmu_check == Some(true))]
        {
            if given {
                return Err(Failure::Value { name: name.to_owned(), reason: "needs --fmu".to_owned() });
            }
        }
        return Ok(None);
    };
    FmuChoice::new(path, arguments.map.as_deref()).map(Some)
}

/// The table that `--fmu-check` shows of the FMU for a vehicle.
///
/// # Errors
/// [`Failure`] of the FMU.
pub fn fmu_listing(choice: &FmuChoice, vehicle: &VehicleSettings) -> Result<String, Failure> {
    choice.open(&vehicle.flown_configuration()).map(|(_, mapping)| listing(&mapping))
}

/// Looks whether an FMU can be flown by a vehicle that is asked for so. What the user is told about it.
///
/// # Errors
/// [`Failure`] that names what it cannot do.
pub(super) fn check(
    arguments: &Arguments,
    choice: &FmuChoice,
    vehicle: &VehicleSettings,
) -> Result<Vec<Notice>, Failure> {
    let (fmu, mapping) = choice.open(&vehicle.flown_configuration())?;
    refuse(arguments, vehicle, &mapping)?;
    let note = |severity, text| Notice { severity, text };
    let name = &mapping.model_name;
    let mut notes = vec![note(Severity::Info, format!("the FMU {name} flies as the {}", mapping.role))];
    if fmu.description().needs_execution_tool {
        let tool = fmu.description().generation_tool.as_deref().unwrap_or("it does not say which");
        notes.push(note(
            Severity::Info,
            format!("the FMU {name} says that it needs the tool that made it: {tool}"),
        ));
    }
    if mapping.role == ForeignRole::ClosedLoop && mapping.armed.is_none() {
        let text = format!(
            "the FMU {name} has no input `armed`: disarming does not stop its rotors, it holds its reference"
        );
        notes.push(note(Severity::Warning, text));
    }
    if !vehicle.surroundings.terrain.is_flat() && !mapping.takes(crate::fmu::GROUND) {
        let text = format!(
            "the FMU {name} has no input for the height of the ground (ground.z): it stands on ground of its own, whatever --world says"
        );
        notes.push(note(Severity::Warning, text));
    }
    Ok(notes)
}

/// The same for the plant of an external autopilot.
///
/// # Errors
/// [`Failure`] that names what it cannot do.
pub(super) fn check_plant(
    arguments: &Arguments,
    choice: &FmuChoice,
    vehicle: &VehicleSettings,
) -> Result<Vec<Notice>, Failure> {
    let notes = check(arguments, choice, vehicle)?;
    let (_, mapping) = choice.open(&vehicle.flown_configuration())?;
    if mapping.role == ForeignRole::ClosedLoop {
        let reason = format!(
            "the FMU {} is a closed loop; an external autopilot needs a plant, with rotor.command.1 to .4, or thrust and torques, \
             as its inputs",
            mapping.model_name
        );
        return Err(Failure::Value { name: "--fmu".to_owned(), reason });
    }
    Ok(notes)
}

fn refuse(arguments: &Arguments, vehicle: &VehicleSettings, mapping: &Mapping) -> Result<(), Failure> {
    let name = &mapping.model_name;
    let wrong = |flag: &str, reason: String| Err(Failure::Value { name: flag.to_owned(), reason });
    let of_rotors = vehicle.faults.iter().find(|scheduled| scheduled.fault.is_of_rotors());
    if let Some(scheduled) = of_rotors.filter(|_| mapping.role == ForeignRole::ClosedLoop) {
        let reason = format!(
            "`{scheduled}`: the FMU {name} flies as the closed loop, and its rotors take no faults; only a plant's do"
        );
        return wrong("--fault", reason);
    }
    if (vehicle.wind.speed_m_s > 0.0 || vehicle.wind.gusts_m_s > 0.0) && !mapping.takes(crate::fmu::WIND) {
        let reason = format!(
            "the FMU {name} has no inputs for the wind; map wind.velocity.x to .z in [variables] of --map, or leave the wind out"
        );
        return wrong("--wind, --gusts", reason);
    }
    let measured = vehicle.sensors.model != SensorModel::Ideal
        || !vehicle.configuration.sensors.is_exact()
        || vehicle.configuration.sensors.output_feedback;
    if mapping.role == ForeignRole::ClosedLoop && measured && arguments.hil.is_none() {
        let reason = format!(
            "the closed loop of the FMU {name} flies by measurements of its own; use the ideal sensors"
        );
        return wrong("--sensors, --noise, --kalman", reason);
    }
    Ok(())
}
