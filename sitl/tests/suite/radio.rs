//! A pilot's radio in simulation time: the modes that are flown with sticks, switches, gestures and the loss of the radio. The figures
//! are those of ArduCopter and PX4: their parameters, their switches' pulses and their delays.

use crate::common::{Bench, settings};
use mavlink::dialects::ardupilotmega::{
    MANUAL_CONTROL_DATA, MavCmd, MavMessage, MavSysStatusSensor, PARAM_SET_DATA, RC_CHANNELS_OVERRIDE_DATA,
};
use mavlink::types::CharArray;
use vehicle::identity::Identity;
use vehicle::radio::{CHANNELS, RadioFailure, RadioLossAction};
use vehicle::{Mode, VehicleSettings};

const ACCEPTED: u8 = 0;
const TEMPORARILY_REJECTED: u8 = 1;
const FAILED: u8 = 4;
const UNSUPPORTED: u8 = 3;
const ARM: [f32; 7] = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];

/// A radio as ArduPilot's tests have it: throttle low, the mode switch at 1800, everything else centred or low.
struct Radio([u16; CHANNELS]);

impl Radio {
    fn new() -> Self {
        let mut pulses = [1000; CHANNELS];
        pulses[..5].copy_from_slice(&[1500, 1500, 1000, 1500, 1800]);
        Self(pulses)
    }

    fn set(&mut self, bench: &mut Bench, channel: usize, pulse: u16) {
        self.0[channel - 1] = pulse;
        bench.autopilot.receive_radio(self.0);
    }
}

/// A vehicle and its radio, in the mode of the mode switch.
fn with_radio(settings: &VehicleSettings) -> (Bench, Radio) {
    let (mut bench, radio) = (Bench::of(settings), Radio::new());
    bench.autopilot.receive_radio(radio.0);
    bench.fly(0.3);
    (bench, radio)
}

/// Flies up with the throttle and holds there in a mode.
fn flown_up(settings: &VehicleSettings, mode: Mode) -> (Bench, Radio) {
    let (mut bench, mut radio) = with_radio(settings);
    assert_eq!(bench.set_mode(mode), ACCEPTED, "{:?}", bench.texts());
    bench.arm();
    radio.set(&mut bench, 3, 1700);
    bench.fly_until("10 m", 30.0, |bench| bench.position()[2] < -10.0);
    radio.set(&mut bench, 3, 1500);
    bench.fly(2.0);
    (bench, radio)
}

fn fail(bench: &mut Bench, failure: RadioFailure) {
    set_parameter(bench, "SIM_RC_FAIL", f32::from(failure as u8));
}

fn set_parameter(bench: &mut Bench, name: &str, value: f32) {
    bench.heard.clear();
    bench.send(MavMessage::PARAM_SET(PARAM_SET_DATA {
        target_system: 1,
        target_component: 1,
        param_id: CharArray::from(name),
        param_value: value,
        ..PARAM_SET_DATA::default()
    }));
    let told = bench.parameters();
    assert!(told.iter().any(|told| told.param_value == value), "{name}: {told:?}");
}

fn said(bench: &Bench, text: &str) -> bool {
    bench.texts().iter().any(|said| said.contains(text))
}

fn roll_deg(bench: &Bench) -> f64 {
    bench.autopilot.vehicle().outputs().attitude_rad.x.to_degrees()
}

fn is_armed(bench: &Bench) -> bool {
    bench.autopilot.vehicle().is_armed()
}

#[test]
fn the_mode_switch_decides_at_first_and_when_it_is_moved() {
    let (mut bench, mut radio) = with_radio(&settings(Identity::ArduPilot));
    // FLTMODE6 of ArduPilot's simulation.
    assert_eq!(bench.mode(), Mode::Stabilize);
    assert_eq!(bench.set_mode(Mode::Offboard), ACCEPTED);
    bench.fly(1.0);
    assert_eq!(bench.mode(), Mode::Offboard, "the switch has not moved");
    for (pulse, mode) in [(1685, Mode::Position), (1800, Mode::Stabilize), (1425, Mode::Return)] {
        radio.set(&mut bench, 5, pulse);
        bench.fly(0.1);
        assert_ne!(bench.mode(), mode, "before it is steady");
        bench.fly(0.2);
        assert_eq!(bench.mode(), mode, "{:?}", bench.texts());
    }
}

