//! Ticks that last longer: nothing happens to a vehicle that hovers by itself or stands disarmed, so it is looked at less often.

use super::super::steering::Steering;
use super::super::weathervane::IntoWind;
use super::Vehicle;
use crate::mode::Mode;

/// Long ticks end at multiples of this, µs: two samples of the attitude controller. Fifty looks a second are plenty for machines that have
/// nothing to do, none of whose times is shorter than some tenths of a second.
const GRID_US: u64 = 20_000;
/// Slower than this, m/s and rad/s, a vehicle whose reference rests rests, too.
const SLOW_M_S: f64 = 0.5;
const SLOW_RAD_S: f64 = 0.5;

/// A long tick that has begun.
#[derive(Clone, Copy, Debug)]
pub(super) struct LongTick {
    pub begun_us: u64,
    pub end_us: u64,
    armed: bool,
    mode: Mode,
    steering: Steering,
}

impl Vehicle {
    /// Until when the vehicle rests by itself, µs, as things are: it can fly there at once ([`Self::fly`]). `None`: it does not rest.
    pub fn rests_until_us(&self) -> Option<u64> {
        match &self.tick {
            Some(tick) => self.goes_on(tick).then_some(tick.end_us),
            None => self.next_end_us(),
        }
    }

    /// The end of the long tick that begins now, µs, if the vehicle rests by itself.
    fn next_end_us(&self) -> Option<u64> {
        let now_us = self.time_us();
        (self.is_left_alone() && self.rests()).then_some(now_us - now_us % GRID_US + GRID_US)
    }

    /// The long tick that begins now, when all machines have been shown how things are, if the vehicle rests by itself.
    pub(super) fn long_tick(&self) -> Option<LongTick> {
        self.next_end_us().map(|end_us| LongTick {
            begun_us: self.time_us(),
            end_us,
            armed: self.is_armed(),
            mode: self.mode(),
            steering: *self.decided.steering(),
        })
    }

    /// Whether nobody has asked for another flight since a long tick has begun. What else was asked for waits for its end.
    pub(super) fn goes_on(&self, tick: &LongTick) -> bool {
        self.is_left_alone()
            && (tick.armed, tick.mode) == (self.is_armed(), self.mode())
            && tick.steering == *self.decided.steering()
    }

    /// Whether only a request can end its rest: what is asked for stays as it is, and nothing acts on the vehicle that changes with time.
    fn is_left_alone(&self) -> bool {
        let (machines, conduct) = (&self.machines, self.conduct());
        let holds = match self.mode() {
            _ if !self.is_armed() => true,
            Mode::Hold => true,
            Mode::Offboard => {
                conduct.weathervane.way == IntoWind::Off
                    && !machines.offboard.is_recent(self.time_us(), conduct.set_point_timeout_s)
            }
            _ => false,
        };
        let pilot = machines.receiver.pilot();
        let is_pushed = [&conduct.simulated.pushes.shove, &conduct.simulated.pushes.twist]
            .iter()
            .any(|push| push.time_ms > 0);
        holds
            && self.closed_loop.is_undisturbed()
            && self.perception.navigation().is_none()
            && (pilot.sticks.is_none() && pilot.pulses.is_none())
            && machines.injection.is_over()
            && machines.rotors.lost_rotor().is_none()
            && !is_pushed
            && !machines.motor_tests.is_running()
            && !machines.autostart.is_pending()
            && !machines.boot_fault.is_present()
            && !machines.turn.is_on()
            && !conduct.precision.enabled
            && !conduct.equipment.parachute.enabled
            && !machines.equipment.parachute().is_released()
            && machines
                .equipment
                .rests(self.decided.region().is_some(), conduct.equipment.gripper_closes_after_s)
    }

    /// Whether it stands disarmed, or hovers and is to stay where it is.
    fn rests(&self) -> bool {
        let outputs = self.outputs();
        let is_landed = self.machines.landing.is_landed();
        let is_to_stay = match self.decided.steering() {
            Steering::Idle { .. } => self.stands(),
            Steering::Goal(goal) => !is_landed && outputs.setpoint.position_m == goal.position_m,
            Steering::Motion(motion) => !is_landed && motion.rests(&self.closed_loop.limits().largest()),
            Steering::Path(_) | Steering::Attitude { .. } | Steering::Descent { .. } => false,
        };
        is_to_stay
            && outputs.setpoint.velocity_m_s.norm() == 0.0
            && outputs.setpoint.acceleration_m_s2.norm() == 0.0
            && outputs.setpoint.yaw_rate_rad_s == 0.0
            && outputs.velocity_m_s.norm() < SLOW_M_S
            && outputs.body_rate_rad_s.norm() < SLOW_RAD_S
    }
}
