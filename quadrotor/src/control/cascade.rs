//! The cascade of Figure 2: position → tilt, altitude → thrust, attitude → torques.

use nalgebra::{Vector1, Vector3};
use serde::{Deserialize, Serialize};

use crate::control::activity::Activity;
use crate::control::altitude_controller::AltitudeController;
use crate::control::attitude_controller::AttitudeController;
use crate::control::attitude_reference::{AttitudeReference, SmoothedAcceleration};
use crate::control::flat_attitude::FlatAttitude;
use crate::control::followed_way::FollowedWay;
use crate::control::largest_lean::LargestLean;
use crate::control::mass_belief::MassBelief;
use crate::control::narrowed_way::NarrowedWay;
use crate::control::observation::Observation;
use crate::control::position_controller::PositionController;
use crate::control::required_thrust::RequiredThrust;
use crate::control::rotor_command::RotorCommand;
use crate::control::turned_way::{ForetoldWay, TurnedWay};
use crate::control::unseen_motion::UnseenMotion;
use crate::design::controller_limits::{
    holding_horizontal_m_s2, least_thrust_n, reference_tilt_rad, thrust_range_n,
};
use crate::design::loop_design::LoopDesign;
use crate::guidance::heading::Heading;
use crate::guidance::reference_motion::ReferenceMotion;
use crate::{
    AttitudeTarget, CascadeDesign, Configuration, GRAVITY_M_S2, PositionReference, RigidBody, Wrench,
    commanded_tilt_rad, wrench_of_rotors,
};

/// How soon a lean that a reference is about to take counts as its present one, s: the samples under the present limit.
const SOON_S: f64 = 0.2;
/// Smallest cosine of the tilt by which the thrust is raised to hold the altitude (about 73°). Beyond it
/// the thrust is the weight: it pushes sideways or down, but leaves the rotors room for torques.
const UPRIGHT: f64 = 0.3;

/// State of the three controllers and of the commands between them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cascade {
    position: PositionController,
    altitude: AltitudeController,
    attitude: AttitudeController,
    narrowed: NarrowedWay,
    followed: FollowedWay,
    turned: TurnedWay,
    turning: SmoothedAcceleration,
    /// What feedback adds to the acceleration of the reference, NED, m/s².
    feedback_m_s2: Vector3<f64>,
    /// Acceleration of the reference at the latest sample of the attitude controller, NED, m/s².
    reference_m_s2: Vector3<f64>,
    tilt_reference_rad: [f64; 2],
    activity: Activity,
    sampled: LatestSamples,
}

/// When each controller sampled last, µs; `None` since it took over.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
struct LatestSamples {
    position_us: Option<u64>,
    altitude_us: Option<u64>,
    attitude_us: Option<u64>,
}

/// Time since the latest sample, s, and notes the present one. The first one counts as a whole sample time.
fn interval_s(latest_us: &mut Option<u64>, time_us: u64, period_us: u64) -> f64 {
    let since_us = latest_us.replace(time_us);
    let elapsed_us = since_us.map_or(period_us, |since_us| time_us.saturating_sub(since_us));
    elapsed_us as f64 / 1e6
}

impl Cascade {
    /// Takes over a vehicle whose rotors hold it by an angular acceleration, FRD, rad/s², against what disturbs it.
    pub fn new(body: &RigidBody, held_rad_s2: &Vector3<f64>) -> Self {
        Self {
            position: PositionController::new(body.position_m.xy()),
            altitude: AltitudeController::new(body.position_m.z),
            attitude: AttitudeController::new(&body.rotation(), held_rad_s2),
            narrowed: NarrowedWay::default(),
            followed: FollowedWay::default(),
            turned: TurnedWay::default(),
            turning: SmoothedAcceleration::default(),
            feedback_m_s2: Vector3::zeros(),
            reference_m_s2: Vector3::zeros(),
            tilt_reference_rad: [0.0; 2],
            activity: Activity::default(),
            sampled: LatestSamples::default(),
        }
    }

    /// How the controllers came to their last inputs.
    pub fn activity(&self) -> Activity {
        self.activity
    }

    /// φ, θ asked of the attitude controller, rad.
    pub fn tilt_reference_rad(&self) -> [f64; 2] {
        self.tilt_reference_rad
    }

    /// Goes on from the commands of one design under another one, without a step of torques.
    pub(crate) fn hand_over(&mut self, before: &LoopDesign, after: &LoopDesign) {
        self.attitude.hand_over(before, after);
    }