#[test]
fn stabilize_is_flown_with_throttle_and_lean_and_ends_with_the_rudder() {
    let (mut bench, mut radio) = flown_up(&settings(Identity::ArduPilot), Mode::Stabilize);
    // The centred throttle is the hovering thrust.
    let climb = -bench.velocity()[2];
    bench.fly(1.0);
    assert!((-bench.velocity()[2] - climb).abs() < 1.0, "{climb} {:?}", bench.velocity());
    // Half a stick is half of ANGLE_MAX.
    radio.set(&mut bench, 1, 1760);
    bench.fly(1.0);
    assert!((roll_deg(&bench) - 15.0).abs() < 1.5, "{}", roll_deg(&bench));
    assert!(bench.velocity()[1] > 1.0, "{:?}", bench.velocity());
    radio.set(&mut bench, 1, 1500);
    bench.fly(1.0);
    assert!(roll_deg(&bench).abs() < 1.0, "{}", roll_deg(&bench));
    // In the air the rudder stops nothing while the throttle is up.
    radio.set(&mut bench, 4, 1000);
    bench.fly(3.0);
    assert!(is_armed(&bench));
    radio.set(&mut bench, 4, 1500);
    assert_eq!(bench.set_mode(Mode::Land), ACCEPTED);
    radio.set(&mut bench, 3, 1000);
    bench.fly_until("landed", 120.0, |bench| !is_armed(bench));
}

#[test]
fn altitude_is_held_and_commanded_and_the_ground_is_found() {
    let (mut bench, mut radio) = flown_up(&settings(Identity::ArduPilot), Mode::Altitude);
    bench.fly(2.0);
    let held = bench.position()[2];
    radio.set(&mut bench, 2, 1300);
    bench.fly(3.0);
    radio.set(&mut bench, 2, 1500);
    bench.fly(3.0);
    assert!((bench.position()[2] - held).abs() < 0.3, "{held} {:?}", bench.position());
    assert!(bench.position()[0] > 3.0, "it has drifted on: {:?}", bench.position());
    // Within the dead zone of 100 thousandths nothing changes.
    radio.set(&mut bench, 3, 1560);
    bench.fly(3.0);
    assert!((bench.position()[2] - held).abs() < 0.3, "{held} {:?}", bench.position());
    // PILOT_SPEED_DN = 0: that of PILOT_SPEED_UP.
    radio.set(&mut bench, 3, 1000);
    bench.fly(3.0);
    assert!((bench.velocity()[2] - 2.5).abs() < 0.15, "{:?}", bench.velocity());
    bench.fly_until("landed", 30.0, |bench| {
        bench.autopilot.vehicle().landed_state() == vehicle::LandedState::OnGround
    });
    bench.fly(0.5);
    assert!(is_armed(&bench), "{:?}", bench.texts());
    radio.set(&mut bench, 4, 1000);
    bench.fly(1.5);
    assert!(is_armed(&bench));
    bench.fly(1.0);
    assert!(!is_armed(&bench), "{:?}", bench.texts());
}

#[test]
fn loiter_and_poshold_take_off_with_the_throttle_and_hold_the_place() {
    for mode in [Mode::Position, Mode::PositionHold] {
        let (mut bench, mut radio) = flown_up(&settings(Identity::ArduPilot), mode);
        let start = bench.position();
        radio.set(&mut bench, 2, 1200);
        bench.fly(2.0);
        assert!(bench.velocity()[0] > 1.0, "{mode:?}: {:?}", bench.velocity());
        radio.set(&mut bench, 2, 1500);
        bench.fly(6.0);
        let stopped = bench.position();
        assert!(bench.velocity().iter().all(|axis| axis.abs() < 0.1), "{mode:?}: {:?}", bench.velocity());
        bench.fly(3.0);
        let there = bench.position();
        assert!(
            (0..3).all(|axis| (there[axis] - stopped[axis]).abs() < 0.2),
            "{mode:?}: {stopped:?} {there:?}"
        );
        assert!((there[2] - start[2]).abs() < 0.5, "{mode:?}: {start:?} {there:?}");
        assert_eq!(bench.mode(), mode);
    }
}

