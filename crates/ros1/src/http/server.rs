//! XML-RPC server on one connection.

use std::io::{BufRead, BufReader, Write};
use std::net::TcpStream;
use std::sync::Mutex;
use std::time::Duration;

use opendr_engine::{ErrorKind, Result};

use super::read_message;
use crate::ParameterValue;
use crate::connection::Timed;
use crate::lock::lock;
use crate::xml_rpc::{Fault, call_from_xml, xml_from_fault, xml_from_response};

/// Time after which a connection without a call is closed.
const IDLE_TIME: Duration = Duration::from_secs(60);

/// Lock that allows one call to be read at a time, since a parsed call takes many times its length.
static READING: Mutex<()> = Mutex::new(());

/// Time limit of receiving a call.
const CALL_TIME: Duration = Duration::from_secs(10);

/// Serves calls from `stream` with `answer` until the peer disconnects.
///
/// # Errors
/// The error of an invalid request, which the peer also receives as an HTTP status.
pub(crate) fn serve_connection(
    stream: &TcpStream,
    answer: impl Fn(&str, Vec<ParameterValue>) -> Result<ParameterValue, Fault>,
) -> Result<()> {
    stream.set_write_timeout(Some(CALL_TIME))?;
    let mut reader = BufReader::new(Timed::new(stream, IDLE_TIME));
    loop {
        reader.get_mut().extend(IDLE_TIME);
        if !matches!(reader.fill_buf(), Ok([_, ..])) {
            return Ok(());
        }
        reader.get_mut().extend(CALL_TIME);
        let request = match read_message(&mut reader) {
            Ok(Some(request)) => request,
            Ok(None) => return Ok(()),
            Err(error) => {
                if error.kind() == ErrorKind::Format {
                    respond(stream, "400 Bad Request", &error.to_string(), false)?;
                }
                return Err(error);
            }
        };
        if !request.first_line.starts_with("POST ") {
            return respond(stream, "405 Method Not Allowed", "send XML-RPC by POST", false);
        }
        let reading = lock(&READING);
        let call = call_from_xml(&request.body);
        drop(reading);
        let body = match call {
            Ok(call) => match answer(&call.method, call.params) {
                Ok(value) => {
                    xml_from_response(&value).unwrap_or_else(|error| xml_from_fault(1, &error.to_string()))
                }
                Err(fault) => xml_from_fault(fault.code, &fault.text),
            },
            Err(error) => xml_from_fault(-32700, &error.to_string()),
        };
        respond(stream, "200 OK", &body, request.stays_open)?;
        if !request.stays_open {
            return Ok(());
        }
    }
}

fn respond(mut stream: &TcpStream, status: &str, body: &str, stays_open: bool) -> Result<()> {
    let connection = if stays_open { "keep-alive" } else { "close" };
    let response = format!(
        "HTTP/1.1 {status}\r\nServer: opendr\r\nConnection: {connection}\r\nContent-Type: text/xml\r\n\
         Content-Length: {}\r\n\r\n{body}",
        body.len()
    );
    Ok(stream.write_all(response.as_bytes())?)
}
