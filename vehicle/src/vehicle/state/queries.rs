//! What can be asked about the vehicle.

use nalgebra::Vector3;
use quadrotor::{Configuration, Outputs, Simulation, StabilityWarning};

use super::super::battery::{Battery, capacity_ah};
use super::super::conduct::Conduct;
use super::super::failsafe::Failsafe;
use super::super::fence_watch::FenceRecord;
use super::super::flight_times::FlightTimes;
use super::super::home::Home;
use super::super::landed::LandedState;
use super::super::mission::{
    Beginning, MissionState, MissionStatus, PlannedLeg, height_without_m, planned_way,
};
use super::super::orbit_request::OrbitStatus;
use super::super::set_point::PositionSetPoint;
use super::super::speeds::with_speeds;
use super::super::steering::{Steering, SteeringKind, TrackedAttitude};
use super::Vehicle;
use crate::estimation::{Estimate, InstrumentHealth, Navigation, Readings, Validity};
use crate::fault::Faults;
use crate::fence::{Breach, Fence};
use crate::foreign::{ForeignDescription, ForeignMotion};
use crate::identity::Identity;
use crate::mode::Mode;
use crate::plan::{MissionItem, PlanKind, Plans, Site, compile};
use crate::surroundings::Terrain;
use crate::world::{Geodetic, LocalFrame, ToldFrame};

impl Vehicle {
    /// Whose conventions it follows.
    pub fn identity(&self) -> Identity {
        self.setup.identity()
    }

    /// Simulation time, µs after the start.
    pub fn time_us(&self) -> u64 {
        self.outputs().time_us
    }

    /// Time of the start, µs since 1970.
    pub fn unix_start_us(&self) -> u64 {
        self.setup.unix_start_us()
    }

    /// What the closed loop shows, as far as the vehicle knows its motion.
    pub fn outputs(&self) -> &Outputs {
        self.perception.outputs()
    }

    /// What the closed loop shows in truth.
    pub fn truth(&self) -> &Outputs {
        self.perception.truth()
    }

    /// What of its motion it knows well enough to fly by.
    pub fn validity(&self) -> Validity {
        self.perception.validity()
    }

    /// Which instruments work.
    pub fn instrument_health(&self) -> InstrumentHealth {
        self.perception.health()
    }

    /// Instruments and estimator, if it flies by them.
    pub fn navigation(&self) -> Option<&Navigation> {
        self.perception.navigation()
    }

    /// The estimate, if it flies by one.
    pub fn estimate(&self) -> Option<&Estimate> {
        self.perception.estimate()
    }

    /// What the instruments show; ideal ones show the truth.
    pub fn readings(&self) -> Readings {
        self.perception.readings(self.frame())
    }

    /// The engine; beside a closed loop from elsewhere it keeps configuration and motion.
    pub fn simulation(&self) -> &Simulation {
        self.closed_loop.simulation()
    }

    /// The closed loop or plant from elsewhere, if one flies.
    pub fn foreign(&self) -> Option<&ForeignDescription> {
        self.closed_loop.foreign()
    }

    /// What that has shown last.
    pub fn foreign_motion(&self) -> Option<&ForeignMotion> {
        self.closed_loop.foreign_motion()
    }

    /// What is worth a warning about our controllers, if they fly.
    pub fn stability_warnings(&self) -> &[StabilityWarning] {
        self.closed_loop.stability_warnings()
    }

    /// The parameters of the closed loop, whatever speeds hold for now.
    pub fn kept_configuration(&self) -> Configuration {
        with_speeds(*self.simulation().configuration(), self.machines.speeds.kept_m_s())
    }

    /// The local frame.
    pub fn frame(&self) -> &LocalFrame {
        self.setup.frame()
    }

    /// A position, NED, m, as a place on the earth. That of the vehicle is calculated once, however often it is asked for.
    pub fn place_of(&self, position_m: &Vector3<f64>) -> Geodetic {
        self.perception.place_of(position_m, self.frame())
    }

    /// The local frame in which clients count.
    pub fn told_frame(&self) -> &ToldFrame {
        self.setup.told_frame()
    }

    /// Velocity of the air, NED, m/s.
    pub fn wind_m_s(&self) -> Vector3<f64> {
        self.closed_loop.wind_m_s()
    }

