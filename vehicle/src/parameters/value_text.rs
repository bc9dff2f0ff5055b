//! Values of parameters as people write them.

use super::{ParameterTable, SetError};

impl ParameterTable {
    /// The number that a text means for a parameter: a number, or the name of one of its values (`dlqr`, `hold`, `on`). A switch
    /// takes `true` and `false`, too. Whether the parameter can have that number is for [`set`](Self::set) to say.
    ///
    /// # Errors
    /// [`SetError::Unknown`] for the parameter, [`SetError::NotAllowed`] for the text.
    pub fn number(&self, name: &str, text: &str) -> Result<f64, SetError> {
        let entry = self.require(name)?;
        let text = text.trim().trim_matches('"');
        if let Ok(number) = text.parse() {
            return Ok(number);
        }
        let names = entry.describe().names;
        if let Some(named) = names.iter().find(|named| named.is_named(text)) {
            return Ok(f64::from(named.value));
        }
        let switch = names.iter().map(|named| named.value).eq([0, 1]);
        match text.to_ascii_lowercase().as_str() {
            "false" if switch => Ok(0.0),
            "true" if switch => Ok(1.0),
            _ => Err(SetError::NotAllowed {
                name: name.to_owned(),
                value: text.to_owned(),
                allowed: entry.allowed(),
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::identity::Identity;
    use crate::parameters::ParameterTable;

    #[test]
    fn values_can_be_named() {
        let table = ParameterTable::new(Identity::Px4);
        for (name, text, expected) in [
            ("controller.kind", "dlqr", 3.0),
            ("CTRL_KIND", "DLQR", 3.0),
            ("C_KIND", "\"ssmpc\"", 2.0),
            ("controller.kind", "1", 1.0),
            ("controller.governor", "false", 0.0),
            ("SENS_KALMAN", "on", 1.0),
            ("COM_OBL_RC_ACT", "position-mode", 0.0),
            ("COM_OBL_RC_ACT", " Position mode ", 0.0),
            ("airframe.mass", "1e0", 1.0),
        ] {
            assert_eq!(table.number(name, text), Ok(expected), "{name} = {text}");
        }
        for (name, text, expected) in [
            ("controller.kind", "pid", "controller.kind = pid; allowed 1 (lmpc), 2 (ssmpc), 3 (dlqr)"),
            ("FRAME_MASS", "heavy", "FRAME_MASS = heavy; allowed 0.005–50 kg"),
            (
                "NAV_DLL_ACT",
                "true",
                "NAV_DLL_ACT = true; allowed 0 (Nothing), 1 (Hold), 2 (Return), 3 (Land), 5 (Terminate), 6 (Disarm)",
            ),
            ("controller.knid", "dlqr", "unknown parameter controller.knid; did you mean controller.kind?"),
        ] {
            assert_eq!(table.number(name, text).expect_err(text).to_string(), expected);
        }
    }
}
