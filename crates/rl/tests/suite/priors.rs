//! Prior knowledge in the four ways, by every algorithm that trains it.

use std::ops::ControlFlow;

use opendr_engine::data::Observation;
use opendr_engine::environment::{Controller, Environment, EnvironmentSpec, Info, ResetOptions, Space, Step};
use opendr_engine::learner::{FitJob, Handle};
use opendr_engine::model::Model;
use opendr_engine::{Device, ErrorKind, Result};
use opendr_kernels::Compute;
use opendr_rl::prior::{
    AlphaSchedule, BoxedController, CommandLaw, Commanded, DemonstratedSteps, Prior, Residual,
    ResidualConfig, ResidualController, ResidualPpoFitParams, ResidualPpoLearner, Shield, ShieldedVector,
    begin_as_clone, begin_as_prior,
};
use opendr_rl::{
    ActionMode, Algorithm, BehaviourCloningConfig, PolicyMemory, PolicyParams, Ppo, PpoConfig, Sac,
    SacConfig, Td3, Td3Config,
};
use opendr_simulation::uav_corridor::{CompactController, CompactCorridor, ReactiveController};
use opendr_simulation::vector::{Autoreset, EnvironmentVector, VecEnvironment};
use opendr_simulation::{RegisteredSource, make};

use crate::support::Folder;

fn pendulum() -> Box<dyn Environment> {
    make("Pendulum-v1").unwrap()
}

/// A weak feedback law: it leaves something to learn.
fn law(observation: &[f32], action: &mut [f32]) -> Result<()> {
    action[0] = (-2.0 * observation[1] - 0.5 * observation[2]).clamp(-2.0, 2.0);
    Ok(())
}

fn prior() -> BoxedController {
    Box::new(law)
}

fn residual() -> Residual<Box<dyn Environment>> {
    Residual::new(pendulum(), prior(), AlphaSchedule::constant(1.0).unwrap()).unwrap()
}

fn vector(make: impl Fn() -> Box<dyn Environment>, count: usize) -> EnvironmentVector {
    EnvironmentVector::new((0..count).map(|_| make()).collect(), Autoreset::SameStep, 1).unwrap()
}

fn ppo(config: PpoConfig, spec: &EnvironmentSpec) -> Ppo {
    Ppo::new(&config, spec).unwrap()
}

fn small_ppo() -> PpoConfig {
    PpoConfig { n_steps: 64, batch_size: 64, n_epochs: 2, ..PpoConfig::default() }
}

fn small_sac() -> SacConfig {
    let mut config = SacConfig::default();
    config.network.net_arch = vec![16];
    (config.off_policy.buffer_size, config.off_policy.batch_size) = (500, 16);
    (config.off_policy.learning_starts, config.off_policy.starts_with_policy) = (20, true);
    config
}

fn small_td3() -> Td3Config {
    Td3Config { network: small_sac().network, off_policy: small_sac().off_policy, ..Td3Config::default() }
}

/// The actions of `algorithm`'s policy on top of the prior are the prior's, in an episode.
fn assert_is_prior(algorithm: &dyn Algorithm) {
    let mut both = ResidualController::new(algorithm.policy(), prior(), 1.0).unwrap();
    let mut pendulum = pendulum();
    let (mut seen, mut action, mut wanted) = ([0.0; 3], [0.0], [0.0]);
    pendulum.reset(Some(3), &ResetOptions::new(), &mut seen).unwrap();
    both.reset();
    for _ in 0..200 {
        both.act(&seen, &mut action).unwrap();
        law(&seen, &mut wanted).unwrap();
        assert!((action[0] - wanted[0]).abs() <= 1e-6, "{}: {action:?} {wanted:?}", algorithm.name());
        pendulum.step(&action, &mut seen).unwrap();
    }
}

