//! The best flights of raw steps, found offline by a nonlinear solver: xtask/python/optimum.py.

use quadrotor::{Configuration, Plant, PlantInputs, PlantState, wrench_of_rotors};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::plan::Plan;
use super::track::{Moment, STEP_US, Track};
use crate::error::Error;

/// Longest integration step of the plant, s.
const STEP_S: f64 = 1e-3;

/// Commands of a flight that is optimal under the limits on tilt, speed and thrust and those of the rotors.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Optimum {
    /// Name of the flight among the plans.
    pub flight: String,
    /// "squared distance" or "settling time".
    pub objective: String,
    /// How long the solver took, s.
    pub computed_in_s: f64,
    /// How long each command is held, s.
    step_s: Vec<f64>,
    /// Speeds of the rotors in the order of the airframe's layout, rad/s.
    command_rad_s: Vec<[f64; 4]>,
}

/// An optimal flight, replayed on the plant.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct OptimumResult {
    /// The flight, as in `bars`.
    pub flight: String,
    /// What is least: "squared distance" or "settling time".
    pub objective: String,
    /// Time after which the vehicle stays within 2 cm of the goal, s; null when the replay does not.
    pub settled_s: Option<f64>,
    /// Integral of the squared distance from the goal, m²·s.
    pub squared_distance_m2_s: f64,
    /// Largest share by which a limit of tilt, speed or thrust is exceeded, %.
    pub beyond_limit_percent: f64,
    /// How long the solver took, s.
    pub computed_in_s: f64,
}

impl Optimum {
    /// Reads what the solver has written.
    ///
    /// # Errors
    /// [`Error::Optimum`] when it is not that.
    pub fn parse(text: &str) -> Result<Vec<Self>, Error> {
        let optima: Vec<Self> =
            serde_json::from_str(text).map_err(|error| Error::Optimum(error.to_string()))?;
        let whole = |optimum: &Self| {
            optimum.step_s.len() == optimum.command_rad_s.len()
                && optimum.step_s.iter().all(|step_s| step_s.is_finite() && *step_s > 0.0)
        };
        match optima.iter().find(|optimum| !whole(optimum)) {
            Some(broken) => {
                Err(Error::Optimum(format!("{}: each command needs a positive time", broken.flight)))
            }
            None => Ok(optima),
        }
    }

    /// Flies its commands on the plant, without any controller, and measures the flight.
    pub fn measured(&self, plan: &Plan) -> (OptimumResult, Track) {
        let track = self.replayed(&plan.configuration, plan);
        let result = OptimumResult {
            flight: self.flight.clone(),
            objective: self.objective.clone(),
            settled_s: Some(track.settled_s()).filter(|time_s| time_s.is_finite()),
            squared_distance_m2_s: track.squared_distance_m2_s(),
            beyond_limit_percent: 100.0
                * track.limit_excess(&plan.configuration.limits, &plan.configuration.airframe).max(0.0),
            computed_in_s: self.computed_in_s,
        };
        (result, track)
    }

    fn replayed(&self, configuration: &Configuration, plan: &Plan) -> Track {
        let plant = Plant::new(&configuration.airframe, &configuration.environment);
        let mut state = PlantState::hovering(&configuration.initial, &configuration.airframe);
        let moment_s = STEP_US as f64 * 1e-6;
        let mut track = Track::default();
        let (mut time_s, mut until_s) = (0.0, 0.0);
        let mut see = |time_s: f64, state: &PlantState| {
            track.moments.push(Moment::of(
                time_s,
                state,
                &wrench_of_rotors(plant.airframe(), &state.rotor_speed_rad_s),
                plan.reference(time_s).position_m,
            ));
        };
        see(time_s, &state);
        let mut seen = 1.0;
        for (held_s, command_rad_s) in self.step_s.iter().zip(&self.command_rad_s) {
            until_s += held_s;
            let inputs = PlantInputs::rotor_speeds(*command_rad_s);
            while time_s < until_s {
                let next_s = (time_s + STEP_S).min(until_s).min(seen * moment_s);
                state = plant.step(&state, &inputs, next_s - time_s);
                time_s = next_s;
                if time_s >= seen * moment_s {
                    see(time_s, &state);
                    seen += 1.0;
                }
            }
        }
        track
    }
}

#[cfg(test)]
mod tests {
    use quadrotor::{Airframe, Configuration};

    use super::Optimum;
    use crate::bars::plans;

    /// Hover speeds for 1.6 s: the vehicle stays 5 m away, 25 m² · 1.6 s. Half a second at 10 % more thrust lifts it by
    /// g/10 · t²/2, less what the rotors' lag takes.
    #[test]
    fn commands_are_flown_on_the_plant() {
        let plans = plans(&Configuration::default());
        let plan = plans.iter().find(|plan| plan.name == "5 m north").unwrap();
        let hover = Airframe::default().hover_rotor_speed_rad_s();
        let text = |speed: f64| {
            format!(
                r#"[{{"flight": "5 m north", "objective": "settling time", "computed_in_s": 1,
                "step_s": [0.505, 1.095], "command_rad_s": [[{speed}, {speed}, {speed}, {speed}], [{hover}, {hover}, {hover}, {hover}]]}}]"#
            )
        };
        let measured = |speed: f64| Optimum::parse(&text(speed)).unwrap()[0].measured(plan);
        let (still, track) = measured(hover);
        assert_eq!(track.moments.len(), 161);
        assert!((still.squared_distance_m2_s - 40.0).abs() < 1e-9, "{still:?}");
        assert_eq!(still.settled_s, None);
        let (_, lifted) = measured(hover * 1.1_f64.sqrt());
        let up_m_s = -lifted.moments[160].velocity_m_s.z;
        // The lag delays the beginning and the end alike.
        assert!((up_m_s - 0.980_665 * 0.505).abs() < 5e-3, "{up_m_s}");
    }

    #[test]
    fn what_is_no_list_of_commands_is_refused() {
        for (text, part) in [
            ("{}", "expected a sequence"),
            (
                r#"[{"flight": "x", "objective": "y", "computed_in_s": 1, "step_s": [0.1], "command_rad_s": []}]"#,
                "x: each command needs a positive time",
            ),
        ] {
            let message = Optimum::parse(text).unwrap_err().to_string();
            assert!(message.contains(part), "{message}");
        }
    }
}
