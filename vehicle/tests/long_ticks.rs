//! A vehicle that rests flies several ticks at once, and no flight depends on how it is divided.

use vehicle::identity::Identity;
use vehicle::{Mode, Vehicle, VehicleSettings};

/// Ticks of 1 ms.
const TAKEOFF: u64 = 15_000;
const FLIGHT: u64 = 60_000;

/// What is asked for, at a tick that is no multiple of anything.
type Request = (u64, fn(&mut Vehicle));

const REQUESTS: [Request; 6] = [
    (1_003, |vehicle| vehicle.arm(false).expect("it can be armed")),
    (1_004, |vehicle| vehicle.take_off(Some(5.0)).expect("it can take off")),
    (22_222, |vehicle| vehicle.set_mode(Mode::Return).expect("it can return")),
    (22_229, |vehicle| vehicle.set_mode(Mode::Hold).expect("it can stop")),
    (33_331, |vehicle| vehicle.hear_ground_station(true)),
    (44_444, |vehicle| vehicle.set_mode(Mode::Land).expect("it can land")),
];

/// Flies with all requests, at most so many ticks at once. Returns the vehicle, and how often it was called.
fn flown(most: u64) -> (Vehicle, u64) {
    let mut vehicle = Vehicle::new(&VehicleSettings::new(Identity::Px4)).expect("the defaults fly");
    let (mut tick, mut calls) = (0, 0);
    for (at, request) in REQUESTS.iter().chain([&(FLIGHT, (|_| {}) as fn(&mut Vehicle))]) {
        while tick < *at {
            tick += vehicle.fly(most.min(at - tick)).expect("the flight goes on");
            calls += 1;
        }
        request(&mut vehicle);
    }
    assert_eq!(vehicle.time_us(), FLIGHT * 1000);
    (vehicle, calls)
}

#[test]
fn a_flight_does_not_depend_on_how_it_is_divided() {
    let (one, _) = flown(1);
    assert!(!one.is_armed() && one.outputs().position_m.norm() < 1.0, "it has landed");
    for (vehicle, calls) in [2, 3, 7, 100].map(flown) {
        assert_eq!(vehicle.simulation().state(), one.simulation().state());
        assert_eq!(vehicle.battery(), one.battery());
        assert_eq!(vehicle.flight_times(), one.flight_times());
        assert!(calls < FLIGHT, "{calls} calls");
    }
}

#[test]
fn a_hovering_vehicle_flies_twenty_ticks_at_once() {
    let mut vehicle = Vehicle::new(&VehicleSettings::new(Identity::Px4)).expect("the defaults fly");
    assert_eq!(vehicle.fly(30).expect("it stands"), 20, "on the ground");
    vehicle.arm(false).expect("it can be armed");
    vehicle.take_off(Some(5.0)).expect("it can take off");
    assert_eq!(vehicle.fly(10).expect("it climbs"), 1, "on its way");
    for _ in 1..TAKEOFF {
        vehicle.tick().expect("the flight goes on");
    }
    assert_eq!(vehicle.mode(), Mode::Hold);
    assert_eq!(
        [vehicle.fly(30), vehicle.fly(3), vehicle.fly(30)].map(|flown| flown.expect("it hovers")),
        [20, 3, 17]
    );
    let now_us = vehicle.time_us();
    assert_eq!(vehicle.rests_until_us(), Some(now_us + 20_000));
    vehicle.fly(2).expect("it hovers");
    assert_eq!(vehicle.rests_until_us(), Some(now_us + 20_000), "within a long tick");
    vehicle.set_mode(Mode::Land).expect("it can land");
    assert_eq!(vehicle.rests_until_us(), None);
    assert_eq!(vehicle.fly(10).expect("it descends"), 1, "on its way down");
}
