//! Published airframes.

use serde::{Deserialize, Serialize};

use crate::plant::airframe::{Airframe, GRAVITY_M_S2};
use crate::plant::rotor_layout::RotorLayout;

/// An airframe with published parameters.
///
/// | constant | crazyflie | hummingbird | iris | heavy |
/// | --- | --- | --- | --- | --- |
/// | mass, kg | 0.028 \[1\] | 0.716 \[4\] | 1.52 \[5\] | 10.0 \[6\] |
/// | arm, m | 0.046 \[1\] | 0.17 \[4\] | 0.13 forward, 0.22 and 0.20 sideways \[5\] | 0.52 \[6\] |
/// | layout | "X", front right turns counterclockwise | "+", front turns clockwise | as "X" | "X", front right turns counterclockwise |
/// | J, kg·m² | 16.57, 16.66, 29.26 e-6 \[1\] | 0.007, 0.007, 0.012 \[4\] | 0.029125, 0.029125, 0.055225 \[5\] | 0.303755, 0.27722, 0.469164 \[6\] |
/// | k₁, N·s² | 2.880e-8 \[2\] | 8.54858e-6 \[4\] | 5.84e-6 \[5\] | 2.4407e-4 \[6\] |
/// | k₂/k₁, m | 0.005964552 \[1\] | 0.016 \[4\] | 0.016 \[4\], see below | 0.044148 \[6\] |
/// | ω max, rad/s | 2269 \[2\] | 838 \[4\] | 1100 \[5\] | 600 \[6\] |
/// | rotor lag, s | 0.072 \[3\] | 0.025 \[4\] | 0.025 \[5\] | 0.036, see below |
/// | drag in hover, N·s/m | 0.0057, z 0.0064 \[1\] | 0.146 \[4\] | 0.559 \[5\] | 0.103 \[6\] |
///
/// Sources:
///
/// 1. J. Förster: System Identification of the Crazyflie 2.0 Nano Quadrocopter, bachelor thesis, ETH Zürich 2015. The
///    products of inertia, up to a tenth of J_x, are left out; drag is 9.1785e-7 (z 10.311e-7) N·s/m per rad/s of all rotors.
/// 2. C. Luis, J. Le Ny: Design of a Trajectory Tracking Controller for a Nanoquadcopter, arXiv:1608.05786, 2016: 3.1582e-10 N
///    per squared rpm, 0.2685 · 65535 + 4070.3 rpm at full PWM. The thrust is then 60 g, as Bitcraze measures it.
/// 3. S. Folk, J. Paulos, V. Kumar: RotorPy, 2023, `crazyflie_params.py`. The motors have brushes and do not brake.
/// 4. F. Furrer, M. Burri, M. Achtelik, R. Siegwart: RotorS – A Modular Gazebo MAV Simulator Framework, 2016, with the
///    constants of `hummingbird.xacro`: body 0.68 kg and four rotors of 9 g. Drag is 8.06428e-5 N·s/m per rad/s of a rotor.
/// 5. PX4's simulation model of the 3DR Iris, `iris.sdf`: body 1.5 kg and four rotors of 5 g. Drag is 1.75e-4 N·s/m per rad/s.
///    Its moment constant of 0.06 m would let a 10-inch propeller waste 0.7 kW in hover; RotorS has 0.016 m for the same
///    vehicle.
/// 6. LARICS, University of Zagreb: `kopterworx_base.urdf.xacro` of `uav_ros_simulation`, with four 22-inch propellers (APC
///    22x8): body, rotors and sensors 9.05 kg. Here it carries 0.95 kg at the centre of mass. The highest rotor speed is the
///    one that agrees with the hover throttle of the real vehicle.
///
/// Where the source has different time constants for rising and falling speed, 0.0125 and 0.025 s, it is the slower one. \[6\]
/// has 0.0125 s, which is RotorS's value for 10-inch propellers. Rotors that are alike but for their size have inertia
/// and drag torque both in proportion to the fifth power of the diameter, so that the lag goes with 1/ω: from 0.025 s at the
/// Hummingbird's 453 rad/s in hover to 0.036 s at 317 rad/s. Lowest speeds are not published: they are those of a thrust of 4 % of the
/// one in hover, as the paper's airframe has it here.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum AirframePreset {
    /// The vehicle of Chipofya, Lee and Chong 2015: the default of [`Airframe`].
    #[default]
    Paper,
    /// Bitcraze Crazyflie 2.x, 28 g.
    Crazyflie,
    /// AscTec Hummingbird, 0.7 kg.
    Hummingbird,
    /// 3DR Iris, 1.5 kg.
    Iris,
    /// Kopterworx of LARICS with a payload, 10 kg.
    Heavy,
}

