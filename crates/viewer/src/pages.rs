//! Files of the page.

use crate::response::Response;

/// Returns the file at a path.
pub fn page(path: &str) -> Option<Response> {
    let (media_type, text) = match path {
        "/" => ("text/html; charset=utf-8", include_str!("page/index.html")),
        "/viewer.css" => ("text/css; charset=utf-8", include_str!("page/viewer.css")),
        "/viewer.js" => ("text/javascript; charset=utf-8", include_str!("page/viewer.js")),
        "/cloud.js" => ("text/javascript; charset=utf-8", include_str!("page/cloud.js")),
        "/plots.js" => ("text/javascript; charset=utf-8", include_str!("page/plots.js")),
        "/icon.svg" => ("image/svg+xml", include_str!("page/icon.svg")),
        _ => return None,
    };
    Some(Response::new(media_type, text.as_bytes()))
}
