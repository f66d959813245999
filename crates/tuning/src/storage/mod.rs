//! Where studies are kept.

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

/// Where studies are kept: in memory, or in a file that Optuna's `JournalStorage` reads and goes on with, and the other
/// way round. Several processes, Optuna's among them, may work on one file at a time.
#[derive(Debug)]
pub struct Storage {
    replay: Replay,
    journal: Option<Journal>,
    worker: String,
}

impl Storage {
    /// Studies that end with the process.
    pub fn memory() -> Self {
        Self { replay: Replay::default(), journal: None, worker: worker::this_worker() }
    }

    /// Studies in Optuna's journal at `path`, which is made when there is none.
    ///
    /// # Errors
    /// `Io` when the file can be neither read nor made; `Format` with the line when it is no journal.
    pub fn journal(path: impl AsRef<Path>) -> Result<Self> {
        let mut storage = Self { journal: Some(Journal::open(path.as_ref())?), ..Self::memory() };
        storage.refresh()?;
        Ok(storage)
    }

    /// The studies of a journal's bytes, in memory.
    ///
    /// # Errors
    /// `Format` with the line that is no operation.
    pub fn from_journal_bytes(bytes: &[u8]) -> Result<Self> {
        let mut storage = Self::memory();
        journal::read_text(bytes, |operation, worker| storage.replay.apply(operation, worker))?;
        Ok(storage)
    }

    /// The studies of Optuna's SQLite file, in memory. To go on with one, [`copy_study`](Storage::copy_study) it.
    ///
    /// # Errors
    /// `Io` or `NotFound` when the file cannot be read, `Unsupported` while another program writes it or its schema is not
    /// version 12, `Format` when it is damaged.
    pub fn sqlite(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        sqlite::bytes_from_file(path)
            .and_then(|bytes| Self::from_sqlite_bytes(&bytes))
            .context(|| format!("reading {}", path.display()))
    }

    /// The studies of the bytes of Optuna's SQLite file, in memory.
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

    /// The studies.
    pub fn studies(&self) -> impl Iterator<Item = &StudyRecord> {
        self.replay.studies().map(|(_, study)| study)
    }

    /// Copies a study with its trials to the end of another storage.
    ///
    /// # Errors
    /// `NotFound` when there is no study called `name`; `InvalidParam` when there is one in the other storage; `Io`.
    pub fn copy_study(&self, name: &str, other: &mut Self) -> Result<()> {
        let study = self.studies().find(|study| study.name == name).ok_or_else(|| self.no_study(name))?;
        other.transact(|replay, _| {
            if replay.studies().any(|(_, known)| known.name == name) {
                return Err(Error::invalid_param(format!(
                    "there is a study {name:?} already; delete it or copy elsewhere"
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

    /// Reads what others have written.
    pub(crate) fn refresh(&mut self) -> Result<()> {
        let replay = &mut self.replay;
        self.journal
            .as_mut()
            .map_or(Ok(()), |journal| journal.read_new(|operation, worker| replay.apply(operation, worker)))
    }

    /// Lets `decide` look at the newest state and write, while nobody else does.
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
            true => format!("no study {name:?}; there are none"),
            false => format!("no study {name:?}; there are {}", names.join(", ")),
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
