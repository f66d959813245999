//! What a viewer displays besides items.

use std::path::PathBuf;

use opendr_engine::params::{Field, ParamMap};

/// Options of a viewer.
#[derive(Debug, Clone, Default)]
pub struct ViewerOptions {
    /// Title of the page, such as the name of the learner.
    pub title: String,
    /// Parameters of the learner; those that are live are displayed.
    pub params: &'static [Field],
    /// Values of the parameters; defaults for those that are absent.
    pub values: ParamMap,
    /// Whether the page can change live parameters.
    pub is_writable: bool,
    /// Folder of a training's log, whose curves are displayed.
    pub log: Option<PathBuf>,
}
