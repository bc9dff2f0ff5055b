//! What is received of the pilot: the radio, overrides of its channels, and MANUAL_CONTROL.

use super::sticks::Sticks;
use crate::identity::Identity;
use crate::radio::{CHANNELS, InputChoice, MIDDLE_US, RadioFailure, RadioSettings};

/// Pulses of all channels, µs; 0: none.
pub type Pulses = [u16; CHANNELS];

/// A throttle must be this low for so long to be that of a lost sender, µs.
const LOW_US: u64 = 60_000;
/// What the receiver of SIM_RC_FAIL = 2 shows as throttle, µs.
const LOST_THROTTLE_US: u16 = 950;
/// A throttle at its low end for this long stops the rotors' work, µs.
const ZERO_US: u64 = 400_000;

/// The pilot as the vehicle sees him.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Pilot {
    /// The sticks; `None`: there is no pilot.
    pub sticks: Option<Sticks>,
    /// Whether there was one, and is no more.
    pub lost: bool,
    /// Whether that is a reason to act: PX4 does without a pilot who was not there when it was armed.
    pub missed: bool,
    /// Whether there is no pilot any more, because overrides of channels have ended.
    pub released: bool,
    /// Whether the throttle has been at its low end for a while.
    pub throttle_is_zero: bool,
    /// The pulses that count now; `None`: no radio.
    pub pulses: Option<Pulses>,
    /// The pulses of when the radio was last to be believed.
    pub believed: Option<Pulses>,
    /// Whether the pulses are not to be believed, as the radio is lost or is about to be.
    pub is_doubted: bool,
    /// Whether a radio has ever been received.
    pub has_radio: bool,
    /// Whether the radio is being calibrated: its sticks and switches mean nothing.
    pub is_calibrating: bool,
}

impl Pilot {
    /// The sticks of a pilot who is there: those of one who is lost are what a failsafe makes of them.
    pub fn present_sticks(&self) -> Option<Sticks> {
        self.sticks.filter(|_| !self.lost)
    }
}

/// Where sticks come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Source {
    Radio,
    Joystick,
}

/// What has been received.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Receiver {
    /// What the radio sends until it sends something else, µs.
    radio: Option<Pulses>,
    /// Overridden channels: pulses, µs, and when they came, µs.
    overrides: [Option<(u16, u64)>; CHANNELS],
    /// Sticks of MANUAL_CONTROL, and when they came, µs.
    joystick: Option<(Sticks, u64)>,
    /// Whether a switch keeps overrides off.
    refuses_overrides: bool,
    first: Option<Source>,
    /// When sticks were received last, µs; `None`: never.
    received_us: Option<u64>,
    low_since_us: Option<u64>,
    zero_since_us: Option<u64>,
    optional: bool,
    calibrating: bool,
    now: Pilot,
}

impl Receiver {
    /// The pilot now.
    pub fn pilot(&self) -> &Pilot {
        &self.now
    }

    /// Takes overrides from now on, or none, and gives all channels back.
    pub fn switch_overrides(&mut self, taken: bool) {
        self.refuses_overrides = !taken;
        if !taken {
            self.overrides = Default::default();
        }
    }

    /// The radio sends these pulses from now on, µs; 0 where there is no channel.
    pub fn receive(&mut self, pulses: Pulses) {
        self.radio = Some(pulses);
    }

    /// What the radio sends, if there is one.
    pub fn radio(&self) -> Option<Pulses> {
        self.radio
    }

    /// Overrides channels: `None` leaves one as it is, 0 gives it back.
    pub fn take_overrides(&mut self, pulses: &[Option<u16>; CHANNELS], time_us: u64) {
        if self.refuses_overrides {
            return;
        }
        for (channel, pulse) in self.overrides.iter_mut().zip(pulses) {
            match pulse {
                None => {}
                Some(0) => *channel = None,
                Some(pulse) => *channel = Some((*pulse, time_us)),
            }
        }
    }

