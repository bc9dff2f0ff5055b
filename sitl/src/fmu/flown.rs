//! An FMU in flight: demands go in as values of its variables, its motion comes out.

use std::time::{Duration, Instant};

use importer::{Guarded, GuestError, Said, Setup, Status};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use quadrotor::{PositionReference, RigidBody, Wrench};
use vehicle::foreign::{Demand, ForeignDescription, ForeignModel, ForeignMotion};
use vehicle::{FlightError, VehicleSettings};

use super::choice::{FmuChoice, HOST_ARGUMENT};
use super::mapping::Mapping;
use super::signals::{INPUTS, OUTPUTS, input, output};
use crate::failure::Failure;

/// Longest time of loading and initializing: interpreters and tools start in it.
const LONGEST_START: Duration = Duration::from_secs(60);
/// A start this near to the vehicle's is the same, m and rad.
const NEAR_M: f64 = 0.01;
const NEAR_RAD: f64 = 0.01;
/// A vehicle that has sunk so far with its rotors at rest falls, m: feet give way by less.
const FALLEN_M: f64 = 0.2;
/// Lines of the FMU's log that may be shown at once, and per second after that.
const LINES: f64 = 50.0;
const LINES_PER_S: f64 = 5.0;

/// Values of all signals: groups, and their parts.
type Values = [[f64; 4]; 10];

/// An FMU in a process of its own.
#[derive(Debug)]
pub struct FlownFmu {
    guarded: Guarded,
    mapping: Mapping,
    description: ForeignDescription,
    log: Log,
    support: Support,
    failed: bool,
}

impl FlownFmu {
    /// Starts an FMU where a vehicle stands. `mount_rad` is how far the nose of its autopilot is turned from its own.
    ///
    /// # Errors
    /// [`Failure`] of the file, the mapping, the FMU's initialization, or of a start elsewhere.
    pub fn start(
        choice: &FmuChoice,
        name: &str,
        settings: &VehicleSettings,
        mount_rad: f64,
    ) -> Result<Self, Failure> {
        let configuration = settings.flown_configuration();
        let (fmu, mapping) = choice.open(&configuration)?;
        let place_m = Vector3::from(configuration.initial.position_m);
        let ground_z_m = settings.surroundings.terrain.z_below_m(&place_m);
        let demand = resting(place_m, settings.heading_rad, ground_z_m);
        let inputs = values_of(&mapping, &demand);
        let of = |channel: &super::mapping::Channel| {
            (channel.variable.1, channel.conversion.theirs(value_at(&inputs, channel.group, channel.part)))
        };
        let setup = Setup {
            name: name.to_owned(),
            host: (choice.host.clone(), vec![HOST_ARGUMENT.to_owned()]),
            preload: mapping.preload.clone(),
            debug: tracing::enabled!(tracing::Level::DEBUG),
            values: mapping.values.iter().map(|(_, reference, value)| (*reference, value.clone())).collect(),
            reals: mapping.inputs.iter().map(of).collect(),
            booleans: mapping.armed.iter().map(|(_, reference)| (*reference, false)).collect(),
            outputs: mapping.outputs.iter().map(|channel| channel.variable.1).collect(),
            longest_start: LONGEST_START,
            longest_step: mapping.longest_step,
        };
        let (mut guarded, shown) =
            Guarded::start(fmu, &setup).map_err(|error| Failure::Flight(failed(&error, 0)))?;
        let mut log = Log::new(guarded.name());
        log.take(guarded.take_said());
        let start = motion_of(&mapping, &shown, 0)?;
        check_start(&start, place_m, settings.heading_rad, mount_rad)
            .map_err(|reason| Failure::Content { path: choice.path.clone(), reason })?;
        let name = format!("the FMU {}", mapping.model_name);
        let description = ForeignDescription { name, role: mapping.role, start };
        Ok(Self { guarded, mapping, description, log, support: Support::default(), failed: false })
    }
}

impl ForeignModel for FlownFmu {
    fn description(&self) -> &ForeignDescription {
        &self.description
    }

    fn advance(&mut self, demand: &Demand) -> Result<ForeignMotion, FlightError> {
        let values = values_of(&self.mapping, demand);
        let theirs = self
            .mapping
            .inputs
            .iter()
            .map(|channel| channel.conversion.theirs(value_at(&values, channel.group, channel.part)));
        let reals: Vec<f64> = theirs.collect();
        let booleans: &[bool] = if self.mapping.armed.is_some() { &[demand.armed] } else { &[] };
        let (time_s, step_s) = (demand.time_us as f64 / 1e6, demand.duration_us as f64 / 1e6);
        let shown = self.guarded.step(time_s, step_s, &reals, booleans);
        self.log.take(self.guarded.take_said());
        let motion = match shown {
            Ok(shown) => motion_of(&self.mapping, &shown, demand.time_us),
            Err(error) => Err(failed(&error, demand.time_us)),
        };
        self.failed = motion.is_err();
        if let Ok(motion) = &motion
            && let Some(warning) = self.support.look(demand.armed, &self.description, motion)
        {
            tracing::warn!("{warning}");
        }
        motion
    }
}