/// Thrust of the slowest rotors as a share of the weight: that of the paper's airframe, 50 of 252 rad/s squared.
const IDLE_THRUST_SHARE: f64 = 0.04;

/// One row of the table.
struct Published {
    mass_kg: f64,
    arm_length_m: f64,
    layout: RotorLayout,
    inertia_kg_m2: [f64; 3],
    thrust_coefficient_n_s2: f64,
    /// k₂/k₁.
    moment_arm_m: f64,
    rotor_speed_max_rad_s: f64,
    rotor_time_constant_s: f64,
    /// Horizontal and vertical drag per speed and per speed of each rotor, N·s/m per rad/s.
    rotor_drag: [f64; 2],
}

impl Published {
    fn airframe(&self) -> Airframe {
        let hover_rad_s = libm::sqrt(self.mass_kg * GRAVITY_M_S2 / (4.0 * self.thrust_coefficient_n_s2));
        let [horizontal, vertical] = self.rotor_drag.map(|drag| 4.0 * drag * hover_rad_s);
        Airframe {
            mass_kg: self.mass_kg,
            arm_length_m: self.arm_length_m,
            layout: self.layout,
            inertia_kg_m2: self.inertia_kg_m2,
            thrust_coefficient_n_s2: self.thrust_coefficient_n_s2,
            torque_coefficient_n_m_s2: self.moment_arm_m * self.thrust_coefficient_n_s2,
            rotor_speed_min_rad_s: libm::sqrt(IDLE_THRUST_SHARE) * hover_rad_s,
            rotor_speed_max_rad_s: self.rotor_speed_max_rad_s,
            rotor_time_constant_s: self.rotor_time_constant_s,
            drag_n_s_m: [horizontal, horizontal, vertical],
            // The optional physics stay off.
            ..Airframe::default()
        }
    }
}

impl AirframePreset {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Paper, Self::Crazyflie, Self::Hummingbird, Self::Iris, Self::Heavy];

    /// Its name: `paper`, `crazyflie`, `hummingbird`, `iris` or `heavy`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::Crazyflie => "crazyflie",
            Self::Hummingbird => "hummingbird",
            Self::Iris => "iris",
            Self::Heavy => "heavy",
        }
    }

    /// The preset of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|preset| preset.name() == name)
    }

    /// What it is, for a person.
    pub const fn description(self) -> &'static str {
        match self {
            Self::Paper => "Vehicle of Chipofya, Lee and Chong 2015, 0.7 kg",
            Self::Crazyflie => "Bitcraze Crazyflie 2.x, 28 g",
            Self::Hummingbird => "AscTec Hummingbird, 0.7 kg",
            Self::Iris => "3DR Iris, 1.5 kg",
            Self::Heavy => "Kopterworx with 22-inch propellers and a payload, 10 kg",
        }
    }

    /// Its constants.
    pub fn airframe(self) -> Airframe {
        match self {
            Self::Paper => Airframe::default(),
            Self::Crazyflie => crazyflie().airframe(),
            Self::Hummingbird => hummingbird().airframe(),
            Self::Iris => iris().airframe(),
            Self::Heavy => heavy().airframe(),
        }
    }
}

fn crazyflie() -> Published {
    // From N per squared rpm.
    let rad_s_per_rpm = core::f64::consts::TAU / 60.0;
    Published {
        mass_kg: 0.028,
        arm_length_m: 0.046,
        layout: RotorLayout::x().reversed(),
        inertia_kg_m2: [16.571_710e-6, 16.655_602e-6, 29.261_652e-6],
        thrust_coefficient_n_s2: 3.1582e-10 / (rad_s_per_rpm * rad_s_per_rpm),
        moment_arm_m: 0.005_964_552,
        rotor_speed_max_rad_s: (0.2685 * 65_535.0 + 4070.3) * rad_s_per_rpm,
        rotor_time_constant_s: 0.072,
        rotor_drag: [9.1785e-7, 10.311e-7],
    }
}

fn hummingbird() -> Published {
    Published {
        mass_kg: 0.68 + 4.0 * 0.009,
        arm_length_m: 0.17,
        layout: RotorLayout::plus(),
        inertia_kg_m2: [0.007, 0.007, 0.012],
        thrust_coefficient_n_s2: 8.548_58e-6,
        moment_arm_m: 0.016,
        rotor_speed_max_rad_s: 838.0,
        rotor_time_constant_s: 0.025,
        rotor_drag: [8.064_28e-5, 0.0],
    }
}