    /// Takes the sticks of MANUAL_CONTROL. ArduPilot overrides the channels of the sticks by them.
    pub fn take_sticks(
        &mut self,
        sticks: Sticks,
        identity: Identity,
        settings: &RadioSettings,
        time_us: u64,
    ) {
        if !identity.is_ardupilot() {
            self.joystick = Some((sticks, time_us));
            return;
        }
        let axes = settings.axes;
        let shares = [
            (axes.roll, (sticks.right + 1.0) / 2.0),
            // A stick that is pushed is a short pulse.
            (axes.pitch, (1.0 - sticks.forward) / 2.0),
            (axes.throttle, sticks.throttle()),
            (axes.yaw, (sticks.turn + 1.0) / 2.0),
        ];
        let mut pulses = [None; CHANNELS];
        for (number, share) in shares {
            let Some((index, channel)) = settings.channel(number) else { continue };
            if let Some(pulse) = pulses.get_mut(index) {
                *pulse = Some(channel.pulse_us(share));
            }
        }
        self.take_overrides(&pulses, time_us);
    }

    /// It is armed: a pilot who is not there then is not needed until he comes back, and a calibration is over.
    pub fn arm(&mut self) {
        self.calibrating = false;
        self.optional = self.now.lost;
    }

    /// Begins or ends a calibration of the radio. Returns whether one was under way.
    pub fn calibrate(&mut self, begins: bool) -> bool {
        std::mem::replace(&mut self.calibrating, begins)
    }

    /// Looks at what has been received up to a time, µs. `timeout_s` is how long sticks count, `watched` whether anything is done about
    /// a throttle that is too low.
    pub fn look(
        &mut self,
        identity: Identity,
        settings: &RadioSettings,
        (timeout_s, watched): (f64, bool),
        time_us: u64,
    ) {
        let pulses = self.pulses(identity, settings, timeout_s, time_us);
        if self.calibrating {
            self.now = self.calibrated(pulses);
            return;
        }
        let young = |taken_us: u64| time_us.saturating_sub(taken_us) <= (timeout_s * 1e6) as u64;
        let joystick = self.joystick.filter(|(_, taken_us)| young(*taken_us)).map(|(sticks, _)| sticks);
        let by_radio = pulses.map(|pulses| decoded(&pulses, identity, settings));
        let chosen =
            if identity.is_ardupilot() { by_radio } else { self.choose(settings, by_radio, joystick) };
        if chosen.is_some() {
            self.received_us = Some(time_us);
        }
        let watched = watched && identity.is_ardupilot();
        let low = self.is_low(watched, settings, pulses.as_ref(), time_us);
        let ever = self.received_us.is_some();
        // ArduPilot's simulation has a radio all the time, unless that fails: what overrides gave back is centred. PX4's timeout has
        // passed already.
        let fails = identity.is_ardupilot() && settings.failure.is_silence();
        let silent = ever && chosen.is_none() && !(fails && self.received_us.is_some_and(young));
        let gone = silent && (fails || !identity.is_ardupilot());
        let released = silent && !gone;
        let sticks = match chosen {
            _ if low || gone => Some(Sticks::default()),
            Some(sticks) => Some(sticks),
            None if !ever || released => None,
            None => self.now.sticks,
        };
        let at_zero = chosen.is_some_and(|sticks| sticks.throttle() <= 0.0);
        self.zero_since_us = at_zero.then(|| self.zero_since_us.unwrap_or(time_us));
        let lost = low || gone;
        self.optional &= lost && !identity.is_ardupilot();
        let is_doubted = lost || self.low_since_us.is_some();
        self.now = Pilot {
            believed: pulses.filter(|_| !is_doubted).or(self.now.believed),
            is_doubted,
            sticks,
            lost,
            missed: lost && !self.optional,
            released,
            throttle_is_zero: self.zero_since_us.is_some_and(|since_us| time_us >= since_us + ZERO_US),
            pulses,
            has_radio: ever,
            is_calibrating: false,
        };
    }

    /// The pilot while the radio is calibrated: its pulses alone.
    fn calibrated(&self, pulses: Option<Pulses>) -> Pilot {
        Pilot {
            pulses,
            believed: self.now.believed,
            has_radio: self.now.has_radio || pulses.is_some(),
            is_doubted: true,
            is_calibrating: true,
            ..Pilot::default()
        }
    }

