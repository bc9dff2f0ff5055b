//! Who flies.

use quadrotor::{Configuration, ControllerKind};

use crate::flights::Pilot;

/// A choice of controllers for the whole vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flyer {
    /// The cascade with Laguerre MPC.
    LaguerreMpc,
    /// The cascade with state-space MPC.
    StateSpaceMpc,
    /// The cascade with the regulator, whose commands are clipped.
    Regulator,
    /// The same behind the governor, which moves distant set-points closer.
    GovernedRegulator,
    /// Lee's geometric controller with feed-forward from differential flatness, which knows no limits but the rotors'.
    Geometric,
}

impl Flyer {
    /// All of them.
    pub const ALL: [Self; 5] =
        [Self::LaguerreMpc, Self::StateSpaceMpc, Self::Regulator, Self::GovernedRegulator, Self::Geometric];

    /// Name in results.json.
    pub fn name(self) -> &'static str {
        match self {
            Self::LaguerreMpc => "LMPC",
            Self::StateSpaceMpc => "SS-MPC",
            Self::Regulator => "DLQR",
            Self::GovernedRegulator => "DLQR, governed",
            Self::Geometric => "geometric",
        }
    }

    /// Name among the random flights, where it took part.
    pub fn pilot(self) -> String {
        match self {
            Self::LaguerreMpc => Pilot::default_lmpc().name,
            Self::StateSpaceMpc => Pilot::state_space(25).name,
            Self::Regulator => Pilot::regulator().name,
            Self::GovernedRegulator | Self::Geometric => self.name().to_owned(),
        }
    }

    /// Name on the command line.
    pub fn key(self) -> &'static str {
        match self {
            Self::LaguerreMpc => "lmpc",
            Self::StateSpaceMpc => "ssmpc",
            Self::Regulator => "dlqr",
            Self::GovernedRegulator => "governed",
            Self::Geometric => "geometric",
        }
    }

    /// Whether its commands are clipped without a prediction.
    pub fn is_regulator(self) -> bool {
        matches!(self, Self::Regulator | Self::GovernedRegulator)
    }

    /// A configuration with its controllers.
    pub fn applied(self, configuration: &Configuration) -> Configuration {
        let mut configuration = *configuration;
        configuration.controllers.kind = match self {
            Self::LaguerreMpc | Self::Geometric => ControllerKind::Lmpc,
            Self::StateSpaceMpc => ControllerKind::StateSpaceMpc,
            Self::Regulator | Self::GovernedRegulator => ControllerKind::Dlqr,
        };
        configuration.controllers.governor = self == Self::GovernedRegulator;
        configuration
    }
}