    /// When it was armed, took off and landed.
    pub fn flight_times(&self) -> &FlightTimes {
        &self.machines.flight_times
    }

    /// The battery.
    pub fn battery(&self) -> &Battery {
        &self.machines.battery
    }

    /// Remaining share of the battery.
    pub fn battery_remaining(&self) -> f64 {
        self.battery().remaining(self.battery_capacity_ah())
    }

    /// Capacity of the battery, A·h.
    pub fn battery_capacity_ah(&self) -> f64 {
        capacity_ah(&self.simulation().configuration().airframe, self.conduct().battery_capacity_ah)
    }

    /// Its own parameters.
    pub fn conduct(&self) -> &Conduct {
        self.setup.conduct()
    }

    /// A number that changes whenever those may have changed.
    pub fn conduct_revision(&self) -> u64 {
        self.setup.conduct_revision()
    }

    /// Everything that is broken now.
    pub fn faults(&self) -> Faults {
        let simulated = &self.conduct().simulated;
        let faults = simulated.errors.switches.with(*self.machines.injection.faults());
        faults.with_weak(simulated.weak_rotors as u32, simulated.weak_share)
    }

    /// Home.
    pub fn home(&self) -> &Home {
        self.decided.home()
    }

    /// Whether the rotors may turn.
    pub fn is_armed(&self) -> bool {
        self.decided.is_armed()
    }

    /// Whether its last flight has been terminated.
    pub fn is_terminated(&self) -> bool {
        self.decided.is_terminated()
    }

    /// Whether its last flight has ended in a crash.
    pub fn has_crashed(&self) -> bool {
        self.machines.crash.has_crashed()
    }

    /// The mode.
    pub fn mode(&self) -> Mode {
        self.decided.mode()
    }

    /// Whether commands and set-points of clients lead it: ArduPilot's guided modes, in one of which it takes off.
    pub fn is_guided(&self) -> bool {
        matches!(self.mode(), Mode::Offboard | Mode::Takeoff | Mode::GuidedAttitude)
    }

    /// Whether its mission cannot be cleared: ArduPilot flies it to its end.
    pub fn keeps_mission(&self) -> bool {
        let is_flown = self.is_armed() && self.mission_status().state == MissionState::Active;
        self.identity().is_ardupilot() && is_flown
    }

    /// The mode that clients are shown.
    pub fn shown_mode(&self) -> Mode {
        match self.mode() {
            Mode::Mission if self.machines.mission.lands() => Mode::MissionLanding,
            mode => mode,
        }
    }

    /// The failsafe.
    pub fn failsafe(&self) -> &Failsafe {
        &self.machines.failsafe
    }

    /// The rotor that is known to be lost: front (0), right, back or left (3). Until it is disarmed it only descends then.
    pub fn lost_rotor(&self) -> Option<usize> {
        self.machines.rotors.lost_rotor()
    }

    /// Whether the latest set-point is young enough to fly on.
    pub fn set_points_are_recent(&self) -> bool {
        self.situation().set_points_are_recent
    }

    /// How it is steered.
    pub fn steering_kind(&self) -> SteeringKind {
        self.decided.steering().kind()
    }

    /// What it is asked for by position, axis by axis; `None` on a planned way, and while it is not steered by position.
    pub fn asked(&self) -> Option<PositionSetPoint> {
        self.decided.steering().asked()
    }

    /// What the attitude controller tracks now.
    pub fn tracked_attitude(&self) -> TrackedAttitude {
        let (_, strongest_n) = self.simulation().configuration().airframe.thrust_range_n();
        self.decided.steering().tracked_attitude(self.outputs(), strongest_n)
    }

    /// Whether it stands, climbs from the ground, flies or descends to the ground.
    pub fn landed_state(&self) -> LandedState {
        self.machines.landed_state(self.mode(), self.is_armed())
    }

