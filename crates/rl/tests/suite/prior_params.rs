//! Demonstrations and shields as parameters of a training, and the report of a policy with a prior.

use opendr_engine::data::Observation;
use opendr_engine::environment::{Controller, EnvironmentSource, ResetOptions};
use opendr_engine::learner::{FitJob, Handle, LearnerRl};
use opendr_engine::model::Model;
use opendr_engine::params::{ParamMap, Params as _};
use opendr_engine::{Device, ErrorKind, Result};
use opendr_rl::prior::{Prior, ResidualPpoFitParams, ResidualPpoLearner, ShieldParams, controllers_of_model};
use opendr_rl::{
    EvaluationProtocol, PolicyParams, PpoFitParams, PpoLearner, SacFitParams, SacLearner, evaluate_controller,
};
use opendr_simulation::{RegisteredSource, make};

use crate::support::Folder;

const CORRIDOR: &str = "UavDepthCorridor-compact-v1";

fn corridors() -> RegisteredSource {
    RegisteredSource::new(CORRIDOR, &ParamMap::new()).unwrap()
}

fn shield(rule: Option<&str>, prior: Option<&str>) -> PolicyParams {
    let [shield, shield_prior] = [rule, prior].map(|name| name.map(str::to_owned));
    PolicyParams { shield: ShieldParams { shield, shield_prior }, ..PolicyParams::default() }
}

fn fit<L: LearnerRl<Params = PolicyParams>>(
    params: PolicyParams,
    fit_params: &L::FitParams,
    source: &dyn EnvironmentSource,
    folder: &Folder,
) -> Result<Model> {
    let mut learner = Handle::<L>::new(params, Device::Cpu)?;
    let job = FitJob::new(folder.path());
    learner.fit_in(fit_params, source, None, &job)?;
    Model::open(job.model())
}

fn short_residual() -> ResidualPpoFitParams {
    let mut params = ResidualPpoFitParams::default();
    (params.config.n_steps, params.training.n_envs, params.training.total_timesteps) = (32, 2, 128);
    (params.training.n_eval_episodes, params.residual.critic_warmup) = (2, 0);
    params
}

#[test]
fn a_shield_is_a_parameter_of_policies() {
    let folder = Folder::new("shield-residual");
    let model = fit::<ResidualPpoLearner>(
        shield(Some("corridor-clearance"), None),
        &short_residual(),
        &corridors(),
        &folder,
    )
    .unwrap();
    let params = shield(Some("corridor-clearance"), None).to_map();
    let mut rows = controllers_of_model(&model, &params).unwrap().unwrap();
    let names: Vec<_> = rows.iter().map(|row| row.name()).collect();
    assert_eq!(names, ["prior", "policy", "prior and policy", "prior and policy, shielded"]);
    let protocol = EvaluationProtocol { episodes: 4, ..EvaluationProtocol::default() };
    let mut corridor = make(CORRIDOR).unwrap();
    for row in &mut rows {
        let report =
            evaluate_controller(row, &mut *corridor, &protocol, &|step| step.info.success()).unwrap();
        assert_eq!(report.episodes.len(), 4);
        assert_eq!(row.shielded_share().is_some(), row.name().ends_with("shielded"), "{}", row.name());
    }
    // The prior itself acts instead; another one is refused, and so is a rule without a controller.
    let other = Some("corridor-potential-field");
    for params in [shield(Some("corridor-clearance"), other), shield(None, other), shield(Some("x"), None)] {
        let folder = Folder::new("shield-refused");
        let error = fit::<ResidualPpoLearner>(params, &short_residual(), &corridors(), &folder).unwrap_err();
        assert!(matches!(error.kind(), ErrorKind::InvalidParam | ErrorKind::NotFound), "{error}");
    }
}

