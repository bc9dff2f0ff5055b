//! The orbit mode: PX4's Orbit, ArduPilot's CIRCLE.
//!
//! ```text
//!  mode ──► Stopping ──► plan ──► Approaching ──on the circle──► Around ──way is flown──► Hold
//!                          ▲           ▲                            │
//!          PX4: a command ─┘           └── other radius or centre ──┘
//! ```

use nalgebra::Vector3;

use super::circle::Circle;
use super::circle_pilot::CirclePilot;
use super::motion::wrapped;
use super::notice::{Refusal, Severity};
use super::orbit_request::{OrbitHeading, OrbitRequest, OrbitStatus};
use super::proposal::Proposal;
use super::set_point::{AxisTarget, PositionSetPoint, YawTarget};
use super::situation::Situation;
use super::steering::{Steering, SteeringKind};
use super::tick::TICK_S;
use crate::mode::Mode;

/// Share of the horizontal acceleration that points to the centre: half of it on ArduPilot's circle; PX4's largest is 2 m/s², which
/// is this share of ours.
const CENTRIPETAL_ARDUPILOT: f64 = 0.5;
const CENTRIPETAL_PX4: f64 = 0.8;
/// PX4's smallest radius, m, fastest orbit, m/s, and speed unless a command says one, m/s.
const SMALLEST_RADIUS_M: f64 = 1.0;
const FASTEST_M_S: f64 = 10.0;
const DEFAULT_SPEED_M_S: f64 = 1.0;
/// So slow, m/s, and so near, m, a reference has come to rest at a goal.
const RESTS_M_S: f64 = 0.01;
const ARRIVED_M: f64 = 0.01;
/// What is left of a way, m, that counts as flown.
const FLOWN_M: f64 = 1e-3;
/// Places of a circle that the fence is asked about.
const CHECKED_PLACES: usize = 36;

/// What is flown.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Asked {
    centre_m: Option<[f64; 2]>,
    down_m: Option<f64>,
    radius_m: f64,
    /// Positive clockwise seen from above.
    speed_m_s: f64,
    heading: OrbitHeading,
    way_rad: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Default)]
enum Phase {
    /// It brakes.
    #[default]
    Stopping,
    /// To the circle.
    Approaching(Circle),
    /// On it.
    Around(Circle),
    /// A circle without a radius: on the spot.
    Turning,
}

/// The orbit.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Orbit {
    asked: Option<Asked>,
    phase: Phase,
    initial_yaw_rad: f64,
    /// Whether the pilot has changed the height, and the heading.
    lifted: bool,
    turned: bool,
    /// What the sticks do to the circle.
    pilot: CirclePilot,
    /// ArduPilot's radius, m, and rate, rad/s, as they were last looked at.
    heeded: Option<[f64; 2]>,
}

impl Orbit {
    /// The orbit that is flown, or flown to.
    pub fn status(&self) -> Option<OrbitStatus> {
        let asked = self.asked?;
        let (Phase::Approaching(circle) | Phase::Around(circle)) = self.phase else { return None };
        let radius_m = libm::copysign(circle.radius_m(), asked.speed_m_s);
        Some(OrbitStatus { centre_m: circle.centre_m(), radius_m })
    }

    /// The mode begins: it brakes, and then goes around.
    pub fn begin(&mut self, situation: &Situation, proposal: &mut Proposal) {
        *self = Self { initial_yaw_rad: situation.outputs.attitude_rad.z, ..Self::default() };
        proposal.hold(situation);
    }

