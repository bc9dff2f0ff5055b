//! Where the vehicle is on the earth.

use nalgebra::Vector3;
use vehicle::identity::Identity;
use vehicle::world::LocalFrame;
use vehicle::{Vehicle, VehicleSettings};

/// A place that is kept for several messages is that of now, in each tick of a climb, and of nowhere else.
#[test]
fn the_place_of_the_vehicle_is_that_of_now() {
    let mut vehicle = Vehicle::new(&VehicleSettings::new(Identity::Px4)).expect("valid settings");
    vehicle.arm(false).expect("armed");
    vehicle.take_off(Some(3.0)).expect("a takeoff");
    let frame: LocalFrame = *vehicle.frame();
    for _ in 0..3_000 {
        vehicle.tick().expect("the flight goes on");
        let here_m = vehicle.outputs().position_m;
        for position_m in [here_m, here_m + Vector3::new(3.0, -4.0, 5.0), here_m] {
            assert_eq!(vehicle.place_of(&position_m), frame.to_geodetic(&position_m));
        }
        let told = vehicle.readings().gps.expect("a receiver").position_m;
        assert_eq!(told, vehicle.truth().position_m);
    }
    assert!(vehicle.outputs().position_m.z < -1.0, "it climbs");
}
