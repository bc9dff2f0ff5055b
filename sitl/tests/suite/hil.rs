//! The plant alone under an autopilot's motors, without a socket.

use crate::common::settings;
use mavlink::dialects::ardupilotmega::{
    HIL_GPS_DATA, HIL_SENSOR_DATA, HIL_STATE_QUATERNION_DATA, MavMessage,
};
use sitl::hil::{ActuatorControls, Mount, Rig, STEP_US};
use vehicle::identity::Identity;
use vehicle::world::earth_field_ned;

fn rig(mount: Mount) -> Rig {
    Rig::new(&settings(Identity::Px4), mount).expect("the default airframe")
}

fn controls(motors: [f64; 4]) -> ActuatorControls {
    ActuatorControls { time_us: 0, lockstep: true, armed: true, motors }
}

#[derive(Default)]
struct Told {
    sensors: Vec<HIL_SENSOR_DATA>,
    fixes: Vec<HIL_GPS_DATA>,
    truths: Vec<HIL_STATE_QUATERNION_DATA>,
    heartbeats: usize,
    /// How old fixes were when they were told, µs.
    fix_ages_us: Vec<u64>,
}

fn fly(rig: &mut Rig, seconds: f64, motors: Option<[f64; 4]>) -> Told {
    let mut told = Told::default();
    for _ in 0..(seconds * 1e6 / STEP_US as f64).round() as usize {
        if let Some(motors) = motors {
            rig.control(&controls(motors));
        }
        for message in rig.step().expect("a flight") {
            match message {
                MavMessage::HIL_SENSOR(data) => told.sensors.push(data),
                MavMessage::HIL_GPS(data) => {
                    told.fix_ages_us.push(rig.time_us() - data.time_usec);
                    told.fixes.push(data);
                }
                MavMessage::HIL_STATE_QUATERNION(data) => told.truths.push(data),
                MavMessage::HEARTBEAT(_) => told.heartbeats += 1,
                other => panic!("{other:?}"),
            }
        }
    }
    told
}

/// What instruments on the ground must show: free fall upwards, no turn, the earth's field, the pressure of the place.
#[test]
fn instruments_on_the_ground_show_the_ground() {
    let mut settings = settings(Identity::Px4);
    settings.heading_rad = 0.7;
    for mount in [Mount::X, Mount::Plus] {
        let mut rig = Rig::new(&settings, mount).expect("the default airframe");
        let told = fly(&mut rig, 3.0, None);
        assert_eq!((told.sensors.len(), told.truths.len(), told.heartbeats), (750, 150, 3));
        let times: Vec<u64> = told.sensors.iter().map(|sensor| sensor.time_usec).collect();
        assert!(times.iter().zip(1..).all(|(time, step)| *time == step * STEP_US));
        let last = &told.sensors[600];
        // The offsets of the data sheet, at four standard deviations.
        assert!((last.zacc + 9.806_65).abs() < 0.27 && last.xacc.hypot(last.yacc) < 0.4, "{last:?}");
        assert!([last.xgyro, last.ygyro, last.zgyro].iter().all(|rate| rate.abs() < 0.015), "{last:?}");

        // Every fifth report has magnetometer and barometer, 50 Hz; the others say so.
        let full = |sensor: &&HIL_SENSOR_DATA| sensor.fields_updated.bits() == 0x1bff;
        let inertial = |sensor: &&HIL_SENSOR_DATA| sensor.fields_updated.bits() == 0x3f;
        assert_eq!(told.sensors.iter().filter(full).count(), 150);
        assert_eq!(told.sensors.iter().filter(inertial).count(), 600);
        let seen = told.sensors.iter().rfind(full).expect("a full report");
        let field = earth_field_ned(&settings.origin);
        let heading = f64::from(-seen.ymag).atan2(f64::from(seen.xmag));
        assert!((heading - settings.heading_rad).abs() < 0.01, "{mount:?} {heading}");
        assert!((f64::from(seen.zmag) - field.z).abs() < 0.002, "{seen:?}");
        // 488 m in the standard atmosphere: 956 hPa.
        assert!((seen.abs_pressure - 956.0).abs() < 3.0 && (seen.temperature - 11.8).abs() < 0.3, "{seen:?}");

        // Ten fixes a second, from a second (and the receiver's latency) on.
        assert!((19..=21).contains(&told.fixes.len()), "{}", told.fixes.len());
        // PX4's start script tells its estimator 10 ms; reports come every 4 ms.
        assert!(told.fix_ages_us.iter().all(|age| (10_000..14_000).contains(age)), "{:?}", told.fix_ages_us);
        let fix = told.fixes.last().expect("a fix");
        assert!((f64::from(fix.lat) * 1e-7 - settings.origin.latitude_deg).abs() < 1e-4, "{fix:?}");
        assert!((f64::from(fix.alt) * 1e-3 - settings.origin.altitude_m).abs() < 15.0, "{fix:?}");
        let [w, _, _, z] = told.truths[149].attitude_quaternion;
        assert!((2.0 * f64::from(z).atan2(f64::from(w)) - 0.7).abs() < 1e-3, "{mount:?}");
    }
}

