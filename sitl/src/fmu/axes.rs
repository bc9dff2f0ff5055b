//! The axes of an FMU's world and body, and how they lie in ours.

use nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

/// Axes by the directions that x, y and z point in; ours are NED and FRD.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Axes {
    /// Its world into NED.
    world: Matrix3<f64>,
    /// Its body into FRD.
    body: Matrix3<f64>,
    /// Where our origin is in its world, m.
    origin_m: Vector3<f64>,
}

impl Default for Axes {
    fn default() -> Self {
        Self { world: Matrix3::identity(), body: Matrix3::identity(), origin_m: Vector3::zeros() }
    }
}

impl Axes {
    /// Axes by letters: N, S, E, W, U, D for the world, F, B, L, R, U, D for the body.
    ///
    /// # Errors
    /// What is allowed.
    pub fn new(world: &str, body: &str, origin_m: [f64; 3]) -> Result<Self, String> {
        let read = |name: &str, given: &str, letters: [&str; 3], example: &str| {
            matrix(given, letters)
                .ok_or_else(|| format!("{name} = {given:?}; allowed are three right-handed axes, the last one up or down: {example}"))
        };
        Ok(Self {
            world: read("world", world, ["NS", "EW", "DU"], "NED, ENU, NWU or another")?,
            body: read("body", body, ["FB", "RL", "DU"], "FRD, FLU or another")?,
            origin_m: origin_m.into(),
        })
    }

    /// A place of its world in NED, m.
    pub fn place_m(&self, theirs_m: Vector3<f64>) -> Vector3<f64> {
        self.world * (theirs_m - self.origin_m)
    }

    /// A place in NED in its world, m.
    pub fn their_place_m(&self, ours_m: Vector3<f64>) -> Vector3<f64> {
        self.world.tr_mul(&ours_m) + self.origin_m
    }

    /// A vector of its world in NED.
    pub fn in_world(&self, theirs: Vector3<f64>) -> Vector3<f64> {
        self.world * theirs
    }

    /// A vector in NED in its world.
    pub fn in_their_world(&self, ours: Vector3<f64>) -> Vector3<f64> {
        self.world.tr_mul(&ours)
    }

    /// A vector of its body in FRD.
    pub fn in_body(&self, theirs: Vector3<f64>) -> Vector3<f64> {
        self.body * theirs
    }

    /// A vector in FRD in its body.
    pub fn in_their_body(&self, ours: Vector3<f64>) -> Vector3<f64> {
        self.body.tr_mul(&ours)
    }

    /// Its attitude, its body into its world, as ours: FRD into NED.
    pub fn attitude(&self, theirs: Quaternion<f64>) -> Quaternion<f64> {
        if self.world == Matrix3::identity() && self.body == Matrix3::identity() {
            return theirs;
        }
        (rotation(&self.world) * UnitQuaternion::new_normalize(theirs) * rotation(&self.body).inverse())
            .into_inner()
    }

    /// Our attitude as its own.
    pub fn their_attitude(&self, ours: UnitQuaternion<f64>) -> UnitQuaternion<f64> {
        rotation(&self.world).inverse() * ours * rotation(&self.body)
    }

    /// Our heading, rad, as its own; it goes on over ±π.
    pub fn their_yaw_rad(&self, yaw_rad: f64) -> f64 {
        let level = self.their_attitude(UnitQuaternion::identity());
        level.euler_angles().2 + self.their_yaw_rate(yaw_rad)
    }

    /// Our rate of the heading as its own: it turns the other way about an axis that points up.
    pub fn their_yaw_rate(&self, rate: f64) -> f64 {
        self.world.m33 * rate
    }
}

fn rotation(matrix: &Matrix3<f64>) -> UnitQuaternion<f64> {
    UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(*matrix))
}

/// Columns are the given axes in ours; each pair of letters is an axis of ours and its opposite.
fn matrix(given: &str, letters: [&str; 3]) -> Option<Matrix3<f64>> {
    let axis = |letter: char| {
        letters.iter().enumerate().find_map(|(axis, pair)| {
            let sign = if pair.starts_with(letter) {
                1.0
            } else if pair.ends_with(letter) {
                -1.0
            } else {
                return None;
            };
            Some(Vector3::from_fn(|row, _| if row == axis { sign } else { 0.0 }))
        })
    };
    let columns: Vec<Vector3<f64>> = given.to_ascii_uppercase().chars().map(axis).collect::<Option<_>>()?;
    let [x, y, z] = columns.as_slice() else { return None };
    let right_handed = x.cross(y) == *z;
    (right_handed && z.z != 0.0).then(|| Matrix3::from_columns(&[*x, *y, *z]))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use nalgebra::{UnitQuaternion, Vector3};

    use super::Axes;

    #[test]
    fn east_north_up_and_forward_left_up_are_what_they_say() {
        let axes = Axes::new("ENU", "flu", [0.0, 0.0, 2.0]).expect("axes");
        assert_eq!(axes.place_m(Vector3::new(1.0, 2.0, 5.0)), Vector3::new(2.0, 1.0, -3.0));
        assert_eq!(axes.their_place_m(Vector3::new(2.0, 1.0, -3.0)), Vector3::new(1.0, 2.0, 5.0));
        assert_eq!(axes.in_body(Vector3::new(1.0, 2.0, 3.0)), Vector3::new(1.0, -2.0, -3.0));
        // North is a quarter turn to the left of east.
        assert!((axes.their_yaw_rad(0.0) - FRAC_PI_2).abs() < 1e-12);
        assert!((axes.their_yaw_rad(FRAC_PI_2) - 0.0).abs() < 1e-12);
        assert!((axes.their_yaw_rad(7.0) - (FRAC_PI_2 - 7.0)).abs() < 1e-12);
        assert_eq!(axes.their_yaw_rate(0.3), -0.3);
        // Nose down by 0.2, heading south-west: by hand through the directions of its axes.
        let ours = UnitQuaternion::from_euler_angles(0.1, -0.2, 2.5);
        let theirs = axes.their_attitude(ours);
        let forward = axes.in_world(theirs * Vector3::x());
        assert!((forward - ours * Vector3::x()).norm() < 1e-12);
        let left = axes.in_world(theirs * Vector3::y());
        assert!((left + ours * Vector3::y()).norm() < 1e-12);
        let back = UnitQuaternion::new_normalize(axes.attitude(theirs.into_inner()));
        assert!(back.angle_to(&ours) < 1e-12);
    }

    #[test]
    fn what_are_no_axes_is_refused() {
        for world in ["", "NE", "NEDU", "NEU", "NND", "DNE", "XYZ"] {
            assert!(Axes::new(world, "FRD", [0.0; 3]).is_err(), "{world}");
        }
        assert!(Axes::new("NWU", "BLU", [0.0; 3]).is_err());
        assert!(Axes::new("NWU", "BRU", [0.0; 3]).is_ok());
    }
}
