//! Storage of studies.

mod distribution_json;
mod journal;
mod lock;
mod operation;
mod python_json;
mod replay;
mod sqlite;
mod worker;

use std::path::Path;

use opendr_engine::{Error, Result, ResultExt};

use crate::records::{StudyRecord, TrialRecord};
use journal::Journal;
pub(crate) use operation::{NewTrial, Notes, Operation};
pub(crate) use replay::Replay;
pub(crate) use worker::is_dead;

/// Storage of studies: in memory, or in a journal file that is compatible with Optuna's `JournalStorage` in both
/// directions. Several processes, including Optuna's, may use one file at a time.
#[derive(Debug)]
pub struct Storage {
    replay: Replay,
    journal: Option<Journal>,
    worker: String,
}

impl Storage {
    /// Creates a storage in memory.
    pub fn memory() -> Self {
        Self { replay: Replay::default(), journal: None, worker: worker::this_worker() }
    }

    /// Opens Optuna's journal at `path`; creates it if missing.
    ///
    /// # Errors
    /// `Io` when the file can be neither read nor created; `Format` with the line when it is not a journal.
    pub fn journal(path: impl AsRef<Path>) -> Result<Self> {
        let mut storage = Self { journal: Some(Journal::open(path.as_ref())?), ..Self::memory() };
        storage.refresh()?;
        Ok(storage)
    }

    /// Reads the studies of a journal's bytes into memory.
    ///
    /// # Errors
    /// `Format` with the invalid line.
    pub fn from_journal_bytes(bytes: &[u8]) -> Result<Self> {
        let mut storage = Self::memory();
        journal::read_text(bytes, |operation, worker| storage.replay.apply(operation, worker))?;
        Ok(storage)
    }

    /// Reads the studies of Optuna's SQLite file into memory. To continue one, [`copy_study`](Storage::copy_study) it.
    ///
    /// # Errors
    /// `Io` or `NotFound` when the file cannot be read, `Unsupported` while another program writes it or when its schema is not
    /// version 12, `Format` when it is damaged.
    pub fn sqlite(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        sqlite::bytes_from_file(path)
            .and_then(|bytes| Self::from_sqlite_bytes(&bytes))
            .context(|| format!("reading {}", path.display()))
    }

    /// Reads the studies of the bytes of Optuna's SQLite file into memory.
    ///
    /// # Errors
    /// As [`Storage::sqlite`].
    pub fn from_sqlite_bytes(bytes: &[u8]) -> Result<Self> {
        let mut storage = Self::memory();
        for operation in sqlite::operations_from_bytes(bytes)? {
            storage.replay.apply(operation, "");
        }
        Ok(storage)
    }

    /// Returns the studies.
    pub fn studies(&self) -> impl Iterator<Item = &StudyRecord> {
        self.replay.studies().map(|(_, study)| study)
    }

    /// Appends a copy of a study with its trials to another storage.
    ///
    /// # Errors
    /// `NotFound` when there is no study `name`; `InvalidParam` when the other storage has one; `Io`.
    pub fn copy_study(&self, name: &str, other: &mut Self) -> Result<()> {
        let study = self.studies().find(|study| study.name == name).ok_or_else(|| self.no_study(name))?;
        other.transact(|replay, _| {
            if replay.studies().any(|(_, known)| known.name == name) {
                return Err(Error::invalid_param(format!(
                    "the study {name:?} already exists; delete it or copy elsewhere"
                )));
            }
            let id = replay.created_studies();
            let create =
                Operation::CreateStudy { name: name.to_owned(), directions: study.directions.clone() };
            let notes = [(Notes::User, &study.user_attributes), (Notes::System, &study.system_attributes)];
            let notes = notes.into_iter().flat_map(|(notes, map)| {
                map.iter().map(move |(key, value)| Operation::NoteOfStudy {
                    study: id,
                    notes,
                    key: key.clone(),
                    value: value.clone(),
                })
            });
            let trials = study.trials.iter().map(|trial| new_trial(id, trial));
            Ok([create].into_iter().chain(notes).chain(trials).collect())
        })
    }

    /// Reads changes by other processes.
    pub(crate) fn refresh(&mut self) -> Result<()> {
        let replay = &mut self.replay;
        self.journal
            .as_mut()
            .map_or(Ok(()), |journal| journal.read_new(|operation, worker| replay.apply(operation, worker)))
    }

    /// Calls `decide` with the newest state and writes its operations, under the lock.
    pub(crate) fn transact(
        &mut self,
        decide: impl FnOnce(&Replay, &str) -> Result<Vec<Operation>>,
    ) -> Result<()> {
        let lock = self.journal.as_ref().map(Journal::lock).transpose()?;
        self.refresh()?;
        let operations = decide(&self.replay, &self.worker)?;
        match (&self.journal, &lock) {
            _ if operations.is_empty() => Ok(()),
            (Some(journal), Some(lock)) => {
                journal.append(lock, &operations, &self.worker)?;
                self.refresh()
            }
            _ => {
                operations.into_iter().for_each(|operation| self.replay.apply(operation, &self.worker));
                Ok(())
            }
        }
    }

    pub(crate) fn replay(&self) -> &Replay {
        &self.replay
    }

    fn no_study(&self, name: &str) -> Error {
        let names: Vec<_> = self.studies().map(|study| format!("{:?}", study.name)).collect();
        Error::not_found(match names.is_empty() {
            true => format!("no study {name:?}; the storage has none"),
            false => format!("no study {name:?}; available: {}", names.join(", ")),
        })
    }
}

fn new_trial(study: usize, trial: &TrialRecord) -> Operation {
    let own = |notes: &std::collections::BTreeMap<String, serde_json::Value>| {
        notes.iter().map(|(key, value)| (key.clone(), value.clone())).collect()
    };
    let new = NewTrial {
        state: trial.state,
        params: trial.params.iter().map(|(name, suggestion)| (name.clone(), suggestion.clone())).collect(),
        values: trial.values.clone(),
        reports: trial.reports.iter().map(|(step, value)| (*step, *value)).collect(),
        user_attributes: own(&trial.user_attributes),
        system_attributes: own(&trial.system_attributes),
        started: trial.started,
        ended: trial.ended,
    };
    Operation::CreateTrial { study, trial: Box::new(new) }
}

#[cfg(test)]
mod tests;
