//! A policy learns to look from where the recogniser is certain, and the active recogniser uses it.

use opendr_active::{
    Active, ActiveModel, ActiveReport, ActiveTraining, Look, Mover, Oracle, PolicyMover, Stare, StopReason,
    StopRule, run_episode, train_active,
};
use opendr_engine::target::ActionBase as _;

use crate::toy::{ToyRecogniser, ToyRig, ToyScene};

fn training() -> ActiveTraining {
    let stop = StopRule { moves: 5, ..StopRule::default() };
    ActiveTraining {
        timesteps: 12_000,
        environments: 8,
        threads: 1,
        calibration_episodes: 100,
        stop,
        seed: 1,
    }
}

fn train(training: &ActiveTraining) -> ActiveModel {
    train_active(&|| Ok(ToyScene::new()), training, &mut |_, _| ()).unwrap()
}

fn report(model: &ActiveModel, mover: &mut dyn Mover, stop: &StopRule) -> ActiveReport {
    let mut look = Look::new(ToyScene::new(), model.fusion, model.stop.moves).unwrap();
    let run = (1_000_000..1_000_200).map(|seed| run_episode(&mut look, mover, stop, seed, None).unwrap());
    ActiveReport::of(&run.collect::<Vec<_>>()).unwrap()
}

#[test]
fn a_policy_learns_where_to_look() {
    let model = train(&training());
    let fixed = report(&model, &mut Stare, &StopRule { moves: 0, ..model.stop }).accuracy.value;
    let oracle = report(&model, &mut Oracle, &model.stop).accuracy.value;
    let policy = report(&model, &mut PolicyMover::new(model.policy.clone()), &model.stop);
    assert!(fixed < 0.6 && oracle > 0.9, "{fixed} {oracle}");
    assert!(policy.accuracy.value > fixed + 0.4, "{policy:?} {fixed}");
    assert!(policy.calibration_error < 0.1, "{policy:?}");

    let mut active = Active::new(ToyRecogniser, model.clone()).unwrap();
    let outcome = active.run(&mut ToyRig::new(1.6, 3)).unwrap();
    assert_eq!((outcome.class, outcome.reason), (3, StopReason::Confident), "{outcome:?}");
    let (last, moved) = outcome.views.split_last().unwrap();
    assert!(last.action.is_none() && !moved.is_empty());
    for view in moved {
        // To the left, where the front is, one axis, within its bounds.
        let action = view.action.unwrap();
        assert!(matches!(action.axes(), [azimuth] if (0.0..=1.0).contains(azimuth)), "{outcome:?}");
        assert!(view.expected_gain.is_some());
    }
    let text = serde_json::to_string(&outcome).unwrap();
    assert!(text.contains("\"reason\":\"confident\""), "{text}");
}

#[test]
fn threads_and_repetitions_change_no_bit() {
    let short = ActiveTraining { timesteps: 1024, ..training() };
    let first = train(&short);
    let again = train(&ActiveTraining { threads: 3, ..short });
    assert_eq!((first.policy.parameters(), first.fusion), (again.policy.parameters(), again.fusion));
}

#[test]
fn a_rig_of_other_axes_is_refused() {
    let model = train(&ActiveTraining { timesteps: 512, ..training() });
    let mut active = Active::new(ToyRecogniser, model).unwrap();
    let mut world = opendr_simulation::sphere_view::SphereWorld::new(16).unwrap();
    let error = active.run(&mut world).unwrap_err().to_string();
    assert!(error.contains("a policy of 1 axes for a rig of 3"), "{error}");
}
