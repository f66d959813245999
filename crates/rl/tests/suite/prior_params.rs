//! Demonstrations and shields as parameters of a training, and the report of a policy with a prior.

use opendr_engine::data::Observation;
use opendr_engine::environment::{Controller, EnvironmentSource, ResetOptions, Space};
use opendr_engine::learner::{FitJob, Handle, LearnerRl};
use opendr_engine::model::Model;
use opendr_engine::params::{ParamMap, Params as _};
use opendr_engine::target::RlTarget;
use opendr_engine::{Device, ErrorKind, Result};
use opendr_rl::prior::{
    CommandLaw, Prior, ResidualPpoFitParams, ResidualPpoLearner, ShapedPpoFitParams, ShapedPpoLearner,
    ShapedSacFitParams, ShapedSacLearner, ShieldParams, controllers_of_model,
};
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

fn short_shaped(prior: &str, hold: u32) -> ShapedPpoFitParams {
    let mut params = ShapedPpoFitParams::default();
    (params.shaping.prior, params.shaping.hold) = (prior.to_owned(), hold);
    (params.config.n_steps, params.training.n_envs, params.training.total_timesteps) = (32, 2, 64);
    (params.training.n_eval_episodes, params.training.preset) = (2, false);
    params
}

/// Steps of an episode in which `learner` and `controller` act; returns the largest difference of their actions.
fn largest_difference<L>(learner: &mut Handle<L>, controller: &mut dyn Controller, id: &str) -> f32
where
    L: for<'a> LearnerRl<Input<'a> = &'a Observation, Target = RlTarget>,
{
    let mut environment = make(id).unwrap();
    let mut seen = vec![0.0; environment.spec().observation.len()];
    let mut wanted = vec![0.0; environment.spec().action.len()];
    environment.reset(Some(6), &ResetOptions::new(), &mut seen).unwrap();
    controller.reset();
    let mut largest = 0.0_f32;
    for _ in 0..20 {
        let own = learner.infer(&Observation::from_data(seen.clone()).unwrap()).unwrap().values.clone();
        controller.act(&seen, &mut wanted).unwrap();
        let differences = own.iter().zip(&wanted).map(|(own, wanted)| (own - wanted).abs());
        largest = differences.fold(largest, f32::max);
        if environment.step(&own, &mut seen).unwrap().is_over() {
            break;
        }
    }
    largest
}

#[test]
fn a_policy_of_commands_begins_as_its_prior() {
    for (id, prior) in [(CORRIDOR, "corridor-reactive"), ("Pendulum-v1", "pendulum-energy")] {
        let folder = Folder::new("shaped-begin");
        let mut params = short_shaped(prior, 1);
        params.config.actor_starts = 1_000_000;
        let source = RegisteredSource::new(id, &ParamMap::new()).unwrap();
        fit::<ShapedPpoLearner>(PolicyParams::default(), &params, &source, &folder).unwrap();
        let mut learner = Handle::<ShapedPpoLearner>::new(PolicyParams::default(), Device::Cpu).unwrap();
        learner.load(folder.path().join("model")).unwrap();
        let space = make(id).unwrap().spec().observation.clone();
        let mut controller = Prior::newest(prior).unwrap().controller(&space).unwrap();
        let largest = largest_difference(&mut learner, &mut *controller, id);
        assert!(largest < 1e-6, "{prior}: {largest}");
    }
}

#[test]
fn a_policy_of_commands_is_trained_saved_and_reported() {
    let folder = Folder::new("shaped");
    let params = short_shaped("corridor-reactive", 3);
    let model = fit::<ShapedPpoLearner>(PolicyParams::default(), &params, &corridors(), &folder).unwrap();
    let shielded = shield(Some("corridor-clearance"), None);
    let mut rows = controllers_of_model(&model, &shielded.to_map()).unwrap().unwrap();
    let names: Vec<_> = rows.iter().map(|row| row.name()).collect();
    assert_eq!(names, ["prior", "prior and policy", "prior and policy, shielded"]);
    // The learner acts as the shielded row does, with commands that are held for three steps.
    let mut learner = Handle::<ShapedPpoLearner>::new(shielded, Device::Cpu).unwrap();
    learner.load(folder.path().join("model")).unwrap();
    let largest = largest_difference(&mut learner, rows.last_mut().unwrap(), CORRIDOR);
    assert_eq!((largest, rows.last().unwrap().shielded_share().is_some()), (0.0, true));

    let folder = Folder::new("shaped-refused");
    let shielded = shield(Some("corridor-clearance"), None);
    let error = fit::<ShapedPpoLearner>(shielded, &params, &corridors(), &folder).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::InvalidParam, "{error}");
    let params = short_shaped("corridor-potential-field", 1);
    let error = fit::<ShapedPpoLearner>(PolicyParams::default(), &params, &corridors(), &folder).unwrap_err();
    assert!(error.to_string().contains("corridor-potential-field follows no commands"), "{error}");
}

#[test]
fn a_container_of_commands_is_checked() {
    let law = |seen: &[f32], gain: &[f32], action: &mut [f32]| -> Result<()> {
        action[0] = (-(1.0 + gain[0]) * seen[2]).clamp(-2.0, 2.0);
        Ok(())
    };
    let plain = move |seen: &[f32], action: &mut [f32]| law(seen, &[0.0], action);
    let prior = Prior::new("test-commanded-law", 1, move |_| Ok(Box::new(plain)));
    let commands = || Space::symmetric(&[1.0]);
    prior.with_commands(move |_| Ok(Box::new(CommandLaw::new(commands(), 1, law)))).register().unwrap();
    let folder = Folder::new("shaped-sac");
    let mut params = ShapedSacFitParams::default();
    params.set_text("net_arch", "16").unwrap();
    params.shaping.prior = "test-commanded-law".to_owned();
    (params.config.off_policy.batch_size, params.training.total_timesteps) = (16, 150);
    (params.training.n_eval_episodes, params.training.preset) = (1, false);
    let pendulum = RegisteredSource::new("Pendulum-v1", &ParamMap::new()).unwrap();
    fit::<ShapedSacLearner>(PolicyParams::default(), &params, &pendulum, &folder).unwrap();
    let load = || {
        let mut learner = Handle::<ShapedSacLearner>::new(PolicyParams::default(), Device::Cpu)?;
        learner.load(folder.path().join("model"))
    };
    load().unwrap();
    let manifest = folder.path().join("model").join("model.json");
    let text = std::fs::read_to_string(&manifest).unwrap();
    for (from, to, kind) in [
        ("test-commanded-law", "nobody", ErrorKind::NotFound),
        ("test-commanded-law", "corridor-potential-field", ErrorKind::Unsupported),
        ("test-commanded-law", "pendulum-energy", ErrorKind::Format),
        ("\"hold\": 1", "\"hold\": 0", ErrorKind::Format),
        ("\"hold\": 1", "\"hold\": -1", ErrorKind::Format),
        ("commanded_prior", "other", ErrorKind::Format),
    ] {
        assert!(text.contains(from), "{text}");
        std::fs::write(&manifest, text.replace(from, to)).unwrap();
        assert_eq!(load().unwrap_err().kind(), kind, "{from} {to}");
    }
}
