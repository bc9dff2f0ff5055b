//! All settings, resolved and checked.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::Duration;

use nalgebra::Vector3;
use quadrotor::Configuration;
use vehicle::estimation::{SensorModel, SensorSettings};
use vehicle::fault::ScheduledFault;
use vehicle::identity::Identity;
use vehicle::parameters::Speed;
use vehicle::plan::{PlanKind, Plans, Site};
use vehicle::surroundings::Surroundings;
use vehicle::world::{LocalFrame, WindSettings};
use vehicle::{BatteryPack, Conduct, Notice, Severity, TICK_US, VehicleSettings};

use super::start_parameters::set_parameters;
use super::{
    AirframeChoice, Arguments, Clocks, Ports, ViewAddress, fmu, partners, read_plans, read_world, wind_drag,
    wind_hold,
};
use crate::failure::Failure;
use crate::files::kept_plans;
use crate::fleet::{LockstepPhase, LockstepSettings};
use crate::flight_log::LogSettings;
use crate::fmu::FmuChoice;
use crate::link::{LinkSpecification, default_links};
use crate::record::Participant;

/// Size that a record may get unless told otherwise, MB: a client's set-points at 50 Hz for more than a day.
const RECORD_MEGABYTES: f64 = 1000.0;

/// What the program does.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The vehicles.
    pub vehicles: Vec<MemberSettings>,
    /// Links of each hub.
    pub hubs: Vec<Vec<LinkSpecification>>,
    /// Whether all tick by one clock.
    pub clocks: Clocks,
    /// Pace.
    pub speed: Speed,
    /// Whether and how simulation time waits for set-points.
    pub lockstep: Option<LockstepSettings>,
    /// Record to be written.
    pub record: Option<PathBuf>,
    /// Size that the record may get, bytes.
    pub record_most_bytes: u64,
    /// Traffic log.
    pub tlog: Option<PathBuf>,
    /// Flight logs, and sizes and numbers of files of the traffic log.
    pub logs: LogSettings,
    /// Whether the vehicles see one another as traffic.
    pub fleet_traffic: bool,
    /// Folder that clients see, and whether they may change it.
    pub ftp_root: Option<(PathBuf, bool)>,
    /// Key to sign with.
    pub signing_key: Option<PathBuf>,
    /// Whether a local client may set the key while there is none.
    pub accept_signing_setup: bool,
    /// What flies in place of our closed loop or plant.
    pub fmu: Option<FmuChoice>,
    /// Where the live page is served, if it is.
    pub view: Option<ViewAddress>,
    /// File to write when clients can connect.
    pub ready_file: Option<PathBuf>,
    /// Whether the flight is followed in one line, and not in a panel.
    pub no_panel: bool,
    /// End, µs of simulation time.
    pub end_us: Option<u64>,
    /// What the user is told at the start.
    pub notes: Vec<Notice>,
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
    /// Port that hears its pilot's radio; 0: any.
    pub rc_port: Option<u16>,
}

