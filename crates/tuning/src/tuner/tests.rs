use std::path::Path;
use std::sync::atomic::AtomicU64;
use std::time::Duration;

use super::*;
use crate::{Asha, Direction, Distribution, Median, RandomSearch, Storage, TrialRecord};

/// The loss falls with the units towards the value of the configuration, plus noise of the seed.
struct Slope<'a> {
    worth: f64,
    done: u64,
    spent: &'a AtomicU64,
}

impl Training for Slope<'_> {
    fn advance(&mut self, until: u64) -> Result<Option<f64>> {
        self.spent.fetch_add(until.saturating_sub(self.done), Ordering::Relaxed);
        self.done = self.done.max(until);
        Ok(Some(self.worth + 1.0 / self.done as f64))
    }

    fn save(&self, folder: &Path) -> Result<()> {
        fs::create_dir_all(folder)?;
        Ok(fs::write(folder.join("done"), self.done.to_string())?)
    }

    fn load(&mut self, folder: &Path) -> Result<()> {
        self.done = fs::read_to_string(folder.join("done"))?.parse().unwrap();
        Ok(())
    }
}

fn folder(name: &str) -> PathBuf {
    std::env::temp_dir().join(format!("opendr-tuner-{name}-{}", std::process::id()))
}

fn study() -> Study {
    let study = Study::open(Storage::memory(), "s", &[Direction::Minimize]).unwrap();
    study.with_sampler(RandomSearch::new(5)).with_pruner(Asha::new(1, 3).unwrap())
}

fn tuner<'a>(study: Study, folder: &Path, spent: &'a AtomicU64) -> Tuner<'a> {
    let space = SearchSpace::new().with("x", Distribution::float(0.0, 1.0).unwrap()).unwrap();
    let begin = move |params: &ParamMap, seed: u64| {
        let worth = params["x"].as_float().unwrap() + (seed % 1000) as f64 * 1e-5;
        Ok(Slope { worth, done: 0, spent })
    };
    Tuner::new(study, space, Plan::at(vec![1, 3, 9]).unwrap(), folder, begin).unwrap()
}

/// Sum of the units of all trials.
fn units(study: &StudyRecord) -> u64 {
    study.trials.iter().filter_map(|trial| trial.last_report()).map(|(step, _)| step as u64).sum()
}

/// State, values, and reports by step.
type TrialSummary = (TrialState, Vec<f64>, Vec<(i64, f64)>);

fn summaries(study: &StudyRecord) -> Vec<TrialSummary> {
    let of = |trial: &TrialRecord| {
        (
            trial.state,
            trial.values.clone(),
            trial.reports.iter().map(|(step, value)| (*step, *value)).collect(),
        )
    };
    study.trials.iter().map(of).collect()
}

