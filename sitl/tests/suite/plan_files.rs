//! Plans in files, and the flights that they are.

use std::path::{Path, PathBuf};

use sitl::Failure;
use sitl::configuration::read_plans;
use vehicle::identity::Identity;
use vehicle::plan::{PlanKind, Plans, Site, command};
use vehicle::world::{Geodetic, LocalFrame};

fn site(identity: Identity) -> Site {
    let origin = Geodetic::default();
    Site {
        identity,
        frame: LocalFrame::new(origin),
        home_m: nalgebra::Vector3::zeros(),
        terrain: vehicle::surroundings::Terrain::default(),
    }
}

/// Reads a text as a file, and hands its name to the errors.
fn read(name: &str, text: &str, identity: Identity) -> Result<Plans, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let path: PathBuf = folder.path().join(name);
    std::fs::write(&path, text).expect("written");
    read_plans(&path, &site(identity)).map_err(|error| error.to_string())
}

const PLAN: &str = include_str!("corpus/mission.plan");

#[test]
fn a_plan_of_qgroundcontrol_is_read_with_fence_and_rally_points() {
    let plans = read("a.plan", PLAN, Identity::Px4).expect("a plan");
    let mission = plans.get(PlanKind::Mission).items();
    let commands: Vec<u16> = mission.iter().map(|item| item.command).collect();
    assert_eq!(commands, [22, 16, 177, 20]);
    assert!(mission[0].parameter(4).is_nan());
    assert_eq!((mission[1].parameter(1), mission[1].parameter(5)), (1.5, 47.398));
    assert_eq!(mission[2].parameter(1), 1.0, "the id of a jump's target is the item with that id");
    let fence = plans.get(PlanKind::Fence).items();
    let commands: Vec<u16> = fence.iter().map(|item| item.command).collect();
    assert_eq!(commands, [5002, 5002, 5002, 5003, 5000]);
    assert_eq!((fence[0].parameter(1), fence[3].parameter(1)), (3.0, 120.5));
    let rally = plans.get(PlanKind::Rally).items();
    assert_eq!((rally.len(), rally[0].command, rally[0].position), (1, 5100, [47.3978, 8.5457, 20.0]));
    // In ArduPilot's convention home is the first item.
    let plans = read("a.plan", PLAN, Identity::ArduPilot).expect("a plan");
    let mission = plans.get(PlanKind::Mission).items();
    assert_eq!((mission.len(), mission[0].position), (5, [47.397_742, 8.545_594, 488.0]));
    assert_eq!(mission[3].parameter(1), 2.0);
}

const TEXT: &str = include_str!("corpus/mission.waypoints");

#[test]
fn a_waypoint_text_is_read_and_its_home_is_no_item_of_px4() {
    let plans = read("a.waypoints", TEXT, Identity::Px4).expect("a plan");
    let mission = plans.get(PlanKind::Mission).items();
    assert_eq!(mission.len(), 4);
    assert_eq!((mission[0].command, mission[0].position[2]), (command::NAV_TAKEOFF, 10.0));
    assert_eq!((mission[2].command, mission[2].parameter(1)), (command::DO_JUMP, 1.0));
    assert!(!mission[3].autocontinue);
    let plans = read("a.waypoints", TEXT, Identity::ArduPilot).expect("a plan");
    let mission = plans.get(PlanKind::Mission).items();
    assert_eq!((mission.len(), mission[3].parameter(1)), (5, 2.0));
}

#[test]
fn errors_name_the_file_the_place_the_value_and_its_range() {
    let replaced = |text: &str, from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        text.replacen(from, to, 1)
    };
    let survey = r#""type": "ComplexItem", "complexItemType": "survey", "autoContinue": true, "command": 16"#;
    let simple = r#""type": "SimpleItem", "autoContinue": true, "command": 16"#;
    for (name, text, expected) in [
        ("a.plan", replaced(PLAN, simple, survey), "item 2: complex item `survey` is not supported"),
        (
            "a.plan",
            replaced(PLAN, "[1.5, 0,", "[-1.5, 0,"),
            "item 2: NAV_WAYPOINT (16): hold time = -1.5; allowed 0 to 86400",
        ),
        ("a.plan", replaced(PLAN, "[5, 2,", "[9, 2,"), "item 3: no item has doJumpId 9"),
        (
            "a.plan",
            replaced(PLAN, r#""command": 20"#, r#""command": 30"#),
            "item 4: NAV_CONTINUE_AND_CHANGE_ALT (30): not supported",
        ),
        ("a.plan", replaced(PLAN, r#"[1.5, 0, 0, null,"#, "[1.5,"), "item 2: invalid length 4"),
        ("a.plan", replaced(PLAN, r#"Type": "Plan""#, r#"Type": "Parameters""#), "fileType is `Parameters`"),
        (
            "a.plan",
            replaced(PLAN, r#""version": 2, "firm"#, r#""version": 1, "firm"#),
            "mission version 1 is not supported; expected 2",
        ),
        (
            "a.plan",
            replaced(PLAN, "[47.3978, 8.5457, 20]", "[97, 8, 20]"),
            "rally point 1: NAV_RALLY_POINT (5100): latitude = 97",
        ),
        (
            "a.plan",
            replaced(PLAN, "[47.398, 8.545]", "[47.398, 190]"),
            "fence polygon 1: NAV_FENCE_POLYGON_VERTEX_EXCLUSION (5002): longitude = 190",
        ),
        ("a.plan", "{".to_owned(), "not a valid .plan file: EOF"),
        (
            "a.txt",
            replaced(TEXT, "47.398", "147.398"),
            "line 5: NAV_WAYPOINT (16): latitude = 147.398; allowed -90 to 90 degrees",
        ),
        ("a.txt", replaced(TEXT, "47.398", "north"), "line 5: field 9 `north` is not a number"),
        ("a.txt", replaced(TEXT, "2\t0\t3", "7\t0\t3"), "line 5: found item 7, expected item 2"),
        (
            "a.txt",
            replaced(TEXT, "4\t0\t3\t21", "4\t0\t3.5\t21"),
            "line 7: frame = 3.5 must be a whole number",
        ),
        ("a.txt", replaced(TEXT, "177\t2", "177\t0"), "line 6: a jump cannot go to item 0, which is home"),
        ("a.txt", replaced(TEXT, "8.5457\t10\t1", "8.5457\t10"), "line 5: found 11 fields, expected 12"),
        ("a.txt", replaced(TEXT, "WPL 110", "WPL 120"), "neither a .plan"),
    ] {
        let error = read(name, &text, Identity::Px4).expect_err(expected);
        assert!(error.contains(name) && error.contains(expected), "{error}");
    }
    let missing = read_plans(Path::new("/nowhere/a.plan"), &site(Identity::Px4)).expect_err("no file");
    assert!(matches!(missing, Failure::File { .. }) && missing.exit_code() == 4);
}
