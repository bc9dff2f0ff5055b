//! What is decided before the closed loop flies a tick: what the watches see, and what the machine of the mode asks for.

use std::cell::Cell;

use super::super::descent::descend;
use super::super::failsafe::{Cause, Change};
use super::super::limit_release::is_fitting;
use super::super::machines::Machines;
use super::super::manual_control::fly_by_velocity;
use super::super::mission::Helm;
use super::super::notice::Severity;
use super::super::proposal::Proposal;
use super::super::situation::Situation;
use super::super::speed_choice::SpeedChoice;
use super::super::speeds::SpeedChange;
use super::super::traffic_watch::TrafficWatch;
use super::Vehicle;
use super::decision::Shown;
use crate::fence::Breach;
use crate::mode::Mode;

impl Vehicle {
    /// Looks around and at what lowered limits allow, then at the fence and at all causes of failsafes: what one of them does is decided
    /// before the next one is looked at. Then the armed vehicle is led.
    pub(super) fn lead(&mut self) {
        self.look_around();
        let easing = self.closed_loop.simulation().control().state().is_easing();
        if self.closed_loop.limits().is_eased() && is_fitting(&self.situation(), easing) {
            self.closed_loop.release_limits();
        }
        let (crossed, flies) = (Cell::new(None), Cell::new(false));
        let (mut causes, lasted_s) = (Cause::ALL.iter(), self.lasted_s);
        self.consult_in_turn(&mut [
            &mut |parts, situation, proposal| look(parts, situation, proposal, (&crossed, lasted_s)),
            &mut |parts, situation, proposal| {
                parts.fence_margin.watch(situation, proposal);
                Shown::Still
            },
            &mut |parts, situation, proposal| {
                if let Some(breach) = crossed.take() {
                    parts.failsafe.tell_crossing(situation, proposal, breach);
                }
                Shown::Still
            },
            &mut |parts, situation, proposal| {
                let Some(change) = parts.failsafe.watch(situation, proposal, &mut causes) else {
                    return Shown::Still;
                };
                if change == (Cause::Fence, Change::Begun) {
                    parts.fence.count(situation.time_us);
                }
                Shown::Again
            },
            &mut |parts, situation, proposal| {
                flies.set(situation.armed);
                if situation.armed { fly_by_mode(parts, situation, proposal) } else { Shown::Still }
            },
            &mut |parts, situation, proposal| {
                if flies.get() {
                    fly_beside_mode(parts, situation, proposal);
                }
                Shown::Still
            },
        ]);
    }

    /// Looks for what disturbs its start, the air around it, its instruments and the target of a landing.
    fn look_around(&mut self) {
        if self.machines.boot_fault.is_present() {
            self.consult(|parts, situation, proposal| parts.boot_fault.watch(situation, proposal));
        }
        if TrafficWatch::is_due(self.time_us()) {
            self.consult(|parts, situation, proposal| parts.traffic.watch(situation, proposal));
        }
        let restarted_us = self.perception.estimate().and_then(|estimate| estimate.restarted_us);
        if let Some(restarted_us) = restarted_us.filter(|_| self.identity().is_ardupilot()) {
            self.consult(|parts, situation, proposal| {
                parts.vibration.watch(situation, proposal, restarted_us);
            });
        }
        self.watch_terrain();
        if self.conduct().precision.enabled {
            self.consult(|parts, situation, proposal| parts.precision.watch(situation, proposal));
        }
    }
}

/// Looks at the pilot's consent, the speeds that hold, the fence, the wind and the battery.
fn look(
    parts: &mut Machines,
    situation: &Situation,
    proposal: &mut Proposal,
    (crossed, lasted_s): (&Cell<Option<Breach>>, f64),
) -> Shown {
    let before = (parts.consent, parts.fence, parts.simple);
    parts.consent.watch(situation);
    let chosen = SpeedChoice::of(situation, parts.mission.takes_off());
    crossed.set(parts.fence.watch(situation));
    parts.simple.watch(situation);
    parts.failsafe.feel_wind(situation.wind_m_s.norm(), lasted_s);
    if let Some(text) = parts.failsafe.feel_battery(situation) {
        proposal.say(Severity::Critical, text);
    }
    if chosen != parts.speeds.chosen() {
        proposal.change_speeds(SpeedChange::Choose(chosen));
    }
    // Only sticks refer to the headings of the simple modes.
    let turned = situation.pilot.sticks.is_some() && parts.simple != before.2;
    Shown::still_if(!turned && (parts.consent, parts.fence) == (before.0, before.1))
}