    /// Goes on under another belief in mass, inertia and drag, without a step of thrust or torques.
    pub(crate) fn believe(&mut self, before: &Configuration, after: &Configuration) {
        if let Some(belief) = MassBelief::changed(&before.controllers, &after.controllers) {
            let commanded = self.acceleration_m_s2();
            let horizontal = belief.horizontal(&commanded.xy());
            let vertical = belief.vertical(&Vector1::new(commanded.z));
            self.feedback_m_s2 = Vector3::new(horizontal.x, horizontal.y, vertical.x) - self.reference_m_s2;
            self.position.translate(|acceleration| belief.horizontal(acceleration));
            self.altitude.translate(|acceleration| belief.vertical(acceleration));
        }
        let drag_1_s = after.drag_1_s() - before.drag_1_s();
        if drag_1_s != Vector3::zeros() {
            self.position.feed_forward(&drag_1_s.xy());
            self.altitude.feed_forward(drag_1_s.z);
        }
        let inertia = before.believed_inertia_kg_m2().x / after.believed_inertia_kg_m2().x;
        if inertia != 1.0 {
            self.attitude.believe(inertia);
            self.position.believe(inertia);
        }
    }

    /// Vehicle and reference are elsewhere, m: neither has moved.
    pub(crate) fn shift(&mut self, by_m: &Vector3<f64>) {
        self.position.shift(&by_m.xy());
        self.altitude.shift(by_m.z);
        self.turned.shift(&by_m.xy());
    }

    /// The acceleration that is commanded, NED, m/s².
    pub(crate) fn acceleration_m_s2(&self) -> Vector3<f64> {
        self.reference_m_s2 + self.feedback_m_s2
    }

    /// What is followed at a time in place of a reference that nobody can follow, or that no plan of the position controller reaches;
    /// `None` of another one. `is_told` is whether all of its derivatives are told, instead of being found.
    pub(crate) fn follow(
        &mut self,
        configuration: &Configuration,
        design: &CascadeDesign,
        (reference, is_told, seen): (&PositionReference, bool, &Observation),
        time_us: u64,
    ) -> Option<PositionReference> {
        if design.position.law.regulator().is_none() {
            let attitude = design.attitude_loop();
            let followed = self.turned.follow(configuration, attitude.as_ref(), (reference, seen), time_us);
            if followed.is_some() {
                // A goal at rest ends both.
                (self.narrowed, self.followed) = (NarrowedWay::default(), FollowedWay::default());
                return followed;
            }
        } else {
            self.turned = TurnedWay::default();
        }
        let available_rad_s2 = design.attitude.available_rad_s2;
        let narrowed = self.narrowed.follow(configuration, available_rad_s2, (reference, is_told), time_us);
        let way = narrowed.as_ref().unwrap_or(reference);
        self.followed.follow(configuration, (way, &seen.body), time_us).or(narrowed)
    }

    /// The way that is followed, if it is known where it leads.
    pub(crate) fn foretold_way(&self) -> Option<ForetoldWay> {
        self.turned.foretold()
    }

