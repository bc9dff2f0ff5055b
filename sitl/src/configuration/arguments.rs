//! Command line and environment; the configuration file has the same settings by the same names.

use std::path::PathBuf;

use clap::Parser;
use clap::builder::{OsStringValueParser, TypedValueParser};
use vehicle::estimation::SensorModel;
use vehicle::fault::ScheduledFault;
use vehicle::parameters::Speed;

use super::equipment::EquipmentChoice;
use super::help::{FILES, FLEET, FMU, HIL, LINKS, SIMULATION, VEHICLE};
use super::ranged::{non_negative, number, whole};
use super::view::DEFAULT_VIEW;
use super::{
    Addressed, AirframeChoice, Clocks, Formation, HomePosition, ListFormat, MeasurementNoise, Ports,
    TrafficChoice, ViewAddress, WindFrom,
};
use super::{Conventions, LogFilter};
use crate::fleet::LockstepPhase;
use crate::flight_log::LogStart;
use crate::hil::Mount;
use crate::link::LinkSpecification;

/// A simulated MAVLink quadrotor under Laguerre model predictive control.
#[derive(Clone, Debug, Default, PartialEq, Parser)]
#[command(name = "lmpc-sitl", version, max_term_width = 110)]
pub struct Arguments {
    /// Configuration file (TOML)
    ///
    /// Sets flags by their names; see "Configuration" below.
    #[arg(long, env = "LMPC_SITL_CONFIG", value_name = "FILE")]
    pub config: Option<PathBuf>,

    /// File to write when clients can connect (JSON)
    ///
    /// It has the process id and the addresses of the links. A file of an earlier run is removed at the start.
    #[arg(long, env = "LMPC_SITL_READY_FILE", value_name = "FILE", hide_short_help = true)]
    pub ready_file: Option<PathBuf>,

    /// Log level: off, error, warn, info, debug or trace
    ///
    /// Levels of single parts follow after commas: warn,sitl=debug. The parts are autopilot, sitl and vehicle.
    /// [default: info]
    #[arg(long, env = "LMPC_SITL_LOG", value_name = "LEVEL")]
    pub log: Option<LogFilter>,

