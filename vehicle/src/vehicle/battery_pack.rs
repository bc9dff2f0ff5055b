//! The battery that an airframe carries.

use quadrotor::Airframe;
use serde::{Deserialize, Serialize};

/// Share of the electric power that becomes mechanical power of the rotors.
const DRIVE_EFFICIENCY: f64 = 0.75;

/// A lithium-polymer pack and what it supplies beside the motors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BatteryPack {
    /// Cells in series.
    pub cells: u8,
    /// Charge when full, A·h.
    pub capacity_ah: f64,
    /// Internal resistance of the whole pack, Ω.
    pub resistance_ohm: f64,
    /// Autopilot and radio, W.
    pub avionics_w: f64,
}

/// That of the paper's airframe: three cells and 2.2 A·h hover for half an hour.
impl Default for BatteryPack {
    fn default() -> Self {
        Self { cells: 3, capacity_ah: 2.2, resistance_ohm: 0.03, avionics_w: 3.0 }
    }
}

/// Cells of a pack for so much electric power in hover, W: more cells keep the current moderate.
const CELLS: [(f64, u8); 4] = [(10.0, 1), (300.0, 3), (500.0, 4), (1200.0, 6)];
/// Cells of a pack for more power than that.
const MOST_CELLS: u8 = 12;

/// Electric power of the motors in hover, W: P = 4 k₂ ω³ over the efficiency.
fn hover_w(airframe: &Airframe) -> f64 {
    let speed = airframe.hover_rotor_speed_rad_s();
    4.0 * airframe.torque_coefficient_n_m_s2 * speed * speed * speed / DRIVE_EFFICIENCY
}

impl BatteryPack {
    /// A pack with which an airframe hovers as long as the paper's does with [`BatteryPack::default`], and whose voltage sags by the
    /// same share.
    pub fn of_airframe(airframe: &Airframe) -> Self {
        let known = Self::default();
        let power_w = hover_w(airframe);
        let cells =
            CELLS.iter().find(|(most_w, _)| power_w <= *most_w).map_or(MOST_CELLS, |(_, cells)| *cells);
        let power = power_w / hover_w(&Airframe::default());
        let voltage = f64::from(cells) / f64::from(known.cells);
        Self {
            cells,
            capacity_ah: known.capacity_ah * power / voltage,
            resistance_ohm: known.resistance_ohm * voltage * voltage / power,
            avionics_w: known.avionics_w * power.min(1.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use quadrotor::{Airframe, AirframePreset};

    use super::BatteryPack;

    #[test]
    fn the_papers_airframe_has_the_default_pack() {
        assert_eq!(BatteryPack::of_airframe(&Airframe::default()), BatteryPack::default());
    }

    /// As sold for vehicles of this size: one cell of some 0.3 A·h, three cells, and twelve of 16 to 22 A·h.
    #[test]
    fn packs_have_the_size_of_the_vehicle() {
        for (preset, cells, capacity_ah) in [
            (AirframePreset::Crazyflie, 1, 0.2..0.6),
            (AirframePreset::Hummingbird, 3, 2.0..4.0),
            (AirframePreset::Iris, 3, 3.5..12.0),
            (AirframePreset::Heavy, 12, 15.0..25.0),
        ] {
            let pack = BatteryPack::of_airframe(&preset.airframe());
            assert_eq!(pack.cells, cells, "{preset:?}: {pack:?}");
            assert!(capacity_ah.contains(&pack.capacity_ah), "{preset:?}: {pack:?}");
        }
    }
}
