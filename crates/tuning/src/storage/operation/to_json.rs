//! Writing of journal lines.

use serde_json::{Map, Value};

use super::code::{code_from_direction, code_from_state};
use super::{NewTrial, Notes, Operation};
use crate::Timestamp;
use crate::records::{Suggestion, TrialState};
use crate::storage::distribution_json::json_from_distribution;
use crate::storage::python_json::value_from_number;

impl Operation {
    /// Returns the operation as a line of the journal.
    pub fn to_json(&self, worker: &str) -> Value {
        let mut line = Map::new();
        let mut put = |key: &str, value: Value| line.insert(key.to_owned(), value);
        put("worker_id", Value::from(worker));
        match self {
            Self::CreateStudy { name, directions } => {
                put("op_code", 0.into());
                put("study_name", name.as_str().into());
                put(
                    "directions",
                    directions.iter().map(|direction| code_from_direction(*direction)).collect(),
                );
            }
            Self::DeleteStudy { study } => {
                put("op_code", 1.into());
                put("study_id", (*study).into());
            }
            Self::NoteOfStudy { study, notes, key, value } => {
                put("op_code", if *notes == Notes::User { 2 } else { 3 }.into());
                put("study_id", (*study).into());
                put(note_key(*notes), [(key.clone(), value.clone())].into_iter().collect());
            }
            Self::CreateTrial { study, trial } => {
                put("op_code", 4.into());
                put("study_id", (*study).into());
                put_new_trial(trial, &mut put);
            }
            Self::SetParam { trial, name, suggestion } => {
                put("op_code", 5.into());
                put("trial_id", (*trial).into());
                put("param_name", name.as_str().into());
                put("param_value_internal", value_from_number(suggestion.number));
                put("distribution", json_from_distribution(&suggestion.distribution).into());
            }
            Self::SetState { trial, state, values, at } => {
                put("op_code", 6.into());
                put("trial_id", (*trial).into());
                put("state", code_from_state(*state).into());
                put("values", json_from_numbers(values));
                if *state != TrialState::Waiting {
                    let key = if state.is_finished() { "datetime_complete" } else { "datetime_start" };
                    put(key, at.to_string().into());
                }
            }
            Self::Report { trial, step, value } => {
                put("op_code", 7.into());
                put("trial_id", (*trial).into());
                put("step", (*step).into());
                put("intermediate_value", value_from_number(*value));
            }
            Self::NoteOfTrial { trial, notes, key, value } => {
                put("op_code", if *notes == Notes::User { 8 } else { 9 }.into());
                put("trial_id", (*trial).into());
                put(note_key(*notes), [(key.clone(), value.clone())].into_iter().collect());
            }
            Self::Ignored => {
                put("op_code", 10.into());
            }
        }
        Value::Object(line)
    }
}

fn note_key(notes: Notes) -> &'static str {
    if notes == Notes::User { "user_attr" } else { "system_attr" }
}

fn put_new_trial(trial: &NewTrial, put: &mut impl FnMut(&str, Value) -> Option<Value>) {
    let moment = |moment: Option<Timestamp>| moment.map_or(Value::Null, |moment| moment.to_string().into());
    put("datetime_start", moment(trial.started));
    let bare = NewTrial { started: trial.started, ..NewTrial::new(TrialState::Running) };
    if *trial == bare {
        return;
    }
    put("state", code_from_state(trial.state).into());
    let single = trial.values.len() == 1;
    put(
        "value",
        trial.values.first().filter(|_| single).map_or(Value::Null, |value| value_from_number(*value)),
    );
    put("values", if single { Value::Null } else { json_from_numbers(&trial.values) });
    if trial.ended.is_some() {
        put("datetime_complete", moment(trial.ended));
    }
    let params = || trial.params.iter();
    let distribution =
        |suggestion: &Suggestion| Value::from(json_from_distribution(&suggestion.distribution));
    put("distributions", params().map(|(name, it)| (name.clone(), distribution(it))).collect());
    put("params", params().map(|(name, it)| (name.clone(), value_from_number(it.number))).collect());
    put("user_attrs", Value::Object(trial.user_attributes.clone()));
    put("system_attrs", Value::Object(trial.system_attributes.clone()));
    let reports = trial.reports.iter().map(|(step, value)| (step.to_string(), value_from_number(*value)));
    put("intermediate_values", reports.collect());
}

fn json_from_numbers(numbers: &[f64]) -> Value {
    if numbers.is_empty() {
        Value::Null
    } else {
        numbers.iter().map(|number| value_from_number(*number)).collect()
    }
}