impl Settings {
    /// Resolves arguments, with the configuration file that they name already in them.
    ///
    /// # Errors
    /// [`Failure`] that names the wrong value.
    pub fn resolve(arguments: &Arguments) -> Result<Self, Failure> {
        let instance = arguments.instance.unwrap_or(0);
        let ids = system_ids(arguments)?;
        let shared = arguments.ports.unwrap_or_default() == Ports::Shared;
        let count = ids.len();
        check_addresses(arguments, &ids)?;
        partners::check(arguments, count)?;
        let fmu = fmu::choice(arguments)?;
        let member = |(number, system_id): (usize, u8)| {
            let parameters = arguments.parameters.as_deref();
            let parameters =
                parameters.map(|path| if count > 1 { of_system(path, system_id) } else { path.to_owned() });
            let (vehicle, notes) = vehicle(arguments, number, count, parameters.as_deref())?;
            let hub = if shared { 0 } else { number };
            let warning = wind_hold::warning(&vehicle.configuration, &vehicle.wind);
            let about_fmu = match &fmu {
                Some(choice) => fmu::check(arguments, choice, &vehicle)?,
                None => Vec::new(),
            };
            let rc_port = arguments.rc_port.map(|port| rc_port(port, number)).transpose()?;
            let own = MemberSettings { system_id, vehicle, hub, parameters, rc_port };
            Ok((own, notes.into_iter().chain(warning).chain(about_fmu).collect()))
        };
        let members: Result<Vec<_>, Failure> = ids.into_iter().enumerate().map(member).collect();
        let (vehicles, vehicle_notes): (Vec<_>, Vec<_>) = members?.into_iter().unzip();
        let hubs = if shared { 1 } else { count };
        Ok(Self {
            notes: lockstep_note(arguments).into_iter().chain(notes(&vehicles, vehicle_notes)).collect(),
            vehicles,
            hubs: (0..hubs).map(|number| hub(arguments, instance, number)).collect::<Result<_, _>>()?,
            clocks: arguments.clocks.unwrap_or_default(),
            speed: arguments.speed.unwrap_or(Speed::Factor(1.0)),
            lockstep: lockstep(arguments),
            record: arguments.record.clone(),
            record_most_bytes: (arguments.record_size.unwrap_or(RECORD_MEGABYTES) * 1e6) as u64,
            tlog: arguments.tlog.clone(),
            logs: log_settings(arguments),
            fleet_traffic: arguments.sees_fleet(),
            ftp_root: arguments.ftp_root.clone().map(|path| (path, arguments.ftp_write.unwrap_or(false))),
            signing_key: arguments.signing_key.clone(),
            fmu,
            accept_signing_setup: arguments.accept_signing_setup.unwrap_or(false),
            view: arguments.view.clone(),
            ready_file: arguments.ready_file.clone(),
            no_panel: arguments.no_panel.unwrap_or(false),
            end_us: end_us(arguments),
        })
    }

