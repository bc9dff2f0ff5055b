//! Errors of opening a link.

use std::io;

/// A link that cannot be opened, with the reason and the remedy.
#[derive(Debug, thiserror::Error)]
pub enum LinkError {
    /// A socket.
    #[error("cannot use {what} for the link `{link}`: {source}{}", hint(source))]
    Socket {
        /// Address.
        what: String,
        /// The link as it was asked for.
        link: String,
        /// Why.
        source: io::Error,
    },
    /// A serial device.
    #[error("cannot use {path} for the link `{link}`: {source}")]
    Device {
        /// Path of the device.
        path: String,
        /// The link as it was asked for.
        link: String,
        /// Why.
        source: io::Error,
    },
    /// A host name without an address.
    #[error("cannot resolve host {host} in the link `{link}`")]
    Host {
        /// The name.
        host: String,
        /// The link as it was asked for.
        link: String,
    },
}

fn hint(error: &io::Error) -> &'static str {
    match error.kind() {
        io::ErrorKind::AddrInUse => {
            " (is another vehicle running? choose another port, or --instance N for other default ports)"
        }
        _ => "",
    }
}
