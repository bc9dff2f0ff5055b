//! Command line and environment; the configuration file has the same settings by the same names.

use std::path::PathBuf;

use clap::Parser;
use vehicle::estimation::SensorModel;
use vehicle::fault::ScheduledFault;
use vehicle::parameters::Speed;

use super::Conventions;
use super::ranged::{number, whole};
use super::{Addressed, Clocks, Formation, HomePosition, MeasurementNoise, Ports, WindFrom};
use crate::flight_log::LogStart;
use crate::hil::Mount;
use crate::link::LinkSpecification;

const AFTER_HELP: &str = "\
Links:
  udpout:HOST:PORT[@LOCALPORT]  sends to an address, answers LOCALPORT's senders
  udpin:[HOST:]PORT             waits for datagrams, answers their senders
  tcpin:[HOST:]PORT             accepts connections
  serial:PATH[:BAUD]            a serial device or pseudo-terminal, 57600 baud
  HOST is 127.0.0.1 unless named. With `,onboard` behind it a link gets the
  faster telemetry of a companion computer. Without --link, as PX4 has them:
    udpout:127.0.0.1:14550@18570 and udpout:127.0.0.1:14540@14580,onboard
  --instance counts the local ports and 14540 up, the latter to 14549.

Many vehicles:
  --vehicles 5                    each with PX4's ports of its instance
  --vehicles 5 --ports shared     behind the same links, told apart by system id
  --vehicles 5 --link tcpin:5760  on 5760 to 5764: local ports count up, and where
                                  an onboard link sends to
  --parameters fleet.params       of system 3 among several: fleet-3.params
  --mission 3:own.plan            of system 3, instead of another one for all
  --fault 3:12.5:rotor1=off       of system 3 alone

External autopilot:
  --hil 4560   then, for PX4: make px4_sitl none_iris (its motors 1 to 4: front
               right, back left, front left, back right; see --hil-mount)
  --hil 0.0.0.0:4561   for PX4's instance 1 on another machine, which finds
               this one by its PX4_SIM_HOSTNAME

Connect with:
  QGroundControl   start it: it listens on 14550
  MAVSDK           udpin://0.0.0.0:14540
  pymavlink        mavutil.mavlink_connection('udpin:127.0.0.1:14540')
  MAVProxy         mavproxy.py --master=udpin:127.0.0.1:14550

Faults (UNIT=KIND):
  gyroscope, accelerometer, magnetometer, barometer, gps
      off, stuck, garbage, wrong, slow, delayed, intermittent
  battery
      off, stuck, wrong
  rotor1 (front), rotor2 (right), rotor3 (back), rotor4 (left), rotors
      off, stuck, weak[:SHARE of the thrust, 0.7 unless named]
  `ok` mends each of them.

Every flag can be set in the configuration file by its name (`speed = 5`;
`link = [\"tcpin:5760\", \"udpin:14550\"]` where it can be repeated), and in the
environment by LMPC_SITL_ and its name in capitals (several between `;`). Flags
go before the environment, the environment before the file.

Exit codes: 0 ended as asked, 1 the simulation failed, 2 a wrong flag or value,
3 a port or device cannot be used, 4 a file cannot be used, 5 a replayed flight
differs from the recorded one.";

/// A simulated quadrotor under Laguerre model predictive control that MAVLink clients fly.
#[derive(Clone, Debug, Default, PartialEq, Parser)]
#[command(name = "lmpc-sitl", version, after_help = AFTER_HELP, max_term_width = 110)]
pub struct Arguments {
    /// Configuration file (TOML)
    #[arg(long, env = "LMPC_SITL_CONFIG", value_name = "FILE")]
    pub config: Option<PathBuf>,

    /// Link to clients; repeat it for more, see below
    #[arg(long, env = "LMPC_SITL_LINK", value_name = "LINK", value_delimiter = ';')]
    pub link: Option<Vec<LinkSpecification>>,

    /// Number of this vehicle on the machine: moves the default ports and system id; 0 to 200
    /// [default: 0]
    #[arg(long, env = "LMPC_SITL_INSTANCE", value_name = "N", value_parser = whole(0_u16, 200), allow_negative_numbers = true)]
    pub instance: Option<u16>,

    /// MAVLink system id, 1 to 250 [default: 1 + instance]
    #[arg(long, env = "LMPC_SITL_SYSTEM_ID", value_name = "ID", value_parser = whole(1_u8, 250), allow_negative_numbers = true)]
    pub system_id: Option<u8>,

    /// Number of vehicles, 1 to 250, with system ids from --system-id upwards; gusts and noise of each have their own seed
    /// [default: 1]
    #[arg(long, env = "LMPC_SITL_VEHICLES", value_name = "N", value_parser = whole(1_u8, 250), allow_negative_numbers = true)]
    pub vehicles: Option<u8>,

    /// Whether each vehicle has its own ports, or all share them [default: own]
    #[arg(long, env = "LMPC_SITL_PORTS")]
    pub ports: Option<Ports>,

