//! Links as people write them: `udpout:127.0.0.1:14550`.

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

use autopilot::envelope::LinkProfile;
use serde::{Deserialize, Serialize};

/// Links bind to and send to loopback unless another address is given.
const LOCAL: &str = "127.0.0.1";
/// Default speed of a serial link.
const BAUD: u32 = 57_600;

/// Kind and address of a link.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Endpoint {
    /// Sends to an address; others may send to it, too.
    UdpOut {
        /// Host to send to.
        host: String,
        /// Port to send to.
        port: u16,
        /// Port to send from; 0: any.
        local_port: u16,
    },
    /// Waits for datagrams and answers their senders.
    UdpIn {
        /// Address to listen on.
        host: String,
        /// Port to listen on; 0: any.
        port: u16,
    },
    /// Accepts connections.
    TcpIn {
        /// Address to listen on.
        host: String,
        /// Port to listen on; 0: any.
        port: u16,
    },
    /// A serial device.
    Serial {
        /// Its path.
        path: PathBuf,
        /// Bits per second.
        baud: u32,
    },
}

/// A link: its address and its purpose.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct LinkSpecification {
    /// Address.
    pub endpoint: Endpoint,
    /// Purpose: telemetry for a ground station or a companion computer.
    pub profile: LinkProfile,
}

/// PX4's ports for a vehicle of this number: a ground-station link and an onboard link.
pub fn default_links(instance: u16) -> Vec<LinkSpecification> {
    let link = |port, local_port, profile| LinkSpecification {
        endpoint: Endpoint::UdpOut { host: LOCAL.to_owned(), port, local_port },
        profile,
    };
    vec![
        link(14_550, 18_570 + instance, LinkProfile::Ground),
        // From the eleventh on all share a port: the next one is the ground station's.
        link(14_540 + instance.min(9), 14_580 + instance, LinkProfile::Onboard),
    ]
}

impl LinkSpecification {
    /// The same link of the vehicle of a number (from zero) among several: local ports count up, and the port that an
    /// onboard link sends to. `None` where ports end, and for a serial device, which is only one.
    pub fn of_vehicle(&self, number: u16) -> Option<Self> {
        // 0 is any.
        let counted = |port: u16| if port == 0 { Some(0) } else { port.checked_add(number) };
        let endpoint = match &self.endpoint {
            Endpoint::UdpOut { host, port, local_port } => Endpoint::UdpOut {
                host: host.clone(),
                port: if self.profile == LinkProfile::Onboard { counted(*port)? } else { *port },
                local_port: counted(*local_port)?,
            },
            Endpoint::UdpIn { host, port } => Endpoint::UdpIn { host: host.clone(), port: counted(*port)? },
            Endpoint::TcpIn { host, port } => Endpoint::TcpIn { host: host.clone(), port: counted(*port)? },
            Endpoint::Serial { .. } if number == 0 => self.endpoint.clone(),
            Endpoint::Serial { .. } => return None,
        };
        Some(Self { endpoint, profile: self.profile })
    }
}

impl FromStr for LinkSpecification {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        read(text).ok_or_else(|| refusal(text))
    }
}

/// A link as it is written.
fn read(text: &str) -> Option<LinkSpecification> {
    let (address, profile) = match text.rsplit_once(',') {
        Some((address, "onboard")) => (address, LinkProfile::Onboard),
        Some((address, "ground")) => (address, LinkProfile::Ground),
        Some(_) => return None,
        None => (text, LinkProfile::Ground),
    };
    let (kind, rest) = address.split_once(':')?;
    let endpoint = match kind {
        "udpout" => {
            let (remote, local) = rest.split_once('@').unwrap_or((rest, "0"));
            let (host, port) = host_and_port(remote)?;
            let local_port = local.parse().ok()?;
            Endpoint::UdpOut { host, port, local_port }
        }
        "udpin" => {
            let (host, port) = host_and_port(rest)?;
            Endpoint::UdpIn { host, port }
        }
        "tcpin" => {
            let (host, port) = host_and_port(rest)?;
            Endpoint::TcpIn { host, port }
        }
        "serial" if !rest.is_empty() => {
            let (path, baud) = path_and_baud(rest)?;
            Endpoint::Serial { path: path.into(), baud }
        }
        _ => return None,
    };
    Some(LinkSpecification { endpoint, profile })
}

