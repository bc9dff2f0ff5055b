//! Lock-step with a client: simulation time waits for its set-points.
//!
//! ```text
//!                       set-point                        end of the period
//!   free-running ─────────────────────► flying a period ───────────────────► waiting
//!        ▲                                     ▲           ◄── set-point ──     │
//!        └──────────────────── no set-point for too long ────────────────────────┘
//! ```
//!
//! While a period is flown, received messages are held until it ends. So each message takes effect at a simulation time
//! that follows from the order of the messages alone, whatever the speed of the simulation and of the client.

use std::time::{Duration, Instant};

use autopilot::envelope::PeerId;

use super::held::{Held, is_set_point};
use crate::link::Received;

/// Where nothing depends on set-points, a client that is silent for so long has ended its stream: PX4, too, asks for two a
/// second.
const STREAM_END: Duration = Duration::from_millis(500);
/// A client that does not answer a report gets another one: UDP may have lost it.
const REMINDER: Duration = Duration::from_secs(1);

/// When simulation time waits for set-points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, clap::ValueEnum)]
pub enum LockstepPhase {
    /// While a client streams them.
    #[default]
    Streaming,
    /// From the start, in every mode.
    Always,
}

/// How a vehicle keeps step with its client.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LockstepSettings {
    /// When it waits.
    pub phase: LockstepPhase,
    /// Simulated time that each set-point is good for, µs.
    pub period_us: u64,
    /// A vehicle in flight that has waited so long flies on.
    pub timeout: Duration,
}

/// What lock-step goes by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Circumstances {
    /// Simulation time, µs.
    pub time_us: u64,
    /// Whether the rotors turn.
    pub armed: bool,
    /// Whether the mode follows set-points.
    pub offboard: bool,
    /// Whether simulation time stands still by request.
    pub paused: bool,
}

/// What is to be done while the vehicle waits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// Nothing: it flies.
    Fly,
    /// Nothing: a set-point can be expected at any moment.
    Expect,
    /// Nothing: it has waited for a while already.
    Wait,
    /// Tell the client where the vehicle is.
    Report(PeerId),
    /// Tell everyone that it flies on without its client.
    GiveUp,
}

/// The step that a vehicle keeps with its client.
#[derive(Debug)]
pub struct Lockstep {
    settings: LockstepSettings,
    /// End of the period that is flown, µs; `None`: it runs freely.
    until_us: Option<u64>,
    held: Held,
    /// Of the client's last set-point.
    client: Option<PeerId>,
    /// Whether the client knows where the vehicle is.
    reported: bool,
    waiting_since: Option<Instant>,
    reminded: Option<Instant>,
}

impl Lockstep {
    /// A vehicle that has just started.
    pub fn new(settings: LockstepSettings) -> Self {
        let until_us = (settings.phase == LockstepPhase::Always).then_some(0);
        Self {
            settings,
            until_us,
            held: Held::default(),
            client: None,
            reported: false,
            waiting_since: None,
            reminded: None,
        }
    }

    /// Simulation time that must not be passed now, µs.
    pub fn limit_us(&self) -> Option<u64> {
        self.until_us
    }

    /// The client that it keeps step with.
    pub fn client(&self) -> Option<PeerId> {
        self.client
    }

    /// How long it waits for a set-point.
    pub fn timeout(&self) -> Duration {
        self.settings.timeout
    }

    /// Whether it holds so many messages of a peer that the next have to wait.
    pub fn is_full(&self, peer: PeerId) -> bool {
        self.held.is_full(peer)
    }

    /// A message has come.
    pub fn put(&mut self, received: Received) {
        self.held.put(received);
    }

    /// The effect of a message of a peer has cost this much.
    pub fn charge(&mut self, peer: PeerId, cost: Duration) {
        self.held.charge(peer, cost);
    }

    /// The next message that takes effect now.
    pub fn take(&mut self, now: &Circumstances) -> Option<Received> {
        let flying = self.until_us.is_some_and(|until_us| now.time_us < until_us);
        // A pause must be able to end.
        let received = self.held.take(flying && !now.paused)?;
        if is_set_point(&received.frame) {
            self.until_us = Some(now.time_us + self.settings.period_us);
            self.client = Some(received.origin.peer);
            (self.reported, self.waiting_since, self.reminded) = (false, None, None);
        }
        Some(received)
    }

    /// The client has been told where the vehicle is.
    pub fn has_reported(&mut self) {
        self.reported = true;
    }

