//! New trials.

use serde_json::{Map, Value};

use crate::Timestamp;
use crate::records::{Suggestion, TrialState};

/// The initial content of a trial.
#[derive(Debug, Clone, PartialEq)]
pub struct NewTrial {
    pub state: TrialState,
    pub params: Vec<(String, Suggestion)>,
    pub values: Vec<f64>,
    pub reports: Vec<(i64, f64)>,
    pub user_attributes: Map<String, Value>,
    pub system_attributes: Map<String, Value>,
    pub started: Option<Timestamp>,
    pub ended: Option<Timestamp>,
}

impl NewTrial {
    /// Creates an empty trial in this state.
    pub fn new(state: TrialState) -> Self {
        let started = (state == TrialState::Running).then(Timestamp::now);
        let (user_attributes, system_attributes) = (Map::new(), Map::new());
        let (params, values, reports) = (Vec::new(), Vec::new(), Vec::new());
        Self { state, params, values, reports, user_attributes, system_attributes, started, ended: None }
    }
}
