//! Vectorised environments: several of one kind, stepped together.

mod batch;
mod cart_pole_vector;
mod chunk;
mod environment_vector;
#[cfg(test)]
mod tests;

use opendr_engine::environment::{EnvironmentSpec, ResetOptions, Snapshot, StateReader};
use opendr_engine::{Error, Result};

pub use batch::Batch;
pub use cart_pole_vector::CartPoleVector;
pub use environment_vector::EnvironmentVector;

/// When an environment is reset after the end of an episode (Gymnasium's `AutoresetMode`).
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Autoreset {
    /// In the next step, which ignores its action and returns the first observation and a reward of 0.
    #[default]
    NextStep,
    /// In the step that ends an episode. It returns the first observation of the next episode; the last one is in
    /// [`Batch::final_observations`].
    SameStep,
    /// Never; the caller resets with a mask.
    Disabled,
}

/// Seeds of the environments.
#[derive(Debug, Clone, Copy, Default)]
pub enum Seeds<'a> {
    /// Each environment continues its random numbers, or starts with a random seed.
    #[default]
    Random,
    /// Environment `i` has the seed `seed + i`.
    From(u64),
    /// One seed per environment.
    Each(&'a [Option<u64>]),
}

impl Seeds<'_> {
    fn check(&self, count: usize) -> Result<()> {
        match self {
            Self::Each(seeds) if seeds.len() != count => Err(Error::invalid_input(format!(
                "{} seeds for {count} environments; give one per environment",
                seeds.len()
            ))),
            _ => Ok(()),
        }
    }

    fn at(&self, index: usize) -> Option<u64> {
        match self {
            Self::Random => None,
            Self::From(seed) => Some(seed.wrapping_add(index as u64)),
            Self::Each(seeds) => seeds.get(index).copied().flatten(),
        }
    }
}

/// The executed actions of a step.
#[derive(Debug, Clone, Copy)]
pub struct Interventions<'a> {
    /// Actions, environment by environment, in the action space of the environments.
    pub actions: &'a [f32],
    /// Whether the action of each environment was replaced.
    pub replaced: &'a [bool],
}

/// Environments that are stepped together. Results do not depend on the number of threads.
pub trait VecEnvironment: Send {
    /// Returns the specification of each environment.
    fn spec(&self) -> &EnvironmentSpec;

    /// Returns the number of environments.
    fn count(&self) -> usize;

    /// Returns when environments are reset automatically.
    fn autoreset(&self) -> Autoreset;

    /// Resets all environments, or those with `mask` true, and writes the first observations.
    ///
    /// # Errors
    /// `InvalidInput` when seeds, mask or batch have another size, or the mask is all false; else as
    /// [`reset`](opendr_engine::environment::Environment::reset).
    fn reset(
        &mut self,
        seeds: Seeds<'_>,
        options: &ResetOptions,
        mask: Option<&[bool]>,
        batch: &mut Batch,
    ) -> Result<()>;

    /// Takes one step in every environment; `actions` are concatenated.
    ///
    /// # Errors
    /// `InvalidInput` when actions or batch have another size, for an invalid action, before the first reset, and
    /// without autoreset after the end of an episode. The message names the environment; the others may have
    /// taken their step.
    fn step(&mut self, actions: &[f32], batch: &mut Batch) -> Result<()>;

    /// Returns the actions that the last step executed, if something between learner and environments may replace actions, such as a
    /// shield. A learner stores these instead of its own.
    fn interventions(&self) -> Option<Interventions<'_>> {
        None
    }

    /// Writes the state of all environments.
    ///
    /// # Errors
    /// `Unsupported` for environments without snapshots, `InvalidInput` before the first reset.
    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        let _ = snapshot;
        Err(Error::unsupported(format!("{} has no snapshots of several environments", self.spec().id)))
    }

    /// Reads what [`Self::save_state`] wrote, in the same order.
    ///
    /// # Errors
    /// `Unsupported` for environments without snapshots, `Format` for a snapshot of something else.
    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        let _ = state;
        Err(Error::unsupported(format!("{} has no snapshots of several environments", self.spec().id)))
    }

    /// Returns the state of all environments. The caller keeps the last [`Batch`], on which the next action
    /// depends. A snapshot does not depend on threads or on how the states are stored.
    ///
    /// # Errors
    /// As [`Self::save_state`].
    fn snapshot(&self) -> Result<Snapshot> {
        let mut snapshot = Snapshot::new(&snapshot_id(self.spec(), self.count()));
        self.save_state(&mut snapshot)?;
        Ok(snapshot)
    }

    /// Restores a state: the same actions then have the same results, bit for bit.
    ///
    /// # Errors
    /// `InvalidInput` for a snapshot of other environments or another count, else as [`Self::load_state`]. After an
    /// error the environments must be reset.
    fn restore(&mut self, snapshot: &Snapshot) -> Result<()> {
        let mut state = snapshot.read(&snapshot_id(self.spec(), self.count()))?;
        self.load_state(&mut state)?;
        state.finish()
    }
}

/// Returns the id of a snapshot of several environments.
fn snapshot_id(spec: &EnvironmentSpec, count: usize) -> String {
    format!("{count} x {}", spec.id)
}

/// Options of [`make_vec`](crate::make_vec).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct VectorOptions {
    /// Number of environments.
    pub count: usize,
    /// When environments are reset automatically.
    pub autoreset: Autoreset,
    /// Number of threads; ignored by environments that are faster on one.
    pub threads: usize,
}

impl VectorOptions {
    /// Creates options for `count` environments on one thread, with the default autoreset.
    pub fn new(count: usize) -> Self {
        Self { count, autoreset: Autoreset::default(), threads: 1 }
    }

    pub(crate) fn checked_count(&self) -> Result<usize> {
        check_count(self.count)
    }
}

/// Checks that a number of environments is in range.
fn check_count(count: usize) -> Result<usize> {
    const MAX: usize = 1 << 20;
    if (1..=MAX).contains(&count) {
        return Ok(count);
    }
    Err(Error::invalid_param(format!("{count} environments; give 1 to {MAX}")))
}

/// Checks the sizes of the arguments of a reset.
fn check_reset(seeds: &Seeds<'_>, mask: Option<&[bool]>, count: usize) -> Result<()> {
    seeds.check(count)?;
    match mask {
        Some(mask) if mask.len() != count || !mask.contains(&true) => {
            let (len, chosen) = (mask.len(), mask.iter().filter(|chosen| **chosen).count());
            Err(Error::invalid_input(format!(
                "the mask has {len} values, {chosen} of them true, for {count} environments; give one per environment, at least one true"
            )))
        }
        _ => Ok(()),
    }
}

/// Checks the number of actions of a step.
fn check_actions(actions: &[f32], spec: &EnvironmentSpec, count: usize) -> Result<()> {
    let expected = spec.action.len() * count;
    if actions.len() == expected {
        return Ok(());
    }
    let given = actions.len();
    Err(Error::invalid_input(format!(
        "{given} action numbers for {count} environments of {}; give {expected}, ordered by environment",
        spec.id
    )))
}