    /// Numbers of the vehicles that tick by each clock.
    pub fn clocks(&self) -> Vec<Range<usize>> {
        let count = self.vehicles.len();
        match self.clocks {
            Clocks::Shared => std::iter::once(0..count).collect(),
            Clocks::Separate => (0..count).map(|number| number..number + 1).collect(),
        }
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

/// The port of the radio of a vehicle: ports of several are apart as ArduPilot has them.
fn rc_port(first: u16, number: usize) -> Result<u16, Failure> {
    const APART: usize = 10;
    if first == 0 {
        return Ok(0);
    }
    u16::try_from(usize::from(first) + APART * number).map_err(|_| Failure::Value {
        name: "--rc-port".to_owned(),
        reason: format!("{first} leaves no port for vehicle {}; choose a lower one", number + 1),
    })
}

/// Whether and how simulation time waits for set-points.
fn lockstep(arguments: &Arguments) -> Option<LockstepSettings> {
    const PERIOD_S: f64 = 0.02;
    const TIMEOUT_S: f64 = 5.0;
    let phase = arguments.lockstep?;
    let ticks = (arguments.lockstep_period.unwrap_or(PERIOD_S) * 1e6 / TICK_US as f64).round() as u64;
    let timeout = Duration::from_secs_f64(arguments.lockstep_timeout.unwrap_or(TIMEOUT_S));
    Some(LockstepSettings { phase, period_us: ticks * TICK_US, timeout })
}

/// A vehicle that does not move must not look broken.
fn lockstep_note(arguments: &Arguments) -> Option<Notice> {
    let waits = arguments.lockstep == Some(LockstepPhase::Always);
    let text = || "lock-step: simulation time starts with the first set-point".to_owned();
    waits.then(|| Notice { severity: Severity::Info, text: text() })
}

/// Notes about vehicles: one for all that have the same, else each with the system that it is about.
fn notes(vehicles: &[MemberSettings], notes: Vec<Vec<Notice>>) -> Vec<Notice> {
    let same = notes.windows(2).all(|pair| pair.first() == pair.last());
    if same {
        return notes.into_iter().next().unwrap_or_default();
    }
    let of_each = vehicles.iter().zip(notes);
    let named = |(own, notes): (&MemberSettings, Vec<Notice>)| {
        let name = |note: Notice| Notice { text: format!("system {}: {}", own.system_id, note.text), ..note };
        notes.into_iter().map(name).collect::<Vec<_>>()
    };
    of_each.flat_map(named).collect()
}

/// End, µs of simulation time.
pub(super) fn end_us(arguments: &Arguments) -> Option<u64> {
    arguments.duration.map(|seconds| (seconds * 1e6) as u64)
}

/// System id of the first vehicle.
pub(super) fn first_system_id(arguments: &Arguments) -> u8 {
    // Instances end at 200, see the arguments.
    let of_instance = u8::try_from(arguments.instance.unwrap_or(0).saturating_add(1)).unwrap_or(u8::MAX);
    arguments.system_id.unwrap_or(of_instance)
}

/// System ids of the vehicles.
fn system_ids(arguments: &Arguments) -> Result<Vec<u8>, Failure> {
    const LAST: u16 = 250;
    let count = u16::from(arguments.vehicles.unwrap_or(1));
    let first = u16::from(first_system_id(arguments));
    let last = (first + count).saturating_sub(1);
    if last > LAST {
        let reason = format!(
            "{count} vehicles from system {first} on need system ids up to {last}; the largest is {LAST}"
        );
        return Err(Failure::Value { name: "--vehicles".to_owned(), reason });
    }
    Ok((first..=last).filter_map(|id| u8::try_from(id).ok()).collect())
}

/// The links of a hub.
fn hub(arguments: &Arguments, instance: u16, number: usize) -> Result<Vec<LinkSpecification>, Failure> {
    // As many as vehicles, see the arguments.
    let number = u16::try_from(number).unwrap_or(u16::MAX);
    let Some(links) = &arguments.link else { return Ok(default_links(instance.saturating_add(number))) };
    let counted = |link: &LinkSpecification| {
        link.of_vehicle(number).ok_or_else(|| Failure::Value {
            name: "--link".to_owned(),
            reason: format!("`{link}` leaves no port for vehicle {}; use --ports shared", number + 1),
        })
    };
    links.iter().map(counted).collect()
}

/// A file's name for one of several systems: `fleet.params` is `fleet-3.params`.
fn of_system(path: &Path, system_id: u8) -> PathBuf {
    let mut name = path.file_stem().unwrap_or_default().to_owned();
    name.push(format!("-{system_id}"));
    if let Some(extension) = path.extension() {
        name.push(".");
        name.push(extension);
    }
    path.with_file_name(name)
}

/// The vehicle of a number among several, as the arguments describe it, and what to tell the user about it.
pub(super) fn vehicle(
    arguments: &Arguments,
    number: usize,
    count: usize,
    parameters: Option<&Path>,
) -> Result<(VehicleSettings, Vec<Notice>), Failure> {
    let system_id = first_system_id(arguments).saturating_add(u8::try_from(number).unwrap_or(u8::MAX));
    let identity: Identity = arguments.autopilot.unwrap_or_default().into();
    let home = arguments.home.unwrap_or_default();
    let wind = arguments.wind.unwrap_or_default();
    let gusts_m_s = arguments.gusts.unwrap_or(0.0);
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
            seed: arguments.seed.unwrap_or(1).wrapping_add(number as u64),
        },
        faults: faults(arguments, system_id)?,
        sensors: SensorSettings {
            model: arguments.sensors.unwrap_or_default(),
            seed: arguments.seed.unwrap_or(1).wrapping_add(number as u64),
        },
        battery: BatteryPack::default(),
        plans: Plans::default(),
        autostart: arguments.autostart.unwrap_or(false),
        surroundings: surroundings(arguments)?,
        foreign: None,
        equipment: arguments.equipment.unwrap_or_default().into(),
    };
    let chosen = airframe_of(arguments, system_id).map(AirframeChoice::choose).transpose()?;
    let airframe_note = chosen.map(|chosen| {
        vehicle.configuration = chosen.configuration;
        vehicle.battery = chosen.battery;
        vehicle.conduct.battery_capacity_ah = chosen.battery.capacity_ah;
        chosen.note
    });
    let [north_m, east_m] = arguments.formation.unwrap_or_default().start_m(number, count);
    let ground_z_m = vehicle.surroundings.terrain.z_m([north_m, east_m]);
    check_start(number, ground_z_m)?;
    vehicle.configuration.initial.position_m = [north_m, east_m, ground_z_m];
    vehicle.configuration.sensors.seed = noise_seed(arguments, number);
    let windy = wind.speed_m_s > 0.0 || gusts_m_s > 0.0;
    let drag_n_s_m =
        if windy { vehicle::world::wind_drag::provide(&mut vehicle.configuration) } else { None };
    let chosen = set_parameters(&mut vehicle, parameters, &named_parameters(arguments, number)?)?;
    let note = if windy { wind_drag::note(&vehicle.configuration, drag_n_s_m, &chosen.names) } else { None };
    let home_m = Vector3::from(vehicle.configuration.initial.position_m);
    let site = Site {
        identity,
        frame: LocalFrame::new(vehicle.origin),
        home_m,
        terrain: vehicle.surroundings.terrain.clone(),
    };
    vehicle.plans = plans(arguments, system_id, parameters, &site)?;
    check_autostart(arguments, system_id, &vehicle.plans)?;
    Ok((vehicle, airframe_note.into_iter().chain(note).chain(chosen.warnings).collect()))
}