    /// The circle that a request means now, for who wants to know whether it can be flown.
    ///
    /// # Errors
    /// [`Refusal::Denied`] for a circle that the fence forbids.
    pub fn check(&self, situation: &Situation, request: &OrbitRequest) -> Result<(), Refusal> {
        let before = self.asked.filter(|_| situation.mode == Mode::Orbit);
        let circle = planned(&asked_by(request, before, situation), situation);
        let part_rad = core::f64::consts::TAU / CHECKED_PLACES as f64;
        let mut places = (0..CHECKED_PLACES).map(|part| circle.place_m(part as f64 * part_rad));
        match places.find_map(|place_m| situation.breach_at(&place_m)) {
            Some(breach) => Err(Refusal::denied(format!("Orbit rejected: {breach}"))),
            None => Ok(()),
        }
    }

    /// Flies an orbit that a command asks for, in the mode that has begun.
    pub fn ask(&mut self, request: &OrbitRequest, situation: &Situation, proposal: &mut Proposal) {
        self.initial_yaw_rad = situation.outputs.attitude_rad.z;
        (self.lifted, self.turned) = (false, false);
        let asked = asked_by(request, self.asked, situation);
        self.approach(asked, situation, proposal);
    }

    /// One tick of the mode.
    pub fn step(&mut self, situation: &Situation, proposal: &mut Proposal) {
        if proposal.steering().kind() == SteeringKind::Idle {
            return;
        }
        if situation.identity.is_ardupilot() {
            self.heed_parameters(situation, proposal);
        }
        match self.phase {
            Phase::Stopping if rests(situation) => self.start(situation, proposal),
            Phase::Approaching(circle) if has_arrived(situation, proposal.steering(), &circle) => {
                self.phase = Phase::Around(circle);
                self.go_around(circle, situation, proposal);
            }
            Phase::Around(circle) => self.go_around(circle, situation, proposal),
            Phase::Turning => {
                let yaw = YawTarget::Rate(situation.conduct.orbit.rate_rad_s);
                proposal.follow(situation, &PositionSetPoint { axes: [AxisTarget::HOLD; 3], yaw });
            }
            Phase::Stopping | Phase::Approaching(_) => {}
        }
    }

    /// The orbit of the mode by itself, once the vehicle rests.
    fn start(&mut self, situation: &Situation, proposal: &mut Proposal) {
        if !situation.identity.is_ardupilot() {
            let asked = asked_by(&OrbitRequest::default(), None, situation);
            return self.approach(asked, situation, proposal);
        }
        let asked = ardupilot_circle(situation);
        if asked.radius_m == 0.0 {
            (self.asked, self.phase) = (Some(asked), Phase::Turning);
            return;
        }
        self.approach(asked, situation, proposal);
    }

    /// ArduPilot's circle follows its parameters in flight.
    fn heed_parameters(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let Some(before) = self.asked else { return };
        let settings = &situation.conduct.orbit;
        let heading = ardupilot_heading(situation);
        let now = [settings.radius_m, settings.rate_rad_s];
        // What the pilot has changed stays until a parameter changes.
        if self.heeded.replace(now).is_none_or(|before| before == now) {
            self.asked = Some(Asked { heading, ..before });
            return;
        }
        let (radius_m, speed_m_s) = (settings.radius_m, settings.rate_rad_s * settings.radius_m);
        let wanted = Asked { radius_m, speed_m_s, heading, ..before };
        if wanted.radius_m != before.radius_m || wanted.speed_m_s * before.speed_m_s < 0.0 {
            if wanted.radius_m == 0.0 {
                self.phase = Phase::Turning;
            } else {
                self.approach(wanted, situation, proposal);
            }
        }
        self.asked = Some(wanted);
    }

    /// The pilot of ArduPilot's circle changes its radius and rate. Returns whether it goes the other way around now.
    fn heed_pilot(&mut self, circle: &mut Circle, asked: &mut Asked, situation: &Situation) -> bool {
        if !self.pilot.acts(situation) {
            return false;
        }
        let acceleration_m_s2 = Circle::tangential_m_s2(situation.limits());
        let rate_rad_s = self.pilot.rate_rad_s(situation, asked.speed_m_s / asked.radius_m);
        let widens_m_s = self.pilot.widen(situation, circle.radius_m(), SMALLEST_RADIUS_M, acceleration_m_s2);
        circle.widen(widens_m_s, TICK_S);
        (asked.radius_m, asked.speed_m_s) = (circle.radius_m(), rate_rad_s * circle.radius_m());
        self.asked = Some(*asked);
        rate_rad_s != 0.0 && (rate_rad_s > 0.0) != circle.is_clockwise()
    }

