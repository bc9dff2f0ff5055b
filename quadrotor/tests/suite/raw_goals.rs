//! Raw goals under slow tilts and slow samples. Others, cruise and side forces are among the bars of the crate `paper`.

use crate::common::{Extremes, KINDS, distance, fly, goal, noisy, overshoot};
use nalgebra::Vector3;
use quadrotor::{
    AirframePreset, Configuration, ControllerKind, Disturbance, Inputs, Limits, Sensors, Simulation,
};

/// A tilt that turns or begins to turn slowly: later, but without swinging. Goals of 10 m were missed for ever, by 170 m with a Crazyflie.
#[test]
fn goals_are_reached_by_slow_tilts() {
    let slower = |limits: &Limits, rate: f64, acceleration: f64| Limits {
        tilt_rate_rad_s: rate * limits.tilt_rate_rad_s,
        tilt_acceleration_rad_s2: acceleration * limits.tilt_acceleration_rad_s2,
        ..*limits
    };
    for (preset, kind, rate, acceleration) in [
        (AirframePreset::Paper, ControllerKind::Lmpc, 0.1, 0.1),
        (AirframePreset::Crazyflie, ControllerKind::Lmpc, 0.1, 0.1),
        (AirframePreset::Heavy, ControllerKind::Lmpc, 1.0, 0.05),
        (AirframePreset::Paper, ControllerKind::StateSpaceMpc, 0.1, 0.1),
    ] {
        let mut configuration = Configuration::for_airframe(&preset.airframe()).unwrap();
        configuration.controllers.kind = kind;
        configuration.reference.shaping = false;
        configuration.limits = slower(&configuration.limits, rate, acceleration);
        let goal_m = [8.0, -6.0, 0.0];
        let mut beyond = 0.0_f64;
        let end = fly(&configuration, &goal(goal_m, 0.0), 12.0, |outputs| {
            beyond = beyond.max(overshoot(outputs, goal_m));
        });
        let away_m = distance(&end.outputs(), goal_m);
        assert!(beyond < 0.04 && away_m < 0.02, "{preset:?} {kind:?}: {beyond}, {away_m} m");
    }
}

/// On noisy states or outputs alone, at the speed limit: a plan that took the noise of each sample for a force that lasts pitched by ±10°,
/// and was a quarter of a metre per second slower than the limit.
#[test]
fn a_cruise_at_the_speed_limit_is_calm_under_noise() {
    for (output_feedback, most_deg) in [(false, 2.5), (true, 4.5)] {
        let mut configuration = Configuration::default();
        configuration.reference.shaping = false;
        configuration.sensors = Sensors { output_feedback, ..noisy() };
        let limit_m_s = configuration.limits.speed_horizontal_m_s;
        let [mut count, mut pitch, mut speed] = [0.0; 3];
        let mut fastest_m_s = 0.0_f64;
        fly(&configuration, &goal([300.0, 0.0, 0.0], 0.0), 30.0, |outputs| {
            if outputs.time_us > 10_000_000 {
                count += 1.0;
                pitch += outputs.attitude_rad.y.to_degrees().powi(2);
                speed += outputs.velocity_m_s.x;
                fastest_m_s = fastest_m_s.max(outputs.velocity_m_s.x);
            }
        });
        let (pitch_deg, mean_m_s) = (f64::sqrt(pitch / count), speed / count);
        let told =
            format!("outputs alone: {output_feedback}: {pitch_deg}°, {mean_m_s} and {fastest_m_s} m/s");
        assert!(
            pitch_deg < most_deg && mean_m_s > 0.99 * limit_m_s && fastest_m_s < 1.02 * limit_m_s,
            "{told}"
        );
    }
}

