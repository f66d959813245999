use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use opendr_engine::ErrorKind;
use serde_json::json;

use super::*;
use crate::{Asha, Median, RandomSearch, SearchSpace};

fn study() -> Study {
    Study::open(Storage::memory(), "s", &[Direction::Minimize]).unwrap().with_sampler(RandomSearch::new(5))
}

fn space() -> SearchSpace {
    SearchSpace::new()
        .with("kind", Distribution::categorical(["a", "b"]).unwrap())
        .and_then(|space| space.with_when("x", Distribution::float(0.0, 1.0)?, "kind", ["a"]))
        .and_then(|space| space.with("one", Distribution::int(7, 7)?))
        .unwrap()
}

fn x_or_two(trial: &Trial<'_>) -> Result<Outcome> {
    Ok(Outcome::from(if trial.get::<String>("kind")? == "a" { trial.float("x")? } else { 2.0 }))
}

#[test]
fn conditional_parameters_are_active_only_under_their_condition() {
    let study = study();
    study.optimize(&space(), &Budget::more(40), x_or_two, |_, _| Progress::Continue).unwrap();
    let with = |kind: &str| {
        let study = study.snapshot();
        let of = study.trials.iter().filter(|trial| trial.params["kind"].value() == kind);
        of.map(|trial| trial.params.contains_key("x")).collect::<Vec<_>>()
    };
    assert!(with("a").len() > 5 && with("a").iter().all(|has| *has));
    assert!(with("b").len() > 5 && with("b").iter().all(|has| !*has));
    assert!(study.inspect(|study| study.trials.iter().all(|trial| trial.params["one"].value() == 7)));
    assert!(study.best().unwrap().value().unwrap() < 0.5);
}

#[test]
fn wrong_use_is_reported() {
    let study = study();
    let trial = study.ask(&space()).unwrap();
    assert!(trial.float("y").unwrap_err().to_string().contains("kind, one"));
    assert!(trial.int("kind").is_err());
    let number = trial.number();
    let kind = |result: Result<()>| result.unwrap_err().kind();
    assert_eq!(kind(study.tell(number, Outcome::Complete(vec![1.0, 2.0]))), ErrorKind::InvalidParam);
    assert_eq!(kind(study.tell(9, Outcome::Pruned)), ErrorKind::NotFound);
    trial.tell(Outcome::from(f64::NAN)).unwrap();
    assert_eq!(study.snapshot().trials[0].state, TrialState::Failed);
    assert_eq!(kind(study.tell(number, Outcome::from(1.0))), ErrorKind::InvalidParam, "it has already ended");
    let other = SearchSpace::new().with("one", Distribution::float(0.0, 1.0).unwrap()).unwrap();
    assert_eq!(study.ask(&other).err().unwrap().kind(), ErrorKind::InvalidParam);
    assert!(Study::open(Storage::memory(), "s", &[]).is_err());
    let two = Study::open(Storage::memory(), "s", &[Direction::Minimize; 2]).unwrap();
    assert!(two.ask(&space()).unwrap().report(0, 1.0).is_err());
    assert!(study.reevaluate_best(&[1], |_, _| Ok(Some(0.0))).is_err());
}

#[test]
fn queued_trials_come_first_with_their_parameters() {
    let study = study();
    study.enqueue(&[("kind".to_owned(), json!("a")), ("x".to_owned(), json!(0.25))].into()).unwrap();
    study.enqueue(&[("kind".to_owned(), json!("c"))].into()).unwrap();
    let first = study.ask(&space()).unwrap();
    assert_eq!((first.number(), first.float("x").unwrap()), (0, 0.25));
    let second = study.ask(&space()).unwrap();
    assert!(
        ["a", "b"].contains(&second.get::<String>("kind").unwrap().as_str()),
        "an invalid value is drawn"
    );
    assert_eq!(study.ask(&space()).unwrap().number(), 2);
}

#[test]
fn a_failing_objective_fails_its_trial() {
    let study = study();
    let calls = AtomicUsize::new(0);
    let objective = |trial: &Trial<'_>| match calls.fetch_add(1, Ordering::Relaxed) {
        1 => Err(Error::io("the environment is gone")),
        2 => panic!("on purpose"),
        _ => x_or_two(trial),
    };
    study.optimize(&space(), &Budget::total(5), objective, |_, _| Progress::Continue).unwrap();
    let trials = study.snapshot().trials;
    assert_eq!(trials.len(), 7);
    assert_eq!(trials[1].system_attributes["fail_reason"], json!("the environment is gone"));
    assert!(trials[2].system_attributes["fail_reason"].as_str().unwrap().contains("on purpose"));
    let always = |_: &Trial<'_>| -> Result<Outcome> { Err(Error::io("no disk")) };
    let error = study.optimize(&space(), &Budget::more(100), always, |_, _| Progress::Continue).unwrap_err();
    assert!(error.kind() == ErrorKind::Io && error.to_string().contains("in a row"), "{error}");
    assert_eq!(study.snapshot().trials.len(), 10);
}

#[test]
fn threads_share_a_study() {
    let study = study();
    let budget = Budget::more(50).threads(4).timeout(Duration::from_secs(60));
    study.optimize(&space(), &budget, x_or_two, |_, _| Progress::Continue).unwrap();
    let record = study.snapshot();
    assert_eq!(record.trials.len(), 50);
    assert!(record.trials.iter().all(|trial| trial.state == TrialState::Complete));
    let stop = |_: &StudyRecord, _| Progress::Stop;
    study.optimize(&space(), &Budget::more(50), x_or_two, stop).unwrap();
    assert_eq!(study.snapshot().trials.len(), 51);
}

