//! Policies of action chunks from the demonstration to the container, and what they guarantee.

#![allow(clippy::unwrap_used)]

use std::ops::ControlFlow;

use opendr_engine::environment::{Controller, Environment, Space};
use opendr_engine::learner::{FitJob, Learner as _, LearnerRl};
use opendr_engine::model::Model;
use opendr_engine::{Device, ErrorKind, Random, Result};
use opendr_imitation::{
    Act, ActConfig, ActFitParams, ActLearner, ActParams, ChunkMethod, ChunkPolicy, ChunkState, ChunkTraining,
    ChunkTrainingParams, DemonstrationSet, DiffusionConfig, DiffusionParams, DiffusionPolicy, Episode,
    ImitationMethod, RecordingOptions, TeacherParams,
};
use opendr_kernels::Compute;
use opendr_rl::prior::Prior;

#[global_allocator]
static ALLOCATOR: opendr_test_allocator::CountingAllocator = opendr_test_allocator::CountingAllocator;

fn act_config() -> ActConfig {
    ActConfig {
        chunk_size: 6,
        dim_model: 32,
        n_heads: 2,
        dim_feedforward: 32,
        n_encoder_layers: 1,
        n_decoder_layers: 1,
        n_vae_encoder_layers: 1,
        latent_dim: 4,
        ..ActConfig::default()
    }
}

fn diffusion_config() -> DiffusionConfig {
    DiffusionConfig { horizon: 8, cond_dim: 32, width: 64, n_blocks: 2, ..DiffusionConfig::default() }
}

/// A point that is demonstrated to go to zero by half of its distance in each step.
fn demonstrations() -> DemonstrationSet {
    let (mut set, mut random) = (DemonstrationSet::new([1, 1]).unwrap(), Random::new(3));
    for _ in 0..40 {
        let mut place = random.uniform(-1.0, 1.0);
        let mut episode = Episode::default();
        for _ in 0..12 {
            let action = -0.5 * place;
            episode.observations.push(place);
            episode.actions.push(action);
            place += action;
        }
        set.add(episode).unwrap();
    }
    set
}

fn spaces() -> [Space; 2] {
    [Space::symmetric(&[f32::INFINITY]), Space::symmetric(&[1.0])]
}

fn trained<M: ChunkMethod>(config: &M::Config, steps: u64, threads: usize) -> ChunkPolicy<M> {
    let params = ChunkTrainingParams {
        training_steps: steps,
        warmup_steps: 20,
        learning_rate: 2e-3,
        num_workers: threads,
        ..ChunkTrainingParams::default()
    };
    let mut training = ChunkTraining::<M>::new(config, &params, spaces(), &demonstrations(), None).unwrap();
    training.run(&mut |_, _| ControlFlow::Continue(())).unwrap();
    training.policy().clone()
}

/// Returns the largest distance from zero after some steps from several places.
fn distance<M: ChunkMethod>(policy: &ChunkPolicy<M>, params: &M::Params) -> f32 {
    let mut controller = policy.controller(params);
    let mut largest = 0.0f32;
    for start in [-0.9f32, -0.3, 0.2, 0.8] {
        controller.reset();
        let mut place = start;
        for _ in 0..12 {
            let mut action = [0.0];
            controller.act(&[place], &mut action).unwrap();
            place += action[0];
        }
        largest = largest.max(place.abs());
    }
    largest
}

#[test]
fn both_methods_learn_to_do_what_is_demonstrated() {
    let act = trained::<Act>(&act_config(), 600, 2);
    let far = distance(&act, &ActParams::default());
    assert!(far < 0.1, "ACT: {far}");
    let open = ActParams { temporal_ensemble: false, n_action_steps: 3, ..ActParams::default() };
    let far = distance(&act, &open);
    assert!(far < 0.1, "ACT without ensemble: {far}");
    let diffusion = trained::<DiffusionPolicy>(&diffusion_config(), 1500, 2);
    let far = distance(&diffusion, &DiffusionParams::default());
    assert!(far < 0.15, "diffusion policy: {far}");
}

#[test]
fn threads_do_not_change_a_bit() {
    assert_eq!(
        trained::<Act>(&act_config(), 5, 1).to_bytes().unwrap(),
        trained::<Act>(&act_config(), 5, 2).to_bytes().unwrap()
    );
    assert_eq!(
        trained::<DiffusionPolicy>(&diffusion_config(), 5, 1).to_bytes().unwrap(),
        trained::<DiffusionPolicy>(&diffusion_config(), 5, 2).to_bytes().unwrap()
    );
}

#[test]
fn control_allocates_nothing() {
    fn check<M: ChunkMethod>(config: &M::Config, params: &M::Params) {
        let policy = trained::<M>(config, 2, 1);
        let (compute, mut state, mut action) = (Compute::single(), ChunkState::default(), [0.0]);
        let mut run = |steps: usize| {
            state.reset();
            for step in 0..steps {
                policy.act(&compute, params, &mut state, &[step as f32 / 20.0], &mut action).unwrap();
            }
        };
        run(20);
        let before = opendr_test_allocator::allocations_of_thread();
        run(20);
        assert_eq!(opendr_test_allocator::allocations_of_thread(), before, "{}", M::SPEC.name);
    }
    check::<Act>(&act_config(), &ActParams::default());
    check::<DiffusionPolicy>(&diffusion_config(), &DiffusionParams::default());
}

