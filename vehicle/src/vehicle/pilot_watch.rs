//! What a pilot asks for without flying: modes, arming, functions of switches, and the vehicle itself by moving the sticks.

use super::receiver::Pulses;
use super::situation::Situation;
use super::sticks::Sticks;
use crate::mode::{Leader, Mode};
use crate::radio::{
    Debounced, Function, GIMBAL_AXES, KNOBS, PX4_SLOTS, Position, RadioSettings, RudderArming, function,
    position, sixth,
};

/// A stick at this share of its way is at the end.
const END: f64 = 0.9;
/// Seconds that sticks must be held to arm or disarm: ArduPilot, PX4.
const HELD_US: [u64; 2] = [2_000_000, 1_000_000];
/// Over how long sticks count as moved, s.
const MOVING_S: f64 = 0.5;

/// What the pilot asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wish {
    /// A mode, by its custom mode.
    Mode(u32),
    /// A function of a switch that has come to a position.
    Function(Function, Position),
    /// A switch has a function that there is not, by its number.
    Unknown(u32),
    /// Arm.
    Arm,
    /// Disarm.
    Disarm,
    /// Fly by the sticks, in this mode.
    TakeOver(Mode),
}

/// PX4's switches.
const PX4_SWITCHES: usize = 5;

/// What has been seen of the pilot's switches and gestures.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct PilotWatch {
    modes: Debounced<usize>,
    functions: [Debounced<Position>; 16],
    switches: [Debounced<bool>; PX4_SWITCHES],
    /// Whether the gesture of arming (`true`) or disarming is being made, and since when, µs; `u64::MAX`: it has been answered.
    gesture: Option<(bool, u64)>,
    /// The sticks as they were for a while.
    resting: Option<Sticks>,
}

impl PilotWatch {
    /// Looks at the pilot for `dt_s`.
    pub fn look(&mut self, situation: &Situation, dt_s: f64) -> Vec<Wish> {
        let (pilot, settings) = (situation.pilot, &situation.conduct.radio);
        let mut wishes = Vec::new();
        if pilot.lost || pilot.sticks.is_none() {
            self.rest();
            return wishes;
        }
        if let Some(pulses) = &pilot.pulses {
            self.look_at_modes(situation, settings, pulses, &mut wishes);
            if situation.identity.is_ardupilot() {
                self.look_at_functions(situation.time_us, settings, pulses, &mut wishes);
            } else {
                self.look_at_switches(situation, settings, pulses, &mut wishes);
            }
        }
        if let Some(sticks) = pilot.sticks {
            wishes.extend(self.look_at_gesture(situation, settings, &sticks));
            wishes.extend(self.look_at_movement(situation, settings, &sticks, dt_s));
        }
        wishes
    }

    /// There is no pilot to be looked at.
    pub fn rest(&mut self) {
        (self.gesture, self.resting) = (None, None);
    }

    /// The position of the mode switch, from 0.
    pub fn switch_position(&self) -> Option<usize> {
        self.modes.counted()
    }

    /// The mode of the mode switch, by its custom mode.
    pub fn switched_mode(&self, situation: &Situation) -> Option<u32> {
        let slot = *situation.conduct.radio.modes.get(self.modes.counted()?)? as i32;
        if situation.identity.is_ardupilot() {
            return u32::try_from(slot).ok();
        }
        let (_, [main, sub], _) = PX4_SLOTS.iter().find(|(number, ..)| *number == slot)?;
        Some(main << 16 | sub << 24)
    }

    fn look_at_modes(
        &mut self,
        situation: &Situation,
        settings: &RadioSettings,
        pulses: &Pulses,
        wishes: &mut Vec<Wish>,
    ) {
        let Some((index, channel)) = settings.channel(settings.mode_channel) else { return };
        let Some(pulse) = pulses.get(index).copied().filter(|pulse| *pulse > 0) else { return };
        let slot = if situation.identity.is_ardupilot() {
            sixth(pulse)
        } else {
            Some((((channel.deflection(pulse) + 1.0) * 3.0) as usize).min(5))
        };
        let changed = slot.and_then(|slot| self.modes.see(slot, situation.time_us)).is_some();
        if changed {
            wishes.extend(self.switched_mode(situation).map(Wish::Mode));
        }
    }

    fn look_at_functions(
        &mut self,
        time_us: u64,
        settings: &RadioSettings,
        pulses: &Pulses,
        wishes: &mut Vec<Wish>,
    ) {
        let channels = settings.channels.iter().zip(pulses).zip(&mut self.functions);
        for ((channel, pulse), seen) in channels.filter(|((channel, _), _)| channel.option > 0.0) {
            let Some(now) = position(*pulse) else { continue };
            let number = channel.option as u32;
            if GIMBAL_AXES.contains(&number) || KNOBS.contains(&number) {
                continue;
            }
            let Some((before, now)) = seen.see(now, time_us) else { continue };
            let what = function(number);
            // Where a switch is found at first mostly changes nothing.
            if before.is_some() || what.is_some_and(Function::counts_at_first) {
                wishes.push(what.map_or(Wish::Unknown(number), |what| Wish::Function(what, now)));
            }
        }
    }

