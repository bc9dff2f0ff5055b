//! A survey as QGroundControl writes it: read from its file, uploaded and flown. The images come at the distance that was asked for.

#[allow(deprecated)] // Clients still use what the dialect calls deprecated.
use std::path::PathBuf;

use crate::common::Bench;
use crate::common::plan_client::{result, upload};
use autopilot::codec::Message;
use mavlink::dialects::ardupilotmega::{CAMERA_FEEDBACK_DATA, CAMERA_IMAGE_CAPTURED_DATA, MavMessage};
use nalgebra::Vector3;
use sitl::configuration::read_plans;
use vehicle::identity::Identity;
use vehicle::plan::{PlanKind, Site};
use vehicle::world::{Geodetic, LocalFrame};
use vehicle::{MissionState, Mode};

/// Images as they were told.
#[derive(Default)]
struct Told {
    triggers: Vec<u32>,
    feedback: Vec<CAMERA_FEEDBACK_DATA>,
    captured: Vec<CAMERA_IMAGE_CAPTURED_DATA>,
}

fn survey(identity: Identity) -> (Bench, Told) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/suite/corpus/survey.plan");
    let origin = Geodetic::default();
    let site = Site {
        identity,
        frame: LocalFrame::new(origin),
        home_m: Vector3::zeros(),
        terrain: vehicle::surroundings::Terrain::default(),
    };
    let plans = read_plans(&path, &site).expect("a plan");
    let mut bench = Bench::new(identity);
    let items = plans.get(PlanKind::Mission).items();
    assert_eq!(result(&upload(&mut bench, PlanKind::Mission, items)), Some(0));
    bench.arm();
    bench.set_mode(Mode::Mission);
    let mut told = Told::default();
    for _ in 0..20_000 {
        bench.heard.clear();
        bench.fly(0.01);
        for message in &bench.heard {
            match message {
                Message::Typed(MavMessage::CAMERA_TRIGGER(trigger)) => told.triggers.push(trigger.seq),
                Message::Typed(MavMessage::CAMERA_FEEDBACK(feedback)) => told.feedback.push(feedback.clone()),
                Message::Typed(MavMessage::CAMERA_IMAGE_CAPTURED(image)) => told.captured.push(image.clone()),
                _ => {}
            }
        }
        if bench.autopilot.vehicle().mission_status().state == MissionState::Complete {
            return (bench, told);
        }
    }
    panic!("the survey did not end: {:?}", bench.position());
}

/// Transects lead north and south, 40 m long, 12 m apart, with an image at the beginning of each and every 5 m.
#[test]
fn images_are_as_far_apart_as_the_survey_says() {
    for identity in [Identity::Px4, Identity::ArduPilot] {
        let (bench, told) = survey(identity);
        let places = told.feedback.iter().map(|image| {
            let place = Geodetic {
                latitude_deg: f64::from(image.lat) / 1e7,
                longitude_deg: f64::from(image.lng) / 1e7,
                altitude_m: f64::from(image.alt_msl),
            };
            bench.autopilot.vehicle().frame().to_local_m(&place)
        });
        let places: Vec<Vector3<f64>> = places.collect();
        let mut per_transect = [0; 3];
        for pair in places.windows(2) {
            let ([one, other], apart_m) = ([pair[0], pair[1]], (pair[1] - pair[0]).xy().norm());
            if (one.y - other.y).abs() < 6.0 {
                assert!((apart_m - 5.0).abs() < 0.1, "{identity:?}: {apart_m} m from {one} to {other}");
            }
        }
        for place in &places {
            per_transect[(place.y / 12.0).round() as usize] += 1;
            assert!((place.z + 15.0).abs() < 0.5 && (-3.0..43.0).contains(&place.x), "{place}");
        }
        assert!(per_transect.iter().all(|count| (8..=9).contains(count)), "{identity:?}: {per_transect:?}");
        // All three messages tell the same images.
        let count = places.len() as u32;
        assert_eq!(told.triggers, (1..=count).collect::<Vec<_>>());
        let captured: Vec<_> = told.captured.iter().map(|image| (image.image_index, image.lat)).collect();
        let fed: Vec<_> =
            told.feedback.iter().map(|image| (i32::from(image.img_idx) - 1, image.lat)).collect();
        assert_eq!(captured, fed);
        // The camera looks down, as the plan says.
        let [w, x, y, z] = told.captured.last().unwrap().q.map(f64::from);
        let pitch_rad = libm::asin(2.0 * (w * y - z * x));
        assert!((pitch_rad.to_degrees() + 90.0).abs() < 0.5, "{pitch_rad}");
    }
}
