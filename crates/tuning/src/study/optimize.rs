//! Running of trials, in sequence and in parallel.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use opendr_engine::{Error, Result};

use crate::records::{StudyRecord, TrialState};
use crate::space::SearchSpace;
use crate::study::{Outcome, Study, Trial};

/// Limits of [`Study::optimize`].
#[derive(Debug, Clone, Copy)]
pub struct Budget {
    trials: Trials,
    timeout: Option<Duration>,
    threads: usize,
    failures: usize,
}

#[derive(Debug, Clone, Copy)]
enum Trials {
    More(usize),
    Total(usize),
}

impl Budget {
    /// Creates a budget of this many new trials.
    pub fn more(trials: usize) -> Self {
        Self { trials: Trials::More(trials), timeout: None, threads: 1, failures: 3 }
    }

    /// Creates a budget that brings the study to this number of trials, not counting failed ones. Several processes can share it, and
    /// it is independent of interruptions.
    pub fn total(trials: usize) -> Self {
        Self { trials: Trials::Total(trials), ..Self::more(0) }
    }

    /// Sets the time after which no trial starts.
    #[must_use]
    pub fn timeout(self, timeout: Duration) -> Self {
        Self { timeout: Some(timeout), ..self }
    }

    /// Sets the number of parallel trials.
    #[must_use]
    pub fn threads(self, threads: usize) -> Self {
        Self { threads: threads.max(1), ..self }
    }

    /// Sets the number of consecutive failures that end the study; 3 by default.
    #[must_use]
    pub fn max_failures(self, failures: usize) -> Self {
        Self { failures: failures.max(1), ..self }
    }

    /// Returns the end of the time limit, counted from now.
    pub(crate) fn end(&self) -> Option<Instant> {
        self.timeout.map(|timeout| Instant::now() + timeout)
    }
}

/// Whether a study continues after a trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Progress {
    /// Continue.
    Continue,
    /// Start no further trial.
    Stop,
}

/// State shared by the threads of a study.
struct Shared {
    stop: AtomicBool,
    begun: AtomicUsize,
    failed_in_row: AtomicUsize,
    error: Mutex<Option<Error>>,
}

impl Study {
    /// Runs trials until the budget is used up and no paused trial should be resumed. `after` is called with the study
    /// after every trial, for instance to print a table, and may stop the study.
    ///
    /// An objective that returns an error or panics fails its trial; the study continues.
    ///
    /// # Errors
    /// The error of the last trial when too many fail in a row, after all are recorded; `Io` and `Format` of the storage.
    pub fn optimize(
        &self,
        space: &SearchSpace,
        budget: &Budget,
        objective: impl Fn(&Trial<'_>) -> Result<Outcome> + Sync,
        after: impl Fn(&StudyRecord, usize) -> Progress + Sync,
    ) -> Result<()> {
        let shared = Shared {
            stop: AtomicBool::new(false),
            begun: AtomicUsize::new(0),
            failed_in_row: AtomicUsize::new(0),
            error: Mutex::new(None),
        };
        let end = budget.end();
        let work = || {
            let on = || !shared.stop.load(Ordering::Relaxed) && end.is_none_or(|end| Instant::now() < end);
            while on() {
                let done = self.one_trial(space, budget, &shared, &objective, &after);
                match done {
                    Ok(true) => {}
                    Ok(false) => break,
                    Err(error) => {
                        shared.stop.store(true, Ordering::Relaxed);
                        shared.error.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
                    }
                }
            }
        };
        thread::scope(|scope| {
            (1..budget.threads).for_each(|_| {
                scope.spawn(work);
            });
            work();
        });
        shared.error.into_inner().unwrap_or_else(PoisonError::into_inner).map_or(Ok(()), Err)
    }

    /// Runs one trial. Returns whether there was one.
    fn one_trial(
        &self,
        space: &SearchSpace,
        budget: &Budget,
        shared: &Shared,
        objective: &impl Fn(&Trial<'_>) -> Result<Outcome>,
        after: &impl Fn(&StudyRecord, usize) -> Progress,
    ) -> Result<bool> {
        let may_begin = |study: &StudyRecord| match budget.trials {
            Trials::More(most) => shared.begun.fetch_add(1, Ordering::Relaxed) < most,
            Trials::Total(most) => {
                study.trials.iter().filter(|trial| trial.state != TrialState::Failed).count() < most
            }
        };
        let Some(trial) = self.claim(space, may_begin)? else { return Ok(false) };
        let number = trial.number();
        let (outcome, error) = match catch_unwind(AssertUnwindSafe(|| objective(&trial))) {
            Ok(Ok(outcome)) => (outcome, None),
            Ok(Err(error)) => (Outcome::Failed(error.to_string()), Some(error)),
            Err(panic) => {
                let error = Error::internal(format!("the objective panicked: {}", panic_text(&*panic)));
                (Outcome::Failed(error.to_string()), Some(error))
            }
        };
        self.tell(number, outcome)?;
        if self.inspect(|study| after(study, number)) == Progress::Stop {
            shared.stop.store(true, Ordering::Relaxed);
        }
        match error {
            Some(error) if shared.failed_in_row.fetch_add(1, Ordering::Relaxed) + 1 >= budget.failures => {
                Err(error
                    .context(format!("trial {number}, the last of {} that failed in a row", budget.failures)))
            }
            Some(_) => Ok(true),
            None => {
                shared.failed_in_row.store(0, Ordering::Relaxed);
                Ok(true)
            }
        }
    }
}

fn panic_text(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<&str>().copied();
    text.or_else(|| panic.downcast_ref::<String>().map(String::as_str)).unwrap_or("without a message")
}
