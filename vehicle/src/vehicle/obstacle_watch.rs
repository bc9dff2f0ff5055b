//! What stands around the vehicle: measuring it, stopping before it, and noticing that it was touched.

use nalgebra::{Vector2, Vector3};

use super::fence_watch::stopping_place_m;
use super::notice::Severity;
use super::proposal::Proposal;
use super::proximity_keeping::keep_away;
use super::set_point::{AxisTarget, PositionSetPoint};
use super::situation::Situation;
use super::surface_tracking::Surface;
use crate::mode::{Leader, Mode};
use crate::surroundings::{Aircraft, Obstacle, RangeScan, Reading, SECTOR_RAD, SECTORS};

/// The lidar turns ten times per second.
const TURN_US: u64 = 100_000;
/// A scan older than this, µs, counts as none.
const OLD_US: u64 = 500_000;
/// What comes within this, µs, is of one frame: the nearest of it counts.
const FRAME_US: u64 = 20_000;
/// So near to the distance that is kept, m, the vehicle does not set out towards an obstacle.
const SLACK_M: f64 = 0.6;
/// A vehicle that was stopped sets out again when it has so much more room than it needs to brake, m.
const ROOM_M: f64 = 1.0;
/// Slower than this, m/s, it stands.
const STANDING_M_S: f64 = 0.1;
/// What is asked for and smaller than this, m or m/s, is no direction.
const SMALL: f64 = 0.02;
/// What is nearer than the distance that is kept stops only a motion that leads towards it within this cosine.
const TOWARDS: f64 = 0.5;
/// ArduPilot's kind of the instrument that its simulation has (PRX1_TYPE).
const SIMULATED: u8 = 10;
/// A stop is told again when the way was free for so long, µs.
const TOLD_US: u64 = 2_000_000;
/// The sphere around the vehicle that must touch nothing, in lengths of its arms.
const REACH_ARMS: f64 = 1.5;

/// The obstacles, and what is measured of them.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct ObstacleWatch {
    obstacles: Vec<Obstacle>,
    lidar: Option<RangeScan>,
    /// What a companion computer has told, the latest last. Each has its own time and place.
    companion: Vec<RangeScan>,
    /// Distance below, m, and what it is the distance to.
    below_m: Option<f64>,
    surface: Option<Surface>,
    /// Whether it is kept from going on.
    stopped: bool,
    /// When it was stopped last, µs.
    stopped_us: Option<u64>,
    /// Whether it was told that nothing is measured.
    told_blind: bool,
    /// Whether a switch of the pilot has switched the rangefinder off.
    rangefinder_off: bool,
    /// Whether one has switched off that a distance is kept.
    proximity_off: bool,
}

impl ObstacleWatch {
    /// Among these obstacles.
    pub fn new(obstacles: Vec<Obstacle>) -> Self {
        Self { obstacles, ..Self::default() }
    }

    /// The latest turn of our lidar; `None` without obstacles.
    pub fn lidar(&self) -> Option<&RangeScan> {
        self.lidar.as_ref()
    }

    /// What a companion computer tells, if that is not too old.
    pub fn companion(&self, time_us: u64) -> Option<RangeScan> {
        self.told(time_us).copied().reduce(|mut together, scan| {
            together.merge(&scan);
            together
        })
    }

    fn told(&self, time_us: u64) -> impl Iterator<Item = &RangeScan> {
        self.companion.iter().filter(move |scan| is_fresh(scan, time_us))
    }

    /// Whether something measures around, or is to by the parameters.
    pub fn has_proximity(&self, situation: &Situation) -> bool {
        let chosen = situation.identity.is_ardupilot() && situation.conduct.surroundings.proximity_kind > 0;
        self.lidar.is_some() || chosen
    }

    /// Whether it measures now.
    pub fn measures_around(&self, situation: &Situation) -> bool {
        let simulated = situation.conduct.surroundings.proximity_kind == SIMULATED;
        self.lidar.is_some() || simulated || self.told(situation.time_us).next().is_some()
    }

    /// Whether a distance is kept from what is measured, as far as a switch says.
    pub fn proximity_is_on(&self) -> bool {
        !self.proximity_off
    }