#[test]
fn promoted_trials_resume_and_complete_after_all_seeds() {
    let (folder, spent) = (folder("seeds"), AtomicU64::new(0));
    let tuner = tuner(study(), &folder, &spent);
    assert_eq!(tuner.run(&Budget::total(60), |_, _| Progress::Continue).unwrap(), TuningStatus::Finished);
    let record = tuner.study().snapshot();
    assert_eq!(units(&record), spent.load(Ordering::Relaxed), "a unit was repeated");
    assert!(units(&record) < 60 * 27 / 5, "{}", units(&record));
    assert!(record.complete().count() > 0);
    for trial in record.complete() {
        assert_eq!(trial.reports.keys().copied().collect::<Vec<_>>(), [1, 3, 9, 18, 27]);
    }
    let best = record.best().unwrap();
    let noise = tuner.plan.seeds().iter().map(|seed| (seed % 1000) as f64 * 1e-5).sum::<f64>() / 3.0;
    let expected = best.params["x"].number + noise + 1.0 / 9.0;
    assert!((best.value().unwrap() - expected).abs() < 1e-12, "the mean of three seeds");
    let again = tuner.reevaluate().unwrap().unwrap();
    assert_eq!((again.number, again.chosen_by, again.values.len()), (best.number, best.value().unwrap(), 3));
    assert_ne!(again.mean(), again.chosen_by);
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn an_interrupted_study_gives_the_result_of_an_uninterrupted_one() {
    let (folder, spent, other) = (folder("interrupted"), AtomicU64::new(0), AtomicU64::new(0));
    let whole = tuner(study(), &folder.join("whole"), &other);
    whole.run(&Budget::total(20), |_, _| Progress::Continue).unwrap();
    fs::create_dir_all(&folder).unwrap();
    let journal = folder.join("study.log");
    let mut runs = 0;
    loop {
        let study = Study::open(Storage::journal(&journal).unwrap(), "s", &[Direction::Minimize]).unwrap();
        let study = study.with_sampler(RandomSearch::new(5)).with_pruner(Asha::new(1, 3).unwrap());
        let tuner = tuner(study, &folder.join("trials"), &spent);
        let measured = AtomicU64::new(0);
        let three = |_: &StudyRecord, _| match measured.fetch_add(1, Ordering::Relaxed) {
            2 => Progress::Stop,
            _ => Progress::Continue,
        };
        runs += 1;
        if tuner.run(&Budget::total(20), three).unwrap() == TuningStatus::Finished {
            assert_eq!(summaries(&tuner.study().snapshot()), summaries(&whole.study().snapshot()));
            break;
        }
        assert_eq!(
            tuner.study().inspect(|study| study
                .trials
                .iter()
                .filter(|it| it.state == TrialState::Running)
                .count()),
            0
        );
    }
    assert!(runs > 8, "{runs}");
    assert_eq!(spent.load(Ordering::Relaxed), other.load(Ordering::Relaxed), "a unit was repeated");
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_study_without_a_complete_trial_finishes_the_best() {
    let (folder, spent) = (folder("finish"), AtomicU64::new(0));
    let tuner = tuner(study(), &folder, &spent);
    assert_eq!(tuner.run(&Budget::total(2), |_, _| Progress::Continue).unwrap(), TuningStatus::Finished);
    let record = tuner.study().snapshot();
    let worth = |number: usize| record.trials[number].params["x"].number;
    let (best, other) = if worth(0) < worth(1) { (0, 1) } else { (1, 0) };
    assert_eq!(record.trials[best].state, TrialState::Complete);
    assert_eq!((record.trials[other].is_paused(), record.trials.len()), (true, 2));
    assert_eq!(units(&record), spent.load(Ordering::Relaxed), "a unit was repeated");
    fs::remove_dir_all(folder).unwrap();
}

/// Stops, as by Ctrl-C, on its way to 9, until it is released.
struct Stopping<'a>(Slope<'a>, &'a AtomicBool);

impl Training for Stopping<'_> {
    fn advance(&mut self, until: u64) -> Result<Option<f64>> {
        if until == 9 && !self.1.load(Ordering::Relaxed) { Ok(None) } else { self.0.advance(until) }
    }

    fn save(&self, folder: &Path) -> Result<()> {
        self.0.save(folder)
    }

    fn load(&mut self, folder: &Path) -> Result<()> {
        self.0.load(folder)
    }
}

#[test]
fn a_stopped_training_resumes_from_its_last_point() {
    let (folder, spent, on) = (folder("halted"), AtomicU64::new(0), AtomicBool::new(false));
    let study = Study::open(Storage::memory(), "s", &[Direction::Minimize]).unwrap();
    let space = SearchSpace::new().with("x", Distribution::float(0.0, 1.0).unwrap()).unwrap();
    let begin = |_: &ParamMap, _| Ok(Stopping(Slope { worth: 0.0, done: 0, spent: &spent }, &on));
    let plan = Plan::at(vec![1, 3, 9]).unwrap().with_seeds(0, 1);
    let tuner = Tuner::new(study, space, plan, &folder, begin).unwrap();
    let run = || tuner.run(&Budget::total(2), |_, _| Progress::Continue).unwrap();
    assert_eq!(run(), TuningStatus::Interrupted);
    let record = tuner.study().snapshot();
    assert!(record.trials.len() == 1 && record.trials[0].is_interrupted());
    assert_eq!(record.trials[0].last_report().unwrap().0, 3);
    on.store(true, Ordering::Relaxed);
    assert_eq!(run(), TuningStatus::Finished);
    assert_eq!((tuner.study().snapshot().complete().count(), spent.load(Ordering::Relaxed)), (2, 18));
    on.store(false, Ordering::Relaxed);
    assert_eq!(tuner.reevaluate().unwrap(), None);
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn trials_of_dead_workers_resume_from_their_checkpoints() {
    let (folder, spent) = (folder("dead"), AtomicU64::new(0));
    let study = Study::open(Storage::memory(), "s", &[Direction::Minimize]).unwrap();
    let tuner = tuner(study.with_abandoned_after(Duration::from_millis(50)), &folder, &spent);
    let trial = tuner.study().ask(&tuner.space).unwrap();
    let mut training = (tuner.begin)(&trial.param_map().unwrap(), tuner.plan.seeds()[0]).unwrap();
    trial.report(3, training.advance(3).unwrap().unwrap()).unwrap();
    training.save(&tuner.folder_of(0).join("seed_0")).unwrap();
    trial.checkpoint(json!(TrialProgress { values: Vec::new(), done: 3 })).unwrap();
    std::thread::sleep(Duration::from_millis(60));
    tuner.run(&Budget::total(1), |_, _| Progress::Continue).unwrap();
    let record = tuner.study().snapshot();
    assert_eq!((record.trials.len(), record.trials[0].state), (1, TrialState::Complete));
    assert_eq!(spent.load(Ordering::Relaxed), 27);
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn stopped_trials_leave_no_checkpoints() {
    let (folder, spent) = (folder("stopped"), AtomicU64::new(0));
    let study = study().with_pruner(Median { startup_trials: 3, warmup_steps: 0 });
    let tuner = tuner(study, &folder, &spent);
    let late = Budget::total(20).timeout(Duration::ZERO);
    assert_eq!(tuner.run(&late, |_, _| Progress::Continue).unwrap(), TuningStatus::Interrupted);
    tuner.run(&Budget::total(20).threads(2), |_, _| Progress::Continue).unwrap();
    let record = tuner.study().snapshot();
    let left = |state| {
        record
            .trials
            .iter()
            .filter(|trial| trial.state == state)
            .map(|trial| tuner.folder_of(trial.number).exists())
            .collect::<Vec<_>>()
    };
    assert!(left(TrialState::Complete).len() > 3 && left(TrialState::Complete).iter().all(|there| *there));
    assert!(left(TrialState::Pruned).len() > 3 && !left(TrialState::Pruned).contains(&true));
    let two = Study::open(Storage::memory(), "s", &[Direction::Minimize; 2]).unwrap();
    let begin = |_: &ParamMap, _| Ok(Slope { worth: 0.0, done: 0, spent: &spent });
    assert!(Tuner::new(two, SearchSpace::new(), Plan::every(1, 3).unwrap(), "", begin).is_err());
    assert_eq!(Plan::every(4, 10).unwrap().points, [4, 8, 10]);
    assert!(Plan::every(0, 1).is_err() && Plan::every(2, 1).is_err() && Plan::at(vec![0, 1]).is_err());
    fs::remove_dir_all(folder).unwrap();
}