    /// Show one status line instead of the panel [default: false]
    ///
    /// Either appears on a terminal only.
    #[arg(
        long, env = "LMPC_SITL_NO_PANEL", value_name = "true|false", num_args = 0..=1, default_missing_value = "true",
        hide_short_help = true
    )]
    pub no_panel: Option<bool>,

    /// Link to clients; repeat it for more
    ///
    /// See "Link formats" below. [default: PX4's links to UDP ports 14550 and 14540]
    #[arg(long, env = "LMPC_SITL_LINK", value_name = "LINK", value_delimiter = ';', help_heading = LINKS)]
    pub link: Option<Vec<LinkSpecification>>,

    /// Instance number on this machine, 0 to 200 [default: 0]
    ///
    /// Moves the default ports and the system id, so that several runs do not collide.
    #[arg(long, env = "LMPC_SITL_INSTANCE", value_name = "N", value_parser = whole(0_u16, 200), allow_negative_numbers = true, help_heading = LINKS, hide_short_help = true)]
    pub instance: Option<u16>,

    /// MAVLink system id, 1 to 250 [default: 1 + instance]
    #[arg(long, env = "LMPC_SITL_SYSTEM_ID", value_name = "ID", value_parser = whole(1_u8, 250), allow_negative_numbers = true, help_heading = LINKS, hide_short_help = true)]
    pub system_id: Option<u8>,

    /// Key file for signing and verifying messages (MAVLink 2)
    ///
    /// The file has 64 hexadecimal digits or 32 bytes, and mode 0600. Timestamps are kept in a file beside it. An empty file
    /// needs --accept-signing-setup.
    #[arg(long, env = "LMPC_SITL_SIGNING_KEY", value_name = "FILE", help_heading = LINKS, hide_short_help = true)]
    pub signing_key: Option<PathBuf>,

    /// Let a local client set the first signing key
    ///
    /// It sends SETUP_SIGNING over loopback or a serial link while no vehicle is armed. The key is stored in the file of
    /// --signing-key; without that flag it is forgotten at the end. A key in use can only be changed by messages that it signs.
    /// [default: false]
    #[arg(
        long, env = "LMPC_SITL_ACCEPT_SIGNING_SETUP", value_name = "true|false", num_args = 0..=1,
        default_missing_value = "true", help_heading = LINKS, hide_short_help = true
    )]
    pub accept_signing_setup: Option<bool>,

    /// UDP port for a pilot's radio
    ///
    /// A datagram has the pulses of 8 or 16 channels in µs, 16 bits each, the lowest byte first, as ArduPilot's SITL receives them on port
    /// 5501. Pulses hold until the next datagram. Each further vehicle has a port of its own, 10 above the one before it. Port 0 is any free
    /// port. Only programs on this machine can reach the port. [default: none]
    #[arg(long, env = "LMPC_SITL_RC_PORT", value_name = "PORT", value_parser = whole(0_u16, 65_535), allow_negative_numbers = true, help_heading = LINKS, hide_short_help = true)]
    pub rc_port: Option<u16>,

    /// Autopilot whose conventions to follow [default: px4]
    #[arg(long, env = "LMPC_SITL_AUTOPILOT", help_heading = VEHICLE)]
    pub autopilot: Option<Conventions>,

    /// Airframe: a preset or a TOML file [default: paper]
    ///
    /// Presets are paper (0.7 kg), crazyflie (28 g), hummingbird (0.7 kg), iris (1.5 kg) and heavy (10 kg). Limits, weights and
    /// battery follow from the airframe. See "Airframes" below. Repeat it for single vehicles, with their system ids in front.
    #[arg(
        long, env = "LMPC_SITL_AIRFRAME", value_name = "[ID:]NAME|FILE.toml", value_delimiter = ';', help_heading = VEHICLE,
        value_parser = OsStringValueParser::new().try_map(Addressed::of_airframe)
    )]
    pub airframe: Option<Vec<Addressed<AirframeChoice>>>,

    /// Start: LAT,LON,ALT or LAT,LON,ALT,HEADING
    ///
    /// Latitude and longitude in degrees, altitude above sea level in m, heading in degrees from north through east.
    /// [default: 47.397742,8.545594,488,0]
    #[arg(long, env = "LMPC_SITL_HOME", value_name = "PLACE", allow_hyphen_values = true, help_heading = VEHICLE)]
    pub home: Option<HomePosition>,

    /// Parameter file, read at the start and updated
    ///
    /// The file need not exist; it is written whenever a parameter changes. Lines are `NAME VALUE`, `NAME,VALUE` or
    /// `NAME = VALUE`, or those of QGroundControl's files. A file that ends in .params is written in QGroundControl's form,
    /// any other as `NAME VALUE`.
    ///
    /// Missions, fences and rally points are kept beside it, in FILE.plans. Without this flag, parameters and plans outlast a
    /// reboot command, but not the program.
    #[arg(long, env = "LMPC_SITL_PARAMETERS", value_name = "FILE", help_heading = VEHICLE)]
    pub parameters: Option<PathBuf>,

    /// Parameter at the start; repeat it for more
    ///
    /// NAME is a MAVLink name or a dotted name; a value may be a name, too: airframe.mass=0.9, controller.kind=dlqr. It
    /// overrides the parameter file.
    #[arg(long, env = "LMPC_SITL_SET", value_name = "NAME=VALUE", value_delimiter = ';', help_heading = VEHICLE)]
    pub set: Option<Vec<String>>,

    /// List all parameters and exit
    ///
    /// With the values at the start, as a table or as JSON. [default: table]
    #[arg(
        long, env = "LMPC_SITL_LIST_PARAMETERS", value_name = "table|json", num_args = 0..=1,
        default_missing_value = "table", help_heading = VEHICLE, hide_short_help = true, hide_possible_values = true
    )]
    pub list_parameters: Option<ListFormat>,

    /// Plan to start with (.plan or QGC WPL 110)
    ///
    /// QGroundControl's .plan has a mission, a fence and rally points; a QGC WPL 110 text has a mission. Repeat it for plans
    /// of single vehicles, with their system ids in front.
    #[arg(
        long, env = "LMPC_SITL_MISSION", value_name = "[ID:]FILE", value_delimiter = ';', help_heading = VEHICLE,
        value_parser = OsStringValueParser::new().map(Addressed::of_path)
    )]
    pub mission: Option<Vec<Addressed<PathBuf>>>,

    /// Arm and start the mission at once [default: false]
    ///
    /// The vehicle arms and starts the mission of --mission as soon as it is ready. A pilot who arms or chooses another mode
    /// takes over.
    #[arg(
        long, env = "LMPC_SITL_AUTOSTART", value_name = "true|false", num_args = 0..=1,
        default_missing_value = "true", help_heading = VEHICLE
    )]
    pub autostart: Option<bool>,

    /// Who speaks for camera and gimbal [default: autopilot]
    ///
    /// With `own`, the camera (component 100) and the gimbal (component 154) send heartbeats and messages of their own, as MAVLink
    /// cameras and gimbals do. With `autopilot` no heartbeats but the autopilot's are sent, so that clients that take every
    /// heartbeat for the autopilot's are not misled; requests to both components are answered all the same.
    #[arg(
        long, env = "LMPC_SITL_EQUIPMENT", value_name = "autopilot|own", help_heading = VEHICLE, hide_possible_values = true,
        hide_short_help = true
    )]
    pub equipment: Option<EquipmentChoice>,

    /// Number of vehicles, 1 to 250 [default: 1]
    ///
    /// Their system ids count up from --system-id. Each has its own seed for gusts and noise.
    #[arg(long, env = "LMPC_SITL_VEHICLES", value_name = "N", value_parser = whole(1_u8, 250), allow_negative_numbers = true, help_heading = FLEET)]
    pub vehicles: Option<u8>,

    /// Own or shared ports [default: own]
    #[arg(long, env = "LMPC_SITL_PORTS", help_heading = FLEET, hide_short_help = true)]
    pub ports: Option<Ports>,

    /// Arrangement at the start [default: line,5]
    ///
    /// SHAPE is line, grid or circle; SPACING is the distance between neighbours, 1 to 200 m.
    #[arg(long, env = "LMPC_SITL_FORMATION", value_name = "SHAPE[,SPACING]", help_heading = FLEET, hide_short_help = true)]
    pub formation: Option<Formation>,

    /// Shared or separate clocks [default: shared]
    #[arg(long, env = "LMPC_SITL_CLOCKS", help_heading = FLEET, hide_short_help = true)]
    pub clocks: Option<Clocks>,

    /// Simulated seconds per second, or `max` [default: 1]
    ///
    /// From 0.01 to 1000; 0 is paused. The parameter SIM_SPEEDUP changes it in flight.
    #[arg(long, env = "LMPC_SITL_SPEED", value_name = "X|max", allow_hyphen_values = true, help_heading = SIMULATION)]
    pub speed: Option<Speed>,

    /// Simulated time waits for a client's set-points
    ///
    /// A closed loop then flies the same at every --speed; see "Lock-step" below. `streaming` waits while a client streams
    /// set-points, `always` from the start. [default: off; `streaming` without a value]
    #[arg(
        long, env = "LMPC_SITL_LOCKSTEP", value_name = "PHASE", num_args = 0..=1,
        default_missing_value = "streaming", help_heading = SIMULATION, hide_short_help = true, hide_possible_values = true
    )]
    pub lockstep: Option<LockstepPhase>,

    /// Simulated time per set-point [default: 0.02]
    ///
    /// From 0.001 to 1 s, in lock-step.
    #[arg(long, env = "LMPC_SITL_LOCKSTEP_PERIOD", value_name = "SECONDS", value_parser = number(0.001, 1.0), allow_hyphen_values = true, help_heading = SIMULATION, hide_short_help = true)]
    pub lockstep_period: Option<f64>,

    /// Longest wait for a set-point in flight [default: 5]
    ///
    /// Seconds of the wall clock, 0.1 to 1000000. The vehicle then flies on without waiting.
    #[arg(long, env = "LMPC_SITL_LOCKSTEP_TIMEOUT", value_name = "SECONDS", value_parser = number(0.1, 1e6), allow_hyphen_values = true, help_heading = SIMULATION, hide_short_help = true)]
    pub lockstep_timeout: Option<f64>,

    /// End after this much simulated time
    #[arg(long, env = "LMPC_SITL_DURATION", value_name = "SECONDS", value_parser = number(0.0, 1e9), allow_hyphen_values = true, help_heading = SIMULATION, hide_short_help = true)]
    pub duration: Option<f64>,

    /// Seed for everything random [default: 1]
    #[arg(long, env = "LMPC_SITL_SEED", value_name = "N", value_parser = non_negative, allow_negative_numbers = true, help_heading = SIMULATION, hide_short_help = true)]
    pub seed: Option<u64>,

    /// Steady wind: m/s, and degrees it comes from
    ///
    /// From 0 to 30 m/s. Wind pushes through drag (airframe.drag.x, .y and .z). In wind or gusts an airframe without drag
    /// gets 0.15 N·s/m per 0.7 kg unless --set or --parameters give another. A warning appears if the vehicle cannot hold its position.
    /// [default: 0,0]
    #[arg(long, env = "LMPC_SITL_WIND", value_name = "SPEED[,FROM]", allow_hyphen_values = true, help_heading = SIMULATION)]
    pub wind: Option<WindFrom>,

    /// Standard deviation of gusts, 0 to 10 m/s
    ///
    /// Gusts have a Dryden spectrum and push through the same drag as --wind. [default: 0]
    #[arg(long, env = "LMPC_SITL_GUSTS", value_name = "SIGMA", value_parser = number(0.0, 10.0), allow_hyphen_values = true, help_heading = SIMULATION, hide_short_help = true)]
    pub gusts: Option<f64>,

    /// Sensors: ideal or realistic [default: ideal]
    ///
    /// `ideal` is the truth. `realistic` is a GPS receiver, an inertial unit, a barometer and a magnetometer with the noise of
    /// real ones, and an estimator; the vehicle can be armed after 2 to 2.5 s.
    #[arg(long, env = "LMPC_SITL_SENSORS", value_name = "MODEL", help_heading = SIMULATION)]
    pub sensors: Option<SensorModel>,

    /// White noise on the measurements of `ideal` sensors
    ///
    /// `motion-capture` (0.001,0.01,0.002,0.005), `rtk-gps` (0.02,0.05,0.005,0.01), or standard deviations in m, m/s, rad and
    /// rad/s. Telemetry then shows what the vehicle measures, SIM_STATE the truth. [default: 0,0,0,0]
    #[arg(long, env = "LMPC_SITL_NOISE", value_name = "PRESET|P,V,A,R", allow_hyphen_values = true, help_heading = SIMULATION, hide_short_help = true)]
    pub noise: Option<MeasurementNoise>,

    /// Measure only position and attitude [default: false]
    ///
    /// A Kalman predictor in the loop estimates velocities and body rates.
    #[arg(
        long, env = "LMPC_SITL_KALMAN", value_name = "true|false", num_args = 0..=1,
        default_missing_value = "true", help_heading = SIMULATION, hide_short_help = true
    )]
    pub kalman: Option<bool>,

    /// Ground with heights, and obstacles (TOML)
    ///
    /// Hills or a grid of heights; boxes, cylinders and walls. A downward rangefinder measures both, a lidar the obstacles. A
    /// vehicle that touches an obstacle ends its flight. [default: flat ground without obstacles]
    #[arg(long, env = "LMPC_SITL_WORLD", value_name = "FILE.toml", help_heading = SIMULATION, hide_short_help = true)]
    pub world: Option<PathBuf>,

    /// Aircraft around the vehicles: a flight, a file or `fleet`
    ///
    /// `NORTH,EAST,HEIGHT,SPEED,COURSE[,CLIMB]` flies straight on, from a place in metres, with m/s and degrees. FILE.toml has
    /// several, with tracks. `fleet` makes the vehicles of this run see one another. Repeat it for more.
    #[arg(
        long, env = "LMPC_SITL_TRAFFIC", value_name = "AIRCRAFT", value_delimiter = ';', allow_hyphen_values = true,
        help_heading = SIMULATION, hide_short_help = true,
        value_parser = OsStringValueParser::new().try_map(TrafficChoice::of)
    )]
    pub traffic: Option<Vec<TrafficChoice>>,

    /// Fault to inject, such as 12.5:rotor1=off
    ///
    /// SECONDS:UNIT=KIND, see "Faults" below; repeat it for more. A system id in front restricts it to one vehicle.
    #[arg(long, env = "LMPC_SITL_FAULT", value_name = "FAULT", value_delimiter = ';', help_heading = SIMULATION)]
    pub fault: Option<Vec<Addressed<ScheduledFault>>>,

    /// Record received messages for --replay
    ///
    /// Each message is recorded with its simulation time.
    #[arg(long, env = "LMPC_SITL_RECORD", value_name = "FILE", help_heading = FILES)]
    pub record: Option<PathBuf>,

    /// Size at which a record ends [default: 1000]
    ///
    /// From 0.1 to 100000 MB. The flight goes on without the record.
    #[arg(long, env = "LMPC_SITL_RECORD_SIZE", value_name = "MB", value_parser = number(0.1, 100_000.0), allow_hyphen_values = true, help_heading = FILES, hide_short_help = true)]
    pub record_size: Option<f64>,

    /// Fly a record again and compare the flights
    ///
    /// It flies as fast as possible and opens no links. The record holds all settings, so only --log goes with this flag, and a
    /// --config with nothing else in it. The record of a program that was killed replays up to its last complete line. Exit code 5
    /// means that the flights differ.
    #[arg(long, env = "LMPC_SITL_REPLAY", value_name = "FILE", help_heading = FILES)]
    pub replay: Option<PathBuf>,

    /// Folder for flight logs (ULog)
    ///
    /// For Flight Review, PlotJuggler and pyulog; clients can download them. The folder is created if necessary.
    #[arg(long, env = "LMPC_SITL_LOG_DIR", value_name = "DIR", help_heading = FILES)]
    pub log_dir: Option<PathBuf>,

    /// When a flight log begins [default: arm]
    ///
    /// `arm` makes one log per flight, `boot` one per run.
    #[arg(long, env = "LMPC_SITL_LOG_START", value_name = "arm|boot", help_heading = FILES, hide_short_help = true)]
    pub log_start: Option<LogStart>,

    /// Size at which a log continues in a new file [default: 100]
    ///
    /// 0.1 to 4000 MB, for flight logs and the traffic log.
    #[arg(long, env = "LMPC_SITL_LOG_SIZE", value_name = "MB", value_parser = number(0.1, 4000.0), allow_hyphen_values = true, help_heading = FILES, hide_short_help = true)]
    pub log_size: Option<f64>,

    /// Number of log files to keep, 1 to 10000 [default: 100]
    ///
    /// For flight logs and for files of the traffic log; the oldest are deleted.
    #[arg(long, env = "LMPC_SITL_LOG_COUNT", value_name = "N", value_parser = whole(1_u32, 10_000), allow_negative_numbers = true, help_heading = FILES, hide_short_help = true)]
    pub log_count: Option<u32>,

    /// Log all MAVLink traffic, as ground stations do (.tlog)
    #[arg(long, env = "LMPC_SITL_TLOG", value_name = "FILE", help_heading = FILES, hide_short_help = true)]
    pub tlog: Option<PathBuf>,

    /// Folder that clients see as /files by MAVLink FTP
    ///
    /// Clients can only read it, unless --ftp-write is set.
    #[arg(long, env = "LMPC_SITL_FTP_ROOT", value_name = "DIR", help_heading = FILES, hide_short_help = true)]
    pub ftp_root: Option<PathBuf>,

    /// Let clients change files in --ftp-root [default: false]
    ///
    /// Up to 64 MiB in all and 16 MiB per file.
    #[arg(
        long, env = "LMPC_SITL_FTP_WRITE", num_args = 0..=1, default_missing_value = "true", value_name = "true|false",
        help_heading = FILES, hide_short_help = true
    )]
    pub ftp_write: Option<bool>,

    /// Show the flight in a browser
    ///
    /// Prints the address of the page. Only a page with the token in that address can send commands; others can only watch.
    /// HOST defaults to 127.0.0.1: name another address to let other machines see the page. Port 0 is any free port.
    /// [default: off; 127.0.0.1:8088 without a value]
    #[arg(
        long, env = "LMPC_SITL_VIEW", value_name = "[HOST:]PORT", num_args = 0..=1, default_missing_value = DEFAULT_VIEW,
        allow_negative_numbers = true, help_heading = LINKS
    )]
    pub view: Option<ViewAddress>,

    /// Show a recorded flight in a browser (.ulg, .csv or .lmpc)
    ///
    /// FILE is a ULog (such as --log-dir writes), a table (such as FMPy's results of LmpcQuadrotor.fmu) or a record (of --record),
    /// which the program replays first. Only --view, --view-page, --ready-file and --log go with this flag. Ctrl-C ends the
    /// program.
    #[arg(long, env = "LMPC_SITL_VIEW_RECORD", value_name = "FILE", help_heading = LINKS, hide_short_help = true)]
    pub view_record: Option<PathBuf>,

    /// Write the page of --view-record to a file and exit
    ///
    /// FILE is a single HTML file that contains the page and the flight: browsers open it without a server. The flight can have
    /// up to 375 MB; without this flag a table can have 500 MB and a ULog 1 GB.
    #[arg(long, env = "LMPC_SITL_VIEW_PAGE", value_name = "FILE", help_heading = LINKS, hide_short_help = true)]
    pub view_page: Option<PathBuf>,

    /// FMU that flies (FMI 2.0 co-simulation)
    ///
    /// It flies as the closed loop, or as the plant under our controllers, depending on its inputs. Variables with our names are
    /// found without a map; --map names others. Each vehicle has an instance of its own, in a process of its own. With --hil it
    /// is the plant of the external autopilot. Exit code 6 means that it crashed, hung or reported an error.
    #[arg(long, env = "LMPC_SITL_FMU", value_name = "FILE.fmu", help_heading = FMU, hide_short_help = true)]
    pub fmu: Option<PathBuf>,

    /// Names, units, axes and start values of --fmu (TOML)
    ///
    /// For an FMU whose variables have other names than ours. `[variables]` has our names and its names, `[frame]` its axes,
    /// `[parameters]` its start values.
    #[arg(long, env = "LMPC_SITL_MAP", value_name = "FILE.toml", help_heading = FMU, hide_short_help = true)]
    pub map: Option<PathBuf>,

    /// List which variables of --fmu are used, and exit
    ///
    /// With units, conversions and start values. The FMU's code does not run. [default: false]
    #[arg(
        long, env = "LMPC_SITL_FMU_CHECK", value_name = "true|false", num_args = 0..=1, default_missing_value = "true",
        help_heading = FMU, hide_short_help = true
    )]
    pub fmu_check: Option<bool>,

    /// Only simulate the plant, for an autopilot on TCP
    ///
    /// PX4 connects to port 4560; HOST defaults to 127.0.0.1. Sends HIL_SENSOR, HIL_GPS and HIL_STATE_QUATERNION, receives
    /// HIL_ACTUATOR_CONTROLS, in lock-step. Start PX4 with `make px4_sitl none_iris`; on another machine, set its
    /// PX4_SIM_HOSTNAME to this one.
    #[arg(long, env = "LMPC_SITL_HIL", value_name = "[HOST:]PORT", allow_negative_numbers = true, help_heading = HIL, hide_short_help = true)]
    pub hil: Option<String>,

    /// How the autopilot is mounted on the airframe [default: x]
    ///
    /// Its motors 1 to 4 are front right, back left, front left and back right (x), or right, left, front and back (plus).
    #[arg(long, env = "LMPC_SITL_HIL_MOUNT", value_name = "MOUNT", help_heading = HIL, hide_short_help = true)]
    pub hil_mount: Option<Mount>,
}

