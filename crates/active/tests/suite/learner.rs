//! The learner: training from an environment, container, proposed motions.

use opendr_active::{
    ActiveContainer, ActiveFitParams, ActiveInput, ActiveObjectRecognition, ActiveParams,
    ActivePoseRecognition,
};
use opendr_engine::data::{Image, Observation};
use opendr_engine::learner::{FitJob, Learner as _, LearnerActive as _};
use opendr_engine::model::Model;
use opendr_engine::rig::ViewRig as _;
use opendr_engine::target::{ActionBase as _, Category};
use opendr_engine::{Device, ErrorKind};
use proptest::prelude::*;

use crate::small::source;

fn trained(folder: &std::path::Path) -> Model {
    let fit_params = ActiveFitParams {
        total_timesteps: 512,
        view_episodes: 40,
        epochs: 1,
        kernels: 4,
        hidden: 16,
        n_envs: 4,
        num_workers: 1,
        calibration_episodes: 50,
        ..ActiveFitParams::default()
    };
    let job = FitJob::new(folder);
    let statistics =
        ActivePoseRecognition::fit(None, &ActiveParams::default(), &fit_params, None, &source(), &job)
            .unwrap();
    assert!(statistics.get("policy_accuracy").is_some(), "{statistics}");
    let model = Model::open(job.model()).unwrap();
    // From a base model, both parts can be kept.
    let kept = ActiveFitParams { total_timesteps: 0, view_episodes: 0, ..fit_params.clone() };
    let error =
        ActivePoseRecognition::fit(None, &ActiveParams::default(), &kept, None, &source(), &job).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::InvalidParam);
    ActivePoseRecognition::fit(Some(&model), &ActiveParams::default(), &kept, None, &source(), &job).unwrap();
    let again = ActiveContainer::read(&Model::open(job.model()).unwrap()).unwrap();
    let before = ActiveContainer::read(&model).unwrap();
    assert_eq!(again.model.policy.parameters(), before.model.policy.parameters());
    assert_eq!(again.recogniser.to_bytes(), before.recogniser.to_bytes());
    let best_view = |container: &ActiveContainer| container.model.best_view.as_ref().unwrap().to_bytes();
    assert_eq!(best_view(&again), best_view(&before));
    assert!(statistics.get("best_view_loss").is_some(), "{statistics}");
    // A kept camera policy keeps its estimator beside a new recogniser.
    let other = ActiveFitParams { total_timesteps: 0, seed: 4, ..fit_params };
    let folder = folder.join("other");
    let job = FitJob::new(&folder);
    let statistics =
        ActivePoseRecognition::fit(Some(&model), &ActiveParams::default(), &other, None, &source(), &job)
            .unwrap();
    assert!(statistics.get("best_view_loss").is_none(), "{statistics}");
    let other = ActiveContainer::read(&Model::open(job.model()).unwrap()).unwrap();
    assert_eq!(best_view(&other), best_view(&before));
    assert_ne!(other.recogniser.to_bytes(), before.recogniser.to_bytes());
    model
}

/// Images of any content, with any pose or none: what a camera may give.
fn views() -> impl Strategy<Value = Vec<(Vec<u8>, Option<[f32; 3]>)>> {
    let pixels = prop::collection::vec(any::<u8>(), 3 * 9);
    let pose = prop::option::of([-1e6f32..1e6, -3.0f32..3.0, -1.0f32..1e6]);
    prop::collection::vec((pixels, pose), 1..20)
}

#[test]
fn actions_have_the_declared_axes_within_bounds() {
    let folder = std::env::temp_dir().join(format!("opendr-active-learner-{}", std::process::id()));
    let model = trained(&folder);
    let axes = ActiveContainer::read(&model).unwrap().model.axes.len();
    let learner = ActivePoseRecognition::load(&model, ActiveParams::default(), Device::Cpu).unwrap();
    let mut runner = proptest::test_runner::TestRunner::default();
    let property = |views: Vec<(Vec<u8>, Option<[f32; 3]>)>| {
        let (mut state, mut target) = (Default::default(), Category::default());
        let mut motions = 0;
        for (pixels, pose) in views {
            let image = Image::from_rgb8(pixels, 3, 3).unwrap();
            let pose = pose.map(|pose| Observation::from_data(pose.to_vec()).unwrap());
            let input = ActiveInput { image: &image, pose: pose.as_ref() };
            learner.infer_into(&mut state, input, &mut target).unwrap();
            let sum: f32 = target.probabilities.iter().sum();
            prop_assert!((sum - 1.0).abs() < 1e-4 && target.probabilities.len() == 10);
            match &target.action {
                Some(action) => {
                    motions += 1;
                    prop_assert_eq!(action.axes().len(), axes);
                    prop_assert!(action.axes().iter().all(|axis| (-1.0..=1.0).contains(axis)));
                }
                None => motions = 0,
            }
            prop_assert!(motions <= 6);
        }
        Ok(())
    };
    runner.run(&views(), property).unwrap();
    let image = Image::from_rgb8(vec![0; 27], 3, 3).unwrap();
    let pose = Observation::from_data(vec![0.0, 1.0]).unwrap();
    let mut target = Category::default();
    let input = ActiveInput { image: &image, pose: Some(&pose) };
    assert!(learner.infer_into(&mut Default::default(), input, &mut target).is_err());
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn the_environment_has_to_fit() {
    let folder = std::env::temp_dir().join(format!("opendr-active-unfit-{}", std::process::id()));
    let cart = opendr_simulation::RegisteredSource::new("CartPole-v1", &Default::default()).unwrap();
    let fit = |env: &dyn opendr_engine::environment::EnvironmentSource| {
        let (params, fit_params) = (ActiveParams::default(), ActiveFitParams::default());
        ActiveObjectRecognition::fit(None, &params, &fit_params, None, env, &FitJob::new(&folder))
    };
    let error = fit(&cart).unwrap_err();
    assert!(error.to_string().contains("no environment of active perception"), "{error}");
}

#[test]
fn an_environment_is_a_rig() {
    use opendr_engine::environment::EnvironmentSource as _;
    let mut rig = opendr_active::EnvironmentRig::new(source().make().unwrap()).unwrap();
    let class = rig.begin(3).unwrap();
    assert!(class < 10 && rig.best_pose().is_some());
    let before = rig.capture().unwrap();
    let action = opendr_engine::target::Action::new(&[1.0, 0.0, -1.0]).unwrap();
    let achieved = rig.apply(&action).unwrap();
    assert!((rig.pose().azimuth - 35f64.to_radians()).abs() < 1e-6, "{achieved:?}");
    assert_ne!(rig.capture().unwrap(), before);
}
