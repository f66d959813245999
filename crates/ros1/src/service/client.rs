//! Service clients.

use std::fmt;
use std::io::Read;
use std::net::TcpStream;
use std::sync::{Arc, Mutex};
use std::time::Duration;

use opendr_engine::{Error, Result, ResultExt};

use super::ANSWER_TIME;
use crate::ServiceType;
use crate::connection::{HANDSHAKE_TIME, Timed, connect};
use crate::context::Context;
use crate::http::HttpUri;
use crate::lock::lock;
use crate::tcpros::{Header, read_body, read_length, write_frame};
use crate::types::agree;

/// Client of one service, over a persistent connection that is renewed after a restart of the service.
pub struct ServiceClient {
    context: Arc<Context>,
    name: String,
    kind: ServiceType,
    time: Duration,
    connection: Mutex<Option<TcpStream>>,
}

impl ServiceClient {
    /// Creates a client of the service with the full name `name`.
    pub(crate) fn new(context: &Arc<Context>, name: String, kind: ServiceType) -> Self {
        Self { context: Arc::clone(context), name, kind, time: ANSWER_TIME, connection: Mutex::default() }
    }

    /// Sets the time limit of a response (default: a minute).
    #[must_use]
    pub fn with_timeout(mut self, time: Duration) -> Self {
        self.time = time;
        self
    }

    /// Sends `request` and waits for the response. Calls of several threads run one after the other.
    ///
    /// # Errors
    /// `NotFound` for an unknown service, `Network` when it does not respond in time, `InvalidInput` for another type, `Unsupported`
    /// with the service's message when it fails.
    pub fn call(&self, request: &[u8]) -> Result<Vec<u8>> {
        let mut connection = lock(&self.connection);
        let kept = connection.take().filter(is_usable);
        let asked = match kept {
            Some(stream) => Ok(stream),
            None => self.open(true),
        };
        let outcome = asked.and_then(|stream| Ok((self.ask(&stream, request)?, stream)));
        let (answer, stream) = outcome.context(|| format!("calling service {}", self.name))?;
        *connection = Some(stream);
        answer.map_err(|text| Error::unsupported(format!("service {} failed: {text:.1000}", self.name)))
    }

    pub(crate) fn call_once(&self, request: &[u8]) -> Result<Vec<u8>> {
        let answer = self.open(false).and_then(|stream| self.ask(&stream, request));
        let answer = answer.context(|| format!("calling service {}", self.name))?;
        answer.map_err(|text| Error::unsupported(format!("service {} failed: {text:.1000}", self.name)))
    }

    fn open(&self, persistent: bool) -> Result<TcpStream> {
        let stream = connect_to(&self.context, &self.name)?;
        Header::new([
            ("callerid", self.context.names.node()),
            ("service", &self.name),
            ("type", &self.kind.name),
            ("md5sum", &self.kind.md5sum),
            ("persistent", if persistent { "1" } else { "0" }),
        ])
        .write(&stream)?;
        let header = Header::read(&mut Timed::new(&stream, HANDSHAKE_TIME))?;
        if let Some(error) = header.get("error") {
            return Err(Error::invalid_input(format!("the service refused the connection: {error:.500}")));
        }
        let sum = header.get("md5sum").unwrap_or("*");
        if !agree(sum, &self.kind.md5sum) {
            return Err(Error::invalid_input(format!(
                "the service has type {} with md5 sum {sum:.40}, but this node expects {} with {}; build both against \
                 the same definition",
                header.get("type").unwrap_or("(unknown)"),
                self.kind.name,
                self.kind.md5sum
            )));
        }
        Ok(stream)
    }

    /// Returns the response, or the error message of the service.
    fn ask(&self, stream: &TcpStream, request: &[u8]) -> Result<Result<Vec<u8>, String>> {
        let broken = |error| Error::network("the service disconnected or took too long").with_source(error);
        stream.set_write_timeout(Some(self.time))?;
        write_frame(&mut &*stream, b"", request).map_err(broken)?;
        let mut reader = Timed::new(stream, self.time);
        let mut code = [0];
        reader.read_exact(&mut code).map_err(broken)?;
        let length = read_length(&mut reader).map_err(broken)?;
        let length =
            length.ok_or_else(|| Error::network("the service disconnected within its response"))? as usize;
        if length > self.context.max_message_bytes {
            return Err(Error::format(format!(
                "the response has {length} bytes; at most {} are allowed (NodeOptions::max_message_bytes)",
                self.context.max_message_bytes
            )));
        }
        let mut answer = Vec::new();
        read_body(&mut reader, length, &mut answer).map_err(broken)?;
        Ok(if code == [0] { Err(String::from_utf8_lossy(&answer).into_owned()) } else { Ok(answer) })
    }
}

impl fmt::Debug for ServiceClient {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("ServiceClient").field(&self.name).finish()
    }
}

/// Returns whether the connection is still open; an idle service sends no data.
fn is_usable(stream: &TcpStream) -> bool {
    stream.set_nonblocking(true).is_ok()
        && matches!(stream.peek(&mut [0]), Err(error) if error.kind() == std::io::ErrorKind::WouldBlock)
        && stream.set_nonblocking(false).is_ok()
}

/// Checks that the service `name` responds.
pub(crate) fn probe(context: &Context, name: &str) -> Result<()> {
    let stream = connect_to(context, name)?;
    let caller = context.names.node();
    Header::new([("callerid", caller), ("service", name), ("md5sum", "*"), ("probe", "1")]).write(&stream)?;
    Header::read(&mut Timed::new(&stream, HANDSHAKE_TIME)).map(|_| ())
}

fn connect_to(context: &Context, name: &str) -> Result<TcpStream> {
    let uri = context.master.call("lookupService", &[name.into()])?;
    let uri = uri.as_str().unwrap_or_default();
    let place = HttpUri::parse(uri, "rosrpc://")
        .ok_or_else(|| Error::format(format!("the master returned {uri:.200?}, which is not an address")))?;
    connect(&place.host, place.port, HANDSHAKE_TIME)
}