impl Arguments {
    /// Whether each vehicle sees the others in its traffic.
    pub fn sees_fleet(&self) -> bool {
        self.traffic.iter().flatten().any(|choice| *choice == TrafficChoice::Fleet)
    }

    /// These settings; what they leave open is taken from a file's.
    pub fn or(self, file: Self) -> Self {
        Self {
            config: self.config,
            link: self.link.or(file.link),
            instance: self.instance.or(file.instance),
            system_id: self.system_id.or(file.system_id),
            vehicles: self.vehicles.or(file.vehicles),
            ports: self.ports.or(file.ports),
            formation: self.formation.or(file.formation),
            clocks: self.clocks.or(file.clocks),
            autopilot: self.autopilot.or(file.autopilot),
            airframe: self.airframe.or(file.airframe),
            home: self.home.or(file.home),
            speed: self.speed.or(file.speed),
            lockstep: self.lockstep.or(file.lockstep),
            lockstep_period: self.lockstep_period.or(file.lockstep_period),
            lockstep_timeout: self.lockstep_timeout.or(file.lockstep_timeout),
            wind: self.wind.or(file.wind),
            gusts: self.gusts.or(file.gusts),
            sensors: self.sensors.or(file.sensors),
            noise: self.noise.or(file.noise),
            kalman: self.kalman.or(file.kalman),
            seed: self.seed.or(file.seed),
            set: self.set.or(file.set),
            fault: self.fault.or(file.fault),
            world: self.world.or(file.world),
            traffic: self.traffic.or(file.traffic),
            parameters: self.parameters.or(file.parameters),
            list_parameters: self.list_parameters.or(file.list_parameters),
            mission: self.mission.or(file.mission),
            autostart: self.autostart.or(file.autostart),
            equipment: self.equipment.or(file.equipment),
            record: self.record.or(file.record),
            record_size: self.record_size.or(file.record_size),
            replay: self.replay.or(file.replay),
            hil: self.hil.or(file.hil),
            hil_mount: self.hil_mount.or(file.hil_mount),
            tlog: self.tlog.or(file.tlog),
            log_dir: self.log_dir.or(file.log_dir),
            log_start: self.log_start.or(file.log_start),
            log_size: self.log_size.or(file.log_size),
            log_count: self.log_count.or(file.log_count),
            ftp_root: self.ftp_root.or(file.ftp_root),
            ftp_write: self.ftp_write.or(file.ftp_write),
            view: self.view.or(file.view),
            view_record: self.view_record.or(file.view_record),
            view_page: self.view_page.or(file.view_page),
            fmu: self.fmu.or(file.fmu),
            map: self.map.or(file.map),
            fmu_check: self.fmu_check.or(file.fmu_check),
            signing_key: self.signing_key.or(file.signing_key),
            accept_signing_setup: self.accept_signing_setup.or(file.accept_signing_setup),
            rc_port: self.rc_port.or(file.rc_port),
            ready_file: self.ready_file.or(file.ready_file),
            duration: self.duration.or(file.duration),
            log: self.log.or(file.log),
            no_panel: self.no_panel.or(file.no_panel),
        }
    }
}
