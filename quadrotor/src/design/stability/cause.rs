//! Which value of a configuration makes a loop unstable.

use core::fmt::{Display, Formatter, Result as FormatResult};

use crate::design::stability::stability_report::StabilityReport;
use crate::{Access, CascadeDesign, Configuration, PARAMETERS, Parameter, Quantity};

/// Most parameters that are tried: each try is a design.
const MOST_TRIES: usize = 12;

/// The groups of parameters that the stability of a loop depends on.
const GROUPS: [&str; 3] = ["airframe.", "controller.", "sensor."];

/// A parameter that makes a loop unstable: with another value of it alone the vehicle could fly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cause {
    /// Public name of the parameter.
    pub name: &'static str,
    /// Its value.
    pub value: Quantity,
    /// A value with which all loops are stable.
    pub stable: Quantity,
}

impl Cause {
    /// The first parameter whose value in one of some `sound` configurations makes all loops stable.
    pub(crate) fn of<'a>(
        configuration: &Configuration,
        sound: impl IntoIterator<Item = &'a Configuration>,
    ) -> Option<Self> {
        sound.into_iter().find_map(|sound| Self::beside(configuration, sound))
    }

    fn beside(configuration: &Configuration, sound: &Configuration) -> Option<Self> {
        let differing = |parameter: &&Parameter| {
            GROUPS.iter().any(|group| parameter.name.starts_with(group))
                && !parameter.access.same(configuration, sound)
        };
        // Another number is a better answer than another kind of controller.
        let is_number =
            |parameter: &&Parameter| matches!(parameter.access, Access::Real { .. } | Access::Integer { .. });
        let numbers = PARAMETERS.iter().filter(is_number);
        let others = PARAMETERS.iter().filter(|parameter| !is_number(parameter));
        let mut tried = numbers.chain(others).filter(differing).take(MOST_TRIES);
        let blamed = tried.find(|parameter| {
            let mut mended = *configuration;
            parameter.access.copy(sound, &mut mended);
            is_stable(&mended)
        })?;
        let quantity =
            |configuration| Quantity { value: number(blamed, configuration), unit: blamed.unit.symbol() };
        Some(Self { name: blamed.name, value: quantity(configuration), stable: quantity(sound) })
    }
}

impl Display for Cause {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> FormatResult {
        let Self { name, value, stable } = self;
        write!(formatter, "caused by {name} = {value}, stable with {stable}")
    }
}

fn is_stable(configuration: &Configuration) -> bool {
    let designed = CascadeDesign::new(configuration).ok();
    let report = designed.and_then(|design| StabilityReport::of(configuration, &design).ok());
    report.is_some_and(|report| report.unstable().is_none())
}

fn number(parameter: &Parameter, configuration: &Configuration) -> f64 {
    match parameter.access {
        Access::Real { get, .. } => get(configuration),
        Access::Integer { get, .. } | Access::Enumeration { get, .. } => f64::from(get(configuration)),
        Access::Boolean { get, .. } => f64::from(u8::from(get(configuration))),
    }
}
