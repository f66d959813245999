//! Environment steps until a search finds a configuration of PPO that balances the pole, by successive halving, by
//! random search with one evaluation per training, and by random search with 16 evaluations, which stops at the first
//! success:
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

/// Mean return of a solved environment.
const SOLVED: f64 = 475.0;
/// First rung, and interval of evaluations.
const FIRST: u64 = LENGTH / 16;
/// One of this many trials is promoted.
const FACTOR: i64 = 4;

fn main() -> Result<()> {
    let seeds = std::env::args().nth(1).unwrap_or_else(|| "0..3".to_owned());
    let range = seeds.split_once("..").and_then(|(first, end)| Some(first.parse().ok()?..end.parse().ok()?));
    let range: std::ops::Range<u64> = range.ok_or_else(|| {
        Error::invalid_param(format!("{seeds:?} are not seeds; give a range such as 0..10"))
    })?;
    let mut steps = [Vec::new(), Vec::new(), Vec::new()];
    for seed in range {
        let solved_after = [
            steps_to_solve(seed, Asha::new(FIRST as i64, FACTOR)?, FIRST)?,
            steps_to_solve(seed, NoPruner, LENGTH)?,
            steps_to_solve(seed, NoPruner, FIRST)?,
        ];
        println!(
            "seed {seed}: halving {}, random search {}, evaluated often {}",
            solved_after[0], solved_after[1], solved_after[2]
        );
        steps.iter_mut().zip(solved_after).for_each(|(steps, count)| steps.push(count));
    }
    let [halving, random, evaluated_often] = steps.map(|mut steps| {
        steps.sort_unstable();
        let mean = steps.iter().sum::<u64>() as f64 / steps.len().max(1) as f64;
        (steps.get(steps.len() / 2).map_or(0.0, |median| *median as f64), mean)
    });
    println!("median (mean): halving {} ({:.0})", halving.0, halving.1);
    for (name, (median, mean)) in [("random search", random), ("evaluated often", evaluated_often)] {
        println!("{name} {median} ({mean:.0}): share {:.2} ({:.2})", halving.0 / median, halving.1 / mean);
    }
    Ok(())
}

/// Returns the steps of all trainings, evaluated every `interval`, until one reaches the goal.
fn steps_to_solve(seed: u64, pruner: impl Pruner + 'static, interval: u64) -> Result<u64> {
    let study = Study::open(Storage::memory(), "cart_pole", &[Direction::Maximize])?;
    let study = study.with_sampler(RandomSearch::new(seed)).with_pruner(pruner);
    let folder = std::env::temp_dir().join(format!("opendr-cart-pole-{}", std::process::id()));
    let (steps, solved) = (AtomicU64::new(0), Mutex::new(None));
    let begin = |params: &ParamMap, seed| CartPoleTraining::begin(params, seed, &steps);
    // One seed for both: the comparison is of progress, not of certainty.
    let plan = Plan::every(interval, LENGTH)?.with_seeds(seed, 1);
    let tuner = Tuner::new(study, space()?, plan, &folder, begin)?;
    tuner.run(&Budget::more(1000).max_failures(1000), |study, number| {
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