/// Why a text is not a link: what was probably meant, or what is allowed.
fn refusal(text: &str) -> String {
    if text.starts_with("serial:") {
        return format!(
            "invalid link `{text}`; use serial:PATH[:BAUD] with a positive integer as BAUD, such as \
             serial:/dev/ttyACM0:57600"
        );
    }
    match meant(text) {
        Some(link) => format!("invalid link `{text}`; did you mean `{link}`?"),
        None => format!(
            "invalid link `{text}`; use udpout:HOST:PORT[@LOCALPORT], udpin:[HOST:]PORT, tcpin:[HOST:]PORT or \
             serial:PATH[:BAUD], with a PORT from 0 to 65535; append `,onboard` for faster telemetry"
        ),
    }
}

/// The link that was probably meant: other programs write `udp:` and `tcp:`, with slashes, or the address alone.
fn meant(text: &str) -> Option<String> {
    let (kind, rest) = match text.split_once(':') {
        _ if text.starts_with('/') => ("tty", text),
        split => split.unwrap_or(("", text)),
    };
    let rest = if kind.is_empty() { rest } else { rest.trim_start_matches("//").trim_start_matches(':') };
    let named: &[&str] = match kind.to_ascii_lowercase().as_str() {
        // An address to send to has a host.
        "" | "udp" if rest.contains(':') => &["udpout"],
        "" | "udp" | "udpin" | "udp_in" | "upd" | "updin" | "udpi" => &["udpin"],
        "udpout" | "udp_out" | "udpo" | "udpbcast" | "updout" => &["udpout"],
        "tcp" | "tcpin" | "tcp_in" | "tcpserver" | "tcpout" => &["tcpin"],
        "tty" | "uart" | "ser" => &["serial"],
        _ => &[],
    };
    // Without a kind the text before the first colon is a host.
    let whole = ["udpout"].into_iter().map(|kind| format!("{kind}:{text}")).filter(|_| named.is_empty());
    let candidates = named.iter().map(|kind| format!("{kind}:{rest}")).chain(whole);
    candidates.into_iter().find(|link| link != text && read(link).is_some())
}

/// A colon within the name of a device, as in /dev/serial/by-path/pci-0000:00:14.0, is followed by more of its path.
fn path_and_baud(text: &str) -> Option<(&str, u32)> {
    match text.rsplit_once(':') {
        Some((path, baud)) if !baud.contains(['-', '.', '/']) => {
            baud.parse().ok().filter(|baud| *baud > 0 && !path.is_empty()).map(|baud| (path, baud))
        }
        _ => Some((text, BAUD)),
    }
}

/// `PORT` alone is on this machine.
fn host_and_port(text: &str) -> Option<(String, u16)> {
    let (host, port) = text.rsplit_once(':').unwrap_or((LOCAL, text));
    let host = host.trim_start_matches('[').trim_end_matches(']');
    Some((host.to_owned(), port.parse().ok()?)).filter(|(host, _)| !host.is_empty() && !host.contains('/'))
}

impl fmt::Display for Endpoint {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UdpOut { host, port, local_port } => write!(formatter, "udpout:{host}:{port}@{local_port}"),
            Self::UdpIn { host, port } => write!(formatter, "udpin:{host}:{port}"),
            Self::TcpIn { host, port } => write!(formatter, "tcpin:{host}:{port}"),
            Self::Serial { path, baud } => write!(formatter, "serial:{}:{baud}", path.display()),
        }
    }
}

impl fmt::Display for LinkSpecification {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.profile {
            LinkProfile::Ground => write!(formatter, "{}", self.endpoint),
            LinkProfile::Onboard => write!(formatter, "{},onboard", self.endpoint),
        }
    }
}

