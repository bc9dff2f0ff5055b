//! The drag that the wind acts through.

use quadrotor::Configuration;

/// Linear drag of an airframe in a wind per mass, unless the user chooses another, N·s/m per kg: 0.15 N·s/m for 0.7 kg with an open
/// frame, which hovers in 10 m/s of wind at a lean of 12°.
const DRAG_N_S_M_PER_KG: f64 = 0.15 / 0.7;
/// MAVLink names of the parameters, in the order of the axes.
pub const NAMES: [&str; 3] = ["FRAME_DRAG_X", "FRAME_DRAG_Y", "FRAME_DRAG_Z"];

/// Gives an airframe without drag one that a wind can push, N·s/m, and returns that.
pub fn provide(configuration: &mut Configuration) -> Option<f64> {
    let airframe = &mut configuration.airframe;
    if airframe.hover_drag_n_s_m() != [0.0; 3] {
        return None;
    }
    let drag_n_s_m = DRAG_N_S_M_PER_KG * airframe.mass_kg;
    airframe.drag_n_s_m = [drag_n_s_m; 3];
    Some(drag_n_s_m)
}

/// Tells that some parameters were set to a drag, N·s/m.
pub fn provided(names: &[&str], drag_n_s_m: f64) -> String {
    // Three digits, as a person would write it.
    let drag = (drag_n_s_m * 1e3).round() / 1e3;
    format!("wind needs drag: {} set to {drag} N·s/m; change it with --set", names.join(", "))
}
