//! What a user is told about the drag that the wind acts through.

use quadrotor::Configuration;
use vehicle::world::wind_drag::{NAMES, provided};
use vehicle::{Notice, Severity};

/// What the user needs to know about the drag in a wind: which of it was provided, or that there is none. `chosen` are the
/// MAVLink names of the parameters that the user has set.
pub(super) fn note(
    configuration: &Configuration,
    provided_n_s_m: Option<f64>,
    chosen: &[&str],
) -> Option<Notice> {
    let info = |text| Notice { severity: Severity::Info, text };
    let open: Vec<&str> = NAMES.into_iter().filter(|name| !chosen.contains(name)).collect();
    if let Some(drag_n_s_m) = provided_n_s_m.filter(|_| !open.is_empty()) {
        return Some(info(provided(&open, drag_n_s_m)));
    }
    let none = configuration.airframe.hover_drag_n_s_m() == [0.0; 3];
    none.then(|| info(format!("wind has no effect: {} are 0", NAMES.join(", "))))
}
