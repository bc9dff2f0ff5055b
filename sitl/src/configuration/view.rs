//! `--view [HOST:]PORT`.

use std::str::FromStr;

/// Where the live page is served.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ViewAddress {
    /// Name or address of this machine.
    pub host: String,
    /// Port; 0 is any free one.
    pub port: u16,
}

/// The address without a value.
pub const DEFAULT_VIEW: &str = "127.0.0.1:8088";

impl Default for ViewAddress {
    fn default() -> Self {
        Self { host: "127.0.0.1".to_owned(), port: 8088 }
    }
}

impl FromStr for ViewAddress {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (host, port) = text.rsplit_once(':').unwrap_or(("127.0.0.1", text));
        let is_host = !host.is_empty() && (!host.contains(':') || host.starts_with('['));
        match port.parse() {
            Ok(port) if is_host => Ok(Self { host: host.to_owned(), port }),
            _ => Err(format!(
                "invalid address `{text}`; use [HOST:]PORT, such as 8088, 0.0.0.0:8088 or [::1]:8088"
            )),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{DEFAULT_VIEW, ViewAddress};

    #[test]
    fn an_address_is_a_port_with_a_host_or_without() {
        let read = |text: &str| text.parse::<ViewAddress>().map(|address| (address.host, address.port));
        assert_eq!(DEFAULT_VIEW.parse(), Ok(ViewAddress::default()));
        assert_eq!(read("9000"), Ok(("127.0.0.1".to_owned(), 9000)));
        assert_eq!(read("robot:0"), Ok(("robot".to_owned(), 0)));
        assert_eq!(read("[::1]:80"), Ok(("[::1]".to_owned(), 80)));
        for wrong in ["", "robot", ":80", "::1:80", "127.0.0.1:", "127.0.0.1:70000", "1:2:3"] {
            assert!(read(wrong).is_err_and(|reason| reason.contains("[HOST:]PORT")), "{wrong}");
        }
    }
}
