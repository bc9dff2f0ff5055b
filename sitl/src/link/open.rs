//! From an endpoint to its transport.

use super::endpoint::Endpoint;
use super::error::LinkError;
use super::readiness::Readiness;
use super::tcp::Tcp;
use super::transport::Transport;
use super::udp::{Udp, resolve};

/// The transport of an endpoint, ready to be used; `readiness` watches its socket, if it has one.
///
/// # Errors
/// [`LinkError`] when its address or device cannot be used.
pub fn open(endpoint: &Endpoint, readiness: &mut Readiness) -> Result<Box<dyn Transport>, LinkError> {
    let text = endpoint.to_string();
    Ok(match endpoint {
        Endpoint::UdpOut { host, port, local_port } => {
            // To this machine from this machine; else from whichever of its addresses leads there.
            let loopback = resolve(host, *port, &text)?.ip().is_loopback();
            let local = if loopback { "127.0.0.1" } else { "0.0.0.0" };
            Box::new(Udp::open((local, *local_port), Some((host, *port)), &text, readiness)?)
        }
        Endpoint::UdpIn { host, port } => Box::new(Udp::open((host, *port), None, &text, readiness)?),
        Endpoint::TcpIn { host, port } => Box::new(Tcp::open((host, *port), &text)?),
        #[cfg(unix)]
        Endpoint::Serial { path, baud } => Box::new(super::serial::Serial::open(path, *baud, &text)?),
        #[cfg(not(unix))]
        Endpoint::Serial { path, .. } => {
            return Err(LinkError::Device {
                path: path.display().to_string(),
                link: text,
                source: std::io::Error::new(
                    std::io::ErrorKind::Unsupported,
                    "serial links need a Unix system",
                ),
            });
        }
    })
}