impl Drop for FlownFmu {
    fn drop(&mut self) {
        if self.failed {
            return;
        }
        if let Err(error) = self.guarded.finish() {
            tracing::warn!("at the end: {error}");
        }
        self.log.take(self.guarded.take_said());
    }
}

/// The end of a flight by its FMU.
fn failed(error: &GuestError, time_us: u64) -> FlightError {
    let mut reason = error.to_string();
    if reason.contains("undefined symbol") {
        // An FMU of an interpreter counts on the program that loads it being one.
        reason.push_str(
            "; name the library that has it, such as libpython3.12.so.1.0, in `preload` of a --map",
        );
    }
    if reason.contains("cannot open shared object file") {
        reason.push_str(
            "; install what its library needs, or name it with its whole path in `preload` of a --map",
        );
    }
    FlightError::Foreign { time_us, reason }
}

/// What an FMU is told before the flight.
fn resting(place_m: Vector3<f64>, heading_rad: f64, ground_z_m: f64) -> Demand {
    Demand {
        time_us: 0,
        duration_us: 0,
        reference: PositionReference::goal(place_m.into(), heading_rad),
        armed: false,
        rotor_command_rad_s: [0.0; 4],
        wrench: Wrench::default(),
        wind_m_s: Vector3::zeros(),
        ground_z_m,
    }
}

fn value_at(values: &Values, group: usize, part: usize) -> f64 {
    values.get(group).and_then(|parts| parts.get(part)).copied().unwrap_or(0.0)
}

/// A demand in the axes of the FMU, in SI units.
fn values_of(mapping: &Mapping, demand: &Demand) -> Values {
    let axes = &mapping.axes;
    let reference = &demand.reference;
    let of = |vector: Vector3<f64>| [vector.x, vector.y, vector.z, 0.0];
    let alone = |value: f64| [value, 0.0, 0.0, 0.0];
    let mut values = Values::default();
    values[input::REFERENCE_POSITION] = of(axes.their_place_m(reference.position_m));
    values[input::REFERENCE_VELOCITY] = of(axes.in_their_world(reference.velocity_m_s));
    values[input::REFERENCE_ACCELERATION] = of(axes.in_their_world(reference.acceleration_m_s2));
    values[input::REFERENCE_YAW] = alone(axes.their_yaw_rad(reference.yaw_rad));
    values[input::REFERENCE_YAW_RATE] = alone(axes.their_yaw_rate(reference.yaw_rate_rad_s));
    values[input::ROTOR_COMMAND] = demand.rotor_command_rad_s;
    values[input::THRUST] = alone(demand.wrench.thrust_n);
    values[input::TORQUE] = of(axes.in_their_body(demand.wrench.torque_n_m));
    values[input::WIND] = of(axes.in_their_world(demand.wind_m_s));
    values[input::GROUND] = alone(axes.their_place_m(Vector3::z() * demand.ground_z_m).z);
    values
}

/// The motion that an FMU shows, in our axes.
fn motion_of(mapping: &Mapping, shown: &[f64], time_us: u64) -> Result<ForeignMotion, FlightError> {
    let name = &mapping.model_name;
    let wrong = |reason: String| FlightError::Foreign { time_us, reason };
    let mut values = Values::default();
    for (group, part, value) in &mapping.constants {
        if let Some(place) = values.get_mut(*group).and_then(|parts| parts.get_mut(*part)) {
            *place = *value;
        }
    }
    for (channel, theirs) in mapping.outputs.iter().zip(shown) {
        if !theirs.is_finite() {
            let signal =
                OUTPUTS.get(channel.group).map(|group| group.signal(channel.part)).unwrap_or_default();
            let variable = &channel.variable.0;
            return Err(wrong(format!(
                "the FMU {name} shows {theirs} for {signal} (its variable `{variable}`)"
            )));
        }
        if let Some(place) = values.get_mut(channel.group).and_then(|parts| parts.get_mut(channel.part)) {
            *place = channel.conversion.ours(*theirs);
        }
    }
    let axes = &mapping.axes;
    let vector = |group: usize| Vector3::from_fn(|part, _| value_at(&values, group, part));
    let shows = |group: usize| mapping.shows(group);
    let attitude = if shows(output::QUATERNION) {
        let [w, x, y, z] = values[output::QUATERNION];
        let quaternion = Quaternion::new(w, x, y, z);
        if (quaternion.norm() - 1.0).abs() > 0.01 {
            return Err(wrong(format!(
                "the FMU {name} shows an attitude that is no unit quaternion: {w}, {x}, {y}, {z}"
            )));
        }
        quaternion
    } else {
        let [phi, theta, psi, _] = values[output::ATTITUDE];
        UnitQuaternion::from_euler_angles(phi, theta, psi).into_inner()
    };
    let attitude = axes.attitude(attitude);
    let velocity_m_s = if shows(output::VELOCITY) {
        axes.in_world(vector(output::VELOCITY))
    } else {
        UnitQuaternion::new_normalize(attitude) * axes.in_body(vector(output::BODY_VELOCITY))
    };
    Ok(ForeignMotion {
        body: RigidBody {
            position_m: axes.place_m(vector(output::POSITION)),
            velocity_m_s,
            attitude,
            body_rate_rad_s: axes.in_body(vector(output::BODY_RATE)),
        },
        acceleration_m_s2: shows(output::ACCELERATION).then(|| axes.in_world(vector(output::ACCELERATION))),
        rotor_speed_rad_s: shows(output::ROTOR_SPEED).then_some(values[output::ROTOR_SPEED]),
        thrust_n: shows(output::ROTOR_THRUST).then(|| value_at(&values, output::ROTOR_THRUST, 0)),
    })
}

