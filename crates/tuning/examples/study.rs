//! Runs a study of a function with a known minimum, for comparisons with other programs:
//!
//! ```console
//! $ cargo run --release -p opendr-tuning --example study -- branin --trials 100 --seeds 0..30
//! $ cargo run --release -p opendr-tuning --example study -- mixed --trials 50 --journal study.log --name first
//! $ cargo run --release -p opendr-tuning --example study -- show --journal study.log --figures pictures
//! ```
//!
//! Prints one line of JSON per seed: the seed, the best value and its parameters.

use std::collections::BTreeMap;
use std::path::Path;

use opendr_engine::{Error, Result};
use opendr_runlog::{svg_from_figure, write_atomically};
use opendr_tuning::{
    Budget, CmaEs, Direction, Distribution, Outcome, Progress, QuasiRandom, RandomSearch, SearchSpace,
    Storage, Study, Tpe, Trial, history_figure, importance_figure, importance_from_study,
};
use serde_json::{Value, json};

#[path = "study/functions.rs"]
mod functions;

fn main() -> Result<()> {
    let mut args = std::env::args().skip(1);
    let function = args.next().unwrap_or_default();
    let mut options: BTreeMap<String, String> = BTreeMap::new();
    while let Some(name) = args.next() {
        options.insert(name, args.next().unwrap_or_default());
    }
    let option = |name: &str, default: &str| options.get(name).cloned().unwrap_or_else(|| default.to_owned());
    let number = |text: &str| {
        text.parse::<u64>().map_err(|_| Error::invalid_param(format!("{text:?} is not a number from 0")))
    };
    if function == "show" {
        return show(
            &option("--journal", ""),
            &option("--sqlite", ""),
            &option("--into", ""),
            &option("--figures", ""),
        );
    }
    let seeds = option("--seeds", "0..1");
    let (first, end) = seeds.split_once("..").unwrap_or((&seeds, &seeds));
    let trials = usize::try_from(number(&option("--trials", "100"))?).unwrap_or(usize::MAX);
    let threads = usize::try_from(number(&option("--threads", "1"))?).unwrap_or(1);
    for seed in number(first)?..number(end)? {
        let storage = match options.get("--journal") {
            Some(path) => Storage::journal(path)?,
            None => Storage::memory(),
        };
        let study = Study::open(storage, &option("--name", "study"), &[Direction::Minimize])?;
        let study = with_sampler(study, &option("--sampler", "tpe"), seed)?;
        run(&study, &function, &Budget::total(trials).threads(threads))?;
        let importance = study.inspect(importance_from_study);
        let best = study.best().ok_or_else(|| Error::internal("no trial is complete"))?;
        let params: BTreeMap<_, Value> = best.params.iter().map(|(name, it)| (name, it.value())).collect();
        let count = study.inspect(|study| study.trials.len());
        println!(
            "{}",
            json!({"seed": seed, "best": best.value(), "params": params, "trials": count, "importance": importance})
        );
    }
    Ok(())
}

fn with_sampler(study: Study, name: &str, seed: u64) -> Result<Study> {
    Ok(match name {
        "tpe" => study.with_sampler(Tpe::new(seed)),
        "random" => study.with_sampler(RandomSearch::new(seed)),
        "quasi_random" => study.with_sampler(QuasiRandom::new(seed)),
        "cma_es" => study.with_sampler(CmaEs::new(seed)),
        _ => return Err(Error::invalid_param(format!("{name:?}: give tpe, random, quasi_random or cma_es"))),
    })
}

fn run(study: &Study, function: &str, budget: &Budget) -> Result<()> {
    let (space, value): (SearchSpace, fn(&Trial<'_>) -> Result<f64>) = match function {
        "branin" => (
            SearchSpace::new()
                .with("x", Distribution::float(-5.0, 10.0)?)?
                .with("y", Distribution::float(0.0, 15.0)?)?,
            functions::branin,
        ),
        "hartmann6" => (cube(6, 0.0, 1.0)?, functions::hartmann6),
        "rosenbrock5" => (cube(5, -2.0, 2.0)?, functions::rosenbrock5),
        "mixed" => (
            SearchSpace::new()
                .with("lr", Distribution::log_float(1e-6, 1e-1)?)?
                .with("batch", Distribution::log_int(16, 1024)?)?
                .with("gamma", Distribution::float(0.8, 0.9999)?)?
                .with("optimizer", Distribution::categorical(["sgd", "adam", "rmsprop"])?)?
                .with_when("momentum", Distribution::float(0.0, 0.99)?, "optimizer", ["sgd"])?,
            functions::mixed,
        ),
        _ => {
            return Err(Error::invalid_param(format!(
                "{function:?}: give branin, hartmann6, rosenbrock5 or mixed, or show --journal FILE"
            )));
        }
    };
    study.optimize(&space, budget, |trial| value(trial).map(Outcome::from), |_, _| Progress::Continue)
}

fn cube(size: usize, low: f64, high: f64) -> Result<SearchSpace> {
    (0..size).try_fold(SearchSpace::new(), |space, at| {
        space.with(format!("x{at}"), Distribution::float(low, high)?)
    })
}

/// Prints the content of a file, copies its studies `into` a journal, and draws them into the folder `figures`.
fn show(journal: &str, sqlite: &str, into: &str, figures: &str) -> Result<()> {
    let storage = if sqlite.is_empty() { Storage::journal(journal)? } else { Storage::sqlite(sqlite)? };
    for study in storage.studies() {
        let trials = study.trials.iter().map(|trial| {
            let params: BTreeMap<_, Value> = trial.params.iter().map(|(name, it)| (name, it.value())).collect();
            json!({
                "number": trial.number, "state": format!("{:?}", trial.state), "params": params,
                "values": trial.values.iter().map(f64::to_string).collect::<Vec<_>>(),
                "reports": trial.reports.iter().map(|(step, value)| (step.to_string(), value.to_string())).collect::<BTreeMap<_, _>>(),
                "user": trial.user_attributes, "started": trial.started.map(|at| at.to_string()),
                "distributions": trial.params.iter().map(|(name, it)| (name, it.distribution.to_string())).collect::<BTreeMap<_, _>>(),
            })
        });
        let directions: Vec<_> = study.directions.iter().map(|direction| format!("{direction:?}")).collect();
        let trials: Vec<_> = trials.collect();
        println!(
            "{}",
            json!({"name": study.name, "directions": directions, "trials": trials, "user": study.user_attributes})
        );
        if !into.is_empty() {
            storage.copy_study(&study.name, &mut Storage::journal(into)?)?;
        }
        if !figures.is_empty() {
            std::fs::create_dir_all(figures)?;
            for figure in [history_figure(study), importance_figure(study)] {
                let (name, svg) = svg_from_figure(&figure);
                let path = Path::new(figures).join(format!("{}_{name}.svg", study.name));
                write_atomically(&path, svg.as_bytes())?;
            }
        }
    }
    Ok(())
}
