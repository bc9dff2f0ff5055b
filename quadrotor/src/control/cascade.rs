//! The cascade of Figure 2: position → tilt, altitude → thrust, attitude → torques.

use nalgebra::{UnitQuaternion, Vector1, Vector2, Vector3};
use serde::{Deserialize, Serialize};

use crate::attitude::{tilt_angles, turned};
use crate::control::activity::Activity;
use crate::control::altitude_controller::AltitudeController;
use crate::control::attitude_controller::{AttitudeController, VehicleRotation};
use crate::control::mass_belief::MassBelief;
use crate::control::observation::Observation;
use crate::control::position_controller::PositionController;
use crate::design::controller_limits::{
    COMMANDED_TILT_SHARE, attitude_bounds, largest_tilt, least_thrust_n, thrust_range_n,
};
use crate::design::loop_design::LoopDesign;
use crate::guidance::heading::Heading;
use crate::guidance::ramp::Ramp;
use crate::guidance::reference_motion::ReferenceMotion;
use crate::guidance::setpoint::Setpoint;
use crate::{
    AttitudeTarget, CascadeDesign, Configuration, GRAVITY_M_S2, RigidBody, Wrench, wrench_of_rotors,
};

/// Smallest cosine of the tilt by which the thrust is raised to hold the altitude (about 73°). Beyond it
/// the thrust is the weight: it pushes sideways or down, but leaves the rotors room for torques.
const UPRIGHT: f64 = 0.3;

