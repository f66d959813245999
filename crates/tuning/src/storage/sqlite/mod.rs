//! Reading of Optuna's SQLite files.
//!
//! The file format is parsed here, since reading a few tables needs no query engine, and so no C compiler
//! on any platform.

mod columns;
mod database;
mod record;

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs;
use std::path::Path;

use opendr_engine::{Error, Result};

use crate::Timestamp;
use crate::records::{Direction, TrialState};
use crate::storage::distribution_json::distribution_from_json;
use crate::storage::operation::{NewTrial, Notes, Operation, checked_suggestion};
use crate::storage::python_json::value_from_text;
use database::{Database, Row};

/// Schema version of Optuna 3.2 to 5: Alembic's `v3.2.0.a`.
const SCHEMA: i64 = 12;

/// Reads a database that no program is writing.
pub fn bytes_from_file(path: &Path) -> Result<Vec<u8>> {
    let beside = |end: &str| {
        let mut name = OsString::from(path.as_os_str());
        name.push(end);
        fs::metadata(&name).is_ok_and(|facts| facts.len() > 0)
    };
    let bytes = fs::read(path)?;
    // Such a file contains changes that are not, or not certainly, in the database.
    match ["-journal", "-wal"].into_iter().find(|end| beside(end)) {
        None => Ok(bytes),
        Some(end) => Err(Error::unsupported(format!(
            "another program writes the database, or was killed while writing: a file ending in {end} exists; end that program, \
             or open the study once with Optuna"
        ))),
    }
}

/// Returns the operations that create the studies of a database.
pub fn operations_from_bytes(bytes: &[u8]) -> Result<Vec<Operation>> {
    let database = Database::new(bytes)?;
    let version = database.table("version_info")?.rows().map(|row| row.int("schema_version")).last();
    match version.transpose()? {
        Some(SCHEMA) => {}
        version => {
            let version = version.map_or("none".to_owned(), |version| version.to_string());
            return Err(Error::unsupported(format!(
                "the schema version is {version}, not {SCHEMA}; run \"optuna storage upgrade\" with Optuna 3.2 or later"
            )));
        }
    }
    let (studies, mut operations) = studies(&database)?;
    for (study, trial) in trials(&database)? {
        let Some(study) = studies.get(&study) else { continue };
        operations.push(Operation::CreateTrial { study: *study, trial: Box::new(trial) });
    }
    Ok(operations)
}

/// Returns the indices of studies by their ids in the database, and the operations that create them.
fn studies(database: &Database<'_>) -> Result<(BTreeMap<i64, usize>, Vec<Operation>)> {
    let mut directions: BTreeMap<i64, BTreeMap<i64, Direction>> = BTreeMap::new();
    for row in database.table("study_directions")?.rows() {
        let direction = match row.text("direction")? {
            "NOT_SET" | "MINIMIZE" => Direction::Minimize,
            "MAXIMIZE" => Direction::Maximize,
            other => return Err(Error::format(format!("{other:?} is not a direction"))),
        };
        directions.entry(row.int("study_id")?).or_default().insert(row.int("objective")?, direction);
    }
    let (mut places, mut operations) = (BTreeMap::new(), Vec::new());
    for row in database.table("studies")?.rows() {
        let id = row.int("study_id")?;
        places.insert(id, places.len());
        let directions = directions.remove(&id).unwrap_or_default().into_values().collect();
        operations.push(Operation::CreateStudy { name: row.text("study_name")?.to_owned(), directions });
    }
    for (table, notes) in [("study_user_attributes", Notes::User), ("study_system_attributes", Notes::System)]
    {
        for row in database.table(table)?.rows() {
            let Some(study) = places.get(&row.int("study_id")?) else { continue };
            let (key, value) = note(row)?;
            operations.push(Operation::NoteOfStudy { study: *study, notes, key, value });
        }
    }
    Ok((places, operations))
}

/// Returns the trials with the ids of their studies, in order of creation.
fn trials(database: &Database<'_>) -> Result<Vec<(i64, NewTrial)>> {
    let mut trials: BTreeMap<i64, (i64, NewTrial)> = BTreeMap::new();
    for row in database.table("trials")?.rows() {
        let state = match row.text("state")? {
            "RUNNING" => TrialState::Running,
            "COMPLETE" => TrialState::Complete,
            "PRUNED" => TrialState::Pruned,
            "FAIL" => TrialState::Failed,
            "WAITING" => TrialState::Waiting,
            other => return Err(Error::format(format!("{other:?} is not a state of a trial"))),
        };
        let (started, ended) = (moment(row, "datetime_start")?, moment(row, "datetime_complete")?);
        let trial = NewTrial { started, ended, ..NewTrial::new(state) };
        trials.insert(row.int("trial_id")?, (row.int("study_id")?, trial));
    }
    let mut each = |table: &str, read: &dyn Fn(Row<'_>, &mut NewTrial) -> Result<()>| {
        database.table(table)?.rows().try_for_each(|row| match trials.get_mut(&row.int("trial_id")?) {
            Some((_, trial)) => read(row, trial),
            None => Ok(()),
        })
    };
    each("trial_params", &|row, trial| {
        let distribution = distribution_from_json(row.text("distribution_json")?)?;
        let suggestion = checked_suggestion(distribution, row.number("param_value")?)?;
        trial.params.push((row.text("param_name")?.to_owned(), suggestion));
        Ok(())
    })?;
    // Rows of several values are in the order of their objectives.
    each("trial_values", &|row, trial| {
        trial.values.push(number(row, "value", "value_type")?);
        Ok(())
    })?;
    each("trial_intermediate_values", &|row, trial| {
        trial.reports.push((row.int("step")?, number(row, "intermediate_value", "intermediate_value_type")?));
        Ok(())
    })?;
    each("trial_user_attributes", &|row, trial| {
        trial.user_attributes.extend([note(row)?]);
        Ok(())
    })?;
    each("trial_system_attributes", &|row, trial| {
        trial.system_attributes.extend([note(row)?]);
        Ok(())
    })?;
    Ok(trials.into_values().collect())
}

fn moment(row: Row<'_>, column: &str) -> Result<Option<Timestamp>> {
    let wrong = |text| Error::format(format!("{column}: {text:?} is not a timestamp"));
    row.optional_text(column)?.map(|text| Timestamp::parse(text).ok_or_else(|| wrong(text))).transpose()
}

fn note(row: Row<'_>) -> Result<(String, serde_json::Value)> {
    Ok((row.text("key")?.to_owned(), value_from_text(row.text("value_json")?)?))
}

/// Reads a number; those that SQLite cannot store are words in a second column.
fn number(row: Row<'_>, value: &str, kind: &str) -> Result<f64> {
    match row.text(kind)? {
        "FINITE" => row.number(value),
        "INF_POS" => Ok(f64::INFINITY),
        "INF_NEG" => Ok(f64::NEG_INFINITY),
        "NAN" => Ok(f64::NAN),
        other => Err(Error::format(format!("{kind}: {other:?} is not a kind of number"))),
    }
}

#[cfg(test)]
mod tests;