    /// What the downward rangefinder shows, m; `None` if there is none, or nothing is in its range.
    pub fn below_m(&self) -> Option<f64> {
        self.below_m
    }

    /// What it shows, if it is switched on.
    pub fn surface(&self) -> Option<Surface> {
        self.surface.filter(|_| !self.rangefinder_off)
    }

    /// Whether there is a rangefinder.
    pub fn has_rangefinder(&self, situation: &Situation) -> bool {
        let world = !self.obstacles.is_empty() || !situation.terrain.is_flat();
        world || situation.conduct.surroundings.rangefinder_kind > 0
    }

    /// Whether it is switched on.
    pub fn rangefinder_is_on(&self) -> bool {
        !self.rangefinder_off
    }

    /// Switches the rangefinder on or off.
    pub fn switch_rangefinder(&mut self, on: bool) {
        self.rangefinder_off = !on;
    }

    /// Lets a distance be kept, or not.
    pub fn switch_proximity(&mut self, on: bool) {
        self.proximity_off = !on;
    }

    /// Takes what a companion computer measures. Sectors that it does not know keep what it knew a moment ago.
    pub fn take(&mut self, scan: RangeScan) {
        let ended = |known: &RangeScan| known.time_us + FRAME_US < scan.time_us;
        for known in self.companion.iter_mut().filter(|known| ended(known)) {
            for (known, news) in known.sectors.iter_mut().zip(scan.sectors) {
                if news != Reading::Unknown {
                    *known = Reading::Unknown;
                }
            }
        }
        self.companion.retain(|known| {
            is_fresh(known, scan.time_us)
                && known.heading_rad == scan.heading_rad
                && known.sectors.iter().any(|reading| *reading != Reading::Unknown)
        });
        match self.companion.last_mut() {
            Some(latest) if latest.time_us == scan.time_us => latest.merge(&scan),
            _ => self.companion.push(scan),
        }
    }

    /// Measures what is there after a tick.
    pub fn measure(&mut self, situation: &Situation) {
        let outputs = situation.outputs;
        if !situation.time_us.is_multiple_of(TURN_US) {
            return;
        }
        if self.has_rangefinder(situation) {
            self.below_m = self.look_down(situation);
            let down_z = (outputs.orientation() * Vector3::z()).z;
            self.surface = self.below_m.map(|below_m| Surface {
                z_m: outputs.position_m.z + below_m * down_z,
                time_us: situation.time_us,
            });
        }
        if !self.obstacles.is_empty() {
            self.lidar = Some(RangeScan::of_obstacles(
                &self.obstacles,
                &situation.truth.position_m,
                situation.time_us,
                outputs.position_m,
                outputs.attitude_rad.z,
            ));
        }
    }

    fn look_down(&self, situation: &Situation) -> Option<f64> {
        let truth = situation.truth;
        let down = truth.orientation() * Vector3::z();
        let settings = &situation.conduct.surroundings;
        let ground_m = if situation.terrain.is_flat() {
            (down.z > 0.1).then(|| -truth.position_m.z / down.z)
        } else {
            situation.terrain.along_m(&truth.position_m, &down, settings.rangefinder_farthest_m)
        };
        let others = self.obstacles.iter().filter_map(|obstacle| obstacle.along_m(&truth.position_m, &down));
        let nearest_m = others.chain(ground_m).fold(f64::INFINITY, f64::min);
        let range_m = nearest_m.max(settings.rangefinder_nearest_m);
        (range_m <= settings.rangefinder_farthest_m).then_some(range_m)
    }

    /// What the vehicle touches.
    pub fn touched(&self, situation: &Situation) -> Option<&Obstacle> {
        let reach_m = REACH_ARMS * situation.configuration.airframe.arm_length_m;
        self.obstacles.iter().find(|obstacle| obstacle.distance_m(&situation.truth.position_m) < reach_m)
    }

    /// Whether it is so high that obstacles are avoided: above the ground if that is measured, else above home. Zero is no limit.
    fn is_high(&self, situation: &Situation) -> bool {
        let above_home_m = situation.home.position_m.z - situation.outputs.position_m.z;
        let least_m = situation.conduct.surroundings.avoided_above_m;
        least_m <= 0.0 || self.below_m.unwrap_or(above_home_m) > least_m
    }

