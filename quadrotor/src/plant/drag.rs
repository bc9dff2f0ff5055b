//! Drag of the body in the air.

use nalgebra::Vector3;

use crate::plant::airframe::vanish;
use crate::plant::differentiation::real::{Real, constant};
use crate::{Airframe, External, RigidBody};

impl Airframe {
    /// Whether the body drags at all.
    #[inline(always)]
    pub(crate) fn drags(&self) -> bool {
        !(vanish(&self.drag_n_s_m) && vanish(&self.body_drag_n_s_m))
    }

    /// Linear drag of a body in a wind, NED, m/s: force, NED, and torque about the centre of mass, FRD.
    ///
    /// f = −C (v − w) − R D Rᵀ (v − w), along the axes of the world and along those of the body: the second term is the drag
    /// of Faessler, Franchi, Scaramuzza 2018, "Differential flatness of quadrotor dynamics subject to rotor drag for accurate
    /// tracking of high-speed trajectories" (there per mass). It acts at the rotors' centre, whose velocity is v.
    #[inline(always)]
    pub(crate) fn drag<T: Real>(&self, body: &RigidBody<T>, wind_m_s: &Vector3<T>) -> External<T> {
        let mut airspeed = body.velocity_m_s - wind_m_s;
        let centre: Vector3<T> = -constant::<T>(self.centre_of_gravity_m);
        if !self.is_centred() {
            airspeed += body.orientation().in_world(&body.body_rate_rad_s.cross(&centre));
        }
        let mut force_n = -constant::<T>(self.drag_n_s_m).component_mul(&airspeed);
        if !vanish(&self.body_drag_n_s_m) {
            let orientation = body.orientation();
            let along_body = orientation.in_body(&airspeed);
            force_n -= orientation.in_world(&constant::<T>(self.body_drag_n_s_m).component_mul(&along_body));
        }
        let torque_n_m = if self.is_centred() {
            Vector3::zeros()
        } else {
            centre.cross(&body.orientation().in_body(&force_n))
        };
        External { force_n, torque_n_m }
    }

    /// All drag of the vehicle, per speed through the air along north, east and down, N·s/m, when it hovers level and heads
    /// north: that of the body, and that of rotors that carry the weight.
    pub fn hover_drag_n_s_m(&self) -> [f64; 3] {
        let rotors = &self.rotor_aerodynamics;
        let turning_rad_s = 4.0 * self.hover_rotor_speed_rad_s();
        let [lateral, axial] = [rotors.drag_coefficient_n_s2_m, rotors.inflow_coefficient_n_s2_m]
            .map(|coefficient| coefficient * turning_rad_s);
        let of_rotors = [lateral, lateral, axial];
        core::array::from_fn(|axis| self.drag_n_s_m[axis] + self.body_drag_n_s_m[axis] + of_rotors[axis])
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{UnitQuaternion, Vector3};

    use crate::{Airframe, RigidBody, RotorAerodynamics};

    fn body(velocity_m_s: [f64; 3], (roll, pitch, yaw): (f64, f64, f64)) -> RigidBody {
        RigidBody {
            position_m: Vector3::zeros(),
            velocity_m_s: velocity_m_s.into(),
            attitude: UnitQuaternion::from_euler_angles(roll, pitch, yaw).into_inner(),
            body_rate_rad_s: Vector3::zeros(),
        }
    }

    /// A tail wind pushes, a head wind brakes: −c (v − w), each axis with its own coefficient.
    #[test]
    fn drag_is_that_of_the_motion_through_the_air() {
        let airframe = Airframe { drag_n_s_m: [0.1, 0.2, 0.4], ..Airframe::default() };
        let wind = Vector3::new(5.0, -5.0, 1.0);
        for attitude in [(0.0, 0.0, 0.0), (0.4, -0.2, 2.0)] {
            let drag = airframe.drag(&body([2.0, 5.0, -4.0], attitude), &wind);
            let expected = Vector3::new(0.1 * 3.0, -0.2 * 10.0, 0.4 * 5.0);
            assert!((drag.force_n - expected).norm() < 1e-14);
            assert_eq!(drag.torque_n_m, Vector3::zeros());
        }
    }

    /// Heading east, its forward is the world's east; pitched up by 90°, its down is the world's north.
    #[test]
    fn drag_along_body_axes_turns_with_the_body() {
        let airframe = Airframe { body_drag_n_s_m: [0.1, 0.2, 0.4], ..Airframe::default() };
        let quarter = core::f64::consts::FRAC_PI_2;
        for (attitude, along) in [
            ((0.0, 0.0, 0.0), [0.1, 0.2, 0.4]),
            ((0.0, 0.0, quarter), [0.2, 0.1, 0.4]),
            ((0.0, quarter, 0.0), [0.4, 0.2, 0.1]),
            ((quarter, 0.0, 0.0), [0.1, 0.4, 0.2]),
        ] {
            let velocity = [3.0, -2.0, 5.0];
            let drag = airframe.drag(&body(velocity, attitude), &Vector3::zeros());
            let expected = -Vector3::from(along).component_mul(&Vector3::from(velocity));
            assert!((drag.force_n - expected).norm() < 1e-14, "{attitude:?}: {}", drag.force_n);
        }
    }

    /// The centre of mass 0.1 m ahead and 0.2 m below: a head wind on the rotors' centre, behind and above it, pitches up.
    #[test]
    fn drag_acts_at_the_centre_of_the_rotors() {
        let airframe =
            Airframe { drag_n_s_m: [0.5; 3], centre_of_gravity_m: [0.1, 0.0, 0.2], ..Airframe::default() };
        let mut moving = body([4.0, 0.0, 0.0], (0.0, 0.0, 0.0));
        let drag = airframe.drag(&moving, &Vector3::zeros());
        assert!((drag.force_n - Vector3::new(-2.0, 0.0, 0.0)).norm() < 1e-15);
        assert!((drag.torque_n_m - Vector3::new(0.0, 0.4, 0.0)).norm() < 1e-15, "{}", drag.torque_n_m);
        // Turning to the right with 3 rad/s, a point behind moves to the left.
        moving.body_rate_rad_s.z = 3.0;
        assert!((airframe.drag(&moving, &Vector3::zeros()).force_n.y - 0.5 * 0.3).abs() < 1e-15);
    }

    #[test]
    fn drag_in_hover_adds_up() {
        let rotor_aerodynamics = RotorAerodynamics {
            drag_coefficient_n_s2_m: 1e-4,
            inflow_coefficient_n_s2_m: 3e-4,
            ..RotorAerodynamics::default()
        };
        let airframe = Airframe {
            drag_n_s_m: [0.1, 0.2, 0.3],
            body_drag_n_s_m: [0.01, 0.02, 0.03],
            rotor_aerodynamics,
            ..Airframe::default()
        };
        // 4 · 252.1146 rad/s
        for (drag, expected) in airframe.hover_drag_n_s_m().iter().zip([0.210_846, 0.320_846, 0.632_538]) {
            assert!((drag - expected).abs() < 1e-5, "{drag}");
        }
    }
}