    /// What is to be done at an instant of the wall clock; `connected`: whether the client can still be reached.
    pub fn step(&mut self, now: &Circumstances, wall: Instant, connected: bool) -> Step {
        match self.until_us {
            Some(until_us) if now.time_us >= until_us => {}
            _ => return Step::Fly,
        }
        let always = self.settings.phase == LockstepPhase::Always;
        // On the ground nothing is lost by waiting.
        let unlimited = always && !now.armed;
        if unlimited {
            self.waiting_since = None;
        }
        let needed = always || is_steered(now);
        let longest = if needed { self.settings.timeout } else { STREAM_END };
        let waited = wall.saturating_duration_since(*self.waiting_since.get_or_insert(wall));
        if !unlimited && (waited >= longest || !connected) {
            (self.until_us, self.waiting_since) = (None, None);
            return if needed { Step::GiveUp } else { Step::Fly };
        }
        let silent = wall.saturating_duration_since(*self.reminded.get_or_insert(wall));
        match self.client {
            Some(client) if !self.reported || silent >= REMINDER => {
                (self.reported, self.reminded) = (true, Some(wall));
                Step::Report(client)
            }
            Some(_) if silent < Duration::from_millis(20) => Step::Expect,
            _ => Step::Wait,
        }
    }
}

fn is_steered(now: &Circumstances) -> bool {
    now.armed && now.offboard
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use autopilot::codec::{Frame, Version, id};
    use autopilot::envelope::{Origin, PeerId};
    use mavlink::dialects::ardupilotmega::{HEARTBEAT_DATA, MavMessage, SET_POSITION_TARGET_LOCAL_NED_DATA};

    use super::{Circumstances, Lockstep, LockstepPhase, LockstepSettings, Step};
    use crate::link::Received;

    const CLIENT: PeerId = PeerId { link: 0, number: 7 };
    const TIMEOUT: Duration = Duration::from_secs(5);
    const STEERED: Circumstances =
        Circumstances { time_us: 100_000, armed: true, offboard: true, paused: false };

    fn lockstep(phase: LockstepPhase) -> Lockstep {
        Lockstep::new(LockstepSettings { phase, period_us: 20_000, timeout: TIMEOUT })
    }

    fn put(lockstep: &mut Lockstep, message: MavMessage) {
        put_from(lockstep, CLIENT, message);
    }

    fn put_from(lockstep: &mut Lockstep, peer: PeerId, message: MavMessage) {
        let frame = Frame::encode(&message.into(), Version::Two, 0, (255, 190)).expect("MAVLink 2");
        lockstep.put(Received { origin: Origin { peer, system: 255, component: 190 }, frame });
    }

    fn set_point(lockstep: &mut Lockstep) {
        put(
            lockstep,
            MavMessage::SET_POSITION_TARGET_LOCAL_NED(SET_POSITION_TARGET_LOCAL_NED_DATA::default()),
        );
    }

    fn heartbeat(lockstep: &mut Lockstep) {
        put(lockstep, MavMessage::HEARTBEAT(HEARTBEAT_DATA::default()));
    }

    /// Messages that take effect now.
    fn taken(lockstep: &mut Lockstep, now: &Circumstances) -> Vec<u32> {
        std::iter::from_fn(|| lockstep.take(now)).map(|received| received.frame.message_id()).collect()
    }

    #[test]
    fn a_set_point_is_good_for_one_period_and_what_comes_meanwhile_waits_for_its_end() {
        let mut lockstep = lockstep(LockstepPhase::Streaming);
        assert_eq!(lockstep.limit_us(), None);
        set_point(&mut lockstep);
        heartbeat(&mut lockstep);
        assert_eq!(taken(&mut lockstep, &STEERED), [id::SET_POSITION_TARGET_LOCAL_NED]);
        assert_eq!(lockstep.limit_us(), Some(120_000));
        let during = Circumstances { time_us: 119_000, ..STEERED };
        assert_eq!(lockstep.step(&during, Instant::now(), true), Step::Fly);
        set_point(&mut lockstep);
        assert!(taken(&mut lockstep, &during).is_empty());
        let end = Circumstances { time_us: 120_000, ..STEERED };
        assert_eq!(taken(&mut lockstep, &end), [id::HEARTBEAT, id::SET_POSITION_TARGET_LOCAL_NED]);
        assert_eq!(lockstep.limit_us(), Some(140_000));
    }

    #[test]
    fn surplus_set_points_do_not_pile_up() {
        let mut lockstep = lockstep(LockstepPhase::Streaming);
        (0..5).for_each(|_| set_point(&mut lockstep));
        assert_eq!(taken(&mut lockstep, &STEERED).len(), 4);
        assert_eq!(lockstep.limit_us(), Some(120_000));
    }

    #[test]
    fn a_client_does_not_wait_behind_what_others_have_held() {
        let mut lockstep = lockstep(LockstepPhase::Streaming);
        set_point(&mut lockstep);
        assert_eq!(taken(&mut lockstep, &STEERED).len(), 1);
        let other = PeerId { link: 1, number: 3 };
        while !lockstep.is_full(other) {
            put_from(&mut lockstep, other, MavMessage::HEARTBEAT(HEARTBEAT_DATA::default()));
        }
        let during = Circumstances { time_us: 119_000, ..STEERED };
        assert!(lockstep.take(&during).is_none(), "a flood does not take effect earlier, either");
        set_point(&mut lockstep);
        assert!(!lockstep.is_full(CLIENT));
        let end = Circumstances { time_us: 120_000, ..STEERED };
        let mut before = 0;
        while let Some(received) = lockstep.take(&end) {
            before += usize::from(received.origin.peer == other);
            lockstep.charge(received.origin.peer, Duration::from_micros(50));
        }
        assert_eq!(lockstep.limit_us(), Some(140_000), "the set-point has begun the next period");
        assert!(before <= 3, "{before} messages of the other took effect before it");
    }

    #[test]
    fn other_messages_are_answered_while_it_waits_and_during_a_pause() {
        let mut lockstep = lockstep(LockstepPhase::Always);
        let start = Circumstances { time_us: 0, armed: false, offboard: false, paused: false };
        heartbeat(&mut lockstep);
        assert_eq!(taken(&mut lockstep, &start), [id::HEARTBEAT]);
        assert_eq!(lockstep.limit_us(), Some(0));
        set_point(&mut lockstep);
        heartbeat(&mut lockstep);
        assert_eq!(taken(&mut lockstep, &start), [id::SET_POSITION_TARGET_LOCAL_NED]);
        assert_eq!(taken(&mut lockstep, &Circumstances { paused: true, ..start }), [id::HEARTBEAT]);
    }

    #[test]
    fn the_client_is_told_where_the_vehicle_is_and_told_again() {
        let mut lockstep = lockstep(LockstepPhase::Streaming);
        set_point(&mut lockstep);
        assert_eq!(taken(&mut lockstep, &STEERED).len(), 1);
        let end = Circumstances { time_us: 120_000, ..STEERED };
        let wall = Instant::now();
        assert_eq!(lockstep.step(&end, wall, true), Step::Report(CLIENT));
        assert_eq!(lockstep.step(&end, wall, true), Step::Expect);
        assert_eq!(lockstep.step(&end, wall + Duration::from_millis(900), true), Step::Wait);
        assert_eq!(lockstep.step(&end, wall + Duration::from_millis(1_000), true), Step::Report(CLIENT));
        // A report that telemetry has brought already is not repeated.
        set_point(&mut lockstep);
        assert_eq!(taken(&mut lockstep, &end).len(), 1);
        lockstep.has_reported();
        let end = Circumstances { time_us: 140_000, ..STEERED };
        assert_eq!(lockstep.step(&end, wall, true), Step::Expect);
    }

    #[test]
    fn an_armed_vehicle_gives_up_after_the_timeout_or_when_the_client_is_gone() {
        for (waited, connected) in [(TIMEOUT, true), (Duration::ZERO, false)] {
            for phase in [LockstepPhase::Streaming, LockstepPhase::Always] {
                let mut lockstep = lockstep(phase);
                set_point(&mut lockstep);
                assert_eq!(taken(&mut lockstep, &STEERED).len(), 1);
                let end = Circumstances { time_us: 120_000, ..STEERED };
                let wall = Instant::now();
                assert_eq!(lockstep.step(&end, wall, true), Step::Report(CLIENT));
                assert_eq!(lockstep.step(&end, wall + waited, connected), Step::GiveUp);
                assert_eq!(lockstep.limit_us(), None);
                assert_eq!(lockstep.step(&end, wall + waited, connected), Step::Fly);
                // The next set-point takes up the step again.
                set_point(&mut lockstep);
                assert_eq!(taken(&mut lockstep, &end).len(), 1);
                assert_eq!(lockstep.limit_us(), Some(140_000));
            }
        }
    }

    #[test]
    fn a_disarmed_vehicle_waits_without_limit_and_time_counts_from_arming() {
        let mut lockstep = lockstep(LockstepPhase::Always);
        let start = Circumstances { time_us: 0, armed: false, offboard: false, paused: false };
        let wall = Instant::now();
        assert_eq!(lockstep.step(&start, wall, true), Step::Wait);
        let later = wall + Duration::from_secs(3600);
        assert_eq!(lockstep.step(&start, later, true), Step::Wait);
        let armed = Circumstances { armed: true, ..start };
        assert_eq!(lockstep.step(&armed, later, true), Step::Wait);
        assert_eq!(lockstep.step(&armed, later + TIMEOUT, true), Step::GiveUp);
    }

    #[test]
    fn a_stream_may_end_without_a_word_where_nothing_depends_on_it() {
        let mut lockstep = lockstep(LockstepPhase::Streaming);
        for not_steered in
            [Circumstances { offboard: false, ..STEERED }, Circumstances { armed: false, ..STEERED }]
        {
            // The stream begins before the mode that follows it.
            set_point(&mut lockstep);
            assert_eq!(taken(&mut lockstep, &not_steered).len(), 1);
            assert_eq!(lockstep.limit_us(), Some(120_000));
            let end = Circumstances { time_us: 120_000, ..not_steered };
            let wall = Instant::now();
            assert_eq!(lockstep.step(&end, wall, true), Step::Report(CLIENT));
            assert_eq!(lockstep.step(&end, wall + Duration::from_millis(499), true), Step::Wait);
            assert_eq!(lockstep.step(&end, wall + Duration::from_millis(500), true), Step::Fly);
            assert_eq!(lockstep.limit_us(), None);
        }
    }
}
