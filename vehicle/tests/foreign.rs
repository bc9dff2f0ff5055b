//! A vehicle whose plant, or whole closed loop, is from elsewhere: here our own engine, behind the wall that foreign models are
//! behind. It must fly as without the wall.

use nalgebra::Vector3;
use quadrotor::{
    Configuration, Disturbance, Inputs, PlantInputs, PlantSimulation, PlantState, RotorFault, Simulation,
};
use vehicle::fault::{Fault, Rotors};
use vehicle::foreign::{Demand, ForeignDescription, ForeignModel, ForeignMotion, ForeignRole};
use vehicle::identity::Identity;
use vehicle::{
    AttitudeSetPoint, AxisTarget, FlightError, Mode, PositionSetPoint, Refusal, SetPoint, Vehicle,
    VehicleSettings, YawTarget,
};

fn settings() -> VehicleSettings {
    VehicleSettings::new(Identity::Px4)
}

fn description(role: ForeignRole, start: ForeignMotion) -> ForeignDescription {
    ForeignDescription { name: "the model".to_owned(), role, start }
}

/// Our plant.
#[derive(Debug)]
struct OwnPlant {
    description: ForeignDescription,
    plant: PlantSimulation,
    /// Whether rotor speeds and thrust are driven, or only the thrust and torques of rotors that it does not have.
    rotors: bool,
    fails_at_us: Option<u64>,
}

impl OwnPlant {
    fn new(configuration: &Configuration, rotors: bool) -> Self {
        let state = PlantState::at_rest(&configuration.initial);
        let plant =
            PlantSimulation::new(configuration, &state, &PlantInputs::default()).expect("the plant starts");
        let start = ForeignMotion {
            body: state.body,
            acceleration_m_s2: rotors.then(Vector3::zeros),
            rotor_speed_rad_s: rotors.then_some([0.0; 4]),
            thrust_n: None,
        };
        Self { description: description(ForeignRole::Plant, start), plant, rotors, fails_at_us: None }
    }
}

impl ForeignModel for OwnPlant {
    fn description(&self) -> &ForeignDescription {
        &self.description
    }

    fn advance(&mut self, demand: &Demand) -> Result<ForeignMotion, FlightError> {
        if self.fails_at_us == Some(demand.time_us) {
            return Err(FlightError::Foreign { time_us: demand.time_us, reason: "it broke".to_owned() });
        }
        let disturbance = Disturbance { wind_m_s: demand.wind_m_s, ..Disturbance::default() };
        let actuation = if self.rotors {
            PlantInputs::rotor_speeds(demand.rotor_command_rad_s)
        } else {
            PlantInputs::wrench(demand.wrench)
        };
        let inputs = PlantInputs { disturbance, ..actuation };
        self.plant.advance_to(demand.time_us + demand.duration_us, &|_| inputs)?;
        let (shown, state) = (self.rotors, self.plant.plant_state());
        Ok(ForeignMotion {
            body: state.body,
            acceleration_m_s2: shown.then(|| self.plant.plant().acceleration_m_s2(&state, &inputs)),
            rotor_speed_rad_s: shown.then_some(state.rotor_speed_rad_s),
            thrust_n: None,
        })
    }
}

/// Our closed loop, told a reference only.
#[derive(Debug)]
struct OwnLoop {
    description: ForeignDescription,
    simulation: Simulation,
}

impl OwnLoop {
    fn new(configuration: &Configuration) -> Self {
        let mut configuration = *configuration;
        configuration.reference.shaping = false;
        let inputs = Inputs { armed: false, ..Inputs::default() };
        let simulation = Simulation::new(&configuration, &inputs).expect("a closed loop");
        let start = ForeignMotion {
            body: simulation.plant_state().body,
            acceleration_m_s2: None,
            rotor_speed_rad_s: Some([0.0; 4]),
            thrust_n: None,
        };
        Self { description: description(ForeignRole::ClosedLoop, start), simulation }
    }
}

impl ForeignModel for OwnLoop {
    fn description(&self) -> &ForeignDescription {
        &self.description
    }

    fn advance(&mut self, demand: &Demand) -> Result<ForeignMotion, FlightError> {
        let disturbance = Disturbance { wind_m_s: demand.wind_m_s, ..Disturbance::default() };
        let inputs =
            Inputs { reference: demand.reference, armed: demand.armed, disturbance, ..Inputs::default() };
        self.simulation.advance_to(demand.time_us + demand.duration_us, &inputs)?;
        let PlantState { body, rotor_speed_rad_s, .. } = self.simulation.plant_state();
        Ok(ForeignMotion { body, rotor_speed_rad_s: Some(rotor_speed_rad_s), ..self.description.start })
    }
}

fn fly(vehicle: &mut Vehicle, seconds: f64) {
    for _ in 0..(seconds * 1000.0) as usize {
        vehicle.tick().expect("the flight goes on");
    }
}

fn fly_until(vehicle: &mut Vehicle, seconds: f64, what: &str, condition: impl Fn(&Vehicle) -> bool) {
    for _ in 0..(seconds * 1000.0) as usize {
        if condition(vehicle) {
            return;
        }
        vehicle.tick().expect("the flight goes on");
    }
    panic!("not within {seconds} s: {what}; {:?}", vehicle.truth());
}

