//! The true motion, as PX4's simulators report it.

use mavlink::dialects::ardupilotmega::{HIL_STATE_QUATERNION_DATA, MavMessage};
use nalgebra::Vector3;
use quadrotor::GRAVITY_M_S2;
use vehicle::estimation::TrueMotion;
use vehicle::world::Geodetic;

use super::{centimetres_per_second, floats, millimetres, scaled_degrees};

/// HIL_STATE_QUATERNION: the true motion at a place in a wind, NED, m/s. Its acceleration is along the body's axes, in thousandths of the standard
/// gravity, as Gazebo reports it.
pub fn hil_state_quaternion(motion: &TrueMotion, place: &Geodetic, wind_m_s: &Vector3<f64>) -> MavMessage {
    let q = motion.attitude;
    let gravity = q.inverse_transform_vector(&Vector3::new(0.0, 0.0, GRAVITY_M_S2));
    let acceleration_mg = (motion.specific_force_m_s2 + gravity) * (1e3 / GRAVITY_M_S2);
    let [rollspeed, pitchspeed, yawspeed] = floats(&motion.body_rate_rad_s);
    // Beyond the range of a field a cast gives its end.
    let [vx, vy, vz] = motion.velocity_m_s.data.0[0].map(centimetres_per_second);
    let [xacc, yacc, zacc] = acceleration_mg.data.0[0].map(|value| value.round() as i16);
    let airspeed = ((motion.velocity_m_s - wind_m_s).norm() * 1e2).round() as u16;
    MavMessage::HIL_STATE_QUATERNION(HIL_STATE_QUATERNION_DATA {
        time_usec: motion.time_us,
        attitude_quaternion: [q.w as f32, q.i as f32, q.j as f32, q.k as f32],
        rollspeed,
        pitchspeed,
        yawspeed,
        lat: scaled_degrees(place.latitude_deg),
        lon: scaled_degrees(place.longitude_deg),
        alt: millimetres(place.altitude_m),
        vx,
        vy,
        vz,
        ind_airspeed: airspeed,
        true_airspeed: airspeed,
        xacc,
        yacc,
        zacc,
    })
}

#[cfg(test)]
mod tests {
    use core::f64::consts::FRAC_PI_2;

    use mavlink::dialects::ardupilotmega::MavMessage;
    use nalgebra::{UnitQuaternion, Vector3};
    use quadrotor::GRAVITY_M_S2;
    use vehicle::estimation::TrueMotion;
    use vehicle::world::Geodetic;

    use super::hil_state_quaternion;

    /// A level vehicle with its nose to the east is accelerated to the north, which is to its left.
    #[test]
    fn the_acceleration_is_along_the_axes_of_the_body() {
        let motion = TrueMotion {
            time_us: 1_000,
            position_m: Vector3::zeros(),
            velocity_m_s: Vector3::new(1.0, -2.0, 400.0),
            attitude: UnitQuaternion::from_euler_angles(0.0, 0.0, FRAC_PI_2),
            body_rate_rad_s: Vector3::zeros(),
            specific_force_m_s2: Vector3::new(0.0, -0.1, -1.0) * GRAVITY_M_S2,
        };
        let origin = Geodetic { latitude_deg: 47.0, longitude_deg: 8.0, altitude_m: 400.0 };
        let told = hil_state_quaternion(&motion, &origin, &Vector3::new(0.0, 0.0, 400.0));
        let MavMessage::HIL_STATE_QUATERNION(told) = told else { panic!("{told:?}") };
        assert_eq!([told.xacc, told.yacc, told.zacc], [0, -100, 0]);
        assert_eq!([told.vx, told.vy, told.vz], [100, -200, i16::MAX]);
        assert_eq!(
            (told.lat, told.lon, told.alt, told.true_airspeed),
            (470_000_000, 80_000_000, 400_000, 224)
        );
    }
}
