//! A lithium-polymer pack whose voltage the motors follow.

use serde::{Deserialize, Serialize};

use crate::Airframe;
use crate::plant::differentiation::real::{Real, Valued};
use crate::plant::events::branches::{Branches, ByValue};
use crate::plant::events::switch::Switch;

/// Share of the electric power that becomes mechanical power of the rotors.
const DRIVE_EFFICIENCY: f64 = 0.75;

/// A battery: a voltage source that falls as it is drained, behind a resistance (the Rint model: He, Xiong, Fan 2011,
/// "Evaluation of lithium-ion battery equivalent circuit models for state of charge estimation by an experimental approach").
///
/// With sag, a rotor goes to its commanded speed times U/U₀, U being the voltage at the terminals under load and U₀ that of
/// the full pack at rest: speed controllers without a speed loop set a share of the voltage, to which a motor's speed is
/// proportional. Without sag the pack is ideal: it stays full, and its voltage does not give way.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BatteryPack {
    /// Whether the rotors' speeds follow the voltage, and the pack is drained.
    pub sag: bool,
    /// U₀, voltage of the full pack without load, V.
    pub voltage_v: f64,
    /// Resistance inside the pack and on the way to the motors, Ω.
    pub resistance_ohm: f64,
    /// Charge of the full pack, A·s.
    pub capacity_a_s: f64,
}

/// Three cells with 2.2 A·h, which fly the default airframe for half an hour, and 10 mΩ per cell, usual for such a pack.
impl Default for BatteryPack {
    fn default() -> Self {
        Self { sag: false, voltage_v: 12.6, resistance_ohm: 0.03, capacity_a_s: 7920.0 }
    }
}

/// What a battery gives.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct BatteryOutput<T = f64> {
    /// Voltage at the terminals, V.
    pub voltage_v: T,
    /// Current to the motors, A.
    pub current_a: T,
    /// Remaining share of the charge, 0 to 1.
    pub remaining: T,
}

/// Remaining share of the charge at the knee of the voltage.
const KNEE: f64 = 0.1;

/// Voltage of a lithium-polymer cell without load, V, by the remaining share of its charge: 4.2 V full, 3.7 V at the knee of
/// a tenth, 3.3 V empty.
pub fn cell_voltage_v(remaining: f64) -> f64 {
    cell_voltage(remaining, remaining > KNEE)
}

fn cell_voltage<T: Real>(remaining: T, above_knee: bool) -> T {
    if above_knee { (remaining - KNEE) * 0.5 / 0.9 + 3.7 } else { remaining * 0.4 / KNEE + 3.3 }
}

impl BatteryPack {
    /// Share of its commanded speed that a rotor goes to at a voltage, V.
    pub fn speed_share<T: Real>(&self, voltage_v: T) -> T {
        if self.sag { voltage_v / self.voltage_v } else { T::one() }
    }

    /// What the pack gives to a load of `power_w` when `discharge` of its charge is drawn.
    ///
    /// U I = P and U = U_oc − R I make U = (U_oc + √(U_oc² − 4 R P))/2. A pack gives no more than U_oc²/4R; beyond that the
    /// voltage stays at half, and the current at what goes with it.
    pub fn output<T: Valued>(&self, power_w: T, discharge: T) -> BatteryOutput<T> {
        self.output_in(power_w, discharge, &mut ByValue)
    }

    /// The same, with its branches chosen.
    pub(crate) fn output_in<T: Real>(
        &self,
        power_w: T,
        discharge: T,
        branches: &mut impl Branches<T>,
    ) -> BatteryOutput<T> {
        if !self.sag {
            let voltage_v = T::constant(self.voltage_v);
            return BatteryOutput { voltage_v, current_a: power_w / self.voltage_v, remaining: T::one() };
        }
        let remaining = self.remaining(discharge, branches);
        let above_knee = branches.exceeds(Switch::AboveKnee, remaining, T::constant(KNEE), 1.0);
        let open_v = cell_voltage(remaining, above_knee) * self.voltage_v / cell_voltage_v(1.0);
        let (open_squared, taken) = (open_v * open_v, power_w * (4.0 * self.resistance_ohm));
        let usual_squared = self.voltage_v * self.voltage_v;
        let overloaded = branches.exceeds(Switch::Overloaded, taken, open_squared, usual_squared);
        // Not beyond the bound in either mode: there is no root there.
        let root = if overloaded { T::zero() } else { (open_squared - taken).at_least(0.0).sqrt() };
        let voltage_v = (open_v + root) / 2.0;
        let strongest_w = open_squared / (4.0 * self.resistance_ohm);
        let drawn_w = strongest_w.where_greater(power_w, power_w, strongest_w);
        BatteryOutput { voltage_v, current_a: drawn_w / voltage_v, remaining }
    }

