//! The priors of this crate as parameters of trainings.

use std::path::PathBuf;

use opendr_control::{Actuator, AxisInput, Lqr, ObservationLqr, ObservationPid, PidGains, priors};
use opendr_engine::data::Observation;
use opendr_engine::environment::{Environment, ResetOptions, Snapshot};
use opendr_engine::learner::{FitJob, Handle, LearnerRl};
use opendr_engine::model::Model;
use opendr_engine::params::{ParamMap, Params as _};
use opendr_engine::{Device, Result};
use opendr_rl::prior::{
    AlphaSchedule, Prior, Residual, ResidualPpoFitParams, ResidualPpoLearner, controllers_of_model,
};
use opendr_rl::{EvaluationProtocol, PolicyParams, PpoFitParams, PpoLearner, evaluate_controller};
use opendr_simulation::{RegisteredSource, make};
use opendr_test_allocator::allocations_of_thread;

/// Makes the priors known once in a program that runs all tests.
fn provide() {
    static ONCE: std::sync::Once = std::sync::Once::new();
    ONCE.call_once(|| Prior::provide(priors()));
}

fn folder(name: &str) -> PathBuf {
    std::env::temp_dir().join(format!("opendr-control-{name}-{}", std::process::id()))
}

fn remove(name: &str) {
    std::fs::remove_dir_all(folder(name)).ok();
}

fn fit<L: LearnerRl<Params = PolicyParams>>(
    name: &str,
    id: &str,
    fit_params: &L::FitParams,
) -> Result<Model> {
    let folder = folder(name);
    let mut learner = Handle::<L>::new(PolicyParams::default(), Device::Cpu)?;
    let source = RegisteredSource::new(id, &ParamMap::new())?;
    let job = FitJob::new(&folder);
    learner.fit_in(fit_params, &source, None, &job)?;
    Model::open(job.model())
}

#[test]
fn policies_correct_the_controllers() {
    provide();
    for (prior, id) in [
        ("quad-track-pid", "QuadTrack-v1"),
        ("quad-track-lqr", "QuadTrack-v1"),
        ("pendulum-lqr", "Pendulum-v1"),
    ] {
        let mut params = ResidualPpoFitParams::default();
        params.residual.prior = prior.to_owned();
        (params.config.n_steps, params.training.n_envs, params.training.total_timesteps) = (32, 2, 64);
        (params.training.n_eval_episodes, params.training.preset) = (1, false);
        let model = fit::<ResidualPpoLearner>(prior, id, &params).unwrap();
        let mut rows = controllers_of_model(&model, &PolicyParams::default().to_map()).unwrap().unwrap();
        assert_eq!(
            rows.iter().map(|row| row.name()).collect::<Vec<_>>(),
            ["prior", "policy", "prior and policy"]
        );
        let mut environment = make(id).unwrap();
        let protocol = EvaluationProtocol { episodes: 1, ..EvaluationProtocol::default() };
        let report = evaluate_controller(&mut rows[0], &mut *environment, &protocol, &|_| None).unwrap();
        assert!(report.mean_return > -400.0, "{prior}: {}", report.mean_return);
        remove(prior);
    }
    let mut params = ResidualPpoFitParams::default();
    params.residual.prior = "quad-track-pid".to_owned();
    let error = fit::<ResidualPpoLearner>("wrong", "Pendulum-v1", &params).unwrap_err();
    assert!(error.to_string().contains("quad-track-pid reads no observations"), "{error}");
}

/// PPO that begins with cloned behaviour: choices are cloned, too.
#[test]
fn a_policy_of_choices_is_cloned_from_the_regulator() {
    provide();
    let mut params = PpoFitParams::default();
    params.demonstrations.demonstration_prior = Some("cart-pole-lqr".to_owned());
    params.demonstrations.demonstration_episodes = 20;
    (params.config.n_steps, params.config.actor_starts) = (64, 1_000_000);
    (params.training.total_timesteps, params.training.preset) = (64, false);
    params.training.n_eval_episodes = 1;
    let model = fit::<PpoLearner>("cloned", "CartPole-v1", &params).unwrap();
    let mut learner = Handle::<PpoLearner>::new(PolicyParams::default(), Device::Cpu).unwrap();
    learner.load_model(model).unwrap();
    let (mut cart, mut seen, mut steps) = (make("CartPole-v1").unwrap(), [0.0; 4], 0);
    cart.reset(Some(1), &ResetOptions::new(), &mut seen).unwrap();
    loop {
        let chosen = learner.infer(&Observation::from_data(seen.to_vec()).unwrap()).unwrap().values.clone();
        steps += 1;
        if cart.step(&chosen, &mut seen).unwrap().is_over() {
            break;
        }
    }
    assert!(steps > 200, "a random policy balances for about 20 steps, the clone for {steps}");
    remove("cloned");
}

/// The integrals of a PID are part of a snapshot, so that a residual training resumes bit for bit.
#[test]
fn a_corrected_pid_continues_from_a_snapshot() {
    provide();
    let made = || {
        let track = make("QuadTrack-v1").unwrap();
        let prior = Prior::newest("quad-track-pid").unwrap().controller(&track.spec().observation).unwrap();
        Residual::new(track, prior, AlphaSchedule::linear(1.0, 1.0, 0).unwrap()).unwrap()
    };
    let mut flight = made();
    let mut observation = vec![0.0; flight.spec().observation.len()];
    flight.reset(Some(2), &ResetOptions::new(), &mut observation).unwrap();
    let correction = [0.3, -0.2, 0.1];
    (0..50).for_each(|_| drop(flight.step(&correction, &mut observation).unwrap()));
    let mut snapshot = Snapshot::new("flight");
    flight.save_state(&mut snapshot).unwrap();
    let mut again = made();
    let mut reader = snapshot.read("flight").unwrap();
    again.load_state(&mut reader).unwrap();
    reader.finish().unwrap();
    let mut other = observation.clone();
    for _ in 0..50 {
        let (one, two) = (flight.step(&correction, &mut observation), again.step(&correction, &mut other));
        assert_eq!((one.unwrap(), &observation), (two.unwrap(), &other));
    }
}

/// A user's own gains and matrices, as few lines as in Python.
#[test]
fn own_gains_and_matrices_are_priors() {
    let gains = PidGains { kp: 12.0, kd: 3.0, filter: 0.0, ..PidGains::default() };
    let upright = AxisInput { place: 1, rate: Some(2), setpoint: Some(0.0) };
    let pid = ObservationPid::new(&[gains], &[upright], 0.05, Actuator::Limited(vec![2.0])).unwrap();
    pid.into_prior("test-own-pid", 1).about("balances Pendulum-v1").register().unwrap();
    let lqr = Lqr::double_integrator(0.05, 10.0, 1.0, 1.0).unwrap();
    let law = ObservationLqr::new(lqr, vec![1, 2], vec![0.0; 2], vec![0.0], Actuator::Limited(vec![2.0]));
    law.unwrap().into_prior("test-own-lqr", 1).register().unwrap();
    let space = make("Pendulum-v1").unwrap().spec().observation.clone();
    for name in ["test-own-pid", "test-own-lqr"] {
        let mut controller = Prior::newest(name).unwrap().controller(&space).unwrap();
        let mut action = [0.0];
        controller.act(&[0.99, 0.1, 0.2], &mut action).unwrap();
        assert!(action[0] < -0.3, "{name} pushes back: {action:?}");
        let before = allocations_of_thread();
        (0..10).for_each(|_| controller.act(&[0.99, 0.1, 0.2], &mut action).unwrap());
        assert_eq!(allocations_of_thread() - before, 0, "{name}");
    }
}
