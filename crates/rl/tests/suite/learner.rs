//! Policies as learners: training, resuming, evaluation, saving and errors.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use opendr_engine::data::Observation;
use opendr_engine::environment::{
    Environment, EnvironmentSpec, Info, ResetOptions, Snapshot, StateReader, Step,
};
use opendr_engine::learner::{FitJob, Handle};
use opendr_engine::model::Model;
use opendr_engine::{Device, Error, ErrorKind, Progress, Result, Unit};
use opendr_rl::{PolicyParams, PpoFitParams, PpoLearner};

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("opendr-rl-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn cart() -> Result<Box<dyn Environment>> {
    opendr_simulation::make("CartPole-v1")
}

fn short(steps: u64) -> PpoFitParams {
    let mut params = PpoFitParams::default();
    params.training.total_timesteps = steps;
    params.training.eval_freq = 512;
    params.training.n_eval_episodes = 3;
    params.training.checkpoint_after_iter = 512;
    params
}

fn handle() -> Handle<PpoLearner> {
    Handle::new(PolicyParams::default(), Device::Cpu).unwrap()
}

fn policy_of(folder: &Path) -> Vec<u8> {
    Model::open(folder.join("model")).unwrap().file("policy.safetensors").unwrap()
}

#[test]
fn fit_writes_a_container_that_acts() {
    let folder = Folder::new("fit");
    let mut learner = handle();
    let log = folder.0.join("log");
    let job = FitJob { logging_path: Some(&log), ..FitJob::new(&folder.0) };
    let statistics = learner.fit_in(&short(2048), &cart, None, &job).unwrap();
    assert_eq!(statistics.get("steps"), Some(2048.0));
    assert!(statistics.curves["val_return"].len() > 1, "{statistics:?}");
    assert!(log.join("curves.svg").exists());

    let observation = Observation::from_data(vec![0.0, 0.0, 0.05, 0.0]).unwrap();
    let chosen = learner.infer(&observation).unwrap();
    assert!([0.0, 1.0].contains(&chosen.values[0]) && chosen.values.len() == 1, "{chosen:?}");
    let copy = folder.0.join("copy");
    learner.save(&copy).unwrap();
    let mut again = handle();
    again.load(&copy).unwrap();
    assert_eq!(again.infer(&observation).unwrap(), chosen);
    assert_eq!(again.model().unwrap().manifest().inputs["environment"], "CartPole-v1");
    let short = Observation::from_data(vec![0.0; 3]).unwrap();
    assert_eq!(again.infer(&short).unwrap_err().kind(), ErrorKind::InvalidInput);
}

/// Stops after a number of steps.
struct StopsAt(u64, AtomicU64);

impl Progress for StopsAt {
    fn begin(&self, _: &str, _: Option<u64>, _: Unit) {}
    fn advance(&self, amount: u64) {
        self.1.fetch_add(amount, Ordering::Relaxed);
    }
    fn end(&self) {}
    fn stopped(&self) -> bool {
        self.1.load(Ordering::Relaxed) >= self.0
    }
}

#[test]
fn a_resumed_training_gives_the_result_of_an_uninterrupted_one() {
    let (whole, parts) = (Folder::new("whole"), Folder::new("parts"));
    // Evaluated at the end only, so that the last policy is the one that is written.
    let mut params = short(2048);
    params.training.eval_freq = 0;
    handle().fit_in(&params, &cart, None, &FitJob::new(&whole.0)).unwrap();
    let stops = StopsAt(700, AtomicU64::new(0));
    let job = FitJob { progress: &stops, ..FitJob::new(&parts.0) };
    let statistics = handle().fit_in(&params, &cart, None, &job).unwrap();
    assert!((700.0..1200.0).contains(&statistics.get("steps").unwrap()), "{statistics:?}");
    assert!(policy_of(&whole.0) != policy_of(&parts.0));
    let job = FitJob { resume: true, ..FitJob::new(&parts.0) };
    handle().fit_in(&params, &cart, None, &job).unwrap();
    assert!(policy_of(&whole.0) == policy_of(&parts.0));
}

#[test]
fn a_failing_environment_is_reported_with_its_step_and_the_checkpoint_stays() {
    struct Breaking(Box<dyn Environment>, u32);
    impl Environment for Breaking {
        fn spec(&self) -> &EnvironmentSpec {
            self.0.spec()
        }
        fn reset(
            &mut self,
            seed: Option<u64>,
            options: &ResetOptions,
            observation: &mut [f32],
        ) -> Result<Info> {
            self.0.reset(seed, options, observation)
        }
        fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
            self.1 += 1;
            if self.1 == 200 {
                return Err(Error::internal("the motor burnt"));
            }
            self.0.step(action, observation)
        }
        fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
            self.0.save_state(snapshot)
        }
        fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
            self.0.load_state(state)
        }
    }
    let folder = Folder::new("broken");
    let breaking = || -> Result<Box<dyn Environment>> { Ok(Box::new(Breaking(cart()?, 0))) };
    let error = handle().fit_in(&short(20_000), &breaking, Some(&cart), &FitJob::new(&folder.0)).unwrap_err();
    let text = error.to_string();
    assert!(text.contains("the motor burnt") && text.contains("step"), "{text}");
    let job = FitJob { resume: true, ..FitJob::new(&folder.0) };
    let statistics = handle().fit_in(&short(2048), &cart, None, &job).unwrap();
    assert!(statistics.get("steps").unwrap() >= 2048.0);
}

#[test]
fn an_environment_without_snapshots_restarts_its_episodes() {
    struct WithoutSnapshots(Box<dyn Environment>);
    impl Environment for WithoutSnapshots {
        fn spec(&self) -> &EnvironmentSpec {
            self.0.spec()
        }
        fn reset(
            &mut self,
            seed: Option<u64>,
            options: &ResetOptions,
            observation: &mut [f32],
        ) -> Result<Info> {
            self.0.reset(seed, options, observation)
        }
        fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
            self.0.step(action, observation)
        }
    }
    let folder = Folder::new("forgetful");
    let forgetful = || -> Result<Box<dyn Environment>> { Ok(Box::new(WithoutSnapshots(cart()?))) };
    let stops = StopsAt(700, AtomicU64::new(0));
    let job = FitJob { progress: &stops, ..FitJob::new(&folder.0) };
    handle().fit_in(&short(2048), &forgetful, None, &job).unwrap();
    let job = FitJob { resume: true, ..FitJob::new(&folder.0) };
    let statistics = handle().fit_in(&short(2048), &forgetful, None, &job).unwrap();
    assert_eq!(statistics.get("steps"), Some(2048.0));
    assert!(statistics.get("mean_return").unwrap() > 9.0);
}
