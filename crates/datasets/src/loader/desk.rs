//! Where the loader's threads take their work from and lay down what is ready.

use std::any::Any;
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

use opendr_engine::dataset::DatasetIterator;
use opendr_engine::{Error, Random, Result, ResultExt};

use crate::augment::{Augment, Others, Pipeline};
use crate::loader::{Collate, LoaderOptions, Skipped};

/// The samples of an epoch, or of the rest of one, in batches.
pub(super) struct Job<'d, C> {
    pub(super) dataset: Arc<dyn DatasetIterator + 'd>,
    pub(super) pipeline: Arc<Pipeline>,
    pub(super) collate: Arc<C>,
    pub(super) options: LoaderOptions,
    /// The numbers of the samples.
    pub(super) order: Vec<usize>,
    pub(super) epoch: u64,
    /// Where among them the first batch begins.
    pub(super) position: usize,
}

/// A batch with what was left out of it.
pub(super) struct Loaded<B> {
    pub(super) content: B,
    pub(super) indices: Vec<usize>,
    pub(super) skipped: Vec<Skipped>,
}

impl<C: Collate> Job<'_, C> {
    pub(super) fn batches(&self) -> usize {
        (self.order.len() - self.position).div_ceil(self.options.batch_size)
    }

    /// Where among the samples batch number `number` ends.
    pub(super) fn end(&self, number: usize) -> usize {
        (self.position + (number + 1) * self.options.batch_size).min(self.order.len())
    }

    /// Makes batch number `number`; breaks off once `stopped`.
    pub(super) fn batch(&self, number: usize, stopped: &AtomicBool) -> Result<Loaded<C::Batch>> {
        let start = self.position + number * self.options.batch_size;
        let order = &self.order[start..self.end(number)];
        let mut loaded =
            Loaded { content: self.collate.start(order.len()), indices: Vec::new(), skipped: Vec::new() };
        for index in order.iter().copied() {
            if stopped.load(Ordering::Relaxed) {
                return Err(Error::internal("a batch of an epoch that was dropped"));
            }
            match self.add(&mut loaded.content, index) {
                Ok(()) => loaded.indices.push(index),
                Err(error) if self.options.skip_broken => {
                    loaded.skipped.push(Skipped { index, name: self.dataset.name(index), error });
                }
                Err(error) => return Err(error),
            }
        }
        Ok(loaded)
    }

    fn add(&self, batch: &mut C::Batch, index: usize) -> Result<()> {
        let mut random = Random::at([self.options.seed, self.epoch, index as u64]);
        let done = self.dataset.get(index).and_then(|mut sample| {
            self.pipeline.apply(&mut sample, &mut random, &Others::of(&*self.dataset))?;
            self.collate.add(batch, sample)
        });
        done.context(|| format!("sample {index} ({})", self.dataset.name(index)))
    }
}

/// A batch, an error, or what a thread panicked with.
pub(super) type Outcome<B> = Result<Result<Loaded<B>>, Box<dyn Any + Send>>;

/// The job, which of its batches are under way, and those that are ready.
pub(super) struct Desk<'d, C: Collate> {
    pub(super) job: Job<'d, C>,
    stopped: AtomicBool,
    state: Mutex<State<C::Batch>>,
    /// There is room for another batch, or the work is over.
    room: Condvar,
    /// A batch is ready.
    ready: Condvar,
}

struct State<B> {
    /// Batches that a thread has taken on.
    claimed: usize,
    /// Batches that were handed out.
    handed: usize,
    finished: BTreeMap<usize, Outcome<B>>,
}

impl<'d, C: Collate> Desk<'d, C> {
    pub(super) fn new(job: Job<'d, C>) -> Self {
        let state = State { claimed: 0, handed: 0, finished: BTreeMap::new() };
        let (room, ready) = (Condvar::new(), Condvar::new());
        Self { job, stopped: AtomicBool::new(false), state: Mutex::new(state), room, ready }
    }

    /// How many threads can help.
    pub(super) fn helpers(&self) -> usize {
        let LoaderOptions { threads, ahead, .. } = self.job.options;
        threads.min(ahead).min(self.job.batches())
    }

    /// What each thread does until all batches are taken on or the work is stopped.
    pub(super) fn serve(&self) {
        while let Some(number) = self.claim() {
            let outcome = self.work(number);
            self.lock().finished.insert(number, outcome);
            self.ready.notify_all();
        }
    }

    /// Batch number `number`, made by the thread that calls.
    pub(super) fn work(&self, number: usize) -> Outcome<C::Batch> {
        catch_unwind(AssertUnwindSafe(|| self.job.batch(number, &self.stopped)))
    }

    /// Batch number `number` once a thread has made it.
    pub(super) fn wait_for(&self, number: usize) -> Outcome<C::Batch> {
        let mut state = self.lock();
        loop {
            if let Some(outcome) = state.finished.remove(&number) {
                state.handed += 1;
                self.room.notify_all();
                return outcome;
            }
            state = self.ready.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    pub(super) fn stop(&self) {
        self.stopped.store(true, Ordering::Relaxed);
        // Under the lock: a thread between its look at the flag and its sleep would miss the call.
        drop(self.lock());
        self.room.notify_all();
    }

    fn claim(&self) -> Option<usize> {
        let mut state = self.lock();
        loop {
            if self.stopped.load(Ordering::Relaxed) || state.claimed == self.job.batches() {
                return None;
            }
            if state.claimed < state.handed + self.job.options.ahead {
                state.claimed += 1;
                return Some(state.claimed - 1);
            }
            state = self.room.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    fn lock(&self) -> MutexGuard<'_, State<C::Batch>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
