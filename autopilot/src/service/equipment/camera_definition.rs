//! The camera definition: the file that tells clients which settings the camera has.

use core::fmt::Write;

use vehicle::equipment::Camera;

use super::camera_setting::Setting;

/// The file, in the root: MAVSDK stores what it downloads by its last name, and looks for it by the whole path.
pub const NAME: &str = "camera.xml";
/// Where CAMERA_INFORMATION says that it is.
pub const URI: &str = "mftp://camera.xml";
/// To be raised with every change of the file: clients keep it by vendor, model and this number.
pub const VERSION: u16 = 1;
/// Who made the camera.
pub const VENDOR: &str = "LMPC";
/// What it is.
pub const MODEL: &str = "Simulated camera";

/// What it describes, with its name for people. The mode has commands of its own, and MAVSDK mistakes the number of a defined mode
/// whenever CAMERA_SETTINGS tells it.
const SETTINGS: [(Setting, &str); 2] =
    [(Setting::Zoom, "Zoom, percent of its range"), (Setting::Focus, "Focus, percent of its range")];

/// The file. It stays the same however the camera is set: default values are those at the start.
pub fn render() -> Vec<u8> {
    let mut xml = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<mavlinkcamera>\n  <definition version=\"{VERSION}\">\n    \
         <model>{MODEL}</model>\n    <vendor>{VENDOR}</vendor>\n  </definition>\n  <parameters>\n"
    );
    let initial = Camera::default();
    for (setting, description) in SETTINGS {
        let (name, default) = (setting.name(), f32::from_le_bytes(setting.value(&initial)));
        // Writing into a string cannot fail.
        let _ = writeln!(
            xml,
            "    <parameter name=\"{name}\" type=\"float\" default=\"{default}\" min=\"0\" max=\"100\" step=\"1\">\n      \
             <description>{description}</description>\n    </parameter>"
        );
    }
    xml.push_str("  </parameters>\n</mavlinkcamera>\n");
    xml.into_bytes()
}

#[cfg(test)]
mod tests {
    use super::{VERSION, render};
    use crate::codec::checksum::checksum;

    /// Clients that have a file of this version go on using it.
    #[test]
    fn a_changed_file_has_another_version() {
        assert_eq!((VERSION, checksum(&render())), (1, 3_519_802_935), "raise VERSION, then set both here");
    }
}
