//! Shared test code.

pub mod dots;

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use opendr_engine::{Random, Result};
use opendr_kernels::Compute;
use opendr_rl::{Algorithm, SavedState};
use opendr_runlog::Checkpoints;
use opendr_simulation::make_vec;
use opendr_simulation::vector::{Autoreset, VecEnvironment, VectorOptions};

pub fn environments(id: &str, count: usize, threads: usize) -> Box<dyn VecEnvironment> {
    let options = VectorOptions { count, autoreset: Autoreset::SameStep, threads };
    make_vec(id, options).unwrap()
}

pub struct Folder(PathBuf);

impl Folder {
    pub fn new(name: &str) -> Self {
        // Tests of one process run in parallel.
        static COUNT: AtomicUsize = AtomicUsize::new(0);
        let (process, count) = (std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let path = std::env::temp_dir().join(format!("opendr-rl-{name}-{process}-{count}"));
        std::fs::remove_dir_all(&path).ok();
        Self(path)
    }

    pub fn path(&self) -> &Path {
        &self.0
    }

    pub fn checkpoints(&self) -> Checkpoints {
        Checkpoints::new(&self.0, 2).unwrap()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        std::fs::remove_dir_all(&self.0).ok();
    }
}

pub const TOTAL: u64 = 4000;

pub fn trained(
    learner: &mut dyn Algorithm,
    worlds: &mut dyn VecEnvironment,
    iterations: usize,
) -> Result<()> {
    (0..iterations).try_for_each(|_| learner.iterate(worlds, TOTAL).map(drop))
}

/// Stops after a random number of iterations, resumes with other threads, and compares the final states.
pub fn assert_resumes<A: Algorithm>(
    worlds: impl Fn(usize) -> Box<dyn VecEnvironment>,
    iterations: usize,
    make: impl Fn(Compute) -> A,
) {
    let environments = worlds;
    let mut worlds = environments(1);
    let mut whole = make(Compute::single());
    trained(&mut whole, &mut *worlds, iterations).unwrap();
    let expected: SavedState = whole.saved_state(&*worlds).unwrap();

    let nanoseconds = std::time::SystemTime::UNIX_EPOCH.elapsed().unwrap().as_nanos() as u64;
    let stop = 1 + Random::new(nanoseconds).below(iterations - 1);
    let folder = Folder::new(whole.name());
    {
        let mut worlds = environments(2);
        let mut first = make(Compute::with_threads(2));
        trained(&mut first, &mut *worlds, stop).unwrap();
        let checkpoints = folder.checkpoints();
        first.save(&checkpoints, &*worlds).unwrap();
        first.save(&checkpoints, &*worlds).unwrap();
    }
    let mut worlds = environments(1);
    let mut second = make(Compute::with_threads(2));
    let checkpoint = second.load(&folder.checkpoints(), &mut *worlds).unwrap().unwrap();
    assert_eq!(checkpoint.step, second.report().timesteps);
    trained(&mut second, &mut *worlds, iterations - stop).unwrap();
    assert!(second.saved_state(&*worlds).unwrap() == expected, "{} stopped after {stop}", whole.name());
    assert_eq!(second.report(), whole.report());
}
