//! Names of at most 16 characters for the dotted names of the closed loop.

/// Longest identifier.
pub const LONGEST: usize = 16;

/// Words of the dotted names, and what is left of them.
const WORDS: &[(&str, &str)] = &[
    ("airframe", "AF"),
    ("acceleration", "ACC"),
    ("altitude", "ALT"),
    ("angular_rate", "RATE"),
    ("arm_length", "ARM"),
    ("attitude", "ATT"),
    ("body_rate", "RATE"),
    ("controller", "C"),
    ("controllers", "C"),
    ("estimator", "EST"),
    ("horizontal", "H"),
    ("increment_weight", "R"),
    ("inertia", "J"),
    ("lambda", "LAM"),
    ("limits", "LIM"),
    ("mass_factor", "MASSF"),
    ("output_weight", "Q"),
    ("position", "POS"),
    ("prediction_horizon", "NP"),
    ("rate_weight", "QD"),
    ("rotor", "ROT"),
    ("sample_time", "DT"),
    ("scale", "A"),
    ("sensors", "SEN"),
    ("speed_max", "MAX"),
    ("speed_min", "MIN"),
    ("terms", "N"),
    ("theta", "THE"),
    ("thrust_coefficient", "K1"),
    ("tilt_acceleration", "TILT_A"),
    ("tilt_rate", "TILT_R"),
    ("time_constant", "TAU"),
    ("torque_coefficient", "K2"),
    ("velocity", "VEL"),
    ("vertical", "V"),
    ("yaw_acceleration", "YAW_A"),
    ("yaw_jerk", "YAW_J"),
    ("yaw_rate", "YAW_R"),
];

/// The identifier of a dotted name: known words are abbreviated, others lose their vowels if it must be.
pub fn identifier(name: &str) -> String {
    let word = |word: &str| {
        let known = WORDS.iter().find(|(long, _)| *long == word).map(|(_, short)| (*short).to_owned());
        known.unwrap_or_else(|| word.to_ascii_uppercase())
    };
    let whole = name.split('.').map(word).collect::<Vec<_>>().join("_");
    if whole.len() <= LONGEST {
        return whole;
    }
    let mut previous = '_';
    let squeezed = whole.chars().filter(|letter| {
        let inside = previous != '_';
        previous = *letter;
        !(inside && matches!(letter, 'A' | 'E' | 'I' | 'O' | 'U'))
    });
    squeezed.take(LONGEST).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use quadrotor::PARAMETERS;

    use super::{LONGEST, identifier};

    #[test]
    fn identifiers_are_short_unique_and_plain() {
        let identifiers: BTreeSet<String> =
            PARAMETERS.iter().map(|parameter| identifier(parameter.name)).collect();
        assert_eq!(identifiers.len(), PARAMETERS.len(), "{identifiers:?}");
        for name in &identifiers {
            assert!(name.len() <= LONGEST && !name.is_empty(), "{name}");
            assert!(
                name.bytes().all(|byte| byte == b'_' || byte.is_ascii_uppercase() || byte.is_ascii_digit())
            );
        }
        assert_eq!(identifier("controller.attitude.increment_weight.theta"), "C_ATT_R_THE");
        assert_eq!(identifier("limits.speed.horizontal"), "LIM_SPEED_H");
    }
}
