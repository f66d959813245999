//! Parsing of HTTP requests and responses.

use std::io::{BufRead, ErrorKind, Read};

use opendr_engine::{Error, Result};

/// Maximum size of the first line and header fields, in bytes.
const MOST_HEAD: u64 = 16 << 10;

/// Maximum size of a response body in bytes; all parameters of a master are a few megabytes.
const MOST_ANSWER: u64 = 64 << 20;

/// Maximum size of a request body in bytes; any peer may send several at once.
const MOST_REQUEST: u64 = 8 << 20;

/// A received HTTP message.
#[derive(Debug, PartialEq)]
pub(crate) struct HttpMessage {
    /// `POST /RPC2 HTTP/1.1` or `HTTP/1.1 200 OK`.
    pub first_line: String,
    /// Whether the peer keeps the connection open.
    pub stays_open: bool,
    pub body: Vec<u8>,
}

/// Reads the next message; returns `None` at the end of the connection. A response may omit its length, a request may not.
///
/// # Errors
/// `Format` for invalid or oversized messages, `Network` when the peer disconnects or is too slow.
pub(crate) fn read_message(stream: &mut impl BufRead) -> Result<Option<HttpMessage>> {
    let mut head = stream.take(MOST_HEAD);
    let Some(first_line) = line(&mut head)? else { return Ok(None) };
    let is_response = first_line.starts_with("HTTP/");
    let most = if is_response { MOST_ANSWER } else { MOST_REQUEST };
    let mut stays_open = first_line.contains("HTTP/1.1");
    let mut length = None;
    loop {
        let field = line(&mut head)?.ok_or_else(|| disconnected("the head"))?;
        if field.is_empty() {
            break;
        }
        let (name, value) = field.split_once(':').unwrap_or((&field, ""));
        let value = value.trim();
        if name.eq_ignore_ascii_case("content-length") {
            let announced = value.parse::<u64>().ok().filter(|announced| *announced <= most);
            length = Some(announced.ok_or_else(|| {
                Error::format(format!("an HTTP message has a body of {value:.40?} bytes, which is too long"))
            })?);
        } else if name.eq_ignore_ascii_case("connection") {
            stays_open = !value.eq_ignore_ascii_case("close");
        } else if name.eq_ignore_ascii_case("transfer-encoding") {
            return Err(Error::format(format!(
                "an HTTP message has the transfer encoding {value:.40?}; send Content-Length"
            )));
        }
    }
    let mut body = Vec::new();
    match length {
        Some(length) => {
            // The buffer grows with the received bytes, not with the announced length.
            let read = stream.take(length).read_to_end(&mut body).map_err(network)?;
            if read as u64 != length {
                return Err(disconnected("the body"));
            }
        }
        None if is_response => {
            stays_open = false;
            stream.take(most).read_to_end(&mut body).map_err(network)?;
        }
        None => return Err(Error::format("an HTTP request has no Content-Length")),
    }
    Ok(Some(HttpMessage { first_line, stays_open, body }))
}

fn line(head: &mut impl BufRead) -> Result<Option<String>> {
    let mut bytes = Vec::new();
    head.read_until(b'\n', &mut bytes).map_err(network)?;
    match bytes.pop() {
        None => Ok(None),
        Some(b'\n') => {
            Ok(Some(String::from_utf8_lossy(bytes.strip_suffix(b"\r").unwrap_or(&bytes)).into_owned()))
        }
        Some(_) => Err(Error::format("the head of an HTTP message is incomplete or too long")),
    }
}

fn disconnected(part: &str) -> Error {
    Error::network(format!("the peer disconnected within {part} of an HTTP message"))
}

fn network(error: std::io::Error) -> Error {
    let announced = match error.kind() {
        ErrorKind::TimedOut | ErrorKind::WouldBlock => "the peer is too slow",
        _ => "the connection was interrupted",
    };
    Error::network(announced).with_source(error)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(mut bytes: &[u8]) -> Result<Option<HttpMessage>> {
        read_message(&mut bytes)
    }

    #[test]
    fn requests_and_responses() {
        let request =
            read(b"POST /RPC2 HTTP/1.1\r\nhost: a\r\ncontent-LENGTH: 2\r\n\r\nhi there").unwrap().unwrap();
        assert_eq!(request.body, b"hi");
        assert!(request.stays_open);
        let closing = read(b"POST / HTTP/1.1\nConnection: close\nContent-length: 0\n\n").unwrap().unwrap();
        assert!(!closing.stays_open);
        let response = read(b"HTTP/1.0 200 OK\r\n\r\nall of it").unwrap().unwrap();
        assert_eq!((response.body.as_slice(), response.stays_open), (&b"all of it"[..], false));
        assert_eq!(read(b"").unwrap(), None);
    }

    #[test]
    fn bad_messages_are_refused() {
        let long = [b"POST / HTTP/1.1\r\n".as_slice(), &[b'a'; 20_000]].concat();
        for bytes in [
            b"POST / HTTP/1.1\r\n\r\n".as_slice(),
            b"POST / HTTP/1.1\r\nContent-Length: 5\r\n\r\nhi",
            b"POST / HTTP/1.1\r\nContent-Length: 99999999999\r\n\r\n",
            b"POST / HTTP/1.1\r\nContent-Length: -1\r\n\r\n",
            b"POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n",
            b"\xff\xfe",
            &long,
        ] {
            assert!(read(bytes).is_err());
        }
    }
}
