//! Plans made from items: in SI units and the local frame.

use super::mission_command::{ROI_ITEM, Source, mission_command};
use super::step::{Condition, Do, Step, Turn};
use super::{
    FaultCode, Look, MissionItem, Place, PlanFault, PlanKind, Program, ProgramStep, Site, check, command,
};

/// The steps of a mission whose items were checked. The first item of ArduPilot's convention is home, and never checked: what
/// cannot be understood is passed by.
pub fn mission(items: &[MissionItem], site: &Site) -> Program {
    let ardupilot = site.identity.is_ardupilot();
    let steps = items
        .iter()
        .map(|item| ProgramStep {
            step: step(item, items, site),
            // ArduPilot goes on after every item.
            continues: item.autocontinue || ardupilot,
        })
        .collect();
    Program::new(steps, usize::from(ardupilot))
}

/// The places of rally points whose items were checked.
pub fn rally_points(items: &[MissionItem], site: &Site) -> Vec<Place> {
    items.iter().map(|item| site.place(item).unwrap_or_default()).collect()
}

/// What DO_SET_ROI or one of its successors looks at; `None`: at nothing any more. `items` are those of the mission, which it may
/// name.
///
/// # Errors
/// [`PlanFault`] of what is no region of interest.
pub fn look(item: &MissionItem, items: &[MissionItem], site: &Site) -> Result<Option<Look>, PlanFault> {
    // As any item but home.
    let index = usize::from(site.identity.is_ardupilot());
    check::item(PlanKind::Mission, index, item, site)?;
    let (count, named) = (items.len(), item.parameter(2));
    if item.command == command::DO_SET_ROI
        && item.parameter(1) == ROI_ITEM
        && !(0.0..count as f64).contains(&named)
    {
        let reason = format!("no item has sequence number {named}; the plan has {count} items");
        return Err(PlanFault::of_item(index, FaultCode::InvalidParameter(2), reason));
    }
    match step(item, items, site) {
        Step::Do(Do::Look(look)) => Ok(look),
        _ => {
            let reason = "not supported".to_owned();
            Err(PlanFault::of_item(index, FaultCode::Unsupported, reason))
        }
    }
}

/// What is done at once for a command that is no part of a mission.
///
/// # Errors
/// [`PlanFault`] of what is not done at once.
pub fn action(item: &MissionItem, site: &Site) -> Result<Do, PlanFault> {
    match alone(item, site)? {
        Step::Do(action) => Ok(action),
        _ => Err(unsupported(site)),
    }
}

/// The turn that CONDITION_YAW asks for.
///
/// # Errors
/// [`PlanFault`] of what is no turn.
pub fn turn(item: &MissionItem, site: &Site) -> Result<Turn, PlanFault> {
    match alone(item, site)? {
        Step::Condition(Condition::Yaw(turn)) => Ok(turn),
        _ => Err(unsupported(site)),
    }
}

/// The number of an item that is no part of a mission: as any item but home.
fn alone_index(site: &Site) -> usize {
    usize::from(site.identity.is_ardupilot())
}

/// The step of an item that is no part of a mission, once it has been checked.
fn alone(item: &MissionItem, site: &Site) -> Result<Step, PlanFault> {
    check::item(PlanKind::Mission, alone_index(site), item, site)?;
    Ok(step(item, &[], site))
}

fn unsupported(site: &Site) -> PlanFault {
    PlanFault::of_item(alone_index(site), FaultCode::Unsupported, "not supported")
}

fn step(item: &MissionItem, items: &[MissionItem], site: &Site) -> Step {
    let source = Source { item, items, site };
    mission_command(item.command).map_or(Step::Pass, |command| (command.step)(&source))
}

#[cfg(test)]
mod tests {

    use nalgebra::Vector3;
    use proptest::prelude::*;