    /// Ends the flight of a vehicle that touches something.
    pub fn watch_contact(&self, situation: &Situation, proposal: &mut Proposal) {
        if !situation.armed {
            return;
        }
        if let Some(obstacle) = self.touched(situation) {
            proposal.say(Severity::Critical, format!("Collision with {}", obstacle.name));
            proposal.terminate();
        }
    }

    /// What is measured, north and east of here, m; `None`: nothing has been for a while.
    pub fn seen_m(&self, situation: &Situation) -> Option<Vec<Vector2<f64>>> {
        let lidar = self.lidar.as_ref().filter(|scan| is_fresh(scan, situation.time_us));
        let mut scans = lidar.into_iter().chain(self.told(situation.time_us)).peekable();
        scans.peek()?;
        Some(scans.flat_map(|scan| scan.seen_from(situation.outputs.position_m)).collect())
    }

    /// Stops the vehicle before what is measured, in the modes that keep a distance. ArduPilot's sticks slide along it; on a way to a
    /// place they do not lead, and it stops there, too.
    pub fn keep_distance(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let keeps = !self.proximity_off && keeps_distance(situation) && self.is_high(situation);
        let Some(asked) = proposal.steering().asked().filter(|_| keeps) else {
            self.stopped = false;
            return;
        };
        let direction = wanted(&asked, &situation.outputs.position_m).try_normalize(SMALL);
        let Some(points) = self.seen_m(situation) else {
            if !situation.conduct.surroundings.go_without_data && direction.is_some() {
                if !std::mem::replace(&mut self.told_blind, true) {
                    proposal.say(Severity::Warning, "No range data: not moving");
                }
                proposal.follow(situation, &stopped(&asked));
            }
            return;
        };
        self.told_blind = false;
        let by_sticks = situation.mode.leader() == Leader::Sticks && asked.is_velocity();
        if situation.identity.is_ardupilot() && by_sticks {
            self.stopped = false;
            if let Some(kept) = keep_away(situation, &points, &asked) {
                proposal.follow(situation, &kept);
            }
            return;
        }
        let margin_m = situation.conduct.surroundings.obstacle_distance_m;
        let (course, brakes_m) = braking(situation);
        let free = |direction: &Vector2<f64>| free_m(&points, direction, margin_m);
        let room_m = if self.stopped { brakes_m + ROOM_M } else { SLACK_M };
        let sets_out = direction.is_some_and(|direction| free(&direction) < room_m);
        self.stopped = sets_out || course.is_some_and(|course| free(&course) < brakes_m);
        if self.stopped {
            let told = self.stopped_us.replace(situation.time_us);
            if told.is_none_or(|told_us| situation.time_us - told_us > TOLD_US) {
                proposal.say(Severity::Warning, "Obstacle ahead: stopping");
            }
            proposal.follow(situation, &stopped(&asked));
        }
    }
}

fn is_fresh(scan: &RangeScan, time_us: u64) -> bool {
    time_us.saturating_sub(scan.time_us) <= OLD_US
}

/// PX4 keeps its distance in Position mode, ArduPilot in Loiter, PosHold, ZigZag and Guided, if it has a sensor.
fn keeps_distance(situation: &Situation) -> bool {
    const PROXIMITY: u8 = 2;
    let settings = &situation.conduct.surroundings;
    if situation.landed || settings.obstacle_distance_m < 0.0 {
        return false;
    }
    if situation.identity.is_ardupilot() {
        let senses = settings.avoided & PROXIMITY != 0 && settings.proximity_kind > 0;
        senses
            && matches!(situation.mode, Mode::Position | Mode::PositionHold | Mode::ZigZag | Mode::Offboard)
    } else {
        situation.mode == Mode::Position
    }
}

/// Where set-points lead over the ground: only its direction counts.
fn wanted(asked: &PositionSetPoint, here_m: &Vector3<f64>) -> Vector2<f64> {
    Vector2::from_fn(|axis, _| match asked.axes[axis] {
        AxisTarget::Position(position_m) => position_m - here_m[axis],
        AxisTarget::Velocity(velocity_m_s) => velocity_m_s,
        AxisTarget::Acceleration(acceleration_m_s2) => acceleration_m_s2,
        AxisTarget::Track { position_m, velocity_m_s, .. } => position_m - here_m[axis] + velocity_m_s,
    })
}

