//! A clock of simulation time, and the vehicles that tick by it.

use std::ops::Range;
use std::time::{Duration, Instant};

use vehicle::TICK_US;
use vehicle::parameters::Speed;

use super::{Fleet, Member};
use crate::pace::Pace;

/// The links are looked at this often, and after each round of all vehicles.
const BURST: Duration = Duration::from_millis(2);
/// Ticks that one vehicle flies between two looks at the clock, which costs about as much as one. Several share them, as far as each flies
/// [`AT_ONCE`].
const MOST_TICKS: u64 = 20;
/// Of each vehicle so many, or a multiple of it, if they are due: one that hovers flies them at once. Half of its long tick: links wait for all
/// vehicles.
const AT_ONCE: u64 = 10;
/// Messages of several ticks share a datagram where simulation time is fast; none waits much longer than this for others.
const LONGEST_WAIT: Duration = Duration::from_millis(1);

/// Simulation time of some vehicles: they tick together, and share its speed.
#[derive(Debug)]
pub struct Clock {
    pace: Pace,
    speed: Speed,
    members: Range<usize>,
    time_us: u64,
    end_us: Option<u64>,
    /// Until when it goes on although it is paused, µs.
    step_to_us: u64,
}

impl Clock {
    /// A clock that begins to run now.
    pub fn new(speed: Speed, members: Range<usize>, end_us: Option<u64>, now: Instant) -> Self {
        Self { pace: Pace::new(speed, now, 0), speed, members, time_us: 0, end_us, step_to_us: 0 }
    }

    /// Whether it has come to its end, or nobody flies by it any more.
    pub fn is_over(&self, fleet: &Fleet) -> bool {
        let lost = |member: &Member| member.loss().is_some();
        self.has_ended()
            || fleet.members().get(self.members.clone()).is_none_or(|members| members.iter().all(lost))
    }

    fn has_ended(&self) -> bool {
        self.end_us.is_some_and(|end_us| self.time_us >= end_us)
    }

    /// Whether a vehicle flies by it.
    pub fn has(&self, member: usize) -> bool {
        self.members.contains(&member)
    }

    /// Simulation time that was asked for.
    pub fn speed(&self) -> Speed {
        self.speed
    }

    /// Goes on for a time although it is paused. Whether it is paused.
    pub fn step(&mut self, time_us: u64) -> bool {
        let paused = self.speed == Speed::Paused;
        if paused {
            self.step_to_us = self.step_to_us.max(self.time_us).saturating_add(time_us);
        }
        paused
    }

    /// Flies its vehicles on to where simulation time should be, for about a share of a burst. Whether it is still
    /// behind after that.
    pub fn advance(&mut self, fleet: &mut Fleet, now: Instant, clocks: u32) -> bool {
        self.agree_on_speed(fleet, now);
        if !self.is_patient() {
            self.members.clone().for_each(|number| fleet.catch_up(number, now));
        }
        let limit_us = fleet.limit_us(self.members.clone());
        let (goal_us, longest) = match self.pace.goal_us(self.speed, now, self.time_us) {
            None => (limit_us, BURST),
            Some(goal_us) if self.speed == Speed::Paused => {
                (goal_us.max(self.step_to_us).min(limit_us), 4 * BURST)
            }
            Some(goal_us) => (goal_us.min(limit_us), 4 * BURST),
        };
        self.fly_to(fleet, goal_us, longest / clocks.max(1), now)
    }

    /// A new speed of one vehicle is that of all, and told by all.
    fn agree_on_speed(&mut self, fleet: &mut Fleet, now: Instant) {
        let speeds = self.members.clone().filter_map(|number| fleet.members().get(number));
        // Whoever rests behind its clock has been told nothing.
        let speeds = speeds.filter(|member| !member.is_behind());
        let mut news = speeds.map(|member| member.autopilot().speed()).filter(|speed| *speed != self.speed);
        let Some(speed) = news.next() else { return };
        // A step is of the pause in which it was asked for.
        (self.speed, self.step_to_us) = (speed, 0);
        for number in self.members.clone() {
            let Some(member) = fleet.attend(number, now) else { continue };
            if member.autopilot.speed() != speed {
                member.autopilot.set_speed(speed);
                fleet.send(number, now);
            }
        }
    }

    /// Flies on to a time, µs, but hardly longer than a time of the wall clock. Whether it is not there yet.
    fn fly_to(&mut self, fleet: &mut Fleet, goal_us: u64, longest: Duration, now: Instant) -> bool {
        let start = Instant::now();
        let mut flushed = Duration::ZERO;
        loop {
            // Up to a multiple, where what hovers is looked at.
            let at_once = ticks_at_once(fleet.members().len()) - self.time_us / TICK_US % AT_ONCE;
            let ticks = self.ticks_to(goal_us).min(at_once);
            if ticks == 0 {
                return false;
            }
            let begun_us = self.time_us;
            self.time_us += ticks * TICK_US;
            let patient = self.is_patient() && !self.has_ended();
            fleet.fly(self.members.clone(), begun_us..self.time_us, patient, now);
            let elapsed = start.elapsed();
            if elapsed >= longest {
                return true;
            }
            if elapsed >= flushed + LONGEST_WAIT {
                fleet.flush();
                flushed = elapsed;
            }
        }
    }

    /// Whether those that rest may be some milliseconds of simulation time behind it: hardly more of the wall clock, for they tell of themselves
    /// that much later. As fast as possible, they fly that far at once.
    fn is_patient(&self) -> bool {
        matches!(self.speed, Speed::Factor(factor) if factor >= 1.0)
    }

    /// Ticks to a time, µs, or to the end.
    fn ticks_to(&self, goal_us: u64) -> u64 {
        let left_us = self.end_us.map_or(u64::MAX, |end_us| end_us.saturating_sub(self.time_us));
        let ticks = goal_us.saturating_sub(self.time_us) / TICK_US;
        ticks.min(left_us.div_ceil(TICK_US))
    }
}

/// Ticks that each vehicle flies between two looks at the clock: few of many vehicles, because the links wait.
fn ticks_at_once(vehicles: usize) -> u64 {
    (MOST_TICKS / vehicles.max(1) as u64).next_multiple_of(AT_ONCE).max(AT_ONCE)
}

#[cfg(test)]
mod tests {
    use super::ticks_at_once;

    #[test]
    fn many_vehicles_fly_few_ticks_at_once() {
        assert_eq!([0, 1, 2, 3, 4, 8, 9, 200].map(ticks_at_once), [20, 20, 10, 10, 10, 10, 10, 10]);
    }
}