#[test]
fn acro_commands_rates_and_the_trainer_levels() {
    let mut start = settings(Identity::ArduPilot);
    start.conduct.sticks.roll_rad_s = 1.0;
    start.conduct.sticks.trainer = vehicle::Trainer::Off;
    let (mut bench, mut radio) = flown_up(&start, Mode::Altitude);
    assert_eq!(bench.set_mode(Mode::Acro), ACCEPTED);
    radio.set(&mut bench, 1, 2000);
    bench.fly(0.6);
    let rate = bench.autopilot.vehicle().outputs().body_rate_rad_s.x;
    assert!((rate - 1.0).abs() < 0.2, "{rate}");
    radio.set(&mut bench, 1, 1500);
    bench.fly(0.4);
    let kept = roll_deg(&bench);
    assert!(kept > 20.0, "{kept}");
    bench.fly(0.4);
    assert!((roll_deg(&bench) - kept).abs() < 5.0, "no rate is commanded: {kept} {}", roll_deg(&bench));
    set_parameter(&mut bench, "ACRO_TRAINER", 1.0);
    bench.fly(3.0);
    assert!(roll_deg(&bench).abs() < 5.0, "{}", roll_deg(&bench));
}

#[test]
fn arming_needs_a_low_throttle_and_the_rudder_arms() {
    let (mut bench, mut radio) = with_radio(&settings(Identity::ArduPilot));
    radio.set(&mut bench, 3, 1700);
    bench.fly(0.1);
    assert_eq!(bench.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, ARM), FAILED);
    assert!(said(&bench, "throttle too high"), "{:?}", bench.texts());
    radio.set(&mut bench, 3, 1000);
    radio.set(&mut bench, 4, 2000);
    bench.fly(1.9);
    assert!(!is_armed(&bench));
    bench.fly(0.2);
    assert!(is_armed(&bench), "{:?}", bench.texts());
    assert!(bench.position()[2] > -0.01);
    // Off (0) and arming only (1).
    radio.set(&mut bench, 4, 1500);
    set_parameter(&mut bench, "ARMING_RUDDER", 1.0);
    radio.set(&mut bench, 4, 1000);
    bench.fly(3.0);
    assert!(is_armed(&bench));
}

#[test]
fn the_loss_of_the_radio_disarms_on_the_ground() {
    let (mut bench, _) = with_radio(&settings(Identity::ArduPilot));
    bench.arm();
    fail(&mut bench, RadioFailure::NoPulses);
    bench.fly(1.1);
    assert!(!is_armed(&bench), "{:?}", bench.texts());
    assert_eq!(bench.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, ARM), FAILED);
}

#[test]
fn the_loss_of_the_radio_does_what_its_parameter_says() {
    for (failure, lost, expected) in [
        (RadioFailure::NoPulses, RadioLossAction::None, Mode::Altitude),
        (RadioFailure::NoPulses, RadioLossAction::Return, Mode::Return),
        (RadioFailure::LowThrottle, RadioLossAction::Return, Mode::Return),
        (RadioFailure::LowThrottle, RadioLossAction::None, Mode::Altitude),
        (RadioFailure::NoPulses, RadioLossAction::Land, Mode::Land),
        (RadioFailure::NoPulses, RadioLossAction::BrakeOrLand, Mode::Hold),
        (RadioFailure::NoPulses, RadioLossAction::TraceOrReturn, Mode::SmartReturn),
    ] {
        let mut start = settings(Identity::ArduPilot);
        start.conduct.failsafe.pilot_lost = lost;
        let (mut bench, mut radio) = flown_up(&start, Mode::Altitude);
        bench.heard.clear();
        fail(&mut bench, failure);
        bench.fly(1.2);
        assert_eq!(bench.mode(), expected, "{failure:?} {lost:?}: {:?}", bench.texts());
        if expected == Mode::Altitude {
            continue;
        }
        assert!(said(&bench, "Radio Failsafe"), "{:?}", bench.texts());
        let health = health(&mut bench);
        assert!(!health.contains(MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_RC_RECEIVER));
        // With the radio back, the mode switch decides again once it is moved.
        fail(&mut bench, RadioFailure::None);
        bench.fly(2.0);
        assert_eq!(bench.mode(), expected);
        radio.set(&mut bench, 5, 1685);
        bench.fly(0.3);
        assert_eq!(bench.mode(), Mode::Position, "{:?}", bench.texts());
    }
}

