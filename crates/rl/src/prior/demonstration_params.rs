//! Demonstrations as parameters of a training.

use opendr_engine::environment::Environment;
use opendr_engine::params::Params;
use opendr_engine::{Error, Result};
use opendr_kernels::Compute;

use super::{DemonstratedSteps, Prior, begin_as_clone};
use crate::algorithm::Algorithm;
use crate::behaviour_cloning::BehaviourCloningConfig;
use crate::{Ppo, Sac, Td3};

/// Demonstrations of a prior that a policy is cloned from before its training.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct ClonedDemonstrations {
    /// Name of the prior whose behaviour is cloned before the training, in its newest version; none clones nothing.
    pub demonstration_prior: Option<String>,
    /// Episodes that the prior demonstrates.
    #[param(default = 100, range = 1..=1_000_000)]
    pub demonstration_episodes: u64,
}

/// Demonstrations of a prior that keep a share of every batch.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct ReplayedDemonstrations {
    /// Name of the prior whose steps are in every batch, in its newest version; none uses no demonstrations.
    pub demonstration_prior: Option<String>,
    /// Episodes that the prior demonstrates.
    #[param(default = 100, range = 1..=1_000_000)]
    pub demonstration_episodes: u64,
    /// Share of demonstrated steps in every batch.
    #[param(default = 0.5, range = 0.0..=1.0)]
    pub demonstration_share: f32,
}

/// Creates an environment of the training.
pub type MakeEnvironment<'a> = &'a dyn Fn() -> Result<Box<dyn Environment>>;

/// Seed of the first demonstrated episode, far from those of trainings and evaluations.
const FIRST_SEED: u64 = 1 << 42;

fn record(prior: &str, episodes: u64, make: MakeEnvironment<'_>) -> Result<DemonstratedSteps> {
    let mut environment =
        make().map_err(|error| error.context("making the environment of demonstrations"))?;
    let mut controller = Prior::newest(prior)?.controller(&environment.spec().observation)?;
    DemonstratedSteps::record(&mut *controller, &mut *environment, FIRST_SEED..FIRST_SEED + episodes)
}

/// Demonstrations that prepare an algorithm for its training.
pub trait Demonstrating<A> {
    /// Prepares `algorithm` by demonstrations in an environment that `make` creates. A policy that starts `from_base` is not cloned.
    ///
    /// # Errors
    /// As [`Prior::newest`], [`DemonstratedSteps::record`] and the method that uses them.
    fn prepare(&self, algorithm: &mut A, from_base: bool, make: MakeEnvironment<'_>) -> Result<()>;
}

impl Demonstrating<Ppo> for ClonedDemonstrations {
    fn prepare(&self, ppo: &mut Ppo, from_base: bool, make: MakeEnvironment<'_>) -> Result<()> {
        match &self.demonstration_prior {
            None => Ok(()),
            Some(prior) if from_base => Err(Error::invalid_param(format!(
                "demonstration_prior is {prior}, but the training starts from a policy; omit one of them"
            ))),
            Some(prior) => {
                let steps = record(prior, self.demonstration_episodes, make)?;
                begin_as_clone(ppo, &steps, &BehaviourCloningConfig::default(), &Compute::single()).map(drop)
            }
        }
    }
}

macro_rules! replayed {
    ($($algorithm:ident),*) => {$(
        impl Demonstrating<$algorithm> for ReplayedDemonstrations {
            fn prepare(&self, algorithm: &mut $algorithm, _: bool, make: MakeEnvironment<'_>) -> Result<()> {
                let Some(prior) = &self.demonstration_prior else { return Ok(()) };
                let steps = record(prior, self.demonstration_episodes, make)?;
                algorithm
                    .set_demonstrations(&steps, self.demonstration_share)
                    .map_err(|error| error.context(format!("demonstrations of {prior} for {}", algorithm.name())))
            }
        }
    )*};
}

replayed!(Sac, Td3);