#[test]
fn a_residual_policy_begins_as_its_prior() {
    let config = ResidualConfig::default();
    let spec = residual().spec().clone();
    let mut ppo = ppo(config.ppo(&small_ppo()), &spec);
    let mut sac = Sac::new(&config.sac(&small_sac()), &spec).unwrap();
    let mut td3 = Td3::new(&config.td3(&small_td3()), &spec).unwrap();
    for algorithm in [&mut ppo as &mut dyn Algorithm, &mut sac, &mut td3] {
        begin_as_prior(algorithm, config.correction_log_std).unwrap();
        assert_is_prior(algorithm);
        // The values learn, the actor waits.
        let mut environments = vector(|| Box::new(residual()), 2);
        for _ in 0..60 {
            algorithm.iterate(&mut environments, 100_000).unwrap();
        }
        assert!(algorithm.report().timesteps <= config.critic_warmup);
        assert!(algorithm.report().metrics.get("n_updates").unwrap() > 0.0);
        assert_is_prior(algorithm);
    }
    // It moves then.
    let config = ResidualConfig { critic_warmup: 0, ..config };
    let mut moving = Sac::new(&config.sac(&small_sac()), &spec).unwrap();
    begin_as_prior(&mut moving, config.correction_log_std).unwrap();
    let before = moving.policy().clone();
    moving
        .train(&mut vector(|| Box::new(residual()), 1), 40, &mut |_| Ok(ControlFlow::Continue(())))
        .unwrap();
    assert!(*moving.policy() != before);
}

#[test]
fn corrections_are_added_within_bounds() {
    let mut both = residual();
    assert_eq!(both.spec().action, Space::symmetric(&[2.0]));
    let mut seen = [0.0; 4];
    both.reset(Some(1), &ResetOptions::new(), &mut seen).unwrap();
    let mut wanted = [0.0];
    law(&seen[..3], &mut wanted).unwrap();
    assert_eq!(seen[3], wanted[0]);
    // The same step as by hand, in the environment itself.
    let (mut plain, mut after) = (pendulum(), [0.0; 3]);
    plain.reset(Some(1), &ResetOptions::new(), &mut after).unwrap();
    let by_hand = plain.step(&[(wanted[0] + 0.75).clamp(-2.0, 2.0)], &mut after).unwrap();
    let step = both.step(&[0.75], &mut seen).unwrap();
    assert_eq!((step.reward, &seen[..3]), (by_hand.reward, &after[..]));
    assert!(both.step(&[2.5], &mut seen).is_err());
    assert!(
        Residual::new(make("CartPole-v1").unwrap(), prior(), AlphaSchedule::constant(1.0).unwrap()).is_err()
    );
    // A closure keeps no state that could be written: the snapshot says so instead of being wrong.
    assert_eq!(both.snapshot().unwrap_err().kind(), ErrorKind::Unsupported);
}

#[test]
fn a_residual_corridor_goes_on_from_a_snapshot() {
    let corridor = || {
        let prior: BoxedController = Box::new(CompactController::new(ReactiveController::default()));
        let corridor = CompactCorridor::new(make("UavDepthCorridor-v1").unwrap()).unwrap();
        Residual::new(corridor, prior, AlphaSchedule::linear(0.5, 1.0, 40).unwrap()).unwrap()
    };
    let mut first = corridor();
    let mut seen = vec![0.0; first.spec().observation.len()];
    first.reset(Some(5), &ResetOptions::new(), &mut seen).unwrap();
    first.step(&[0.3, -0.9], &mut seen).unwrap();
    first.step(&[-0.2, 0.8], &mut seen).unwrap();
    let snapshot = first.snapshot().unwrap();
    let mut second = corridor();
    let mut other = seen.clone();
    second.reset(Some(9), &ResetOptions::new(), &mut other).unwrap();
    second.restore(&snapshot).unwrap();
    for action in [[0.1, 0.1], [-0.5, 0.4], [0.0, -1.0]] {
        let steps = (first.step(&action, &mut seen).unwrap(), second.step(&action, &mut other).unwrap());
        assert_eq!(steps.0, steps.1);
        assert_eq!(seen, other);
    }
}