#[test]
fn a_silent_worker_is_treated_as_dead() {
    let study = study().with_abandoned_after(Duration::from_millis(1));
    let silent = study.ask(&space()).unwrap();
    std::thread::sleep(Duration::from_millis(5));
    let next = study.ask(&space()).unwrap();
    assert_eq!(study.snapshot().trials[0].state, TrialState::Failed);
    assert!(silent.tell(Outcome::from(1.0)).is_err());
    std::thread::sleep(Duration::from_millis(2));
    next.report(0, 1.0).unwrap();
    assert!(next.record().unwrap().system_attributes.contains_key(ALIVE));
}

/// The loss of a configuration falls with the steps towards its final value.
fn halving(trial: &Trial<'_>, steps: &AtomicUsize) -> Result<Outcome> {
    let worth = trial.float("x")?;
    let begun = trial.resumed_from().and_then(Value::as_i64).unwrap_or(0);
    for step in begun + 1..=27 {
        steps.fetch_add(1, Ordering::Relaxed);
        match trial.report(step, worth + 1.0 / step as f64)? {
            Advice::Pause if step < 27 => return Ok(Outcome::Paused(step.into())),
            _ => {}
        }
    }
    Ok(Outcome::from(worth))
}

#[test]
fn a_promoted_trial_resumes_from_its_state() {
    let study = study().with_pruner(Asha::new(1, 3).unwrap());
    let space = SearchSpace::new().with("x", Distribution::float(0.0, 1.0).unwrap()).unwrap();
    let steps = AtomicUsize::new(0);
    let budget = Budget::total(81);
    study.optimize(&space, &budget, |trial| halving(trial, &steps), |_, _| Progress::Continue).unwrap();
    let record = study.snapshot();
    assert_eq!(record.trials.len(), 81);
    let reports: usize = record.trials.iter().map(|trial| trial.reports.len()).sum();
    assert_eq!(reports, steps.load(Ordering::Relaxed), "a step was repeated");
    assert!(reports < 81 * 27 / 5, "{reports}");
    let best = record.trials.iter().map(|trial| trial.params["x"].number).fold(1.0, f64::min);
    assert_eq!(study.best().unwrap().params["x"].number, best, "the best was promoted to the end");
    assert!(record.trials.iter().filter(|trial| trial.is_paused()).count() >= 50);
    study.prune_paused().unwrap();
    let pruned = study.snapshot().trials.into_iter().find(|trial| trial.state == TrialState::Pruned).unwrap();
    assert_eq!(pruned.value(), pruned.last_report().map(|(_, value)| value));
}

#[test]
fn a_configuration_is_complete_after_all_its_seeds() {
    let study = study().with_pruner(Median { startup_trials: 3, warmup_steps: 0 });
    let space = SearchSpace::new().with("x", Distribution::float(0.0, 1.0).unwrap()).unwrap();
    let seeds = training_seeds(1, 3);
    let noise = |seed: u64| (seed % 1000) as f64 * 1e-4;
    let objective = |trial: &Trial<'_>| {
        let x = trial.float("x")?;
        trial.over_seeds(&seeds, |seed| Ok(x + noise(seed)))
    };
    study.optimize(&space, &Budget::more(30), objective, |_, _| Progress::Continue).unwrap();
    let record = study.snapshot();
    assert!(record.complete().all(|trial| trial.reports.len() == 3));
    assert!(record.trials.iter().any(|trial| trial.state == TrialState::Pruned && trial.reports.len() == 1));
    let best = study.best().unwrap();
    let mean = seeds.iter().map(|seed| best.params["x"].number + noise(*seed)).sum::<f64>() / 3.0;
    assert!((best.value().unwrap() - mean).abs() < 1e-12);
    let fresh = fresh_seeds(1, 5);
    assert!(fresh.iter().all(|seed| !seeds.contains(seed)));
    assert_eq!(study.reevaluate_best(&fresh, |_, _| Ok(None)).unwrap(), None);
    let again = study
        .reevaluate_best(&fresh, |trial, seed| Ok(Some(trial.params["x"].number + noise(seed))))
        .unwrap()
        .unwrap();
    assert_eq!((again.number, again.values.len()), (best.number, 5));
    assert!((again.mean() - again.chosen_by).abs() < 0.2 && again.std() > 0.0);
    assert_eq!(study.snapshot().user_attributes["reevaluation"]["trial"], json!(best.number));
}

#[test]
fn several_directions_have_a_pareto_front() {
    let study = Study::open(Storage::memory(), "s", &[Direction::Minimize, Direction::Maximize]).unwrap();
    let space = SearchSpace::new()
        .with("x", Distribution::float(0.0, 1.0).unwrap())
        .and_then(|space| space.with("y", Distribution::float(0.0, 1.0)?))
        .unwrap();
    // The front is x = anything, y = 0.
    let objective = |trial: &Trial<'_>| {
        let (x, y) = (trial.float("x")?, trial.float("y")?);
        Ok(Outcome::Complete(vec![x + y, x - y]))
    };
    study.optimize(&space, &Budget::more(80), objective, |_, _| Progress::Continue).unwrap();
    assert_eq!(study.best(), None);
    let (front, late) = study.inspect(|study| {
        let front: Vec<f64> = study.pareto_front().iter().map(|trial| trial.params["y"].number).collect();
        let late = study.trials[40..].iter().map(|trial| trial.params["y"].number).sum::<f64>() / 40.0;
        (front, late)
    });
    assert!(front.len() > 5 && late < 0.35, "{} {late}", front.len());
}
