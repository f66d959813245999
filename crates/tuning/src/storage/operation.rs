//! One change of a storage: a line of Optuna's journal.

use serde_json::{Map, Value};

use crate::Timestamp;
use crate::records::{Direction, Suggestion, TrialState};
use crate::storage::distribution_json::{distribution_from_json, json_from_distribution};
use crate::storage::python_json::{number_from_value, value_from_number};
use opendr_engine::{Error, Result};

/// What a trial is when it begins.
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
    /// A trial in this state, without anything.
    pub fn new(state: TrialState) -> Self {
        let started = (state == TrialState::Running).then(Timestamp::now);
        let (user_attributes, system_attributes) = (Map::new(), Map::new());
        let (params, values, reports) = (Vec::new(), Vec::new(), Vec::new());
        Self { state, params, values, reports, user_attributes, system_attributes, started, ended: None }
    }
}

/// Whose notes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Notes {
    User,
    System,
}

/// One change. Studies and trials are named by their numbers in the storage, counted from 0 in the order of creation.
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

impl Operation {
    /// As a line of the journal says it, and who did it.
    pub fn from_json(line: &Value) -> Result<(Self, String)> {
        let fields = Fields(line.as_object().ok_or_else(|| Error::format("a line is no JSON object"))?);
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
            4 => Self::CreateTrial { study: fields.index("study_id")?, trial: Box::new(fields.new_trial()?) },
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
                let what = format!("op_code {code} is unknown; a newer program may have written it");
                return Err(Error::format(what));
            }
        };
        Ok((operation, fields.text("worker_id")?))
    }

    /// As a line of the journal says it.
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

/// The fields of a line.
struct Fields<'a>(&'a Map<String, Value>);

impl Fields<'_> {
    fn read<T>(&self, key: &str, what: &str, read: impl FnOnce(&Value) -> Option<T>) -> Result<T> {
        let value = self.0.get(key).ok_or_else(|| Error::format(format!("no field {key:?}")))?;
        read(value).ok_or_else(|| Error::format(format!("{key} is no {what}")))
    }

    fn text(&self, key: &str) -> Result<String> {
        self.read(key, "text", |value| value.as_str().map(str::to_owned))
    }

    fn whole(&self, key: &str) -> Result<i64> {
        self.read(key, "whole number", Value::as_i64)
    }

    fn index(&self, key: &str) -> Result<usize> {
        self.read(key, "number from 0", |value| usize::try_from(value.as_u64()?).ok())
    }

    fn number(&self, key: &str) -> Result<f64> {
        self.read(key, "number", number_from_value)
    }

    fn list(&self, key: &str) -> Result<&Vec<Value>> {
        let value = self.0.get(key).and_then(Value::as_array);
        value.ok_or_else(|| Error::format(format!("{key} is no list")))
    }

    /// The numbers of a list; none where there is no list.
    fn numbers(&self, key: &str) -> Result<Vec<f64>> {
        match self.0.get(key) {
            None | Some(Value::Null) => Ok(Vec::new()),
            Some(_) => {
                let number = |value| {
                    number_from_value(value).ok_or_else(|| Error::format(format!("{key} holds {value}")))
                };
                self.list(key)?.iter().map(number).collect()
            }
        }
    }

    /// The fields of an object; none where there is no object.
    fn object(&self, key: &str) -> Result<Map<String, Value>> {
        match self.0.get(key) {
            None => Ok(Map::new()),
            Some(Value::Object(map)) => Ok(map.clone()),
            Some(_) => Err(Error::format(format!("{key} is no object"))),
        }
    }

    fn moment(&self, key: &str) -> Result<Option<Timestamp>> {
        match self.0.get(key) {
            None | Some(Value::Null) => Ok(None),
            Some(_) => self.read(key, "moment", |value| Timestamp::parse(value.as_str()?)).map(Some),
        }
    }

    fn note(&self, key: &str) -> Result<(String, Value)> {
        let mut notes = self.object(key)?.into_iter();
        match (notes.next(), notes.next()) {
            (Some(note), None) => Ok(note),
            _ => Err(Error::format(format!("{key} should hold one note"))),
        }
    }

    fn new_trial(&self) -> Result<NewTrial> {
        let state =
            self.0.get("state").map_or(Ok(TrialState::Running), |_| state_from_code(self.whole("state")?))?;
        let mut values = self.numbers("values")?;
        if let Some(value) = self.0.get("value").and_then(number_from_value) {
            values = vec![value];
        }
        let distributions = self.object("distributions")?;
        let mut params = Vec::new();
        for (name, number) in self.object("params")? {
            let (Some(text), Some(number)) =
                (distributions.get(&name).and_then(Value::as_str), number_from_value(&number))
            else {
                return Err(Error::format(format!("parameter {name:?} has no number or no distribution")));
            };
            params.push((name, checked_suggestion(distribution_from_json(text)?, number)?));
        }
        let mut reports = Vec::new();
        for (step, value) in self.object("intermediate_values")? {
            let report = step.parse().ok().zip(number_from_value(&value));
            reports.push(report.ok_or_else(|| Error::format(format!("intermediate value {step}: {value}")))?);
        }
        let (user_attributes, system_attributes) = (self.object("user_attrs")?, self.object("system_attrs")?);
        let (started, ended) = (self.moment("datetime_start")?, self.moment("datetime_complete")?);
        Ok(NewTrial { state, params, values, reports, user_attributes, system_attributes, started, ended })
    }
}

/// A parameter from a file, whose number must mean something.
pub fn checked_suggestion(distribution: crate::Distribution, number: f64) -> Result<Suggestion> {
    match distribution.value_from_number(number) {
        Some(_) => Ok(Suggestion { distribution, number }),
        None => Err(Error::format(format!("{number} is no value of {distribution}"))),
    }
}

fn json_from_numbers(numbers: &[f64]) -> Value {
    if numbers.is_empty() {
        Value::Null
    } else {
        numbers.iter().map(|number| value_from_number(*number)).collect()
    }
}

fn direction_from_json(code: &Value) -> Result<Direction> {
    match code.as_i64() {
        // Not set, in Optuna: to be minimised.
        Some(0 | 1) => Ok(Direction::Minimize),
        Some(2) => Ok(Direction::Maximize),
        _ => Err(Error::format(format!("{code} is no direction: 1 is to minimise, 2 to maximise"))),
    }
}

fn code_from_direction(direction: Direction) -> i64 {
    match direction {
        Direction::Minimize => 1,
        Direction::Maximize => 2,
    }
}

fn state_from_code(code: i64) -> Result<TrialState> {
    Ok(match code {
        0 => TrialState::Running,
        1 => TrialState::Complete,
        2 => TrialState::Pruned,
        3 => TrialState::Failed,
        4 => TrialState::Waiting,
        _ => return Err(Error::format(format!("{code} is no state of a trial: 0 to 4"))),
    })
}

fn code_from_state(state: TrialState) -> i64 {
    match state {
        TrialState::Running => 0,
        TrialState::Complete => 1,
        TrialState::Pruned => 2,
        TrialState::Failed => 3,
        TrialState::Waiting => 4,
    }
}
