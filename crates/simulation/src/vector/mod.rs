//! Many environments of one kind, stepped together.

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

/// When an environment whose episode ended begins the next one (Gymnasium's `AutoresetMode`).
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Autoreset {
    /// The step after the end ignores its action: it answers with the first observation and a reward of 0.
    #[default]
    NextStep,
    /// The step that ends an episode answers with the first observation of the next one; the last is in
    /// [`Batch::final_observations`].
    SameStep,
    /// Never: the caller resets, with a mask.
    Disabled,
}

/// Where the environments' random numbers begin.
#[derive(Debug, Clone, Copy, Default)]
pub enum Seeds<'a> {
    /// Each goes on with its stream, or begins one by chance.
    #[default]
    Chance,
    /// Environment `i` begins with the seed plus `i`.
    From(u64),
    /// One for each environment.
    Each(&'a [Option<u64>]),
}

impl Seeds<'_> {
    fn check(&self, count: usize) -> Result<()> {
        match self {
            Self::Each(seeds) if seeds.len() != count => Err(Error::invalid_input(format!(
                "{} seeds for {count} environments; give one for each",
                seeds.len()
            ))),
            _ => Ok(()),
        }
    }

    fn at(&self, index: usize) -> Option<u64> {
        match self {
            Self::Chance => None,
            Self::From(seed) => Some(seed.wrapping_add(index as u64)),
            Self::Each(seeds) => seeds.get(index).copied().flatten(),
        }
    }
}

/// The actions that a step executed.
#[derive(Debug, Clone, Copy)]
pub struct Interventions<'a> {
    /// Environment after environment, as the environments take them.
    pub actions: &'a [f32],
    /// The environments in which they are not the actions that were given.
    pub replaced: &'a [bool],
}

/// Environments that are stepped together. What they answer does not depend on threads.
pub trait VecEnvironment: Send {
    /// What each of them is.
    fn spec(&self) -> &EnvironmentSpec;

    /// How many there are.
    fn count(&self) -> usize;

    /// When episodes begin anew.
    fn autoreset(&self) -> Autoreset;

    /// Begins an episode in every environment, or where `mask` says so, and writes the first observations.
    ///
    /// # Errors
    /// `InvalidInput` when seeds, mask or batch are of another size, or the mask is nowhere true; else as
    /// [`reset`](opendr_engine::environment::Environment::reset).
    fn reset(
        &mut self,
        seeds: Seeds<'_>,
        options: &ResetOptions,
        mask: Option<&[bool]>,
        batch: &mut Batch,
    ) -> Result<()>;

    /// Takes one step in every environment; `actions` lie in a row.
    ///
    /// # Errors
    /// `InvalidInput` when actions or batch are of another size, when an action is none, before the first reset, and
    /// without autoreset where an episode is over. The message names the environment; the others may have
    /// taken their step.
    fn step(&mut self, actions: &[f32], batch: &mut Batch) -> Result<()>;

    /// The actions that the last step executed, where something between learner and environments may replace them, such as
    /// a shield. A learner keeps these instead of those that it gave. None where nothing can.
    fn interventions(&self) -> Option<Interventions<'_>> {
        None
    }

    /// Writes everything that decides the future of all environments.
    ///
    /// # Errors
    /// `Unsupported` where a world cannot be written, `InvalidInput` before the first reset.
    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        let _ = snapshot;
        Err(Error::unsupported(format!("{} keeps no snapshots side by side", self.spec().id)))
    }

    /// Takes back what [`Self::save_state`] wrote, in the same order.
    ///
    /// # Errors
    /// `Unsupported` where a world cannot be written, `Format` when the snapshot is of something else.
    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        let _ = state;
        Err(Error::unsupported(format!("{} keeps no snapshots side by side", self.spec().id)))
    }

    /// The state of all environments, to come back to. The last [`Batch`] is the caller's to keep: the next action
    /// follows from it. Threads and arrays leave no trace in it.
    ///
    /// # Errors
    /// As [`Self::save_state`].
    fn snapshot(&self) -> Result<Snapshot> {
        let mut snapshot = Snapshot::new(&snapshot_id(self.spec(), self.count()));
        self.save_state(&mut snapshot)?;
        Ok(snapshot)
    }

    /// Goes back to a state: the same actions then have the same outcome, bit for bit.
    ///
    /// # Errors
    /// `InvalidInput` for a snapshot of others, or of another count of them, else as [`Self::load_state`]. After an
    /// error the environments must be reset.
    fn restore(&mut self, snapshot: &Snapshot) -> Result<()> {
        let mut state = snapshot.read(&snapshot_id(self.spec(), self.count()))?;
        self.load_state(&mut state)?;
        state.finish()
    }
}

/// What a snapshot of several is a snapshot of.
fn snapshot_id(spec: &EnvironmentSpec, count: usize) -> String {
    format!("{count} x {}", spec.id)
}

/// How [`make_vec`](crate::make_vec) makes environments.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct VectorOptions {
    /// How many environments.
    pub count: usize,
    /// When episodes begin anew.
    pub autoreset: Autoreset,
    /// How many threads step them; those so light that threads would slow them down ignore it.
    pub threads: usize,
}

impl VectorOptions {
    /// `count` environments on one thread.
    pub fn new(count: usize) -> Self {
        Self { count, autoreset: Autoreset::default(), threads: 1 }
    }

    pub(crate) fn checked_count(&self) -> Result<usize> {
        check_count(self.count)
    }
}

/// A number of environments that memory allows.
fn check_count(count: usize) -> Result<usize> {
    const MOST: usize = 1 << 20;
    if (1..=MOST).contains(&count) {
        return Ok(count);
    }
    Err(Error::invalid_param(format!("{count} environments; give 1 to {MOST}")))
}

/// Checks sizes of what comes with a reset.
fn check_reset(seeds: &Seeds<'_>, mask: Option<&[bool]>, count: usize) -> Result<()> {
    seeds.check(count)?;
    match mask {
        Some(mask) if mask.len() != count || !mask.contains(&true) => {
            let (len, chosen) = (mask.len(), mask.iter().filter(|chosen| **chosen).count());
            Err(Error::invalid_input(format!(
                "a mask of {len} with {chosen} chosen for {count} environments; give one for each, at least one true"
            )))
        }
        _ => Ok(()),
    }
}

/// Checks the number of actions of a step.
fn check_actions(actions: &[f32], spec: &EnvironmentSpec, count: usize) -> Result<()> {
    let wanted = spec.action.len() * count;
    if actions.len() == wanted {
        return Ok(());
    }
    let given = actions.len();
    Err(Error::invalid_input(format!(
        "{given} numbers of actions for {count} of {}; give {wanted}, environment after environment",
        spec.id
    )))
}