    /// Straight to the nearest point of the circle, at its height.
    fn approach(&mut self, asked: Asked, situation: &Situation, proposal: &mut Proposal) {
        let circle = planned(&asked, situation);
        (self.asked, self.phase) = (Some(asked), Phase::Approaching(circle));
        let yaw = match asked.heading {
            OrbitHeading::Centre => YawTarget::Angle(circle.heading_rad()),
            OrbitHeading::Travel => YawTarget::Angle(circle.heading_of_travel_rad()),
            OrbitHeading::Initial => YawTarget::Angle(self.initial_yaw_rad),
            OrbitHeading::Free | OrbitHeading::Pilot => YawTarget::Hold,
        };
        let axes = circle.position_m().data.0[0].map(AxisTarget::Position);
        proposal.follow(situation, &PositionSetPoint { axes, yaw });
    }

    fn go_around(&mut self, mut circle: Circle, situation: &Situation, proposal: &mut Proposal) {
        let (Some(mut asked), limits) = (self.asked, situation.limits()) else { return };
        if self.heed_pilot(&mut circle, &mut asked, situation) {
            self.approach(asked, situation, proposal);
            return;
        }
        let share = if situation.identity.is_ardupilot() { CENTRIPETAL_ARDUPILOT } else { CENTRIPETAL_PX4 };
        let tangential_m_s2 = Circle::tangential_m_s2(limits);
        let mut wanted_m_s = asked.speed_m_s.abs().min(circle.fastest_m_s(share, limits));
        if let Some(way_rad) = asked.way_rad {
            let left_m = (way_rad - circle.flown_rad()) * circle.radius_m();
            if left_m <= FLOWN_M {
                proposal.say(Severity::Info, "Orbit complete");
                proposal.enter(situation.holding_mode());
                return;
            }
            wanted_m_s = wanted_m_s.min(libm::sqrt(2.0 * tangential_m_s2 * left_m).max(0.01));
        }
        let mut set_point = circle.advance(wanted_m_s, tangential_m_s2, limits, TICK_S);
        let rate_rad_s = circle.yaw_rate_rad_s();
        set_point.yaw = match asked.heading {
            OrbitHeading::Centre => YawTarget::Follow(circle.heading_rad(), rate_rad_s),
            OrbitHeading::Travel => YawTarget::Follow(circle.heading_of_travel_rad(), rate_rad_s),
            OrbitHeading::Initial => YawTarget::Angle(self.initial_yaw_rad),
            OrbitHeading::Free | OrbitHeading::Pilot => YawTarget::Hold,
        };
        self.heed_sticks(&asked, &mut set_point, situation);
        proposal.follow(situation, &set_point);
        self.phase = Phase::Around(circle);
    }

    /// The throttle climbs; the yaw stick turns where it may: on ArduPilot's circle always, on PX4's where the pilot has the heading.
    fn heed_sticks(&mut self, asked: &Asked, set_point: &mut PositionSetPoint, situation: &Situation) {
        let sticks = situation.pilot.sticks;
        let wanted =
            sticks.map(|sticks| sticks.set_point(situation.conduct, 0.0, situation.limits().yaw_rate_rad_s));
        let climb = wanted.map_or(AxisTarget::HOLD, |wanted| wanted.axes[2]);
        let yaw = wanted.map_or(YawTarget::Hold, |wanted| wanted.yaw);
        self.lifted |= climb != AxisTarget::HOLD;
        self.turned |= yaw != YawTarget::Hold;
        if self.lifted {
            set_point.axes[2] = climb;
        }
        let may_turn = situation.identity.is_ardupilot() || asked.heading == OrbitHeading::Pilot;
        if self.turned && may_turn {
            set_point.yaw = yaw;
        }
    }
}