/// Vehicles start at or above the height of the origin.
fn check_start(number: usize, ground_z_m: f64) -> Result<(), Failure> {
    if ground_z_m <= 0.0 {
        return Ok(());
    }
    let reason = format!(
        "the ground where vehicle {} starts is {ground_z_m:.2} m below the origin; allowed at or above it: raise all heights, and lower \
         the origin's altitude by as much",
        number + 1
    );
    Err(Failure::Value { name: "--world".to_owned(), reason })
}

/// The plans of a vehicle: its mission's file, or else those that are kept beside its parameters.
fn plans(
    arguments: &Arguments,
    system_id: u8,
    parameters: Option<&Path>,
    site: &Site,
) -> Result<Plans, Failure> {
    match (mission_of(arguments, system_id), parameters) {
        (Some(path), _) => read_plans(path, site),
        (None, Some(parameters)) => Ok(kept_plans(parameters, site)?.unwrap_or_default()),
        (None, None) => Ok(Plans::default()),
    }
}

/// Refuses to start by itself what has nothing to fly.
fn check_autostart(arguments: &Arguments, system_id: u8, plans: &Plans) -> Result<(), Failure> {
    let file = mission_of(arguments, system_id).filter(|_| arguments.autostart == Some(true));
    match file {
        Some(path) if plans.get(PlanKind::Mission).items().is_empty() => {
            let reason =
                format!("`{}` has no mission items to start; add one, or leave the flag out", path.display());
            Err(Failure::Value { name: "--autostart".to_owned(), reason })
        }
        _ => Ok(()),
    }
}

/// What stands and flies around every vehicle.
fn surroundings(arguments: &Arguments) -> Result<Surroundings, Failure> {
    let (obstacles, terrain) = arguments.world.as_deref().map(read_world).transpose()?.unwrap_or_default();
    let mut aircraft = Vec::new();
    for choice in arguments.traffic.iter().flatten() {
        aircraft.append(&mut choice.aircraft(aircraft.len())?);
    }
    let mut ids: Vec<u32> = aircraft.iter().map(|one| one.id).collect();
    ids.sort_unstable();
    if let Some(id) =
        ids.iter().zip(ids.iter().skip(1)).find_map(|(one, other)| (one == other).then_some(one))
    {
        let reason = format!("two aircraft have the address {id}; give each an `icao` of its own");
        return Err(Failure::Value { name: "--traffic".to_owned(), reason });
    }
    Ok(Surroundings { obstacles, aircraft, terrain })
}

/// Parameters that flags name: those of the noise, then `--set`.
fn named_parameters(arguments: &Arguments, number: usize) -> Result<Vec<String>, Failure> {
    let mut named = Vec::new();
    if let Some(noise) = arguments.noise {
        named.extend(noise.parameters().map(|(name, value)| format!("{name}={value}")));
    }
    if let Some(kalman) = arguments.kalman {
        named.push(format!("sensor.output_feedback={}", u8::from(kalman)));
    }
    if !named.is_empty() && arguments.sensors.unwrap_or_default() != SensorModel::Ideal {
        let reason = "not with --sensors realistic, which has noise and an estimator of its own".to_owned();
        return Err(Failure::Value { name: "--noise, --kalman".to_owned(), reason });
    }
    if arguments.seed.is_some() {
        named.push(format!("sensor.seed={}", noise_seed(arguments, number)));
    }
    named.extend(arguments.set.iter().flatten().cloned());
    Ok(named)
}

