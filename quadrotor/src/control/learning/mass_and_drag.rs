//! The vehicle's mass and drag, learned from thrust and acceleration in flight.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::control::learning::averaging::Averaging;
use crate::control::learning::bounded_estimate::BoundedEstimate;
use crate::control::learning::excitation::{Excitation, Shown};
use crate::control::learning::flight_sample::FlightSample;
use crate::control::learning::gust_memory::{GustMemory, Surprise};
use crate::control::learning::motion_equation::{
    MEMORY_S, MotionEquation, Sampled, Terms, noise_of_positions, noise_of_velocities,
};
use crate::control::learning::prior_knowledge::{
    DRAG_DEVIATION_1_S, MOST_FORCE_M_S2, UNKNOWNS, Unknowns, believed, prior,
};
use crate::control::learning::steady_thrust::SteadyThrust;
use crate::control::learning::thrust_fit::ThrustFit;
use crate::{Belief, Configuration, Sensors};

/// Most inertia that a learned mass stands for, as a multiple of the configured one.
const MOST_INERTIA_SHARE: f64 = 2.0;
/// Deviation of the equation of motion without noise of sensors, m/s²: what the model of rotors and their lag misses.
const MODEL_NOISE_M_S2: f64 = 0.03;

/// An acceleration along the thrust that is off by this much, m/s², and by so many deviations of the noise, is another vehicle or
/// another force: a payload that was dropped, a gust.
const SURPRISE_M_S2: f64 = 0.75;
const SURPRISE_DEVIATIONS: f64 = 5.0;
/// Time over which a force is averaged, to which its change is compared, s.
pub(super) const STEADY_FORCE_S: f64 = 3.0;
/// Time after a surprise, or a start, in which there is no other one, s.
const SETTLING_S: f64 = 1.5;
/// The part of it, s, in which a steady force is found: it is no gust.
const BEGINNING_S: f64 = 0.5;
/// So many deviations of what is not known of the drag are drag.
const DRAG_DEVIATIONS: f64 = 2.0;
/// Time in which a gust is forgotten, s: another one follows.
pub(super) const GUSTY_S: f64 = 10.0;
/// Surprises of late, each of which counts less by e within [`GUSTY_S`], beyond which the next one is a gust.
const MOST_SURPRISES: f64 = 1.5;
/// So many of them are left of one surprise within seven seconds.
const LATELY: f64 = 0.5;
/// Climbs and descents that are slower than this, m/s, are level flight.
const LEVEL_M_S: f64 = 0.5;
/// A surprise may be a gust while the thrust per mass mostly keeps within this share of it.
const STEADY_SHARE: f64 = 0.4;
/// How many times more a gust may change the force along the thrust than it shows at once across it.
const GUST_SWINGS: f64 = 5.0;
/// Equations of a filter that has taken in less than this tell nothing of gusts.
const FITTED: f64 = 0.5;
/// What the thrust does not explain of the force along it may be this many deviations of the noise.
const FIT_DEVIATIONS: f64 = 2.0;
/// How many times more a gust changes the force along the thrust than the thrust, which answers it, leaves unexplained.
const FIT_SWINGS: f64 = 20.0;

/// Time from one equation that is learned from to the next, µs, when a flight has settled: short beside the memory of the filter, so that
/// those between them tell nothing that the next one does not.
pub(super) const LEARNS_EACH_US: u64 = 20_000;
/// Slower than this, m/s, by what the filter has taken in of the velocity, it may stand on something that carries it.
const AT_REST_M_S: f64 = 0.02;

/// Of an equation.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Noise {
    /// Its deviation by sensors and by what the model misses, m/s².
    all_m_s2: f64,
    /// What the thrust does not explain of the force along it, m/s².
    unexplained_m_s2: f64,
}

