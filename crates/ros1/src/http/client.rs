//! XML-RPC calls of masters and nodes.

use std::io::{BufReader, Write};
use std::time::Duration;

use opendr_engine::{Error, Result, ResultExt};

use super::uri::host_in_uri;
use super::{HttpUri, read_message};
use crate::ParameterValue;
use crate::connection::{Timed, connect};
use crate::xml_rpc::{response_from_xml, xml_from_call};

/// Calls `method` of the server at `uri`; `time` limits the connection, and again the response.
///
/// # Errors
/// `Network` when the peer does not respond, `Format` for an invalid response, `Unsupported` for a fault.
pub(crate) fn call(
    uri: &HttpUri,
    method: &str,
    params: &[ParameterValue],
    time: Duration,
) -> Result<ParameterValue> {
    ask(uri, method, params, time).context(|| format!("calling {method} of {uri}"))
}

fn ask(uri: &HttpUri, method: &str, params: &[ParameterValue], time: Duration) -> Result<ParameterValue> {
    let body = xml_from_call(method, params)?;
    let stream = connect(&uri.host, uri.port, time)?;
    stream.set_write_timeout(Some(time))?;
    let request = format!(
        "POST /RPC2 HTTP/1.1\r\nHost: {}:{}\r\nConnection: close\r\nUser-Agent: opendr\r\n\
         Content-Type: text/xml\r\nContent-Length: {}\r\n\r\n{body}",
        host_in_uri(&uri.host),
        uri.port,
        body.len()
    );
    (&mut &stream).write_all(request.as_bytes()).map_err(|error| {
        Error::network("the peer closed the connection during the request").with_source(error)
    })?;
    let response = read_message(&mut BufReader::new(Timed::new(&stream, time)))?
        .ok_or_else(|| Error::network("the peer closed the connection without a response"))?;
    if response.first_line.split(' ').nth(1) != Some("200") {
        return Err(Error::network(format!("the peer responded {:.80?}", response.first_line)));
    }
    response_from_xml(&response.body)?.map_err(|fault| {
        Error::unsupported(format!("the peer returned fault {}: {:.500}", fault.code, fault.text))
    })
}
