//! The plant's doubles, bit for bit: a flight that was recorded flies again.

use crate::common::numbers::Numbers;
use crate::common::physics::all_physics;
use nalgebra::Quaternion;
use quadrotor::{
    Airframe, Disturbance, Environment, InitialState, Plant, PlantInputs, PlantState, RigidBody, RotorFault,
    Wrench,
};

/// FNV-1a over the bits of what is seen.
struct Digest(u64);

impl Digest {
    fn take(&mut self, value: f64) {
        for byte in value.to_bits().to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    fn take_all<'a>(&mut self, values: impl IntoIterator<Item = &'a f64>) {
        values.into_iter().for_each(|value| self.take(*value));
    }

    fn take_state(&mut self, state: &PlantState) {
        let RigidBody { position_m, velocity_m_s, attitude, body_rate_rad_s } = &state.body;
        self.take_all(position_m.iter().chain(velocity_m_s).chain(&attitude.coords).chain(body_rate_rad_s));
        self.take_all(&state.rotor_speed_rad_s);
        self.take(state.discharge);
    }
}

fn state(numbers: &mut Numbers) -> PlantState {
    let near_ground = numbers.next().is_multiple_of(2);
    let mut position_m = numbers.vector(3.0);
    let lean = if near_ground { 0.02 } else { 1.0 };
    position_m.z = if near_ground { numbers.within(0.01) } else { -1.5 + numbers.within(1.5) };
    let mut attitude =
        Quaternion::new(1.0 + numbers.within(0.1), numbers.within(lean), numbers.within(lean), 0.0);
    attitude.coords.z = numbers.within(1.0);
    let slow = if numbers.next().is_multiple_of(4) { 0.05 } else { 3.0 };
    PlantState {
        body: RigidBody {
            position_m,
            velocity_m_s: numbers.vector(slow),
            attitude,
            body_rate_rad_s: numbers.vector(slow),
        },
        rotor_speed_rad_s: std::array::from_fn(|_| 230.0 + numbers.within(220.0)),
        discharge: 0.6 + numbers.within(0.6),
    }
}

fn inputs(numbers: &mut Numbers) -> PlantInputs {
    let mut inputs = if numbers.next().is_multiple_of(3) {
        PlantInputs::wrench(Wrench { thrust_n: 7.0 + numbers.within(7.0), torque_n_m: numbers.vector(0.2) })
    } else {
        PlantInputs::rotor_speeds(std::array::from_fn(|_| 230.0 + numbers.within(220.0)))
    };
    inputs.disturbance = Disturbance {
        force_n: numbers.vector(1.0),
        torque_n_m: numbers.vector(0.05),
        wind_m_s: numbers.vector(4.0),
    };
    if numbers.next().is_multiple_of(3) {
        let faults = [RotorFault::Off, RotorFault::Stuck, RotorFault::Weak { share: 0.6 }];
        inputs.rotor_faults[(numbers.next() % 4) as usize] = Some(faults[(numbers.next() % 3) as usize]);
    }
    inputs
}

fn everything() -> Airframe {
    Airframe { inertia_kg_m2: Airframe::default().inertia_kg_m2, ..all_physics() }
}

/// All that a plant says of random states, and short flights from them.
fn digest(airframe: &Airframe, ground_plane: bool) -> u64 {
    let plant = Plant::new(airframe, &Environment { ground_plane });
    let (mut numbers, mut digest) = (Numbers(2015), Digest(0xcbf2_9ce4_8422_2325));
    for _ in 0..300 {
        let (mut state, inputs) = (state(&mut numbers), inputs(&mut numbers));
        digest.take_state(&plant.derivative(&state, &inputs));
        for _ in 0..20 {
            state = plant.step(&state, &inputs, 1e-3);
        }
        digest.take_state(&state);
        digest.take_all(&plant.acceleration_m_s2(&state, &inputs));
        let (wrench, battery) = (plant.wrench(&state, &inputs), plant.battery(&state));
        digest.take_all(&wrench.torque_n_m);
        digest.take_all(&[wrench.thrust_n, battery.voltage_v, battery.current_a, battery.remaining]);
    }
    let mut landing = PlantState::at_rest(&InitialState {
        position_m: [0.0, 0.0, -0.3],
        velocity_m_s: [0.8, -0.3, 0.0],
        attitude_rad: [0.05, -0.03, 0.4],
        ..InitialState::default()
    });
    for _ in 0..3_000 {
        landing = plant.step(&landing, &PlantInputs::default(), 1e-3);
    }
    digest.take_state(&landing);
    digest.0
}

/// Recorded when the equations began to multiply by constants that are inverted once; on the ground, when what has come to rest there began to
/// stand still.
#[test]
fn doubles_are_those_that_were_recorded() {
    let windy = Airframe { drag_n_s_m: [0.3; 3], ..Airframe::default() };
    let recorded = [
        (Airframe::default(), false, 0x940f_68de_1bf3_6768),
        (Airframe::default(), true, 0xfb45_3ac2_262b_f2c5),
        (windy, true, 0x4301_0bef_5017_612b),
        (everything(), false, 0xffe2_5c01_061a_91f1),
        (everything(), true, 0x21ae_2501_b14b_38a7),
    ];
    let found = recorded.map(|(airframe, ground_plane, _)| digest(&airframe, ground_plane));
    let expected = recorded.map(|(_, _, digest)| digest);
    assert_eq!(found, expected, "{found:#018x?}");
}
