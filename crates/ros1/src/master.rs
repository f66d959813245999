//! Calls of the master, and responses of masters and nodes: `[code, text, value]`.
//!
//! Source: <https://wiki.ros.org/ROS/Master_API>, <https://wiki.ros.org/ROS/Parameter%20Server%20API>.

use std::time::Duration;

use opendr_engine::{Error, ErrorKind, Result};

use crate::ParameterValue;
use crate::http::{HttpUri, call};

/// Time limit of a response of a master or node.
pub(crate) const CALL_TIME: Duration = Duration::from_secs(5);

/// Client of the master for one node.
#[derive(Debug)]
pub(crate) struct Master {
    pub uri: HttpUri,
    caller_id: String,
}

impl Master {
    pub fn new(uri: HttpUri, caller_id: &str) -> Self {
        Self { uri, caller_id: caller_id.to_owned() }
    }

    /// Calls `method` with the node's name and `params`.
    ///
    /// # Errors
    /// `Network` when the master does not respond, `NotFound` when it returns an error.
    pub fn call(&self, method: &str, params: &[ParameterValue]) -> Result<ParameterValue> {
        self.call_within(method, params, CALL_TIME)
    }

    /// As [`Master::call`], with another time limit.
    pub fn call_within(
        &self,
        method: &str,
        params: &[ParameterValue],
        time: Duration,
    ) -> Result<ParameterValue> {
        call_api(&self.uri, &self.caller_id, method, params, time).map_err(|error| match error.kind() {
            ErrorKind::Network => error.context("no ROS master; start roscore or set ROS_MASTER_URI"),
            _ => error,
        })
    }

    /// Calls a method that returns a list of strings.
    pub fn call_for_texts(&self, method: &str, params: &[ParameterValue]) -> Result<Vec<String>> {
        let texts = self.call(method, params)?;
        let texts =
            texts.as_list().map(|list| list.iter().map(|value| value.as_str().map(str::to_owned)).collect());
        texts
            .flatten()
            .ok_or_else(|| Error::format(format!("{method} of the master did not return a list of strings")))
    }
}

/// Calls `method` of the master or node at `uri` and returns the value of its response.
///
/// # Errors
/// `Network` when the peer does not respond, `NotFound` when it returns an error, `Format` for an invalid response.
pub(crate) fn call_api(
    uri: &HttpUri,
    caller_id: &str,
    method: &str,
    params: &[ParameterValue],
    time: Duration,
) -> Result<ParameterValue> {
    let params = [&[caller_id.into()], params].concat();
    match call(uri, method, &params, time)? {
        ParameterValue::List(mut answer) if answer.len() == 3 => {
            let value = answer.pop();
            match (answer.first().and_then(ParameterValue::as_int), answer.get(1), value) {
                (Some(1), _, Some(value)) => Ok(value),
                (Some(code), Some(text), _) => {
                    let text = text.as_str().unwrap_or("no reason given");
                    Err(Error::not_found(format!("{method} of {uri} returned {code}: {text:.500}")))
                }
                _ => Err(Error::format(format!("{method} of {uri} returned no code"))),
            }
        }
        _ => Err(Error::format(format!("{method} of {uri} did not return [code, text, value]"))),
    }
}
