//! The high latency protocol: the fields of its message, and when it is sent.

use autopilot::Autopilot;
use autopilot::codec::{CommandAck, Frame, Message, Version, command_long};
use autopilot::envelope::{Destination, LinkProfile, Origin, PeerId};
use mavlink::dialects::ardupilotmega::{
    HIGH_LATENCY2_DATA, HlFailureFlag, MavAutopilot, MavCmd, MavMessage, MavResult, MavType,
};
use mavlink::{Message as _, MessageData};
use vehicle::identity::Identity;
use vehicle::parameters::Speed;
use vehicle::world::WindSettings;
use vehicle::{TICK_US, VehicleSettings};

const SECOND: u64 = 1_000_000 / TICK_US;
/// The link that the commands come by, and another one.
const LINK: usize = 1;

/// A vehicle with two links, and what it has said.
struct Bench {
    autopilot: Autopilot,
    heard: Vec<(Destination, Message)>,
    sequence: u8,
}

impl Bench {
    fn new(identity: Identity) -> Self {
        Self::in_wind(identity, WindSettings::default())
    }

    fn in_wind(identity: Identity, wind: WindSettings) -> Self {
        let mut settings = VehicleSettings { wind, ..VehicleSettings::new(identity) };
        settings.conduct.failure_injection = true;
        let links = [LinkProfile::Ground, LinkProfile::Onboard];
        let autopilot = Autopilot::new(&settings, 1, Speed::Factor(1.0), &links, 0).expect("valid settings");
        Self { autopilot, heard: Vec::new(), sequence: 0 }
    }

    /// Sends a command and returns the result of its answer.
    fn command(&mut self, command: MavCmd, parameters: [f32; 7]) -> u8 {
        let message = MavMessage::COMMAND_LONG(command_long((1, 1), command, parameters));
        self.sequence = self.sequence.wrapping_add(1);
        let frame = Frame::encode(&message.into(), Version::Two, self.sequence, (255, 190)).expect("a frame");
        let origin = Origin { peer: PeerId { link: LINK, number: 1 }, system: 255, component: 190 };
        self.listen();
        let before = self.heard.len();
        self.autopilot.receive(&origin, &frame);
        self.listen();
        let answer = self.heard[before..].iter().find_map(|(_, message)| match message {
            Message::CommandAck(CommandAck { command: number, result, .. }) if *number == command as u16 => {
                Some(*result)
            }
            _ => None,
        });
        answer.expect("every command is answered")
    }

