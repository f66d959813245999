//! The master's calls, and the answers of masters and nodes: `[code, text, value]`.
//!
//! Source: <https://wiki.ros.org/ROS/Master_API>, <https://wiki.ros.org/ROS/Parameter%20Server%20API>.

use std::time::Duration;

use opendr_engine::{Error, ErrorKind, Result};

use crate::ParameterValue;
use crate::http::{HttpUri, call};

/// How long a master or node may take to answer.
pub(crate) const CALL_TIME: Duration = Duration::from_secs(5);

/// The master as one node sees it.
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
    /// `Network` when the master does not answer, `NotFound` when it says no.
    pub fn call(&self, method: &str, params: &[ParameterValue]) -> Result<ParameterValue> {
        self.call_within(method, params, CALL_TIME)
    }

    /// As [`Master::call`], with another time.
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

    /// Calls a method that answers with a list of texts.
    pub fn call_for_texts(&self, method: &str, params: &[ParameterValue]) -> Result<Vec<String>> {
        let texts = self.call(method, params)?;
        let texts =
            texts.as_list().map(|list| list.iter().map(|value| value.as_str().map(str::to_owned)).collect());
        texts
            .flatten()
            .ok_or_else(|| Error::format(format!("{method} of the master answered no list of texts")))
    }
}

/// Calls `method` of the master or node at `uri`, and takes its answer apart.
///
/// # Errors
/// `Network` when the peer does not answer, `NotFound` when it says no, `Format` for another answer.
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
                    Err(Error::not_found(format!("{method} of {uri} answered {code}: {text:.500}")))
                }
                _ => Err(Error::format(format!("{method} of {uri} answered without a code"))),
            }
        }
        _ => {
            Err(Error::format(format!("{method} of {uri} answered something else than [code, text, value]")))
        }
    }
}