/// Braking takes longer than a plan foresees, or the tilt turns slowly: the vehicle comes to rest at the goal, within the speed limit. It had
/// gone up to 14 m beyond, a third faster than the limit, and 54 m with a Crazyflie.
#[test]
fn long_braking_begins_in_time() {
    let paper = (AirframePreset::Paper, 10.0);
    for ((preset, speed_m_s), tilt_deg, tilt_rate_share, goal_m) in [
        (paper, 10.0_f64, 1.0, [120.0, -90.0, 0.0]),
        (paper, 14.0, 1.0, [0.0, 150.0, 0.0]),
        (paper, 17.6, 1.0, [33.8, 35.9, 0.0]),
        (paper, 18.0, 0.4, [-60.0, 10.0, 5.0]),
        ((AirframePreset::Crazyflie, 10.6), 35.0, 0.16, [33.0, 43.0, 0.0]),
        ((AirframePreset::Heavy, 7.1), 17.8, 1.0, [75.1, 97.5, -11.7]),
    ] {
        for kind in [ControllerKind::Lmpc, ControllerKind::StateSpaceMpc] {
            let mut configuration = Configuration::for_airframe(&preset.airframe()).unwrap();
            configuration.controllers.kind = kind;
            configuration.reference.shaping = false;
            let limits = &mut configuration.limits;
            limits.speed_horizontal_m_s = speed_m_s;
            limits.tilt_rad = tilt_deg.to_radians();
            limits.acceleration_horizontal_m_s2 = 1.0;
            limits.tilt_rate_rad_s *= tilt_rate_share;
            let (mut beyond, mut extremes) = (0.0_f64, Extremes::new());
            let end = fly(&configuration, &goal(goal_m, 0.0), 50.0, |outputs| {
                beyond = beyond.max(overshoot(outputs, goal_m));
                extremes.see(outputs);
            });
            let away_m = distance(&end.outputs(), goal_m);
            let share = extremes.horizontal_speed_m_s / speed_m_s;
            assert!(
                beyond < 0.005 && away_m < 0.001 && share < 1.01,
                "{preset:?} {kind:?} {tilt_deg}: {beyond}, {away_m} m, {share} of the speed"
            );
        }
    }
}

/// Tilts that may turn at a quarter or less of the default rate: a plan that had to keep to that at instants at which the attitude has not answered
/// yet went 0.7, 0.3 and 0.2 m beyond the first three.
#[test]
fn slow_tilts_overshoot_little() {
    use AirframePreset::{Heavy, Iris, Paper};
    for (preset, tilt_rate_rad_s, goal_m) in [
        (Paper, 0.4514, [11.18, -3.06, -2.80]),
        (Heavy, 0.7558, [4.29, -1.42, 4.84]),
        (Iris, 1.213, [-2.72, 0.25, 2.37]),
        (Iris, 1.2324, [-5.39, -42.38, 2.92]),
    ] {
        let mut configuration = Configuration::for_airframe(&preset.airframe()).unwrap();
        configuration.reference.shaping = false;
        configuration.limits.tilt_rate_rad_s = tilt_rate_rad_s;
        let mut beyond = 0.0_f64;
        fly(&configuration, &goal(goal_m, 0.0), 20.0, |outputs| {
            beyond = beyond.max(overshoot(outputs, goal_m))
        });
        assert!(beyond < 0.08, "{preset:?} at {tilt_rate_rad_s} rad/s: {beyond} m");
    }
}

/// A heading that turns as fast as it may does not push the vehicle sideways: with a Crazyflie, which had gone 4.8 m beyond the goal and 5.9 m
/// off the way there, and with one that may turn faster.
#[test]
fn goals_are_reached_straight_while_the_heading_turns() {
    let paper = (AirframePreset::Paper, Some(2.4), 2.0);
    for (preset, yaw_rate_rad_s, turning_rad_s) in [(AirframePreset::Crazyflie, None, 1.3), paper] {
        for kind in KINDS {
            let mut configuration = Configuration::for_airframe(&preset.airframe()).unwrap();
            configuration.controllers.kind = kind;
            configuration.reference.shaping = false;
            let most_rad_s = &mut configuration.limits.yaw_rate_rad_s;
            *most_rad_s = yaw_rate_rad_s.unwrap_or(*most_rad_s);
            let goal_m = [5.0, 0.0, 0.0];
            let inputs = |time_us: u64| {
                let mut inputs = goal(goal_m, turning_rad_s * time_us as f64 / 1e6);
                inputs.reference.yaw_rate_rad_s = turning_rad_s;
                inputs
            };
            let (mut beyond, mut aside) = (0.0_f64, 0.0_f64);
            let end = fly(&configuration, &inputs, 6.0, |outputs| {
                beyond = beyond.max(overshoot(outputs, goal_m));
                aside = aside.max(outputs.position_m.y.abs());
            });
            let away_m = distance(&end.outputs(), goal_m);
            assert!(
                beyond < 0.05 && aside < 0.01 && away_m < 0.02,
                "{preset:?} {kind:?}: {beyond}, {aside}, {away_m} m"
            );
        }
    }
}