    fn control(&mut self, value: f32) -> u8 {
        self.command(MavCmd::MAV_CMD_CONTROL_HIGH_LATENCY, [value, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    }

    fn listen(&mut self) {
        let outgoing = self.autopilot.take_outgoing();
        self.heard.extend(outgoing.map(|outgoing| (outgoing.to, outgoing.message)));
    }

    fn fly(&mut self, ticks: u64) {
        for _ in 0..ticks {
            self.autopilot.tick().expect("a tick");
            self.listen();
        }
    }

    /// All that were sent since the last call, with where to.
    fn messages(&mut self) -> Vec<(Destination, HIGH_LATENCY2_DATA)> {
        let heard = std::mem::take(&mut self.heard).into_iter();
        heard
            .filter_map(|(to, message)| match message {
                Message::Typed(MavMessage::HIGH_LATENCY2(data)) => Some((to, data)),
                _ => None,
            })
            .collect()
    }

    /// Asks for one.
    fn request(&mut self) -> HIGH_LATENCY2_DATA {
        let id = HIGH_LATENCY2_DATA::ID as f32;
        self.messages();
        let result = self.command(MavCmd::MAV_CMD_REQUEST_MESSAGE, [id, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(result, MavResult::MAV_RESULT_ACCEPTED as u8);
        let messages = self.messages();
        assert_eq!(messages.len(), 1);
        messages[0].1.clone()
    }

    fn take_off(&mut self) {
        let nan = f32::NAN;
        let up = [0.0, 0.0, 0.0, nan, nan, nan, 508.0];
        self.command(MavCmd::MAV_CMD_NAV_TAKEOFF, up);
        self.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert!(self.autopilot.vehicle().is_armed());
    }
}

/// Every field against the vehicle's state in SI units, in a climb.
#[test]
fn its_fields_are_the_state_of_the_vehicle() {
    let mut bench = Bench::new(Identity::Px4);
    bench.take_off();
    bench.fly(4 * SECOND);
    let told = bench.request();
    let vehicle = bench.autopilot.vehicle();
    let outputs = vehicle.outputs();
    let within =
        |told: f64, actual: f64, step: f64| assert!((told - actual).abs() <= step, "{told} {actual}");
    let place = vehicle.frame().to_geodetic(&outputs.position_m);
    assert!(outputs.velocity_m_s.z < -0.5, "it climbs");
    assert_eq!(u64::from(told.timestamp), outputs.time_us / 1000);
    within(f64::from(told.latitude) / 1e7, place.latitude_deg, 1e-7);
    within(f64::from(told.longitude) / 1e7, place.longitude_deg, 1e-7);
    within(f64::from(told.altitude), 488.0 - outputs.position_m.z, 0.5);
    within(f64::from(told.target_altitude), 488.0 - outputs.setpoint.position_m.z, 0.5);
    within(f64::from(told.heading) * 2.0, outputs.attitude_rad.z.to_degrees().rem_euclid(360.0), 2.0);
    within(f64::from(told.groundspeed) / 5.0, outputs.velocity_m_s.xy().norm(), 0.1);
    within(f64::from(told.airspeed) / 5.0, outputs.velocity_m_s.norm(), 0.1);
    within(f64::from(told.climb_rate) / 10.0, -outputs.velocity_m_s.z, 0.05);
    within(f64::from(told.battery), 100.0 * vehicle.battery_remaining(), 1.0);
    // 15 °C at sea level, 6.5 °C less with each kilometre.
    within(f64::from(told.temperature_air), 15.0 - 0.0065 * f64::from(told.altitude), 0.6);
    assert!((20..=100).contains(&told.throttle), "{}", told.throttle);
    assert_eq!((told.windspeed, told.target_distance, told.wp_num), (0, 0, u16::MAX));
    assert_eq!(
        (told.mavtype, told.autopilot),
        (MavType::MAV_TYPE_QUADROTOR, MavAutopilot::MAV_AUTOPILOT_PX4)
    );
    assert_eq!(told.failure_flags, HlFailureFlag::empty());
    let custom_mode = vehicle.identity().custom_mode(vehicle.mode());
    assert_eq!(u32::from(told.custom_mode) << 16, custom_mode, "PX4's clients shift it back");
}

/// What only a wind and a goal far away show.
#[test]
fn wind_and_distance_are_told() {
    let wind = WindSettings { speed_m_s: 4.0, from_rad: 2.0, ..WindSettings::default() };
    let mut bench = Bench::in_wind(Identity::Px4, wind);
    bench.take_off();
    bench.fly(20 * SECOND);
    // 500 m to the north.
    let goal = [-1.0, 0.0, 0.0, f32::NAN, 47.402_24, 8.545_594, 508.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_REPOSITION, goal), MavResult::MAV_RESULT_ACCEPTED as u8);
    bench.fly(20 * SECOND);
    let told = bench.request();
    let vehicle = bench.autopilot.vehicle();
    let (outputs, wind_m_s) = (vehicle.outputs(), vehicle.wind_m_s());
    assert!(wind_m_s.xy().norm() > 2.0, "{wind_m_s}");
    let within =
        |told: f64, actual: f64, step: f64| assert!((told - actual).abs() <= step, "{told} {actual}");
    within(f64::from(told.windspeed) / 5.0, wind_m_s.xy().norm(), 0.1);
    let blows_to_deg = wind_m_s.y.atan2(wind_m_s.x).to_degrees().rem_euclid(360.0);
    within(f64::from(told.wind_heading) * 2.0, blows_to_deg, 2.0);
    within(f64::from(told.airspeed) / 5.0, (outputs.velocity_m_s - wind_m_s).norm(), 0.1);
    within(f64::from(told.groundspeed) / 5.0, outputs.velocity_m_s.xy().norm(), 0.1);
    let ahead_m = (outputs.setpoint.position_m - outputs.position_m).xy().norm();
    within(f64::from(told.target_distance) * 10.0, ahead_m, 5.0);
}

/// ArduPilot's mode fits; whether it is armed stands in the first custom field.
#[test]
fn an_ardupilot_tells_its_small_mode_and_its_flags() {
    const SAFETY_ARMED: u8 = 128;
    let mut bench = Bench::new(Identity::ArduPilot);
    let told = bench.request();
    let vehicle = bench.autopilot.vehicle();
    assert_eq!(u32::from(told.custom_mode), vehicle.identity().custom_mode(vehicle.mode()));
    assert_eq!(told.custom0 as u8 & SAFETY_ARMED, 0);
    bench.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    assert_ne!(bench.request().custom0 as u8 & SAFETY_ARMED, 0);
}

/// Once on, it comes at once and then every five seconds, on the link that has asked.
#[test]
fn it_is_sent_at_a_fifth_of_a_hertz_while_it_is_on() {
    let mut bench = Bench::new(Identity::Px4);
    bench.fly(6 * SECOND);
    assert!(bench.messages().is_empty(), "nobody has asked");
    for _ in 0..2 {
        assert_eq!(bench.control(1.0), MavResult::MAV_RESULT_ACCEPTED as u8);
        bench.fly(SECOND);
    }
    bench.fly(19 * SECOND);
    let messages = bench.messages();
    assert!(messages.iter().all(|(to, _)| *to == Destination::Link(LINK)));
    let times: Vec<u32> = messages.iter().map(|(_, data)| data.timestamp).collect();
    assert_eq!(times.len(), 5, "{times:?}");
    assert!(times.windows(2).all(|pair| pair[1] - pair[0] == 5000), "{times:?}");
    assert_eq!(bench.control(0.0), MavResult::MAV_RESULT_ACCEPTED as u8);
    bench.fly(6 * SECOND);
    assert!(bench.messages().is_empty());
    assert_eq!(bench.control(0.0), MavResult::MAV_RESULT_ACCEPTED as u8, "off already");
}

#[test]
fn what_neither_enables_nor_disables_is_refused() {
    let mut bench = Bench::new(Identity::Px4);
    for value in [0.5, 2.0, -1.0, f32::NAN] {
        assert_eq!(bench.control(value), MavResult::MAV_RESULT_DENIED as u8, "{value}");
    }
    bench.fly(6 * SECOND);
    assert!(bench.messages().is_empty());
}

/// The climb is over when the next message comes, and is in it all the same.
#[test]
fn it_tells_the_fastest_climb_since_the_last_one() {
    let mut bench = Bench::new(Identity::Px4);
    bench.control(1.0);
    bench.fly(1);
    bench.take_off();
    let mut fastest_m_s = 0.0_f64;
    for _ in 0..20 * SECOND {
        bench.fly(1);
        fastest_m_s = fastest_m_s.max(-bench.autopilot.vehicle().outputs().velocity_m_s.z);
    }
    let messages = bench.messages();
    let told = messages.iter().map(|(_, data)| data.climb_rate).max();
    assert_eq!(told, Some((10.0 * fastest_m_s).round() as i8));
    assert!(bench.autopilot.vehicle().outputs().velocity_m_s.z.abs() < 0.1, "it hovers");
}

/// A receiver that has failed is flagged, and its accuracy unknown.
#[test]
fn failures_are_flagged() {
    const GPS_OFF: [f32; 7] = [4.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let mut bench = Bench::new(Identity::Px4);
    bench.fly(2 * SECOND);
    assert_ne!(bench.request().eph, u8::MAX);
    bench.command(MavCmd::MAV_CMD_INJECT_FAILURE, GPS_OFF);
    bench.fly(2 * SECOND);
    let told = bench.request();
    assert!(told.failure_flags.contains(HlFailureFlag::HL_FAILURE_FLAG_GPS), "{:?}", told.failure_flags);
    assert_eq!(told.eph, u8::MAX);
    assert_eq!(MavMessage::HIGH_LATENCY2(told).message_id(), HIGH_LATENCY2_DATA::ID);
}
