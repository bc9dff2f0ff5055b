//! Limits that are lowered in flight by parameter or by command, in every way of flying that the vehicle plans itself: none of them
//! leads it into the ground, past the end of its way or through its fence.

use nalgebra::Vector3;
use quadrotor::{Configuration, Limits};
use vehicle::identity::Identity;
use vehicle::plan::{MissionItem, PlanKind, command, frame};
use vehicle::{
    AxisTarget, LandedState, MissionState, Mode, PositionSetPoint, Reposition, SetPoint, Vehicle,
    VehicleSettings, YawTarget,
};

/// The limits on motion one by one, lowered to a tenth or to the end of their range, and all of them together.
fn lowered() -> Vec<(&'static str, Limits)> {
    let limits = Limits::default();
    vec![
        ("jerk", Limits { jerk_horizontal_m_s3: 0.4, jerk_vertical_m_s3: 0.4, ..limits }),
        ("least jerk", Limits { jerk_horizontal_m_s3: 0.1, jerk_vertical_m_s3: 0.1, ..limits }),
        (
            "acceleration",
            Limits { acceleration_horizontal_m_s2: 0.25, acceleration_vertical_m_s2: 0.2, ..limits },
        ),
        ("speed", Limits { speed_horizontal_m_s: 0.8, speed_up_m_s: 0.4, speed_down_m_s: 0.3, ..limits }),
        ("tilt", Limits { tilt_rad: 0.1, tilt_rate_rad_s: 0.2, acceleration_horizontal_m_s2: 0.5, ..limits }),
        ("tilt acceleration", Limits { tilt_acceleration_rad_s2: 0.8, ..limits }),
        ("thrust", Limits { thrust_min: 0.95, thrust_max: 1.05, ..limits }),
        (
            "heading",
            Limits { yaw_rate_rad_s: 0.08, yaw_acceleration_rad_s2: 0.03, yaw_jerk_rad_s3: 0.06, ..limits },
        ),
        (
            "all of them",
            Limits {
                jerk_horizontal_m_s3: 0.4,
                jerk_vertical_m_s3: 0.4,
                acceleration_horizontal_m_s2: 0.25,
                acceleration_vertical_m_s2: 0.2,
                speed_horizontal_m_s: 2.0,
                speed_up_m_s: 1.0,
                speed_down_m_s: 1.0,
                ..limits
            },
        ),
    ]
}

struct Flight {
    vehicle: Vehicle,
    /// Of all places since it was lowered, by axis: least and largest, m.
    range_m: [(f64, f64); 3],
    /// The largest sink rate below 0.3 m, m/s.
    impact_m_s: f64,
}

impl Flight {
    /// In the air at 10 m, north and east at 0.
    fn hovering() -> Self {
        let mut configuration = Configuration::default();
        configuration.airframe.drag_n_s_m = [0.1; 3];
        let settings = VehicleSettings { configuration, ..VehicleSettings::new(Identity::Px4) };
        let mut vehicle = Vehicle::new(&settings).expect("valid settings");
        vehicle.arm(false).expect("armed");
        vehicle.take_off(Some(10.0)).expect("a takeoff");
        let range_m = [(f64::INFINITY, f64::NEG_INFINITY); 3];
        let mut flight = Self { vehicle, range_m, impact_m_s: 0.0 };
        flight.fly_until("hover", 60.0, |vehicle| vehicle.mode() == Mode::Hold);
        flight.fly(2.0);
        flight
    }

    fn tick(&mut self) {
        self.vehicle.tick().expect("the flight goes on");
        let truth = self.vehicle.truth();
        for (range_m, place_m) in self.range_m.iter_mut().zip(&truth.position_m) {
            *range_m = (range_m.0.min(*place_m), range_m.1.max(*place_m));
        }
        if truth.position_m.z > -0.3 {
            self.impact_m_s = self.impact_m_s.max(truth.velocity_m_s.z);
        }
    }

    fn fly(&mut self, seconds: f64) {
        for _ in 0..(seconds * 1e3) as usize {
            self.tick();
        }
    }

    fn fly_until(&mut self, what: &str, most_s: f64, condition: impl Fn(&Vehicle) -> bool) {
        for _ in 0..(most_s * 1e3) as usize {
            if condition(&self.vehicle) {
                return;
            }
            self.tick();
        }
        panic!("not within {most_s} s: {what}; {:?}", self.vehicle.truth().position_m);
    }