    /// Where the vehicles start, with 1 to 200 m between neighbours: line, grid or circle [default: line,5]
    #[arg(long, env = "LMPC_SITL_FORMATION", value_name = "SHAPE[,SPACING]")]
    pub formation: Option<Formation>,

    /// Whether all vehicles tick by one clock, or each has its own time and SIM_SPEEDUP [default: shared]
    #[arg(long, env = "LMPC_SITL_CLOCKS")]
    pub clocks: Option<Clocks>,

    /// Whose conventions to follow [default: px4]
    #[arg(long, env = "LMPC_SITL_AUTOPILOT")]
    pub autopilot: Option<Conventions>,

    /// Start: latitude and longitude in degrees, altitude above sea level in m, heading in degrees
    /// [default: 47.397742,8.545594,488,0]
    #[arg(long, env = "LMPC_SITL_HOME", value_name = "LAT,LON,ALT[,HEADING]", allow_hyphen_values = true)]
    pub home: Option<HomePosition>,

    /// Simulated seconds per second, 0 (paused) to 1000, or `max`; the parameter SIM_SPEEDUP changes it in flight
    /// [default: 1]
    #[arg(long, env = "LMPC_SITL_SPEED", value_name = "X|max", allow_hyphen_values = true)]
    pub speed: Option<Speed>,

    /// Steady wind: speed in m/s, 0 to 30, and the direction in degrees that it comes from. It acts through drag
    /// (AF_DRAG_X, AF_DRAG_Y, AF_DRAG_Z), of which a vehicle in wind or gusts has 0.15 N s/m unless --set or --parameters
    /// say otherwise [default: 0,0]
    #[arg(long, env = "LMPC_SITL_WIND", value_name = "SPEED[,FROM]", allow_hyphen_values = true)]
    pub wind: Option<WindFrom>,

    /// Standard deviation of gusts in m/s, 0 to 10 (Dryden's spectrum); they act through the same drag as --wind
    /// [default: 0]
    #[arg(long, env = "LMPC_SITL_GUSTS", value_name = "SIGMA", value_parser = number(0.0, 10.0), allow_hyphen_values = true)]
    pub gusts: Option<f64>,

    /// What the vehicle knows its motion by: `ideal` is the truth; `realistic` are a GPS receiver, an inertial unit, a
    /// barometer and a magnetometer with the noise of real ones, and an estimator (armable after 2 to 2.5 s) [default: ideal]
    #[arg(long, env = "LMPC_SITL_SENSORS", value_name = "ideal|realistic")]
    pub sensors: Option<SensorModel>,

    /// White noise on the measurements that an `ideal` vehicle flies by: `motion-capture` (0.001,0.01,0.002,0.005),
    /// `rtk-gps` (0.02,0.05,0.005,0.01), or standard deviations in m, m/s, rad and rad/s. Telemetry then tells what the
    /// vehicle believes, SIM_STATE the truth [default: 0,0,0,0]
    #[arg(long, env = "LMPC_SITL_NOISE", value_name = "PRESET|P,V,A,R", allow_hyphen_values = true)]
    pub noise: Option<MeasurementNoise>,

