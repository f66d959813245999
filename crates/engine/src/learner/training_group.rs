//! Processes that train one network together.

use crate::Result;

/// A process of a group that trains one network together. Each process computes the gradients of its part of the batches of a step; all
/// carry out the same steps, so that all have the same weights.
pub trait TrainingGroup: Sync {
    /// Returns the number of this process among those of the group, from 0. Process 0 validates.
    fn rank(&self) -> usize;

    /// Returns the number of processes, at least 1.
    fn size(&self) -> usize;

    /// Sends `payload` to all processes, waits for theirs, and returns the payloads of all processes by rank.
    ///
    /// # Errors
    /// When a process is lost, or the user stops the training.
    fn all_gather(&self, payload: Vec<u8>) -> Result<Vec<Vec<u8>>>;
}
