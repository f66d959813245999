//! A resumed training gives the same result bit for bit, with any number of threads.

use crate::support::{Folder, TOTAL, assert_resumes, environments, trained};
use opendr_engine::ErrorKind;
use opendr_rl::{
    ActionNoise, Algorithm, Dqn, DqnConfig, OffPolicyConfig, Ppo, PpoConfig, Sac, SacConfig, Td3, Td3Config,
};

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
    assert_resumes(
        |threads| environments("CartPole-v1", 4, threads),
        9,
        |compute| Ppo::new(&config, &spec).unwrap().with_compute(compute),
    );
    let spec = environments("Pendulum-v1", 3, 1).spec().clone();
    assert_resumes(
        |threads| environments("Pendulum-v1", 3, threads),
        6,
        |compute| Ppo::new(&config, &spec).unwrap().with_compute(compute),
    );
}

#[test]
fn recurrent_ppo_resumes_bit_for_bit() {
    let mut config = PpoConfig { n_steps: 48, n_epochs: 3, batch_size: 40, seed: 6, ..PpoConfig::default() };
    (config.network.gru_size, config.network.net_arch) = (Some(12), vec![16]);
    for (id, count, sequence_length) in [("CartPole-v1", 4, None), ("Pendulum-v1", 6, Some(12))] {
        let config = PpoConfig { sequence_length, ..config.clone() };
        let spec = environments(id, count, 1).spec().clone();
        let worlds = |threads| environments(id, count, threads);
        assert_resumes(worlds, 7, |compute| Ppo::new(&config, &spec).unwrap().with_compute(compute));
    }
}

fn small(config: OffPolicyConfig) -> OffPolicyConfig {
    OffPolicyConfig {
        buffer_size: 300,
        batch_size: 16,
        learning_starts: 40,
        norm_obs: true,
        seed: 3,
        ..config
    }
}

#[test]
fn off_policy_learners_resume_bit_for_bit() {
    let pendulum = environments("Pendulum-v1", 2, 1).spec().clone();
    let mut sac = SacConfig::default();
    (sac.off_policy, sac.network.net_arch) = (small(sac.off_policy), vec![16, 16]);
    assert_resumes(
        |threads| environments("Pendulum-v1", 2, threads),
        220,
        |compute| Sac::new(&sac, &pendulum).unwrap().with_compute(compute),
    );
    let mut td3 = Td3Config { action_noise: ActionNoise::OrnsteinUhlenbeck, ..Td3Config::default() };
    (td3.off_policy, td3.network.net_arch) = (small(td3.off_policy), vec![16, 16]);
    assert_resumes(
        |threads| environments("Pendulum-v1", 2, threads),
        220,
        |compute| Td3::new(&td3, &pendulum).unwrap().with_compute(compute),
    );
    let carts = environments("CartPole-v1", 2, 1).spec().clone();
    let mut dqn = DqnConfig { target_update_interval: 30, exploration_fraction: 0.5, ..DqnConfig::default() };
    dqn.off_policy = small(dqn.off_policy);
    assert_resumes(
        |threads| environments("CartPole-v1", 2, threads),
        60,
        |compute| Dqn::new(&dqn, &carts).unwrap().with_compute(compute),
    );
}

#[test]
fn checkpoints_of_other_algorithms_are_refused() {
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

/// Saves a checkpoint as version 0.1.0 wrote it, without the array of shielded steps, and resumes from it.
fn assert_resumes_from_older_version<A: Algorithm>(id: &str, iterations: usize, make: impl Fn() -> A) {
    let folder = Folder::new("older-version");
    let mut worlds = environments(id, 2, 1);
    let mut whole = make();
    trained(&mut whole, &mut *worlds, iterations).unwrap();
    let files = whole.saved_state(&*worlds).unwrap().files().unwrap();
    let older = files.iter().filter(|(name, _)| name != "replay_shielded.f32");
    let older: Vec<_> = older.map(|(name, bytes)| (name.as_str(), &bytes[..])).collect();
    assert_eq!(older.len() + 1, files.len());
    folder.checkpoints().save(whole.report().timesteps, &older).unwrap();

    let mut resumed_worlds = environments(id, 2, 1);
    let mut resumed = make();
    resumed.load(&folder.checkpoints(), &mut *resumed_worlds).unwrap().unwrap();
    for (learner, worlds) in [(&mut whole, &mut worlds), (&mut resumed, &mut resumed_worlds)] {
        trained(learner, &mut **worlds, iterations).unwrap();
    }
    assert_eq!(resumed.saved_state(&*resumed_worlds).unwrap(), whole.saved_state(&*worlds).unwrap());
    // An array that every version writes is still required.
    let damaged: Vec<_> = older.into_iter().filter(|(name, _)| *name != "replay_rewards.f32").collect();
    folder.checkpoints().save(whole.report().timesteps, &damaged).unwrap();
    let error = make().load(&folder.checkpoints(), &mut *environments(id, 2, 1)).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::NotFound, "{error}");
}

#[test]
fn checkpoints_without_shielded_steps_resume() {
    let pendulum = environments("Pendulum-v1", 2, 1).spec().clone();
    let mut sac = SacConfig::default();
    (sac.off_policy, sac.network.net_arch) = (small(sac.off_policy), vec![16, 16]);
    assert_resumes_from_older_version("Pendulum-v1", 60, || Sac::new(&sac, &pendulum).unwrap());
    let mut td3 = Td3Config::default();
    (td3.off_policy, td3.network.net_arch) = (small(td3.off_policy), vec![16, 16]);
    assert_resumes_from_older_version("Pendulum-v1", 60, || Td3::new(&td3, &pendulum).unwrap());
    let carts = environments("CartPole-v1", 2, 1).spec().clone();
    let mut dqn = DqnConfig::default();
    dqn.off_policy = small(dqn.off_policy);
    assert_resumes_from_older_version("CartPole-v1", 30, || Dqn::new(&dqn, &carts).unwrap());
}