/// State of the three controllers and of the commands between them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cascade {
    position: PositionController,
    altitude: AltitudeController,
    attitude: AttitudeController,
    /// Horizontal acceleration wanted, NED, m/s².
    horizontal: Ramp<2>,
    /// Vertical acceleration wanted, NED, m/s².
    vertical: Ramp<1>,
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
    /// Takes over a vehicle.
    pub fn new(body: &RigidBody, time_us: u64) -> Self {
        Self {
            position: PositionController::new(body.position_m.xy()),
            altitude: AltitudeController::new(body.position_m.z),
            attitude: AttitudeController::new(&body.rotation()),
            horizontal: Ramp::still(time_us),
            vertical: Ramp::still(time_us),
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
        self.attitude.hand_over(&before.cascade, after);
    }

    /// Goes on under another belief in mass, inertia and drag, without a step of thrust or torques.
    pub(crate) fn believe(&mut self, before: &Configuration, after: &Configuration) {
        if let Some(belief) = MassBelief::changed(&before.controllers, &after.controllers) {
            self.horizontal = self.horizontal.map(|acceleration| belief.horizontal(acceleration));
            self.vertical = self.vertical.map(|acceleration| belief.vertical(acceleration));
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
            self.attitude.translate(|torque| torque * inertia);
        }
    }

    /// The acceleration that is commanded at `time_us`, NED, m/s².
    pub(crate) fn acceleration_m_s2(&self, time_us: u64) -> Vector3<f64> {
        let (horizontal, vertical) = (self.horizontal.at(time_us), self.vertical.at(time_us));
        Vector3::new(horizontal.x, horizontal.y, vertical.x)
    }

    /// A sample of the position controller.
    pub(crate) fn sample_position(
        &mut self,
        configuration: &Configuration,
        design: &CascadeDesign,
        seen: &Observation,
        setpoint: &Setpoint,
        time_us: u64,
    ) {
        let period_us = configuration.controllers.position.sample_time_us;
        let vertical = self.vertical.at(time_us).x;
        let reference = &setpoint.reference;
        let motion = ReferenceMotion {
            position: reference.position_m.xy(),
            velocity: reference.velocity_m_s.xy(),
            acceleration: reference.acceleration_m_s2.xy(),
            acceleration_ahead: with_drag(configuration, setpoint).xy(),
            interval_s: interval_s(&mut self.sampled.position_us, time_us, period_us),
        };
        let limits = &configuration.limits;
        let before = self.horizontal;
        let tilt = largest_tilt(COMMANDED_TILT_SHARE * limits.tilt_rad, vertical);
        let (to, activity) =
            self.position.step(configuration, design, &seen.horizontal(), &motion, tilt, |wanted| {
                // ẍ = −g θ: what bounds the rate of the tilt bounds the rate of the acceleration.
                let paced = before.towards(
                    within_tilt(wanted, vertical, limits.tilt_rad),
                    GRAVITY_M_S2 * limits.tilt_rate_rad_s,
                    GRAVITY_M_S2 * limits.tilt_acceleration_rad_s2,
                    time_us,
                    period_us,
                );
                within_tilt(paced, vertical, limits.tilt_rad)
            });
        self.horizontal.go_to(to, time_us, period_us);
        self.activity.position = activity;
    }

    /// A sample of the altitude controller.
    pub(crate) fn sample_altitude(
        &mut self,
        configuration: &Configuration,
        design: &CascadeDesign,
        seen: &Observation,
        setpoint: &Setpoint,
        time_us: u64,
    ) {
        let period_us = configuration.controllers.altitude.sample_time_us;
        let reference = &setpoint.reference;
        let axis = |vector: &Vector3<f64>| [vector.z].into();
        let motion = ReferenceMotion {
            position: axis(&reference.position_m),
            velocity: axis(&reference.velocity_m_s),
            acceleration: axis(&reference.acceleration_m_s2),
            acceleration_ahead: axis(&with_drag(configuration, setpoint)),
            interval_s: interval_s(&mut self.sampled.altitude_us, time_us, period_us),
        };
        let range = vertical_range(configuration, upright(&seen.body));
        let (to, activity) = self.altitude.step(configuration, design, &seen.vertical(), &motion, range);
        self.vertical.go_to(Vector1::new(to), time_us, period_us);
        self.activity.altitude = activity;
    }

    /// A sample of the attitude controller: from the accelerations wanted to rotor speeds, rad/s.
    pub(crate) fn sample_attitude(
        &mut self,
        configuration: &Configuration,
        design: &CascadeDesign,
        seen: &Observation,
        heading: &Heading,
        time_us: u64,
    ) -> [f64; 4] {
        let period_us = configuration.controllers.attitude.sample_time_us;
        let period_s = configuration.controllers.attitude.sample_time_s();
        let now = (self.horizontal.at(time_us), self.vertical.at(time_us).x);
        let (tilt, reference) = attitude_reference(configuration, heading.yaw_rad, now);
        self.tilt_reference_rad = tilt;
        let next_yaw_rad = heading.yaw_rad + heading.yaw_rate_rad_s * period_s;
        let next_us = time_us + period_us;
        let ahead = (self.horizontal.ahead(next_us), self.vertical.ahead(next_us).x);
        let (_, next) = attitude_reference(configuration, next_yaw_rad, ahead);
        let rate = turned(&reference, &next) / period_s;

        let thrust_n = thrust(configuration, now.1, upright(&seen.body));
        // The altitude controller leaves the torques their reserve itself: its thrust is kept.
        let thrust_n = (thrust_n, thrust_n);
        self.command_rotors(configuration, design, seen, (&reference, &rate), thrust_n, time_us)
    }

    /// A sample of the attitude controller alone, for an attitude and a thrust from outside.
    pub(crate) fn sample_attitude_target(
        &mut self,
        configuration: &Configuration,
        design: &CascadeDesign,
        seen: &Observation,
        target: &AttitudeTarget,
        time_us: u64,
    ) -> [f64; 4] {
        let (phi, theta, _) = target.attitude.euler_angles();
        self.tilt_reference_rad = [phi, theta];
        let reference = (&target.attitude, &target.body_rate_rad_s);
        let thrust_n = (target.thrust_n, least_thrust_n(configuration, upright(&seen.body).max(UPRIGHT)));
        self.command_rotors(configuration, design, seen, reference, thrust_n, time_us)
    }

    /// Rotor speeds that turn the body to an attitude, whose rate, rad/s, is in its own axes, under a thrust, N, which may be
    /// reduced for the torques to a least one, N.
    fn command_rotors(
        &mut self,
        configuration: &Configuration,
        design: &CascadeDesign,
        seen: &Observation,
        reference: (&UnitQuaternion<f64>, &Vector3<f64>),
        (thrust_n, least_thrust_n): (f64, f64),
        time_us: u64,
    ) -> [f64; 4] {
        let period_us = configuration.controllers.attitude.sample_time_us;
        let period_s = configuration.controllers.attitude.sample_time_s();
        let body = &seen.body;
        // The controller acts on the inertia that it was designed for; all torques grow with the one that is believed in now.
        let scale = configuration.believed_inertia_kg_m2().x / design.inertia_kg_m2.x;
        let designed = configuration.with_inertia_kg_m2(&design.inertia_kg_m2);
        let gyroscopic = gyroscopic_torque(&designed, &body.body_rate_rad_s);
        let rotation = seen.rotation();
        let disturbance_n_m = rotation.disturbance_n_m / scale;
        let bounds = attitude_bounds(&design.mixer, (thrust_n, least_thrust_n), &(gyroscopic * scale));
        let (torque, activity) = self.attitude.step(
            &designed,
            design,
            &VehicleRotation { disturbance_n_m, ..rotation },
            reference,
            &bounds.map(|bound| bound / scale),
            interval_s(&mut self.sampled.attitude_us, time_us, period_us),
        );
        // The rotors answer late; until then a spinning body has turned under the torque.
        let lag_s = configuration.airframe.rotor_time_constant_s + period_s / 2.0;
        let lead = UnitQuaternion::from_scaled_axis(Vector3::z() * (-body.body_rate_rad_s.z * lag_s));
        let wanted = Wrench { thrust_n, torque_n_m: lead * ((torque + gyroscopic) * scale) };
        let rotor_command_rad_s = design.mixer.rotor_speeds_rad_s(&wanted, least_thrust_n);
        let made = wrench_of_rotors(&configuration.airframe, &rotor_command_rad_s);
        self.activity.attitude = activity;
        self.activity.attitude.cut(&wanted.torque_n_m, &made.torque_n_m);
        self.attitude.apply(design, &(lead.inverse() * made.torque_n_m / scale - gyroscopic));
        rotor_command_rad_s
    }
}

