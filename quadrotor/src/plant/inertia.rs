//! The inertia tensor: moments and products of inertia.

use nalgebra::Matrix3;

use crate::Airframe;
use crate::plant::airframe::vanish;

/// How far rounding may carry the largest principal moment beyond the sum of the other two, as a share of that sum: of a
/// flat plate it is exactly the sum.
const TRIANGLE_TOLERANCE: f64 = 1e-9;

impl Airframe {
    /// The inertia tensor about the centre of mass, FRD, kg·m².
    pub fn inertia_tensor_kg_m2(&self) -> Matrix3<f64> {
        let [x, y, z] = self.inertia_kg_m2;
        let [xy, xz, yz] = self.products_of_inertia_kg_m2;
        Matrix3::new(x, xy, xz, xy, y, yz, xz, yz, z)
    }

    /// Principal moments of inertia, kg·m², the smallest one first.
    pub fn principal_moments_kg_m2(&self) -> [f64; 3] {
        let mut moments: [f64; 3] = self.inertia_tensor_kg_m2().symmetric_eigenvalues().into();
        moments.sort_unstable_by(f64::total_cmp);
        moments
    }

    /// Whether a rigid body can have this inertia tensor: its principal moments are positive, and none exceeds the sum of the
    /// other two (Wensing, Kim, Slotine 2018, "Linear matrix inequalities for physically consistent inertial parameter
    /// identification").
    pub(crate) fn has_physical_inertia(&self) -> bool {
        let [smallest, middle, largest] = self.principal_moments_kg_m2();
        smallest > 0.0 && largest <= (1.0 + TRIANGLE_TOLERANCE) * (smallest + middle)
    }

    /// Whether the body axes are the principal axes.
    #[inline]
    pub(crate) fn has_principal_axes(&self) -> bool {
        vanish(&self.products_of_inertia_kg_m2)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Rotation3;
    use proptest::prelude::*;

    use crate::Airframe;

    fn with_inertia(moments: [f64; 3], products: [f64; 3]) -> Airframe {
        Airframe { inertia_kg_m2: moments, products_of_inertia_kg_m2: products, ..Airframe::default() }
    }

    /// The same body in axes that are turned.
    fn turned(moments: [f64; 3], axes: &Rotation3<f64>) -> Airframe {
        let tensor = axes * nalgebra::Matrix3::from_diagonal(&moments.into()) * axes.inverse();
        with_inertia([tensor.m11, tensor.m22, tensor.m33], [tensor.m12, tensor.m13, tensor.m23])
    }

    proptest! {
        #[test]
        fn principal_moments_do_not_depend_on_the_axes(angles in prop::array::uniform3(-3.0..3.0)) {
            let moments = [0.08, 0.11, 0.17];
            let axes = Rotation3::from_euler_angles(angles[0], angles[1], angles[2]);
            let found = turned(moments, &axes).principal_moments_kg_m2();
            prop_assert!(found.iter().zip(moments).all(|(one, other)| (one - other).abs() < 1e-12), "{:?}", found);
        }
    }

    #[test]
    fn only_tensors_of_rigid_bodies_are_physical() {
        assert!(Airframe::default().has_physical_inertia());
        // A flat plate in any axes: J_z = J_x + J_y.
        let plate = turned([0.1, 0.2, 0.1 + 0.2], &Rotation3::from_euler_angles(0.3, -0.7, 1.1));
        assert!(plate.has_physical_inertia() && !plate.has_principal_axes());
        assert!(with_inertia([0.1, 0.1, 0.15], [0.04, 0.0, 0.0]).has_physical_inertia());
        assert!(
            !with_inertia([0.1, 0.1, 0.15], [0.08, 0.0, 0.0]).has_physical_inertia(),
            "0.18 > 0.02 + 0.15"
        );
        assert!(!with_inertia([0.1, 0.1, 0.15], [0.1, 0.0, 0.0]).has_physical_inertia());
        assert!(!with_inertia([0.1, 0.1, 0.15], [0.0, 0.2, 0.0]).has_physical_inertia());
        assert!(!with_inertia([0.1, 0.1, 0.21], [0.0; 3]).has_physical_inertia());
    }
}
