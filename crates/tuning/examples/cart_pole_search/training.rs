//! PPO on CartPole as a tunable training.

use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

use opendr_engine::Result;
use opendr_engine::environment::Environment;
use opendr_engine::params::{ParamMap, Params as _};
use opendr_rl::{Algorithm as _, EvaluationProtocol, Ppo, PpoConfig, evaluate};
use opendr_runlog::Checkpoints;
use opendr_simulation::vector::{Autoreset, VecEnvironment, VectorOptions};
use opendr_simulation::{make, make_vec};
use opendr_tuning::{Distribution, SearchSpace, Training};

/// Environment steps of a whole training.
pub const LENGTH: u64 = 49_152;

pub struct CartPoleTraining<'a> {
    ppo: Ppo,
    carts: Box<dyn VecEnvironment>,
    cart: Box<dyn Environment>,
    /// Total steps of all trainings.
    steps: &'a AtomicU64,
}

impl<'a> CartPoleTraining<'a> {
    pub fn begin(params: &ParamMap, seed: u64, steps: &'a AtomicU64) -> Result<Self> {
        let mut config = PpoConfig { seed, ..PpoConfig::default() };
        params.iter().try_for_each(|(name, value)| config.set(name, value.clone()))?;
        let options = VectorOptions { autoreset: Autoreset::SameStep, ..VectorOptions::new(8) };
        let carts = make_vec("CartPole-v1", options)?;
        Ok(Self { ppo: Ppo::new(&config, carts.spec())?, carts, cart: make("CartPole-v1")?, steps })
    }
}

impl Training for CartPoleTraining<'_> {
    /// Returns the mean return of twenty fixed episodes.
    fn advance(&mut self, until: u64) -> Result<Option<f64>> {
        let before = self.ppo.report().timesteps;
        while self.ppo.report().timesteps < until {
            self.ppo.iterate(&mut *self.carts, LENGTH)?;
        }
        self.steps.fetch_add(self.ppo.report().timesteps - before, Ordering::Relaxed);
        let protocol = EvaluationProtocol { episodes: 20, ..EvaluationProtocol::default() };
        Ok(Some(evaluate(self.ppo.policy(), &mut *self.cart, &protocol)?.mean_return))
    }

    fn save(&self, folder: &Path) -> Result<()> {
        self.ppo.save(&Checkpoints::new(folder, 1)?, &*self.carts).map(drop)
    }

    fn load(&mut self, folder: &Path) -> Result<()> {
        self.ppo.load(&Checkpoints::new(folder, 1)?, &mut *self.carts).map(drop)
    }
}

/// Returns the search space of rl-zoo for PPO, without the network.
pub fn space() -> Result<SearchSpace> {
    SearchSpace::new()
        .with("learning_rate", Distribution::log_float(1e-5, 1.0)?)?
        .with("n_steps", Distribution::categorical([16, 32, 64, 128, 256, 512])?)?
        .with("batch_size", Distribution::categorical([32, 64, 128, 256, 512])?)?
        .with("n_epochs", Distribution::categorical([1, 5, 10, 20])?)?
        .with("gamma", Distribution::categorical([0.9, 0.95, 0.98, 0.99, 0.995, 0.999, 0.9999])?)?
        .with("gae_lambda", Distribution::categorical([0.8, 0.9, 0.92, 0.95, 0.98, 0.99, 1.0])?)?
        .with("clip_range", Distribution::categorical([0.1, 0.2, 0.3, 0.4])?)?
        .with("ent_coef", Distribution::log_float(1e-8, 0.1)?)?
        .with("max_grad_norm", Distribution::categorical([0.3, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 2.0, 5.0])?)?
        .with("vf_coef", Distribution::float(0.0, 1.0)?)
}
