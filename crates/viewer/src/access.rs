//! Who may read the viewer.

use std::fmt::Write as _;
use std::net::{IpAddr, SocketAddr};

use opendr_engine::{Error, ErrorKind, Result};

use crate::request::Request;

/// Header of the token.
pub const TOKEN_HEADER: &str = "x-opendr-token";

/// Conditions of a request.
#[derive(Debug)]
pub struct Access {
    /// Token of a viewer that other machines can reach.
    pub token: Option<String>,
}

impl Access {
    /// Creates the conditions for a viewer at `address`: a token unless the address is of this machine alone.
    ///
    /// # Errors
    /// `Io` when the system has no random numbers.
    pub fn new(address: SocketAddr) -> Result<Self> {
        if address.ip().is_loopback() {
            return Ok(Self { token: None });
        }
        let mut bytes = [0_u8; 16];
        getrandom::fill(&mut bytes)
            .map_err(|error| Error::new(ErrorKind::Io, format!("random numbers: {error}")))?;
        let token = bytes.iter().fold(String::new(), |mut token, byte| {
            // Writing to a String cannot fail.
            write!(token, "{byte:02x}").ok();
            token
        });
        Ok(Self { token: Some(token) })
    }

    /// Checks that a request comes from the viewer's own page.
    ///
    /// A viewer on the loopback interface accepts hosts that are this machine, with any port, since tunnels change it; so a page of a
    /// name that was rebound to 127.0.0.1 is refused.
    ///
    /// # Errors
    /// Returns the reason of a refusal.
    pub fn check(&self, request: &Request) -> Result<(), &'static str> {
        let host = request.header("host").ok_or("the request has no Host")?;
        if self.token.is_none() && !is_this_machine(host) {
            return Err("the viewer is for this machine; open it as http://localhost");
        }
        let origin = request.header("origin");
        if origin.is_some_and(|origin| origin.strip_prefix("http://") != Some(host)) {
            return Err("the request comes from a page of another origin");
        }
        if request.header("sec-fetch-site").is_some_and(|site| !["same-origin", "none"].contains(&site)) {
            return Err("the request comes from a page of another origin");
        }
        Ok(())
    }

    /// Checks the token of a request.
    ///
    /// # Errors
    /// Returns the reason of a refusal.
    pub fn check_token(&self, request: &Request) -> Result<(), &'static str> {
        let Some(token) = &self.token else { return Ok(()) };
        let given = request.header(TOKEN_HEADER).unwrap_or_default();
        // Takes the same time wherever the first difference is.
        let differences = given.bytes().zip(token.bytes()).filter(|(given, token)| given != token).count();
        match given.len() == token.len() && differences == 0 {
            true => Ok(()),
            false => Err("the token is wrong; open the address that the program printed"),
        }
    }
}

fn is_this_machine(host: &str) -> bool {
    let name = match host.rsplit_once(':') {
        Some((name, port)) if !port.is_empty() && port.bytes().all(|byte| byte.is_ascii_digit()) => name,
        _ => host,
    };
    let address = name.strip_prefix('[').and_then(|name| name.strip_suffix(']')).unwrap_or(name);
    name == "localhost" || address.parse::<IpAddr>().is_ok_and(|address| address.is_loopback())
}
