//! How the sticks of a pilot are flown.

use serde::{Deserialize, Serialize};

/// Parameters of the modes that are flown with sticks.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StickSettings {
    /// Lean angle of a full stick, rad.
    pub lean_rad: f64,
    /// Rate of turn of a full stick, rad/s.
    pub turn_rad_s: f64,
    /// Share of a stick's way around its centre that means zero where sticks command a velocity (MPC_HOLD_DZ). ArduPilot's channels have
    /// dead zones of their own, and sticks none.
    #[serde(default = "tenth")]
    pub dead_zone: f64,
    /// What the throttle does besides, as ArduPilot's parameter adds it up (PILOT_THR_BHV).
    #[serde(default)]
    pub throttle_behaviour: u8,
    /// Whether roll, pitch and yaw move the place of a landing (ArduPilot: LAND_REPOSITION).
    #[serde(default)]
    pub move_landings: bool,
    /// Vertical acceleration, m/s².
    pub climb_m_s2: f64,
    /// Share of the throttle's way above and below its middle that means no climb (THR_DZ).
    pub throttle_dead_zone: f64,
    /// Share of the largest thrust at the lowest throttle in the air (MPC_MANTHR_MIN).
    pub least_thrust: f64,
    /// Whether a centred throttle hovers (MPC_THR_CURVE = 0).
    pub hovers_centred: bool,
    /// Roll rate of a full stick in acrobatic flight, rad/s.
    pub roll_rad_s: f64,
    /// Pitch rate of a full stick in acrobatic flight, rad/s.
    pub pitch_rad_s: f64,
    /// Yaw rate of a full stick in acrobatic flight, rad/s.
    pub spin_rad_s: f64,
    /// How much gentler the middle of a stick is in acrobatic flight, 0 to 1.
    pub exponent: f64,
    /// Help of acrobatic flight.
    pub trainer: Trainer,
    /// How fast the trainer levels, 1/s.
    pub levelling_1_s: f64,
}

/// What helps in acrobatic flight (ACRO_TRAINER).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Trainer {
    /// Nothing.
    Off,
    /// Released sticks level the vehicle.
    Levels,
    /// It levels, and leans no further than the lean angle.
    LevelsAndLimits,
}

/// Records of before it could be chosen have this one.
fn tenth() -> f64 {
    0.1
}

impl Default for StickSettings {
    fn default() -> Self {
        Self::new(false)
    }
}

/// Of the behaviours of the throttle.
const ENDS_LANDINGS: u8 = 2;
const DISARMS_ON_LANDING: u8 = 4;

impl StickSettings {
    /// Whether a high throttle breaks a landing off.
    pub fn high_throttle_ends_landings(&self) -> bool {
        self.throttle_behaviour & ENDS_LANDINGS != 0
    }

    /// Whether a landing by hand ends as the others do.
    pub fn disarms_on_landing(&self) -> bool {
        self.throttle_behaviour & DISARMS_ON_LANDING != 0
    }

    /// The defaults of both autopilots.
    pub fn new(ardupilot: bool) -> Self {
        if ardupilot {
            return Self {
                lean_rad: 30.0_f64.to_radians(),
                turn_rad_s: 202.5_f64.to_radians(),
                dead_zone: 0.0,
                throttle_behaviour: 0,
                move_landings: true,
                climb_m_s2: 2.5,
                throttle_dead_zone: 0.1,
                least_thrust: 0.0,
                hovers_centred: true,
                roll_rad_s: 360.0_f64.to_radians(),
                pitch_rad_s: 360.0_f64.to_radians(),
                spin_rad_s: 202.5_f64.to_radians(),
                exponent: 0.3,
                trainer: Trainer::LevelsAndLimits,
                levelling_1_s: 1.0,
            };
        }
        Self {
            lean_rad: 35.0_f64.to_radians(),
            turn_rad_s: 150.0_f64.to_radians(),
            dead_zone: tenth(),
            throttle_behaviour: 0,
            move_landings: false,
            climb_m_s2: 3.0,
            throttle_dead_zone: 0.05,
            least_thrust: 0.08,
            hovers_centred: true,
            roll_rad_s: 100.0_f64.to_radians(),
            pitch_rad_s: 100.0_f64.to_radians(),
            spin_rad_s: 100.0_f64.to_radians(),
            exponent: 0.0,
            trainer: Trainer::Off,
            levelling_1_s: 1.0,
        }
    }
}
