//! All settings, resolved and checked.

use std::ops::Range;
use std::path::{Path, PathBuf};

use quadrotor::Configuration;

use super::Arguments;
use crate::estimation::SensorSettings;
use crate::failure::Failure;
use crate::fault::ScheduledFault;
use crate::link::{LinkSpecification, default_links};
use crate::parameters::{Host, ParameterTable, Speed, identifier, parse};
use crate::record::Participant;
use crate::vehicle::{Conduct, Vehicle, VehicleSettings};
use crate::world::WindSettings;

/// Linear drag that the wind acts through when the airframe has none, N·s/m: 0.7 kg with an open frame drifts with
/// 10 m/s of wind at a lean of 12°.
const DRAG_IN_WIND_N_S_M: f64 = 0.15;

/// What the program does.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The vehicles.
    pub vehicles: Vec<MemberSettings>,
    /// Links of each hub.
    pub hubs: Vec<Vec<LinkSpecification>>,
    /// Pace.
    pub speed: Speed,
    /// Record to be written.
    pub record: Option<PathBuf>,
    /// Traffic log.
    pub tlog: Option<PathBuf>,
    /// File that tells that clients can connect.
    pub ready_file: Option<PathBuf>,
    /// End, µs of simulation time.
    pub end_us: Option<u64>,
}

/// One vehicle of them.
#[derive(Clone, Debug, PartialEq)]
pub struct MemberSettings {
    /// MAVLink system id.
    pub system_id: u8,
    /// The vehicle.
    pub vehicle: VehicleSettings,
    /// Number of the hub that it is behind.
    pub hub: usize,
    /// Parameter file.
    pub parameters: Option<PathBuf>,
}

impl Settings {
    /// Resolves arguments, with the configuration file that they name already in them.
    ///
    /// # Errors
    /// [`Failure`] that names the wrong value.
    pub fn resolve(arguments: &Arguments) -> Result<Self, Failure> {
        let instance = arguments.instance.unwrap_or(0);
        let end_us = match arguments.duration {
            Some(seconds) => Some((within("duration", seconds, 0.0, 1e9)? * 1e6) as u64),
            None => None,
        };
        // At most 200, see the arguments.
        let default_id = u8::try_from(instance + 1).unwrap_or(u8::MAX);
        let member = MemberSettings {
            system_id: arguments.system_id.unwrap_or(default_id),
            vehicle: vehicle(arguments)?,
            hub: 0,
            parameters: arguments.parameters.clone(),
        };
        Ok(Self {
            vehicles: vec![member],
            hubs: vec![arguments.link.clone().unwrap_or_else(|| default_links(instance))],
            speed: arguments.speed.unwrap_or(Speed::Factor(1.0)),
            record: arguments.record.clone(),
            tlog: arguments.tlog.clone(),
            ready_file: arguments.ready_file.clone(),
            end_us,
        })
    }

    /// Numbers of the vehicles that tick by each clock.
    pub fn clocks(&self) -> Vec<Range<usize>> {
        std::iter::once(0..self.vehicles.len()).collect()
    }

    /// The vehicles as a record has them.
    pub fn participants(&self) -> Vec<Participant> {
        let participant = |own: &MemberSettings| Participant {
            system_id: own.system_id,
            links: self.hubs.get(own.hub).into_iter().flatten().map(|link| link.profile).collect(),
            vehicle: own.vehicle.clone(),
        };
        self.vehicles.iter().map(participant).collect()
    }
}

/// A vehicle as the arguments describe it.
fn vehicle(arguments: &Arguments) -> Result<VehicleSettings, Failure> {
    let identity = arguments.autopilot.unwrap_or_default();
    let home = arguments.home.unwrap_or_default();
    let wind = arguments.wind.unwrap_or_default();
    let gusts_m_s = within("gusts", arguments.gusts.unwrap_or(0.0), 0.0, 10.0)?;
    let mut vehicle = VehicleSettings {
        identity,
        configuration: Configuration::default(),
        conduct: Conduct::new(identity.is_ardupilot()),
        origin: home.place,
        heading_rad: home.heading_deg.to_radians(),
        wind: WindSettings {
            speed_m_s: wind.speed_m_s,
            from_rad: wind.from_deg.to_radians(),
            gusts_m_s,
            seed: arguments.seed.unwrap_or(1),
        },
        faults: faults(arguments.fault.as_deref().unwrap_or_default())?,
        sensors: SensorSettings {
            model: arguments.sensors.unwrap_or_default(),
            seed: arguments.seed.unwrap_or(1),
        },
    };
    if (wind.speed_m_s > 0.0 || gusts_m_s > 0.0) && vehicle.configuration.airframe.drag_n_s_m == [0.0; 3] {
        vehicle.configuration.airframe.drag_n_s_m = [DRAG_IN_WIND_N_S_M; 3];
    }
    let named = arguments.set.as_deref().unwrap_or_default();
    set_parameters(&mut vehicle, arguments.parameters.as_deref(), named)?;
    Ok(vehicle)
}

fn within(name: &str, value: f64, minimum: f64, maximum: f64) -> Result<f64, Failure> {
    if (minimum..=maximum).contains(&value) {
        return Ok(value);
    }
    let reason = format!("{value} is outside [{minimum}, {maximum}]");
    Err(Failure::Value { name: format!("--{name}"), reason })
}

fn faults(named: &[String]) -> Result<Vec<ScheduledFault>, Failure> {
    let fault =
        |text: &String| text.parse().map_err(|reason| Failure::Value { name: "--fault".to_owned(), reason });
    named.iter().map(fault).collect()
}

/// Sets the parameters of the file, then those of the command line, on a vehicle that is only made for that.
fn set_parameters(
    settings: &mut VehicleSettings,
    file: Option<&Path>,
    named: &[String],
) -> Result<(), Failure> {
    let text = match file {
        Some(path) if path.exists() => {
            Some((path, std::fs::read_to_string(path).map_err(|source| Failure::read(path, source))?))
        }
        _ => None,
    };
    if text.is_none() && named.is_empty() {
        return Ok(());
    }
    let table = ParameterTable::new(settings.identity);
    let mut vehicle = Vehicle::new(settings)?;
    // Pace and system id are no matter of a file.
    let mut speed = Speed::Factor(1.0);
    let mut host = Host { vehicle: &mut vehicle, system_id: 1, speed: &mut speed };
    if let Some((path, text)) = text {
        parse(&text, &table, &mut host)
            .map_err(|source| Failure::Parameters { path: path.to_owned(), source })?;
    }
    for setting in named {
        let wrong = || Failure::Value {
            name: "--set".to_owned(),
            reason: format!("`{setting}` is not NAME=VALUE with a number"),
        };
        let (name, value) = setting.split_once('=').ok_or_else(wrong)?;
        let value: f64 = value.trim().parse().map_err(|_| wrong())?;
        let name = name.trim();
        let id = if name.contains('.') { identifier(name) } else { name.to_owned() };
        table.set(&id, value, &mut host)?;
    }
    settings.conduct = *vehicle.conduct();
    settings.configuration = *vehicle.simulation().configuration();
    Ok(())
}

/// Numbers between commas; `None` unless all are finite.
pub(super) fn numbers(text: &str) -> Option<Vec<f64>> {
    text.split(',').map(|word| word.trim().parse::<f64>().ok().filter(|value| value.is_finite())).collect()
}
