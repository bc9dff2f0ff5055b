//! How one loop of the cascade behaves about hover.

use lmpc::DesignError;

use crate::design::stability::small_signal::{Reading, SmallSignal, covariance, modes, transition};

/// One loop of the cascade about hover: its slowest and least damped modes, and what measurement noise does to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopStability {
    /// "roll", "pitch", "yaw", "north", "east" or "altitude".
    pub name: &'static str,
    /// Time after which the loop's samples repeat, s.
    pub period_s: f64,
    /// Largest magnitude of the eigenvalues over that period. The loop is stable below 1.
    pub spectral_radius: f64,
    /// Rate at which the slowest deviation decays as e^(−rate t), 1/s; negative when it grows.
    pub decay_rate_1_s: f64,
    /// Smallest damping ratio of the modes that oscillate; 1 when none does.
    pub damping_ratio: f64,
    /// Angular frequency of the least damped mode, rad/s; 0 when none oscillates.
    pub frequency_rad_s: f64,
    /// Stationary standard deviations under the configured measurement noise; `None` without noise or stability.
    pub spread: Option<Spread>,
}

/// Stationary standard deviations of a loop under the configured measurement noise, to first order.
///
/// Two effects of more noise are not in them: limits that become active, and the thrust that the lagging rotors lose while
/// torque commands change, which moves the height by the square of the noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Of the angle about one axis, rad; 0 for the altitude.
    pub angle_rad: f64,
    /// Of the position along one axis, m; 0 for an attitude loop.
    pub position_m: f64,
    /// Of the commanded acceleration: rad/s² for a loop with an angle, m/s² for the altitude.
    pub command: f64,
}

/// Which states of a loop are its angle, position and command.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Seen {
    pub(crate) angle: Option<usize>,
    pub(crate) position: Option<usize>,
    pub(crate) command: usize,
}

impl LoopStability {
    /// Of a loop whose readings have errors of these standard deviations.
    ///
    /// # Errors
    /// [`DesignError::ElementNotFinite`], [`DesignError::Eigenvalues`].
    pub(crate) fn of<const S: usize>(
        name: &'static str,
        signal: &impl SmallSignal<S>,
        noise: &Reading,
        seen: Seen,
    ) -> Result<Self, DesignError> {
        let period_s = signal.period_s();
        let transition = transition(signal);
        let modes = modes(&transition, period_s)?;
        let is_noisy = *noise != Reading::default() && modes.spectral_radius < 1.0;
        let spread = is_noisy.then(|| covariance(signal, &transition, noise)).flatten().map(|covariance| {
            let deviation = |state: usize| libm::sqrt(covariance[(state, state)].max(0.0));
            Spread {
                angle_rad: seen.angle.map_or(0.0, deviation),
                position_m: seen.position.map_or(0.0, deviation),
                command: deviation(seen.command),
            }
        });
        Ok(Self {
            name,
            period_s,
            spectral_radius: modes.spectral_radius,
            decay_rate_1_s: modes.decay_rate_1_s,
            damping_ratio: modes.damping_ratio,
            frequency_rad_s: modes.frequency_rad_s,
            spread,
        })
    }

    /// Whether deviations decay.
    pub fn is_stable(&self) -> bool {
        self.spectral_radius < 1.0
    }

    /// The one of two that is worse off, under the name of this one.
    pub(crate) fn worse(self, other: Self) -> Self {
        let name = self.name;
        let spreads = [self.spread, other.spread].into_iter().flatten();
        let spread = spreads.reduce(|one, two| Spread {
            angle_rad: one.angle_rad.max(two.angle_rad),
            position_m: one.position_m.max(two.position_m),
            command: one.command.max(two.command),
        });
        let worse = if other.decay_rate_1_s < self.decay_rate_1_s { other } else { self };
        let damped = if other.damping_ratio < self.damping_ratio { other } else { self };
        Self {
            name,
            spread,
            damping_ratio: damped.damping_ratio,
            frequency_rad_s: damped.frequency_rad_s,
            ..worse
        }
    }
}
