//! Another aircraft, as its transponder tells.

use nalgebra::Vector3;

/// What is known of an aircraft.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aircraft {
    /// Its address: 24 bits of the International Civil Aviation Organization, or a number that stands for a name.
    pub id: u32,
    /// What it calls itself, filled up with zeros.
    pub callsign: [u8; 9],
    /// Kind of aircraft: emitter category of ADS-B.
    pub category: u8,
    /// Where it was, NED, m.
    pub position_m: Vector3<f64>,
    /// How it moves, NED, m/s.
    pub velocity_m_s: Vector3<f64>,
    /// When it was heard, µs.
    pub heard_us: u64,
    /// Whether it is one of the simulation's own.
    pub simulated: bool,
}

impl Aircraft {
    /// Where it is now, NED, m, if it flew on.
    pub fn position_at_m(&self, time_us: u64) -> Vector3<f64> {
        self.position_m + self.velocity_m_s * self.age_s(time_us)
    }

    /// How long ago it was heard, s.
    pub fn age_s(&self, time_us: u64) -> f64 {
        time_us.saturating_sub(self.heard_us) as f64 / 1e6
    }

    /// What people call it: its callsign, else its address.
    pub fn name(&self) -> String {
        let letters = self.callsign.iter().take_while(|letter| letter.is_ascii_graphic());
        let name: String = letters.map(|letter| char::from(*letter)).collect();
        if name.is_empty() { format!("{:06X}", self.id) } else { name }
    }
}
