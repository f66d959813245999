//! Responses of the viewer by method and path.

use std::time::Duration;

use opendr_engine::params::ParamValue;
use serde::Deserialize;
use serde_json::json;

use crate::access::Access;
use crate::feed::Feed;
use crate::pages;
use crate::request::Request;
use crate::response::Response;
use crate::settings::Settings;
use crate::{Curve, CurveSource};

/// Maximum time that a request waits for the next item.
const PATIENCE: Duration = Duration::from_secs(5);
/// Maximum number of points of a curve.
const MAX_CURVE: usize = 1000;

/// What all connections share.
#[derive(Debug)]
pub struct Shared {
    pub title: String,
    pub access: Access,
    pub feed: Feed,
    pub settings: Settings,
    pub is_writable: bool,
    pub curves: Option<CurveSource>,
}

/// A change of a parameter.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Change {
    name: String,
    value: ParamValue,
}

impl Shared {
    /// Returns the response to a request.
    pub fn response(&self, request: &Request) -> Response {
        if let Err(reason) = self.access.check(request) {
            return Response::refusal(403, reason);
        }
        let is_read = ["GET", "HEAD"].contains(&request.method.as_str());
        if let Some(page) = pages::page(&request.path) {
            return if is_read { page } else { Response::refusal(405, "pages are read") };
        }
        if let Err(reason) = self.access.check_token(request) {
            return Response::refusal(403, reason);
        }
        match (request.path.as_str(), is_read) {
            ("/api/state", true) => self.state(),
            ("/api/next", true) => self.next(request),
            ("/api/curves", true) => self.curves(),
            ("/api/params", false) if request.method == "POST" => self.change(request),
            ("/api/state" | "/api/next" | "/api/curves" | "/api/params", _) => {
                Response::refusal(405, "this method does not exist here")
            }
            _ => Response::refusal(404, "there is no such page"),
        }
    }

    fn state(&self) -> Response {
        let (params, failure) = self.settings.to_json();
        Response::json(&json!({
            "title": self.title,
            "is_writable": self.is_writable,
            "has_curves": self.curves.is_some(),
            "params": params,
            "failure": failure,
        }))
    }

    fn next(&self, request: &Request) -> Response {
        let Ok(after) = request.in_query("after").unwrap_or("0").parse() else {
            return Response::refusal(400, "after is no number");
        };
        let is_drawn = request.in_query("plain").is_none();
        match self.feed.next_after(after, PATIENCE) {
            Some(item) => Response::new("application/octet-stream", item.bytes(is_drawn)),
            None => Response::nothing(),
        }
    }

    fn curves(&self) -> Response {
        let Some(CurveSource { unit, read }) = &self.curves else {
            return Response::refusal(404, "there is no training");
        };
        match read() {
            Ok(curves) => {
                let curves: Vec<_> = curves.into_iter().map(thinned).collect();
                Response::json(&json!({ "unit": unit, "curves": curves }))
            }
            Err(error) => Response::refusal(503, &error.to_string()),
        }
    }

    fn change(&self, request: &Request) -> Response {
        if !self.is_writable {
            return Response::refusal(403, "the page only reads; start the program with --view-write");
        }
        // A form of another page could send text, but not JSON.
        if request.header("content-type") != Some("application/json") {
            return Response::refusal(400, "a change of a parameter is JSON");
        }
        let change = serde_json::from_slice::<Change>(&request.body).map_err(|error| error.to_string());
        let done = change.and_then(|Change { name, value }| {
            self.settings.request(&name, value).map_err(|error| error.to_string())
        });
        match done {
            Ok(()) => Response::nothing(),
            Err(text) => Response::refusal(400, &text),
        }
    }
}

/// Returns a curve as JSON, with every second, third, ... point and the last one where there are too many.
fn thinned(curve: Curve) -> serde_json::Value {
    let step = curve.points.len().div_ceil(MAX_CURVE).max(1);
    let last = curve.points.len().saturating_sub(1);
    let kept = curve.points.iter().enumerate().filter(|(index, _)| index % step == 0 || *index == last);
    let points: Vec<_> = kept.map(|(_, point)| point).collect();
    json!({ "name": curve.name, "points": points, "is_scatter": curve.is_scatter })
}