/// Learns mass and drag, with the forces beside them.
///
/// What can be told apart, and what cannot: in hover the weight and a steady vertical force are the same, and so are drag in
/// steady cruise and a steady force against it. Both then keep what they were taken for, and integral action makes up for either.
/// Changes of thrust and of speed tell them apart.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct MassAndDrag {
    equation: MotionEquation,
    excitation: Excitation,
    estimate: BoundedEstimate<UNKNOWNS>,
    /// When the latest equation was made that was learned from, µs.
    latest_us: Option<u64>,
    /// Force per mass beside thrust and drag, averaged over seconds, NED, m/s².
    steady_force_m_s2: Vector3<f64>,
    /// What the estimate has not explained along the thrust in these seconds, m/s²: it is known, and no other surprise.
    steady_missed_m_s2: f64,
    /// Thrust per mass of these seconds.
    thrust: SteadyThrust,
    /// Of the force along the thrust on the thrust of these seconds.
    fit: ThrustFit,
    /// Time in which there is no surprise, s.
    settling_s: f64,
    /// How much forces from outside change, m/s², by those across the thrust: no mass does that.
    gusts_m_s2: f64,
    /// How many surprises there were of late: each counts for less as time goes by.
    surprises: f64,
    /// What was known before the first of the surprises of late, as long as they may be a gust.
    before: Option<GustMemory<UNKNOWNS>>,
}

impl MassAndDrag {
    /// What a configuration believes in.
    pub(crate) fn new(configuration: &Configuration) -> Self {
        Self {
            equation: MotionEquation::new(),
            excitation: Excitation::new(),
            estimate: BoundedEstimate::new(&prior(configuration), &believed(configuration)),
            latest_us: None,
            steady_force_m_s2: Vector3::zeros(),
            steady_missed_m_s2: 0.0,
            thrust: SteadyThrust::new(),
            fit: ThrustFit::new(),
            settling_s: SETTLING_S,
            gusts_m_s2: 0.0,
            surprises: 0.0,
            before: None,
        }
    }

    /// The learned mass as a multiple of the airframe's.
    pub(crate) fn mass_factor(&self) -> f64 {
        1.0 / self.estimate.mean()[0]
    }

    /// The learned mass, kg.
    pub(crate) fn mass_kg(&self, configuration: &Configuration) -> f64 {
        configuration.airframe.mass_kg * self.mass_factor()
    }

    /// The learned drag along the world axes, N·s/m.
    pub(crate) fn drag_n_s_m(&self, configuration: &Configuration) -> Vector3<f64> {
        self.drag_1_s() * self.mass_kg(configuration)
    }

    /// The learned drag per mass along the world axes, 1/s.
    fn drag_1_s(&self) -> Vector3<f64> {
        self.estimate.mean().fixed_rows::<3>(1).into_owned()
    }

    /// Moments of inertia for a learned mass as a share of those that are configured. The mass does not tell them: a model that
    /// is wrong is so in both, a load near the centre only in the mass. Torques for too little inertia cost the attitude its
    /// damping, for somewhat too much they do not: they are believed to grow with the mass up to twice, and to shrink with it only as
    /// far as those of the airframe.
    fn inertia_share(&self, configuration: &Configuration) -> f64 {
        let believed = configuration.controllers.mass_factor;
        (self.mass_factor() / believed).clamp(1.0 / believed.max(1.0), MOST_INERTIA_SHARE)
    }

    /// A configuration with what was learned in place of what was believed, if it is to learn.
    pub(crate) fn in_place_of_belief(&self, configuration: &Configuration) -> Configuration {
        let mut learned = *configuration;
        if configuration.controllers.learning {
            let inertia_kg_m2 = configuration.believed_inertia_kg_m2() * self.inertia_share(configuration);
            learned.controllers.mass_factor = self.mass_factor();
            learned.believe_inertia_kg_m2(&inertia_kg_m2);
            learned.airframe.drag_n_s_m = self.drag_n_s_m(configuration).into();
        }
        learned
    }

    /// What the controllers of a configuration go by.
    pub(crate) fn belief(&self, configuration: &Configuration) -> Belief {
        if configuration.controllers.learning {
            Belief { mass_kg: self.mass_kg(configuration), drag_n_s_m: self.drag_n_s_m(configuration) }
        } else {
            Belief::configured(configuration)
        }
    }

