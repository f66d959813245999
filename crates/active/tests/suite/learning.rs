//! A policy learns to move to where the recogniser is certain, and active perception uses it.

use opendr_active::{Active, ActiveModel, ActiveTraining, StopReason, StopRule, compare, train_active};
use opendr_engine::Silent;
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
    train_active(&|| Ok(ToyScene::new()), None, training, &Silent, &mut |_, _| ()).unwrap()
}

#[test]
fn a_policy_learns_to_move_to_the_front() {
    let model = train(&training());
    let comparison = compare(ToyScene::new(), &model, 1_000_000, 200, &Silent).unwrap();
    let accuracy = |name: &str| comparison.of(name).unwrap().accuracy.value;
    assert!(accuracy("static") < 0.6 && accuracy("oracle") > 0.9, "{comparison}");
    assert!(accuracy("policy") > accuracy("static") + 0.4, "{comparison}");
    assert!(comparison.of("policy").unwrap().calibration_error < 0.1, "{comparison}");

    let mut active = Active::new(ToyRecogniser, &model).unwrap();
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
    let mut active = Active::new(ToyRecogniser, &model).unwrap();
    let mut world = opendr_simulation::sphere_view::SphereWorld::new(16).unwrap();
    let error = active.run(&mut world).unwrap_err().to_string();
    assert!(error.contains("a policy of 1 axes for a rig of 3"), "{error}");
}
