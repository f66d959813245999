//! Calling a master or node.

use std::io::{BufReader, Write};
use std::time::Duration;

use opendr_engine::{Error, Result, ResultExt};

use super::uri::host_in_uri;
use super::{HttpUri, read_message};
use crate::ParameterValue;
use crate::connection::{Timed, connect};
use crate::xml_rpc::{response_from_xml, xml_from_call};

/// Calls `method` of the server at `uri`, which has `time` to be connected to and as much again to answer.
///
/// # Errors
/// `Network` when the peer does not answer, `Format` when it answers something else, `Unsupported` for a
/// fault.
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
    (&mut &stream)
        .write_all(request.as_bytes())
        .map_err(|error| Error::network("the peer broke off while it was being asked").with_source(error))?;
    let response = read_message(&mut BufReader::new(Timed::new(&stream, time)))?
        .ok_or_else(|| Error::network("the peer closed the connection without an answer"))?;
    if response.first_line.split(' ').nth(1) != Some("200") {
        return Err(Error::network(format!("the peer answered {:.80?}", response.first_line)));
    }
    response_from_xml(&response.body)?.map_err(|fault| {
        Error::unsupported(format!("the peer told of fault {}: {:.500}", fault.code, fault.text))
    })
}
