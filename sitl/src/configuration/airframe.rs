//! `--airframe NAME|FILE.toml`: what flies.

use std::ffi::OsString;
use std::fmt;
use std::path::{Path, PathBuf};

use quadrotor::{AirframePreset, Configuration, nearest_name};
use vehicle::{BatteryPack, Notice, Severity};

use super::{Addressed, airframe_file};
use crate::failure::Failure;

/// An airframe with published parameters, or a file that describes one.
#[derive(Clone, Debug, PartialEq)]
pub enum AirframeChoice {
    /// A preset.
    Preset(AirframePreset),
    /// A TOML file.
    File(PathBuf),
}

impl Addressed<AirframeChoice> {
    /// Reads `[ID:]NAME` or `[ID:]FILE.toml`. What ends in .toml, or has a folder in it, is a file.
    ///
    /// # Errors
    /// What is allowed, and the name that is probably meant.
    pub fn of_airframe(given: OsString) -> Result<Self, String> {
        let Addressed { system_id, value: path } = Addressed::of_path(given);
        let name = path.to_str().unwrap_or_default();
        let is_file = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"))
            || path.components().count() > 1;
        let value = match AirframePreset::from_name(name) {
            Some(preset) => AirframeChoice::Preset(preset),
            None if is_file => AirframeChoice::File(path),
            None => return Err(unknown(&path.display().to_string())),
        };
        Ok(Self { system_id, value })
    }
}

impl fmt::Display for AirframeChoice {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Preset(preset) => formatter.write_str(preset.name()),
            Self::File(path) => path.display().fmt(formatter),
        }
    }
}

/// An airframe that there is not.
fn unknown(name: &str) -> String {
    let presets = AirframePreset::ALL.map(AirframePreset::name);
    let meant =
        nearest_name(name, presets).map(|meant| format!("; did you mean {meant}?")).unwrap_or_default();
    format!("unknown airframe `{name}`; allowed {} or a FILE.toml{meant}", presets.join(", "))
}

/// An airframe with all that follows from it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ChosenAirframe {
    /// Limits and weights that fly it.
    pub(super) configuration: Configuration,
    /// A battery of its size.
    pub(super) battery: BatteryPack,
    /// What the user is told.
    pub(super) note: Notice,
}

impl AirframeChoice {
    /// The airframe with limits, weights and battery.
    ///
    /// # Errors
    /// [`Failure`] of a file that cannot be read, or with which nothing can fly.
    pub(super) fn choose(&self) -> Result<ChosenAirframe, Failure> {
        let configuration = match self {
            Self::Preset(preset) => Configuration::for_airframe(&preset.airframe())?,
            Self::File(path) => airframe_file::read(path)?,
        };
        let airframe = &configuration.airframe;
        let text = format!(
            "airframe {}: {} kg, hovers at {:.0} rad/s with {:.0} % of its thrust",
            shown(self),
            airframe.mass_kg,
            airframe.hover_rotor_speed_rad_s(),
            100.0 * airframe.hover_thrust_share(),
        );
        let battery = BatteryPack::of_airframe(airframe);
        Ok(ChosenAirframe { battery, note: Notice { severity: Severity::Info, text }, configuration })
    }
}

/// The preset's name, or the file's without its folder.
fn shown(choice: &AirframeChoice) -> String {
    match choice {
        AirframeChoice::Preset(preset) => preset.name().to_owned(),
        AirframeChoice::File(path) => {
            path.file_name().map_or_else(|| choice.to_string(), |name| Path::new(name).display().to_string())
        }
    }
}

#[cfg(test)]
mod tests {
    use quadrotor::AirframePreset;

    use super::{Addressed, AirframeChoice};

    #[test]
    fn names_are_presets_and_paths_are_files() {
        let read = |text: &str| Addressed::of_airframe(text.into());
        let preset = |system_id, preset| Ok(Addressed { system_id, value: AirframeChoice::Preset(preset) });
        assert_eq!(read("iris"), preset(None, AirframePreset::Iris));
        assert_eq!(read("3:crazyflie"), preset(Some(3), AirframePreset::Crazyflie));
        for file in ["own.toml", "frames/own", "OWN.TOML"] {
            let value = AirframeChoice::File(file.into());
            assert_eq!(read(file), Ok(Addressed { system_id: None, value }));
        }
        let refused = read("irs").expect_err("no airframe");
        assert_eq!(
            refused,
            "unknown airframe `irs`; allowed paper, crazyflie, hummingbird, iris, heavy or a FILE.toml; did you mean iris?"
        );
        assert!(read("boeing").expect_err("no airframe").ends_with("heavy or a FILE.toml"));
    }
}