#[test]
fn a_residual_learner_is_saved_with_its_prior() {
    let name = "test-pendulum-law";
    Prior::new(name, 2, |_| Ok(prior())).register().unwrap();
    let folder = Folder::new("prior");
    let mut params = ResidualPpoFitParams::default();
    (params.residual.prior, params.residual.critic_warmup) = (name.to_owned(), 64);
    params.config = small_ppo();
    params.training.total_timesteps = 512;
    params.training.n_eval_episodes = 2;
    let source = RegisteredSource::new("Pendulum-v1", &Default::default()).unwrap();
    let mut learner = Handle::<ResidualPpoLearner>::new(PolicyParams::default(), Device::Cpu).unwrap();
    let job = FitJob::new(folder.path());
    learner.fit_in(&params, &source, None, &job).unwrap();
    let model = Model::open(job.model()).unwrap();
    assert_eq!(model.manifest().inputs["prior"]["name"], name);
    assert_eq!(model.manifest().inputs["prior"]["version"], 2);
    let handle = || Handle::<ResidualPpoLearner>::new(PolicyParams::default(), Device::Cpu).unwrap();
    let mut loaded = handle();
    loaded.load(job.model()).unwrap();
    let mut pendulum = pendulum();
    let (mut seen, mut differs) = ([0.0; 3], false);
    pendulum.reset(Some(8), &ResetOptions::new(), &mut seen).unwrap();
    for _ in 0..20 {
        let observation = Observation::from_data(seen.to_vec()).unwrap();
        let action = loaded.infer(&observation).unwrap().values.clone();
        assert_eq!(action, learner.infer(&observation).unwrap().values);
        let mut wanted = [0.0];
        law(&seen, &mut wanted).unwrap();
        differs |= (action[0] - wanted[0]).abs() > 1e-4;
        pendulum.step(&action, &mut seen).unwrap();
    }
    assert!(differs, "the policy corrects nothing");
    // Another program does not know the prior.
    let manifest = job.model().join("model.json");
    let text = std::fs::read_to_string(&manifest).unwrap();
    std::fs::write(&manifest, text.replace(name, "someone-elses-law")).unwrap();
    let error = handle().load(job.model()).unwrap_err();
    assert!(
        error.kind() == ErrorKind::NotFound && error.to_string().contains("someone-elses-law"),
        "{error}"
    );
}

#[test]
fn a_policy_commands_a_controller() {
    // The command is the gain of the law.
    let gains = Space::uniform(0.0, 4.0, &[1]).unwrap();
    let law = |seen: &[f32], gain: &[f32], action: &mut [f32]| {
        action[0] = (-gain[0] * seen[2]).clamp(-2.0, 2.0);
        Ok(())
    };
    let mut commanded = Commanded::new(pendulum(), CommandLaw::new(gains.clone(), 1, law), 4).unwrap();
    assert_eq!((&commanded.spec().action, commanded.spec().max_episode_steps), (&gains, Some(50)));
    let (mut seen, mut after) = ([0.0; 3], [0.0; 3]);
    commanded.reset(Some(2), &ResetOptions::new(), &mut seen).unwrap();
    let mut plain = pendulum();
    plain.reset(Some(2), &ResetOptions::new(), &mut after).unwrap();
    let mut earned = 0.0;
    for _ in 0..4 {
        let action = [(-1.5 * after[2]).clamp(-2.0, 2.0)];
        earned += plain.step(&action, &mut after).unwrap().reward;
    }
    let step = commanded.step(&[1.5], &mut seen).unwrap();
    assert_eq!((step.reward, seen), (earned, after));
    assert!(commanded.step(&[5.0], &mut seen).is_err());
}

#[test]
fn demonstrations_have_their_share() {
    let steps = DemonstratedSteps::record(&mut law, &mut *pendulum(), 0..3).unwrap();
    assert_eq!((steps.len(), steps.returns().len()), (600, 3));
    let spec = pendulum().spec().clone();
    let train = |share: Option<f32>| {
        let mut sac = Sac::new(&small_sac(), &spec).unwrap();
        if let Some(share) = share {
            sac.set_demonstrations(&steps, share).unwrap();
        }
        sac.train(&mut vector(pendulum, 1), 60, &mut |_| Ok(ControlFlow::Continue(()))).unwrap();
        sac.policy().clone()
    };
    assert!(train(Some(0.5)) != train(None) && train(Some(0.5)) == train(Some(0.5)));
    let mut td3 = Td3::new(&small_td3(), &spec).unwrap();
    td3.set_demonstrations(&steps, 0.25).unwrap();
    td3.train(&mut vector(pendulum, 1), 60, &mut |_| Ok(ControlFlow::Continue(()))).unwrap();
    assert!(td3.set_demonstrations(&steps, 1.0).is_err());
    let mut elsewhere = Sac::new(&small_sac(), residual().spec()).unwrap();
    assert_eq!(elsewhere.set_demonstrations(&steps, 0.5).unwrap_err().kind(), ErrorKind::InvalidInput);
    // Cloned behaviour is near the prior before any training.
    let mut ppo = ppo(small_ppo(), &spec);
    let config = BehaviourCloningConfig { n_epochs: 40, ..BehaviourCloningConfig::default() };
    begin_as_clone(&mut ppo, &steps, &config, &Compute::single()).unwrap();
    let (mut pendulum, mut seen, mut errors) = (pendulum(), [0.0; 3], 0.0);
    pendulum.reset(Some(1), &ResetOptions::new(), &mut seen).unwrap();
    for _ in 0..200 {
        let (mut own, mut wanted) = ([0.0], [0.0]);
        let acting = ActionMode::Deterministic;
        ppo.policy().act(&Compute::single(), &seen, acting, &mut PolicyMemory::default(), &mut own).unwrap();
        law(&seen, &mut wanted).unwrap();
        errors += (own[0] - wanted[0]).abs() / 200.0;
        pendulum.step(&wanted, &mut seen).unwrap();
    }
    assert!(errors < 0.3, "{errors}");
}

