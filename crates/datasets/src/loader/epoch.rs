//! One way through a data set.

use std::panic::resume_unwind;
use std::sync::Arc;
use std::thread::{Builder, JoinHandle};

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

/// The batches of an epoch, in order, made ahead by threads that end with it.
///
/// A sample that cannot be read or augmented is an error in place of its batch (unless such are skipped), after which the
/// next batch comes; a panic of a thread goes on in whoever asks for the batch.
pub struct Epoch<C: Collate = Samples> {
    desk: Arc<Desk<C>>,
    threads: Vec<JoinHandle<()>>,
    next: usize,
    skipped: Vec<Skipped>,
}

impl<C: Collate> Epoch<C> {
    pub(super) fn start(job: Job<C>) -> Self {
        let count = job.options.threads.min(job.options.ahead).min(job.batches());
        let desk = Arc::new(Desk::new(job));
        let start = |_| {
            let desk = Arc::clone(&desk);
            // Where no thread can be had, the others do its work, or whoever asks.
            Builder::new().name("opendr-loader".to_owned()).spawn(move || desk.serve()).ok()
        };
        let threads = (0..count).filter_map(start).collect();
        Self { desk, threads, next: 0, skipped: Vec::new() }
    }

    /// What was left out so far, in the epoch's order.
    pub fn skipped(&self) -> &[Skipped] {
        &self.skipped
    }
}

impl<C: Collate> Iterator for Epoch<C> {
    type Item = Result<Batch<C::Batch>>;

    fn next(&mut self) -> Option<Self::Item> {
        while self.next < self.desk.job.batches() {
            let number = self.next;
            self.next += 1;
            let outcome =
                if self.threads.is_empty() { self.desk.work(number) } else { self.desk.wait_for(number) };
            let loaded = match outcome.unwrap_or_else(|panic| resume_unwind(panic)) {
                Ok(loaded) => loaded,
                Err(error) => return Some(Err(error)),
            };
            self.skipped.extend(loaded.skipped);
            if !loaded.indices.is_empty() {
                let (epoch, next_position) = (self.desk.job.epoch, self.desk.job.end(number));
                let (content, indices) = (loaded.content, loaded.indices);
                return Some(Ok(Batch { content, indices, epoch, next_position }));
            }
        }
        None
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (0, Some(self.desk.job.batches() - self.next))
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
