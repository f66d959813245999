//! Drones arrive, keep the memory of a flight until `reset`, and train reproducibly on any number of threads.
#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};

use opendr_engine::environment::{Environment, ResetOptions, Step};
use opendr_engine::learner::{FitJob, Handle, Learner as _};
use opendr_engine::model::{Manifest, Model, ModelWriter};
use opendr_engine::{Device, ErrorKind, Result};
use opendr_planning::end_to_end::{EndToEndPlanningFitParams, EndToEndPlanningRl, FlightParams};
use opendr_rl::{EvaluationProtocol, POLICY_FILE, evaluate_controller, observation_from_numbers};
use opendr_simulation::make;

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("opendr-planning-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn handle() -> Handle<EndToEndPlanningRl> {
    Handle::new(FlightParams::default(), Device::Cpu).unwrap()
}

/// Returns a learner with OpenDR's pretrained policy.
fn pretrained(folder: &Path) -> Handle<EndToEndPlanningRl> {
    let weights = "../../models/weights/end_to_end_planning/uav_depth_corridor.safetensors";
    let weights = PathBuf::from(std::env::var_os("CARGO_MANIFEST_DIR").unwrap()).join(weights);
    let mut writer = ModelWriter::new(folder, Manifest::new(EndToEndPlanningRl::SPEC.name, "")).unwrap();
    writer.add(POLICY_FILE, &std::fs::read(weights).unwrap()).unwrap();
    writer.finish().unwrap();
    let mut learner = handle();
    learner.load(folder).unwrap();
    learner
}

fn corridor() -> Result<Box<dyn Environment>> {
    make("UavDepthCorridor-v1")
}

/// Returns the first actions of a flight in the same corridor.
fn flight(learner: &mut Handle<EndToEndPlanningRl>) -> Vec<Vec<f32>> {
    let mut corridor = corridor().unwrap();
    let space = corridor.spec().observation.clone();
    let mut observation = vec![0.0; space.len()];
    corridor.reset(Some(3), &ResetOptions::new(), &mut observation).unwrap();
    let mut actions = Vec::new();
    for _ in 0..8 {
        let action = learner.infer(&observation_from_numbers(&space, &observation).unwrap()).unwrap().values;
        let over = corridor.step(&action, &mut observation).unwrap().is_over();
        actions.push(action);
        if over {
            break;
        }
    }
    actions
}

/// Success rates in the first hundred of the 500 worlds of the table of results; between many obstacles, in all of them.
#[test]
fn the_pretrained_policy_arrives() {
    struct Pilot<'a>(&'a mut Handle<EndToEndPlanningRl>);
    impl opendr_engine::environment::Controller for Pilot<'_> {
        fn reset(&mut self) {
            self.0.reset();
        }
        fn act(&mut self, numbers: &[f32], action: &mut [f32]) -> Result<()> {
            let space = corridor()?.spec().observation.clone();
            action.copy_from_slice(&self.0.infer(&observation_from_numbers(&space, numbers)?)?.values);
            Ok(())
        }
    }
    let folder = Folder::new("arrives");
    let mut learner = pretrained(&folder.0);
    for (id, least, episodes) in [
        ("UavDepthCorridor-v1", 0.88, 100),
        ("UavDepthCorridor-noisy-v1", 0.88, 100),
        ("UavDepthCorridor-dyn-v1", 0.84, 100),
        ("UavDepthCorridor-dense-v1", 0.8, 500),
    ] {
        let protocol = EvaluationProtocol { episodes, ..EvaluationProtocol::default() };
        let success = |step: &Step| step.info.success();
        let report =
            evaluate_controller(&mut Pilot(&mut learner), &mut *make(id).unwrap(), &protocol, &success);
        let success = report.unwrap().success.unwrap();
        assert!(success.rate >= least, "{id}: {success:?}");
    }
}

#[test]
fn memory_of_a_flight_is_kept_until_reset() {
    let folder = Folder::new("flight");
    let mut learner = pretrained(&folder.0);
    let first = flight(&mut learner);
    assert_ne!(flight(&mut learner), first);
    learner.reset();
    assert_eq!(flight(&mut learner), first);
}

#[test]
fn training_does_not_depend_on_the_number_of_threads() {
    let folder = Folder::new("fit");
    let mut params = EndToEndPlanningFitParams {
        n_steps: 64,
        batch_size: 64,
        surroundings_flights: 4,
        foresight_flights: 2,
        ..Default::default()
    };
    params.training.total_timesteps = 256;
    params.training.n_envs = 2;
    params.training.n_eval_episodes = 1;
    let policies = [1, 2].map(|workers| {
        params.training.num_workers = workers;
        let (mut learner, output) = (handle(), folder.0.join(workers.to_string()));
        let statistics = learner.fit_in(&params, &corridor, None, &FitJob::new(&output)).unwrap();
        assert_eq!(statistics.get("steps"), Some(256.0));
        assert_eq!(flight(&mut learner).first().unwrap().len(), 2);
        let model = Model::open(output.join("model")).unwrap();
        [POLICY_FILE, "surroundings.f32", "foresight.f32"].map(|name| model.file(name).unwrap())
    });
    assert!(policies[0] == policies[1]);
    // A foresight needs surroundings.
    let alone = EndToEndPlanningFitParams { surroundings_flights: 0, ..params.clone() };
    let error = handle().fit_in(&alone, &corridor, None, &FitJob::new(&folder.0.join("alone"))).unwrap_err();
    assert!(error.to_string().contains("surroundings_flights"), "{error}");
    // Another environment is refused before anything is learnt.
    params.surroundings_flights = 1_000_000;
    let cart = || make("CartPole-v1");
    let error = handle().fit_in(&params, &cart, None, &FitJob::new(&folder.0.join("cart"))).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Unsupported, "{error}");
}
