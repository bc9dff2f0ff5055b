//! The motion that led to a plan, as far back as it is smoothed over.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::PositionReference;
use crate::guidance::smoothing::Smoothing;

/// Most jumps that are told apart. A goal that moves at each sample of the position controller makes five new plans within the time that
/// is smoothed over, and each of them adds one jump and those that it has come to.
const JUMPS: usize = 24;

/// A motion under constant jerk, and the jumps of its jerk since then. Times are those of the plan after it, s, and negative.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct PastMotion {
    begin_s: f64,
    begin: PositionReference,
    /// Only the first `count` are used; the oldest first.
    jumps: [(f64, Vector3<f64>); JUMPS],
    count: usize,
}

impl PastMotion {
    /// A motion that has had a jerk since a time, s.
    pub fn new(begin_s: f64, begin: &PositionReference) -> Self {
        Self { begin_s, begin: *begin, jumps: [(0.0, Vector3::zeros()); JUMPS], count: 0 }
    }

    /// The same motion seen `later_s` later and from elsewhere, without the jumps before a time, s, which its beginning then stands
    /// for.
    pub fn seen(&self, later_s: f64, from_m: &Vector3<f64>, since_s: f64) -> Self {
        let mut begin = self.begin;
        begin.position_m += from_m;
        let mut seen = Self::new(self.begin_s - later_s, &begin);
        for (time_s, jump) in
            self.jumps.iter().take(self.count).map(|(time_s, jump)| (time_s - later_s, jump))
        {
            if time_s <= since_s { seen.begin_at(time_s, jump) } else { seen.jump(time_s, jump) }
        }
        seen
    }

    /// The same motion elsewhere, m.
    pub fn shift(&mut self, by_m: &Vector3<f64>) {
        self.begin.position_m += by_m;
    }

    /// The jerk jumps once more. When there is no more room the oldest jump is forgotten: it counts as if it had always been.
    pub fn jump(&mut self, time_s: f64, by_m_s3: &Vector3<f64>) {
        if self.count == JUMPS {
            let (oldest_s, oldest) = self.jumps[0];
            self.begin_at(oldest_s, &oldest);
            self.jumps.rotate_left(1);
            self.count -= 1;
        }
        if let Some(free) = self.jumps.get_mut(self.count) {
            *free = (time_s, *by_m_s3);
            self.count += 1;
        }
    }

    /// The motion begins when its jerk jumps.
    fn begin_at(&mut self, time_s: f64, by_m_s3: &Vector3<f64>) {
        self.begin = self.begin.after(time_s - self.begin_s);
        self.begin.jerk_m_s3 += by_m_s3;
        self.begin_s = time_s;
    }

    /// What is smoothed of it at a time, s, as if it went on.
    pub fn smoothed(&self, smoothing: &Smoothing, time_s: f64) -> PositionReference {
        let mut now = smoothing.of_constant_jerk(&self.begin, time_s - self.begin_s);
        for (jump_s, jump) in self.jumps.iter().take(self.count) {
            add(&mut now, smoothing.step(time_s - jump_s).map(|part| jump * part));
        }
        now
    }
}

/// Adds to position, velocity, acceleration, jerk and snap.
pub(crate) fn add(to: &mut PositionReference, parts: [Vector3<f64>; 5]) {
    let [position, velocity, acceleration, jerk, snap] = parts;
    to.position_m += position;
    to.velocity_m_s += velocity;
    to.acceleration_m_s2 += acceleration;
    to.jerk_m_s3 += jerk;
    to.snap_m_s4 += snap;
}