    /// A sample of the position controller, for a reference that is foreseen to go on as `ahead` tells for a time, µs, and
    /// may ask for what `asked` tells beside.
    pub(crate) fn sample_position(
        &mut self,
        configuration: &Configuration,
        design: &CascadeDesign,
        seen: &Observation,
        (reference, ahead, asked): (
            &PositionReference,
            impl Fn(u64) -> PositionReference,
            impl Fn(u64) -> Option<PositionReference>,
        ),
        time_us: u64,
    ) {
        let period_us = configuration.controllers.position.sample_time_us;
        let vertical = self.acceleration_m_s2().z;
        let lean_rad = self.reference_lean_rad(configuration);
        let (is_bent, is_narrow) = (self.followed.gives_way(), self.narrowed.is_narrow());
        let motion = |reference: &PositionReference, interval_s: f64| {
            let required = RequiredThrust::of(configuration, reference, lean_rad);
            ReferenceMotion {
                position: reference.position_m.xy(),
                velocity: reference.velocity_m_s.xy(),
                acceleration: reference.acceleration_m_s2.xy(),
                jerk: reference.jerk_m_s3.xy(),
                thrust: required.acceleration_m_s2.xy(),
                thrust_jerk: required.jerk_m_s3.xy(),
                thrust_snap: required.snap_m_s4.xy(),
                interval_s,
                is_bent,
                is_narrow,
            }
        };
        let now = motion(reference, interval_s(&mut self.sampled.position_us, time_us, period_us));
        let at = |sample: usize| time_us + sample as u64 * period_us;
        let later = |sample: usize| motion(&ahead(at(sample)), 0.0);
        let asked = |sample: usize| asked(at(sample)).map(|reference| motion(&reference, 0.0));
        // The thrust of a climb that begins does not last, and one that is under way will be braked.
        let (_, down) = vertical_range(configuration, upright(&seen.body));
        let lightest = vertical.max(braking_m_s2(seen, reference).min(down));
        let holding = holding_horizontal_m_s2(configuration, seen.vertical().disturbance_m_s2);
        let largest = |vertical| self.largest_lean(configuration, vertical).within(holding);
        let soon = now.thrust + now.thrust_jerk * SOON_S;
        let present = largest(vertical).beside(now.thrust.norm().max(soon.norm()));
        let lasting = largest(lightest);
        let mut seen = seen.horizontal(configuration, &self.attitude.feedback_rad_s2());
        if !now.is_at_rest() {
            let required = RequiredThrust::of(configuration, reference, lean_rad);
            let unseen = UnseenMotion::on(&required);
            seen.jerk_m_s3 += unseen.jerk_m_s3;
            seen.snap_m_s4 += unseen.snap_m_s4;
        }
        let (applied, activity) =
            self.position.step(configuration, design, &seen, (&now, later, asked), (present, lasting));
        let feedback = applied - now.thrust;
        (self.feedback_m_s2.x, self.feedback_m_s2.y) = (feedback.x, feedback.y);
        self.activity.position = activity;
    }

    /// A sample of the altitude controller.
    pub(crate) fn sample_altitude(
        &mut self,
        configuration: &Configuration,
        design: &CascadeDesign,
        seen: &Observation,
        reference: &PositionReference,
        time_us: u64,
    ) {
        let period_us = configuration.controllers.altitude.sample_time_us;
        let axis = |vector: &Vector3<f64>| [vector.z].into();
        let required = RequiredThrust::of(configuration, reference, self.reference_lean_rad(configuration));
        let motion = ReferenceMotion {
            position: axis(&reference.position_m),
            velocity: axis(&reference.velocity_m_s),
            acceleration: axis(&reference.acceleration_m_s2),
            jerk: axis(&reference.jerk_m_s3),
            thrust: axis(&required.acceleration_m_s2),
            thrust_jerk: axis(&required.jerk_m_s3),
            thrust_snap: axis(&required.snap_m_s4),
            interval_s: interval_s(&mut self.sampled.altitude_us, time_us, period_us),
            is_bent: self.followed.gives_way(),
            is_narrow: self.narrowed.is_narrow(),
        };
        let range = vertical_range(configuration, upright(&seen.body));
        let (applied, activity) = self.altitude.step(configuration, design, &seen.vertical(), &motion, range);
        self.feedback_m_s2.z = applied - self.altitude.reference_m_s2();
        self.activity.altitude = activity;
    }

    /// A sample of the attitude controller: from the accelerations wanted to rotor commands. The reference of now, and the one of when
    /// the rotors will have answered.
    pub(crate) fn sample_attitude(
        &mut self,
        configuration: &Configuration,
        design: &CascadeDesign,
        seen: &Observation,
        (reference, answered): (&PositionReference, &PositionReference),
    ) -> RotorCommand {
        let lean_rad = self.reference_lean_rad(configuration);
        let [required, later] =
            [reference, answered].map(|reference| RequiredThrust::of(configuration, reference, lean_rad));
        self.reference_m_s2 = required.acceleration_m_s2;
        let vertical = later.acceleration_m_s2.z + self.feedback_m_s2.z;
        let upright = upright(&seen.body);
        let attitude = self.required_attitude(configuration, &required, &Heading::of(reference), upright);
        let later = self.required_attitude(configuration, &later, &Heading::of(answered), upright);
        self.tilt_reference_rad = attitude.tilt_rad();
        let lag_s = configuration.airframe.mean_rotor_lag_s();
        let change = attitude.attitude.inverse() * later.attitude * later.angular_acceleration_rad_s2
            - attitude.angular_acceleration_rad_s2;
        let required = AttitudeReference {
            attitude: attitude.attitude,
            rate_rad_s: attitude.body_rate_rad_s,
            acceleration_rad_s2: attitude.angular_acceleration_rad_s2,
            jerk_rad_s3: change / lag_s,
        };
        let thrust_n =
            thrust(configuration, vertical, upright, upright_when_answered(configuration, &seen.body));
        // The altitude controller leaves the torques their reserve itself: its thrust is kept.
        let thrust_n = (thrust_n, thrust_n);
        self.command_rotors(configuration, design, seen, &required, thrust_n)
    }

