//! A data set whose samples are read ahead on several threads.

use std::sync::{Mutex, PoisonError};

use crate::dataset::{Dataset, DatasetIterator, Sample, forward};
use crate::{Result, Value};

/// A data set that reads the next samples on several threads, for those that read it in order.
///
/// Samples come in windows: the first sample of a window that is read makes all of them. Errors are not kept.
pub struct ReadAheadDatasetIterator<D> {
    original: D,
    threads: usize,
    window: Mutex<Window>,
}

#[derive(Default)]
struct Window {
    begin: usize,
    samples: Vec<Option<Sample>>,
}

/// Number of samples in a window for each thread.
const DEPTH: usize = 4;

impl<D: DatasetIterator> ReadAheadDatasetIterator<D> {
    /// Creates a data set that reads `original` on up to `threads` threads.
    pub fn new(original: D, threads: usize) -> Self {
        Self { original, threads: threads.max(1), window: Mutex::default() }
    }

    fn in_window(&self, index: usize) -> Option<Sample> {
        if index >= self.original.len() {
            return None;
        }
        let mut window = self.window.lock().unwrap_or_else(PoisonError::into_inner);
        let size = DEPTH * self.threads;
        let begin = index / size * size;
        if window.samples.is_empty() || window.begin != begin {
            let samples = self.read(begin, size.min(self.original.len() - begin));
            *window = Window { begin, samples };
        }
        window.samples.get(index - begin).cloned().flatten()
    }

    fn read(&self, begin: usize, count: usize) -> Vec<Option<Sample>> {
        let mut samples = vec![None; count];
        let each = count.div_ceil(self.threads).max(1);
        std::thread::scope(|scope| {
            for (part, samples) in samples.chunks_mut(each).enumerate() {
                scope.spawn(move || {
                    for (at, sample) in samples.iter_mut().enumerate() {
                        *sample = self.original.get(begin + part * each + at).ok();
                    }
                });
            }
        });
        samples
    }
}

impl<D: DatasetIterator> Dataset for ReadAheadDatasetIterator<D> {}

impl<D: DatasetIterator> DatasetIterator for ReadAheadDatasetIterator<D> {
    fn len(&self) -> usize {
        self.original.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        self.in_window(index).map_or_else(|| self.original.get(index), Ok)
    }

    fn target(&self, index: usize) -> Result<Option<Value>> {
        Ok(self.get(index)?.target)
    }

    forward!(self, index => self.original, index);
}
