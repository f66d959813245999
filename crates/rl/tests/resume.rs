//! A training that was stopped, saved and loaded goes on as if nothing had happened, and threads change no bit.

use std::path::PathBuf;

use opendr_engine::{ErrorKind, Random, Result};
use opendr_kernels::Compute;
use opendr_rl::{
    Algorithm, Dqn, DqnConfig, OffPolicyConfig, Ppo, PpoConfig, Sac, SacConfig, SavedState, Td3, Td3Config,
};
use opendr_runlog::Checkpoints;
use opendr_simulation::make_vec;
use opendr_simulation::vector::{Autoreset, VecEnvironment, VectorOptions};

fn environments(id: &str, count: usize, threads: usize) -> Box<dyn VecEnvironment> {
    let options = VectorOptions { count, autoreset: Autoreset::SameStep, threads };
    make_vec(id, options).unwrap()
}

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("opendr-rl-{name}-{}", std::process::id()));
        std::fs::remove_dir_all(&path).ok();
        Self(path)
    }

    fn checkpoints(&self) -> Checkpoints {
        Checkpoints::new(&self.0, 2).unwrap()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        std::fs::remove_dir_all(&self.0).ok();
    }
}

const TOTAL: u64 = 4000;

fn trained(learner: &mut dyn Algorithm, worlds: &mut dyn VecEnvironment, iterations: usize) -> Result<()> {
    (0..iterations).try_for_each(|_| learner.iterate(worlds, TOTAL).map(drop))
}

/// Stops after a number of iterations that nobody chose, goes on elsewhere, and compares everything.
fn assert_resumes<A: Algorithm>(id: &str, count: usize, iterations: usize, make: impl Fn(Compute) -> A) {
    let mut worlds = environments(id, count, 1);
    let mut whole = make(Compute::single());
    trained(&mut whole, &mut *worlds, iterations).unwrap();
    let wanted: SavedState = whole.saved_state(&*worlds).unwrap();

    let nanoseconds = std::time::SystemTime::UNIX_EPOCH.elapsed().unwrap().as_nanos() as u64;
    let stop = 1 + Random::new(nanoseconds).below(iterations - 1);
    let folder = Folder::new(whole.name());
    {
        let mut worlds = environments(id, count, 2);
        let mut first = make(Compute::with_threads(2));
        trained(&mut first, &mut *worlds, stop).unwrap();
        let checkpoints = folder.checkpoints();
        first.save(&checkpoints, &*worlds).unwrap();
        first.save(&checkpoints, &*worlds).unwrap();
    }
    let mut worlds = environments(id, count, 1);
    let mut second = make(Compute::with_threads(2));
    let checkpoint = second.load(&folder.checkpoints(), &mut *worlds).unwrap().unwrap();
    assert_eq!(checkpoint.step, second.report().timesteps);
    trained(&mut second, &mut *worlds, iterations - stop).unwrap();
    assert!(second.saved_state(&*worlds).unwrap() == wanted, "{} stopped after {stop}", whole.name());
    assert_eq!(second.report(), whole.report());
}

#[test]
fn ppo_resumes_bit_for_bit() {
    let config = PpoConfig {
        n_steps: 48,
        n_epochs: 4,
        norm_obs: true,
        norm_reward: true,
        target_kl: Some(0.02),
        clip_range_vf: Some(0.5),
        ent_coef: 0.01,
        seed: 5,
        ..PpoConfig::default()
    };
    let spec = environments("CartPole-v1", 4, 1).spec().clone();
    assert_resumes("CartPole-v1", 4, 9, |compute| Ppo::new(&config, &spec).unwrap().with_compute(compute));
    let spec = environments("Pendulum-v1", 3, 1).spec().clone();
    assert_resumes("Pendulum-v1", 3, 6, |compute| Ppo::new(&config, &spec).unwrap().with_compute(compute));
}

fn small(config: OffPolicyConfig) -> OffPolicyConfig {
    OffPolicyConfig { buffer_size: 300, batch_size: 16, learning_starts: 40, seed: 3, ..config }
}

#[test]
fn off_policy_learners_resume_bit_for_bit() {
    let pendulum = environments("Pendulum-v1", 2, 1).spec().clone();
    let mut sac = SacConfig::default();
    (sac.off_policy, sac.network.net_arch) = (small(sac.off_policy), vec![16, 16]);
    assert_resumes("Pendulum-v1", 2, 220, |compute| Sac::new(&sac, &pendulum).unwrap().with_compute(compute));
    let mut td3 = Td3Config::default();
    (td3.off_policy, td3.network.net_arch) = (small(td3.off_policy), vec![16, 16]);
    assert_resumes("Pendulum-v1", 2, 220, |compute| Td3::new(&td3, &pendulum).unwrap().with_compute(compute));
    let carts = environments("CartPole-v1", 2, 1).spec().clone();
    let mut dqn = DqnConfig { target_update_interval: 30, exploration_fraction: 0.5, ..DqnConfig::default() };
    dqn.off_policy = small(dqn.off_policy);
    assert_resumes("CartPole-v1", 2, 60, |compute| Dqn::new(&dqn, &carts).unwrap().with_compute(compute));
}

#[test]
fn checkpoints_of_others_are_refused() {
    let folder = Folder::new("refused");
    let mut worlds = environments("CartPole-v1", 2, 1);
    let config = PpoConfig { n_steps: 16, ..PpoConfig::default() };
    let mut ppo = Ppo::new(&config, worlds.spec()).unwrap();
    assert!(ppo.saved_state(&*worlds).is_err());
    ppo.iterate(&mut *worlds, TOTAL).unwrap();
    let checkpoints = folder.checkpoints();
    assert!(ppo.load(&checkpoints, &mut *worlds).unwrap().is_none());
    ppo.save(&checkpoints, &*worlds).unwrap();

    let mut other = config.clone();
    other.network.net_arch = vec![32];
    let mut other = Ppo::new(&other, worlds.spec()).unwrap();
    let error = other.load(&checkpoints, &mut *worlds).unwrap_err();
    assert!(error.to_string().contains("numbers in policy"), "{error}");
    let mut dqn = Dqn::new(&DqnConfig::default(), worlds.spec()).unwrap();
    assert_eq!(dqn.load(&checkpoints, &mut *worlds).unwrap_err().kind(), ErrorKind::NotFound);
    let mut three = environments("CartPole-v1", 3, 1);
    let error = Ppo::new(&config, three.spec()).unwrap().load(&checkpoints, &mut *three).unwrap_err();
    assert!(error.to_string().contains("2 environments, not 3"), "{error}");
}
