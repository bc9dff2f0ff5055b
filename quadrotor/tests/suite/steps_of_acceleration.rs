//! Trapezoidal speed profiles on a curve: the acceleration jumps, and comes without jerk and snap.

use crate::common::{fly, unshaped};
use crate::references::geometric;
use nalgebra::Vector3;
use quadrotor::{
    Configuration, ControllerKind, FlatAttitude, Inputs, Mixer, Plant, PlantInputs, PlantState,
    PositionReference,
};

const RADIUS_M: f64 = 12.0;
const SLOWEST_M_S: f64 = 3.0;
/// Acceleration along the circle, m/s²: it turns round after each period.
const PUSH_M_S2: f64 = 0.8;
const DURATION_S: f64 = 20.0;

/// A point of a circle at a time, whose acceleration jumps after each period, with its jerk between the jumps.
fn point(period_s: f64, time_s: f64) -> PositionReference {
    let whole = libm::floor(time_s / period_s);
    let since_s = time_s - whole * period_s;
    let change_m_s = PUSH_M_S2 * period_s;
    let (start_m_s, a) = match whole as i64 % 2 {
        0 => (SLOWEST_M_S, PUSH_M_S2),
        _ => (SLOWEST_M_S + change_m_s, -PUSH_M_S2),
    };
    let v = start_m_s + a * since_s;
    let way_m = whole * period_s * (SLOWEST_M_S + change_m_s / 2.0) + (start_m_s + v) / 2.0 * since_s;
    let (sin, cos) = (way_m / RADIUS_M).sin_cos();
    let (along, inward) = (Vector3::new(-sin, cos, 0.0), Vector3::new(-cos, -sin, 0.0));
    PositionReference {
        velocity_m_s: along * v,
        acceleration_m_s2: along * a + inward * (v * v / RADIUS_M),
        jerk_m_s3: inward * (3.0 * v * a / RADIUS_M) - along * (v * v * v / RADIUS_M / RADIUS_M),
        ..PositionReference::goal((inward * -RADIUS_M - Vector3::z() * 20.0).into(), 0.0)
    }
}

fn on_the_circle(period_s: f64, kind: ControllerKind) -> Configuration {
    let mut configuration = unshaped();
    let start = point(period_s, 0.0);
    let flat = FlatAttitude::of(&start);
    configuration.controllers.kind = kind;
    configuration.initial.position_m = start.position_m.into();
    configuration.initial.velocity_m_s = start.velocity_m_s.into();
    let [roll_rad, pitch_rad] = flat.tilt_rad();
    configuration.initial.attitude_rad = [roll_rad, pitch_rad, 0.0];
    configuration.initial.body_rate_rad_s = flat.body_rate_rad_s.into();
    configuration
}

/// Largest distance from the way, m, and from the attitude that it has between the jumps, rad, after 2 s of points that are set each
/// `period_us` without jerk and snap.
fn streamed(period_s: f64, kind: ControllerKind, period_us: u64) -> [f64; 2] {
    let inputs = |time_us: u64| {
        let now = point(period_s, (time_us / period_us * period_us) as f64 * 1e-6);
        Inputs { reference: PositionReference { jerk_m_s3: Vector3::zeros(), ..now }, ..Inputs::default() }
    };
    let mut worst = [0.0; 2];
    fly(&on_the_circle(period_s, kind), &inputs, DURATION_S, |outputs| {
        if outputs.time_us > 2_000_000 {
            let wanted = point(period_s, outputs.time_us as f64 * 1e-6);
            let off_m = (outputs.position_m - wanted.position_m).norm();
            let off_rad = FlatAttitude::of(&wanted).attitude.angle_to(&outputs.orientation());
            worst = [f64::max(worst[0], off_m), f64::max(worst[1], off_rad)];
        }
    });
    worst
}

/// The same under the geometric controller, which is told the jerk between the jumps.
fn geometrically(period_s: f64) -> [f64; 2] {
    let configuration = on_the_circle(period_s, ControllerKind::Dlqr);
    let airframe = &configuration.airframe;
    let mixer = Mixer::new(airframe).expect("a quadrotor");
    let plant = Plant::new(airframe, &configuration.environment);
    let mut state = PlantState::hovering(&configuration.initial, airframe);
    let (mut worst, mut command) = ([0.0; 2], [0.0; 4]);
    for millisecond in 0..(DURATION_S * 1e3) as u64 {
        let at = |ahead_s: f64| point(period_s, millisecond as f64 * 1e-3 + ahead_s);
        if millisecond % 10 == 0 {
            command = geometric(airframe, &mixer, &state, at);
        }
        if millisecond > 2_000 {
            let off_m = (state.body.position_m - at(0.0).position_m).norm();
            let off_rad = FlatAttitude::of(&at(0.0)).attitude.angle_to(&state.body.rotation());
            worst = [f64::max(worst[0], off_m), f64::max(worst[1], off_rad)];
        }
        state = plant.step(&state, &PlantInputs::rotor_speeds(command), 1e-3);
    }
    worst
}

/// Whatever the rate of the points, Laguerre MPC comes about as near to the way as the geometric controller, and nearer than the
/// regulator: measured 3 to 10 cm, 4 to 9 cm and 11 to 66 cm.
#[test]
fn steps_of_the_acceleration_are_flown_as_steps() {
    let rates: [(f64, &[u64]); 3] =
        [(0.15, &[1_000, 10_000, 20_000, 50_000]), (0.31, &[100_000]), (1.0, &[1_000, 100_000])];
    for (period_s, periods_us) in rates {
        let [plain_m, plain_rad] = geometrically(period_s);
        for period_us in periods_us {
            let [off_m, off_rad] = streamed(period_s, ControllerKind::Lmpc, *period_us);
            let case = format!("{period_s} s each {period_us} µs");
            assert!(off_m < plain_m + 0.05, "{case}: {off_m} m, geometrically {plain_m} m");
            assert!(off_rad < plain_rad + 0.08, "{case}: {off_rad} rad, geometrically {plain_rad} rad");
            let [regulated_m, _] = streamed(period_s, ControllerKind::Dlqr, *period_us);
            assert!(off_m < regulated_m, "{case}: {off_m} m, regulated {regulated_m} m");
        }
    }
}
