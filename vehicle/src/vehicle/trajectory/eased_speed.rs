//! A speed along a curve whose acceleration changes evenly.
//!
//! ```text
//!  lead: as fast as the curve allows, under accelerations that jump ──► mean over the time T ──► jerk at most 2 a/T
//! ```
//!
//! The lead is T/2 ahead: the mean of its motion over the past T is the motion in the middle of that time, and no faster than the lead is
//! anywhere within it. It passes each place as the lead does and comes to rest where the lead does, T later.

use super::curve_speed::CurveSpeed;

/// Time over which it is eased, T, s.
pub const EASED_S: f64 = 0.5;
/// Steps of the lead within that time.
const STEPS: usize = 25;
const STEP_S: f64 = EASED_S / STEPS as f64;
/// Never slower than this, m/s, before a rest: it would not arrive.
const SLOWEST_M_S: f64 = 0.05;
/// So near to a rest, m, the lead is there.
const NEAR_M: f64 = 0.002;

/// A motion along a curve, from the beginning of a piece on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EasedSpeed {
    /// Accelerations of the lead in its past steps, m/s², the oldest at `oldest`.
    accelerations_m_s2: [f64; STEPS],
    oldest: usize,
    /// Where the lead is at the end of its latest step, m from the beginning of the piece, and how fast, m/s.
    lead_m: f64,
    lead_m_s: f64,
    /// How much of that step is over, s.
    since_s: f64,
    /// What is eased: m/s, m/s², m/s³.
    speed_m_s: f64,
    acceleration_m_s2: f64,
    jerk_m_s3: f64,
}

impl EasedSpeed {
    /// At an even speed, m/s, at the beginning of a piece.
    pub fn even(speed_m_s: f64) -> Self {
        Self {
            accelerations_m_s2: [0.0; STEPS],
            oldest: 0,
            lead_m: speed_m_s * EASED_S / 2.0,
            lead_m_s: speed_m_s,
            since_s: STEP_S,
            speed_m_s,
            acceleration_m_s2: 0.0,
            jerk_m_s3: 0.0,
        }
    }

    /// The same seen from the beginning of the next piece, a length, m, later.
    pub fn onto_next(self, length_m: f64) -> Self {
        Self { lead_m: self.lead_m - length_m, ..self }
    }

    /// Speed, m/s, acceleration, m/s², and jerk, m/s³, along the curve.
    pub fn motion(&self) -> [f64; 3] {
        [self.speed_m_s, self.acceleration_m_s2, self.jerk_m_s3]
    }

    /// Whether it is no faster than a curve allows where the lead is.
    pub fn fits(&self, curve: &CurveSpeed) -> bool {
        /// The lead brakes a little harder where it has to.
        const LITTLE_M_S: f64 = 0.05;
        self.lead_m <= curve.rest_m && self.lead_m_s <= curve.fastest_m_s(self.lead_m) + LITTLE_M_S
    }

    /// Whether it has come to rest where a rest is planned.
    pub fn rests(&self, curve: &CurveSpeed) -> bool {
        self.lead_m_s == 0.0
            && self.lead_is_there(curve)
            && self.accelerations_m_s2.iter().all(|acceleration| *acceleration == 0.0)
    }

    /// Moves on by `dt_s`. Returns by how far, m.
    pub fn step(&mut self, curve: &CurveSpeed, dt_s: f64) -> f64 {
        /// What adding times up leaves of a step, s.
        const ROUNDING_S: f64 = 1e-9;
        let (mut left_s, mut moved_m) = (dt_s, 0.0);
        while left_s > ROUNDING_S {
            if self.since_s > STEP_S - ROUNDING_S {
                self.lead_on(curve);
            }
            let part_s = left_s.min(STEP_S - self.since_s);
            let (v, a, j) = (self.speed_m_s, self.acceleration_m_s2, self.jerk_m_s3);
            moved_m += (v + (a / 2.0 + j * part_s / 6.0) * part_s) * part_s;
            self.speed_m_s = v + (a + j * part_s / 2.0) * part_s;
            self.acceleration_m_s2 = a + j * part_s;
            self.since_s += part_s;
            left_s -= part_s;
        }
        moved_m.max(0.0)
    }

    fn lead_is_there(&self, curve: &CurveSpeed) -> bool {
        curve.rest_m - self.lead_m < NEAR_M
    }

    /// One more step of the lead: to the speed that is the fastest at its end.
    fn lead_on(&mut self, curve: &CurveSpeed) {
        let v = self.lead_m_s;
        let change_m_s = curve.acceleration_m_s2 * STEP_S;
        let wanted_m_s = if self.lead_is_there(curve) {
            0.0
        } else {
            curve.fastest_m_s(self.lead_m + v * STEP_S).max(SLOWEST_M_S)
        };
        // The plan can be kept; where it is not quite, it brakes a little harder.
        self.lead_m_s = wanted_m_s.clamp((v - 2.0 * change_m_s).max(0.0), v + change_m_s);
        let acceleration_m_s2 = (self.lead_m_s - v) / STEP_S;
        self.lead_m += (v + self.lead_m_s) / 2.0 * STEP_S;

        self.acceleration_m_s2 = self.accelerations_m_s2.iter().sum::<f64>() / STEPS as f64;
        let oldest = &mut self.accelerations_m_s2[self.oldest];
        self.jerk_m_s3 = (acceleration_m_s2 - *oldest) / EASED_S;
        *oldest = acceleration_m_s2;
        self.oldest = (self.oldest + 1) % STEPS;
        self.since_s = 0.0;
    }
}