    /// Remaining share of the charge, between nothing and all.
    fn remaining<T: Real>(&self, discharge: T, branches: &mut impl Branches<T>) -> T {
        if branches.exceeds(Switch::Empty, discharge, T::one(), 1.0) {
            return T::zero();
        }
        // Nothing charges the pack: it does not come here from below.
        T::zero().where_greater(discharge, T::one(), -discharge + 1.0)
    }
}

impl Airframe {
    /// Electric power of rotors at these speeds, W: P = Σ k₂ Ω² Ω, drag torque times speed, over the efficiency of the drive.
    pub fn electric_power_w<T: Real>(&self, rotor_speed_rad_s: &[T; 4]) -> T {
        let k2 = self.torque_coefficient_n_m_s2;
        let powers_w = rotor_speed_rad_s.map(|speed| speed * k2 * speed * speed.abs());
        powers_w.into_iter().fold(T::zero(), |sum, power| sum + power) / DRIVE_EFFICIENCY
    }

    /// Largest resistance of the battery, Ω, with which the full pack still turns the rotors in hover with `least` of the
    /// voltage that it has at rest.
    pub(crate) fn largest_resistance_ohm(&self, least: f64) -> f64 {
        let power_w = self.electric_power_w(&[self.hover_rotor_speed_rad_s(); 4]);
        // R = (U₀ − U)/I = (U₀ − U) U/P; most power flows at U = U₀/2.
        let share = least.max(0.5);
        self.battery.voltage_v * self.battery.voltage_v * share * (1.0 - share) / power_w
    }
}

#[cfg(test)]
mod tests {
    use super::{BatteryPack, cell_voltage_v};
    use crate::Airframe;

    const PACK: BatteryPack =
        BatteryPack { sag: true, voltage_v: 12.6, resistance_ohm: 0.1, capacity_a_s: 7200.0 };

    #[test]
    fn voltage_current_and_power_fit_together() {
        for (power, discharge) in [(0.0, 0.0), (100.0, 0.0), (100.0, 0.5), (250.0, 0.95), (10.0, 1.3)] {
            let output = PACK.output(power, discharge);
            let open = 3.0 * cell_voltage_v(f64::max(1.0 - discharge, 0.0));
            assert!((output.voltage_v * output.current_a - power).abs() < 1e-9, "{output:?}");
            assert!((open - 0.1 * output.current_a - output.voltage_v).abs() < 1e-9, "{output:?}");
        }
        // 12.6²/0.4 W is all that there is.
        let most = PACK.output(1e4, 0.0);
        assert!((most.voltage_v - 6.3).abs() < 1e-12 && (most.current_a - 63.0).abs() < 1e-9, "{most:?}");
        let ideal = BatteryPack { sag: false, ..PACK }.output(126.0, 0.7);
        assert_eq!((ideal.voltage_v, ideal.current_a, ideal.remaining), (12.6, 10.0, 1.0));
    }

    #[test]
    fn a_cell_goes_from_four_point_two_volts_over_the_knee_to_three_point_three() {
        for (remaining, voltage) in [(1.0, 4.2), (0.55, 3.95), (0.1, 3.7), (0.05, 3.5), (0.0, 3.3)] {
            assert!((cell_voltage_v(remaining) - voltage).abs() < 1e-12, "{remaining}");
        }
    }

    /// At the largest resistance the voltage in hover is the wanted share.
    #[test]
    fn the_largest_resistance_keeps_the_voltage_in_hover() {
        let mut airframe = Airframe { battery: PACK, ..Airframe::default() };
        // 4 k₂ Ω³ / 0.75 at 252.1146 rad/s
        let power = airframe.electric_power_w(&[airframe.hover_rotor_speed_rad_s(); 4]);
        assert!((power - 51.28).abs() < 0.01, "{power}");
        airframe.battery.resistance_ohm = airframe.largest_resistance_ohm(0.7);
        assert!((airframe.battery.output(power, 0.0).voltage_v / 12.6 - 0.7).abs() < 1e-12);
        airframe.battery.resistance_ohm = airframe.largest_resistance_ohm(0.2);
        assert!((airframe.battery.output(power, 0.0).voltage_v / 12.6 - 0.5).abs() < 1e-7);
    }
}