/// One pair of motors a little faster turns the vehicle as PX4's mixers count on, in both mounts.
#[test]
fn motors_are_px4s() {
    const MORE: f64 = 0.62;
    const LESS: f64 = 0.58;
    // Motors, and the sign of the rates about FRD that they make.
    let x = [
        ([LESS, MORE, MORE, LESS], [1.0, 0.0, 0.0]),
        ([MORE, LESS, MORE, LESS], [0.0, 1.0, 0.0]),
        ([MORE, MORE, LESS, LESS], [0.0, 0.0, 1.0]),
    ];
    let plus = [
        ([LESS, MORE, 0.6, 0.6], [1.0, 0.0, 0.0]),
        ([0.6, 0.6, MORE, LESS], [0.0, 1.0, 0.0]),
        ([MORE, MORE, LESS, LESS], [0.0, 0.0, 1.0]),
    ];
    for (mount, cases) in [(Mount::X, x), (Mount::Plus, plus)] {
        for (motors, signs) in cases {
            let mut rig = rig(mount);
            // Off the ground first.
            fly(&mut rig, 0.7, Some([0.6; 4]));
            assert!(rig.plant().body.position_m.z < -0.2);
            rig.set_truth_interval(Some(STEP_US));
            let truth = fly(&mut rig, 0.3, Some(motors)).truths.pop().expect("the truth");
            let rates = [truth.rollspeed, truth.pitchspeed, truth.yawspeed];
            let largest = rates.iter().fold(0.0_f32, |most, rate| most.max(rate.abs()));
            for (rate, sign) in rates.iter().zip(signs) {
                let wanted = if sign == 0.0 { rate.abs() < 0.05 * largest } else { rate * sign > 0.01 };
                assert!(wanted, "{mount:?} {motors:?}: {rates:?}");
            }
        }
    }
}

/// Half of the hover thrust stays on the ground, hover speed carries the weight, and silence stops the rotors.
#[test]
fn controls_are_rotor_speeds_and_end_with_the_signal() {
    let airframe = quadrotor::Airframe::default();
    let (lowest, highest) = (airframe.rotor_speed_min_rad_s, airframe.rotor_speed_max_rad_s);
    let hover = (airframe.hover_rotor_speed_rad_s() - lowest) / (highest - lowest);
    let mut rig = rig(Mount::X);
    fly(&mut rig, 1.0, Some([0.9 * hover; 4]));
    let height_m = -rig.plant().body.position_m.z;
    assert!(height_m < 0.01, "{height_m}");
    fly(&mut rig, 1.0, Some([1.2 * hover; 4]));
    let settled = fly(&mut rig, 1.0, Some([hover; 4]));
    assert!(
        rig.plant()
            .rotor_speed_rad_s
            .iter()
            .all(|speed| (speed - airframe.hover_rotor_speed_rad_s()).abs() < 0.1)
    );
    let last = settled.truths.last().expect("the truth");
    assert!(last.vz < -50 && [last.xacc, last.yacc, last.zacc].iter().all(|mg| mg.abs() < 5), "{last:?}");
    // 0.2 s of the last command, and the rotors' lag of 0.03 s.
    fly(&mut rig, 0.192, None);
    assert!(rig.plant().rotor_speed_rad_s.iter().all(|speed| *speed > 240.0));
    fly(&mut rig, 0.2, None);
    assert!(rig.plant().rotor_speed_rad_s.iter().all(|speed| *speed < 1.0));
}

/// Before its motors turn a vehicle does not creep over the ground in a wind; then it is blown away.
#[test]
fn what_stands_in_the_wind_stays() {
    let mut settings = settings(Identity::Px4);
    settings.wind = vehicle::world::WindSettings { speed_m_s: 10.0, from_rad: 0.0, gusts_m_s: 0.0, seed: 1 };
    settings.configuration.airframe.drag_n_s_m = [0.15; 3];
    let mut rig = Rig::new(&settings, Mount::X).expect("the default airframe");
    fly(&mut rig, 20.0, None);
    assert!(rig.plant().body.position_m.xy().norm() < 1e-3, "{}", rig.plant().body.position_m);
    fly(&mut rig, 2.0, Some([0.6; 4]));
    assert!(rig.plant().body.position_m.x < -1.0, "{}", rig.plant().body.position_m);
}

#[test]
fn the_same_controls_are_the_same_flight() {
    let flight = |motor: f64| {
        let mut rig = rig(Mount::X);
        fly(&mut rig, 1.0, Some([motor, 0.55, 0.55, 0.55]));
        rig.digest().value()
    };
    assert_eq!(flight(0.56), flight(0.56));
    assert_ne!(flight(0.56), flight(0.560_001));
}

/// SET_MESSAGE_INTERVAL: whole steps, zero for the default, none.
#[test]
fn the_truth_comes_as_often_as_asked() {
    let mut rig = rig(Mount::X);
    for (interval_us, expected) in [(Some(5_000), 125), (Some(1), 250), (Some(0), 50), (None, 0)] {
        rig.set_truth_interval(interval_us);
        assert_eq!(fly(&mut rig, 1.0, None).truths.len(), expected, "{interval_us:?}");
    }
}