fn iris() -> Published {
    // The unit of the layout: from the centre of mass to the front rotors.
    let arm_length_m = libm::hypot(0.13, 0.22);
    let places = [[0.13, 0.22], [-0.13, 0.20], [-0.13, -0.20], [0.13, -0.22]];
    Published {
        mass_kg: 1.5 + 4.0 * 0.005,
        arm_length_m,
        layout: RotorLayout::alternating(places.map(|place| place.map(|metres| metres / arm_length_m)))
            .reversed(),
        inertia_kg_m2: [0.029_125, 0.029_125, 0.055_225],
        thrust_coefficient_n_s2: 5.84e-6,
        moment_arm_m: 0.016,
        rotor_speed_max_rad_s: 1100.0,
        rotor_time_constant_s: 0.025,
        rotor_drag: [1.75e-4, 0.0],
    }
}

fn heavy() -> Published {
    Published {
        mass_kg: 10.0,
        arm_length_m: 0.52,
        layout: RotorLayout::x().reversed(),
        inertia_kg_m2: [0.303_755, 0.277_22, 0.469_164],
        thrust_coefficient_n_s2: 2.440_724_623_743_665e-4,
        moment_arm_m: 0.044_148_079_282_817,
        rotor_speed_max_rad_s: 600.0,
        rotor_time_constant_s: 0.036,
        rotor_drag: [8.064_28e-5, 0.0],
    }
}

#[cfg(test)]
mod tests {
    use super::AirframePreset;
    use crate::{Airframe, Mixer};

    /// What others say of the same vehicles: speed of the rotors in hover, rad/s, and thrust to weight.
    #[test]
    fn hover_speeds_and_thrusts_are_the_published_ones() {
        for (preset, hover_rad_s, thrust_to_weight, tolerance) in [
            // Table 1 of the paper with the choices beside it: √(6.864655 / 1.08e-4), 21.87 N.
            (AirframePreset::Paper, 252.11, 3.186, 0.001),
            // 16073 rpm at 33 g (Luis and Le Ny): 14805 rpm at 28 g; 2.25 at 27 g (gym-pybullet-drones, cf2x.urdf).
            (AirframePreset::Crazyflie, 1550.4, 2.17, 0.01),
            // RotorS: 24.01 N for 0.716 kg.
            (AirframePreset::Hummingbird, 453.2, 3.42, 0.01),
            // PX4: 28.27 N for 1.52 kg.
            (AirframePreset::Iris, 798.8, 1.90, 0.01),
            // LARICS measured 301.5 rad/s at 9.05 kg, and 4.0 times the weight of 9 kg at 600 rad/s.
            (AirframePreset::Heavy, 301.5 * 1.051_18, 4.0 * 0.9, 0.02),
        ] {
            let airframe = preset.airframe();
            let near = |value: f64, expected: f64| libm::fabs(value / expected - 1.0) < tolerance;
            let found = airframe.hover_rotor_speed_rad_s();
            assert!(near(found, hover_rad_s), "{preset:?}: {found} rad/s");
            let found = airframe.hover_thrust_share().recip();
            assert!(near(found, thrust_to_weight), "{preset:?}: {found}");
        }
    }

    /// Bitcraze's Crazyflie lifts about 60 g at full power.
    #[test]
    fn the_crazyflie_lifts_what_bitcraze_measures() {
        let (_, strongest_n) = AirframePreset::Crazyflie.airframe().thrust_range_n();
        assert!((0.055..0.063).contains(&(strongest_n / crate::GRAVITY_M_S2)), "{strongest_n}");
    }

    #[test]
    fn every_preset_is_a_rigid_body_with_rotors_that_control_it() {
        for preset in AirframePreset::ALL {
            let airframe = preset.airframe();
            let [x, y, z] = airframe.inertia_kg_m2;
            // Of any body, two moments of inertia together are at least the third.
            assert!(x + y >= z && y + z >= x && z + x >= y, "{preset:?}");
            assert!(Mixer::new(&airframe).is_ok(), "{preset:?}");
            assert!(airframe.rotor_speed_min_rad_s < 0.3 * airframe.hover_rotor_speed_rad_s());
        }
        assert_eq!(AirframePreset::default().airframe(), Airframe::default());
    }

    #[test]
    fn presets_are_found_by_their_names() {
        for preset in AirframePreset::ALL {
            assert_eq!(AirframePreset::from_name(preset.name()), Some(preset));
        }
        assert_eq!(AirframePreset::from_name("Crazyflie"), None);
    }
}