    fn lower(&mut self, limits: &Limits) {
        let mut kept = self.vehicle.kept_configuration();
        kept.limits = *limits;
        let conduct = *self.vehicle.conduct();
        self.vehicle.adopt(&kept, &conduct).expect("legal limits");
        self.range_m = [(f64::INFINITY, f64::NEG_INFINITY); 3];
    }

    fn position_m(&self) -> Vector3<f64> {
        self.vehicle.truth().position_m
    }
}

fn on_ground(vehicle: &Vehicle) -> bool {
    vehicle.landed_state() == LandedState::OnGround
}

fn set_point(axes: [AxisTarget; 3]) -> SetPoint {
    SetPoint::Position(PositionSetPoint { axes, yaw: YawTarget::Hold })
}

fn waypoint(position: [f64; 3]) -> MissionItem {
    MissionItem {
        frame: frame::LOCAL_NED,
        command: command::NAV_WAYPOINT,
        parameters: [0.0, 2.0, 0.0, f64::NAN],
        position,
        autocontinue: true,
    }
}

#[test]
fn a_reposition_ends_at_its_goal() {
    for (name, limits) in lowered() {
        for (down_m, horizontal_m) in [(-3.0, [0.0, 0.0]), (-20.0, [0.0, 0.0]), (-10.0, [40.0, 0.0])] {
            for change_s in [1.0, 3.0] {
                let mut flight = Flight::hovering();
                let goal = Reposition {
                    down_m: Some(down_m),
                    horizontal_m: Some(horizontal_m),
                    yaw_rad: Some(2.0),
                    ..Reposition::default()
                };
                flight.vehicle.reposition(&goal).expect("a goal");
                flight.fly(change_s);
                flight.lower(&limits);
                flight.fly(40.0);
                let [north_m, _, z_m] = flight.range_m;
                let told = format!("{name} after {change_s} s to {goal:?}: {:?}", flight.range_m);
                assert!(
                    z_m.1 < (-10.0_f64).max(down_m) + 0.15 && z_m.0 > (-10.0_f64).min(down_m) - 0.15,
                    "{told}"
                );
                assert!(north_m.1 < horizontal_m[0] + 0.15 && north_m.0 > -0.15, "{told}");
            }
        }
    }
}

#[test]
fn a_landing_touches_down_no_faster() {
    for (name, limits) in lowered() {
        for change_s in [1.0, 2.5] {
            let mut flight = Flight::hovering();
            flight.vehicle.set_mode(Mode::Land).expect("land mode");
            flight.fly(change_s);
            flight.lower(&limits);
            flight.fly_until("landed", 120.0, on_ground);
            assert!(flight.impact_m_s < 1.0, "{name} after {change_s} s: {} m/s", flight.impact_m_s);
        }
    }
}

/// A velocity, then a stop: lowered while it brakes, the vehicle stops where it would have.
#[test]
fn a_stop_is_ended_as_it_began() {
    let run = |limits: Option<&Limits>| {
        let mut flight = Flight::hovering();
        let ahead = set_point([AxisTarget::Velocity(6.0), AxisTarget::HOLD, AxisTarget::HOLD]);
        flight.vehicle.set_point(ahead).expect("a set-point");
        flight.vehicle.set_mode(Mode::Offboard).expect("offboard mode");
        for _ in 0..20 {
            flight.vehicle.set_point(ahead).expect("a set-point");
            flight.fly(0.25);
        }
        flight.vehicle.set_mode(Mode::Hold).expect("hold mode");
        flight.fly(1.0);
        if let Some(limits) = limits {
            flight.lower(limits);
        }
        flight.fly(15.0);
        flight.position_m().x
    };
    let unchanged_m = run(None);
    for (name, limits) in lowered() {
        let stopped_m = run(Some(&limits));
        assert!((stopped_m - unchanged_m).abs() < 0.3, "{name}: {stopped_m} m, not {unchanged_m} m");
    }
}

