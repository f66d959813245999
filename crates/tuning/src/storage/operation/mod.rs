//! Operations of a storage: the lines of Optuna's journal.

mod code;
mod field;
mod from_json;
mod new_trial;
mod to_json;

use serde_json::Value;

use crate::Timestamp;
use crate::records::{Direction, Suggestion, TrialState};

pub use from_json::checked_suggestion;
pub use new_trial::NewTrial;

/// Kind of an attribute.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Notes {
    User,
    System,
}

/// One operation. Studies and trials are identified by their numbers in the storage, counted from 0 in order of creation.
#[derive(Debug, Clone, PartialEq)]
pub enum Operation {
    CreateStudy {
        name: String,
        directions: Vec<Direction>,
    },
    DeleteStudy {
        study: usize,
    },
    NoteOfStudy {
        study: usize,
        notes: Notes,
        key: String,
        value: Value,
    },
    CreateTrial {
        study: usize,
        trial: Box<NewTrial>,
    },
    SetParam {
        trial: usize,
        name: String,
        suggestion: Suggestion,
    },
    SetState {
        trial: usize,
        state: TrialState,
        values: Vec<f64>,
        at: Timestamp,
    },
    Report {
        trial: usize,
        step: i64,
        value: f64,
    },
    NoteOfTrial {
        trial: usize,
        notes: Notes,
        key: String,
        value: Value,
    },
    /// Of another program (code 10), without effect in Optuna, too.
    Ignored,
}
