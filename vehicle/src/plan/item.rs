//! One item of a plan.

use serde::{Deserialize, Serialize};

use super::{command, frame};

/// An item: a command with its parameters. What was not given is NaN.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct MissionItem {
    /// MAV_FRAME of x, y, z; any number.
    pub frame: u8,
    /// MAV_CMD; any number.
    pub command: u16,
    /// Parameters 1 to 4.
    #[serde(with = "not_given")]
    pub parameters: [f64; 4],
    /// Parameters 5 to 7: latitude and longitude, degrees, and an altitude, m; x, y, z of a local frame, m; or plain numbers.
    #[serde(with = "not_given")]
    pub position: [f64; 3],
    /// Whether the next item follows by itself.
    pub autocontinue: bool,
}

/// Bit for bit: NaN is the same as NaN.
impl PartialEq for MissionItem {
    fn eq(&self, other: &Self) -> bool {
        self.bytes() == other.bytes()
    }
}

impl MissionItem {
    /// The number of the item that a jump leads to, if it is one.
    pub fn jump_target_mut(&mut self) -> Option<&mut f64> {
        let [target, ..] = &mut self.parameters;
        (self.command == command::DO_JUMP).then_some(target)
    }

    /// Home as an item: latitude and longitude, degrees, and altitude above sea level, m.
    pub fn home(position: [f64; 3]) -> Self {
        Self {
            frame: frame::GLOBAL,
            command: command::NAV_WAYPOINT,
            parameters: [0.0; 4],
            position,
            autocontinue: true,
        }
    }

    /// Parameter `n` of 1 to 7.
    pub fn parameter(&self, n: usize) -> f64 {
        let all = self.parameters.iter().chain(&self.position);
        n.checked_sub(1).and_then(|index| all.copied().nth(index)).unwrap_or(f64::NAN)
    }

    /// Parameter `n`, or what stands for it if it was not given.
    pub fn parameter_or(&self, n: usize, default: f64) -> f64 {
        let value = self.parameter(n);
        if value.is_nan() { default } else { value }
    }

    /// Everything in it, as one sequence of bytes.
    pub fn bytes(&self) -> Vec<u8> {
        let mut bytes = vec![self.frame, u8::from(self.autocontinue)];
        bytes.extend(self.command.to_le_bytes());
        for value in self.parameters.iter().chain(&self.position) {
            // NaN has many faces.
            let value = if value.is_nan() { f64::NAN } else { *value };
            bytes.extend(value.to_bits().to_le_bytes());
        }
        bytes
    }
}

/// NaN as `null`, which is all that JSON has for it.
mod not_given {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub fn serialize<S: Serializer, const N: usize>(
        values: &[f64; N],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        values.map(|value| Some(value).filter(|value| !value.is_nan())).to_vec().serialize(serializer)
    }

    pub fn deserialize<'de, D: Deserializer<'de>, const N: usize>(
        deserializer: D,
    ) -> Result<[f64; N], D::Error> {
        let values: Vec<Option<f64>> = Vec::deserialize(deserializer)?;
        let count = values.len();
        <[Option<f64>; N]>::try_from(values)
            .map(|values| values.map(|value| value.unwrap_or(f64::NAN)))
            .map_err(|_| serde::de::Error::invalid_length(count, &format!("{N} numbers").as_str()))
    }
}

#[cfg(test)]
mod tests {
    use super::MissionItem;
    use crate::plan::command;

    #[test]
    fn what_was_not_given_survives_a_file() {
        let item = MissionItem {
            frame: 6,
            command: command::NAV_WAYPOINT,
            parameters: [0.1, f64::NAN, 3.0, f64::NAN],
            position: [47.397_742_1, f64::NAN, 10.0],
            autocontinue: true,
        };
        let text = serde_json::to_string(&item).unwrap();
        assert_eq!(serde_json::from_str::<MissionItem>(&text).unwrap(), item, "{text}");
        assert!(serde_json::from_str::<MissionItem>(&text.replace("[0.1,", "[")).is_err());
    }
}
