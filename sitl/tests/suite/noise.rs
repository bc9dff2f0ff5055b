//! Flights on noisy measurements, with and without the Kalman predictor in the loop.

use crate::common::Bench;
use autopilot::codec::Message;
use mavlink::dialects::ardupilotmega::{MavCmd, MavMessage};
use nalgebra::Vector3;
use sitl::configuration::{Arguments, Settings};
use sitl::record::Digest;
use vehicle::Mode;

fn bench(noise: &str, kalman: bool, seed: u64) -> Bench {
    let arguments = Arguments {
        noise: Some(noise.parse().expect("a noise")),
        kalman: Some(kalman),
        seed: Some(seed),
        ..Arguments::default()
    };
    Bench::of(&Settings::resolve(&arguments).expect("valid").vehicles[0].vehicle)
}

struct Hover {
    /// Root of the mean square of the true distance from the place to hold, m.
    error_m: f64,
    /// The same of what the vehicle believes of its position.
    believed_m: f64,
    digest: u64,
}

/// Takes off and hovers.
fn hover(noise: &str, kalman: bool, seed: u64) -> Hover {
    let mut bench = bench(noise, kalman, seed);
    bench.fly(0.1);
    bench.arm();
    assert_eq!(bench.command(MavCmd::MAV_CMD_NAV_TAKEOFF, [f32::NAN; 7]), 0);
    bench.fly_until("takeoff", 30.0, |bench| bench.mode() == Mode::Hold);
    bench.fly(4.0);
    let goal = bench.autopilot.vehicle().outputs().setpoint.position_m;
    let (mut digest, mut error, mut believed) = (Digest::default(), 0.0, 0.0);
    const TICKS: usize = 10_000;
    for _ in 0..TICKS {
        bench.fly(0.001);
        let vehicle = bench.autopilot.vehicle();
        digest.update(vehicle);
        error += (vehicle.truth().position_m - goal).norm_squared();
        believed += (vehicle.outputs().position_m - vehicle.truth().position_m).norm_squared();
    }
    let root = |sum: f64| (sum / TICKS as f64).sqrt();
    Hover { error_m: root(error), believed_m: root(believed), digest: digest.value() }
}

#[test]
fn it_hovers_on_noise_and_better_by_the_kalman_predictor() {
    // Its noise, three axes of 0.02 m, is what it believes without a filter; the filter believes better.
    let measured = hover("rtk-gps", false, 1);
    assert!(measured.error_m < 0.15, "{}", measured.error_m);
    assert!((measured.believed_m - 0.02 * f64::sqrt(3.0)).abs() < 0.003, "{}", measured.believed_m);
    let filtered = hover("rtk-gps", true, 1);
    assert!(filtered.error_m < 0.06, "{}", filtered.error_m);
    assert!(filtered.believed_m < 0.8 * measured.believed_m, "{}", filtered.believed_m);
    assert!(hover("motion-capture", true, 1).error_m < 0.02);
}

#[test]
fn a_seed_repeats_the_flight_and_another_does_not() {
    let flown = hover("rtk-gps", true, 7).digest;
    assert_eq!(hover("rtk-gps", true, 7).digest, flown);
    assert_ne!(hover("rtk-gps", true, 8).digest, flown);
    // Seeds that differ in their upper bits only are others, too.
    assert_ne!(hover("rtk-gps", true, 7 + (1 << 40)).digest, flown);
}

/// Telemetry is what the vehicle believes; SIM_STATE is the truth.
#[test]
fn telemetry_tells_what_the_vehicle_believes() {
    let mut bench = bench("0.5,0,0,0", false, 3);
    let positions = |bench: &Bench| -> Vec<Vector3<f32>> {
        let place = |message: &Message| match message {
            Message::Typed(MavMessage::LOCAL_POSITION_NED(place)) => {
                Some(Vector3::new(place.x, place.y, place.z))
            }
            _ => None,
        };
        bench.heard.iter().filter_map(place).collect()
    };
    bench.arm();
    bench.fly(5.0);
    let told = positions(&bench);
    assert!(told.len() > 40, "{}", told.len());
    let spread = told.iter().map(Vector3::norm_squared).sum::<f32>() / (3 * told.len()) as f32;
    assert!((0.3..0.7).contains(&spread.sqrt()), "{spread}");
    assert!(bench.autopilot.vehicle().truth().position_m.norm() < 0.1);
}

#[test]
fn what_is_no_noise_is_refused() {
    use sitl::configuration::MeasurementNoise;
    for wrong in ["", "gps", "1", "1,2,3", "-1,0,0,0", "0,0,0.6,0", "nan,0,0,0", "1,2,0.1,4,5"] {
        let error = wrong.parse::<MeasurementNoise>().expect_err(wrong);
        assert!(error.contains("motion-capture") && !error.contains('\n'), "{error}");
    }
    let both = Arguments {
        kalman: Some(true),
        sensors: Some(vehicle::estimation::SensorModel::Realistic),
        ..Arguments::default()
    };
    assert!(Settings::resolve(&both).expect_err("both").to_string().contains("of its own"));
}
