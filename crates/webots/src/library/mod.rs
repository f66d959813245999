//! A link through the `libController` of the user's Webots, loaded at run time: it always fits that version.

mod functions;
mod link;
mod supervisor;

pub use link::LibraryLink;
