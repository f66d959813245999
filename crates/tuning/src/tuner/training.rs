//! What is tuned.

use std::path::Path;

use opendr_engine::Result;

/// A training of one configuration with one seed, that goes on from where it stands and never begins anew.
///
/// How much of it was done is counted in whatever the [`Plan`](crate::Plan) counts: steps of environments, epochs, batches.
pub trait Training {
    /// Goes on until `until` units are done in all, and measures. Where so many, or more, are done already, it only
    /// measures. None when it was stopped from outside before it came there, as by Ctrl-C.
    ///
    /// All trainings should be measured by the same data or episodes: differences are then less of luck.
    ///
    /// # Errors
    /// Those of the learner; they fail the trial.
    fn advance(&mut self, until: u64) -> Result<Option<f64>>;

    /// Saves all that decides the future, in a folder of its own, which appears whole or not at all.
    ///
    /// # Errors
    /// `Io` when it cannot be written.
    fn save(&self, folder: &Path) -> Result<()>;

    /// Goes back to what was saved of a training of the same configuration and seed.
    ///
    /// # Errors
    /// `NotFound`, `Io` and `Format` when that cannot be read.
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
