//! What to change when a controller cannot be designed or flown: parameters by their names.

use alloc::format;
use alloc::string::String;

use lmpc::DesignError;

/// What helps when a part cannot be designed, after the reason; nothing where the reason says all that is known.
pub(super) fn of_design(part: &str, reason: &DesignError) -> String {
    let Some(group) = group_of(part) else { return String::new() };
    match reason {
        DesignError::HorizonTooShort { .. } => {
            format!("; raise {group}.prediction_horizon, or lower {group}.terms")
        }
        DesignError::MovesBeyondHorizon { .. } => {
            format!("; raise {group}.prediction_horizon, or lower {group}.control_horizon")
        }
        DesignError::LaguerreDecay { .. } => format!("; lower {group}.scale, or raise {group}.lambda"),
        // It says what to do in the words of the control library.
        DesignError::IllConditioned { .. } => {
            format!(" ({group}.terms, .control_horizon, .scale, .lambda, .alpha)")
        }
        _ if group == "controller.position" => {
            format!("; change the weights of {group}, or of controller.attitude, whose loop is inside it")
        }
        _ => format!("; change the weights of {group}"),
    }
}

/// What helps against an unstable loop when no parameter alone is to blame.
pub(super) fn of_instability(name: &str) -> String {
    let (group, output, increment) = match name {
        "altitude" => ("altitude", "", ""),
        "north" => ("position", ".x", ".theta"),
        "east" => ("position", ".y", ".phi"),
        "roll" => ("attitude", ".phi", ".phi"),
        "pitch" => ("attitude", ".theta", ".theta"),
        _ => ("attitude", ".psi", ".psi"),
    };
    format!(
        "lower controller.{group}.output_weight{output}, raise controller.{group}.increment_weight{increment}, or lower \
         airframe.rotor.time_constant"
    )
}

/// The parameters of a part.
fn group_of(part: &str) -> Option<&'static str> {
    match part {
        "altitude controller" => Some("controller.altitude"),
        "position controller" => Some("controller.position"),
        "attitude controller" => Some("controller.attitude"),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use super::of_instability;
    use crate::PARAMETERS;

    #[test]
    fn whatever_loop_is_unstable_the_remedy_names_parameters() {
        for name in ["roll", "pitch", "yaw", "north", "east", "altitude"] {
            let remedy = of_instability(name);
            let named = remedy.split([' ', ',']).filter(|word| word.contains('.'));
            let known = named.map(|word| PARAMETERS.iter().any(|parameter| parameter.name == word));
            assert_eq!(known.collect::<Vec<_>>(), [true; 3], "{remedy}");
        }
    }
}
