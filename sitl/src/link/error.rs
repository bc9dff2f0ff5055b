//! Why a link cannot be opened.

use std::io;

/// One line that says what is wrong and what to do about it.
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
    /// A name that stands for no address.
    #[error("`{host}` in the link `{link}` is no address of a host")]
    Host {
        /// The name.
        host: String,
        /// The link as it was asked for.
        link: String,
    },
}

fn hint(error: &io::Error) -> &'static str {
    match error.kind() {
        io::ErrorKind::AddrInUse => " (is another vehicle running? --instance moves the default ports)",
        _ => "",
    }
}