    /// Goes on under another configuration. What it believes in is learned anew if that has changed.
    pub(crate) fn reconfigure(&mut self, before: &Configuration, after: &Configuration) {
        let told = |configuration: &Configuration| {
            let Configuration { airframe, controllers, .. } = configuration;
            (*airframe, controllers.mass_factor, controllers.learning)
        };
        let (one, other) = (told(before), told(after));
        if (one.1, one.2) != (other.1, other.2) {
            *self = Self::new(after);
        } else if one != other {
            // Another vehicle that is known: what was found of its mass beside the belief stays.
            let mut mean = believed(after);
            mean[0] = self.estimate.mean()[0];
            self.estimate = BoundedEstimate::new(&prior(after), &mean);
            self.before = None;
            self.interrupt();
        }
    }

    /// Begins another flight: what was learned stays until it is seen to be wrong.
    pub(crate) fn take_off(&mut self, configuration: &Configuration) {
        self.estimate.open(&prior(configuration), &[true; UNKNOWNS]);
        self.settling_s = SETTLING_S;
        (self.gusts_m_s2, self.surprises, self.before) = (0.0, 0.0, None);
        self.fit = ThrustFit::new();
        self.interrupt();
    }

    /// Nothing can be learned from what happens now.
    pub(crate) fn interrupt(&mut self) {
        self.equation = MotionEquation::new();
        self.excitation = Excitation::new();
        self.fit.begin_anew();
        self.latest_us = None;
    }

    /// All positions are elsewhere, m, and nothing has moved.
    pub(crate) fn shift(&mut self, by_m: &Vector3<f64>) {
        self.equation.shift(by_m);
    }

    /// Learns from an instant of a flight; whether that may have changed what is believed in.
    pub(crate) fn observe(&mut self, configuration: &Configuration, sample: &FlightSample<'_>) -> bool {
        if !configuration.controllers.learning {
            return false;
        }
        let thrust_m_s2 = sample.thrust_per_mass_m_s2(configuration);
        if !sample.flies(thrust_m_s2) {
            self.interrupt();
            return false;
        }
        let FlightSample { motion, velocity_m_s: estimated_velocity_m_s, attitude, time_us, .. } = *sample;
        let sampled = Sampled { motion, estimated_velocity_m_s, attitude, thrust_m_s2, time_us };
        let before_us = self.equation.latest_us().unwrap_or(time_us);
        let Some(terms) = self.equation.observe(sampled, sample.averaging) else { return false };
        let latest_us = *self.latest_us.get_or_insert(time_us);
        let interval_us = time_us.saturating_sub(latest_us);
        let is_settled = self.settling_s == 0.0;
        if interval_us < if is_settled { LEARNS_EACH_US } else { 1 } {
            return false;
        }
        self.latest_us = Some(time_us);
        let [interval_s, sampled_s] = [interval_us, time_us - before_us].map(|us| us as f64 / 1e6);
        let mut room = None;
        let averaging = sample.averaging.over(interval_s, &mut room);
        self.settling_s = (self.settling_s - interval_s).max(0.0);
        if !terms.is_finite() {
            self.interrupt();
            return false;
        }
        let [sensed_m_s2, missed_m_s2] = noises_m_s2(&configuration.sensors, terms.filled, sampled_s);
        let noise_m_s2 = length(missed_m_s2, sensed_m_s2);
        let unexplained_m_s2 = if terms.filled > FITTED {
            let along = self.along_thrust(configuration, &terms);
            let allowed_m_s2 = FIT_DEVIATIONS * sensed_m_s2 / terms.filled;
            self.fit.see(&along, averaging.steady_motion, allowed_m_s2)
        } else {
            self.fit.deviation_m_s2()
        };
        let noise = Noise { all_m_s2: noise_m_s2, unexplained_m_s2 };
        // Also of what is not learned from: where the thrust was before it changed shows the mass as soon as it has changed.
        let (along_m_s2, drag_1_s) = (self.noise_along_m_s2(&noise), self.drag_1_s());
        let mut shown = self.excitation.observe(&terms, averaging.steady_motion, (along_m_s2, &drag_1_s));
        shown.mass &= !self.fit.is_in_doubt();
        let moves = terms.velocity_m_s.norm() > AT_REST_M_S * terms.filled;
        let learns = moves && !sample.is_saturated(configuration);
        if learns {
            self.learn(configuration, &terms, &shown, (&noise, interval_s, averaging));
        }
        learns
    }

