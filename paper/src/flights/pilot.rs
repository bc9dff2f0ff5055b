//! Who flies: the paper's controllers and the cascade's defaults.

use quadrotor::{Configuration, ControllerKind, ControllerSettings, PredictionModel};

use super::mission::Mission;

/// N_p of the paper's designs, which it does not give. With α = 1.2 the horizon has died out long before.
const PAPER_HORIZON: u32 = 100;
/// α of the paper.
const PAPER_ALPHA: f64 = 1.2;

/// A choice of controllers for the whole cascade.
#[derive(Clone, Debug, PartialEq)]
pub struct Pilot {
    /// Its name.
    pub name: String,
    /// Kind of controller.
    pub kind: ControllerKind,
    /// The paper's models with this N and a for all three controllers, and this α; none for the cascade's defaults.
    pub laguerre: Option<[f64; 3]>,
    /// N_c of state-space MPC.
    pub moves: u32,
}

impl Pilot {
    /// LMPC as in the paper, on its models: the same N and a for all three controllers.
    pub fn paper(terms: u32, scale: f64) -> Self {
        Self {
            name: format!("LMPC, N = {terms}, a = {scale:.4}, α = 1.2"),
            kind: ControllerKind::Lmpc,
            laguerre: Some([f64::from(terms), scale, PAPER_ALPHA]),
            moves: 25,
        }
    }

    /// The same with the Riccati solution as terminal weight instead of α.
    pub fn terminal(terms: u32, scale: f64) -> Self {
        Self {
            name: format!("LMPC, N = {terms}, a = {scale:.4}, terminal weight"),
            laguerre: Some([f64::from(terms), scale, 1.0]),
            ..Self::paper(terms, scale)
        }
    }

    /// The cascade's defaults: the loops inside in its models, and N and a of its own for each controller.
    pub fn default_lmpc() -> Self {
        let kind = ControllerKind::Lmpc;
        Self { name: "LMPC, defaults".to_owned(), kind, laguerre: None, moves: 25 }
    }

    /// State-space MPC with so many moves.
    pub fn state_space(moves: u32) -> Self {
        let kind = ControllerKind::StateSpaceMpc;
        Self { name: format!("SS-MPC, N_c = {moves}"), kind, laguerre: None, moves }
    }

    /// The regulator.
    pub fn regulator() -> Self {
        Self { name: "DLQR".to_owned(), kind: ControllerKind::Dlqr, laguerre: None, moves: 25 }
    }

    /// The cascade's configuration on a mission.
    pub fn configuration(&self, mission: Mission) -> Configuration {
        let mut configuration = Configuration::default();
        configuration.reference.shaping = false;
        let controllers = &mut configuration.controllers;
        controllers.kind = self.kind;
        controllers.governor = mission.governor();
        if self.laguerre.is_some() {
            // α belongs to these models: the shipped ones are planned over an infinite horizon.
            controllers.model = PredictionModel::Paper;
            output_weights_only(&mut controllers.altitude);
            output_weights_only(&mut controllers.position);
        }
        self.adjust(&mut controllers.altitude);
        self.adjust(&mut controllers.position);
        self.adjust(&mut controllers.attitude);
        configuration
    }

    fn adjust<const P: usize>(&self, settings: &mut ControllerSettings<P>) {
        settings.control_horizon = self.moves;
        if let Some([terms, scale, alpha]) = self.laguerre {
            settings.terms = terms as u32;
            settings.scale = scale;
            settings.alpha = alpha;
            settings.prediction_horizon = PAPER_HORIZON;
        }
    }
}

/// The paper's Q = CᵀC. The attitude keeps its other weights: its model does not know of the rotors' lag, and needs the damping.
fn output_weights_only<const P: usize>(settings: &mut ControllerSettings<P>) {
    settings.damping_weight.fill(0.0);
    settings.rate_weight.fill(0.0);
}
