//! The values of kept parameters.

use std::collections::{BTreeMap, HashMap};
use std::sync::LazyLock;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::{
    KeptParameter, ardupilot, ardupilot_devices, ardupilot_flight, ardupilot_simulation, px4, px4_checks,
    px4_devices,
};

/// Places for values: as many as there are parameters, see the test.
const PLACES: usize = 1000;

/// All kept parameters; the place of one is the place of its value.
pub fn kept_parameters() -> impl Iterator<Item = (usize, &'static KeptParameter)> {
    let groups = px4::PARAMETERS
        .iter()
        .chain(px4_checks::PARAMETERS)
        .chain(px4_devices::PARAMETERS)
        .chain(ardupilot::PARAMETERS)
        .chain(ardupilot_flight::PARAMETERS)
        .chain(ardupilot_devices::PARAMETERS)
        .chain(ardupilot_simulation::PARAMETERS);
    groups.flat_map(|group| group.iter()).enumerate()
}

/// What has been set of them. It is written and read as names with values: a record or a file of another version, which has
/// other parameters, says the same.
#[derive(Clone, Copy, PartialEq)]
pub struct KeptValues([Option<f32>; PLACES]);

impl Default for KeptValues {
    fn default() -> Self {
        Self([None; PLACES])
    }
}

impl std::fmt::Debug for KeptValues {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        to.debug_map().entries(self.by_name()).finish()
    }
}

impl KeptValues {
    /// The value of a parameter by its name: what has been set, or its default.
    pub fn by_id(&self, id: &str) -> Option<f32> {
        static BY_ID: LazyLock<HashMap<&str, (usize, &KeptParameter)>> =
            LazyLock::new(|| kept_parameters().map(|place| (place.1.id, place)).collect());
        let (place, parameter) = BY_ID.get(id)?;
        Some(self.get(*place).unwrap_or(parameter.default))
    }

    /// The value at a place, if it has been set.
    pub fn get(&self, place: usize) -> Option<f32> {
        self.0.get(place).copied().flatten()
    }

    /// Sets the value at a place.
    pub fn set(&mut self, place: usize, value: f32) {
        if let Some(kept) = self.0.get_mut(place) {
            *kept = Some(value);
        }
    }

    fn by_name(&self) -> BTreeMap<&'static str, f32> {
        let named = |(place, parameter): (usize, &KeptParameter)| Some((parameter.id, self.get(place)?));
        kept_parameters().filter_map(named).collect()
    }
}

impl Serialize for KeptValues {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.by_name().serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for KeptValues {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let named = BTreeMap::<String, f32>::deserialize(deserializer)?;
        let mut values = Self::default();
        for (place, parameter) in kept_parameters() {
            if let Some(value) = named.get(parameter.id) {
                values.set(place, *value);
            }
        }
        Ok(values)
    }
}

#[cfg(test)]
mod tests {
    use super::{KeptValues, PLACES, kept_parameters};

    #[test]
    fn every_parameter_has_a_place_a_sound_default_and_a_reason() {
        let count = kept_parameters().count();
        assert!(count <= PLACES, "{count} parameters");
        for (_, parameter) in kept_parameters() {
            let default = f64::from(parameter.default);
            let within = (parameter.minimum..=parameter.maximum).contains(&default);
            let bound =
                [parameter.minimum, parameter.maximum].iter().any(|end| *end as f32 == parameter.default);
            assert!(within || bound, "{}: {default}", parameter.id);
            assert!(!parameter.integer || default.fract() == 0.0, "{}", parameter.id);
            assert!(parameter.reason.len() > 10 && parameter.text.len() > 3, "{}", parameter.id);
        }
    }

    #[test]
    fn what_is_set_is_written_by_name_and_read_again() {
        let mut values = KeptValues::default();
        let (place, parameter) = kept_parameters().last().expect("some");
        values.set(place, 0.1);
        let text = serde_json::to_string(&values).expect("written");
        assert_eq!(text, format!("{{\"{}\":0.1}}", parameter.id));
        assert_eq!(serde_json::from_str::<KeptValues>(&text).expect("read"), values);
        let other = serde_json::from_str::<KeptValues>("{\"NO_SUCH\":1.0}").expect("of another version");
        assert_eq!(other, KeptValues::default());
    }
}