/// All bits of a vehicle's seed folded into the 31 that the closed loop's has.
fn noise_seed(arguments: &Arguments, number: usize) -> u32 {
    let seed = arguments.seed.unwrap_or(1).wrapping_add(number as u64);
    ((seed ^ seed >> 31 ^ seed >> 62) & 0x7fff_ffff) as u32
}

fn log_settings(arguments: &Arguments) -> LogSettings {
    const MEGABYTES: f64 = 100.0;
    const COUNT: u32 = 100;
    LogSettings {
        folder: arguments.log_dir.clone(),
        start: arguments.log_start.unwrap_or_default(),
        most_bytes: (arguments.log_size.unwrap_or(MEGABYTES) * 1e6) as u64,
        most_files: arguments.log_count.unwrap_or(COUNT) as usize,
    }
}

/// The airframe of a system: its own, else that of all.
fn airframe_of(arguments: &Arguments, system_id: u8) -> Option<&AirframeChoice> {
    let of = |id: Option<u8>| arguments.airframe.iter().flatten().find(|choice| choice.system_id == id);
    of(Some(system_id)).or_else(|| of(None)).map(|choice| &choice.value)
}

/// The plan of a system: its own, else that of all.
fn mission_of(arguments: &Arguments, system_id: u8) -> Option<&Path> {
    let of = |id: Option<u8>| arguments.mission.iter().flatten().find(|file| file.system_id == id);
    of(Some(system_id)).or_else(|| of(None)).map(|file| file.value.as_path())
}

/// Refuses plans and faults of systems that there are not, and a second plan for the same.
fn check_addresses(arguments: &Arguments, systems: &[u8]) -> Result<(), Failure> {
    let mut planned = Vec::new();
    if arguments.autostart == Some(true) && arguments.mission.iter().flatten().next().is_none() {
        let reason = "no mission to start; add --mission FILE".to_owned();
        return Err(Failure::Value { name: "--autostart".to_owned(), reason });
    }
    for file in arguments.mission.iter().flatten() {
        file.check("--mission", file.value.display(), systems)?;
        if planned.contains(&file.system_id) {
            let whose = file.system_id.map_or("all".to_owned(), |id| format!("system {id}"));
            let reason =
                format!("`{}` is a second plan for {whose}; give one plan each", file.value.display());
            return Err(Failure::Value { name: "--mission".to_owned(), reason });
        }
        planned.push(file.system_id);
    }
    let mut built = Vec::new();
    for choice in arguments.airframe.iter().flatten() {
        choice.check("--airframe", &choice.value, systems)?;
        if built.contains(&choice.system_id) {
            let whose = choice.system_id.map_or("all".to_owned(), |id| format!("system {id}"));
            let reason = format!("`{}` is a second airframe for {whose}; give one each", choice.value);
            return Err(Failure::Value { name: "--airframe".to_owned(), reason });
        }
        built.push(choice.system_id);
    }
    arguments.fault.iter().flatten().try_for_each(|fault| fault.check("--fault", fault.value, systems))
}

/// What breaks in a system when, by the sensors that there are.
fn faults(arguments: &Arguments, system_id: u8) -> Result<Vec<ScheduledFault>, Failure> {
    let ideal = arguments.sensors.unwrap_or_default() == SensorModel::Ideal;
    let own = arguments.fault.iter().flatten().filter(|fault| fault.is_for(system_id));
    let faults: Vec<ScheduledFault> = own.map(|fault| fault.value).collect();
    match faults.iter().find(|scheduled| ideal && scheduled.fault.needs_readings()) {
        None => Ok(faults),
        Some(scheduled) => {
            let reason = format!(
                "`{scheduled}` needs --sensors realistic; ideal sensors can only be `off`, `stuck` or `intermittent`"
            );
            Err(Failure::Value { name: "--fault".to_owned(), reason })
        }
    }
}