fn health(bench: &mut Bench) -> MavSysStatusSensor {
    bench.heard.clear();
    bench.fly(1.1);
    let found = bench.heard.iter().rev().find_map(|message| match message {
        autopilot::codec::Message::Typed(MavMessage::SYS_STATUS(status)) => {
            Some(status.onboard_control_sensors_health)
        }
        _ => None,
    });
    found.expect("a SYS_STATUS each second")
}

#[test]
fn options_let_guided_flight_go_on_without_the_radio() {
    let (mut bench, _) = flown_up(&settings(Identity::ArduPilot), Mode::Position);
    assert_eq!(bench.set_mode(Mode::Offboard), ACCEPTED);
    set_parameter(&mut bench, "FS_OPTIONS", 4.0);
    fail(&mut bench, RadioFailure::NoPulses);
    bench.fly(3.0);
    assert_eq!(bench.mode(), Mode::Offboard, "{:?}", bench.texts());
}

#[test]
fn switches_have_functions() {
    let mut start = settings(Identity::ArduPilot);
    for (channel, option) in [(6, 4.0), (8, 153.0), (9, 31.0), (10, 17.0)] {
        start.conduct.radio.channels[channel - 1].option = option;
    }
    let (mut bench, mut radio) = with_radio(&start);
    // Where they are found changes nothing.
    assert!(!is_armed(&bench));
    radio.set(&mut bench, 8, 2000);
    bench.fly(0.3);
    assert!(is_armed(&bench), "{:?}", bench.texts());
    assert_eq!(bench.set_mode(Mode::Altitude), ACCEPTED);
    radio.set(&mut bench, 3, 1700);
    bench.fly_until("5 m", 20.0, |bench| bench.position()[2] < -5.0);
    radio.set(&mut bench, 3, 1500);
    // Saves a waypoint: home, a takeoff and the place.
    radio.set(&mut bench, 7, 2000);
    bench.fly(0.3);
    let mission = bench.autopilot.vehicle().plans().get(vehicle::plan::PlanKind::Mission).items().to_vec();
    assert_eq!(mission.iter().map(|item| item.command).collect::<Vec<_>>(), [16, 22, 16]);
    radio.set(&mut bench, 6, 2000);
    bench.fly(0.3);
    assert_eq!(bench.mode(), Mode::Return, "{:?}", bench.texts());
    // Back to the mode of the mode switch.
    radio.set(&mut bench, 6, 1000);
    bench.fly(0.3);
    assert_eq!(bench.mode(), Mode::Stabilize);
    bench.heard.clear();
    radio.set(&mut bench, 10, 2000);
    bench.fly(0.3);
    assert!(said(&bench, "AutoTune mode is not available"), "{:?}", bench.texts());
    radio.set(&mut bench, 9, 2000);
    bench.fly(0.3);
    assert!(!is_armed(&bench));
}

#[test]
fn functions_of_switches_are_done_by_command() {
    let mut bench = Bench::hovering(Identity::ArduPilot);
    let aux = |number: f32, level: f32| [number, level, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_AUX_FUNCTION, aux(18.0, 2.0)), ACCEPTED);
    assert_eq!(bench.mode(), Mode::Land);
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_AUX_FUNCTION, aux(999.0, 2.0)), UNSUPPORTED);
    assert_eq!(bench.command(MavCmd::MAV_CMD_DO_AUX_FUNCTION, aux(18.0, 3.0)), 2);
}

