//! Policies of robots train, resume from their containers, and act.

use std::path::PathBuf;

use opendr_control::{MobileRl, MobileRlFitParams, MultiObjectSearchRl, MultiObjectSearchRlFitParams};
use opendr_engine::Device;
use opendr_engine::environment::{Environment as _, ResetOptions};
use opendr_engine::learner::{FitJob, Handle, LearnerRl};
use opendr_engine::model::Model;
use opendr_rl::{POLICY_FILE, Policy, observation_from_numbers, onnx_from_policy};
use opendr_simulation::{RegisteredSource, make};

/// Trains with this number of threads; returns the policy and an action.
fn trained<L: LearnerRl>(id: &str, params: &L::FitParams, name: &str) -> (Vec<u8>, Vec<f32>)
where
    L: for<'a> opendr_engine::learner::Learner<
            Input<'a> = &'a opendr_engine::data::Observation,
            Target = opendr_engine::target::RlTarget,
        >,
{
    let folder: PathBuf = std::env::temp_dir().join(format!("opendr-control-{name}-{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    let mut learner = Handle::<L>::new(L::Params::default(), Device::Cpu).unwrap();
    let source = RegisteredSource::new(id, &Default::default()).unwrap();
    learner.fit_in(params, &source, None, &FitJob::new(&folder)).unwrap();
    let mut environment = make(id).unwrap();
    let space = environment.spec().observation.clone();
    let mut numbers = vec![0.0; space.len()];
    environment.reset(Some(1), &ResetOptions::new(), &mut numbers).unwrap();
    let action = learner.infer(&observation_from_numbers(&space, &numbers).unwrap()).unwrap().values;
    let policy = Model::open(folder.join("model")).unwrap().file(POLICY_FILE).unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    (policy, action)
}

#[test]
fn mobile_manipulation_trains_on_any_number_of_threads() {
    let mut params = MobileRlFitParams::default();
    (params.config.n_steps, params.config.batch_size) = (64, 64);
    (params.training.total_timesteps, params.training.n_envs) = (512, 4);
    params.training.n_eval_episodes = 1;
    let results = [1, 2].map(|workers| {
        params.training.num_workers = workers;
        trained::<MobileRl>("MobileManipReach-v1", &params, &format!("mobile-{workers}"))
    });
    assert!(results[0] == results[1]);
    assert_eq!(results[0].1.len(), 3);
    assert_eq!(trained::<MobileRl>("MobileManipReach-diff-v1", &params, "mobile-diff").1.len(), 2);
}

#[test]
fn object_search_trains() {
    let mut params = MultiObjectSearchRlFitParams::default();
    (params.config.n_steps, params.config.batch_size) = (16, 32);
    (params.training.total_timesteps, params.training.n_envs) = (64, 2);
    (params.training.n_eval_episodes, params.demonstration_episodes) = (1, 2);
    let (policy, action) = trained::<MultiObjectSearchRl>("ObjectSearch2D-frontier-v1", &params, "search");
    assert_eq!(action.len(), 1);
    let policy = Policy::from_bytes(&policy).unwrap();
    assert!(Policy::from_bytes(&policy.to_bytes().unwrap()).unwrap() == policy);
    assert!(onnx_from_policy(&policy).is_ok());
}
