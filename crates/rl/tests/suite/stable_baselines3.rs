//! Imported policies of Stable-Baselines3 give the same actions.
//!
//! `tests/rl/write_stable_baselines3.py` wrote the files in `data`.

use opendr_kernels::Compute;
use opendr_rl::{ActionMode, PolicyMemory, policy_from_stable_baselines3};
use opendr_simulation::make;

const POLICIES: [(&str, &str, &[u8]); 5] = [
    ("ppo_cart_pole", "CartPole-v1", include_bytes!("../data/ppo_cart_pole.zip")),
    ("ppo_pendulum", "Pendulum-v1", include_bytes!("../data/ppo_pendulum.zip")),
    ("sac_pendulum", "Pendulum-v1", include_bytes!("../data/sac_pendulum.zip")),
    ("td3_pendulum", "Pendulum-v1", include_bytes!("../data/td3_pendulum.zip")),
    ("dqn_cart_pole", "CartPole-v1", include_bytes!("../data/dqn_cart_pole.zip")),
];

#[test]
fn actions_are_those_of_stable_baselines3() {
    let answers: serde_json::Value = serde_json::from_str(include_str!("../data/answers.json")).unwrap();
    for (name, id, bytes) in POLICIES {
        let numbers = |key: &str| -> Vec<f32> {
            let numbers = answers[name][key].as_array().unwrap();
            numbers.iter().map(|number| number.as_f64().unwrap() as f32).collect()
        };
        let policy = policy_from_stable_baselines3(bytes, make(id).unwrap().spec()).unwrap();
        let (wanted, mut actions) = (numbers("actions"), vec![9.0; 8]);
        let (compute, mut memory) = (Compute::single(), PolicyMemory::default());
        let acting = ActionMode::Deterministic;
        policy.act(&compute, &numbers("observations"), acting, &mut memory, &mut actions).unwrap();
        for (action, wanted) in actions.iter().zip(&wanted) {
            assert!((action - wanted).abs() < 1e-6, "{name}: {actions:?} {wanted:?}");
        }
        assert!(wanted.iter().any(|action| *action != wanted[0]), "{name} always gives the same action");
    }
}

#[test]
fn mismatched_and_damaged_policies_are_refused() {
    let (cart, pendulum) = (make("CartPole-v1").unwrap(), make("Pendulum-v1").unwrap());
    assert!(policy_from_stable_baselines3(POLICIES[0].2, pendulum.spec()).is_err());
    assert!(policy_from_stable_baselines3(POLICIES[2].2, cart.spec()).is_err());
    for (_, id, bytes) in POLICIES {
        let world = make(id).unwrap();
        for cut in [0, 1, bytes.len() / 2, bytes.len() - 1] {
            assert!(policy_from_stable_baselines3(&bytes[..cut], world.spec()).is_err());
        }
        // No damaged file causes a panic.
        for at in (0..bytes.len()).step_by(7) {
            let mut damaged = bytes.to_vec();
            damaged[at] ^= 0x55;
            drop(policy_from_stable_baselines3(&damaged, world.spec()));
        }
    }
}