    fn look_at_switches(
        &mut self,
        situation: &Situation,
        settings: &RadioSettings,
        pulses: &Pulses,
        wishes: &mut Vec<Wish>,
    ) {
        const ON: f64 = 0.5;
        let switches = &settings.switches;
        let custom = |mode: Mode| situation.identity.custom_mode(mode);
        let all = [
            (switches.arm, None),
            (switches.kill, None),
            (switches.return_home, Some(Mode::Return)),
            (switches.hold, Some(Mode::Hold)),
            (switches.offboard, Some(Mode::Offboard)),
        ];
        for (place, ((number, mode), seen)) in all.into_iter().zip(&mut self.switches).enumerate() {
            let Some((index, channel)) = settings.channel(number) else { continue };
            let Some(pulse) = pulses.get(index).copied().filter(|pulse| *pulse > 0) else { continue };
            let Some((Some(_), on)) = seen.see(channel.deflection(pulse) > ON, situation.time_us) else {
                continue;
            };
            match (place, mode, on) {
                (0, ..) => wishes.push(if on { Wish::Arm } else { Wish::Disarm }),
                (_, None, true) => wishes.push(Wish::Function(Function::EmergencyStop, Position::High)),
                (_, Some(mode), true) => wishes.push(Wish::Mode(custom(mode))),
                (_, Some(mode), false) if mode == situation.mode => {
                    let slot = self.modes.counted().and_then(|slot| settings.modes.get(slot));
                    let known = slot
                        .and_then(|slot| PX4_SLOTS.iter().find(|(number, ..)| f64::from(*number) == *slot));
                    let back =
                        known.map_or(custom(Mode::Position), |(_, [main, sub], _)| main << 16 | sub << 24);
                    wishes.push(Wish::Mode(back));
                }
                _ => {}
            }
        }
    }

    /// The throttle at its low end and the rudder at one side, held.
    fn look_at_gesture(
        &mut self,
        situation: &Situation,
        settings: &RadioSettings,
        sticks: &Sticks,
    ) -> Option<Wish> {
        let ardupilot = situation.identity.is_ardupilot();
        let low = if ardupilot { sticks.throttle() <= 0.0 } else { sticks.up < -END };
        let still = ardupilot || sticks.forward.abs().max(sticks.right.abs()) < 0.5;
        let arms = match settings.rudder {
            _ if !low || !still => None,
            RudderArming::Off => None,
            _ if sticks.turn > END => Some(true),
            RudderArming::ArmsAndDisarms if sticks.turn < -END => Some(false),
            _ => None,
        };
        let useful = arms.filter(|arms| *arms != situation.armed);
        let Some(arms) = useful else {
            self.gesture = None;
            return None;
        };
        let since_us = match self.gesture {
            Some((before, since_us)) if before == arms => since_us,
            _ => situation.time_us,
        };
        self.gesture = Some((arms, since_us));
        let held_us = HELD_US[usize::from(!ardupilot)];
        let done = since_us != u64::MAX && situation.time_us >= since_us + held_us;
        if !done {
            return None;
        }
        self.gesture = Some((arms, u64::MAX));
        Some(if arms { Wish::Arm } else { Wish::Disarm })
    }

    /// PX4: moved sticks take over a mode that flies by itself.
    fn look_at_movement(
        &mut self,
        situation: &Situation,
        settings: &RadioSettings,
        sticks: &Sticks,
        dt_s: f64,
    ) -> Option<Wish> {
        let resting = self.resting.get_or_insert(*sticks);
        let share = dt_s / (MOVING_S + dt_s);
        let mut farthest: f64 = 0.0;
        for (rests, now) in [
            (&mut resting.forward, sticks.forward),
            (&mut resting.right, sticks.right),
            (&mut resting.up, sticks.up),
            (&mut resting.turn, sticks.turn),
        ] {
            farthest = farthest.max((now - *rests).abs());
            *rests += share * (now - *rests);
        }
        const AUTOMATIC: u32 = 1;
        const OFFBOARD: u32 = 2;
        let of_mode = match situation.mode.leader() {
            Leader::Sticks => 0,
            Leader::SetPoints => OFFBOARD,
            // There the sticks move the place beside the target.
            Leader::Vehicle if situation.mode == Mode::Follow => 0,
            Leader::Vehicle => AUTOMATIC,
        };
        let may = !situation.identity.is_ardupilot() && settings.take_over & of_mode != 0;
        let flies = situation.flies() && !situation.landed && situation.descends_without_rotor().is_none();
        if !may || !flies || farthest <= settings.take_over_percent / 100.0 {
            return None;
        }
        Some(Wish::TakeOver(if situation.knows_its_place() { Mode::Position } else { Mode::Altitude }))
    }
}