/// One tick of the armed vehicle, by mode.
fn fly_by_mode(parts: &mut Machines, situation: &Situation, proposal: &mut Proposal) -> Shown {
    let holds = situation.mode == Mode::Hold && situation.descends_without_rotor().is_none();
    match situation.mode {
        _ if situation.descends_without_rotor().is_some() => parts.rotors.descend(situation, proposal),
        _ if parts.takeoff_check.blocks(situation, proposal) => {}
        Mode::Throw => parts.throw.step(situation, proposal),
        Mode::Takeoff => parts.takeoff.step(situation, proposal),
        Mode::Hold => {}
        Mode::Position => {
            fly_by_velocity(&mut parts.climb, situation, proposal);
            parts.precision.stay_above(situation, proposal);
        }
        Mode::Flip => parts.flip.step(situation, proposal),
        Mode::ZigZag => parts.zigzag.step(&mut parts.climb, situation, proposal),
        Mode::PositionHold
            if situation.pilot.sticks.is_some_and(|sticks| sticks.leans(&situation.conduct.sticks)) =>
        {
            parts.stick_flight.step_by_height(&mut parts.climb, situation, proposal);
        }
        Mode::PositionHold => {
            parts.stick_flight.forget();
            fly_by_velocity(&mut parts.climb, situation, proposal);
        }
        Mode::Altitude => {
            parts.stick_flight.step_by_height(&mut parts.climb, situation, proposal);
        }
        Mode::Stabilize | Mode::Manual | Mode::Acro => {
            parts.stick_flight.step_by_thrust(situation, proposal);
        }
        Mode::Offboard | Mode::GuidedAttitude => {
            parts.offboard.step(&mut parts.ground_flight, situation, proposal);
        }
        Mode::Mission | Mode::MissionLanding => match parts.mission.step(situation, proposal) {
            Helm::Mission => {}
            Helm::ReturnBegins => parts.return_home.begin(situation, proposal),
            Helm::Return => parts.return_home.step(situation, proposal),
        },
        Mode::Land => descend(situation, proposal, None),
        Mode::Return => parts.return_home.step(situation, proposal),
        Mode::SmartReturn => parts.smart_return.step(situation, proposal),
        Mode::Orbit => parts.orbit.step(situation, proposal),
        Mode::Follow => parts.follow.step(situation, proposal),
    }
    Shown::still_if(holds)
}

/// What goes on in any mode while it is armed: lost set-points, the heading, and waiting on the ground.
fn fly_beside_mode(parts: &mut Machines, situation: &Situation, proposal: &mut Proposal) {
    if parts.offboard.hold_without_news(situation, proposal) {
        parts.ground_flight.forget();
    }
    parts.ground_flight.step(situation, proposal);
    if situation.mode != Mode::SmartReturn {
        parts.smart_return.watch(situation, proposal);
    }
    // The pilot goes before the wind, and the wind before headings that are asked for, as in ArduPilot.
    let by_hand = parts.pilot_turn.step(situation, proposal);
    if !by_hand {
        parts.pilot_turn.end(situation, proposal, &mut parts.turn, &mut parts.mission);
    }
    let turned = by_hand || parts.weathervane.step(situation, proposal);
    if parts.turn.is_on() && !turned {
        parts.turn.step(proposal);
    } else if !turned && situation.chooses_its_heading() {
        proposal.choose_heading(situation, parts.offboard.looks());
    }
    parts.landing.wait(situation, proposal);
    parts.obstacles.keep_distance(situation, proposal);
}