/// The speed limit holds between the samples of a slow controller, too: it was broken by a third.
#[test]
fn slow_samples_keep_the_speed_limit() {
    let mut configuration = Configuration::for_airframe(&AirframePreset::Iris.airframe()).unwrap();
    configuration.reference.shaping = false;
    let controllers = &mut configuration.controllers;
    (controllers.position.sample_time_us, controllers.altitude.sample_time_us) = (200_000, 200_000);
    controllers.attitude.sample_time_us = 20_000;
    let goals_m = [[25.0, -20.0, 0.0], [-25.0, 10.0, 0.0], [20.0, 25.0, 0.0], [-20.0, -15.0, 0.0]];
    let inputs = |time_us: u64| goal(goals_m[(time_us as usize / 2_000_000).min(3)], 0.0);
    let mut extremes = Extremes::new();
    fly(&configuration, &inputs, 14.0, |outputs| extremes.see(outputs));
    let share = extremes.horizontal_speed_m_s / configuration.limits.speed_horizontal_m_s;
    assert!(share < 1.03, "{share}");
}

/// So do those of climb, exceeded by 1 % with samples of the fast controller's numbers, and of sink, but for what the rotors' lag adds
/// between two samples.
#[test]
fn slow_samples_keep_the_vertical_speeds() {
    let mut configuration = Configuration::for_airframe(&AirframePreset::Iris.airframe()).unwrap();
    configuration.reference.shaping = false;
    configuration.controllers.altitude.sample_time_us = 200_000;
    for each_s in [1, 3] {
        let down_m = [-20.0, 20.0, -12.0, 15.0, -25.0, 3.0];
        let inputs =
            |time_us: u64| goal([0.0, 0.0, down_m[(time_us as usize / 1_000_000 / each_s) % 6]], 0.0);
        let mut extremes = Extremes::new();
        fly(&configuration, &inputs, 18.0, |outputs| extremes.see(outputs));
        let climb = extremes.climb_m_s / configuration.limits.speed_up_m_s;
        let sink = extremes.sink_m_s / configuration.limits.speed_down_m_s;
        assert!(climb < 1.005 && sink < 1.02, "each {each_s} s: {climb} {sink}");
    }
}

/// A climb is braked by less thrust, of which the lean that brakes the horizontal motion at the same time has its share: they went up to 10 %
/// beyond the goal.
#[test]
fn climbs_leave_thrust_to_brake_with() {
    for (preset, rotor_lag_s, most) in [
        (AirframePreset::Paper, None, 0.01),
        (AirframePreset::Hummingbird, None, 0.01),
        (AirframePreset::Iris, None, 0.025),
        (AirframePreset::Heavy, None, 0.01),
        (AirframePreset::Heavy, Some(0.02), 0.02),
    ] {
        let mut configuration = Configuration::for_airframe(&preset.airframe()).unwrap();
        configuration.reference.shaping = false;
        let lag_s = &mut configuration.airframe.rotor_time_constant_s;
        *lag_s = rotor_lag_s.unwrap_or(*lag_s);
        let goal_m = [5.0, 5.0, -5.0];
        let mut beyond = 0.0_f64;
        let end = fly(&configuration, &goal(goal_m, 0.0), 5.0, |outputs| {
            beyond = beyond.max(overshoot(outputs, goal_m));
        });
        let away_m = distance(&end.outputs(), goal_m);
        assert!(beyond < most && away_m < 0.02, "{preset:?} {rotor_lag_s:?}: {beyond}, {away_m} m");
    }
}

/// Drag brakes a vehicle that stops, too: a plan that does not know of it brakes as if it had a steady wind in its face, and is carried
/// on by a force that fades. The drag of the Iris is 0.37 1/s; slow rotors slow the position loop to as little.
#[test]
fn drag_is_foreseen() {
    let goal_m = [5.0, 0.0, 0.0];
    for drag_1_s in [0.0, 0.2, 0.4] {
        let mut configuration = Configuration::default();
        configuration.reference.shaping = false;
        configuration.airframe.rotor_time_constant_s = 0.1;
        let drag_n_s_m = drag_1_s * configuration.airframe.mass_kg;
        configuration.airframe.drag_n_s_m = [drag_n_s_m; 3];
        let mut beyond = 0.0_f64;
        let end = fly(&configuration, &goal(goal_m, 0.0), 6.0, |outputs| {
            beyond = beyond.max(overshoot(outputs, goal_m));
        });
        let away_m = distance(&end.outputs(), goal_m);
        assert!(beyond < 0.01 && away_m < 0.01, "{drag_1_s} 1/s: {beyond}, {away_m} m");
    }
}

