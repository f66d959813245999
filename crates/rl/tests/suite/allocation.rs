//! After the first iteration, acting and learning allocate nothing.

use opendr_rl::{Algorithm as _, Ppo, PpoConfig};
use opendr_simulation::make_vec;
use opendr_simulation::vector::{Autoreset, VectorOptions};
use opendr_test_allocator::allocations_of_thread;

#[test]
fn iterations_after_the_first_allocate_nothing() {
    for (id, config) in [
        ("CartPole-v1", PpoConfig { n_steps: 64, norm_obs: true, ..PpoConfig::default() }),
        ("Pendulum-v1", PpoConfig { n_steps: 100, norm_reward: true, ..PpoConfig::default() }),
    ] {
        let options = VectorOptions { autoreset: Autoreset::SameStep, ..VectorOptions::new(6) };
        let mut environments = make_vec(id, options).unwrap();
        let mut ppo = Ppo::new(&config, environments.spec()).unwrap();
        // Pendulums are truncated together in every second iteration.
        let mut iterate =
            |times| (0..times).try_for_each(|_| ppo.iterate(&mut *environments, 100_000).map(drop));
        iterate(2).unwrap();
        let before = allocations_of_thread();
        iterate(4).unwrap();
        assert_eq!(allocations_of_thread() - before, 0, "{id}");
    }
}
