//! What is said of vehicles at the bottom of the terminal.

use std::collections::BTreeMap;

use nalgebra::Vector3;
use vehicle::MissionState;

use super::panel::Form;
use super::segment::Segment;
use crate::fleet::{Fleet, Member};
use crate::link::Links;

/// Ranks of the segments: the state is said in any case.
const STATE: u8 = 0;
const PLACE: u8 = 2;
const BATTERY: u8 = 3;
const CLIENTS: u8 = 5;
/// What only a panel says.
const DETAIL: u8 = 6;

/// A line of segments.
type Row = Vec<Segment>;

/// The state of a fleet.
pub fn of_fleet(fleet: &Fleet, form: Form) -> Vec<Row> {
    let clients: usize = fleet.hubs().iter().map(Links::active_peers).sum();
    let clients = Segment::new(CLIENTS, counted(clients, "client"));
    match (form, fleet.members()) {
        (Form::Panel { .. }, [only]) => [of_one(only), links(fleet.hubs())].concat(),
        (Form::Panel { most }, many) => {
            let mut head = of_many(many);
            head.push(clients);
            let mut rows = vec![head];
            // With links of their own, a line of each vehicle says who is there.
            let own_links = fleet.hubs().len() > 1;
            if !own_links {
                rows.extend(links(fleet.hubs()));
            }
            let left = most.saturating_sub(rows.len());
            rows.extend(cut(many.iter().map(|member| of_member(member, fleet, own_links)).collect(), left));
            rows
        }
        (Form::Line, members) => {
            let mut row = match members {
                [only] => of_one(only).concat().into_iter().filter(|segment| segment.rank < DETAIL).collect(),
                many => of_many(many),
            };
            row.push(clients);
            vec![row]
        }
    }
}

/// The state of an external autopilot, and where the vehicle is and how it moves, NED, m and m/s.
pub fn of_autopilot(
    state: &str,
    position_m: &Vector3<f64>,
    velocity_m_s: &Vector3<f64>,
    form: Form,
) -> Vec<Row> {
    let state = Segment::new(STATE, state);
    match form {
        Form::Line => vec![vec![state, place(position_m)]],
        Form::Panel { .. } => vec![vec![state], [vec![place(position_m)], motion(velocity_m_s)].concat()],
    }
}

/// Nobody is there yet.
pub fn waiting() -> Vec<Row> {
    vec![vec![Segment::new(STATE, "waiting for an autopilot")]]
}

/// One vehicle: state; place and motion; battery and mission.
fn of_one(member: &Member) -> Vec<Row> {
    let vehicle = member.autopilot().vehicle();
    let outputs = vehicle.outputs();
    let heading_deg = outputs.attitude_rad.z.to_degrees().rem_euclid(360.0).round() % 360.0;
    let mut moving = vec![place(&outputs.position_m)];
    moving.extend(motion(&outputs.velocity_m_s));
    moving.push(Segment::new(DETAIL, format!("heading {heading_deg:3.0} deg")));
    let supply = vehicle.battery();
    let power = format!("{:.1} V {:.1} A", supply.voltage_v(), supply.current_a());
    let mut holding = vec![battery(vehicle.battery_remaining()), Segment::new(DETAIL, power)];
    holding.extend(mission(member));
    vec![vec![state(member)], moving, holding]
}

/// How many are in which state, and the weakest battery.
fn of_many(members: &[Member]) -> Row {
    let lost = members.iter().filter(|member| member.loss().is_some()).count();
    let flying = || members.iter().filter(|member| member.loss().is_none());
    let vehicles = || flying().map(|member| member.autopilot().vehicle());
    let armed = vehicles().filter(|vehicle| vehicle.is_armed()).count();
    let mut modes = BTreeMap::new();
    for vehicle in vehicles() {
        *modes.entry(vehicle.identity().mode_name(vehicle.shown_mode())).or_insert(0) += 1;
    }
    let modes: Vec<String> = modes.into_iter().map(|(mode, count)| format!("{count} {mode}")).collect();
    let state = match lost {
        0 => format!("{armed} of {} armed", members.len()),
        _ => format!("{armed} of {} armed, {lost} lost", members.len()),
    };
    vec![
        Segment::new(STATE, state),
        Segment::new(PLACE, modes.join(", ")),
        battery(vehicles().map(|vehicle| vehicle.battery_remaining()).fold(1.0, f64::min)),
    ]
}

