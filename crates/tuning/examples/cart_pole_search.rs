//! How many steps of environments a search takes until a configuration of PPO balances the pole, by successive halving and
//! by random search:
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

fn main() -> Result<()> {
    let seeds = std::env::args().nth(1).unwrap_or_else(|| "0..3".to_owned());
    let range = seeds.split_once("..").and_then(|(first, end)| Some(first.parse().ok()?..end.parse().ok()?));
    let range: std::ops::Range<u64> =
        range.ok_or_else(|| Error::invalid_param(format!("{seeds:?}: give seeds as 0..10")))?;
    let mut shares = Vec::new();
    for seed in range {
        let halving = steps_to_solve(seed, Asha::new(FIRST as i64, 4)?)?;
        let random = steps_to_solve(seed, NoPruner)?;
        shares.push(halving as f64 / random as f64);
        println!(
            "seed {seed}: halving {halving} steps, random search {random}, share {:.3}",
            shares[shares.len() - 1]
        );
    }
    shares.sort_by(f64::total_cmp);
    println!("median share {:.3}", shares[shares.len() / 2]);
    Ok(())
}

/// Steps of all trainings until one has measured enough.
fn steps_to_solve(seed: u64, pruner: impl Pruner + 'static) -> Result<u64> {
    let study = Study::open(Storage::memory(), "cart_pole", &[Direction::Maximize])?;
    let study = study.with_sampler(RandomSearch::new(seed)).with_pruner(pruner);
    let folder = std::env::temp_dir().join(format!("opendr-cart-pole-{}", std::process::id()));
    let (steps, solved) = (AtomicU64::new(0), Mutex::new(None));
    let begin = |params: &ParamMap, seed| CartPoleTraining::begin(params, seed, &steps);
    // One seed, for both: how far a search comes is to be seen, not how sure one can be of it.
    let plan = Plan::every(FIRST, LENGTH)?.with_seeds(seed, 1);
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
