//! URIs of masters and nodes, `http://host:port/`.

use std::fmt;

use opendr_engine::{Error, Result};

/// URI of a master or node.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct HttpUri {
    pub host: String,
    pub port: u16,
}

impl HttpUri {
    /// Parses an address.
    ///
    /// # Errors
    /// `InvalidParam` for anything but `http://host:port`, with or without a path.
    pub fn new(text: &str) -> Result<Self> {
        Self::parse(text.trim(), "http://").ok_or_else(|| {
            Error::invalid_param(format!("{text:.200?} is not an address such as http://localhost:11311"))
        })
    }

    /// Parses host and port of `text` after `scheme`; port 80 if there is none.
    pub fn parse(text: &str, scheme: &str) -> Option<Self> {
        let rest = text.strip_prefix(scheme)?;
        let place = rest.split('/').next().unwrap_or(rest);
        let (host, port) = match place.rsplit_once(':') {
            Some((host, port)) if !port.ends_with(']') => (host, port.parse().ok()?),
            _ => (place, 80),
        };
        let host = host.strip_prefix('[').and_then(|host| host.strip_suffix(']')).unwrap_or(host);
        let plain = !host.is_empty() && host.chars().all(|letter| letter.is_ascii_graphic() && letter != '@');
        plain.then(|| Self { host: host.to_owned(), port })
    }
}

/// Returns `host` in the form of a URI, with brackets around IPv6 addresses.
pub(crate) fn host_in_uri(host: &str) -> String {
    if host.contains(':') { format!("[{host}]") } else { host.to_owned() }
}

impl fmt::Display for HttpUri {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "http://{}:{}/", host_in_uri(&self.host), self.port)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_parsed() {
        let of = |text: &str| HttpUri::new(text).map(|uri| uri.to_string()).ok();
        assert_eq!(of("http://localhost:11311").unwrap(), "http://localhost:11311/");
        assert_eq!(of("http://10.0.0.1:80/RPC2").unwrap(), "http://10.0.0.1:80/");
        assert_eq!(of("http://[::1]:11311/").unwrap(), "http://[::1]:11311/");
        assert_eq!(of("http://robot/").unwrap(), "http://robot:80/");
        for bad in [
            "",
            "localhost:11311",
            "https://a:1",
            "http://:1",
            "http://a:99999",
            "http://a b:1",
            "http://a\r\n:1",
        ] {
            assert_eq!(of(bad), None, "{bad}");
        }
    }
}