/// An environment with the last action as its observation and as its reward.
struct Echo(EnvironmentSpec, u32);

impl Echo {
    fn new() -> Self {
        Self(EnvironmentSpec::new("Echo-v0", Space::symmetric(&[1.0]), Space::symmetric(&[1.0])), 0)
    }
}

impl Environment for Echo {
    fn spec(&self) -> &EnvironmentSpec {
        &self.0
    }

    fn reset(&mut self, _: Option<u64>, _: &ResetOptions, seen: &mut [f32]) -> Result<Info> {
        self.1 = 0;
        seen.fill(0.0);
        Ok(Info::default())
    }

    fn step(&mut self, action: &[f32], seen: &mut [f32]) -> Result<Step> {
        self.1 += 1;
        seen.copy_from_slice(action);
        Ok(Step { reward: action[0].into(), terminated: self.1 == 10, ..Step::default() })
    }
}

fn shielded(is_unsafe: fn(&[f32], &[f32]) -> bool) -> ShieldedVector<EnvironmentVector> {
    let fallback = |_: &[f32], action: &mut [f32]| -> Result<()> {
        action.fill(0.25);
        Ok(())
    };
    let shields = (0..2).map(|_| Shield::new(is_unsafe, Box::new(fallback))).collect();
    ShieldedVector::new(vector(|| Box::new(Echo::new()), 2), shields).unwrap()
}

#[test]
fn executed_actions_are_learnt_from() {
    let spec = Echo::new().spec().clone();
    let mut always = shielded(|_, _| true);
    let mut sac = Sac::new(&small_sac(), &spec).unwrap();
    sac.train(&mut always, 40, &mut |_| Ok(ControlFlow::Continue(()))).unwrap();
    assert_eq!(always.shielded_share(), 1.0);
    let state = sac.saved_state(&vector(|| Box::new(Echo::new()), 2)).unwrap();
    for (row, wanted) in [("replay_actions", 0.25), ("replay_rewards", 0.25), ("replay_shielded", 1.0)] {
        let files = state.files().unwrap();
        let (_, bytes) = files.iter().find(|(name, _)| *name == format!("{row}.f32")).unwrap();
        let numbers: Vec<_> =
            bytes.as_chunks::<4>().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
        assert!(numbers.len() >= 40 && numbers.iter().all(|number| *number == wanted), "{row}: {numbers:?}");
    }
    // PPO learns nothing about actions that it did not choose, but for the entropy, which has no weight here.
    let mut ppo = ppo(small_ppo(), &spec);
    let before = ppo.policy().clone();
    ppo.iterate(&mut always, 1000).unwrap();
    assert!(*ppo.policy() == before && ppo.report().metrics.get("shielded") == Some(1.0));
    let mut sometimes = shielded(|_, action| action[0] > 0.0);
    ppo.iterate(&mut sometimes, 1000).unwrap_or_else(|error| panic!("{error}"));
    assert!(*ppo.policy() != before && (0.2..0.8).contains(&sometimes.shielded_share()));
    let interventions = sometimes.interventions().unwrap();
    assert!(
        interventions
            .actions
            .iter()
            .zip(interventions.replaced)
            .all(|(action, replaced)| { if *replaced { *action == 0.25 } else { *action <= 0.0 } })
    );
}
