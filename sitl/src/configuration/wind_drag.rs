//! The drag that the wind acts through.

use quadrotor::Configuration;
use vehicle::{Notice, Severity};

/// Linear drag of an airframe in a wind per mass, unless the user chooses another, N·s/m per kg: 0.15 N·s/m for 0.7 kg with an open
/// frame, which hovers in 10 m/s of wind at a lean of 12°.
const DRAG_N_S_M_PER_KG: f64 = 0.15 / 0.7;
/// MAVLink names of the parameters, in the order of the axes.
const NAMES: [&str; 3] = ["FRAME_DRAG_X", "FRAME_DRAG_Y", "FRAME_DRAG_Z"];

/// Gives an airframe without drag one that a wind can push, N·s/m, and returns that. The user's parameters come on top.
pub(super) fn provide(configuration: &mut Configuration) -> Option<f64> {
    let airframe = &mut configuration.airframe;
    if airframe.hover_drag_n_s_m() != [0.0; 3] {
        return None;
    }
    let drag_n_s_m = DRAG_N_S_M_PER_KG * airframe.mass_kg;
    airframe.drag_n_s_m = [drag_n_s_m; 3];
    Some(drag_n_s_m)
}

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
        let names = open.join(", ");
        // Three digits, as a person would write it.
        let drag = (drag_n_s_m * 1e3).round() / 1e3;
        return Some(info(format!("wind needs drag: {names} set to {drag} N·s/m; change it with --set")));
    }
    let none = configuration.airframe.hover_drag_n_s_m() == [0.0; 3];
    none.then(|| info(format!("wind has no effect: {} are 0", NAMES.join(", "))))
}