/// φ, θ and the attitude whose thrust axis makes the accelerations wanted, horizontal and vertical, m/s².
fn attitude_reference(
    configuration: &Configuration,
    yaw_rad: f64,
    (horizontal, vertical): (Vector2<f64>, f64),
) -> ([f64; 2], UnitQuaternion<f64>) {
    // m a = m g e₃ − F b₃: the thrust axis points along g e₃ − a
    let horizontal = within_tilt(horizontal, vertical, configuration.limits.tilt_rad);
    let axis = Vector3::new(-horizontal.x, -horizontal.y, GRAVITY_M_S2 - vertical);
    let (phi, theta) = tilt_angles(&axis, yaw_rad);
    ([phi, theta], UnitQuaternion::from_euler_angles(phi, theta, yaw_rad))
}

/// Acceleration, NED, m/s², that thrust and gravity must make for a set-point to be followed against the drag.
fn with_drag(configuration: &Configuration, setpoint: &Setpoint) -> Vector3<f64> {
    let drag = configuration.drag_1_s().component_mul(&setpoint.reference.velocity_m_s);
    setpoint.acceleration_ahead_m_s2 + drag
}

/// Cosine of the tilt: the down component of the body's down axis.
fn upright(body: &RigidBody) -> f64 {
    (body.rotation() * Vector3::z()).z
}

/// A horizontal acceleration, NED, m/s², shortened so that commands keep the thrust axis within
/// `tilt_rad` when the vertical acceleration is `vertical_m_s2`: |a| ≤ tan(0.6 tilt) (g − G).
fn within_tilt(wanted: Vector2<f64>, vertical_m_s2: f64, tilt_rad: f64) -> Vector2<f64> {
    let limit = libm::tan(COMMANDED_TILT_SHARE * tilt_rad) * (GRAVITY_M_S2 - vertical_m_s2).max(0.0);
    let norm = wanted.norm();
    if norm > limit { wanted * (limit / norm) } else { wanted }
}

/// Vertical accelerations G, m/s², that the thrust limits allow at this tilt: G = g − F cos(tilt)/m.
fn vertical_range(configuration: &Configuration, upright: f64) -> (f64, f64) {
    let share = upright.max(UPRIGHT) / configuration.believed_mass_kg();
    let (least, most) = thrust_range_n(configuration);
    (GRAVITY_M_S2 - most * share, GRAVITY_M_S2 - least * share)
}

/// F = m (g − G) of (7), divided by cos φ cos θ because a tilted thrust carries less.
fn thrust(configuration: &Configuration, vertical_m_s2: f64, upright: f64) -> f64 {
    if upright < UPRIGHT {
        return configuration.believed_mass_kg() * GRAVITY_M_S2;
    }
    let level = configuration.believed_mass_kg() * (GRAVITY_M_S2 - vertical_m_s2);
    let (least, most) = thrust_range_n(configuration);
    (level / upright).clamp(least, most)
}

/// ω × Jω, N·m: what (3) takes from the torques, given back.
fn gyroscopic_torque(configuration: &Configuration, body_rate_rad_s: &Vector3<f64>) -> Vector3<f64> {
    body_rate_rad_s.cross(&configuration.believed_inertia_kg_m2().component_mul(body_rate_rad_s))
}
