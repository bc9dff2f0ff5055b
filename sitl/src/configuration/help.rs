//! The command line as clap knows it, and the texts around its flags.

use clap::{Command, CommandFactory};

use super::Arguments;

/// Headings of the groups of flags; what has none stands under "Options".
pub const LINKS: &str = "Links";
/// What flies, and from where.
pub const VEHICLE: &str = "Vehicle";
/// Fleets.
pub const FLEET: &str = "Several vehicles";
/// Time, air, sensors and faults.
pub const SIMULATION: &str = "Simulation";
/// What is written and read.
pub const FILES: &str = "Records, logs and files";
/// The page in a browser.
pub const VIEW: &str = "Live page";
/// Models of others.
pub const FMU: &str = "FMU in place of ours";
/// Hardware and software in the loop.
pub const HIL: &str = "External autopilot";

/// Behind the short help.
pub const AFTER_SHORT: &str = "\
Start it without flags, then open QGroundControl, or connect to UDP port 14540.
`--help` lists all flags, link formats, faults, examples and exit codes.";

/// Behind the long help.
pub const AFTER_LONG: &str = "\
Link formats:
  udpout:HOST:PORT[@LOCALPORT]  sends to an address; also answers whoever sends
                                to LOCALPORT
  udpin:[HOST:]PORT             waits for datagrams and answers their senders
  tcpin:[HOST:]PORT             accepts connections
  serial:PATH[:BAUD]            a serial device or pseudo-terminal; 57600 baud by
                                default
  HOST defaults to 127.0.0.1: links bind to and send to loopback unless you name
  another address. Append `,onboard` for the faster telemetry of a companion
  computer. The default links are PX4's: udpout:127.0.0.1:14550@18570 for ground
  stations and udpout:127.0.0.1:14540@14580,onboard for programs. --instance
  increments the local ports and port 14540, which ends at 14549.

How to connect:
  QGroundControl   start it: it listens on port 14550
  MAVSDK           udpin://0.0.0.0:14540
  pymavlink        mavutil.mavlink_connection('udpin:127.0.0.1:14540')
  MAVProxy         mavproxy.py --master=udpin:127.0.0.1:14550

Airframes:
  paper, crazyflie, hummingbird, iris and heavy have published parameters. A TOML
  file has those of your own vehicle, by the names of --list-parameters:
      preset = \"iris\"            # the rest; without it the file has everything
      mass = 1.8
      layout = \"x\"               # or plus, reversed, or the places of the rotors
      inertia = { x = 0.03, y = 0.03, z = 0.06 }
      [limits]
      tilt = 0.5
  --parameters and --set come on top.

Faults, as UNIT=KIND:
  gyroscope, accelerometer, magnetometer, barometer, gps
      off, stuck, garbage, wrong, slow, delayed, intermittent
  battery
      off, stuck, wrong
  rotor1 (front), rotor2 (right), rotor3 (back), rotor4 (left), rotors (all)
      off, stuck, weak[:SHARE], with SHARE of the thrust left, 0.7 by default
  `ok` repairs the unit.

Examples:
  Links        lmpc-sitl --link tcpin:5760 --link udpin:0.0.0.0:14550
  Vehicle      lmpc-sitl --autopilot ardupilot --set airframe.mass=0.9
  Airframe     lmpc-sitl --airframe crazyflie
  Fleet        lmpc-sitl --vehicles 5 --formation circle,6 --ports shared
  Wind         lmpc-sitl --wind 8,270 --gusts 1.5 --sensors realistic
  Mission      lmpc-sitl --mission survey.plan --autostart
  Fault        lmpc-sitl --mission survey.plan --fault 60:rotor1=off
  Speed        lmpc-sitl --speed max --duration 600
  Record       lmpc-sitl --record flight.lmpc
  Replay       lmpc-sitl --replay flight.lmpc
  Flight logs  lmpc-sitl --log-dir logs --log-start boot
  Live page    lmpc-sitl --view --speed 2
  FMU          lmpc-sitl --fmu plant.fmu --map plant.toml
  PX4          lmpc-sitl --hil 4560

Lock-step (--speed max --lockstep always):
  Each set-point (SET_POSITION_TARGET_*, SET_ATTITUDE_TARGET), in any mode, lets
  the vehicle fly one --lockstep-period. Then time stops: the vehicle sends
  LOCAL_POSITION_NED, unless it did in that period, and waits for the next
  set-point. Messages that arrive in between take effect when the period ends.
  A client that answers each report with one set-point flies the same at every
  speed. Do not ask for reports more often than once per period.
    streaming   time waits from the first set-point on; outside Offboard
                (Guided) only until none has come for 0.5 s
    always      time also waits for the first set-point, so that the whole
                flight is the same bit for bit
  If the client disconnects in flight, or is silent for --lockstep-timeout, the
  vehicle reports this and flies on without waiting, until the next set-point.

