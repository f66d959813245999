//! Services of the node.

use std::io::{BufReader, Write};
use std::net::TcpStream;
use std::sync::atomic::{AtomicU64, Ordering};

use opendr_engine::{Error, Result};

use crate::ServiceType;
use crate::context::Context;
use crate::tcpros::{Header, read_body, read_length, write_frame};
use crate::types::agree;

/// Handler of requests; returns the response or an error message.
pub(crate) type Handler = Box<dyn Fn(&[u8]) -> Result<Vec<u8>, String> + Send + Sync>;

/// A service of the node, with its statistics for getBusStats.
pub(crate) struct Service {
    pub name: String,
    pub kind: ServiceType,
    pub handler: Handler,
    pub requests: AtomicU64,
    pub received_bytes: AtomicU64,
    pub sent_bytes: AtomicU64,
}

impl Service {
    pub fn new(name: &str, kind: ServiceType, handler: Handler) -> Self {
        let zero = || AtomicU64::new(0);
        Self {
            name: name.to_owned(),
            kind,
            handler,
            requests: zero(),
            received_bytes: zero(),
            sent_bytes: zero(),
        }
    }

    /// Registers the service with the master.
    pub fn register(&self, context: &Context) -> Result<()> {
        let params =
            [self.name.as_str().into(), context.service_uri().into(), context.api_uri.as_str().into()];
        context.register("registerService", &params).map(|_| ())
    }

    /// Serves the client that sent `header`: once, or until it disconnects if it requested a persistent connection.
    pub fn serve(&self, context: &Context, header: &Header, stream: &TcpStream) -> Result<()> {
        let sum = header.need("md5sum")?;
        if !agree(sum, &self.kind.md5sum) {
            let error = Error::invalid_input(format!(
                "{} requested service {} with md5 sum {sum:.40}, but its type is {} with {}; build \
                 both against the same definition",
                header.get("callerid").unwrap_or("a client"),
                self.name,
                self.kind.name,
                self.kind.md5sum
            ));
            Header::error(&error.to_string()).write(stream)?;
            return Err(error);
        }
        Header::new([
            ("callerid", context.names.node()),
            ("service", &self.name),
            ("type", &self.kind.name),
            ("md5sum", &self.kind.md5sum),
            ("request_type", &self.kind.request_type),
            ("response_type", &self.kind.response_type),
        ])
        .write(stream)?;
        if header.get("probe") == Some("1") {
            return Ok(());
        }
        stream.set_read_timeout(None)?;
        stream.set_write_timeout(None)?;
        let mut reader = BufReader::new(stream);
        let mut request = Vec::new();
        while let Some(length) = read_length(&mut reader)? {
            if length as usize > context.max_message_bytes {
                let text = format!(
                    "the request has {length} bytes; at most {} are allowed",
                    context.max_message_bytes
                );
                write_frame(&mut &*stream, &[0], text.as_bytes())?;
                return Err(Error::format(text).context(format!("serving {}", self.name)));
            }
            read_body(&mut reader, length as usize, &mut request)?;
            self.answer(context, &request, stream)?;
            if header.get("persistent") != Some("1") {
                break;
            }
        }
        Ok(())
    }

    fn answer(&self, context: &Context, request: &[u8], mut stream: &TcpStream) -> Result<()> {
        let answer = context.guarded(&format!("the handler of {}", self.name), || (self.handler)(request));
        let answer = answer.unwrap_or_else(|| Err("the handler panicked".to_owned()));
        let (code, body) = match &answer {
            Ok(response) => (1, response.as_slice()),
            Err(text) => (0, text.as_bytes()),
        };
        self.requests.fetch_add(1, Ordering::Relaxed);
        self.received_bytes.fetch_add(request.len() as u64 + 4, Ordering::Relaxed);
        self.sent_bytes.fetch_add(body.len() as u64 + 5, Ordering::Relaxed);
        write_frame(&mut stream, &[code], body)?;
        Ok(stream.flush()?)
    }
}
