//! Responses of HTTP/1.1.

use std::io::{self, Write};
use std::sync::Arc;

/// Headers of every response. The page loads scripts and styles of its own only, and no other page can frame it.
const HEADERS: &str = "Cache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\n\
    Cross-Origin-Resource-Policy: same-origin\r\nContent-Security-Policy: default-src 'none'; script-src 'self'; style-src 'self'; \
    img-src 'self' blob: data:; media-src blob:; connect-src 'self'; frame-ancestors 'none'; base-uri 'none'; form-action 'none'\r\n";

/// A response.
#[derive(Debug)]
pub struct Response {
    pub status: u16,
    media_type: &'static str,
    body: Arc<[u8]>,
}

impl Response {
    /// Creates a response with a body.
    pub fn new(media_type: &'static str, body: impl Into<Arc<[u8]>>) -> Self {
        Self { status: 200, media_type, body: body.into() }
    }

    /// Creates a response of JSON.
    pub fn json(value: &serde_json::Value) -> Self {
        Self::new("application/json", value.to_string().into_bytes())
    }

    /// Creates a response without a body, for a request that has nothing new.
    pub fn nothing() -> Self {
        Self { status: 204, ..Self::new("text/plain", []) }
    }

    /// Creates a refusal.
    pub fn refusal(status: u16, text: &str) -> Self {
        Self { status, ..Self::new("text/plain; charset=utf-8", text.as_bytes()) }
    }

    /// Writes the response; `with_body` is false for HEAD, `is_last` before the connection ends.
    ///
    /// # Errors
    /// The error of the connection.
    pub fn write(&self, stream: &mut impl Write, with_body: bool, is_last: bool) -> io::Result<()> {
        let Self { status, media_type, body } = self;
        let connection = if is_last { "close" } else { "keep-alive" };
        let length = match status {
            204 => String::new(),
            _ => format!("Content-Type: {media_type}\r\nContent-Length: {}\r\n", body.len()),
        };
        let reason = reason(*status);
        let head = format!("HTTP/1.1 {status} {reason}\r\n{length}{HEADERS}Connection: {connection}\r\n\r\n");
        stream.write_all(head.as_bytes())?;
        if with_body {
            stream.write_all(body)?;
        }
        stream.flush()
    }
}

fn reason(status: u16) -> &'static str {
    match status {
        200 => "OK",
        204 => "No Content",
        400 => "Bad Request",
        403 => "Forbidden",
        404 => "Not Found",
        405 => "Method Not Allowed",
        408 => "Request Timeout",
        413 => "Content Too Large",
        431 => "Request Header Fields Too Large",
        503 => "Service Unavailable",
        _ => "Error",
    }
}
