//! A lithium-polymer battery that the rotors drain.

use quadrotor::{Airframe, BatteryOutput, cell_voltage_v};

use super::battery_pack::BatteryPack;
use crate::fault::BatteryFault;

/// So often the interval of the charge at a voltage is halved: to the last digit.
const CHARGE_HALVINGS: usize = 60;
/// Below this a cell is not believed to go, V: it bounds the current.
const LOWEST_CELL_V: f64 = 8.0 / 3.0;

/// Capacity of the battery, A·h: that of the pack whose voltage the rotors follow, or else the vehicle's setting.
pub fn capacity_ah(airframe: &Airframe, setting_ah: f64) -> f64 {
    let pack = &airframe.battery;
    if pack.sag { pack.capacity_a_s / 3600.0 } else { setting_ah }
}

/// Voltage of the full battery at rest, V: that of the pack whose voltage the rotors follow, or else of ours.
pub fn full_voltage_v(airframe: &Airframe, battery: &Battery) -> f64 {
    let pack = &airframe.battery;
    if pack.sag { pack.voltage_v } else { cell_voltage_v(1.0) * f64::from(battery.cells()) }
}

/// State of the battery.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Battery {
    pack: BatteryPack,
    /// Drawn since it was full, A·s.
    drawn_as: f64,
    /// Energy drawn, J.
    energy_j: f64,
    current_a: f64,
    /// The true one.
    terminal_v: f64,
    /// What the gauge makes of the voltage.
    voltage_v: f64,
    fault: Option<BatteryFault>,
    /// Remaining share when the gauge got stuck.
    stuck: f64,
}

impl Battery {
    /// A full pack.
    pub fn new(pack: BatteryPack) -> Self {
        let voltage_v = cell_voltage_v(1.0) * f64::from(pack.cells);
        Self {
            pack,
            drawn_as: 0.0,
            energy_j: 0.0,
            current_a: 0.0,
            terminal_v: voltage_v,
            voltage_v,
            fault: None,
            stuck: 1.0,
        }
    }

    /// Cells in series.
    pub fn cells(&self) -> u8 {
        self.pack.cells
    }

    /// `dt_s` of turning rotors. `given` is what the plant's battery gives, if the rotors follow its voltage
    /// ([`BatteryPack::sag`](quadrotor::BatteryPack::sag)); without it the battery is modelled here. Its
    /// capacity is that of whichever it is.
    pub fn step(
        &mut self,
        airframe: &Airframe,
        rotor_speed_rad_s: &[f64; 4],
        given: Option<&BatteryOutput>,
        capacity_ah: f64,
        dt_s: f64,
    ) {
        let (power_w, cells, resistance_ohm) = match given {
            Some(given) => {
                (self.current_a, self.terminal_v) = (given.current_a, given.voltage_v);
                let (voltage_v, resistance_ohm) =
                    (airframe.battery.voltage_v, airframe.battery.resistance_ohm);
                (given.voltage_v * given.current_a, voltage_v / cell_voltage_v(1.0), resistance_ohm)
            }
            None => {
                let cells = f64::from(self.pack.cells);
                let power_w = airframe.electric_power_w(rotor_speed_rad_s) + self.pack.avionics_w;
                let open_v = cell_voltage_v(self.charge(capacity_ah)) * cells;
                self.current_a = power_w / self.terminal_v.max(LOWEST_CELL_V * cells);
                self.terminal_v = open_v - self.current_a * self.pack.resistance_ohm;
                (power_w, cells, self.pack.resistance_ohm)
            }
        };
        self.voltage_v = match self.fault {
            None => self.terminal_v,
            Some(BatteryFault::Stuck) => self.voltage_v,
            Some(BatteryFault::Off | BatteryFault::Wrong) => {
                cell_voltage_v(self.remaining(capacity_ah)) * cells - self.current_a * resistance_ohm
            }
        };
        self.drawn_as = match given {
            Some(given) => (1.0 - given.remaining) * capacity_ah * 3600.0,
            None => self.drawn_as + self.current_a * dt_s,
        };
        self.energy_j += power_w * dt_s;
    }

    /// Charges it, or discharges it, to a voltage at rest, V.
    pub fn charge_to(&mut self, voltage_v: f64, capacity_ah: f64) {
        let cell_v = voltage_v / f64::from(self.pack.cells);
        // The voltage rises with the charge: halve the interval.
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..CHARGE_HALVINGS {
            let middle = 0.5 * (low + high);
            if cell_voltage_v(middle) < cell_v { low = middle } else { high = middle }
        }
        self.drawn_as = (1.0 - high) * capacity_ah * 3600.0;
        self.terminal_v = cell_voltage_v(high) * f64::from(self.pack.cells);
    }

    /// Charges it, or discharges it, to a share of its capacity.
    pub fn refill(&mut self, share: f64, capacity_ah: f64) {
        self.drawn_as = (1.0 - share.clamp(0.0, 1.0)) * capacity_ah * 3600.0;
    }

