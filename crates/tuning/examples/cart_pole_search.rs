//! How many steps of environments a search takes until a configuration of PPO balances the pole: by successive halving, by
//! random search, which measures whole trainings, and by random search that looks at every training 16 times, and ends when
//! it has seen enough:
//!
//! ```console
//! $ cargo run --release -p opendr-tuning --example cart_pole_search -- 0..10
//! ```

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use opendr_engine::params::ParamMap;
use opendr_engine::{Error, Result};
use opendr_tuning::{
    Asha, Budget, Direction, NoPruner, Plan, Progress, Pruner, RandomSearch, Storage, Study, Tuner,
};

#[path = "cart_pole_search/training.rs"]
mod training;

use training::{CartPoleTraining, LENGTH, space};

/// What a configuration is to come to.
const SOLVED: f64 = 475.0;
/// The first rung, and the distance of measurements.
const FIRST: u64 = LENGTH / 16;
/// Of so many one is promoted.
const FACTOR: i64 = 4;

fn main() -> Result<()> {
    let seeds = std::env::args().nth(1).unwrap_or_else(|| "0..3".to_owned());
    let range = seeds.split_once("..").and_then(|(first, end)| Some(first.parse().ok()?..end.parse().ok()?));
    let range: std::ops::Range<u64> =
        range.ok_or_else(|| Error::invalid_param(format!("{seeds:?}: give seeds as 0..10")))?;
    let mut steps = [Vec::new(), Vec::new(), Vec::new()];
    for seed in range {
        let found = [
            steps_to_solve(seed, Asha::new(FIRST as i64, FACTOR)?, FIRST)?,
            steps_to_solve(seed, NoPruner, LENGTH)?,
            steps_to_solve(seed, NoPruner, FIRST)?,
        ];
        println!("seed {seed}: halving {}, random search {}, looked at {}", found[0], found[1], found[2]);
        steps.iter_mut().zip(found).for_each(|(steps, found)| steps.push(found));
    }
    let [halving, random, looked_at] = steps.map(|mut steps| {
        steps.sort_unstable();
        let mean = steps.iter().sum::<u64>() as f64 / steps.len().max(1) as f64;
        (steps.get(steps.len() / 2).map_or(0.0, |median| *median as f64), mean)
    });
    println!("median (mean): halving {} ({:.0})", halving.0, halving.1);
    for (name, (median, mean)) in [("random search", random), ("looked at", looked_at)] {
        println!("{name} {median} ({mean:.0}): share {:.2} ({:.2})", halving.0 / median, halving.1 / mean);
    }
    Ok(())
}

/// Steps of all trainings, measured after every `interval`, until one has measured enough.
fn steps_to_solve(seed: u64, pruner: impl Pruner + 'static, interval: u64) -> Result<u64> {
    let study = Study::open(Storage::memory(), "cart_pole", &[Direction::Maximize])?;
    let study = study.with_sampler(RandomSearch::new(seed)).with_pruner(pruner);
    let folder = std::env::temp_dir().join(format!("opendr-cart-pole-{}", std::process::id()));
    let (steps, solved) = (AtomicU64::new(0), Mutex::new(None));
    let begin = |params: &ParamMap, seed| CartPoleTraining::begin(params, seed, &steps);
    // One seed, for both: how far a search comes is to be seen, not how sure one can be of it.
    let plan = Plan::every(interval, LENGTH)?.with_seeds(seed, 1);
    let tuner = Tuner::new(study, space()?, plan, &folder, begin)?;
    tuner.run(&Budget::more(1000).failures(1000), |study, number| {
        let last = study.trials.get(number).and_then(|trial| trial.last_report());
        match last.is_some_and(|(_, value)| value >= SOLVED) {
            true => {
                if let Ok(mut solved) = solved.lock() {
                    *solved = Some(steps.load(Ordering::Relaxed));
                }
                Progress::Stop
            }
            false => Progress::Continue,
        }
    })?;
    std::fs::remove_dir_all(folder)?;
    let solved = solved.into_inner().ok().flatten();
    solved.ok_or_else(|| Error::not_found("none of a thousand configurations balances the pole"))
}
