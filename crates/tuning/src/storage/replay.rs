//! State of studies after a list of operations.

use std::collections::BTreeMap;

use crate::records::{StudyRecord, TrialRecord, TrialState};
use crate::storage::operation::{NewTrial, Notes, Operation};

/// Studies after their operations. Invalid operations, such as changes of finished or missing trials, have no
/// effect, as in Optuna: if two workers try the same, the first in the file wins.
#[derive(Debug, Default)]
pub struct Replay {
    studies: BTreeMap<usize, StudyRecord>,
    created_studies: usize,
    /// Study and number of every trial, indexed by its number in the storage.
    places: Vec<(usize, usize)>,
}

impl Replay {
    pub fn studies(&self) -> impl Iterator<Item = (usize, &StudyRecord)> {
        self.studies.iter().map(|(id, study)| (*id, study))
    }

    pub fn study(&self, id: usize) -> Option<&StudyRecord> {
        self.studies.get(&id)
    }

    /// Returns the number of studies created so far, which is the number of the next one.
    pub fn created_studies(&self) -> usize {
        self.created_studies
    }

    /// Returns the number of the next trial in the storage.
    pub fn next_trial(&self) -> usize {
        self.places.len()
    }

    pub fn apply(&mut self, operation: Operation, worker: &str) {
        match operation {
            Operation::CreateStudy { name, directions } => {
                if self.studies.values().any(|study| study.name == name) {
                    return;
                }
                let (trials, user_attributes, system_attributes) = Default::default();
                let study = StudyRecord { name, directions, trials, user_attributes, system_attributes };
                self.studies.insert(self.created_studies, study);
                self.created_studies += 1;
            }
            Operation::DeleteStudy { study } => {
                self.studies.remove(&study);
            }
            Operation::NoteOfStudy { study, notes, key, value } => {
                let Some(study) = self.studies.get_mut(&study) else { return };
                match notes {
                    Notes::User => study.user_attributes.insert(key, value),
                    Notes::System => study.system_attributes.insert(key, value),
                };
            }
            Operation::CreateTrial { study, trial } => self.create_trial(study, *trial, worker),
            Operation::SetParam { trial, name, suggestion } => {
                let Some(&(study, _)) = self.places.get(trial) else { return };
                let trials = self.studies.get(&study).map_or(&[][..], |study| &study.trials);
                let known = trials.iter().find_map(|trial| trial.params.get(&name));
                if known.is_some_and(|known| !known.distribution.is_compatible(&suggestion.distribution)) {
                    return;
                }
                if let Some(trial) = self.unfinished(trial) {
                    trial.params.insert(name, suggestion);
                }
            }
            Operation::SetState { trial, state, values, at } => {
                let Some(trial) = self.unfinished(trial) else { return };
                match state {
                    // The trial belongs to the first worker.
                    TrialState::Running if trial.state == TrialState::Running => return,
                    TrialState::Running => {
                        trial.started = Some(at);
                        trial.worker = worker.to_owned();
                    }
                    TrialState::Waiting => {}
                    _ => trial.ended = Some(at),
                }
                trial.state = state;
                if !values.is_empty() {
                    trial.values = values;
                }
            }
            Operation::Report { trial, step, value } => {
                if let Some(trial) = self.unfinished(trial) {
                    trial.reports.insert(step, value);
                }
            }
            Operation::NoteOfTrial { trial, notes, key, value } => {
                let Some(trial) = self.unfinished(trial) else { return };
                match notes {
                    Notes::User => trial.user_attributes.insert(key, value),
                    Notes::System => trial.system_attributes.insert(key, value),
                };
            }
            Operation::Ignored => {}
        }
    }

    fn create_trial(&mut self, id: usize, new: NewTrial, worker: &str) {
        let Some(study) = self.studies.get_mut(&id) else { return };
        let number = study.trials.len();
        study.trials.push(TrialRecord {
            number,
            state: new.state,
            params: new.params.into_iter().collect(),
            values: new.values,
            reports: new.reports.into_iter().collect(),
            user_attributes: new.user_attributes.into_iter().collect(),
            system_attributes: new.system_attributes.into_iter().collect(),
            started: new.started,
            ended: new.ended,
            id: self.places.len(),
            worker: worker.to_owned(),
        });
        self.places.push((id, number));
    }

    fn unfinished(&mut self, trial: usize) -> Option<&mut TrialRecord> {
        let &(study, number) = self.places.get(trial)?;
        let trial = self.studies.get_mut(&study)?.trials.get_mut(number)?;
        (!trial.state.is_finished()).then_some(trial)
    }
}
