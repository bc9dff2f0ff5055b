//! The importer's time and the model's.

use serde::{Deserialize, Serialize};

use crate::error::CallError;

/// Relative tolerance for comparing times: importers accumulate t += h, or multiply i·h.
const TOLERANCE: f64 = 1e-9;
/// Absolute tolerance for comparing times, s: importers count whole nanoseconds, or take their step from a single-precision
/// number. It is half of the resolution of the model's time.
const ROUNDING_S: f64 = 0.5e-6;
/// Longest run, µs: up to here each microsecond is a floating-point number (285 years).
const LONGEST_US: f64 = 9_007_199_254_740_992.0;

/// Time base of an experiment: importer's seconds as floats, microseconds of the run as integers.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Clock {
    start_s: f64,
    stop_s: Option<f64>,
    communication_point_s: f64,
}

/// Where a step ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StepEnd {
    clock: Clock,
    /// Time since the start, µs.
    pub time_us: u64,
}

impl Clock {
    /// A clock that stands at the start.
    pub fn new(start_s: f64, stop_s: Option<f64>) -> Result<Self, CallError> {
        if !start_s.is_finite() {
            return Err(CallError::Time { name: "startTime", value: start_s });
        }
        if let Some(stop_s) = stop_s {
            // An infinite stop time is as good as none.
            if stop_s.is_nan() {
                return Err(CallError::Time { name: "stopTime", value: stop_s });
            }
            if stop_s < start_s {
                return Err(CallError::StopBeforeStart { start_s, stop_s });
            }
        }
        Ok(Self { start_s, stop_s: stop_s.filter(|stop| stop.is_finite()), communication_point_s: start_s })
    }

    /// The current time, s.
    pub fn communication_point_s(&self) -> f64 {
        self.communication_point_s
    }

    /// The present, µs since the start.
    pub fn time_us(&self) -> u64 {
        self.microseconds(self.communication_point_s) as u64
    }

    /// Sets the time of model exchange, s.
    pub fn set(&mut self, time_s: f64) -> Result<(), CallError> {
        let set = Self { communication_point_s: time_s, ..*self };
        if !(time_s.is_finite() && set.is_valid()) {
            return Err(CallError::Time { name: "time", value: time_s });
        }
        *self = set;
        Ok(())
    }

    /// Whether these are times that a clock can have.
    pub fn is_valid(&self) -> bool {
        Self::new(self.start_s, self.stop_s).is_ok()
            && (0.0..=LONGEST_US).contains(&self.microseconds(self.communication_point_s))
    }

    /// Where a step from `point_s` over `step_s`, at most `longest_s`, ends.
    ///
    /// The step starts at the importer's point, not at the end of the last step, so differences within the tolerance do not
    /// add up.
    pub fn step(&self, point_s: f64, step_s: f64, longest_s: f64) -> Result<StepEnd, CallError> {
        if !(step_s.is_finite() && step_s > 0.0) {
            return Err(CallError::StepSize { step_s });
        }
        if step_s > longest_s * (1.0 + TOLERANCE) {
            return Err(CallError::StepTooLong { step_s, longest_s });
        }
        let expected_s = self.communication_point_s;
        let scale_s =
            [self.start_s, expected_s, point_s].into_iter().fold(step_s, |most, t| most.max(t.abs()));
        let tolerance_s = ROUNDING_S + TOLERANCE * scale_s;
        if !(point_s.is_finite() && (point_s - expected_s).abs() <= tolerance_s) {
            return Err(CallError::CommunicationPoint { given_s: point_s, expected_s });
        }
        // A communication point may lie a rounding error before the last one; time never goes back.
        let end_s = (point_s + step_s).max(expected_s);
        if let Some(stop_s) = self.stop_s
            && end_s > stop_s + tolerance_s
        {
            return Err(CallError::PastStop { end_s, stop_s });
        }
        let time_us = self.microseconds(end_s);
        if time_us > LONGEST_US {
            return Err(CallError::Time { name: "the end of the step", value: end_s });
        }
        Ok(StepEnd { clock: Self { communication_point_s: end_s, ..*self }, time_us: time_us as u64 })
    }

    /// Goes on to the end of a step.
    pub fn advance_to(&mut self, end: &StepEnd) {
        *self = end.clock;
    }

    fn microseconds(&self, time_s: f64) -> f64 {
        ((time_s - self.start_s) * 1e6).round()
    }
}

#[cfg(test)]
mod tests {
    use super::Clock;
    use crate::error::CallError;

    const LONGEST_S: f64 = 1e3;

    fn clock(start_s: f64, stop_s: Option<f64>) -> Clock {
        Clock::new(start_s, stop_s).expect("usable times")
    }

    fn stepped(clock: &mut Clock, point_s: f64, step_s: f64) -> u64 {
        let end = clock.step(point_s, step_s, LONGEST_S).expect("a legal step");
        clock.advance_to(&end);
        end.time_us
    }

    #[test]
    fn accumulated_time_is_followed() {
        for (start_s, step_s) in [(0.0, 0.1), (-10.0, 0.1), (1e6, 0.01), (0.0, 1.0 / 3.0)] {
            let mut clock = clock(start_s, None);
            let mut time_s = start_s;
            let mut time_us = 0;
            for _ in 0..1000 {
                time_us = stepped(&mut clock, time_s, step_s);
                time_s += step_s;
            }
            assert_eq!(time_us, (step_s * 1e9).round() as u64, "from {start_s} by {step_s}");
        }
    }

