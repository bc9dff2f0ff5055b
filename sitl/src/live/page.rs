//! The page of a run.

use std::time::{Duration, Instant};

use vehicle::parameters::Speed;
use viewer::{Action, Frame, Order, Viewer};

use super::news::NewsDesk;
use super::request::Request;
use super::sample::sample;
use super::scene::SceneWatch;
use crate::fleet::{Clock, Fleet, Member};

/// Frames per second of the wall clock, whatever the speed of simulation time.
const FRAME: Duration = Duration::from_millis(33);
/// What changes rarely is looked at each so many frames.
const RARELY: u32 = 10;
/// What is said is looked at each so many frames.
const NEWS: u32 = 3;
/// Time over which the pace is measured.
const PACE: Duration = Duration::from_millis(500);
/// Orders that take effect between two looks at the links.
const MOST_ORDERS: usize = 8;
/// Longest step while paused, s.
const LONGEST_STEP_S: f64 = 10.0;

/// Shows the fleet, and hands on what pilots ask for.
#[derive(Debug)]
pub struct LivePage {
    viewer: Viewer,
    news: NewsDesk,
    scene: SceneWatch,
    frames: u32,
    shown: Instant,
    /// When the pace was measured, at which simulation time, µs, and what it was.
    measured: (Instant, u64, f64),
}

impl LivePage {
    /// Of a fleet, which is heard from now on.
    pub fn new(viewer: Viewer, fleet: &mut Fleet, now: Instant) -> Self {
        fleet.listen();
        let (news, scene) = (NewsDesk::default(), SceneWatch::default());
        Self { viewer, news, scene, frames: 0, shown: now, measured: (now, fleet.time_us(), 0.0) }
    }

    /// The address of the page for someone who may give orders.
    pub fn pilot_url(&self) -> String {
        self.viewer.pilot_url()
    }

    /// Lets what pilots ask for take effect.
    pub fn take_orders(&mut self, fleet: &mut Fleet, clocks: &mut [Clock], now: Instant) {
        for _ in 0..MOST_ORDERS {
            let Some(Order { vehicle, action, reply }) = self.viewer.next_order() else { return };
            reply.send(self.carry_out(vehicle, &action, fleet, clocks, now));
        }
    }

    /// Shows how things are, if it is time and somebody looks on.
    pub fn show(&mut self, fleet: &mut Fleet, clocks: &[Clock], now: Instant) {
        self.news.hear(fleet.take_overheard());
        if now.saturating_duration_since(self.shown) < FRAME {
            return;
        }
        self.shown = now;
        let pace = self.pace(fleet.time_us(), now);
        if !self.viewer.is_watched() {
            // Whoever comes next gets everything at once.
            self.frames = 0;
            return;
        }
        fleet.catch_up_all(now);
        if self.frames.is_multiple_of(RARELY) {
            let autopilots = fleet.members().iter().map(Member::autopilot);
            if let Some(scene) = self.scene.changed(autopilots) {
                self.viewer.show_scene(&scene);
            }
        }
        if self.frames.is_multiple_of(NEWS) {
            self.viewer.tell(&self.news.news(fleet));
        }
        self.frames = self.frames.wrapping_add(1);
        let speed = clocks.first().map_or(0.0, |clock| match clock.speed() {
            Speed::Max => f64::INFINITY,
            Speed::Paused => 0.0,
            Speed::Factor(factor) => factor,
        });
        let vehicles = fleet.members().iter();
        let vehicles = vehicles.map(|member| sample(member.autopilot(), member.loss().is_some())).collect();
        self.viewer.show(&Frame { speed, pace, time_s: fleet.time_us() as f64 / 1e6, vehicles });
    }

    /// Simulated seconds per second of late.
    fn pace(&mut self, time_us: u64, now: Instant) -> f64 {
        let (since, from_us, pace) = &mut self.measured;
        let elapsed = now.saturating_duration_since(*since);
        if elapsed >= PACE {
            *pace = time_us.saturating_sub(*from_us) as f64 / 1e6 / elapsed.as_secs_f64();
            (*since, *from_us) = (now, time_us);
        }
        *pace
    }

    fn carry_out(
        &mut self,
        system: u8,
        action: &Action,
        fleet: &mut Fleet,
        clocks: &mut [Clock],
        now: Instant,
    ) -> Result<(), String> {
        // Time is everybody's: where the vehicle is lost, any other stands for it.
        let of_all = matches!(action, Action::Step { .. } | Action::Speed { .. });
        let mut flying = fleet
            .members()
            .iter()
            .enumerate()
            .filter(|(_, member)| member.loss().is_none())
            .map(|(number, member)| (number, member.autopilot().system_id() == system));
        let number = match flying.clone().find(|(_, is_asked)| *is_asked) {
            Some((number, _)) => number,
            None if of_all => flying.next().ok_or("no vehicle flies")?.0,
            None => return Err(format!("no vehicle {system} flies")),
        };
        if let Action::Step { time_s } = action {
            if !(0.001..=LONGEST_STEP_S).contains(time_s) {
                return Err(format!("a step takes 0.001 to {LONGEST_STEP_S} s, not {time_s}"));
            }
            let clock = clocks.iter_mut().find(|clock| clock.has(number));
            let stepped = clock.is_some_and(|clock| clock.step((time_s * 1e6).round() as u64));
            return if stepped {
                Ok(())
            } else {
                Err("pause first: time can be stepped only while it is paused".to_owned())
            };
        }
        fleet.catch_up(number, now);
        let member = fleet.members().get(number).ok_or("no such vehicle")?;
        let request = Request::of(action, member.autopilot())?;
        // What was said before is no answer.
        self.news.hear(fleet.take_overheard());
        for message in request.messages {
            fleet.ask(number, message, now);
            let heard = fleet.take_overheard();
            let refusal = self.news.refusal(&heard);
            self.news.hear(heard);
            if let Some(reason) = refusal {
                return Err(reason);
            }
        }
        Ok(())
    }
}
