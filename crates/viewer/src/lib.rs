//! A local web page of a learner's inputs and predictions, its latencies and the curves of a training.
//!
//! [`Viewer`] serves the page from threads of its own. [`Viewer::show`] replaces the item that the page displays; drawing and encoding
//! happen when a page asks for the item, so that inference never waits for a page, and a slow page skips items.
//! The page reads; it changes live parameters only if [`ViewerOptions::is_writable`] is set.
//!
//! ```
//! use opendr_viewer::{Viewer, ViewerOptions};
//!
//! let viewer = Viewer::bind("127.0.0.1:0".parse()?, ViewerOptions::default())?;
//! assert!(viewer.url().starts_with("http://127.0.0.1:"));
//! # Ok::<_, Box<dyn std::error::Error>>(())
//! ```

mod access;
mod body;
mod feed;
mod memory;
mod options;
mod pages;
mod request;
mod response;
mod routes;
mod server;
mod settings;
mod shown;

#[cfg(test)]
mod tests;

pub use options::{Curve, CurveSource, ViewerOptions};
pub use server::Viewer;
pub use shown::Shown;