/// Rotors that take two and three times as long to slow down as to speed up: controllers are designed for the mean of both. On a Crazyflie
/// both plans had swung by 120° at a ratio of 2, and faster than twice the limit.
#[test]
fn a_cruise_stays_calm_on_rotors_that_slow_down_slowly() {
    for preset in AirframePreset::ALL {
        for (kind, fall_time_ratio) in
            [(ControllerKind::Lmpc, 2.0), (ControllerKind::Lmpc, 3.0), (ControllerKind::StateSpaceMpc, 2.0)]
        {
            let mut configuration = Configuration::for_airframe(&preset.airframe()).unwrap();
            configuration.controllers.kind = kind;
            configuration.reference.shaping = false;
            configuration.airframe.rotor_spin.fall_time_ratio = fall_time_ratio;
            let limit_m_s = configuration.limits.speed_horizontal_m_s;
            let (mut speeds, mut pitches) = ([f64::MAX, f64::MIN], [f64::MAX, f64::MIN]);
            fly(&configuration, &goal([300.0, 0.0, 0.0], 0.0), 25.0, |outputs| {
                if outputs.time_us > 15_000_000 {
                    for ([least, most], value) in
                        [(&mut speeds, outputs.velocity_m_s.x), (&mut pitches, outputs.attitude_rad.y)]
                    {
                        (*least, *most) = (value.min(*least), value.max(*most));
                    }
                }
            });
            let swing_deg = (pitches[1] - pitches[0]).to_degrees();
            let told = format!("{preset:?} {kind:?} {fall_time_ratio}: {speeds:?} m/s, {swing_deg}°");
            assert!(swing_deg < 0.5 && speeds[1] - speeds[0] < 0.05, "{told}");
            assert!(speeds[0] > 0.75 * limit_m_s && speeds[1] < 1.01 * limit_m_s, "{told}");
        }
    }
}

/// A cruise at the speed limit stays calm after a gust from above of half a second and of half of the weight, under a wrong belief in the mass,
/// and on rotors that slow down more slowly than they are taken to: in its last ten seconds. Laguerre MPC had swung by up to 45° for ever
/// where state-space MPC did not, and the gust passed for up to half of the mass.
#[test]
fn a_cruise_stays_calm_whatever_the_model_misses() {
    for preset in AirframePreset::ALL {
        let airframe = preset.airframe();
        for (gust_share, learning, mass_factor, fall_time_ratio) in [
            (0.5, true, 1.0, 1.0),
            (0.5, true, 1.0, 1.5),
            (0.25, true, 1.0, 1.0),
            (0.0, true, 1.5, 1.0),
            (0.0, false, 1.5, 1.0),
            (0.0, false, 0.7, 1.0),
        ] {
            let mut configuration = Configuration::for_airframe(&airframe).unwrap();
            configuration.reference.shaping = false;
            configuration.controllers.learning = learning;
            configuration.controllers.mass_factor = mass_factor;
            configuration.airframe.rotor_spin.fall_time_ratio = fall_time_ratio;
            let calm = goal([1000.0, 0.0, 0.0], 0.0);
            let force_n = Vector3::z() * (gust_share * airframe.weight_n());
            let disturbance = Disturbance { force_n, ..Disturbance::default() };
            let gust = Inputs { disturbance, ..calm };
            let mut simulation = Simulation::new(&configuration, &calm).unwrap();
            simulation.advance_to(15_000_000, &calm).unwrap();
            simulation.advance_to(15_500_000, &gust).unwrap();
            let (mut speeds, mut pitches) = ([f64::MAX, f64::MIN], [f64::MAX, f64::MIN]);
            for time_us in (50_000_000..60_000_000).step_by(20_000) {
                simulation.advance_to(time_us, &calm).unwrap();
                let outputs = simulation.outputs();
                for ([least, most], value) in
                    [(&mut speeds, outputs.velocity_m_s.xy().norm()), (&mut pitches, outputs.attitude_rad.y)]
                {
                    (*least, *most) = (value.min(*least), value.max(*most));
                }
            }
            let believed = simulation.control().belief().mass_kg / airframe.mass_kg;
            let swing_deg = (pitches[1] - pitches[0]).to_degrees();
            let told = format!(
                "{preset:?} {gust_share} {learning} {mass_factor} {fall_time_ratio}: {speeds:?} m/s, {swing_deg}°, {believed}"
            );
            assert!(speeds[0] > 7.9 && speeds[1] < 8.1 && swing_deg < 2.5, "{told}");
            assert!(!learning || (believed - 1.0).abs() < 0.02, "{told}");
        }
    }
}