/// At full speed towards the fence, with limits lowered where the lower ones could not stop before it any more.
#[test]
fn no_fence_is_crossed_for_lower_limits() {
    for (name, limits) in lowered() {
        let mut flight = Flight::hovering();
        let mut conduct = *flight.vehicle.conduct();
        conduct.failsafe.fence_radius_m = 60.0;
        let kept = flight.vehicle.kept_configuration();
        flight.vehicle.adopt(&kept, &conduct).expect("a fence");
        let ahead = set_point([AxisTarget::Velocity(7.0), AxisTarget::HOLD, AxisTarget::HOLD]);
        flight.vehicle.set_point(ahead).expect("a set-point");
        flight.vehicle.set_mode(Mode::Offboard).expect("offboard mode");
        while flight.position_m().x < 40.0 {
            flight.vehicle.set_point(ahead).expect("a set-point");
            flight.fly(0.25);
        }
        flight.lower(&limits);
        for _ in 0..100 {
            let _ = flight.vehicle.set_point(ahead);
            flight.fly(0.25);
        }
        let [north_m, _, z_m] = flight.range_m;
        assert!(north_m.1 < 60.0, "{name}: {north_m:?}");
        assert!(z_m.1 < -2.0, "{name}: {z_m:?}");
    }
}

/// Around corners: lowered on a leg, at its corner and behind it. Every place is passed or reached, and none overshot.
#[test]
fn a_mission_goes_round_its_corners_and_ends_at_its_end() {
    let places = [[30.0, 0.0, -10.0], [30.0, 30.0, -10.0], [0.0, 30.0, -10.0]];
    let run = |name: &str, change_s: f64, limits: &Limits| {
        let mut flight = Flight::hovering();
        let items = places.map(waypoint).to_vec();
        flight.vehicle.set_plan(PlanKind::Mission, items).expect("a mission");
        flight.vehicle.set_mode(Mode::Mission).expect("mission mode");
        flight.fly(change_s);
        flight.lower(limits);
        let complete = |vehicle: &Vehicle| vehicle.mission_status().state == MissionState::Complete;
        flight.fly_until("complete", 400.0, complete);
        flight.fly(5.0);
        let off_m = (flight.position_m() - Vector3::from(places[2])).norm();
        assert!(off_m < 0.3, "{name} after {change_s} s: it ends {off_m} m away");
        flight.range_m
    };
    for change_s in [5.0, 8.0, 11.0] {
        for (name, limits) in lowered() {
            let [north_m, east_m, z_m] = run(name, change_s, &limits);
            let told = format!("{name} after {change_s} s: {north_m:?} {east_m:?} {z_m:?}");
            assert!(north_m.1 < 30.4 && north_m.0 > -0.4, "{told}");
            assert!(east_m.1 < 30.4 && east_m.0 > -0.4, "{told}");
            assert!(z_m.0 > -10.4 && z_m.1 < -9.6, "{told}");
        }
    }
}

/// Home again: the climb, the way and the landing go no farther past home than a return that began within the lower limits.
#[test]
fn a_return_comes_home() {
    let run = |name: &str, limits: &Limits, change_s: Option<f64>| {
        let mut flight = Flight::hovering();
        let goal = Reposition { horizontal_m: Some([30.0, 0.0]), ..Reposition::default() };
        flight.vehicle.reposition(&goal).expect("a goal");
        flight.fly(12.0);
        if change_s.is_none() {
            flight.lower(limits);
        }
        flight.vehicle.set_mode(Mode::Return).expect("return mode");
        if let Some(change_s) = change_s {
            flight.fly(change_s);
            flight.lower(limits);
        }
        flight.fly_until("landed", 400.0, on_ground);
        let off_m = flight.position_m().xy().norm();
        assert!(off_m < 0.5, "{name} after {change_s:?} s: {off_m} m");
        (-flight.range_m[0].0, flight.impact_m_s)
    };
    for (name, limits) in lowered() {
        let (begun_m, begun_m_s) = run(name, &limits, None);
        for change_s in [1.0, 9.0, 12.0, 18.0] {
            let (past_m, impact_m_s) = run(name, &limits, Some(change_s));
            assert!(
                past_m < begun_m.max(0.0) + 0.5,
                "{name} after {change_s} s: {past_m} m, not {begun_m} m"
            );
            assert!(
                impact_m_s < begun_m_s + 0.1,
                "{name} after {change_s} s: {impact_m_s} m/s, not {begun_m_s} m/s"
            );
        }
    }
}