/// Refuses an FMU that does not start where the vehicle stands.
fn check_start(
    start: &ForeignMotion,
    place_m: Vector3<f64>,
    heading_rad: f64,
    mount_rad: f64,
) -> Result<(), String> {
    let shown_m = start.body.position_m;
    let (_, _, psi) = start.body.rotation().euler_angles();
    let turn = vehicle::wrapped(psi - heading_rad);
    if (shown_m - place_m).norm() <= NEAR_M && turn.abs() <= NEAR_RAD {
        return Ok(());
    }
    let told = |place: &Vector3<f64>, yaw_rad: f64| {
        format!(
            "{:.3}, {:.3}, {:.3} m (north, east, down), heading {:.1}°",
            place.x,
            place.y,
            place.z,
            vehicle::wrapped(yaw_rad).to_degrees()
        )
    };
    let mount = if mount_rad.abs() < 1e-9 {
        String::new()
    } else {
        // The heading of --home is the autopilot's: without a word ours looks like a mistake of the program.
        format!(
            " (the autopilot's nose has the heading {:.1}° of --home, and --hil-mount turns it by {:.1}° on the airframe)",
            vehicle::wrapped(heading_rad + mount_rad).to_degrees(),
            mount_rad.to_degrees()
        )
    };
    Err(format!(
        "the FMU starts at {}, the vehicle at {}{mount}; map initial.position.x to .z and initial.attitude.psi to its parameters, set \
         them in [parameters], or say with `origin` of [frame] where the vehicle's start is in its world",
        told(&shown_m, psi),
        told(&place_m, heading_rad)
    ))
}

/// Whether something carries the vehicle while its rotors rest.
#[derive(Debug, Default)]
struct Support {
    /// Nothing more is to be looked for: its rotors have turned, or the warning has been given.
    settled: bool,
}

impl Support {
    /// A warning, once, of a vehicle that falls before its rotors have ever turned.
    fn look(
        &mut self,
        armed: bool,
        description: &ForeignDescription,
        motion: &ForeignMotion,
    ) -> Option<String> {
        let fallen_m = motion.body.position_m.z - description.start.body.position_m.z;
        self.settled |= armed;
        if self.settled || fallen_m < FALLEN_M {
            return None;
        }
        self.settled = true;
        Some(format!(
            "{} falls: nothing carries it while its rotors rest, and it is {fallen_m:.1} m below its start; give it ground at the \
             height of its start, such as a parameter of its own in [parameters] of a --map",
            description.name
        ))
    }
}

/// The FMU's log, as far as there is room in ours.
#[derive(Debug)]
struct Log {
    name: String,
    room: f64,
    since: Instant,
    hidden: usize,
}

impl Log {
    fn new(name: &str) -> Self {
        Self { name: name.to_owned(), room: LINES, since: Instant::now(), hidden: 0 }
    }

    fn take(&mut self, said: Vec<Said>) {
        if said.is_empty() && self.hidden == 0 {
            return;
        }
        let now = Instant::now();
        let waited_s = now.saturating_duration_since(self.since).as_secs_f64();
        (self.room, self.since) = ((self.room + waited_s * LINES_PER_S).min(LINES), now);
        if self.hidden > 0 && self.room >= 2.0 {
            self.room -= 1.0;
            tracing::warn!(
                "FMU {}: {} more lines are not shown",
                self.name,
                std::mem::take(&mut self.hidden)
            );
        }
        for said in said {
            if let Said::Lost(count) = said {
                self.hidden += count;
            } else if self.room < 1.0 {
                self.hidden += 1;
            } else {
                self.room -= 1.0;
                self.show(&said);
            }
        }
    }

    fn show(&self, said: &Said) {
        let name = &self.name;
        match said {
            Said::Printed(line) => tracing::info!("FMU {name}: {line}"),
            Said::Message(message) => {
                let text = message.text.lines().collect::<Vec<_>>().join(" ");
                match message.status {
                    Status::Ok => tracing::info!("FMU {name}: {text}"),
                    Status::Warning => tracing::warn!("FMU {name}: {text}"),
                    _ => tracing::error!("FMU {name}: {text}"),
                }
            }
            Said::Lost(_) => {}
        }
    }
}

/// One place for each group.
const _: () = assert!(INPUTS.len() <= 10 && OUTPUTS.len() <= 10);
