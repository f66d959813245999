//! Continuous control from image observations.

use crate::support::assert_resumes;
use crate::support::dots::dots;
use opendr_kernels::Compute;
use opendr_rl::{
    ActionMode, Algorithm, NetworkConfig, OffPolicyConfig, Policy, PolicyMemory, Sac, SacConfig, Td3,
    Td3Config, onnx_from_policy,
};

fn small(config: OffPolicyConfig, learning_starts: u64) -> OffPolicyConfig {
    OffPolicyConfig {
        buffer_size: 2000,
        batch_size: 16,
        learning_starts,
        gamma: 0.0,
        learning_rate: 1e-3,
        tau: 0.1,
        ..config
    }
}

fn networks(config: NetworkConfig) -> NetworkConfig {
    NetworkConfig { net_arch: vec![16], ..config }
}

fn sac(compute: Compute, learning_starts: u64) -> Sac {
    let mut config = SacConfig { ent_coef: Some(0.01), ..SacConfig::default() };
    (config.off_policy, config.network) =
        (small(config.off_policy, learning_starts), networks(config.network));
    Sac::new(&config, dots(1).spec()).unwrap().with_compute(compute)
}

fn td3(compute: Compute, learning_starts: u64) -> Td3 {
    let mut config = Td3Config { action_noise_std: 0.3, ..Td3Config::default() };
    (config.off_policy, config.network) =
        (small(config.off_policy, learning_starts), networks(config.network));
    Td3::new(&config, dots(1).spec()).unwrap().with_compute(compute)
}

#[test]
fn image_policies_resume_bit_for_bit() {
    assert_resumes(dots, 30, |compute| sac(compute, 20));
    assert_resumes(dots, 30, |compute| td3(compute, 20));
}

/// Returns the actions for a bright bar on the left and on the right.
fn actions_of(policy: &Policy) -> [f32; 2] {
    let image = |bar: std::ops::Range<usize>| {
        (0..400).map(move |at| if bar.contains(&(at % 20)) { 255.0 } else { 0.0 })
    };
    let both: Vec<f32> = image(3..6).chain(image(14..17)).collect();
    let (mut memory, mut actions) = (PolicyMemory::default(), [0.0; 2]);
    policy.act(&Compute::single(), &both, ActionMode::Deterministic, &mut memory, &mut actions).unwrap();
    actions
}

#[test]
fn policies_learn_from_images() {
    let mut learners: [Box<dyn Algorithm>; 2] =
        [Box::new(sac(Compute::single(), 200)), Box::new(td3(Compute::single(), 200))];
    for learner in &mut learners {
        let mut worlds = dots(1);
        let iterations = (0..5000).position(|_| {
            learner.iterate(&mut *worlds, 10_000).unwrap();
            let [left, right] = actions_of(learner.policy());
            left < -0.8 && right > 0.8
        });
        assert!(iterations.is_some(), "{}: {:?}", learner.name(), actions_of(learner.policy()));
        let policy = Policy::from_bytes(&learner.policy().to_bytes().unwrap()).unwrap();
        assert!(policy == *learner.policy() && !onnx_from_policy(&policy).unwrap().is_empty());
    }
}
