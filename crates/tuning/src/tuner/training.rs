//! The trait of tunable trainings.

use std::path::Path;

use opendr_engine::Result;

/// A training of one configuration with one seed, which runs in pieces.
///
/// The unit of its length is that of the [`Plan`](crate::Plan): steps of environments, epochs, batches.
pub trait Training {
    /// Trains until `until` units are done in total, and evaluates. If as many are already done, it only
    /// evaluates. Returns none when it was stopped from outside before, as by Ctrl-C.
    ///
    /// All trainings should be evaluated on the same data or episodes, which reduces random differences.
    ///
    /// # Errors
    /// The errors of the learner, which fail the trial.
    fn advance(&mut self, until: u64) -> Result<Option<f64>>;

    /// Saves the state of the training in a folder of its own, which must appear atomically.
    ///
    /// # Errors
    /// `Io` when it cannot be written.
    fn save(&self, folder: &Path) -> Result<()>;

    /// Restores the saved state of a training of the same configuration and seed.
    ///
    /// # Errors
    /// `NotFound`, `Io` and `Format` when it cannot be read.
    fn load(&mut self, folder: &Path) -> Result<()>;
}

impl<T: Training + ?Sized> Training for Box<T> {
    fn advance(&mut self, until: u64) -> Result<Option<f64>> {
        (**self).advance(until)
    }

    fn save(&self, folder: &Path) -> Result<()> {
        (**self).save(folder)
    }

    fn load(&mut self, folder: &Path) -> Result<()> {
        (**self).load(folder)
    }
}
