//! Tuning of a reinforcement learning algorithm.

use std::sync::atomic::{AtomicU64, Ordering};

use opendr_engine::params::ParamMap;
use opendr_tuning::{
    Asha, Budget, Direction, Plan, Progress, RandomSearch, Storage, Study, Training, TrialRecord, TrialState,
    Tuner, TuningStatus,
};

#[path = "../../examples/cart_pole_search/training.rs"]
mod training;

use training::{CartPoleTraining, LENGTH, space};

#[test]
fn a_promoted_training_gives_the_result_of_an_uninterrupted_one() {
    let folder = std::env::temp_dir().join(format!("opendr-tuned-ppo-{}", std::process::id()));
    let points = [2048, 8192];
    assert!(points[1] < LENGTH);
    let study = Study::open(Storage::memory(), "ppo", &[Direction::Maximize]).unwrap();
    let study = study.with_sampler(RandomSearch::new(2)).with_pruner(Asha::new(2048, 4).unwrap());
    let steps = AtomicU64::new(0);
    let begin = |params: &ParamMap, seed| CartPoleTraining::begin(params, seed, &steps);
    let plan = Plan::at(points.to_vec()).unwrap().with_seeds(0, 2);
    let seeds = plan.seeds().to_vec();
    let tuner = Tuner::new(study, space().unwrap(), plan, &folder, begin).unwrap();
    let done = tuner.run(&Budget::total(9).max_failures(9), |_, _| Progress::Continue).unwrap();
    assert_eq!(done, TuningStatus::Finished);
    let record = tuner.study().snapshot();
    let paused = record.trials.iter().filter(|trial| trial.is_paused()).count();
    assert!(paused >= 6, "{paused}");
    // Promoted trials have both points, and were trained to the second in two pieces.
    let promoted: Vec<&TrialRecord> =
        record.trials.iter().filter(|trial| trial.reports.contains_key(&8192)).collect();
    assert!(!promoted.is_empty());
    for trial in promoted {
        let whole = AtomicU64::new(0);
        let params = trial.param_map().unwrap();
        let mut training = CartPoleTraining::begin(&params, seeds[0], &whole).unwrap();
        assert_eq!(training.advance(points[0]).unwrap(), Some(trial.reports[&2048]));
        assert_eq!(
            training.advance(points[1]).unwrap(),
            Some(trial.reports[&8192]),
            "it resumes with the same bits"
        );
    }
    assert!(record.trials.iter().all(|trial| trial.state != TrialState::Running));
    assert!(steps.load(Ordering::Relaxed) < 9 * 2 * points[1] / 2, "most trials were not stopped early");
    std::fs::remove_dir_all(folder).unwrap();
}