    /// Voltage without the drop that the current makes, V.
    pub fn resting_voltage_v(&self) -> f64 {
        self.voltage_v + self.current_a * self.pack.resistance_ohm
    }

    /// Breaks, or works again.
    pub fn fail(&mut self, fault: Option<BatteryFault>, capacity_ah: f64) {
        if fault != self.fault {
            self.stuck = self.remaining(capacity_ah);
            self.fault = fault;
        }
    }

    /// Remaining share of the charge, 0 to 1, as the gauge has it.
    pub fn remaining(&self, capacity_ah: f64) -> f64 {
        match self.fault {
            None => self.charge(capacity_ah),
            Some(BatteryFault::Off) => 0.0,
            Some(BatteryFault::Stuck) => self.stuck,
            Some(BatteryFault::Wrong) => self.charge(capacity_ah) * BatteryFault::WRONG_SHARE,
        }
    }

    /// The true one.
    fn charge(&self, capacity_ah: f64) -> f64 {
        (1.0 - self.drawn_as / (3600.0 * capacity_ah)).clamp(0.0, 1.0)
    }

    /// Voltage of the pack, V, as the gauge has it.
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

#[cfg(test)]
mod tests {
    use quadrotor::{Airframe, BatteryOutput};

    use super::{Battery, BatteryPack};
    use crate::fault::BatteryFault;

    #[test]
    fn hovering_lasts_about_half_an_hour_and_idling_longer() {
        let airframe = Airframe::default();
        let minutes = |speed: f64| {
            let mut battery = Battery::new(BatteryPack::default());
            let mut seconds = 0.0;
            while battery.remaining(2.2) > 0.0 {
                battery.step(&airframe, &[speed; 4], None, 2.2, 1.0);
                seconds += 1.0;
            }
            seconds / 60.0
        };
        let hover = minutes(airframe.hover_rotor_speed_rad_s());
        assert!((20.0..40.0).contains(&hover), "{hover}");
        assert!(minutes(airframe.rotor_speed_min_rad_s) > 4.0 * hover);
    }

    /// What the gauge says under each fault, and that it is right again after it.
    #[test]
    fn a_broken_gauge_reads_wrong() {
        let airframe = Airframe::default();
        let mut battery = Battery::new(BatteryPack::default());
        let step = |battery: &mut Battery, fault: Option<BatteryFault>, seconds: usize| {
            for _ in 0..seconds {
                battery.fail(fault, 2.2);
                battery.step(&airframe, &[250.0; 4], None, 2.2, 1.0);
            }
            (battery.remaining(2.2), battery.voltage_v())
        };
        let sound = step(&mut battery, None, 60);
        let (remaining, voltage_v) = step(&mut battery, Some(BatteryFault::Off), 1);
        assert!(remaining == 0.0 && (9.5..9.9).contains(&voltage_v), "3.3 V a cell: {voltage_v}");
        let (remaining, voltage_v) = step(&mut battery, Some(BatteryFault::Wrong), 1);
        assert!(
            (remaining / sound.0 - 0.12).abs() < 0.001 && voltage_v < sound.1 - 1.0,
            "{remaining} {voltage_v}"
        );
        let (recovered, recovered_v) = step(&mut battery, None, 1);
        assert!(recovered < sound.0 && recovered > sound.0 - 0.01 && recovered_v > sound.1 - 0.1);
        let stuck = step(&mut battery, Some(BatteryFault::Stuck), 1);
        assert_eq!(step(&mut battery, Some(BatteryFault::Stuck), 60), stuck);
        assert!(step(&mut battery, None, 1).0 < stuck.0 - 0.01);
    }

    #[test]
    fn thrust_makes_the_voltage_sag() {
        let mut battery = Battery::new(BatteryPack::default());
        let rest = battery.voltage_v();
        battery.step(&Airframe::default(), &[400.0; 4], None, 2.2, 0.001);
        assert!(battery.voltage_v() < rest - 0.1 && battery.current_a() > 5.0);
    }
    /// What the rotors follow is what the gauge shows, faults apart.
    #[test]
    fn the_battery_of_the_plant_is_read() {
        let mut airframe = Airframe::default();
        (airframe.battery.sag, airframe.battery.voltage_v) = (true, 16.8);
        let pack = BatteryOutput { voltage_v: 15.0, current_a: 8.0, remaining: 0.6 };
        let mut battery = Battery::new(BatteryPack::default());
        battery.step(&airframe, &[250.0; 4], Some(&pack), 5.0, 1.0);
        assert_eq!((battery.voltage_v(), battery.current_a(), battery.energy_j()), (15.0, 8.0, 120.0));
        assert!((battery.remaining(5.0) - 0.6).abs() < 1e-12 && (battery.drawn_ah() - 2.0).abs() < 1e-12);
        battery.fail(Some(BatteryFault::Off), 5.0);
        battery.step(&airframe, &[250.0; 4], Some(&pack), 5.0, 1.0);
        // Four empty cells, less 8 A through 30 mΩ.
        assert!((battery.voltage_v() - (4.0 * 3.3 - 0.24)).abs() < 1e-12, "{}", battery.voltage_v());
    }
}