    fn learn(
        &mut self,
        configuration: &Configuration,
        terms: &Terms,
        shown: &Shown,
        (noise, interval_s, averaging): (&Noise, f64, &Averaging),
    ) {
        let noise_m_s2 = noise.all_m_s2;
        let prior = &prior(configuration);
        let rows = [0, 1, 2].map(|axis| row(terms, axis));
        self.watch_for_an_end(&rows[2], terms, interval_s);
        let unexplained_m_s2 = self.innovation(&rows, terms);
        let change_m_s2 = unexplained_m_s2 + self.change_of_force_m_s2(terms);
        // The estimate follows a force that swings within seconds, but for its delay; a drag that is still to be learned swings with the
        // speed.
        let with_speed_m_s2 =
            DRAG_DEVIATIONS * DRAG_DEVIATION_1_S * self.excitation.change_of_speed_m_s(terms).norm();
        let swing_m_s2 = (change_m_s2.xy().norm() - with_speed_m_s2) / GUST_SWINGS;
        let kept = averaging.gusts_kept;
        self.watch_gusts(&rows, (unexplained_m_s2.xy().norm(), swing_m_s2), (noise_m_s2, kept));
        let surprise_m_s2 = SURPRISE_M_S2
            + SURPRISE_DEVIATIONS * noise_m_s2
            + self.swing_along_m_s2(self.fit.deviation_m_s2(), noise_m_s2);
        self.surprises *= kept;
        let along_m_s2 = libm::fabs(change_m_s2.z - self.known_m_s2(terms));
        let is_surprised = self.settling_s == 0.0 && along_m_s2 > surprise_m_s2;
        if is_surprised && self.surprises <= MOST_SURPRISES {
            let surprise = Surprise {
                jump_m_s2: along_m_s2,
                thrust_m_s2: terms.present_thrust_m_s2(),
                steady_thrust_m_s2: self.thrust.mean_m_s2(),
            };
            // Thrust that keeps changing shows a mass that is wrong.
            if self.thrust.deviation_m_s2() < STEADY_SHARE * along_m_s2 {
                let since_us = self.latest_us.unwrap_or_default();
                self.before.get_or_insert(GustMemory::new(self.estimate, surprise, since_us));
            }
            // What the filter remembers is of before. Drag does not jump.
            self.estimate.open(prior, &learned_from(&Shown { mass: true, drag: [false; 3] }));
            self.steady_force_m_s2 = self.force_m_s2();
            self.settling_s = SETTLING_S;
            self.surprises += 1.0;
            self.fit.jump();
            self.interrupt();
            return;
        }
        if is_surprised {
            // Loads do not come and go within seconds: what does is a force.
            self.gusts_m_s2 = self.gusts_m_s2.max(along_m_s2 / GUST_SWINGS).min(MOST_FORCE_M_S2);
        }
        let along_m_s2 = self.noise_along_m_s2(noise);
        let learned = learned_from(shown);
        self.estimate.forget(prior, &averaging.learned_kept);
        // Filtered equations repeat one another for as long as the filter remembers.
        let repeated = (2.0 * MEMORY_S / interval_s).max(1.0);
        // And one across it passes for drag, as far as the speed changes with it.
        let across_m_s2 = length(noise_m_s2, self.gusts_m_s2);
        let deviations = [across_m_s2, across_m_s2, along_m_s2];
        for ((row, force_m_s2), deviation) in rows.iter().zip(&terms.specific_force_m_s2).zip(deviations) {
            self.estimate.update(prior, &learned, row, (*force_m_s2, deviation * deviation * repeated));
        }
        let slow = averaging.steady_force;
        let share = if self.settling_s > 0.0 { 1.0 } else { slow };
        self.steady_force_m_s2 += (self.force_m_s2() - self.steady_force_m_s2) * share;
        self.steady_missed_m_s2 += (unexplained_m_s2.z / terms.filled - self.steady_missed_m_s2) * share;
        self.thrust.see(terms.present_thrust_m_s2(), slow);
    }

