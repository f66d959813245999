//! Work queue of the loader: threads claim batches and store finished ones.

use std::any::Any;
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

use opendr_engine::dataset::DatasetIterator;
use opendr_engine::{Error, Random, Result, ResultExt};

use crate::augment::{Augment, OtherSamples, Pipeline};
use crate::loader::{Collate, LoaderOptions, Skipped};

/// The samples of an epoch, or of the rest of one, in batches.
pub(super) struct Job<'d, C> {
    pub(super) dataset: Arc<dyn DatasetIterator + 'd>,
    pub(super) pipeline: Arc<Pipeline>,
    pub(super) collate: Arc<C>,
    pub(super) options: LoaderOptions,
    /// Sample indices.
    pub(super) order: Vec<usize>,
    pub(super) epoch: u64,
    /// Position of the first batch in `order`.
    pub(super) position: usize,
    pub(super) share: Share,
}

/// The batches of a loader among all: every `size`-th one, from `rank` on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Share {
    pub(super) rank: usize,
    pub(super) size: usize,
}

impl Share {
    /// All batches.
    pub(super) const ALL: Self = Self { rank: 0, size: 1 };
}

/// A batch with its skipped samples.
pub(super) struct Loaded<B> {
    pub(super) content: B,
    pub(super) indices: Vec<usize>,
    pub(super) skipped: Vec<Skipped>,
}

impl<C: Collate> Job<'_, C> {
    /// Returns the number of batches of the share.
    pub(super) fn batches(&self) -> usize {
        let all = (self.order.len() - self.position).div_ceil(self.options.batch_size);
        all.saturating_sub(self.share.rank).div_ceil(self.share.size)
    }

    /// Returns the position in `order` at which batch `number` of the share begins.
    fn start(&self, number: usize) -> usize {
        self.position + (self.share.rank + number * self.share.size) * self.options.batch_size
    }

    /// Returns the position in `order` at which batch `number` of the share ends.
    pub(super) fn end(&self, number: usize) -> usize {
        (self.start(number) + self.options.batch_size).min(self.order.len())
    }

    /// Makes batch `number`; fails once `stopped` is set.
    pub(super) fn batch(&self, number: usize, stopped: &AtomicBool) -> Result<Loaded<C::Batch>> {
        let order = &self.order[self.start(number)..self.end(number)];
        let mut loaded =
            Loaded { content: self.collate.start(order.len()), indices: Vec::new(), skipped: Vec::new() };
        for index in order.iter().copied() {
            if stopped.load(Ordering::Relaxed) {
                return Err(Error::internal("the epoch of the batch was dropped"));
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
        let mut random = Random::from_key([self.options.seed, self.epoch, index as u64]);
        let done = self.dataset.get(index).and_then(|mut sample| {
            self.pipeline.apply(&mut sample, &mut random, &OtherSamples::of(&*self.dataset))?;
            self.collate.add(batch, sample)
        });
        done.context(|| format!("sample {index} ({})", self.dataset.name(index)))
    }
}

/// A batch, an error, or the panic of a thread.
pub(super) type Outcome<B> = Result<Result<Loaded<B>>, Box<dyn Any + Send>>;

/// Shared state of the threads: the job, the claimed batches and the finished ones.
pub(super) struct WorkQueue<'d, C: Collate> {
    pub(super) job: Job<'d, C>,
    stopped: AtomicBool,
    state: Mutex<State<C::Batch>>,
    /// Signals that there is room for another batch, or that the work is over.
    room: Condvar,
    /// Signals that a batch is ready.
    ready: Condvar,
}

struct State<B> {
    /// Number of batches claimed by threads.
    claimed: usize,
    /// Number of batches returned to the user.
    handed: usize,
    finished: BTreeMap<usize, Outcome<B>>,
}

impl<'d, C: Collate> WorkQueue<'d, C> {
    pub(super) fn new(job: Job<'d, C>) -> Self {
        let state = State { claimed: 0, handed: 0, finished: BTreeMap::new() };
        let (room, ready) = (Condvar::new(), Condvar::new());
        Self { job, stopped: AtomicBool::new(false), state: Mutex::new(state), room, ready }
    }

    /// Returns the number of useful threads.
    pub(super) fn helpers(&self) -> usize {
        let LoaderOptions { threads, prefetch: ahead, .. } = self.job.options;
        threads.min(ahead).min(self.job.batches())
    }

    /// Runs a worker thread until all batches are claimed or the work is stopped.
    pub(super) fn serve(&self) {
        while let Some(number) = self.claim() {
            let outcome = self.work(number);
            self.lock().finished.insert(number, outcome);
            self.ready.notify_all();
        }
    }

    /// Makes batch `number` on the calling thread.
    pub(super) fn work(&self, number: usize) -> Outcome<C::Batch> {
        catch_unwind(AssertUnwindSafe(|| self.job.batch(number, &self.stopped)))
    }

    /// Waits until batch `number` is made.
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
        // The lock is needed: a thread between its check of the flag and its wait would miss the notification.
        drop(self.lock());
        self.room.notify_all();
    }

    fn claim(&self) -> Option<usize> {
        let mut state = self.lock();
        loop {
            if self.stopped.load(Ordering::Relaxed) || state.claimed == self.job.batches() {
                return None;
            }
            if state.claimed < state.handed + self.job.options.prefetch {
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
