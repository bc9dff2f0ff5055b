//! What a link is, as a person writes it.

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

use autopilot::envelope::LinkProfile;
use serde::{Deserialize, Serialize};

/// Nothing is reachable from outside unless it is asked for.
const LOCAL: &str = "127.0.0.1";
/// Of a serial link that names none.
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

/// A link: where, and what for.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct LinkSpecification {
    /// Where.
    pub endpoint: Endpoint,
    /// What for.
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
        let wrong = || {
            format!(
                "`{text}` is no link: udpout:HOST:PORT[@LOCALPORT], udpin:[HOST:]PORT, tcpin:[HOST:]PORT or \
                 serial:PATH[:BAUD], each with `,onboard` for faster telemetry; PORT is within 0 to 65535"
            )
        };
        let (address, profile) = match text.rsplit_once(',') {
            Some((address, "onboard")) => (address, LinkProfile::Onboard),
            Some((address, "ground")) => (address, LinkProfile::Ground),
            Some(_) => return Err(wrong()),
            None => (text, LinkProfile::Ground),
        };
        let (kind, rest) = address.split_once(':').ok_or_else(wrong)?;
        let endpoint = match kind {
            "udpout" => {
                let (remote, local) = rest.split_once('@').unwrap_or((rest, "0"));
                let (host, port) = host_and_port(remote).ok_or_else(wrong)?;
                let local_port = local.parse().map_err(|_| wrong())?;
                Endpoint::UdpOut { host, port, local_port }
            }
            "udpin" => {
                let (host, port) = host_and_port(rest).ok_or_else(wrong)?;
                Endpoint::UdpIn { host, port }
            }
            "tcpin" => {
                let (host, port) = host_and_port(rest).ok_or_else(wrong)?;
                Endpoint::TcpIn { host, port }
            }
            "serial" if !rest.is_empty() => {
                let (path, baud) = path_and_baud(rest).ok_or_else(|| {
                    format!("`{text}` is no link: serial:PATH[:BAUD] with a whole number above 0 for BAUD")
                })?;
                Endpoint::Serial { path: path.into(), baud }
            }
            _ => return Err(wrong()),
        };
        Ok(Self { endpoint, profile })
    }
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
    Some((host.to_owned(), port.parse().ok()?)).filter(|(host, _)| !host.is_empty())
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