/// Up, elsewhere, and down again.
fn fly_about(vehicle: &mut Vehicle) -> [f64; 3] {
    fly(vehicle, 0.5);
    vehicle.arm(false).expect("armed");
    vehicle.take_off(Some(5.0)).expect("a takeoff");
    fly_until(vehicle, 20.0, "takeoff", |vehicle| vehicle.mode() == Mode::Hold);
    let goal = vehicle::Reposition {
        horizontal_m: Some([4.0, -3.0]),
        yaw_rad: Some(1.0),
        ..vehicle::Reposition::default()
    };
    vehicle.reposition(&goal).expect("a goal");
    fly(vehicle, 12.0);
    let there = vehicle.truth().position_m;
    vehicle.set_mode(Mode::Land).expect("a landing");
    fly_until(vehicle, 40.0, "disarmed", |vehicle| !vehicle.is_armed());
    there.into()
}

#[test]
fn our_plant_behind_the_wall_flies_bit_for_bit_as_without() {
    let settings = settings();
    let mut ours = Vehicle::new(&settings).expect("a vehicle");
    let model = Box::new(OwnPlant::new(&settings.flown_configuration(), true));
    let mut foreign = Vehicle::flown_by(&settings, model).expect("a vehicle");
    assert_eq!(fly_about(&mut ours), fly_about(&mut foreign));
    assert_eq!(ours.truth().position_m, foreign.truth().position_m);
    assert_eq!(ours.truth().rotor_speed_rad_s, foreign.truth().rotor_speed_rad_s);
    assert_eq!(ours.time_us(), foreign.time_us());
}

#[test]
fn a_body_under_thrust_and_torques_flies_nearly_the_same() {
    let settings = settings();
    let mut ours = Vehicle::new(&settings).expect("a vehicle");
    let model = Box::new(OwnPlant::new(&settings.flown_configuration(), false));
    let mut foreign = Vehicle::flown_by(&settings, model).expect("a vehicle");
    let (a, b) = (fly_about(&mut ours), fly_about(&mut foreign));
    let away = (Vector3::from(a) - Vector3::from(b)).norm();
    assert!(away < 0.01, "{a:?} {b:?}");
}

#[test]
fn a_closed_loop_follows_references_and_what_it_cannot_do_is_refused() {
    let settings = settings();
    let model = Box::new(OwnLoop::new(&settings.flown_configuration()));
    let mut vehicle = Vehicle::flown_by(&settings, model).expect("a vehicle");
    let there = fly_about(&mut vehicle);
    assert!((Vector3::from(there) - Vector3::new(4.0, -3.0, -5.0)).norm() < 0.1, "{there:?}");
    assert!((vehicle.truth().position_m.xy() - nalgebra::Vector2::new(4.0, -3.0)).norm() < 0.2);

    let level = AttitudeSetPoint { attitude: None, body_rate_rad_s: Vector3::zeros(), thrust: 0.5 };
    let refused = vehicle.set_point(SetPoint::Attitude(level)).expect_err("no attitude");
    assert!(refused.to_string().contains("the model follows positions"), "{refused}");
    let axes = [AxisTarget::Velocity(1.0), AxisTarget::HOLD, AxisTarget::HOLD];
    let position = SetPoint::Position(PositionSetPoint { axes, yaw: YawTarget::Hold });
    assert_eq!(vehicle.set_point(position), Ok(()));
}

#[test]
fn what_describes_the_model_does_not_change_and_the_rotors_of_a_closed_loop_do_not_break() {
    let settings = settings();
    for closed_loop in [false, true] {
        let configuration = settings.flown_configuration();
        let model: Box<dyn ForeignModel> = if closed_loop {
            Box::new(OwnLoop::new(&configuration))
        } else {
            Box::new(OwnPlant::new(&configuration, true))
        };
        let mut vehicle = Vehicle::flown_by(&settings, model).expect("a vehicle");
        let kept = vehicle.kept_configuration();
        let mut conduct = *vehicle.conduct();
        conduct.failure_injection = true;

        let mut heavier = kept;
        heavier.airframe.mass_kg *= 1.1;
        let refused = vehicle.adopt(&heavier, &conduct).expect_err("another mass").to_string();
        assert!(refused.contains("parameters of the airframe cannot change"), "{refused}");
        let mut slower = kept;
        slower.limits.speed_horizontal_m_s *= 0.5;
        vehicle.adopt(&slower, &conduct).expect("limits are those of the references");
        let mut regulator = slower;
        regulator.controllers.kind = quadrotor::ControllerKind::Dlqr;
        assert_eq!(vehicle.adopt(&regulator, &conduct).is_err(), closed_loop);

        let fault = Fault::Rotors(Rotors::Front, Some(RotorFault::Off));
        match vehicle.inject(&fault) {
            Ok(()) => assert!(!closed_loop, "a plant is told what its rotors do"),
            Err(refused) => {
                let says = matches!(&refused, Refusal::Unsupported(text) if text.contains("flies as the closed loop"));
                assert!(closed_loop && says, "{refused}");
            }
        }
    }
}

#[test]
fn the_end_of_the_model_is_the_end_of_the_flight() {
    let settings = settings();
    let model =
        OwnPlant { fails_at_us: Some(100_000), ..OwnPlant::new(&settings.flown_configuration(), true) };
    let mut vehicle = Vehicle::flown_by(&settings, Box::new(model)).expect("a vehicle");
    fly(&mut vehicle, 0.1);
    let error = vehicle.tick().expect_err("it fails");
    assert_eq!(error.to_string(), "it broke (0.1 s of simulation time)");
    assert_eq!(vehicle.time_us(), 100_000);
}
