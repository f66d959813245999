//! An item that a viewer displays.

use opendr_engine::Value;

/// An input with its predictions.
#[derive(Debug)]
pub struct Shown {
    /// File or device of the input.
    pub name: String,
    /// Index within its file.
    pub index: u64,
    /// Input of the learner.
    pub input: Value,
    /// Outputs of the learner, by name.
    pub outputs: Vec<(String, Value)>,
    /// Further lines, such as the reward of a step, by name.
    pub notes: Vec<(String, String)>,
    /// Durations of the stages, in milliseconds.
    pub stages: Vec<(&'static str, f64)>,
}