Several vehicles:
  Each has its own default ports, as PX4's instances have; with --link, local
  ports count up (tcpin:5760 to tcpin:5764), and so does the port that an onboard
  link sends to. --ports shared puts all behind the same links, told apart by
  system id. System 3 reads fleet-3.params for --parameters fleet.params. An id
  in front addresses one system: --mission 3:own.plan, --fault 3:12.5:rotor1=off.

Configuration:
  A TOML file sets flags by name: speed = 5, link = [\"tcpin:5760\", \"udpin:14550\"].
  Environment variables do, too: LMPC_SITL_ and the name in capitals, with `_` for
  `-`, and `;` between several values: LMPC_SITL_LINK='tcpin:5760;udpin:14550'.
  Flags override the environment, the environment overrides the file. An unknown
  name is an error in all three.

Output:
  On a terminal, the last line shows simulation time, its speed relative to real
  time, state, position relative to home, battery and active clients, as far as
  the width allows. It is absent if the standard output or error stream is not a
  terminal, or TERM is `dumb`. The log goes to the standard error stream; each
  line has the wall-clock time and the simulation time. NO_COLOR turns colours
  off. The digest at the end is a fingerprint of the flight: equal digests mean
  identical flights.

Files:
  A file error never ends a flight. A file that cannot be written is reported,
  tried again every second, and named at the end with exit code 4. A file that
  another process is writing is refused at the start; the lock is FILE.lock.

Exit codes:
  0  ended as asked
  1  the simulation of a vehicle failed; the others flew to the end
  2  a flag, value or environment variable is wrong
  3  a port or device cannot be used
  4  a file cannot be used or is incomplete
  5  a replayed flight differs from the recorded one
  6  an FMU crashed, hung or reported an error";

/// The command line. The names of environment variables follow from those of the flags, and are not listed.
pub fn command() -> Command {
    Arguments::command().mut_args(|argument| argument.hide_env(true))
}

#[cfg(test)]
mod tests {
    use super::{AFTER_LONG, command};

    fn short(columns: usize) -> String {
        command().term_width(columns).render_help().to_string()
    }

    fn long(columns: usize) -> String {
        command().term_width(columns).render_long_help().to_string()
    }

    #[test]
    fn the_short_help_fits_on_a_screen() {
        let text = short(80);
        assert!(text.lines().count() <= 50, "{} lines:\n{text}", text.lines().count());
        for flag in
            ["--link", "--vehicles", "--speed", "--wind", "--mission", "--record", "--config", "--help"]
        {
            assert!(text.contains(flag), "{flag}");
        }
    }

    #[test]
    fn no_line_is_wider_than_the_terminal() {
        assert!(AFTER_LONG.lines().all(|line| line.chars().count() < 84), "written for 80 columns");
        for columns in [80, 100, 120] {
            for text in [short(columns), long(columns)] {
                let widest = text.lines().map(|line| line.chars().count()).max();
                assert!(widest <= Some(columns), "{columns}: {widest:?}\n{text}");
            }
        }
    }

    #[test]
    fn each_flag_has_a_group_a_short_and_a_plain_description() {
        let text = long(80);
        for argument in command().get_arguments() {
            let Some(name) = argument.get_long() else { continue };
            assert!(text.contains(&format!("--{name}")), "{name} is not in the long help");
            let help = argument.get_help().map(ToString::to_string).unwrap_or_default();
            assert!((8..=60).contains(&help.chars().count()), "{name}: `{help}`");
            assert!(!help.ends_with('.'), "{name}: `{help}`");
            let general = ["config", "ready-file", "log", "help", "version"].contains(&name);
            assert_eq!(argument.get_help_heading().is_none(), general, "{name}");
        }
    }

    #[test]
    fn each_setting_has_the_environment_variable_of_its_name() {
        for argument in command().get_arguments() {
            let Some(name) = argument.get_long().filter(|name| !["help", "version"].contains(name)) else {
                continue;
            };
            let expected = format!("LMPC_SITL_{}", name.replace('-', "_").to_uppercase());
            assert_eq!(argument.get_env(), Some(expected.as_ref()), "{name}");
        }
    }

    #[test]
    fn every_group_has_an_example_that_is_accepted() {
        let examples = AFTER_LONG.split("Examples:\n").nth(1).and_then(|text| text.split("\n\n").next());
        let lines: Vec<&str> = examples.expect("examples").lines().collect();
        assert!(lines.len() >= 9);
        for line in lines {
            let words = line.split_whitespace().skip_while(|word| *word != "lmpc-sitl");
            assert!(command().try_get_matches_from(words).is_ok(), "{line}");
        }
    }
}