    #[test]
    fn multiplied_time_is_followed() {
        let mut clock = clock(0.0, None);
        for i in 0..100_000_u32 {
            stepped(&mut clock, f64::from(i) * 0.1, 0.1);
        }
        assert_eq!(clock.time_us(), 10_000_000_000);
    }

    /// Communication points in whole nanoseconds, and steps that are not: the differences do not add up in an hour.
    #[test]
    fn roundings_of_the_importer_do_not_add_up() {
        let nanoseconds = |period_ns: u32| move |i: u32| f64::from(i) * f64::from(period_ns) * 1e-9;
        let hundredths = |i: u32| f64::from(i) * 0.01;
        let late = |i: u32| f64::from(i) * 0.01 + if i.is_multiple_of(2) { 0.0 } else { 0.5e-6 };
        type Points<'a> = &'a dyn Fn(u32) -> f64;
        let points: [(Points<'_>, f64, u32); 5] = [
            (&nanoseconds(16_666_667), 1.0 / 60.0, 216_000),
            (&nanoseconds(16_666_666), 1.0 / 60.0, 216_000),
            (&hundredths, f64::from(0.01_f32), 360_000),
            (&hundredths, 0.01 + 1e-9, 360_000),
            (&late, 0.01, 360_000),
        ];
        for (point_s, step_s, steps) in points {
            for start_s in [0.0, -10.0, 1e6] {
                let mut clock = clock(start_s, None);
                for i in 0..steps {
                    stepped(&mut clock, start_s + point_s(i), step_s);
                }
                let end_s = start_s + point_s(steps - 1) + step_s;
                assert_eq!(clock.communication_point_s(), end_s);
                assert!((clock.time_us() as f64 * 1e-6 - (end_s - start_s)).abs() < 0.6e-6);
            }
        }
    }

    /// Half a microsecond is accepted, a whole one is not.
    #[test]
    fn tolerance_is_half_a_microsecond() {
        let mut clock = clock(0.0, None);
        stepped(&mut clock, 0.0, 0.5);
        for off_s in [0.5e-6, -0.5e-6] {
            assert!(clock.step(0.5 + off_s, 0.1, LONGEST_S).is_ok(), "{off_s}");
            assert!(clock.step(0.5 + 2.0 * off_s, 0.1, LONGEST_S).is_err(), "{off_s}");
        }
    }

    #[test]
    fn steps_below_a_microsecond_add_up() {
        let mut clock = clock(0.0, None);
        for i in 0..1000_u32 {
            stepped(&mut clock, f64::from(i) * 1e-7, 1e-7);
        }
        assert_eq!(clock.time_us(), 100);
    }

    /// At times so large that the tolerance is longer than a step.
    #[test]
    fn time_never_goes_back() {
        let mut clock = clock(1e6, None);
        assert_eq!(stepped(&mut clock, 1e6, 5e-4), 500);
        for _ in 0..2 {
            assert_eq!(stepped(&mut clock, 1e6, 1e-4), 500);
            assert_eq!(clock.time_us(), 500);
        }
        assert!(clock.is_valid());
    }

    #[test]
    fn stop_time_has_the_same_tolerance() {
        let clock = clock(0.0, Some(1.0));
        assert!(clock.step(0.0, 1.0 + 1e-12, LONGEST_S).is_ok());
        // Sixty steps of 1/60 s in whole nanoseconds.
        assert!(clock.step(0.0, 60.0 * 16_666_667e-9, LONGEST_S).is_ok());
        assert!(matches!(clock.step(0.0, 1.001, LONGEST_S), Err(CallError::PastStop { .. })));
        assert!(Clock::new(0.0, Some(f64::INFINITY)).expect("no stop").step(0.0, 1e3, LONGEST_S).is_ok());
    }

    /// A call takes as long as the step that it asks for, and cannot be interrupted.
    #[test]
    fn long_steps_are_refused_with_the_longest_one() {
        let mut clock = clock(0.0, None);
        for step_s in [LONGEST_S * 1.001, 1e9, f64::MAX] {
            let refusal = clock.step(0.0, step_s, LONGEST_S);
            assert_eq!(refusal, Err(CallError::StepTooLong { step_s, longest_s: LONGEST_S }));
        }
        // An importer's t + h may have rounding errors.
        assert_eq!(stepped(&mut clock, 0.0, LONGEST_S * (1.0 + 1e-12)), 1_000_000_000);
    }

    #[test]
    fn nonsense_is_refused() {
        let clock = clock(0.0, None);
        for step_s in [0.0, -0.1, f64::NAN, f64::INFINITY] {
            assert!(
                matches!(clock.step(0.0, step_s, LONGEST_S), Err(CallError::StepSize { .. })),
                "{step_s}"
            );
        }
        for point_s in [0.1, -0.1, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(
                matches!(clock.step(point_s, 0.1, LONGEST_S), Err(CallError::CommunicationPoint { .. })),
                "{point_s}"
            );
        }
        assert!(matches!(clock.step(0.0, 1e300, f64::MAX), Err(CallError::Time { .. })));
        assert!(Clock::new(f64::NAN, None).is_err());
        assert!(Clock::new(f64::INFINITY, None).is_err());
        assert!(Clock::new(1.0, Some(0.5)).is_err());
        assert!(Clock::new(1.0, Some(f64::NAN)).is_err());
    }
}
