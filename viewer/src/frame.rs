//! What moves, as it goes to browsers: numbers of fixed size, the lowest byte first.
//!
//! | bytes | what |
//! | --- | --- |
//! | 0 | version of the form, 1 |
//! | 1 | number of vehicles |
//! | 2 | bytes per vehicle |
//! | 3 | not used |
//! | 4 | speed of simulation time as it was asked for, f32: 0 is paused, infinity as fast as possible |
//! | 8 | simulation time, s, f64 |
//! | 16 | speed of simulation time as it is, f32 |
//! | 20 | the vehicles |

/// Version of the form.
const VERSION: u8 = 1;
/// Bytes before the vehicles.
const HEADER: usize = 20;
/// Bytes per vehicle.
const STRIDE: usize = 16 + 4 * REALS;
/// Single-precision numbers per vehicle.
const REALS: usize = 30;

/// All vehicles at one instant.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Frame {
    /// Simulated seconds per second that were asked for; 0: paused, infinite: as fast as possible.
    pub speed: f64,
    /// Simulated seconds per second of late.
    pub pace: f64,
    /// Simulation time of the vehicle that is furthest, s.
    pub time_s: f64,
    /// The vehicles, at most 255.
    pub vehicles: Vec<VehicleState>,
}

/// One vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct VehicleState {
    /// System id.
    pub id: u8,
    /// Whether the rotors may turn.
    pub armed: bool,
    /// Whether it stands on the ground.
    pub landed: bool,
    /// Whether its simulation has ended.
    pub lost: bool,
    /// Whether a failsafe acts.
    pub failsafe: bool,
    /// Whether it has crashed.
    pub crashed: bool,
    /// Whether it tracks a place.
    pub tracks: bool,
    /// The controllers: altitude, position, attitude.
    pub solvers: [Solver; 3],
    /// Number of the mission's item that is flown, or will be.
    pub item: u16,
    /// NED, m.
    pub position_m: [f64; 3],
    /// NED, m/s.
    pub velocity_m_s: [f64; 3],
    /// FRD into NED, scalar first.
    pub quaternion: [f64; 4],
    /// FRD, rad/s.
    pub body_rate_rad_s: [f64; 3],
    /// Tracked place, NED, m.
    pub setpoint_m: [f64; 3],
    /// Tracked heading, rad.
    pub setpoint_yaw_rad: f64,
    /// Thrust of all rotors, N.
    pub thrust_n: f64,
    /// The most that there is, N.
    pub strongest_n: f64,
    /// Share of the strongest thrust of each rotor.
    pub rotors: [f64; 4],
    /// Remaining share of the battery.
    pub battery: f64,
    /// V.
    pub voltage_v: f64,
    /// Roll and pitch that the position controller asks for, rad.
    pub tilt_reference_rad: [f64; 2],
    /// Velocity of the air, NED, m/s.
    pub wind_m_s: [f64; 3],
}

/// How one controller came to its last input.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Solver {
    /// 0: optimal, 1: relaxed, 2: out of iterations, 3: held.
    pub status: u8,
    /// Limits that are active.
    pub active: u8,
    /// Iterations.
    pub iterations: u16,
}

impl Frame {
    /// The bytes that browsers read.
    pub fn encode(&self) -> Vec<u8> {
        let count = self.vehicles.len().min(usize::from(u8::MAX));
        let mut bytes = Vec::with_capacity(HEADER + STRIDE * count);
        bytes.extend([VERSION, count as u8, STRIDE as u8, 0]);
        bytes.extend((self.speed as f32).to_le_bytes());
        bytes.extend(self.time_s.to_le_bytes());
        bytes.extend((self.pace as f32).to_le_bytes());
        self.vehicles.iter().take(count).for_each(|vehicle| vehicle.write(&mut bytes));
        bytes
    }
}

impl VehicleState {
    fn write(&self, bytes: &mut Vec<u8>) {
        let flags = [self.armed, self.landed, self.lost, self.failsafe, self.crashed, self.tracks];
        let flags = flags.into_iter().enumerate().fold(0, |bits, (bit, set)| bits | u8::from(set) << bit);
        bytes.extend([self.id, flags]);
        bytes.extend(self.solvers.map(|solver| solver.status));
        bytes.extend(self.solvers.map(|solver| solver.active));
        bytes.extend(self.solvers.iter().flat_map(|solver| solver.iterations.to_le_bytes()));
        bytes.extend(self.item.to_le_bytes());
        let reals = [
            &self.position_m[..],
            &self.velocity_m_s,
            &self.quaternion,
            &self.body_rate_rad_s,
            &self.setpoint_m,
            &[self.setpoint_yaw_rad, self.thrust_n, self.strongest_n],
            &self.rotors,
            &[self.battery, self.voltage_v],
            &self.tilt_reference_rad,
            &self.wind_m_s,
        ];
        bytes.extend(reals.into_iter().flatten().flat_map(|real| (*real as f32).to_le_bytes()));
    }
}

#[cfg(test)]
mod tests {
    use super::{Frame, HEADER, STRIDE, Solver, VehicleState};

    #[test]
    fn a_frame_has_the_form_that_its_table_says() {
        let vehicle = VehicleState {
            id: 7,
            armed: true,
            tracks: true,
            solvers: [
                Solver::default(),
                Solver { status: 1, active: 2, iterations: 0x0304 },
                Solver::default(),
            ],
            item: 0x0506,
            position_m: [1.0, 2.0, -3.0],
            wind_m_s: [0.0, 0.0, 8.5],
            ..VehicleState::default()
        };
        let frame = Frame { speed: f64::INFINITY, pace: 40.0, time_s: 12.5, vehicles: vec![vehicle; 3] };
        let bytes = frame.encode();
        assert_eq!(bytes.len(), HEADER + 3 * STRIDE);
        assert_eq!(bytes[..4], [1, 3, STRIDE as u8, 0]);
        assert_eq!(bytes[4..8], f32::INFINITY.to_le_bytes());
        assert_eq!(bytes[8..16], 12.5_f64.to_le_bytes());
        assert_eq!(bytes[16..20], 40.0_f32.to_le_bytes());
        let last = &bytes[HEADER + 2 * STRIDE..];
        assert_eq!(last[..16], [7, 0b10_0001, 0, 1, 0, 0, 2, 0, 0, 0, 4, 3, 0, 0, 6, 5]);
        assert_eq!(last[16..28], [1.0_f32, 2.0, -3.0].map(f32::to_le_bytes).concat());
        assert_eq!(last[STRIDE - 4..], 8.5_f32.to_le_bytes());
    }

    #[test]
    fn no_number_of_vehicles_breaks_the_form() {
        let frame = Frame { vehicles: vec![VehicleState::default(); 300], ..Frame::default() };
        assert_eq!(frame.encode().len(), HEADER + 255 * STRIDE);
    }
}
