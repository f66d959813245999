//! Addresses of robots in a running simulation.

use std::fmt;

use opendr_engine::{Error, Result};

/// The address of a robot whose controller is `<extern>`, as in `WEBOTS_CONTROLLER_URL`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ControllerUrl {
    /// `tcp://HOST:PORT/ROBOT`.
    Tcp {
        /// Host name or address.
        host: String,
        /// Port of Webots, 1234 unless it was started with another.
        port: u16,
        /// Name of the robot; none if it is the only one.
        robot: Option<String>,
    },
    /// `ipc://PORT/ROBOT`: on the machine of Webots.
    Ipc {
        /// Port of Webots.
        port: u16,
        /// Name of the robot.
        robot: String,
    },
}

/// Longest encoded name: Webots replaces longer ones by a hash.
const MAX_NAME: usize = 70;

impl ControllerUrl {
    /// Reads an address.
    ///
    /// # Errors
    /// Returns `InvalidParam` if it does not have one of the two forms, `Unsupported` for names that Webots hashes.
    pub fn parse(text: &str) -> Result<Self> {
        let wrong = || {
            Error::invalid_param(format!(
                "{text:?} is no address of a robot; give tcp://HOST:PORT/ROBOT or ipc://PORT/ROBOT"
            ))
        };
        let (scheme, rest) = text.split_once("://").ok_or_else(wrong)?;
        let (place, robot) = match rest.split_once('/') {
            Some((place, robot)) => (place, Some(robot).filter(|robot| !robot.is_empty())),
            None => (rest, None),
        };
        if robot.is_some_and(|robot| encoded(robot).len() > MAX_NAME) {
            return Err(Error::unsupported(format!(
                "the name of the robot has more than {MAX_NAME} characters, which Webots replaces by a hash; shorten it"
            )));
        }
        match scheme {
            "tcp" => {
                let (host, port) =
                    place.rsplit_once(':').filter(|(host, _)| !host.is_empty()).ok_or_else(wrong)?;
                let port = port.parse().map_err(|_| wrong())?;
                Ok(Self::Tcp { host: host.to_owned(), port, robot: robot.map(str::to_owned) })
            }
            "ipc" => {
                let port = place.parse().map_err(|_| wrong())?;
                Ok(Self::Ipc { port, robot: robot.ok_or_else(wrong)?.to_owned() })
            }
            _ => Err(wrong()),
        }
    }
}

impl fmt::Display for ControllerUrl {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Tcp { host, port, robot } => {
                write!(f, "tcp://{host}:{port}/{}", robot.as_deref().unwrap_or_default())
            }
            Self::Ipc { port, robot } => write!(f, "ipc://{port}/{robot}"),
        }
    }
}

/// Encodes a name for a path: all but letters, digits and `-_.~` as `%XX`.
pub(crate) fn encoded(name: &str) -> String {
    name.bytes().fold(String::new(), |mut text, byte| {
        match byte {
            b'A'..=b'Z' | b'a'..=b'z' | b'0'..=b'9' | b'-' | b'_' | b'.' | b'~' => text.push(byte.into()),
            _ => {
                let digit = |half: u8| char::from_digit(half.into(), 16).unwrap_or('0').to_ascii_uppercase();
                text.extend(['%', digit(byte >> 4), digit(byte & 15)]);
            }
        }
        text
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_forms_are_read() {
        for text in ["tcp://10.0.0.2:1234/my robot", "ipc://1234/robot", "tcp://[::1]:99/"] {
            assert_eq!(ControllerUrl::parse(text).unwrap().to_string(), text);
        }
        for text in [
            "",
            "robot",
            "tcp://host/robot",
            "tcp://:1/robot",
            "ipc://1234",
            "http://a:1/b",
            "tcp://a:70000/b",
        ] {
            assert!(ControllerUrl::parse(text).is_err(), "{text}");
        }
        assert!(ControllerUrl::parse(&format!("ipc://1/{}", "a".repeat(71))).is_err());
    }

    #[test]
    fn names_are_encoded() {
        assert_eq!(encoded("my robot/2"), "my%20robot%2F2");
    }
}
