use opendr_engine::Result;

use super::*;
use crate::{Direction, Outcome, SearchSpace, Storage, Study, TrialState};
use Advice::{Continue, Pause, Stop};

fn study(pruner: impl Pruner + 'static) -> Study {
    Study::open(Storage::memory(), "s", &[Direction::Maximize]).unwrap().with_pruner(pruner)
}

#[test]
fn the_median_stops_the_worse_half() {
    let study = study(Median { startup_trials: 4, warmup_steps: 2 });
    let space = SearchSpace::new();
    for value in [1.0, 2.0, 3.0, f64::NAN] {
        let trial = study.ask(&space).unwrap();
        for step in 0..4 {
            assert_eq!(
                trial.report(step, value).unwrap(),
                Continue,
                "there are too few trials to compare with"
            );
        }
        trial.tell(Outcome::from(1.0)).unwrap();
    }
    let at = |values: &[f64]| -> Result<Vec<Advice>> {
        let trial = study.ask(&space)?;
        values.iter().enumerate().map(|(step, value)| trial.report(step as i64, *value)).collect()
    };
    assert_eq!(at(&[0.0, 0.0, 0.0]).unwrap(), [Continue, Continue, Stop]);
    assert_eq!(at(&[0.0, 2.5, 0.0]).unwrap(), [Continue, Continue, Continue], "its best report counts");
    assert_eq!(at(&[1.0, 1.0, 2.0, 1.9]).unwrap(), [Continue, Continue, Continue, Continue]);
    assert_eq!(at(&[f64::NAN, f64::NAN, f64::NAN]).unwrap()[2], Stop);
}

#[test]
fn rungs_promote_the_best_third() {
    let study = study(Asha::new(2, 3).unwrap());
    let space = SearchSpace::new();
    let mut advice = Vec::new();
    for value in [1.0, 5.0, 3.0, 2.0, 6.0, 4.0] {
        let trial = study.ask(&space).unwrap();
        // Numbers of promoted trials come again; here each is paused at once.
        assert_eq!(trial.report(1, value).unwrap(), Continue, "before the first rung");
        advice.push(trial.report(2, value).unwrap());
        if advice.last() == Some(&Pause) {
            trial.tell(Outcome::Paused(value.into())).unwrap();
            if study.snapshot().trials.len() == 3 {
                // The second of three is the best third.
                let promoted = study.ask(&space).unwrap();
                assert_eq!((promoted.number(), promoted.resumed_from()), (1, Some(&5.0.into())));
                assert_eq!(promoted.report(5, 5.0).unwrap(), Continue, "between rungs");
                assert_eq!(promoted.report(6, 5.0).unwrap(), Pause, "alone at the second rung");
                promoted.tell(Outcome::Paused(6.into())).unwrap();
            }
        }
    }
    assert_eq!(advice, [Pause, Pause, Pause, Pause, Continue, Pause]);
    let paused: Vec<usize> = study
        .snapshot()
        .trials
        .iter()
        .filter(|trial| trial.state == TrialState::Waiting)
        .map(|trial| trial.number)
        .collect();
    assert_eq!(paused, [0, 1, 2, 3, 5]);
    assert!(Asha::new(0, 3).is_err() && Asha::new(1, 1).is_err());
}

#[test]
fn later_brackets_have_fewer_trials() {
    let hyperband = Hyperband::new(1, 9, 3).unwrap();
    let mut counts = [0; 3];
    (0..3000).for_each(|number| counts[hyperband.bracket(number)] += 1);
    assert!(counts[0] > counts[1] && counts[1] > counts[2] && counts[2] > 300, "{counts:?}");
    let study = study(hyperband.clone());
    let space = SearchSpace::new();
    let mut first_pause = [i64::MAX; 3];
    for _ in 0..80 {
        let trial = study.ask(&space).unwrap();
        let resumed_at = trial.record().unwrap().last_report().map_or(0, |(step, _)| step);
        let mut outcome = Outcome::from(1.0);
        for step in resumed_at + 1..=9 {
            if trial.report(step, -(trial.number() as f64)).unwrap() == Pause {
                let first = &mut first_pause[hyperband.bracket(trial.number())];
                *first = step.min(*first);
                outcome = Outcome::Paused(step.into());
                break;
            }
        }
        trial.tell(outcome).unwrap();
    }
    assert_eq!(first_pause, [1, 3, 9]);
    assert!(study.snapshot().trials.len() < 80, "some trials were resumed");
    assert!(Hyperband::new(3, 2, 3).is_err());
}
