//! Parsing of journal lines.

use opendr_engine::{Error, Result};
use serde_json::Value;

use super::code::{direction_from_json, state_from_code};
use super::field::Fields;
use super::{NewTrial, Notes, Operation};
use crate::records::{Suggestion, TrialState};
use crate::storage::distribution_json::distribution_from_json;
use crate::storage::python_json::number_from_value;
use crate::{Distribution, Timestamp};

impl Operation {
    /// Parses a line of the journal. Returns the operation and its worker.
    pub fn from_json(line: &Value) -> Result<(Self, String)> {
        let fields = Fields(line.as_object().ok_or_else(|| Error::format("the line is not a JSON object"))?);
        let operation = match fields.whole("op_code")? {
            0 => {
                let directions = fields.list("directions")?.iter().map(direction_from_json);
                Self::CreateStudy {
                    name: fields.text("study_name")?,
                    directions: directions.collect::<Result<_>>()?,
                }
            }
            1 => Self::DeleteStudy { study: fields.index("study_id")? },
            code @ (2 | 3) => {
                let (notes, key) =
                    if code == 2 { (Notes::User, "user_attr") } else { (Notes::System, "system_attr") };
                let (key, value) = fields.note(key)?;
                Self::NoteOfStudy { study: fields.index("study_id")?, notes, key, value }
            }
            4 => Self::CreateTrial { study: fields.index("study_id")?, trial: Box::new(new_trial(&fields)?) },
            5 => {
                let distribution = distribution_from_json(&fields.text("distribution")?)?;
                let number = fields.number("param_value_internal")?;
                let suggestion = checked_suggestion(distribution, number)?;
                Self::SetParam {
                    trial: fields.index("trial_id")?,
                    name: fields.text("param_name")?,
                    suggestion,
                }
            }
            6 => {
                let state = state_from_code(fields.whole("state")?)?;
                let at = fields.moment("datetime_complete")?.or(fields.moment("datetime_start")?);
                let at = at.unwrap_or(Timestamp(0));
                Self::SetState {
                    trial: fields.index("trial_id")?,
                    state,
                    values: fields.numbers("values")?,
                    at,
                }
            }
            7 => {
                let value = fields.number("intermediate_value")?;
                Self::Report { trial: fields.index("trial_id")?, step: fields.whole("step")?, value }
            }
            code @ (8 | 9) => {
                let (notes, key) =
                    if code == 8 { (Notes::User, "user_attr") } else { (Notes::System, "system_attr") };
                let (key, value) = fields.note(key)?;
                Self::NoteOfTrial { trial: fields.index("trial_id")?, notes, key, value }
            }
            10 => Self::Ignored,
            code => {
                let what = format!("op_code {code} is unknown; a newer program may have written the file");
                return Err(Error::format(what));
            }
        };
        Ok((operation, fields.text("worker_id")?))
    }
}

fn new_trial(fields: &Fields<'_>) -> Result<NewTrial> {
    let state = fields
        .optional("state")
        .map_or(Ok(TrialState::Running), |_| state_from_code(fields.whole("state")?))?;
    let mut values = fields.numbers("values")?;
    if let Some(value) = fields.optional("value").and_then(number_from_value) {
        values = vec![value];
    }
    let distributions = fields.object("distributions")?;
    let mut params = Vec::new();
    for (name, number) in fields.object("params")? {
        let (Some(text), Some(number)) =
            (distributions.get(&name).and_then(Value::as_str), number_from_value(&number))
        else {
            return Err(Error::format(format!("parameter {name:?} has no number or no distribution")));
        };
        params.push((name, checked_suggestion(distribution_from_json(text)?, number)?));
    }
    let mut reports = Vec::new();
    for (step, value) in fields.object("intermediate_values")? {
        let report = step.parse().ok().zip(number_from_value(&value));
        reports.push(report.ok_or_else(|| Error::format(format!("intermediate value {step}: {value}")))?);
    }
    let (user_attributes, system_attributes) = (fields.object("user_attrs")?, fields.object("system_attrs")?);
    let (started, ended) = (fields.moment("datetime_start")?, fields.moment("datetime_complete")?);
    Ok(NewTrial { state, params, values, reports, user_attributes, system_attributes, started, ended })
}

/// Creates a parameter from a file and checks that its number is in the distribution.
pub fn checked_suggestion(distribution: Distribution, number: f64) -> Result<Suggestion> {
    match distribution.value_from_number(number) {
        Some(_) => Ok(Suggestion { distribution, number }),
        None => Err(Error::format(format!("{number} is not a value of {distribution}"))),
    }
}