    /// The pulses that count, if there are any.
    fn pulses(
        &self,
        identity: Identity,
        settings: &RadioSettings,
        timeout_s: f64,
        time_us: u64,
    ) -> Option<Pulses> {
        let life_s = if identity.is_ardupilot() { settings.override_s } else { timeout_s };
        let counts = |taken_us: u64| life_s < 0.0 || time_us.saturating_sub(taken_us) < (life_s * 1e6) as u64;
        // A receiver that fails says nothing of what a ground station sends.
        let mut radio = self.radio.filter(|_| !settings.failure.is_silence());
        if settings.failure == RadioFailure::LowThrottle {
            let lost = radio.get_or_insert([MIDDLE_US; CHANNELS]);
            if let Some(pulse) =
                settings.channel(settings.axes.throttle).and_then(|(index, _)| lost.get_mut(index))
            {
                *pulse = LOST_THROTTLE_US;
            }
        }
        let overridden =
            self.overrides.iter().any(|pulse| pulse.is_some_and(|(_, taken_us)| counts(taken_us)));
        if radio.is_none() && !overridden {
            return None;
        }
        // Sticks that nobody moves are centred; nobody has touched the switches.
        let mut pulses =
            radio.unwrap_or_else(|| core::array::from_fn(|index| if index < STICKS { MIDDLE_US } else { 0 }));
        for (pulse, by) in pulses.iter_mut().zip(&self.overrides) {
            if let Some((by, taken_us)) = by
                && counts(*taken_us)
            {
                *pulse = *by;
            }
        }
        Some(pulses)
    }

    /// Whether the throttle is so low that the receiver has lost its sender.
    fn is_low(
        &mut self,
        watched: bool,
        settings: &RadioSettings,
        pulses: Option<&Pulses>,
        time_us: u64,
    ) -> bool {
        let throttle = settings.channel(settings.axes.throttle).zip(pulses);
        let throttle_us = throttle.and_then(|((index, _), pulses)| pulses.get(index)).copied();
        let low = watched && throttle_us.is_some_and(|pulse| f64::from(pulse) < settings.low_throttle_us);
        self.low_since_us = low.then(|| self.low_since_us.unwrap_or(time_us));
        self.low_since_us.is_some_and(|since_us| time_us >= since_us + LOW_US)
    }

    /// PX4's choice between radio and joystick.
    fn choose(
        &mut self,
        settings: &RadioSettings,
        radio: Option<Sticks>,
        joystick: Option<Sticks>,
    ) -> Option<Sticks> {
        match settings.inputs {
            InputChoice::Radio => radio,
            InputChoice::Joystick => joystick,
            InputChoice::Either => radio.or(joystick),
            InputChoice::Nothing => None,
            InputChoice::First => {
                let found = radio.map(|_| Source::Radio).or(joystick.map(|_| Source::Joystick));
                self.first = self.first.or(found);
                match self.first {
                    Some(Source::Radio) => radio,
                    Some(Source::Joystick) => joystick,
                    None => None,
                }
            }
        }
    }
}

/// The first channels are those of the sticks.
const STICKS: usize = 4;

/// The sticks that pulses mean.
fn decoded(pulses: &Pulses, identity: Identity, settings: &RadioSettings) -> Sticks {
    let of = |number: f64| {
        let (index, channel) = settings.channel(number)?;
        pulses.get(index).filter(|pulse| **pulse > 0).map(|pulse| (channel, *pulse))
    };
    let deflection = |number: f64| of(number).map_or(0.0, |(channel, pulse)| channel.deflection(pulse));
    let axes = settings.axes;
    let up = of(axes.throttle).map_or(0.0, |(channel, pulse)| {
        if identity.is_ardupilot() {
            let (way, middle) = (channel.way(pulse), channel.middle_way());
            if way < middle { way / middle - 1.0 } else { (way - middle) / (1.0 - middle) }
        } else {
            channel.deflection(pulse)
        }
    });
    // A pitch stick that is pulled is a long pulse.
    Sticks { forward: -deflection(axes.pitch), right: deflection(axes.roll), up, turn: deflection(axes.yaw) }
}