    /// The fence as it is looked at; `None` while it is switched off.
    pub fn fence(&self) -> Option<Fence<'_>> {
        self.situation().fence()
    }

    /// What has become of the fence.
    pub fn fence_record(&self) -> &FenceRecord {
        self.machines.fence.record()
    }

    /// Whether there is anything that it must keep to: zones, a greatest distance or height.
    pub fn has_fence(&self) -> bool {
        self.situation().whole_fence().bounds()
    }

    /// The orbit that is flown.
    pub fn orbit_status(&self) -> Option<OrbitStatus> {
        self.machines.orbit.status().filter(|_| self.mode() == Mode::Orbit)
    }

    /// What of the fence forbids a place, NED, m.
    pub fn breach_at(&self, place_m: &Vector3<f64>) -> Option<Breach> {
        self.situation().breach_at(place_m)
    }

    /// Its plans.
    pub fn plans(&self) -> &Plans {
        self.plans.plans()
    }

    /// A number that changes with each plan that is replaced.
    pub fn plans_revision(&self) -> u32 {
        self.plans.revision()
    }

    /// What the places of plans refer to.
    pub fn site(&self) -> Site {
        self.situation().site()
    }

    /// The ground.
    pub fn terrain(&self) -> &Terrain {
        self.setup.terrain()
    }

    /// Where it takes itself to be, north and east of the origin, m.
    pub fn horizontal_m(&self) -> [f64; 2] {
        self.outputs().position_m.xy().into()
    }

    /// An item as a download shows it: in ArduPilot's convention the first one of a mission is home.
    pub fn plan_item(&self, kind: PlanKind, index: usize) -> Option<MissionItem> {
        if kind == PlanKind::Mission && index == 0 && self.identity().is_ardupilot() {
            return Some(self.home_item());
        }
        self.plans().get(kind).items().get(index).copied()
    }

    /// Home as an item of a plan.
    pub fn home_item(&self) -> MissionItem {
        let place = self.frame().to_geodetic(&self.home().position_m);
        MissionItem::home([place.latitude_deg, place.longitude_deg, place.altitude_m])
    }

    /// Whether there is something to be flown.
    pub fn has_mission(&self) -> bool {
        self.machines.mission.program().is_flown()
    }

    /// Where the mission is.
    pub fn mission_status(&self) -> MissionStatus {
        self.machines.mission.status(self.mode())
    }

    /// The way that its mission is planned to take, from home on.
    pub fn planned_way(&self) -> Vec<PlannedLeg> {
        let beginning = Beginning {
            home_m: self.home().position_m,
            from_m: self.home().position_m,
            takeoff_height_m: height_without_m(&self.situation()),
            terrain: self.terrain(),
            grounded: true,
        };
        let items = self.plans().get(PlanKind::Mission).items();
        planned_way(&compile::mission(items, &self.site()), &beginning)
    }

    /// Items that were reached since the last call.
    pub fn take_reached_items(&mut self) -> Vec<u16> {
        self.machines.mission.take_reached()
    }

    /// Where it is led to, NED, m: the end of a mission's leg or of a planned way, or the place that it was asked for.
    pub fn destination_m(&self) -> Option<Vector3<f64>> {
        let in_mission = self.mode() == Mode::Mission;
        let leg = self.leg_errors().filter(|_| in_mission);
        let steering = self.decided.steering();
        let mission = Some(&self.machines.mission).filter(|_| in_mission && self.is_armed());
        leg.map(|(end_m, _)| end_m)
            .or_else(|| mission?.coming_m(&self.outputs().position_m, self.home().position_m.z))
            .or_else(|| self.machines.ground_flight.goal_m(steering))
            .or_else(|| steering.destination_m())
    }

    /// The place that it was asked for, NED, m, or else that of its reference.
    pub(super) fn asked_place_m(&self) -> Vector3<f64> {
        let along_ground_m = self.machines.ground_flight.goal_m(self.decided.steering());
        match self.decided.steering() {
            Steering::Goal(goal) => goal.position_m,
            _ => along_ground_m.unwrap_or(self.outputs().setpoint.position_m),
        }
    }

    /// The end of the present leg, NED, m, and the vehicle's distance from the leg's line, positive to the right, m.
    pub fn leg_errors(&self) -> Option<(Vector3<f64>, f64)> {
        let mission = &self.machines.mission;
        let [_, end_m] = mission.way_m()?;
        Some((end_m, cross_track_m(mission.line_m()?, &self.outputs().position_m)))
    }
}

/// Signed distance of a position from a line, horizontally, positive to the right, m.
fn cross_track_m([from_m, to_m]: [Vector3<f64>; 2], position_m: &Vector3<f64>) -> f64 {
    let off = (position_m - from_m).xy();
    match (to_m - from_m).xy().try_normalize(0.1) {
        Some(along) => along.x * off.y - along.y * off.x,
        None => off.norm(),
    }
}