/// The same without its way over the ground.
fn stopped(asked: &PositionSetPoint) -> PositionSetPoint {
    let [_, _, down] = asked.axes;
    PositionSetPoint { axes: [AxisTarget::HOLD, AxisTarget::HOLD, down], yaw: asked.yaw }
}

/// Where the vehicle goes, if it does, and how far it goes on, m, when it brakes as hard as it may from now on. What counts is the
/// reference that it follows: the vehicle itself swings about it.
fn braking(situation: &Situation) -> (Option<Vector2<f64>>, f64) {
    let velocity_m_s = situation.outputs.setpoint.velocity_m_s.xy();
    let Some(course) = velocity_m_s.try_normalize(STANDING_M_S) else { return (None, 0.0) };
    let stop_m = stopping_place_m(situation, &situation.braking_limits()) - situation.outputs.position_m;
    let late_m = situation.conduct.surroundings.obstacle_delay_s * velocity_m_s.norm();
    (Some(course), stop_m.xy().norm() + late_m)
}

/// How far it is in a direction until something is as near as the margin, m.
fn free_m(points: &[Vector2<f64>], direction: &Vector2<f64>, margin_m: f64) -> f64 {
    let free_of = |point: &Vector2<f64>| {
        let along_m = point.dot(direction);
        let aside_m = (point - direction * along_m).norm();
        let distance_m = point.norm();
        if along_m <= 0.0 || aside_m >= margin_m {
            return f64::INFINITY;
        }
        if distance_m <= margin_m {
            return if along_m > TOWARDS * distance_m { 0.0 } else { f64::INFINITY };
        }
        along_m - libm::sqrt(margin_m * margin_m - aside_m * aside_m)
    };
    points.iter().map(free_of).fold(f64::INFINITY, f64::min)
}

/// A scan of one instrument that looks in one direction: the sectors that it covers, by headings from north, rad.
pub fn one_direction(
    time_us: u64,
    position_m: Vector3<f64>,
    heading_rad: f64,
    width_rad: f64,
    reading: Reading,
) -> RangeScan {
    let half_rad = (width_rad / 2.0).max(SECTOR_RAD / 2.0);
    let mut sectors = [Reading::Unknown; SECTORS];
    for (sector, place) in sectors.iter_mut().enumerate() {
        let off_rad = super::motion::wrapped(sector as f64 * SECTOR_RAD - heading_rad).abs();
        if off_rad <= half_rad {
            *place = reading;
        }
    }
    RangeScan { time_us, position_m, heading_rad: 0.0, sectors }
}

/// Distance of an aircraft from a place, m: horizontal, then vertical.
pub(super) fn separation_m(aircraft: &Aircraft, place_m: &Vector3<f64>, time_us: u64) -> [f64; 2] {
    let between_m = aircraft.position_at_m(time_us) - place_m;
    [between_m.xy().norm(), between_m.z.abs()]
}

#[cfg(test)]
mod tests {
    use core::f64::consts::FRAC_PI_2;

    use nalgebra::{Vector2, Vector3};

    use super::{
        AxisTarget, Mode, ObstacleWatch, PositionSetPoint, RangeScan, Reading, free_m, one_direction,
    };
    use crate::identity::Identity;
    use crate::vehicle::Conduct;
    use crate::vehicle::scene::{Scene, said};
    use crate::vehicle::set_point::YawTarget;

    /// A point of a companion computer, seen from a place north of the origin, m.
    fn point(time_us: u64, north_m: f64, heading_rad: f64, range_m: f64) -> RangeScan {
        one_direction(time_us, Vector3::new(north_m, 0.0, 0.0), heading_rad, 0.0, Reading::At(range_m))
    }

