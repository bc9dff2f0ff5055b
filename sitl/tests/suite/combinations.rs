//! What single features get right, and what went wrong where they met.

use crate::common::requests::local_target;
use crate::common::{Bench, settings};
use mavlink::dialects::ardupilotmega::{MavCmd, MavMessage};
use vehicle::estimation::{SensorModel, SensorSettings};
use vehicle::identity::Identity;
use vehicle::{Action, Mode, SteeringKind};

/// A takeoff that is called off before it has left the ground, be it to hold, to land or to return: the rotors idle, and stop.
#[test]
fn a_takeoff_that_is_called_off_on_the_ground_ends_there() {
    for identity in [Identity::Px4, Identity::ArduPilot] {
        for mode in [Mode::Hold, Mode::Land, Mode::Return, Mode::Position] {
            for delay_s in [0.01, 0.05, 0.2] {
                let mut bench = Bench::new(identity);
                if identity.is_ardupilot() {
                    bench.set_mode(Mode::Offboard);
                }
                bench.arm();
                let altitude = if identity.is_ardupilot() { 10.0 } else { 498.0 };
                let takeoff = [0.0, 0.0, 0.0, f32::NAN, f32::NAN, f32::NAN, altitude];
                assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_TAKEOFF, takeoff), 0);
                bench.fly(delay_s);
                assert_eq!(bench.set_mode(mode), 0);
                let what = format!("{identity:?} {mode:?} {delay_s}");
                bench.fly_until(&what, 12.0, |bench| !bench.autopilot.vehicle().is_armed());
                assert_eq!(bench.autopilot.vehicle().steering_kind(), SteeringKind::Idle, "{what}");
            }
        }
    }
}

fn velocity([vx, vy, vz]: [f32; 3]) -> MavMessage {
    local_target(0b1101_1100_0111, [0.0; 3], [vx, vy, vz])
}

/// Pushed along the ground by its set-points a vehicle comes to lean on an edge: it lands all the same.
#[test]
fn what_leans_on_the_ground_has_landed() {
    for identity in [Identity::Px4, Identity::ArduPilot] {
        for sideways in [1.5, 3.0] {
            let mut bench = Bench::hovering(identity);
            bench.send(velocity([sideways, -sideways, 1.0]));
            assert_eq!(bench.set_mode(Mode::Offboard), 0);
            bench.stream(15.0, |bench| bench.send(velocity([sideways, -sideways, 1.0])));
            bench.set_mode(Mode::Land);
            bench.fly_until("disarmed", 20.0, |bench| !bench.autopilot.vehicle().is_armed());
        }
    }
}

/// A velocity above a low limit of speed: the vehicle flies at the limit, level and steady.
#[test]
fn a_slow_vehicle_flies_steadily_at_its_limit() {
    for limit_m_s in [0.2, 0.5, 1.0, 3.0] {
        let mut bench = Bench::hovering(Identity::Px4);
        let speed = [1.0, limit_m_s, -1.0, 0.0, 0.0, 0.0, 0.0];
        assert_eq!(bench.command(MavCmd::MAV_CMD_DO_CHANGE_SPEED, speed), 0);
        bench.send(velocity([-3.0, 4.0, 0.1]));
        assert_eq!(bench.set_mode(Mode::Offboard), 0);
        bench.stream(4.0, |bench| bench.send(velocity([-3.0, 4.0, 0.1])));
        for _ in 0..100 {
            bench.stream(0.05, |bench| bench.send(velocity([-3.0, 4.0, 0.1])));
            let outputs = bench.autopilot.vehicle().outputs();
            let (lean, behind) = (outputs.attitude_rad.xy().norm(), outputs.tracking_error_m.norm());
            let [vx, vy, _] = bench.velocity();
            let off = libm::hypot(vx + 0.6 * f64::from(limit_m_s), vy - 0.8 * f64::from(limit_m_s));
            assert!(lean < 0.05 && off < 0.1 && behind < 0.3, "{limit_m_s}: {lean} {off} {behind}");
        }
    }
}

/// Accelerometers that are off by 1 m/s² contradict the receiver: after two seconds it is believed instead of them, and the vehicle
/// comes to rest and stays, with errors no larger than the receiver's.
#[test]
fn the_estimator_recovers_from_an_accelerometer_that_is_wrong() {
    const ACCELEROMETER_WRONG: [f32; 7] = [1.0, 4.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    for seed in 1..=4 {
        let mut settings = settings(Identity::Px4);
        settings.sensors = SensorSettings { model: SensorModel::Realistic, seed };
        settings.conduct.failsafe.position_lost = Action::Warn;
        let mut bench = Bench::of(&settings);
        bench.fly(4.0);
        bench.arm();
        let takeoff = [0.0, 0.0, 0.0, f32::NAN, f32::NAN, f32::NAN, 508.0];
        assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_TAKEOFF, takeoff), 0);
        bench.fly_until("takeoff", 30.0, |bench| bench.mode() != Mode::Takeoff);
        bench.fly(5.0);
        let start = bench.autopilot.vehicle().truth().position_m;
        assert_eq!(bench.command(MavCmd::MAV_CMD_INJECT_FAILURE, ACCELEROMETER_WRONG), 0);
        let mut farthest_m = 0.0_f64;
        for second in 0..60 {
            bench.fly(1.0);
            let vehicle = bench.autopilot.vehicle();
            let truth = vehicle.truth();
            farthest_m = farthest_m.max((truth.position_m - start).norm());
            let (health, resets) = (vehicle.instrument_health(), vehicle.estimate().unwrap().resets);
            if second >= 10 {
                let what = format!("seed {seed}, {second} s: {health:?} {resets} {:?}", truth.velocity_m_s);
                assert!(health.gps && health.barometer && (1..=2).contains(&resets), "{what}");
                assert!(truth.velocity_m_s.norm() < 1.0 && vehicle.validity().all(), "{what}");
            }
        }
        assert!(farthest_m < 15.0, "seed {seed}: {farthest_m} m");
    }
}
