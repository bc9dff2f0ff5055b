//! Which tools a parameter file is written for.

use std::path::Path;

/// Form of the lines that are written. All forms are read, whatever the file is called.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum FileFormat {
    /// `NAME VALUE`, for MAVProxy, Mission Planner and people.
    #[default]
    Plain,
    /// System id, component id, name, value and MAV_PARAM_TYPE with tabs between them, for QGroundControl.
    QGroundControl,
}

impl FileFormat {
    /// The one that tools expect of a file: QGroundControl saves `.params`.
    pub fn of(path: &Path) -> Self {
        if path.extension().is_some_and(|extension| extension == "params") {
            Self::QGroundControl
        } else {
            Self::Plain
        }
    }
}
