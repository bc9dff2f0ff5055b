//! One line of a parameter file.

/// Component id of the autopilot, whose parameters are ours.
pub(super) const AUTOPILOT: u8 = 1;

/// What a line says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Line<'a> {
    /// Nothing: it is empty, a comment, or about another component.
    Nothing,
    /// A parameter has a value.
    Setting {
        /// Any of its names.
        name: &'a str,
        /// The value, as it is written.
        value: &'a str,
    },
    /// None of the known forms.
    Malformed,
}

/// Reads `NAME VALUE`, `NAME,VALUE`, `NAME = VALUE` or QGroundControl's five columns. `#` begins a comment.
pub(super) fn read(line: &str) -> Line<'_> {
    let used = line.split('#').next().unwrap_or_default().trim();
    if used.is_empty() {
        return Line::Nothing;
    }
    // The name of a value may have spaces.
    if let Some((name, value)) = used.split_once('=') {
        let (name, value) = (name.trim(), value.trim());
        let sound = !value.is_empty() && !name.is_empty() && !name.contains(char::is_whitespace);
        return if sound { Line::Setting { name, value } } else { Line::Malformed };
    }
    let words: Vec<&str> =
        used.split([' ', '\t', ',']).map(str::trim).filter(|word| !word.is_empty()).collect();
    match words[..] {
        [name, value] => Line::Setting { name, value },
        [system, component, name, value, kind] => {
            match (system.parse::<u8>(), component.parse::<u8>(), kind.parse::<u8>()) {
                (Ok(_), Ok(AUTOPILOT), Ok(_)) => Line::Setting { name, value },
                (Ok(_), Ok(_), Ok(_)) => Line::Nothing,
                _ => Line::Malformed,
            }
        }
        _ => Line::Malformed,
    }
}

#[cfg(test)]
mod tests {
    use super::{Line, read};

    #[test]
    fn the_lines_of_every_tool_are_read() {
        let setting = |name, value| Line::Setting { name, value };
        for (line, expected) in [
            ("FRAME_MASS 0.8", setting("FRAME_MASS", "0.8")),
            ("FRAME_MASS       0.800000", setting("FRAME_MASS", "0.800000")),
            ("FRAME_MASS,0.8", setting("FRAME_MASS", "0.8")),
            ("FRAME_MASS,0.8 # kg", setting("FRAME_MASS", "0.8")),
            ("1\t1\tFRAME_MASS\t0.800000011920928955\t9", setting("FRAME_MASS", "0.800000011920928955")),
            ("7\t1\tNAV_DLL_ACT\t2\t6\r", setting("NAV_DLL_ACT", "2")),
            ("airframe.mass = 0.8", setting("airframe.mass", "0.8")),
            ("COM_OBL_RC_ACT = Position mode", setting("COM_OBL_RC_ACT", "Position mode")),
            ("controller.kind dlqr", setting("controller.kind", "dlqr")),
            ("1\t100\tCAM_MODE\t1\t6", Line::Nothing),
            ("# Vehicle-Id Component-Id Name Value Type", Line::Nothing),
            ("  ", Line::Nothing),
            ("FRAME_MASS", Line::Malformed),
            ("FRAME_MASS =", Line::Malformed),
            ("FRAME_MASS 1 2", Line::Malformed),
            ("a b c d e", Line::Malformed),
        ] {
            assert_eq!(read(line), expected, "{line}");
        }
    }
}
