//! One way through a data set.

use std::ops::ControlFlow;
use std::panic::resume_unwind;
use std::sync::Arc;
use std::thread::{self, Builder, JoinHandle};

use opendr_engine::{Error, Result};

use crate::loader::desk::{Desk, Job};
use crate::loader::{Collate, Samples};

/// A batch of an epoch.
#[derive(Debug, Clone)]
pub struct Batch<B> {
    /// The samples, as they were collated.
    pub content: B,
    /// Their numbers in the data set.
    pub indices: Vec<usize>,
    /// The epoch.
    pub epoch: u64,
    /// Samples of the epoch up to and with this batch: where to [resume](crate::loader::Loader::resume).
    pub next_position: usize,
}

/// A sample that was left out because it is broken.
#[derive(Debug)]
pub struct Skipped {
    /// Its number in the data set.
    pub index: usize,
    /// What the data set calls it.
    pub name: String,
    /// Why.
    pub error: Error,
}

/// Which batch comes next, and what was left out so far.
#[derive(Debug, Default)]
pub(super) struct Reading {
    next: usize,
    pub(super) skipped: Vec<Skipped>,
}

impl Reading {
    /// The next batch that is not empty: made right here when this thread is `alone`.
    pub(super) fn next<C: Collate>(
        &mut self,
        desk: &Desk<'_, C>,
        alone: bool,
    ) -> Option<Result<Batch<C::Batch>>> {
        while self.next < desk.job.batches() {
            let number = self.next;
            self.next += 1;
            let outcome = if alone { desk.work(number) } else { desk.wait_for(number) };
            let loaded = match outcome.unwrap_or_else(|panic| resume_unwind(panic)) {
                Ok(loaded) => loaded,
                Err(error) => return Some(Err(error)),
            };
            self.skipped.extend(loaded.skipped);
            if !loaded.indices.is_empty() {
                let (epoch, next_position) = (desk.job.epoch, desk.job.end(number));
                let (content, indices) = (loaded.content, loaded.indices);
                return Some(Ok(Batch { content, indices, epoch, next_position }));
            }
        }
        None
    }
}

/// The batches of an epoch, in order, made ahead by threads that end with it.
///
/// A sample that cannot be read or augmented is an error in place of its batch (unless such are skipped), after which the
/// next batch comes; a panic of a thread goes on in whoever asks for the batch.
pub struct Epoch<C: Collate = Samples> {
    desk: Arc<Desk<'static, C>>,
    threads: Vec<JoinHandle<()>>,
    reading: Reading,
}

impl<C: Collate> Epoch<C> {
    pub(super) fn start(job: Job<'static, C>) -> Self {
        let desk = Arc::new(Desk::new(job));
        let start = |_| {
            let desk = Arc::clone(&desk);
            // Where no thread can be had, the others do its work, or whoever asks.
            Builder::new().name(THREAD_NAME.to_owned()).spawn(move || desk.serve()).ok()
        };
        let threads = (0..desk.helpers()).filter_map(start).collect();
        Self { desk, threads, reading: Reading::default() }
    }

    /// What was left out so far, in the epoch's order.
    pub fn skipped(&self) -> &[Skipped] {
        &self.reading.skipped
    }
}

impl<C: Collate> Iterator for Epoch<C> {
    type Item = Result<Batch<C::Batch>>;

    fn next(&mut self) -> Option<Self::Item> {
        self.reading.next(&self.desk, self.threads.is_empty())
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (0, Some(self.desk.job.batches() - self.reading.next))
    }
}

impl<C: Collate> Drop for Epoch<C> {
    fn drop(&mut self) {
        self.desk.stop();
        for thread in self.threads.drain(..) {
            // A thread's panics were caught; they have gone to whoever asked for the batch.
            let _ = thread.join();
        }
    }
}

const THREAD_NAME: &str = "opendr-loader";

/// Hands the batches of a job to `each` on this thread, while threads that end before this returns make them ahead.
pub(super) fn each_batch<C: Collate>(
    job: Job<'_, C>,
    mut each: impl FnMut(Batch<C::Batch>) -> Result<ControlFlow<()>>,
) -> Result<Vec<Skipped>> {
    let desk = &Desk::new(job);
    thread::scope(|scope| {
        // Stopped on the way out, be it an error or a panic of `each`; the scope would wait for ever otherwise.
        let _stop = Stop(desk);
        let start = |_: &usize| {
            Builder::new().name(THREAD_NAME.to_owned()).spawn_scoped(scope, || desk.serve()).is_ok()
        };
        let alone = (0..desk.helpers()).filter(start).count() == 0;
        let mut reading = Reading::default();
        while let Some(batch) = reading.next(desk, alone) {
            if each(batch?)?.is_break() {
                break;
            }
        }
        Ok(reading.skipped)
    })
}

/// Stops the work at a desk when it is dropped.
struct Stop<'a, 'd, C: Collate>(&'a Desk<'d, C>);

impl<C: Collate> Drop for Stop<'_, '_, C> {
    fn drop(&mut self) {
        self.0.stop();
    }
}