    /// The largest lean of a reference that is followed as it is, rad. A way in place of one that leans farther keeps to what is
    /// commanded at most.
    fn reference_lean_rad(&self, configuration: &Configuration) -> f64 {
        if self.followed.gives_way() {
            commanded_tilt_rad(configuration)
        } else {
            reference_tilt_rad(configuration)
        }
    }

    /// How far commands may lean under a vertical acceleration, m/s².
    fn largest_lean(&self, configuration: &Configuration, vertical_m_s2: f64) -> LargestLean {
        LargestLean {
            commanded_m_s2: most_horizontal(vertical_m_s2, commanded_tilt_rad(configuration)),
            foretold_m_s2: most_horizontal(vertical_m_s2, self.reference_lean_rad(configuration)),
        }
    }

    /// The attitude and its motion that a reference requires together with what feedback adds to it, within the largest
    /// lean. While the thrust pushes sideways or down it is level: where the thrust should push cannot be followed, and a
    /// way upright that bends with it takes longer.
    fn required_attitude(
        &self,
        configuration: &Configuration,
        required: &RequiredThrust,
        heading: &Heading,
        upright: f64,
    ) -> FlatAttitude {
        if upright < UPRIGHT {
            let none = Vector3::zeros();
            return FlatAttitude::new(&none, &none, &none, heading);
        }
        let wanted_m_s2 = required.acceleration_m_s2 + self.feedback_m_s2;
        let largest_m_s2 = || {
            // Mostly plain: no command within its own lean is cut off.
            let surely_m_s2 = surely_horizontal(wanted_m_s2.z, commanded_tilt_rad(configuration));
            if wanted_m_s2.xy().norm_squared() <= surely_m_s2 * surely_m_s2 {
                return surely_m_s2;
            }
            // Commands that are cut off turn with the reference.
            let required_m_s2 = required.acceleration_m_s2.xy().norm();
            self.largest_lean(configuration, wanted_m_s2.z).beside(required_m_s2)
        };
        // The limit moves with the vertical acceleration; how it moves with the feedback is not known.
        let wanted = RequiredThrust { acceleration_m_s2: wanted_m_s2, ..*required };
        let within = wanted.leaning_at_most(largest_m_s2, |most_m_s2| wanted.motion_of_leaning(most_m_s2));
        FlatAttitude::new(&within.acceleration_m_s2, &within.jerk_m_s3, &within.snap_m_s4, heading)
    }

    /// A sample of the attitude controller alone, for an attitude and a thrust from outside.
    pub(crate) fn sample_attitude_target(
        &mut self,
        configuration: &Configuration,
        design: &CascadeDesign,
        seen: &Observation,
        target: &AttitudeTarget,
        time_us: u64,
    ) -> RotorCommand {
        let (phi, theta, _) = target.attitude.euler_angles();
        self.tilt_reference_rad = [phi, theta];
        let period_us = configuration.controllers.attitude.sample_time_us;
        let since_s = interval_s(&mut self.sampled.attitude_us, time_us, period_us);
        let required = AttitudeReference {
            attitude: target.attitude,
            rate_rad_s: target.body_rate_rad_s,
            acceleration_rad_s2: self.turning.go_on(&target.body_rate_rad_s, since_s),
            jerk_rad_s3: Vector3::zeros(),
        };
        let thrust_n = (target.thrust_n, least_thrust_n(configuration, upright(&seen.body).max(UPRIGHT)));
        self.command_rotors(configuration, design, seen, &required, thrust_n)
    }