#[cfg(test)]
mod tests {
    use super::{CHANNELS, Identity, Pulses, RadioFailure, RadioSettings, Receiver, Sticks};

    fn pulses(first: [u16; 4]) -> Pulses {
        core::array::from_fn(|index| first.get(index).copied().unwrap_or(1500))
    }

    fn overridden(index: usize, pulse: u16) -> [Option<u16>; CHANNELS] {
        core::array::from_fn(|channel| (channel == index).then_some(pulse))
    }

    #[test]
    fn a_radio_goes_on_until_it_fails_and_the_throttle_may_say_so() {
        let mut settings = RadioSettings::new(true);
        let mut receiver = Receiver::default();
        receiver.receive(pulses([1500, 1500, 1700, 1500]));
        let look = |receiver: &mut Receiver, settings: &RadioSettings, time_us| {
            receiver.look(Identity::ArduPilot, settings, (1.0, true), time_us);
            *receiver.pilot()
        };
        let pilot = look(&mut receiver, &settings, 0);
        assert!(pilot.sticks.is_some_and(|sticks| (sticks.up - 0.4).abs() < 1e-9) && !pilot.lost);
        assert!(!look(&mut receiver, &settings, 60_000_000).lost, "it is held");
        settings.failure = RadioFailure::NoPulses;
        assert!(!look(&mut receiver, &settings, 61_000_000).lost);
        assert!(look(&mut receiver, &settings, 61_000_001).lost);
        settings.failure = RadioFailure::None;
        assert!(!look(&mut receiver, &settings, 61_100_000).lost);
        settings.failure = RadioFailure::LowThrottle;
        assert!(!look(&mut receiver, &settings, 61_200_000).lost);
        assert!(look(&mut receiver, &settings, 61_260_000).lost);
    }

    #[test]
    fn overrides_lie_over_the_radio_for_their_time() {
        let settings = RadioSettings::new(true);
        let mut receiver = Receiver::default();
        receiver.receive(pulses([1500, 1500, 1500, 1500]));
        receiver.take_overrides(&overridden(0, 2000), 0);
        let mut right = |time_us: u64| {
            receiver.look(Identity::ArduPilot, &settings, (1.0, true), time_us);
            receiver.pilot().sticks.map(|sticks| sticks.right)
        };
        assert_eq!([right(2_999_999), right(3_000_000)], [Some(1.0), Some(0.0)]);
    }

    #[test]
    fn a_radio_that_is_calibrated_shows_its_pulses_and_steers_nothing() {
        let settings = RadioSettings::new(false);
        let mut receiver = Receiver::default();
        receiver.receive(pulses([1100, 1900, 1100, 1900]));
        for (calibrating, steers) in [(false, true), (true, false), (false, true)] {
            receiver.calibrate(calibrating);
            receiver.look(Identity::Px4, &settings, (0.5, true), 1_000_000);
            let pilot = receiver.pilot();
            assert_eq!((pilot.sticks.is_some(), pilot.is_calibrating), (steers, calibrating));
            assert!(pilot.pulses.is_some_and(|pulses| pulses[0] == 1100) && !pilot.lost);
        }
    }

    #[test]
    fn px4_loses_a_joystick_and_none_that_never_was() {
        let settings = RadioSettings::new(false);
        let mut receiver = Receiver::default();
        receiver.look(Identity::Px4, &settings, (0.5, true), 10_000_000);
        assert_eq!((receiver.pilot().sticks, receiver.pilot().lost), (None, false));
        let sticks = Sticks { forward: 0.5, ..Sticks::default() };
        receiver.take_sticks(sticks, Identity::Px4, &settings, 10_000_000);
        receiver.look(Identity::Px4, &settings, (0.5, true), 10_500_000);
        assert_eq!((receiver.pilot().sticks, receiver.pilot().lost), (Some(sticks), false));
        receiver.look(Identity::Px4, &settings, (0.5, true), 11_000_001);
        assert_eq!((receiver.pilot().sticks, receiver.pilot().lost), (Some(Sticks::default()), true));
    }
}