    use super::super::command::*;
    use super::super::mission_command::mission_command;
    use super::super::step::{Condition, Do, Navigate, Step, Turn, TurnTo, Waypoint};
    use super::super::{Altitude, Look, MissionItem, Place, PlanKind, Site, check, frame};
    use super::{look, mission, rally_points};
    use crate::identity::Identity;
    use crate::world::{Geodetic, LocalFrame};

    const NAN: f64 = f64::NAN;

    fn site(identity: Identity) -> Site {
        let origin = Geodetic { latitude_deg: 47.0, longitude_deg: 8.0, altitude_m: 400.0 };
        Site {
            identity,
            frame: LocalFrame::new(origin),
            home_m: Vector3::new(1.0, 2.0, -3.0),
            terrain: crate::surroundings::Terrain::default(),
        }
    }

    fn item(command: u16, parameters: [f64; 4], position: [f64; 3]) -> MissionItem {
        MissionItem { frame: frame::LOCAL_NED, command, parameters, position, autocontinue: true }
    }

    fn place([x, y, z]: [f64; 3]) -> Place {
        Place { horizontal_m: Some([x, y]), altitude: Some(Altitude::Down(z)) }
    }

    /// The step of an item that is checked, behind one that it may jump to.
    fn step(item: MissionItem, site: &Site) -> Step {
        let first =
            MissionItem { position: [7.0, 8.0, -9.0], ..self::item(NAV_WAYPOINT, [0.0; 4], [0.0; 3]) };
        let items = [first, item];
        check::plan(PlanKind::Mission, &items, site).expect("it is taken");
        mission(&items, site).step(1).expect("it is there")
    }

    #[test]
    fn ardupilot_has_conventions_of_its_own() {
        let site = site(Identity::ArduPilot);
        let at = [30.0, -40.0, -10.0];
        let waypoint = step(item(NAV_WAYPOINT, [0.0; 4], at), &site);
        assert!(matches!(waypoint, Step::Navigate(Navigate::Waypoint(Waypoint { heading_rad: None, .. }))));
        let takeoff = step(item(NAV_TAKEOFF, [0.0; 4], at), &site);
        assert_eq!(takeoff, Step::Navigate(Navigate::Takeoff { place: place(at), travels: false }));
        // Home is never checked, and waits for nobody.
        let home =
            MissionItem { frame: 77, command: 9999, autocontinue: false, ..item(0, [NAN; 4], [NAN; 3]) };
        let program =
            mission(&[home, MissionItem { autocontinue: false, ..item(NAV_WAYPOINT, [0.0; 4], at) }], &site);
        assert_eq!((program.first(), program.step(0)), (1, Some(Step::Pass)));
        assert!(program.continues_after(1) && program.is_flown());
    }

    #[test]
    fn altitudes_keep_what_they_refer_to() {
        let site = site(Identity::Px4);
        let at = |frame, altitude_m| MissionItem {
            frame,
            ..item(NAV_RALLY_POINT, [0.0; 4], [0.0, 0.0, altitude_m])
        };
        let items = [
            at(frame::GLOBAL_RELATIVE_INT, 10.0),
            at(frame::GLOBAL, 420.0),
            at(frame::GLOBAL_TERRAIN, 5.0),
            at(frame::LOCAL_NED, -6.0),
            at(frame::GLOBAL_RELATIVE, NAN),
        ];
        let points = rally_points(&items, &site);
        let down_m = |home_z_m| points.iter().map(|place| place.down_m(home_z_m)).collect::<Vec<_>>();
        assert_eq!(down_m(-3.0), [Some(-13.0), Some(-20.0), Some(-5.0), Some(-6.0), None]);
        assert_eq!(down_m(0.0), [Some(-10.0), Some(-20.0), Some(-5.0), Some(-6.0), None]);
        // Zeros are "here" in a global frame, and a place in the local one.
        assert_eq!(
            points.iter().map(|place| place.horizontal_m.is_some()).collect::<Vec<_>>(),
            [false, false, false, true, false]
        );
    }