fn override_of(channels: [u16; 8]) -> MavMessage {
    let [chan1_raw, chan2_raw, chan3_raw, chan4_raw, chan5_raw, chan6_raw, chan7_raw, chan8_raw] = channels;
    MavMessage::RC_CHANNELS_OVERRIDE(RC_CHANNELS_OVERRIDE_DATA {
        target_system: 1,
        target_component: 1,
        chan1_raw,
        chan2_raw,
        chan3_raw,
        chan4_raw,
        chan5_raw,
        chan6_raw,
        chan7_raw,
        chan8_raw,
        ..RC_CHANNELS_OVERRIDE_DATA::default()
    })
}

#[test]
fn overrides_end_after_their_time_or_when_they_are_given_back() {
    let leave = u16::MAX;
    let mut bench = Bench::hovering(Identity::ArduPilot);
    assert_eq!(bench.set_mode(Mode::Position), ACCEPTED);
    bench.send(override_of([1700, leave, leave, leave, leave, leave, leave, leave]));
    bench.fly(2.9);
    assert!(bench.velocity()[1] > 1.0, "{:?}", bench.velocity());
    let told = bench.heard.iter().rev().find_map(|message| match message {
        autopilot::codec::Message::Typed(MavMessage::RC_CHANNELS(told)) => Some(told.clone()),
        _ => None,
    });
    let told = told.expect("RC_CHANNELS are streamed");
    assert_eq!((told.chan1_raw, told.chan2_raw, told.rssi), (1700, 1500, 254));
    bench.fly(4.0);
    assert!(bench.velocity()[1].abs() < 0.1, "{:?}", bench.velocity());
    assert_eq!(bench.mode(), Mode::Position, "the simulated radio is centred");
    bench.send(override_of([1700, leave, leave, leave, leave, leave, leave, leave]));
    bench.fly(1.0);
    bench.send(override_of([0; 8]));
    bench.fly(4.0);
    assert!(bench.velocity()[1].abs() < 0.1, "{:?}", bench.velocity());
}

fn sticks(x: i16, y: i16, z: i16, r: i16) -> MavMessage {
    MavMessage::MANUAL_CONTROL(MANUAL_CONTROL_DATA {
        target: 1,
        x,
        y,
        z,
        r,
        ..MANUAL_CONTROL_DATA::default()
    })
}

#[test]
fn px4_flies_its_modes_with_a_joystick() {
    let mut bench = Bench::hovering(Identity::Px4);
    let held = bench.position()[2];
    assert_eq!(bench.set_mode(Mode::Altitude), ACCEPTED);
    bench.stream(3.0, |bench| bench.send(sticks(0, 500, 500, 0)));
    // Half of MPC_MAN_TILT_MAX.
    assert!((roll_deg(&bench) - 17.5).abs() < 1.5, "{}", roll_deg(&bench));
    assert!((bench.position()[2] - held).abs() < 0.3, "{:?}", bench.position());
    for mode in [Mode::Stabilize, Mode::Manual] {
        assert_eq!(bench.set_mode(mode), ACCEPTED);
        bench.stream(2.0, |bench| bench.send(sticks(0, -500, 500, 0)));
        assert!((roll_deg(&bench) + 17.5).abs() < 1.5, "{}", roll_deg(&bench));
        assert_eq!(bench.mode(), mode);
    }
    assert_eq!(bench.set_mode(Mode::Altitude), ACCEPTED);
    bench.stream(3.0, |bench| bench.send(sticks(0, 0, 1000, 0)));
    assert!((bench.velocity()[2] + 2.0).abs() < 0.2, "{:?}", bench.velocity());
    assert_eq!(bench.set_mode(Mode::Acro), ACCEPTED);
    bench.stream(0.4, |bench| bench.send(sticks(0, 500, 500, 0)));
    let rate = bench.autopilot.vehicle().outputs().body_rate_rad_s.x.to_degrees();
    assert!((rate - 50.0).abs() < 12.0, "half of MC_ACRO_R_MAX: {rate}");
}

