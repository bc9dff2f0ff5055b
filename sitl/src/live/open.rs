//! From an address to a server.

use viewer::{Past, Recording, Replayer, Viewer, ViewerError};

use super::film::replayed;
use crate::configuration::ViewAddress;

/// Serves the page, which opens the recording if there is one.
///
/// # Errors
/// [`ViewerError`]: the address cannot be used, or the system gives no thread or randomness.
pub fn open_viewer(address: &ViewAddress, recording: Option<Recording>) -> Result<Viewer, ViewerError> {
    let viewer = Viewer::open(
        &address.host,
        address.port,
        Past { recording, replayer: Some(Replayer::new(replayed)) },
    )?;
    if !viewer.address().ip().is_loopback() {
        tracing::warn!("--view: other machines can see the page at {}", viewer.address());
    }
    Ok(viewer)
}