    #[test]
    fn a_look_names_an_item_of_the_mission() {
        let site = site(Identity::Px4);
        let items = [item(NAV_WAYPOINT, [0.0; 4], [1.0, 2.0, -3.0])];
        let named = |number| look(&item(DO_SET_ROI, [2.0, number, 0.0, 0.0], [0.0; 3]), &items, &site);
        assert_eq!(named(0.0), Ok(Some(Look::At(place([1.0, 2.0, -3.0])))));
        for number in [1.0, -1.0, NAN] {
            assert_eq!(
                named(number).unwrap_err().reason,
                format!("no item has sequence number {number}; the plan has 1 items")
            );
        }
        assert!(look(&items[0], &items, &site).is_err(), "a waypoint is no look");
    }

    /// Angles of commands are up to this, °. A relative turn may be more than one turn.
    const MOST_DEG: f64 = 400.0;

    fn number() -> impl Strategy<Value = f64> {
        prop_oneof![
            3 => Just(NAN),
            2 => Just(0.0),
            1 => prop::sample::select(vec![f64::INFINITY, f64::NEG_INFINITY, -0.0, 1e300, f64::MIN_POSITIVE]),
            4 => (-2_i32..4).prop_map(f64::from),
            3 => -MOST_DEG..MOST_DEG,
        ]
    }

    /// Latitudes and longitudes near the site, metres, and what is neither.
    fn position() -> impl Strategy<Value = [f64; 3]> {
        prop_oneof![
            [46.9..47.1, 7.9..8.1, 410.0..430.0],
            [-50.0..50.0, -50.0..50.0, -50.0..0.0],
            [number(), number(), number()],
        ]
    }

    prop_compose! {
        fn any_item()(
            command in prop_oneof![
                20 => prop::sample::select((0..=u16::MAX).filter(|number| mission_command(*number).is_some()).collect::<Vec<_>>()),
                1 => any::<u16>(),
            ],
            frame in 0_u8..13, parameters in [number(), number(), number(), number()], position in position(),
            autocontinue in any::<bool>(),
        ) -> MissionItem {
            MissionItem { frame, command, parameters, position, autocontinue }
        }
    }

    fn angles_rad(step: &Step) -> Vec<f64> {
        match step {
            Step::Navigate(
                Navigate::Waypoint(Waypoint { heading_rad, .. })
                | Navigate::Loiter { heading_rad, .. }
                | Navigate::Land { heading_rad, .. },
            ) => heading_rad.iter().copied().collect(),
            Step::Condition(Condition::Yaw(Turn {
                to: TurnTo::By(to_rad) | TurnTo::Heading(to_rad, _),
                rate_rad_s,
            })) => rate_rad_s.iter().copied().chain([*to_rad]).collect(),
            Step::Do(Do::Look(Some(Look::NextWaypoint { offset_rad }))) => vec![*offset_rad],
            _ => Vec::new(),
        }
    }

    proptest! {
        #[test]
        fn what_is_taken_has_neither_nan_nor_degrees(
            mut items in prop::collection::vec(any_item(), 1..20), ardupilot in any::<bool>(),
        ) {
            let site = site(if ardupilot { Identity::ArduPilot } else { Identity::Px4 });
            // Each by itself (in ArduPilot's convention behind home), so that jumps have where to go.
            let home = MissionItem::home([47.0, 8.0, 400.0]);
            items.retain(|item| check::plan(PlanKind::Mission, &[home, *item], &site).is_ok());
            items.insert(0, home);
            prop_assert!(items.len() == 1 || check::plan(PlanKind::Mission, &items, &site).is_ok());
            let program = mission(&items, &site);
            for (index, item) in items.iter().enumerate().skip(1) {
                let step = program.step(index).expect("one for each item");
                let told = format!("{step:?}");
                prop_assert!(!told.contains("NaN") && !told.contains("inf"), "{item:?} became {told}");
                prop_assert!(step != Step::Pass, "{item:?}");
                for angle_rad in angles_rad(&step) {
                    prop_assert!(angle_rad.abs() <= MOST_DEG.to_radians(), "{item:?} became {told}");
                }
            }
        }
    }
}
