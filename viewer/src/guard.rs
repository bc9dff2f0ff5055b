//! Who may talk to the server at all: pages of other sites must not, whatever names they give this machine.

use axum::http::{HeaderMap, header};

/// Why a request is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stranger {
    /// Its `Host` is the name of another site that leads here.
    Host,
    /// It comes from the page of another site.
    Origin,
}

impl Stranger {
    /// What a person is told.
    pub fn reason(self) -> &'static str {
        match self {
            Self::Host => {
                "This server answers to IP addresses, localhost and the name in --view; use one of these in the address.\n"
            }
            Self::Origin => "This server takes no requests from pages of other sites.\n",
        }
    }
}

/// Checks the headers of a request; `name` is the host that the server was told to listen on.
///
/// An IP address as `Host` cannot be the name of another site (DNS rebinding), and the `Origin` of our own page is its `Host`.
///
/// # Errors
/// [`Stranger`]
pub fn check(headers: &HeaderMap, name: &str) -> Result<(), Stranger> {
    let text = |key| headers.get(key).map(|value| value.to_str().unwrap_or(""));
    let host = text(header::HOST).ok_or(Stranger::Host)?;
    if !is_ours(host_name(host), name) {
        return Err(Stranger::Host);
    }
    match text(header::ORIGIN) {
        // Programs send none, and only they can leave it out.
        None => Ok(()),
        Some(origin) if origin.strip_prefix("http://") == Some(host) => Ok(()),
        Some(_) => Err(Stranger::Origin),
    }
}

fn is_ours(host: &str, name: &str) -> bool {
    let literal = host.trim_start_matches('[').trim_end_matches(']');
    literal.parse::<std::net::IpAddr>().is_ok()
        || host.eq_ignore_ascii_case("localhost")
        || host.eq_ignore_ascii_case(name)
}

/// A host without its port.
fn host_name(host: &str) -> &str {
    match host.rsplit_once(':') {
        Some((name, port)) if port.bytes().all(|byte| byte.is_ascii_digit()) && !name.is_empty() => name,
        _ => host,
    }
}

#[cfg(test)]
mod tests {
    use super::{Stranger, check};
    use axum::http::{HeaderMap, header};

    fn headers(host: &str, origin: Option<&str>) -> HeaderMap {
        let mut headers = HeaderMap::new();
        headers.insert(header::HOST, host.parse().expect("a header"));
        if let Some(origin) = origin {
            headers.insert(header::ORIGIN, origin.parse().expect("a header"));
        }
        headers
    }

    #[test]
    fn addresses_localhost_and_the_own_name_are_answered() {
        for host in ["127.0.0.1:8088", "localhost:8088", "[::1]:8088", "192.168.1.7", "Robot:80", "LOCALHOST"]
        {
            assert_eq!(check(&headers(host, None), "robot"), Ok(()), "{host}");
            let origin = format!("http://{host}");
            assert_eq!(check(&headers(host, Some(&origin)), "robot"), Ok(()), "{host}");
        }
    }

    #[test]
    fn names_and_pages_of_others_are_refused() {
        for host in ["evil.example:8088", "127.0.0.1.evil.example", "localhost.evil.example:8088", "", ":80"]
        {
            assert_eq!(check(&headers(host, None), "robot"), Err(Stranger::Host), "{host}");
        }
        for origin in
            ["http://evil.example", "null", "https://127.0.0.1:8088", "http://127.0.0.1:9000", "", "http://"]
        {
            let headers = headers("127.0.0.1:8088", Some(origin));
            assert_eq!(check(&headers, "robot"), Err(Stranger::Origin), "{origin}");
        }
        assert_eq!(check(&HeaderMap::new(), "robot"), Err(Stranger::Host));
    }
}
