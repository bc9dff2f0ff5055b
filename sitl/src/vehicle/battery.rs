//! A lithium-polymer battery that the rotors drain.

use quadrotor::Airframe;

/// Cells in series.
pub const CELLS: usize = 3;
/// Share of the electric power that becomes mechanical power of the rotors.
const DRIVE_EFFICIENCY: f64 = 0.75;
/// Autopilot and radio, W.
const AVIONICS_W: f64 = 3.0;
/// Of the whole pack, Ω.
const RESISTANCE_OHM: f64 = 0.03;
/// Below this the pack is not believed to go, V: it bounds the current.
const LOWEST_VOLTAGE_V: f64 = 8.0;

/// State of the battery.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Battery {
    /// Drawn since it was full, A·s.
    drawn_as: f64,
    /// Energy drawn, J.
    energy_j: f64,
    current_a: f64,
    voltage_v: f64,
}

impl Default for Battery {
    fn default() -> Self {
        Self { drawn_as: 0.0, energy_j: 0.0, current_a: 0.0, voltage_v: open_circuit_v(1.0) }
    }
}

impl Battery {
    /// `dt_s` of turning rotors.
    pub fn step(&mut self, airframe: &Airframe, rotor_speed_rad_s: &[f64; 4], capacity_ah: f64, dt_s: f64) {
        // P = Σ k₂ ω² · ω: drag torque times speed.
        let k2 = airframe.torque_coefficient_n_m_s2;
        let mechanical_w: f64 = rotor_speed_rad_s.iter().map(|speed| k2 * speed * speed * speed).sum();
        let power_w = mechanical_w / DRIVE_EFFICIENCY + AVIONICS_W;
        let open_v = open_circuit_v(self.remaining(capacity_ah));
        self.current_a = power_w / self.voltage_v.max(LOWEST_VOLTAGE_V);
        self.voltage_v = open_v - self.current_a * RESISTANCE_OHM;
        self.drawn_as += self.current_a * dt_s;
        self.energy_j += power_w * dt_s;
    }

    /// Remaining share of the charge, 0 to 1.
    pub fn remaining(&self, capacity_ah: f64) -> f64 {
        (1.0 - self.drawn_as / (3600.0 * capacity_ah)).clamp(0.0, 1.0)
    }

    /// Voltage of the pack, V.
    pub fn voltage_v(&self) -> f64 {
        self.voltage_v
    }

    /// Current, A.
    pub fn current_a(&self) -> f64 {
        self.current_a
    }

    /// Charge drawn since it was full, A·h.
    pub fn drawn_ah(&self) -> f64 {
        self.drawn_as / 3600.0
    }

    /// Energy drawn since it was full, J.
    pub fn energy_j(&self) -> f64 {
        self.energy_j
    }

    /// How long the rest lasts at the present current, s.
    pub fn time_remaining_s(&self, capacity_ah: f64) -> f64 {
        self.remaining(capacity_ah) * 3600.0 * capacity_ah / self.current_a.max(1e-3)
    }
}

/// Voltage without load: 4.2 V per full cell, 3.7 V at the knee of a tenth, 3.3 V empty.
fn open_circuit_v(remaining: f64) -> f64 {
    let cell =
        if remaining > 0.1 { 3.7 + 0.5 * (remaining - 0.1) / 0.9 } else { 3.3 + 0.4 * remaining / 0.1 };
    cell * CELLS as f64
}

#[cfg(test)]
mod tests {
    use quadrotor::Airframe;

    use super::Battery;

    #[test]
    fn hovering_lasts_about_half_an_hour_and_idling_longer() {
        let airframe = Airframe::default();
        let minutes = |speed: f64| {
            let mut battery = Battery::default();
            let mut seconds = 0.0;
            while battery.remaining(2.2) > 0.0 {
                battery.step(&airframe, &[speed; 4], 2.2, 1.0);
                seconds += 1.0;
            }
            seconds / 60.0
        };
        let hover = minutes(airframe.hover_rotor_speed_rad_s());
        assert!((20.0..40.0).contains(&hover), "{hover}");
        assert!(minutes(airframe.rotor_speed_min_rad_s) > 4.0 * hover);
    }

    #[test]
    fn thrust_makes_the_voltage_sag() {
        let mut battery = Battery::default();
        let rest = battery.voltage_v();
        battery.step(&Airframe::default(), &[400.0; 4], 2.2, 0.001);
        assert!(battery.voltage_v() < rest - 0.1 && battery.current_a() > 5.0);
    }
}
