//! After the first iteration, acting and learning allocate nothing.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};

use opendr_rl::{Algorithm as _, Ppo, PpoConfig};
use opendr_simulation::make_vec;
use opendr_simulation::vector::{Autoreset, VectorOptions};

struct Counting;

static ALLOCATIONS: AtomicUsize = AtomicUsize::new(0);

// SAFETY: passes everything on to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        // SAFETY: the caller's promise.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller's promise.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

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
        let before = ALLOCATIONS.load(Ordering::Relaxed);
        iterate(4).unwrap();
        assert_eq!(ALLOCATIONS.load(Ordering::Relaxed) - before, 0, "{id}");
    }
}