    /// What of the force along the thrust is missed and no other surprise, m/s²: after one, level flight shows a mass only where the thrust
    /// turns, which takes seconds. Each surprise would begin them anew.
    fn known_m_s2(&self, terms: &Terms) -> f64 {
        let is_level = libm::fabs(terms.speed_m_s().z) < LEVEL_M_S;
        if self.surprises > LATELY && is_level { self.steady_missed_m_s2 * terms.filled } else { 0.0 }
    }

    /// Goes back to what was known before a surprise that has ended: it was a gust, and no mass.
    fn watch_for_an_end(&mut self, along: &Unknowns, terms: &Terms, interval_s: f64) {
        let (Some(before), Some(now_us)) = (&mut self.before, self.latest_us) else { return };
        let missed_m_s2 = before.estimate().innovation(along, terms.specific_force_m_s2.z) / terms.filled;
        let seen = (missed_m_s2, terms.present_thrust_m_s2());
        let has_ended = before.has_ended(seen, terms.filled, interval_s);
        // What was known long ago is no better: other things have been learned since.
        let is_old = now_us.saturating_sub(before.since_us()) as f64 > 1e6 * GUSTY_S;
        let Some(known) = self.before.take_if(|_| has_ended || is_old).filter(|_| !is_old) else { return };
        self.estimate = *known.estimate();
        (self.steady_force_m_s2, self.steady_missed_m_s2) = (self.force_m_s2(), 0.0);
        let swing_m_s2 = known.most_missed_m_s2() / GUST_SWINGS;
        self.gusts_m_s2 = self.gusts_m_s2.max(swing_m_s2).min(MOST_FORCE_M_S2);
    }

    /// Deviation of the equation along the thrust, m/s²: a gust across the thrust comes with one along it, which would pass for mass.
    fn noise_along_m_s2(&self, noise: &Noise) -> f64 {
        length(noise.all_m_s2, self.swing_along_m_s2(noise.unexplained_m_s2, noise.all_m_s2))
    }

    /// How much forces from outside change along the thrust, m/s²: by those across it, and by what the thrust does not explain.
    fn swing_along_m_s2(&self, unexplained_m_s2: f64, noise_m_s2: f64) -> f64 {
        let exceeding_m_s2 = unexplained_m_s2 - FIT_DEVIATIONS * noise_m_s2;
        (GUST_SWINGS * self.gusts_m_s2).max(FIT_SWINGS * exceeding_m_s2)
    }

    /// Thrust per mass, m/s², speed along it, m/s, and specific force along it, m/s², but for the configured drag and for level forces,
    /// which lean into it; FRD, of a filter as far as it is filled.
    fn along_thrust(&self, configuration: &Configuration, terms: &Terms) -> Vector3<f64> {
        let velocity_m_s = terms.velocity_m_s.row(2).transpose();
        let drag_m_s2 = velocity_m_s.dot(&configuration.drag_1_s());
        let level_m_s2 = (terms.in_body.row(2).columns(0, 2) * self.force_m_s2().xy()).x;
        let force_m_s2 = terms.specific_force_m_s2.z + drag_m_s2 - level_m_s2;
        Vector3::new(terms.thrust_m_s2, velocity_m_s.sum(), force_m_s2) / terms.filled
    }