    /// Rotor speeds that turn the body as required, under a thrust, N, which may be reduced for the torques to a least one, N.
    fn command_rotors(
        &mut self,
        configuration: &Configuration,
        design: &CascadeDesign,
        seen: &Observation,
        required: &AttitudeReference,
        (thrust_n, least_thrust_n): (f64, f64),
    ) -> RotorCommand {
        let thrust_range_n = (thrust_n, least_thrust_n);
        let (asked, activity) =
            self.attitude.step(configuration, design, &seen.rotation(), required, thrust_range_n);
        let wanted = Wrench { thrust_n, torque_n_m: asked.torque_n_m() };
        let thrusts_n = design.mixer.rotor_thrusts_n(&wanted, least_thrust_n);
        let lag = &design.thrust_lag;
        let speed_rad_s =
            core::array::from_fn(|rotor| lag.command_rad_s(thrusts_n[rotor], seen.rotor_speed_rad_s[rotor]));
        let settled_rad_s = core::array::from_fn(|rotor| {
            lag.settled_rad_s(speed_rad_s[rotor], seen.rotor_speed_rad_s[rotor])
        });
        let made = wrench_of_rotors(&configuration.airframe, &settled_rad_s);
        self.activity.attitude = activity;
        self.activity.attitude.cut(&wanted.torque_n_m, &made.torque_n_m);
        self.attitude.apply(&design.attitude, &asked, &made.torque_n_m);
        RotorCommand { speed_rad_s, wrench: made }
    }
}

/// Cosine of the tilt: the down component of the body's down axis.
fn upright(body: &RigidBody) -> f64 {
    (body.rotation() * Vector3::z()).z
}

/// The same when the rotors will have answered a command, in the middle of the time for which it is held. What answers with a lag T
/// follows c when c + T ċ is commanded.
fn upright_when_answered(configuration: &Configuration, body: &RigidBody) -> f64 {
    let held_s = configuration.controllers.attitude.sample_time_s();
    let later_s = configuration.airframe.mean_rotor_lag_s() + held_s / 2.0;
    let rising_1_s = (body.rotation() * body.body_rate_rad_s.cross(&Vector3::z())).z;
    (upright(body) + rising_1_s * later_s).clamp(UPRIGHT, 1.0)
}

/// Acceleration down, m/s², with which a climb will be braked at its goal: v²/h, as far as it is under way. The speed of a regulated
/// approach falls with the distance left, which takes twice as much in the beginning as braking evenly. None of a descent, which is braked
/// by more thrust.
fn braking_m_s2(seen: &Observation, reference: &PositionReference) -> f64 {
    /// A climb that is so near its end, m, is braked already.
    const NEAR_M: f64 = 0.2;
    let climb_m_s = (reference.velocity_m_s.z - seen.body.velocity_m_s.z).max(0.0);
    let way_m = seen.body.position_m.z - reference.position_m.z;
    climb_m_s * climb_m_s / way_m.max(NEAR_M)
}

/// The largest horizontal acceleration, m/s², under which the thrust leans by at most `lean_rad` when the vertical acceleration
/// is `vertical_m_s2`: |a| ≤ tan(lean) (g − G).
pub(crate) fn most_horizontal(vertical_m_s2: f64, lean_rad: f64) -> f64 {
    libm::tan(lean_rad) * (GRAVITY_M_S2 - vertical_m_s2).max(0.0)
}

/// A little less, as tan x ≥ x, which takes no tangent: mostly it is plain that a vehicle leans less.
pub(crate) fn surely_horizontal(vertical_m_s2: f64, lean_rad: f64) -> f64 {
    lean_rad * (GRAVITY_M_S2 - vertical_m_s2).max(0.0)
}

/// Vertical accelerations G, m/s², that the thrust limits allow at this tilt: G = g − F cos(tilt)/m.
pub(crate) fn vertical_range(configuration: &Configuration, upright: f64) -> (f64, f64) {
    let share = upright.max(UPRIGHT) / configuration.believed_mass_kg();
    let (least, most) = thrust_range_n(configuration);
    (GRAVITY_M_S2 - most * share, GRAVITY_M_S2 - least * share)
}

/// F = m (g − G) of (7), divided by cos φ cos θ because a tilted thrust carries less: by that of `then`, when there will be this thrust.
fn thrust(configuration: &Configuration, vertical_m_s2: f64, upright: f64, then: f64) -> f64 {
    if upright < UPRIGHT {
        return configuration.believed_mass_kg() * GRAVITY_M_S2;
    }
    let level = configuration.believed_mass_kg() * (GRAVITY_M_S2 - vertical_m_s2);
    let (least, most) = thrust_range_n(configuration);
    (level / then).clamp(least, most)
}