#[test]
fn files_are_restored_and_damage_is_detected() {
    fn check<M: ChunkMethod>(config: &M::Config, params: &M::Params) {
        let policy = trained::<M>(config, 2, 1);
        let bytes = policy.to_bytes().unwrap();
        let again = ChunkPolicy::<M>::from_bytes(&bytes).unwrap();
        assert_eq!(distance(&policy, params), distance(&again, params));
        for cut in (0..1200).step_by(7).chain([bytes.len() - 1]) {
            assert!(ChunkPolicy::<M>::from_bytes(&bytes[..cut]).is_err(), "{cut}");
        }
        for at in 0..1200 {
            let mut damaged = bytes.clone();
            damaged[at] ^= 0x15;
            drop(ChunkPolicy::<M>::from_bytes(&damaged));
        }
    }
    check::<Act>(&act_config(), &ActParams::default());
    check::<DiffusionPolicy>(&diffusion_config(), &DiffusionParams::default());
    let act = trained::<Act>(&act_config(), 1, 1).to_bytes().unwrap();
    assert_eq!(ChunkPolicy::<DiffusionPolicy>::from_bytes(&act).unwrap_err().kind(), ErrorKind::InvalidInput);
}

#[test]
fn impossible_settings_are_errors() {
    let new = |config: &ActConfig| Act::new(config, [3, 2]).err().map(|error| error.kind());
    assert_eq!(new(&ActConfig { n_heads: 5, ..act_config() }), Some(ErrorKind::InvalidParam));
    let config = DiffusionConfig { n_obs_steps: 9, ..diffusion_config() };
    assert!(DiffusionPolicy::new(&config, [3, 2]).is_err());
    let params = ChunkTrainingParams::default();
    let wrong = [Space::symmetric(&[1.0; 2]), Space::symmetric(&[1.0])];
    assert!(ChunkTraining::<Act>::new(&act_config(), &params, wrong, &demonstrations(), None).is_err());
    let policy = trained::<Act>(&act_config(), 1, 1);
    let mut state = ChunkState::default();
    let mut act = |observation: &[f32]| {
        policy.act(&Compute::single(), &ActParams::default(), &mut state, observation, &mut [0.0])
    };
    assert!(act(&[f32::NAN]).is_err() && act(&[0.0, 0.0]).is_err() && act(&[0.0]).is_ok());
}

/// A teacher in an environment, a container, and a resumed training.
#[test]
fn a_training_resumes_to_the_same_policy() {
    let env = || -> Result<Box<dyn Environment>> { opendr_simulation::make("Pendulum-v1") };
    let folder = std::env::temp_dir().join(format!("opendr-imitation-{}", std::process::id()));
    let run = |name: &str, steps: u64, resume: bool| {
        let fit_params = ActFitParams {
            config: act_config(),
            training: ChunkTrainingParams {
                training_steps: steps,
                checkpoint_after_iter: 4,
                warmup_steps: 0,
                learning_rate: 1e-3,
                ..ChunkTrainingParams::default()
            },
            teacher: TeacherParams {
                demonstration_prior: Some("pendulum-energy".to_owned()),
                demonstration_episodes: 2,
                n_eval_episodes: 1,
                ..TeacherParams::default()
            },
        };
        let output = folder.join(name);
        let job = FitJob { resume, ..FitJob::new(&output) };
        let statistics =
            <ActLearner as LearnerRl>::fit(None, &ActParams::default(), &fit_params, &env, None, &job)
                .unwrap();
        assert!(statistics.get("val_return").is_some());
        let model = Model::open(job.model()).unwrap();
        let learner = ActLearner::load(&model, ActParams::default(), Device::Cpu).unwrap();
        learner.policy().to_bytes().unwrap()
    };
    let whole = run("policy", 8, false);
    // Without the last checkpoint, the training resumes in its middle.
    let checkpoints = std::fs::read_dir(folder.join("policy/checkpoints")).unwrap();
    let last = checkpoints.map(|entry| entry.unwrap().path()).max().unwrap();
    assert!(last.to_string_lossy().ends_with("00008"), "{last:?}");
    std::fs::remove_dir_all(last).unwrap();
    assert!(whole == run("policy", 8, true));
    let mut world = env().unwrap();
    let mut teacher =
        Prior::newest("pendulum-energy").unwrap().controller(&world.spec().observation.clone()).unwrap();
    let options = RecordingOptions { episodes: 2, first_seed: 1, successes_only: true };
    let set = DemonstrationSet::record(&mut *teacher, &mut *world, &options, &mut |_| {}).unwrap();
    assert_eq!((set.steps(), set.row_lengths()), (400, [3, 1]));
    std::fs::remove_dir_all(&folder).unwrap();
    let fit_params = ActFitParams::default();
    let (config, ..) = Act::parts(&fit_params);
    assert_eq!(*config, ActConfig::default());
}