    /// Fades gusts to the share that is `kept`, and takes for one what is not explained of the force across the thrust, as far as it is
    /// not a drag that is still to be learned, and a swing of that force. What a flight begins with is no gust.
    fn watch_gusts(
        &mut self,
        rows: &[Unknowns; 3],
        (across_m_s2, swing_m_s2): (f64, f64),
        (noise_m_s2, kept): (f64, f64),
    ) {
        self.gusts_m_s2 *= kept;
        let least_m_s2 = SURPRISE_DEVIATIONS * noise_m_s2 + self.gusts_m_s2;
        let begins = self.settling_s > SETTLING_S - BEGINNING_S;
        if begins || across_m_s2.max(swing_m_s2) <= least_m_s2 {
            return;
        }
        let drag_m_s2 =
            rows[..2].iter().map(|row| self.estimate.deviation(&drag_part(row))).fold(0.0, f64::max);
        let change_m_s2 = swing_m_s2.max(across_m_s2 - DRAG_DEVIATIONS * drag_m_s2);
        let gust_m_s2 = change_m_s2 - SURPRISE_DEVIATIONS * noise_m_s2;
        self.gusts_m_s2 = gust_m_s2.max(self.gusts_m_s2).min(MOST_FORCE_M_S2);
    }

    /// By how much forces differ from the force of the last seconds, FRD, m/s².
    fn change_of_force_m_s2(&self, terms: &Terms) -> Vector3<f64> {
        terms.in_body * (self.force_m_s2() - self.steady_force_m_s2)
    }

    /// Acceleration by forces beside thrust and drag, NED, m/s².
    fn force_m_s2(&self) -> Vector3<f64> {
        self.estimate.mean().fixed_rows::<3>(4).into_owned()
    }

    /// What the estimate does not explain of an equation, m/s².
    fn innovation(&self, rows: &[Unknowns; 3], terms: &Terms) -> Vector3<f64> {
        Vector3::from_fn(|axis, _| self.estimate.innovation(&rows[axis], terms.specific_force_m_s2[axis]))
    }

    /// Whether a learner can have been in this state: saved states may come from anywhere.
    pub(crate) fn is_possible(&self, configuration: &Configuration) -> bool {
        self.estimate.is_possible(&prior(configuration))
            && (0.0..=SETTLING_S).contains(&self.settling_s)
            && (0.0..=MOST_FORCE_M_S2).contains(&self.gusts_m_s2)
            && (0.0..=MOST_SURPRISES + 1.0).contains(&self.surprises)
            && self.thrust.is_possible()
            && self.fit.is_possible()
            && self.before.is_none_or(|before| before.is_possible(&prior(configuration)))
    }
}

/// Deviations of a filtered equation, m/s²: by the white noise of the sensors, and by what the model misses. Of that a filter of velocities
/// has taken in as much as of all other terms: the first equations of a flight are small, and tell as much as the later ones. One of
/// positions begins with an estimated velocity, the error of which it has whole from the first equation on. The sensors are sampled each
/// `interval_s`.
fn noises_m_s2(sensors: &Sensors, filled: f64, interval_s: f64) -> [f64; 2] {
    if sensors.output_feedback {
        [sensors.position_noise_m * libm::sqrt(interval_s) * noise_of_positions(), MODEL_NOISE_M_S2]
    } else {
        let sensed_m_s2 = sensors.velocity_noise_m_s * libm::sqrt(interval_s) * noise_of_velocities();
        [sensed_m_s2, MODEL_NOISE_M_S2 * filled]
    }
}

/// √(x² + y²) of numbers whose squares are no matter.
fn length(x: f64, y: f64) -> f64 {
    libm::sqrt(x * x + y * y)
}

/// One axis of Rᵀ(a − g e₃) = −μ t e₃ − Rᵀ diag(v) κ + Rᵀ d.
fn row(terms: &Terms, axis: usize) -> Unknowns {
    let mut row = Unknowns::zeros();
    row[0] = if axis == 2 { -terms.thrust_m_s2 } else { 0.0 };
    for world in 0..3 {
        row[1 + world] = -terms.velocity_m_s[(axis, world)];
        row[4 + world] = terms.in_body[(axis, world)];
    }
    row
}

/// What is of drag in such a row.
fn drag_part(row: &Unknowns) -> Unknowns {
    Unknowns::from_fn(|unknown, _| if (1..4).contains(&unknown) { row[unknown] } else { 0.0 })
}

/// Forces are always learned, mass and drag where they show.
fn learned_from(shown: &Shown) -> [bool; UNKNOWNS] {
    let [north, east, down] = shown.drag;
    [shown.mass, north, east, down, true, true, true]
}

#[cfg(test)]
mod tests;