/// One vehicle of several.
fn of_member(member: &Member, fleet: &Fleet, own_links: bool) -> Row {
    let vehicle = member.autopilot().vehicle();
    let outputs = vehicle.outputs();
    let number = Segment::new(STATE, format!("id {:3}", member.autopilot().system_id()));
    let state = state(member);
    let mut row = vec![
        number,
        Segment::new(STATE, format!("{:<16}", state.text)),
        place(&outputs.position_m),
        Segment::new(DETAIL, format!("{:4.1} m/s", outputs.velocity_m_s.norm())),
        battery(vehicle.battery_remaining()),
    ];
    if let Some(links) = fleet.hubs().get(member.hub()).filter(|_| own_links) {
        row.push(Segment::new(CLIENTS, counted(links.active_peers(), "client")));
    }
    row
}

/// The links, each with its clients.
fn links(hubs: &[Links]) -> Vec<Row> {
    let described =
        hubs.iter().flat_map(|links| links.descriptions().into_iter().zip(links.active_peers_by_link()));
    let row = |(description, clients)| {
        vec![
            Segment::new(CLIENTS, format!("{:>9}", counted(clients, "client"))),
            Segment::new(DETAIL, description),
        ]
    };
    described.map(row).collect()
}

/// As many rows as there is room for; the last one says how many more there are.
fn cut(mut rows: Vec<Row>, most: usize) -> Vec<Row> {
    if rows.len() > most {
        let kept = most.saturating_sub(1);
        let more = rows.len() - kept;
        rows.truncate(kept);
        rows.push(vec![Segment::new(STATE, format!("and {}", counted(more, "more vehicle")))]);
    }
    rows
}

fn state(member: &Member) -> Segment {
    let vehicle = member.autopilot().vehicle();
    if member.loss().is_some() {
        return Segment::new(STATE, "lost");
    }
    let armed = if vehicle.is_armed() { "armed" } else { "disarmed" };
    Segment::new(STATE, format!("{armed} {}", vehicle.identity().mode_name(vehicle.shown_mode())))
}

/// Where the mission is, if there is one.
fn mission(member: &Member) -> Option<Segment> {
    let vehicle = member.autopilot().vehicle();
    let status = vehicle.mission_status();
    // In ArduPilot's convention item 0 is home.
    let number = status.current + usize::from(!vehicle.identity().is_ardupilot());
    let text = match status.state {
        MissionState::None => return None,
        MissionState::NotStarted => format!("mission of {} ready", counted(status.total, "item")),
        MissionState::Active => format!("mission: item {number} of {}", status.total),
        MissionState::Paused => format!("mission paused at item {number} of {}", status.total),
        MissionState::Complete => "mission complete".to_owned(),
    };
    Some(Segment::new(DETAIL, text))
}

/// How it moves, NED, m/s.
fn motion(velocity_m_s: &Vector3<f64>) -> Row {
    let [north, east, down] = velocity_m_s.data.0[0];
    vec![
        Segment::new(DETAIL, format!("speed {:4.1} m/s", north.hypot(east))),
        Segment::new(DETAIL, format!("climb {:4.1} m/s", tenths(-down))),
    ]
}

fn place(position_m: &Vector3<f64>) -> Segment {
    let [north, east, down] = position_m.data.0[0];
    Segment::new(PLACE, format!("N {:5.1} E {:5.1} up {:4.1} m", tenths(north), tenths(east), tenths(-down)))
}

/// Rounded to tenths, and zero without a sign.
fn tenths(value: f64) -> f64 {
    (value * 10.0).round() / 10.0 + 0.0
}

fn battery(remaining: f64) -> Segment {
    Segment::new(BATTERY, format!("battery {:.0} %", 100.0 * remaining))
}

fn counted(number: usize, what: &str) -> String {
    format!("{number} {what}{}", if number == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::{Row, Segment, cut};

    #[test]
    fn the_last_line_says_how_many_vehicles_have_no_room() {
        let rows = |count: usize| -> Vec<Row> {
            (0..count).map(|number| vec![Segment::new(0, number.to_string())]).collect()
        };
        let texts = |count, most| -> Vec<String> {
            cut(rows(count), most).into_iter().flatten().map(|segment| segment.text).collect()
        };
        assert_eq!(texts(3, 3), ["0", "1", "2"]);
        assert_eq!(texts(4, 3), ["0", "1", "and 2 more vehicles"]);
        assert_eq!(texts(4, 1), ["and 4 more vehicles"]);
    }
}
