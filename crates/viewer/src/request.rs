//! Requests of HTTP/1.1.

use std::io::{self, Read};
use std::time::{Duration, Instant};

/// Maximum size of a request's head in bytes.
pub const MAX_HEAD: usize = 8 << 10;
/// Maximum size of a request's body in bytes.
pub const MAX_BODY: usize = 64 << 10;
/// Maximum number of headers.
const MAX_HEADERS: usize = 64;
/// Maximum time from the first byte of a request to its last.
const MAX_TIME: Duration = Duration::from_secs(10);

/// A request.
#[derive(Debug)]
pub struct Request {
    pub method: String,
    /// Path without the query.
    pub path: String,
    pub query: String,
    headers: Vec<(String, String)>,
    pub body: Vec<u8>,
}

/// Why there is no request.
#[derive(Debug)]
pub enum Failure {
    /// The connection ended, or was idle for too long.
    Closed,
    /// Status and text of the refusal, after which the connection ends.
    Refused(u16, &'static str),
}

impl From<io::Error> for Failure {
    fn from(_: io::Error) -> Self {
        Self::Closed
    }
}

impl Request {
    /// Reads the next request; `rest` has bytes that were read after the request before.
    ///
    /// # Errors
    /// `Closed` at the end of the connection, `Refused` for what is no request or too large.
    pub fn read(stream: &mut impl Read, rest: &mut Vec<u8>) -> Result<Self, Failure> {
        let mut begin = (!rest.is_empty()).then(Instant::now);
        let mut is_overdue = || begin.get_or_insert_with(Instant::now).elapsed() > MAX_TIME;
        let (mut request, head_length, body_length) = loop {
            if let Some(parsed) = parse(rest)? {
                break parsed;
            }
            if rest.len() >= MAX_HEAD {
                return Err(Failure::Refused(431, "the head of the request is too large"));
            }
            read_some(stream, rest)?;
            if is_overdue() {
                return Err(Failure::Refused(408, "the request is too slow"));
            }
        };
        while rest.len() < head_length + body_length {
            read_some(stream, rest)?;
            if is_overdue() {
                return Err(Failure::Refused(408, "the request is too slow"));
            }
        }
        request.body = rest[head_length..head_length + body_length].to_vec();
        rest.drain(..head_length + body_length);
        Ok(request)
    }

    /// Returns the value of a header by its name in lower case.
    pub fn header(&self, name: &str) -> Option<&str> {
        self.headers.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str())
    }

    /// Returns the value of a key in the query.
    pub fn in_query(&self, key: &str) -> Option<&str> {
        self.query.split('&').find_map(|pair| pair.strip_prefix(key)?.strip_prefix('='))
    }
}

fn read_some(stream: &mut impl Read, rest: &mut Vec<u8>) -> Result<(), Failure> {
    let mut buffer = [0; 4096];
    match stream.read(&mut buffer)? {
        0 => Err(Failure::Closed),
        count => {
            rest.extend_from_slice(&buffer[..count]);
            Ok(())
        }
    }
}

/// Parses a head and returns the request, the length of the head and that of the body; `None` while the head is incomplete.
fn parse(bytes: &[u8]) -> Result<Option<(Request, usize, usize)>, Failure> {
    let mut headers = [httparse::EMPTY_HEADER; MAX_HEADERS];
    let mut parsed = httparse::Request::new(&mut headers);
    let length = match parsed.parse(bytes) {
        Ok(httparse::Status::Complete(length)) if length <= MAX_HEAD => length,
        Ok(httparse::Status::Complete(_)) | Err(httparse::Error::TooManyHeaders) => {
            return Err(Failure::Refused(431, "the head of the request is too large"));
        }
        Ok(httparse::Status::Partial) => return Ok(None),
        Err(_) => return Err(Failure::Refused(400, "this is no request of HTTP")),
    };
    let target = parsed.path.unwrap_or_default();
    let (path, query) = target.split_once('?').unwrap_or((target, ""));
    let lower = |header: &httparse::Header<'_>| {
        (header.name.to_ascii_lowercase(), String::from_utf8_lossy(header.value).trim().to_owned())
    };
    let request = Request {
        method: parsed.method.unwrap_or_default().to_owned(),
        path: path.to_owned(),
        query: query.to_owned(),
        headers: parsed.headers.iter().map(lower).collect(),
        body: Vec::new(),
    };
    let is_repeated = |name: &str| request.headers.iter().filter(|(known, _)| known == name).count() > 1;
    if request.header("transfer-encoding").is_some() || is_repeated("content-length") || is_repeated("host") {
        return Err(Failure::Refused(400, "the request has an ambiguous length or host"));
    }
    let body = match request.header("content-length").map(str::parse::<usize>) {
        None => 0,
        Some(Ok(length)) if length <= MAX_BODY => length,
        Some(Ok(_)) => return Err(Failure::Refused(413, "the body of the request is too large")),
        Some(Err(_)) => return Err(Failure::Refused(400, "the length of the body is no number")),
    };
    Ok(Some((request, length, body)))
}