    /// The nearest of a frame counts. One that is sent no more ends while others go on.
    #[test]
    fn every_point_has_its_own_age() {
        let mut watch = ObstacleWatch::default();
        let ahead = |watch: &ObstacleWatch, time_us| watch.companion(time_us).map(|scan| scan.sectors[0]);
        watch.take(point(0, 0.0, 0.0, 3.0));
        watch.take(point(0, 0.0, 0.0, 5.0));
        watch.take(point(1000, 0.0, 0.0, 6.0));
        assert_eq!(ahead(&watch, 1000), Some(Reading::At(3.0)));
        watch.take(point(100_000, 0.0, 0.0, 7.0));
        assert_eq!(ahead(&watch, 100_000), Some(Reading::At(7.0)), "of the next frame");
        for tenths in 2..=7 {
            watch.take(point(100_000 * tenths, 0.0, FRAC_PI_2, 4.0));
        }
        assert_eq!(ahead(&watch, 700_000), Some(Reading::Unknown), "sent no more");
        assert_eq!(watch.companion.len(), 1);
    }

    /// What was seen before the vehicle moved on stays where it is.
    #[test]
    fn every_point_has_its_own_place() {
        let mut watch = ObstacleWatch::default();
        let mut scene = Scene::hovering_at([0.0, 0.0, -10.0]);
        watch.take(point(scene.outputs.time_us, 0.0, 0.0, 5.0));
        scene.come_to([1.0, 0.0, -10.0], [0.0; 3]);
        scene.wait_us(100_000);
        watch.take(point(scene.outputs.time_us, 1.0, FRAC_PI_2, 4.0));
        let seen = watch.seen_m(&scene.situation()).expect("both");
        for (seen_m, place_m) in seen.iter().zip([Vector2::new(4.0, 0.0), Vector2::new(0.0, 4.0)]) {
            assert!((seen_m - place_m).norm() < 1e-9, "{seen:?}");
        }
        assert_eq!(seen.len(), 2);
    }

    /// Whether a way to a place is stopped by something 2.5 m ahead; the margin is 2 m.
    fn stops(mode: Mode, height_m: f64, avoided_above_m: f64) -> bool {
        let mut scene = Scene::hovering_at([0.0, 0.0, -height_m]);
        (scene.identity, scene.conduct, scene.mode) = (Identity::ArduPilot, Conduct::new(true), mode);
        let settings = &mut scene.conduct.surroundings;
        (settings.proximity_kind, settings.avoided_above_m) = (2, avoided_above_m);
        let axes = [10.0, 0.0, -height_m].map(AxisTarget::Position);
        scene.show(|situation, proposal| {
            proposal.follow(situation, &PositionSetPoint { axes, yaw: YawTarget::Hold });
        });
        let mut watch = ObstacleWatch::default();
        watch.take(point(scene.outputs.time_us, 0.0, 0.0, 2.5));
        let requests = scene.show(|situation, proposal| watch.keep_distance(situation, proposal));
        said(&requests) == ["Obstacle ahead: stopping"] && scene.goal_m().is_none()
    }

    /// ZigZag across and a precision Loiter go to places.
    #[test]
    fn a_way_to_a_place_stops_in_every_mode_that_keeps_a_distance() {
        for mode in [Mode::Position, Mode::ZigZag, Mode::Offboard] {
            assert!(stops(mode, 10.0, 0.0), "{mode:?}");
        }
        assert!(!stops(Mode::Mission, 10.0, 0.0));
    }

    #[test]
    fn low_down_nothing_is_avoided_and_zero_is_no_limit() {
        for mode in [Mode::Offboard, Mode::ZigZag] {
            assert!(stops(mode, 10.0, 5.0) && !stops(mode, 4.0, 5.0), "{mode:?}");
            assert!(stops(mode, -3.0, 0.0), "{mode:?}: home is higher");
        }
    }

    #[test]
    fn the_free_way_ends_where_the_margin_begins() {
        let north = Vector2::new(1.0, 0.0);
        let free = |x: f64, y: f64| free_m(&[Vector2::new(x, y)], &north, 2.0);
        assert!((free(10.0, 0.0) - 8.0).abs() < 1e-12);
        assert!((free(10.0, 1.2) - (10.0 - 1.6)).abs() < 1e-12);
        assert_eq!(free(10.0, 2.1), f64::INFINITY, "it passes by");
        assert_eq!(free(-3.0, 0.0), f64::INFINITY, "behind");
        assert_eq!(free(1.5, 0.5), 0.0, "too near already, and ahead");
        assert_eq!(free(0.1, 1.5), f64::INFINITY, "too near already, and beside");
    }
}