    /// Measure position and attitude only; a Kalman predictor estimates the rest in the loop [default: false]
    #[arg(
        long, env = "LMPC_SITL_KALMAN", value_name = "true|false", num_args = 0..=1,
        default_missing_value = "true"
    )]
    pub kalman: Option<bool>,

    /// Seed of everything random [default: 1]
    #[arg(long, env = "LMPC_SITL_SEED", value_name = "N", value_parser = whole(0, u64::MAX), allow_negative_numbers = true)]
    pub seed: Option<u64>,

    /// Parameter at the start, by its MAVLink id or its dotted name (airframe.mass=0.9); repeat it for more
    #[arg(long, env = "LMPC_SITL_SET", value_name = "NAME=VALUE", value_delimiter = ';')]
    pub set: Option<Vec<String>>,

    /// What breaks when, such as 12.5:rotor1=off; repeat it for more, see below. Of one vehicle only with its system id in
    /// front
    #[arg(long, env = "LMPC_SITL_FAULT", value_name = "[ID:]SECONDS:UNIT=KIND", value_delimiter = ';')]
    pub fault: Option<Vec<Addressed<ScheduledFault>>>,

    /// Parameter file: read at the start if it exists, written whenever a parameter changes
    #[arg(long, env = "LMPC_SITL_PARAMETERS", value_name = "FILE")]
    pub parameters: Option<PathBuf>,

    /// Plan to start with: QGroundControl's .plan (mission, fence and rally points) or a QGC WPL 110 text (mission). Repeat
    /// it for plans of single vehicles, with their system ids in front
    #[arg(long, env = "LMPC_SITL_MISSION", value_name = "[ID:]FILE", value_delimiter = ';')]
    pub mission: Option<Vec<Addressed<PathBuf>>>,

    /// Arm and start the mission of --mission as soon as the vehicle is ready [default: false]
    #[arg(long, env = "LMPC_SITL_AUTOSTART", value_name = "true|false", num_args = 0..=1, default_missing_value = "true")]
    pub autostart: Option<bool>,

    /// Record received messages with their simulation times, to be replayed
    #[arg(long, env = "LMPC_SITL_RECORD", value_name = "FILE", conflicts_with = "replay")]
    pub record: Option<PathBuf>,

    /// Fly a record again, without links, and compare the flight with the recorded one
    #[arg(long, env = "LMPC_SITL_REPLAY", value_name = "FILE")]
    pub replay: Option<PathBuf>,

    /// Only the plant, as the simulator of an external autopilot that connects to this TCP port (PX4 to 4560): HIL_SENSOR,
    /// HIL_GPS and HIL_STATE_QUATERNION for HIL_ACTUATOR_CONTROLS, in lock-step
    #[arg(long, env = "LMPC_SITL_HIL", value_name = "[HOST:]PORT", conflicts_with = "replay")]
    pub hil: Option<String>,

    /// How that autopilot sits on the airframe: forward between two arms (x) or along one (plus) [default: x]
    #[arg(long, env = "LMPC_SITL_HIL_MOUNT", value_name = "MOUNT")]
    pub hil_mount: Option<Mount>,

    /// Log all traffic as ground stations do (.tlog)
    #[arg(long, env = "LMPC_SITL_TLOG", value_name = "FILE")]
    pub tlog: Option<PathBuf>,

    /// Folder of flight logs (ULog, for Flight Review, PlotJuggler and pyulog); made if it is not there. Clients download
    /// them
    #[arg(long, env = "LMPC_SITL_LOG_DIR", value_name = "DIR")]
    pub log_dir: Option<PathBuf>,

    /// When a log begins: `arm` (one per flight) or `boot` (one per run) [default: arm]
    #[arg(long, env = "LMPC_SITL_LOG_START", value_name = "arm|boot")]
    pub log_start: Option<LogStart>,

    /// A flight or traffic log goes on in another file at this size, 0.1 to 4000 MB
    /// [default: 100]
    #[arg(long, env = "LMPC_SITL_LOG_SIZE", value_name = "MB", value_parser = number(0.1, 4000.0), allow_hyphen_values = true)]
    pub log_size: Option<f64>,

    /// Flight logs, and files of the traffic log, that are kept, 1 to 10000; the oldest go
    /// [default: 100]
    #[arg(long, env = "LMPC_SITL_LOG_COUNT", value_name = "N", value_parser = whole(1_u32, 10_000), allow_negative_numbers = true)]
    pub log_count: Option<u32>,

    /// Folder that clients see as /files by MAVLink FTP, to be read
    #[arg(long, env = "LMPC_SITL_FTP_ROOT", value_name = "DIR")]
    pub ftp_root: Option<PathBuf>,

    /// Let clients change what is in --ftp-root, up to 64 MB [default: false]
    #[arg(long, env = "LMPC_SITL_FTP_WRITE", num_args = 0..=1, default_missing_value = "true", value_name = "true|false")]
    pub ftp_write: Option<bool>,

    /// Key to sign and verify all messages with (MAVLink 2): 64 hexadecimal digits or 32 bytes, mode 0600; timestamps are
    /// kept beside it. An empty file waits for SETUP_SIGNING, which is accepted on local links only
    #[arg(long, env = "LMPC_SITL_SIGNING_KEY", value_name = "FILE")]
    pub signing_key: Option<PathBuf>,

    /// File that is written (JSON: process id, addresses of the links) when clients can connect; an older one is removed
    /// first
    #[arg(long, env = "LMPC_SITL_READY_FILE", value_name = "FILE")]
    pub ready_file: Option<PathBuf>,

    /// End after this much simulated time
    #[arg(long, env = "LMPC_SITL_DURATION", value_name = "SECONDS", value_parser = number(0.0, 1e9), allow_hyphen_values = true)]
    pub duration: Option<f64>,

    /// What to log to the standard error stream: error, warn, info, debug, or a filter of targets [default: info]
    #[arg(long, env = "LMPC_SITL_LOG", value_name = "FILTER")]
    pub log: Option<String>,
}

impl Arguments {
    /// What is not told here is taken from what goes after it.
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
            home: self.home.or(file.home),
            speed: self.speed.or(file.speed),
            wind: self.wind.or(file.wind),
            gusts: self.gusts.or(file.gusts),
            sensors: self.sensors.or(file.sensors),
            noise: self.noise.or(file.noise),
            kalman: self.kalman.or(file.kalman),
            seed: self.seed.or(file.seed),
            set: self.set.or(file.set),
            fault: self.fault.or(file.fault),
            parameters: self.parameters.or(file.parameters),
            mission: self.mission.or(file.mission),
            autostart: self.autostart.or(file.autostart),
            record: self.record.or(file.record),
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
            signing_key: self.signing_key.or(file.signing_key),
            ready_file: self.ready_file.or(file.ready_file),
            duration: self.duration.or(file.duration),
            log: self.log.or(file.log),
        }
    }
}
