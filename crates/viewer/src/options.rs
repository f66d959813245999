//! What a viewer displays besides items.

use std::fmt;

use opendr_engine::Result;
use opendr_engine::params::{Field, ParamMap};

/// Options of a viewer.
#[derive(Debug, Default)]
pub struct ViewerOptions {
    /// Title of the page, such as the name of the learner.
    pub title: String,
    /// Parameters of the learner; those that are live are displayed.
    pub params: &'static [Field],
    /// Values of the parameters; defaults for those that are absent.
    pub values: ParamMap,
    /// Whether the page can change live parameters.
    pub is_writable: bool,
    /// Curves that are displayed instead of items.
    pub curves: Option<CurveSource>,
}

/// Values over steps, or over another number.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Curve {
    /// Name, such as `train/loss`.
    pub name: String,
    /// Pairs of a step and a value.
    pub points: Vec<[f64; 2]>,
    /// Whether the points are not connected by a line.
    pub is_scatter: bool,
}

/// Curves that may grow.
pub struct CurveSource {
    /// What is counted, such as `step`.
    pub unit: &'static str,
    /// Reads the curves as they are now, every time that a page asks for them.
    pub read: Box<dyn Fn() -> Result<Vec<Curve>> + Send + Sync>,
}

impl fmt::Debug for CurveSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("CurveSource").field("unit", &self.unit).finish_non_exhaustive()
    }
}
