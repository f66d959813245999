use serde_json::json;

use crate::{
    Budget, CmaEs, Direction, Distribution, Outcome, Progress, QuasiRandom, RandomSearch, Sampler,
    SearchSpace, Storage, Study, Tpe, Trial,
};

fn mixed_space() -> SearchSpace {
    SearchSpace::new()
        .with("lr", Distribution::log_float(1e-6, 1e-1).unwrap())
        .and_then(|space| space.with("batch", Distribution::log_int(16, 1024)?))
        .and_then(|space| space.with("step", Distribution::stepped_float(-1.0, 1.0, 0.25)?))
        .and_then(|space| space.with("optimizer", Distribution::categorical(["sgd", "adam", "rmsprop"])?))
        .and_then(|space| space.with_when("momentum", Distribution::float(0.0, 0.99)?, "optimizer", ["sgd"]))
        .unwrap()
}

fn mixed(trial: &Trial<'_>) -> opendr_engine::Result<Outcome> {
    let bowl = (trial.float("lr")?.log10() + 3.5).powi(2)
        + (trial.float("batch")?.log2() - 8.0).powi(2) / 4.0
        + trial.float("step")?.powi(2);
    let penalty = if trial.get::<String>("optimizer")? == "adam" { 0.0 } else { 1.0 };
    Ok(Outcome::from(bowl + penalty))
}

fn numbers(sampler: impl Sampler + 'static, trials: usize) -> (f64, Vec<Vec<f64>>) {
    let study = Study::open(Storage::memory(), "s", &[Direction::Minimize]).unwrap().with_sampler(sampler);
    study.optimize(&mixed_space(), &Budget::more(trials), mixed, |_, _| Progress::Continue).unwrap();
    let record = study.snapshot();
    for trial in &record.trials {
        for (name, suggestion) in &trial.params {
            let value = suggestion.value();
            assert_eq!(
                suggestion.distribution.number_from_value(&value).unwrap(),
                suggestion.number,
                "{name} = {value}"
            );
        }
    }
    let rows = record.trials.iter().map(|trial| trial.params.values().map(|it| it.number).collect());
    (record.best().unwrap().value().unwrap(), rows.collect())
}

#[test]
fn a_seed_determines_the_search() {
    type Make = fn(u64) -> Box<dyn Sampler>;
    let samplers: [Make; 4] = [
        |seed| Box::new(RandomSearch::new(seed)),
        |seed| Box::new(QuasiRandom::new(seed)),
        |seed| Box::new(Tpe::new(seed)),
        |seed| Box::new(CmaEs::new(seed)),
    ];
    for make in samplers {
        let run = |seed| numbers(Boxed(make(seed)), 40).1;
        assert_eq!(run(1), run(1));
        assert_ne!(run(1), run(2));
    }
}

/// Adapts `Box<dyn Sampler>` to `Sampler`.
struct Boxed(Box<dyn Sampler>);

impl Sampler for Boxed {
    fn draw(
        &self,
        study: &crate::StudyRecord,
        number: usize,
        parameters: &[&crate::Parameter],
    ) -> opendr_engine::Result<crate::DrawnParameters> {
        self.0.draw(study, number, parameters)
    }
}

#[test]
fn a_resumed_study_draws_the_same_trials() {
    let folder = std::env::temp_dir().join(format!("opendr-resume-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("study.log");
    for trials in [13, 31, 45] {
        let study = Study::open(Storage::journal(&path).unwrap(), "s", &[Direction::Minimize]).unwrap();
        let study = study.with_sampler(Tpe::new(1));
        study.optimize(&mixed_space(), &Budget::total(trials), mixed, |_, _| Progress::Continue).unwrap();
    }
    let storage = Storage::journal(&path).unwrap();
    let record = storage.studies().next().unwrap();
    let rows: Vec<Vec<f64>> =
        record.trials.iter().map(|trial| trial.params.values().map(|it| it.number).collect()).collect();
    assert_eq!(rows, numbers(Tpe::new(1), 45).1);
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn learning_samplers_beat_random_search() {
    let mean = |make: &dyn Fn(u64) -> f64| (0..8).map(make).sum::<f64>() / 8.0;
    let random = mean(&|seed| numbers(RandomSearch::new(seed), 80).0);
    let tpe = mean(&|seed| numbers(Tpe::new(seed), 80).0);
    assert!(tpe < 0.3 * random, "{tpe} {random}");
    // CMA-ES does not model choices, so the function has none.
    let space = (0..4).try_fold(SearchSpace::new(), |space, at| {
        space.with(format!("x{at}"), Distribution::float(-2.0, 2.0)?)
    });
    let space = space.unwrap();
    let rosenbrock = |trial: &Trial<'_>| {
        let x: Vec<f64> = (0..4).map(|at| trial.float(&format!("x{at}"))).collect::<Result<_, _>>()?;
        let term = |at: usize| 100.0 * (x[at + 1] - x[at] * x[at]).powi(2) + (1.0 - x[at]).powi(2);
        Ok(Outcome::from((0..3).map(term).sum::<f64>()))
    };
    let run = |sampler: Box<dyn Sampler>| {
        let study =
            Study::open(Storage::memory(), "s", &[Direction::Minimize]).unwrap().with_sampler(Boxed(sampler));
        study.optimize(&space, &Budget::more(400), rosenbrock, |_, _| Progress::Continue).unwrap();
        study.best().unwrap().value().unwrap()
    };
    let random = mean(&|seed| run(Box::new(RandomSearch::new(seed))));
    let evolved = mean(&|seed| run(Box::new(CmaEs::new(seed))));
    assert!(evolved < 0.2 * random, "{evolved} {random}");
}

#[test]
fn choices_of_any_kind_are_learned() {
    let choices = [json!(null), json!({"a": 1}), json!([1, 2]), json!(2.5), json!("x")];
    let space = SearchSpace::new().with("c", Distribution::categorical(choices.clone()).unwrap()).unwrap();
    let study = Study::open(Storage::memory(), "s", &[Direction::Minimize]).unwrap();
    let objective = |trial: &Trial<'_>| {
        Ok(Outcome::from(if trial.params()["c"].value() == json!([1, 2]) { 0.0 } else { 1.0 }))
    };
    study.optimize(&space, &Budget::more(60), objective, |_, _| Progress::Continue).unwrap();
    let record = study.snapshot();
    let count = |choice: &serde_json::Value| {
        record.trials.iter().filter(|trial| trial.params["c"].value() == *choice).count()
    };
    assert!(count(&choices[2]) > 25, "{}", count(&choices[2]));
}