impl TryFrom<String> for LinkSpecification {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<LinkSpecification> for String {
    fn from(link: LinkSpecification) -> Self {
        link.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::{Endpoint, LinkSpecification, default_links};

    #[test]
    fn links_read_as_they_are_written() {
        for text in [
            "udpout:127.0.0.1:14550@18570",
            "udpin:0.0.0.0:14550",
            "tcpin:127.0.0.1:5760,onboard",
            "serial:/dev/ttyACM0:115200",
        ] {
            let link: LinkSpecification = text.parse().expect(text);
            assert_eq!(link.to_string(), text);
        }
        let link: LinkSpecification = "tcpin:5760".parse().expect("a port alone");
        assert_eq!(link.endpoint, Endpoint::TcpIn { host: "127.0.0.1".to_owned(), port: 5760 });
        for wrong in
            ["", "udp", "udpin:", "tcpin:x", "udpout:h:1@x", "serial:", "tcpin:5760,fast", "udpin:70000"]
        {
            assert!(wrong.parse::<LinkSpecification>().is_err(), "{wrong}");
        }
        for (wrong, right) in [
            ("udp:14550", "udpin:14550"),
            ("udp:127.0.0.1:14550", "udpout:127.0.0.1:14550"),
            ("udp://:14540", "udpin:14540"),
            ("udpin://0.0.0.0:14540,onboard", "udpin:0.0.0.0:14540,onboard"),
            ("tcp:127.0.0.1:5760", "tcpin:127.0.0.1:5760"),
            ("14550", "udpin:14550"),
            ("127.0.0.1:14550", "udpout:127.0.0.1:14550"),
            ("/dev/ttyACM0:57600", "serial:/dev/ttyACM0:57600"),
        ] {
            let error = wrong.parse::<LinkSpecification>().expect_err(wrong);
            assert_eq!(error, format!("invalid link `{wrong}`; did you mean `{right}`?"));
            assert!(right.parse::<LinkSpecification>().is_ok());
        }
        for wrong in ["carrier-pigeon", "udpin:70000", "tcpin:5760,fast"] {
            let error = wrong.parse::<LinkSpecification>().expect_err(wrong);
            assert!(error.contains("use udpout:HOST:PORT[@LOCALPORT], udpin:[HOST:]PORT"), "{error}");
        }
        for wrong in ["serial:/dev/ttyS0:abc", "serial:/dev/ttyS0:", "serial:/dev/ttyS0:0", "serial::9600"] {
            let error = wrong.parse::<LinkSpecification>().expect_err(wrong);
            assert!(error.contains("BAUD"), "{wrong}: {error}");
        }
        for (name, path) in
            [("/dev/ttyUSB0", "/dev/ttyUSB0"), ("/by-path/pci-0:00:14.0-usb", "/by-path/pci-0:00:14.0-usb")]
        {
            let link: LinkSpecification = format!("serial:{name}").parse().expect(name);
            assert_eq!(link.endpoint, Endpoint::Serial { path: path.into(), baud: 57_600 });
        }
    }

    #[test]
    fn default_ports_are_px4s() {
        let links: Vec<String> = default_links(2).iter().map(ToString::to_string).collect();
        assert_eq!(links, ["udpout:127.0.0.1:14550@18572", "udpout:127.0.0.1:14542@14582,onboard"]);
        let links: Vec<String> = default_links(10).iter().map(ToString::to_string).collect();
        assert_eq!(links, ["udpout:127.0.0.1:14550@18580", "udpout:127.0.0.1:14549@14590,onboard"]);
    }

    #[test]
    fn ports_of_several_vehicles_count_up() {
        for (first, third) in [
            ("udpin:127.0.0.1:14550", Some("udpin:127.0.0.1:14552")),
            ("udpin:127.0.0.1:0", Some("udpin:127.0.0.1:0")),
            ("tcpin:127.0.0.1:5760,onboard", Some("tcpin:127.0.0.1:5762,onboard")),
            ("udpout:127.0.0.1:14550@18570", Some("udpout:127.0.0.1:14550@18572")),
            ("udpout:127.0.0.1:14540@0,onboard", Some("udpout:127.0.0.1:14542@0,onboard")),
            ("tcpin:127.0.0.1:65534", None),
            ("serial:/dev/ttyACM0:115200", None),
        ] {
            let link: LinkSpecification = first.parse().expect(first);
            assert_eq!(link.of_vehicle(2).map(|link| link.to_string()).as_deref(), third);
            assert_eq!(link.of_vehicle(0), Some(link));
        }
    }
}