#[test]
fn px4_loses_its_pilot_by_its_parameters() {
    for (lost, exceptions, mode, expected) in [
        (RadioLossAction::Return, 0, Mode::Position, Mode::Return),
        (RadioLossAction::Hold, 0, Mode::Position, Mode::Hold),
        (RadioLossAction::Land, 0, Mode::Altitude, Mode::Land),
        (RadioLossAction::Return, 0, Mode::Hold, Mode::Return),
        (RadioLossAction::Return, 2, Mode::Hold, Mode::Hold),
    ] {
        let mut start = settings(Identity::Px4);
        start.conduct.failsafe.pilot_lost = lost;
        start.conduct.radio.lost_exceptions = exceptions;
        let mut bench = Bench::hovering_with(&start);
        bench.stream(1.0, |bench| bench.send(sticks(0, 0, 500, 0)));
        assert_eq!(bench.set_mode(mode), ACCEPTED);
        bench.stream(1.0, |bench| bench.send(sticks(0, 0, 500, 0)));
        bench.fly(0.4);
        assert_eq!(bench.mode(), mode);
        bench.fly(0.2);
        assert_eq!(bench.mode(), expected, "{lost:?} {exceptions} {mode:?}: {:?}", bench.texts());
    }
}

#[test]
fn moved_sticks_take_over_from_px4() {
    let mut bench = Bench::hovering(Identity::Px4);
    bench.stream(1.0, |bench| bench.send(sticks(200, 0, 500, 0)));
    assert_eq!(bench.mode(), Mode::Hold, "less than COM_RC_STICK_OV");
    bench.stream(0.1, |bench| bench.send(sticks(800, 0, 500, 0)));
    assert_eq!(bench.mode(), Mode::Position, "{:?}", bench.texts());
    assert!(said(&bench, "Pilot took over using sticks"));
}

#[test]
fn px4_arms_with_the_sticks_and_changes_modes_with_switches() {
    let mut start = settings(Identity::Px4);
    start.conduct.radio.mode_channel = 5.0;
    start.conduct.radio.modes = [8.0, 1.0, 2.0, 4.0, 5.0, 3.0];
    start.conduct.radio.switches.kill = 6.0;
    let (mut bench, mut radio) = with_radio(&start);
    for (pulse, mode) in [(1000, Mode::Stabilize), (1250, Mode::Altitude), (1420, Mode::Position)] {
        radio.set(&mut bench, 5, pulse);
        bench.fly(0.3);
        assert_eq!(bench.mode(), mode, "{:?}", bench.texts());
    }
    radio.set(&mut bench, 4, 2000);
    bench.fly(1.2);
    assert!(is_armed(&bench), "{:?}", bench.texts());
    radio.set(&mut bench, 4, 1500);
    radio.set(&mut bench, 6, 2000);
    bench.fly(0.3);
    assert!(!is_armed(&bench));
}

#[test]
fn without_gps_it_arms_and_flies_where_no_place_is_needed() {
    for identity in [Identity::Px4, Identity::ArduPilot] {
        let mut start = settings(identity);
        start.sensors.model = vehicle::estimation::SensorModel::Realistic;
        start.faults = vec!["0:gps=off".parse().expect("a fault")];
        let (mut bench, mut radio) = with_radio(&start);
        bench.fly(15.0);
        assert_eq!(bench.set_mode(Mode::Position), ACCEPTED);
        assert_ne!(bench.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, ARM), ACCEPTED, "{identity:?}");
        assert_eq!(bench.set_mode(Mode::Altitude), ACCEPTED);
        bench.arm();
        radio.set(&mut bench, 3, 1700);
        bench.fly_until("5 m", 20.0, |bench| bench.autopilot.vehicle().truth().position_m.z < -5.0);
        radio.set(&mut bench, 3, 1500);
        bench.fly(3.0);
        let held = bench.autopilot.vehicle().truth().position_m.z;
        bench.fly(5.0);
        assert!((bench.autopilot.vehicle().truth().position_m.z - held).abs() < 1.0, "{identity:?}");
        assert_eq!(bench.mode(), Mode::Altitude, "{:?}", bench.texts());
        let refused = if identity.is_ardupilot() { FAILED } else { TEMPORARILY_REJECTED };
        assert_eq!(bench.set_mode(Mode::Position), refused);
    }
}
