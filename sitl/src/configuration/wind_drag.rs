//! The drag that the wind acts through.

use quadrotor::Configuration;
use vehicle::{Notice, Severity};

/// Linear drag of an airframe in a wind, unless the user chooses another, N·s/m: 0.7 kg with an open frame drifts with
/// 10 m/s of wind at a lean of 12°.
const DRAG_N_S_M: f64 = 0.15;
/// MAVLink names of the parameters, in the order of the axes.
const NAMES: [&str; 3] = ["FRAME_DRAG_X", "FRAME_DRAG_Y", "FRAME_DRAG_Z"];

/// Gives an airframe without drag one that a wind can push. The user's parameters come on top.
pub(super) fn provide(configuration: &mut Configuration) {
    let airframe = &mut configuration.airframe;
    if airframe.hover_drag_n_s_m() == [0.0; 3] {
        airframe.drag_n_s_m = [DRAG_N_S_M; 3];
    }
}

/// What the user needs to know about the drag in a wind: which of it was provided, or that there is none. `chosen` are the
/// MAVLink names of the parameters that the user has set.
pub(super) fn note(configuration: &Configuration, chosen: &[&str]) -> Option<Notice> {
    let info = |text| Notice { severity: Severity::Info, text };
    let airframe = &configuration.airframe;
    let axes = NAMES.into_iter().zip(airframe.drag_n_s_m);
    let provided: Vec<&str> = axes
        .filter(|(name, drag_n_s_m)| *drag_n_s_m == DRAG_N_S_M && !chosen.contains(name))
        .map(|(name, _)| name)
        .collect();
    if !provided.is_empty() {
        let names = provided.join(", ");
        return Some(info(format!(
            "wind needs drag: {names} set to {DRAG_N_S_M} N s/m; change it with --set"
        )));
    }
    let none = airframe.hover_drag_n_s_m() == [0.0; 3];
    none.then(|| info(format!("wind has no effect: {} are 0", NAMES.join(", "))))
}