#[test]
fn a_shielded_policy_executes_the_prior() {
    let folder = Folder::new("shield-ppo");
    let mut params = PpoFitParams::default();
    (params.config.n_steps, params.training.n_envs, params.training.total_timesteps) = (32, 2, 64);
    params.training.n_eval_episodes = 1;
    let shielded = shield(Some("corridor-clearance"), Some("corridor-reactive"));
    let model = fit::<PpoLearner>(shielded.clone(), &params, &corridors(), &folder).unwrap();
    let rows = controllers_of_model(&model, &shielded.to_map()).unwrap().unwrap();
    assert_eq!(rows.iter().map(|row| row.name()).collect::<Vec<_>>(), ["policy", "policy, shielded"]);
    assert!(controllers_of_model(&model, &PolicyParams::default().to_map()).unwrap().is_none());
    // The learner acts as the shielded row does.
    let mut learner = Handle::<PpoLearner>::new(shielded, Device::Cpu).unwrap();
    learner.load(folder.path().join("model")).unwrap();
    let mut row = rows.into_iter().next_back().unwrap();
    let mut corridor = make(CORRIDOR).unwrap();
    let mut seen = vec![0.0; corridor.spec().observation.len()];
    corridor.reset(Some(4), &ResetOptions::new(), &mut seen).unwrap();
    for _ in 0..12 {
        let observation = Observation::from_data(seen.clone()).unwrap();
        let (own, mut wanted) = (learner.infer(&observation).unwrap().values.clone(), [0.0; 2]);
        Controller::act(&mut row, &seen, &mut wanted).unwrap();
        assert_eq!(own, wanted);
        if corridor.step(&own, &mut seen).unwrap().is_over() {
            break;
        }
    }
    let folder = Folder::new("shield-no-prior");
    let error = fit::<PpoLearner>(shield(Some("corridor-clearance"), None), &params, &corridors(), &folder);
    assert!(error.unwrap_err().to_string().contains("shield_prior"));
}

#[test]
fn demonstrations_are_parameters_of_trainings() {
    let pendulum = RegisteredSource::new("Pendulum-v1", &ParamMap::new()).unwrap();
    let policy = |prior: Option<&str>| {
        let folder = Folder::new("demonstrations");
        let mut params = SacFitParams::default();
        params.set_text("net_arch", "16").unwrap();
        params.demonstrations.demonstration_prior = prior.map(str::to_owned);
        params.demonstrations.demonstration_episodes = 2;
        (params.config.off_policy.batch_size, params.training.total_timesteps) = (16, 150);
        (params.training.n_eval_episodes, params.training.preset) = (1, false);
        fit::<SacLearner>(PolicyParams::default(), &params, &pendulum, &folder)
            .and_then(|model| model.file("policy.safetensors"))
    };
    assert!(policy(Some("pendulum-energy")).unwrap() != policy(None).unwrap());
    assert_eq!(policy(Some("nobody")).unwrap_err().kind(), ErrorKind::NotFound);
    // PPO begins with the cloned behaviour, before its actor is trained.
    let law = |seen: &[f32], action: &mut [f32]| -> Result<()> {
        action[0] = (-2.0 * seen[1] - 0.5 * seen[2]).clamp(-2.0, 2.0);
        Ok(())
    };
    Prior::new("test-cloned-law", 1, move |_| Ok(Box::new(law))).register().unwrap();
    let folder = Folder::new("cloned");
    let mut params = PpoFitParams::default();
    params.demonstrations.demonstration_prior = Some("test-cloned-law".to_owned());
    (params.config.n_steps, params.config.actor_starts) = (64, 1_000_000);
    (params.training.total_timesteps, params.training.preset) = (64, false);
    params.training.n_eval_episodes = 1;
    let model = fit::<PpoLearner>(PolicyParams::default(), &params, &pendulum, &folder).unwrap();
    let shielded = shield(Some("corridor-clearance"), Some("corridor-reactive")).to_map();
    assert!(controllers_of_model(&model, &shielded).is_err(), "a rule of another environment");
    let mut learner = Handle::<PpoLearner>::new(PolicyParams::default(), Device::Cpu).unwrap();
    learner.load(folder.path().join("model")).unwrap();
    let (mut pendulum, mut seen, mut errors) = (make("Pendulum-v1").unwrap(), [0.0; 3], 0.0);
    pendulum.reset(Some(1), &ResetOptions::new(), &mut seen).unwrap();
    for _ in 0..200 {
        let own = learner.infer(&Observation::from_data(seen.to_vec()).unwrap()).unwrap().values[0];
        let mut wanted = [0.0];
        law(&seen, &mut wanted).unwrap();
        errors += (own - wanted[0]).abs() / 200.0;
        pendulum.step(&wanted, &mut seen).unwrap();
    }
    assert!(errors < 0.3, "{errors}");
}