/// What a request means: what it leaves open is as before, or as the vehicle has it.
fn asked_by(request: &OrbitRequest, before: Option<Asked>, situation: &Situation) -> Asked {
    let settings = &situation.conduct.orbit;
    let before = before.unwrap_or(Asked {
        centre_m: None,
        down_m: None,
        radius_m: settings.radius_m,
        speed_m_s: DEFAULT_SPEED_M_S,
        heading: settings.heading,
        way_rad: None,
    });
    let clockwise = match request.radius_m {
        Some(radius_m) => libm::copysign(1.0, radius_m),
        None => libm::copysign(1.0, before.speed_m_s),
    };
    let speed_m_s = request.speed_m_s.unwrap_or(before.speed_m_s.abs()).clamp(-FASTEST_M_S, FASTEST_M_S);
    let radius_m = request.radius_m.map_or(before.radius_m, f64::abs);
    Asked {
        centre_m: request.centre_m.or(before.centre_m),
        down_m: request.down_m.or(before.down_m),
        radius_m: radius_m.min(settings.largest_radius_m).max(SMALLEST_RADIUS_M),
        speed_m_s: clockwise * speed_m_s,
        heading: request.heading.unwrap_or(before.heading),
        way_rad: request.way_rad.or(before.way_rad),
    }
}

/// ArduPilot's circle: its centre is ahead of where it rests, unless an option puts it there.
fn ardupilot_circle(situation: &Situation) -> Asked {
    let settings = &situation.conduct.orbit;
    let here = &situation.outputs.setpoint;
    let (sin, cos) = libm::sincos(here.yaw_rad);
    let ahead_m = if settings.begins_at_centre() { 0.0 } else { settings.radius_m };
    Asked {
        centre_m: Some([here.position_m.x + ahead_m * cos, here.position_m.y + ahead_m * sin]),
        down_m: None,
        radius_m: settings.radius_m,
        speed_m_s: settings.rate_rad_s * settings.radius_m,
        heading: ardupilot_heading(situation),
        way_rad: None,
    }
}

fn ardupilot_heading(situation: &Situation) -> OrbitHeading {
    if situation.conduct.orbit.faces_travel() { OrbitHeading::Travel } else { OrbitHeading::Centre }
}

/// The circle from its point that is nearest to the vehicle; from behind it if it is at the centre.
fn planned(asked: &Asked, situation: &Situation) -> Circle {
    const AT_CENTRE_M: f64 = 0.1;
    let here = &situation.outputs.setpoint;
    let [x, y] = asked.centre_m.unwrap_or([here.position_m.x, here.position_m.y]);
    let centre_m = Vector3::new(x, y, asked.down_m.unwrap_or(here.position_m.z));
    let off = (here.position_m - centre_m).xy();
    let start_rad = if off.norm() > AT_CENTRE_M {
        libm::atan2(off.y, off.x)
    } else {
        wrapped(here.yaw_rad + core::f64::consts::PI)
    };
    Circle::starting_at(centre_m, start_rad, libm::copysign(asked.radius_m, asked.speed_m_s))
}

/// Whether the reference has come to rest.
fn rests(situation: &Situation) -> bool {
    situation.outputs.setpoint.velocity_m_s.norm() < RESTS_M_S
}

/// Whether the shaper rests on the circle.
fn has_arrived(situation: &Situation, steering: &Steering, circle: &Circle) -> bool {
    let off_m = (situation.outputs.setpoint.position_m - circle.position_m()).norm();
    matches!(steering, Steering::Goal(_)) && off_m < ARRIVED_M && rests(situation)
}
