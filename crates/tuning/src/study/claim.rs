//! Choice of the next trial and its parameters.

use std::collections::BTreeMap;

use opendr_engine::{Error, Result};
use serde_json::Value;

use crate::Timestamp;
use crate::distribution::Distribution;
use crate::records::{PAUSED_STATE, StudyRecord, Suggestion, TrialRecord, TrialState};
use crate::space::{Parameter, SearchSpace};
use crate::storage::{NewTrial, Notes, Operation, is_dead};
use crate::study::{FIXED, Study, Trial, check_compatible, last_sign, outcome};

impl Study {
    /// Returns the next trial: a paused one to resume, one of the queue, or a new one.
    ///
    /// # Errors
    /// `InvalidParam` when the space is incompatible with earlier trials; `Io` and `Format` of the storage.
    pub fn ask(&self, space: &SearchSpace) -> Result<Trial<'_>> {
        let trial = self.claim(space, |_| true)?;
        trial.ok_or_else(|| Error::internal("the study returned no trial, though a new one was allowed"))
    }

    /// Returns the next trial: an interrupted one, a paused one to resume, one of the queue, a new one if `may_begin`
    /// allows it, or the one to finish. Choice and parameters are written under the lock, so no two workers get
    /// the same trial, and each takes all others into account.
    pub(super) fn claim(
        &self,
        space: &SearchSpace,
        may_begin: impl FnOnce(&StudyRecord) -> bool,
    ) -> Result<Option<Trial<'_>>> {
        // Written first, so that the following decision takes dead workers into account.
        self.write(|study| Ok(self.end_abandoned(study)))?;
        let mut claimed = None;
        self.storage().transact(|replay, _| {
            let study =
                replay.study(self.id).ok_or_else(|| Error::not_found("the study has been deleted"))?;
            let mut operations = Vec::new();
            let interrupted = study.trials.iter().find(|trial| trial.is_interrupted());
            let queued =
                || study.trials.iter().find(|trial| trial.state == TrialState::Waiting && !trial.is_paused());
            let promoted = || self.pruner.promotable(study).and_then(|number| study.trials.get(number));
            let known = interrupted.or_else(promoted).or_else(queued);
            let begins = known.is_none() && may_begin(study);
            let (number, id, known) = match known.or_else(|| if begins { None } else { to_finish(study) }) {
                Some(trial) => {
                    let (state, values, at) = (TrialState::Running, Vec::new(), Timestamp::now());
                    operations.extend(trial.is_interrupted().then(|| outcome::resume(trial)));
                    operations.push(Operation::SetState { trial: trial.id, state, values, at });
                    (trial.number, trial.id, Some(trial))
                }
                None if begins => {
                    let trial = Box::new(NewTrial::new(TrialState::Running));
                    operations.push(Operation::CreateTrial { study: self.id, trial });
                    (study.trials.len(), replay.next_trial(), None)
                }
                None => return Ok(operations),
            };
            let resumed = known.and_then(|trial| trial.system_attributes.get(PAUSED_STATE)).cloned();
            operations.extend(self.parameters(study, space, number, id, known)?);
            claimed = Some((number, resumed));
            Ok(operations)
        })?;
        let trial = |(number, resumed): (usize, Option<Value>)| {
            let params = self.inspect(|study| study.trials.get(number).map(|trial| trial.params.clone()));
            Trial { study: self, number, params: params.unwrap_or_default(), resumed }
        };
        Ok(claimed.map(trial))
    }

    /// Ends the trials of dead workers. A trial with a saved state waits instead.
    fn end_abandoned(&self, study: &StudyRecord) -> Vec<Operation> {
        let silent = |trial: &TrialRecord| {
            self.abandoned_after
                .zip(last_sign(trial))
                .is_some_and(|(after, last)| Timestamp::now().since(last) > after)
        };
        let running = study.trials.iter().filter(|trial| trial.state == TrialState::Running);
        let dead = running.filter(|trial| is_dead(&trial.worker) || silent(trial));
        dead.flat_map(|trial| match trial.system_attributes.contains_key(PAUSED_STATE) {
            true => outcome::interrupt(trial),
            false => outcome::fail(trial, "its worker died"),
        })
        .collect()
    }

    /// Draws the parameters that a trial does not have yet.
    fn parameters(
        &self,
        study: &StudyRecord,
        space: &SearchSpace,
        number: usize,
        id: usize,
        known: Option<&TrialRecord>,
    ) -> Result<Vec<Operation>> {
        let mut params = known.map(|trial| trial.params.clone()).unwrap_or_default();
        let fixed = known.and_then(|trial| trial.system_attributes.get(FIXED)).and_then(Value::as_object);
        let mut operations = Vec::new();
        for group in space.groups() {
            let takes_part = group.first().is_some_and(|parameter| takes_part(parameter, &params));
            let missing =
                group.into_iter().filter(|parameter| takes_part && !params.contains_key(&parameter.name));
            let (mut chosen, mut undrawn): (Vec<(&Parameter, f64)>, Vec<&Parameter>) = Default::default();
            for parameter in missing {
                check_compatible(study, &parameter.name, &parameter.distribution)?;
                let fixed = fixed.and_then(|fixed| fixed.get(&parameter.name));
                // An invalid value of a queued trial is drawn instead, as in Optuna.
                let fixed = fixed.and_then(|value| parameter.distribution.number_from_value(value).ok());
                match fixed.or_else(|| only_number(&parameter.distribution)) {
                    Some(number) => chosen.push((parameter, number)),
                    None => undrawn.push(parameter),
                }
            }
            if !undrawn.is_empty() {
                let drawn = self.sampler.draw(study, number, &undrawn)?;
                chosen.extend(undrawn.into_iter().zip(drawn.numbers));
                operations.extend(drawn.system_attributes.into_iter().map(|(key, value)| {
                    Operation::NoteOfTrial { trial: id, notes: Notes::System, key, value }
                }));
            }
            for (parameter, number) in chosen {
                let suggestion = Suggestion { distribution: parameter.distribution.clone(), number };
                params.insert(parameter.name.clone(), suggestion.clone());
                operations.push(Operation::SetParam { trial: id, name: parameter.name.clone(), suggestion });
            }
        }
        Ok(operations)
    }
}

/// Returns the trial to finish when none is complete or running: the best of the paused ones that came furthest, so that a study
/// whose budget is used up has a result.
fn to_finish(study: &StudyRecord) -> Option<&TrialRecord> {
    let ends = |trial: &TrialRecord| matches!(trial.state, TrialState::Complete | TrialState::Running);
    if study.directions.len() != 1 || study.trials.iter().any(ends) {
        return None;
    }
    let stand =
        |trial: &TrialRecord| trial.last_report().map(|(step, value)| (-step, study.direction().loss(value)));
    let paused = study.trials.iter().filter(|trial| trial.is_paused());
    let stands = paused.filter_map(|trial| Some((stand(trial)?, trial)));
    stands.min_by(|(a, _), (b, _)| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))).map(|(_, trial)| trial)
}

/// Returns whether a parameter's condition holds.
fn takes_part(parameter: &Parameter, params: &BTreeMap<String, Suggestion>) -> bool {
    parameter.condition.as_ref().is_none_or(|condition| {
        let parent = params.get(&condition.parent);
        parent.is_some_and(|parent| condition.values.contains(&parent.value()))
    })
}

fn only_number(distribution: &Distribution) -> Option<f64> {
    distribution.is_single().then_some(match distribution {
        Distribution::Float { low, .. } => *low,
        Distribution::Int { low, .. } => *low as f64,
        Distribution::Categorical { .. } => 0.0,
    })
}
