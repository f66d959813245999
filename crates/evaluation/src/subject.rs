//! The evaluated learner, as journals and outcomes name it.

use opendr_engine::learner::{AnyLearner, Entry};
use opendr_engine::params::ParamMap;
use serde::{Deserialize, Serialize};

/// The evaluated learner, as named in journals and outcomes.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Subject {
    /// Name of the learner, with its variant.
    pub learner: String,
    /// Path of the model container, if it is the user's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub model: Option<String>,
    /// Parameters of the learner.
    pub params: ParamMap,
}

impl Subject {
    /// Returns the subject of a learner with its parameters and a model of the zoo, or none.
    pub fn of(entry: &Entry, learner: &dyn AnyLearner) -> Self {
        Self { learner: entry.spec.name.to_owned(), model: None, params: learner.params() }
    }
}
