//! The greeting of a TCP connection.

use std::io::{Read, Write};

use opendr_engine::{Error, Result};

use crate::url::encoded;

/// Longest answer to a greeting, in bytes.
const MAX_ANSWER: usize = 10;
const CONNECTED: &[u8] = b"CONNECTED";

/// What Webots said.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Greeting {
    Connected,
    /// The world is being loaded.
    Loading,
}

/// Greets Webots as the controller of `robot`.
pub(super) fn greet(stream: &mut (impl Read + Write), robot: Option<&str>) -> Result<Greeting> {
    let hello = match robot {
        Some(robot) => format!("CTR\nRobot-Name: {}", encoded(robot)),
        None => "CTR".to_owned(),
    };
    stream
        .write_all(hello.as_bytes())
        .map_err(|error| Error::network("cannot greet Webots").with_source(error))?;
    let (mut answer, mut length) = ([0; MAX_ANSWER], 0);
    // The answer has no end of its own: it is one of four words.
    while !WORDS.contains(&&answer[..length]) {
        let read = stream.read(&mut answer[length..(length + 1).min(MAX_ANSWER)]);
        match read.map_err(|error| Error::network("Webots did not answer the greeting").with_source(error))? {
            0 => {
                let text = String::from_utf8_lossy(&answer[..length]).into_owned();
                return Err(Error::network(format!(
                    "{text:?} is no answer of Webots; is the port that of Webots?"
                )));
            }
            more => length += more,
        }
    }
    let name = robot.map_or("the only robot".to_owned(), |robot| format!("robot {robot:?}"));
    match &answer[..length] {
        CONNECTED => Ok(Greeting::Connected),
        b"PROCESSING" => Ok(Greeting::Loading),
        b"FORBIDDEN" => Err(Error::network(format!(
            "Webots refuses {name}: it already has a controller, or this address is not allowed"
        ))),
        _ => Err(Error::not_found(format!(
            "Webots has no {name} with the controller <extern>; check the name and the field controller"
        ))),
    }
}

const WORDS: [&[u8]; 4] = [CONNECTED, b"FAILED", b"PROCESSING", b"FORBIDDEN"];

#[cfg(test)]
mod tests {
    use std::io::{Cursor, Result as IoResult};

    use opendr_engine::ErrorKind;

    use super::*;

    struct Peer(Cursor<Vec<u8>>, Vec<u8>);

    impl Read for Peer {
        fn read(&mut self, buffer: &mut [u8]) -> IoResult<usize> {
            self.0.read(buffer)
        }
    }

    impl Write for Peer {
        fn write(&mut self, bytes: &[u8]) -> IoResult<usize> {
            self.1.write(bytes)
        }

        fn flush(&mut self) -> IoResult<()> {
            Ok(())
        }
    }

    fn answered(answer: &str, robot: Option<&str>) -> (Result<Greeting>, Vec<u8>) {
        let mut peer = Peer(Cursor::new(answer.as_bytes().to_vec()), Vec::new());
        (greet(&mut peer, robot), peer.1)
    }

    #[test]
    fn each_answer_is_distinguished() {
        let (greeting, sent) = answered("CONNECTED\u{1}", Some("my robot"));
        assert_eq!(greeting.unwrap(), Greeting::Connected);
        assert_eq!(sent, b"CTR\nRobot-Name: my%20robot");
        let (greeting, sent) = answered("PROCESSING", None);
        assert_eq!((greeting.unwrap(), sent.as_slice()), (Greeting::Loading, b"CTR".as_slice()));
        assert_eq!(answered("FAILED", None).0.unwrap_err().kind(), ErrorKind::NotFound);
        assert_eq!(answered("FORBIDDEN", None).0.unwrap_err().kind(), ErrorKind::Network);
        for wrong in ["", "HTTP/1.1 400", "CONN"] {
            assert_eq!(answered(wrong, None).0.unwrap_err().kind(), ErrorKind::Network);
        }
    }
}
