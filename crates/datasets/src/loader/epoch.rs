//! Iteration over the batches of an epoch.

use std::ops::ControlFlow;
use std::panic::resume_unwind;
use std::sync::Arc;
use std::thread::{self, Builder, JoinHandle};

use opendr_engine::Result;

use crate::loader::queue::{Job, WorkQueue};
use crate::loader::{Collate, SampleBatches, Skipped};

/// A batch of an epoch.
#[derive(Debug, Clone)]
pub struct Batch<B> {
    /// The collated samples.
    pub content: B,
    /// Sample indices in the data set.
    pub indices: Vec<usize>,
    /// Number of the epoch.
    pub epoch: u64,
    /// Number of samples of the epoch up to and including this batch; the position to
    /// [resume](crate::loader::Loader::resume).
    pub next_position: usize,
}

/// Reading position of an epoch, and the skipped samples so far.
#[derive(Debug, Default)]
pub(super) struct Reading {
    next: usize,
    pub(super) skipped: Vec<Skipped>,
}

impl Reading {
    /// Returns the next batch that is not empty; it is made on this thread if this is the only one (`alone`).
    pub(super) fn next<C: Collate>(
        &mut self,
        queue: &WorkQueue<'_, C>,
        alone: bool,
    ) -> Option<Result<Batch<C::Batch>>> {
        while self.next < queue.job.batches() {
            let number = self.next;
            self.next += 1;
            let outcome = if alone { queue.work(number) } else { queue.wait_for(number) };
            let loaded = match outcome.unwrap_or_else(|panic| resume_unwind(panic)) {
                Ok(loaded) => loaded,
                Err(error) => return Some(Err(error)),
            };
            self.skipped.extend(loaded.skipped);
            if !loaded.indices.is_empty() {
                let (epoch, next_position) = (queue.job.epoch, queue.job.end(number));
                let (content, indices) = (loaded.content, loaded.indices);
                return Some(Ok(Batch { content, indices, epoch, next_position }));
            }
        }
        None
    }
}

/// Iterator over the batches of an epoch, in order, prepared by threads that end with it.
///
/// A sample that cannot be read or augmented is an error in place of its batch (unless broken samples are skipped),
/// after which the next batch follows. A panic of a thread resumes in the thread that requests the batch.
pub struct Epoch<C: Collate = SampleBatches> {
    queue: Arc<WorkQueue<'static, C>>,
    threads: Vec<JoinHandle<()>>,
    reading: Reading,
}

impl<C: Collate> Epoch<C> {
    pub(super) fn start(job: Job<'static, C>) -> Self {
        let queue = Arc::new(WorkQueue::new(job));
        let start = |_| {
            let queue = Arc::clone(&queue);
            // If a thread cannot be created, the others or the requesting thread do its work.
            Builder::new().name(THREAD_NAME.to_owned()).spawn(move || queue.serve()).ok()
        };
        let threads = (0..queue.helpers()).filter_map(start).collect();
        Self { queue, threads, reading: Reading::default() }
    }

    /// Returns the skipped samples so far, in the order of the epoch.
    pub fn skipped(&self) -> &[Skipped] {
        &self.reading.skipped
    }
}

impl<C: Collate> Iterator for Epoch<C> {
    type Item = Result<Batch<C::Batch>>;

    fn next(&mut self) -> Option<Self::Item> {
        self.reading.next(&self.queue, self.threads.is_empty())
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (0, Some(self.queue.job.batches() - self.reading.next))
    }
}

impl<C: Collate> Drop for Epoch<C> {
    fn drop(&mut self) {
        self.queue.stop();
        for thread in self.threads.drain(..) {
            // Panics of the thread were caught and resumed in the requesting thread.
            let _ = thread.join();
        }
    }
}

const THREAD_NAME: &str = "opendr-loader";

/// Calls `each` with the batches of a job on this thread, while scoped threads prepare them.
pub(super) fn each_batch<C: Collate>(
    job: Job<'_, C>,
    mut each: impl FnMut(Batch<C::Batch>) -> Result<ControlFlow<()>>,
) -> Result<Vec<Skipped>> {
    let queue = &WorkQueue::new(job);
    thread::scope(|scope| {
        // Stops the threads also after an error or panic of `each`, since the scope would wait for them forever.
        let _stop = Stop(queue);
        let start = |_: &usize| {
            Builder::new().name(THREAD_NAME.to_owned()).spawn_scoped(scope, || queue.serve()).is_ok()
        };
        let alone = (0..queue.helpers()).filter(start).count() == 0;
        let mut reading = Reading::default();
        while let Some(batch) = reading.next(queue, alone) {
            if each(batch?)?.is_break() {
                break;
            }
        }
        Ok(reading.skipped)
    })
}

/// Stops the work when it is dropped.
struct Stop<'a, 'd, C: Collate>(&'a WorkQueue<'d, C>);

impl<C: Collate> Drop for Stop<'_, '_, C> {
    fn drop(&mut self) {
        self.0.stop();
    }
}
