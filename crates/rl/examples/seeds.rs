//! Trains algorithms with several seeds and prints a Markdown table of their returns:
//! `cargo run --release -p opendr-rl --example seeds -- [--seeds 10] [TASK ...]`, tasks as `ppo/CartPole-v1`; default all.
//!
//! A policy is evaluated by the mean return of its most likely actions in 100 held-out episodes. Two policies are evaluated: the
//! last one, and the best of ten evaluations during the training, in 20 other episodes.

use opendr_engine::{Error, Result};
use opendr_rl::{
    Algorithm, Dqn, DqnConfig, EvaluationProtocol, Policy, Ppo, PpoConfig, Sac, SacConfig, SuccessRate, Td3,
    Td3Config, evaluate,
};
use opendr_simulation::vector::{Autoreset, VecEnvironment, VectorOptions};
use opendr_simulation::{make, make_vec};

/// Algorithm, environment, goal of the mean return, and steps of the training if they differ from the preset.
const TASKS: &[(&str, &str, f64, Option<u64>)] = &[
    ("ppo", "CartPole-v1", 475.0, None),
    ("dqn", "CartPole-v1", 475.0, None),
    ("ppo", "Pendulum-v1", -200.0, None),
    ("sac", "Pendulum-v1", -200.0, Some(10_000)),
    ("ppo", "Acrobot-v1", -100.0, Some(300_000)),
    ("td3", "MountainCarContinuous-v0", 90.0, None),
];

fn main() -> Result<()> {
    let (mut seeds, mut chosen) = (10, Vec::new());
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--seeds" => {
                let number = arguments.next().and_then(|number| number.parse().ok());
                seeds = number.ok_or_else(|| Error::invalid_param("--seeds needs a number"))?;
            }
            _ => chosen.push(argument),
        }
    }
    println!(
        "| learner, environment | steps | goal | at the end: median | min | max | reached | kept: median | min | max | reached, 95 % interval | CPU-seconds |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|");
    for &(learner, id, goal, timesteps) in TASKS {
        let name = format!("{learner}/{id}");
        if chosen.is_empty() || chosen.contains(&name) {
            row(learner, id, goal, timesteps, seeds)?;
        }
    }
    Ok(())
}

/// Number of evaluations during a training.
const EVALUATIONS: u64 = 10;
/// Validation episodes, separate from those of the training and of the table.
const VALIDATION: EvaluationProtocol =
    EvaluationProtocol { episodes: 20, first_seed: 2_000_000, deterministic: true, max_steps: 100_000 };

fn row(learner: &str, id: &str, goal: f64, timesteps: Option<u64>, seeds: u64) -> Result<()> {
    let (mut at_the_end, mut kept, mut seconds, mut steps) = (Vec::new(), Vec::new(), Vec::new(), 0);
    for seed in 0..seeds {
        let mut training = begin(learner, id, seed)?;
        let total = timesteps.unwrap_or(training.timesteps);
        let (mut best, mut spent) = (None, 0.0);
        for part in 1..=EVALUATIONS {
            let begun = cpu_seconds();
            while training.learner.report().timesteps < total * part / EVALUATIONS {
                steps = training.learner.iterate(&mut *training.environments, total)?.timesteps;
            }
            spent += cpu_seconds() - begun;
            let policy = training.learner.policy();
            let earned = evaluate(policy, &mut *make(id)?, &VALIDATION)?.mean_return;
            if best.as_ref().is_none_or(|(most, _)| earned > *most) {
                best = Some((earned, policy.clone()));
            }
        }
        seconds.push(spent);
        let measure = |policy: &Policy| evaluate(policy, &mut *make(id)?, &EvaluationProtocol::default());
        at_the_end.push(measure(training.learner.policy())?.mean_return);
        kept.push(best.map_or(Ok(f64::NAN), |(_, policy)| measure(&policy).map(|found| found.mean_return))?);
    }
    seconds.sort_by(f64::total_cmp);
    let (end, kept) = (cells(at_the_end, goal)?, cells(kept, goal)?);
    println!(
        "| {learner}, {id} | {steps} | {goal} | {} | {} of {seeds} | {} | {} of {seeds}, {:.0} to {:.0} % | {:.1} |",
        end.returns,
        end.reached,
        kept.returns,
        kept.reached,
        100.0 * kept.interval[0],
        100.0 * kept.interval[1],
        median(&seconds)
    );
    Ok(())
}

/// Cells of the table for the returns of all seeds.
struct Cells {
    returns: String,
    reached: u64,
    interval: [f64; 2],
}

fn cells(mut returns: Vec<f64>, goal: f64) -> Result<Cells> {
    returns.sort_by(f64::total_cmp);
    let reached = returns.iter().filter(|mean| **mean >= goal).count() as u64;
    let (Some(rate), [lowest, .., highest]) = (SuccessRate::of(reached, returns.len() as u64), &returns[..])
    else {
        return Err(Error::invalid_param(format!("{} seeds; give at least 2", returns.len())));
    };
    let returns = format!("{:.1} | {lowest:.1} | {highest:.1}", median(&returns));
    Ok(Cells { returns, reached, interval: rate.interval })
}

/// Returns the median of sorted numbers.
fn median(sorted: &[f64]) -> f64 {
    let middle = sorted.len() / 2;
    if sorted.len().is_multiple_of(2) { 0.5 * (sorted[middle - 1] + sorted[middle]) } else { sorted[middle] }
}

struct Training {
    learner: Box<dyn Algorithm>,
    environments: Box<dyn VecEnvironment>,
    timesteps: u64,
}

fn begin(learner: &str, id: &str, seed: u64) -> Result<Training> {
    let unknown = || Error::not_found(format!("no settings of {learner} for {id}"));
    let worlds =
        |count| make_vec(id, VectorOptions { autoreset: Autoreset::SameStep, ..VectorOptions::new(count) });
    macro_rules! preset {
        ($learner:ident, $config:ident, $($seed:ident).+) => {{
            let mut preset = $config::preset(id).ok_or_else(unknown)?;
            preset.config.$($seed).+ = seed;
            let environments = worlds(preset.environments)?;
            let learner = Box::new($learner::new(&preset.config, environments.spec())?);
            Ok(Training { learner, environments, timesteps: preset.timesteps })
        }};
    }
    match learner {
        "ppo" => preset!(Ppo, PpoConfig, seed),
        "sac" => preset!(Sac, SacConfig, off_policy.seed),
        "td3" => preset!(Td3, Td3Config, off_policy.seed),
        "dqn" => preset!(Dqn, DqnConfig, off_policy.seed),
        _ => Err(unknown()),
    }
}

/// Returns the CPU time of this thread in seconds; 0 if the system does not report it.
fn cpu_seconds() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    text.split(' ').next().and_then(|time| time.parse::<f64>().ok()).map_or(0.0, |time| time * 1e-9)
}
