//! Environments that fail, and numbers that are not finite.

use crate::support::{Folder, environments};
use opendr_engine::environment::{
    Environment, EnvironmentSpec, Info, ResetOptions, Snapshot, Space, StateReader, Step,
};
use opendr_engine::{Error, ErrorKind, Result};
use opendr_kernels::Compute;
use opendr_rl::{
    ActionMode, Algorithm, Dqn, DqnConfig, Policy, PolicyMemory, Ppo, PpoConfig, Sac, SacConfig, Td3,
    Td3Config,
};
use opendr_simulation::make;
use opendr_simulation::vector::{Autoreset, EnvironmentVector, VecEnvironment};

#[derive(Debug, Clone, Copy, PartialEq)]
enum Fault {
    Error,
    Observation,
    LastObservation,
    Reward,
}

/// An environment with a fault at step `at`.
struct Faulty {
    inner: Box<dyn Environment>,
    fault: Fault,
    at: u64,
    steps: u64,
}

impl Environment for Faulty {
    fn spec(&self) -> &EnvironmentSpec {
        self.inner.spec()
    }

    fn reset(&mut self, seed: Option<u64>, options: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        self.inner.reset(seed, options, observation)
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        let mut step = self.inner.step(action, observation)?;
        self.steps += 1;
        if self.steps == self.at {
            match self.fault {
                Fault::Error => return Err(Error::new(ErrorKind::Device, "the motor does not answer")),
                Fault::Observation => observation[1] = f32::INFINITY,
                Fault::LastObservation => (observation[1], step.truncated) = (f32::NAN, true),
                Fault::Reward => step.reward = f64::NAN,
            }
        }
        Ok(step)
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        snapshot.push(self.steps);
        self.inner.save_state(snapshot)
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        self.steps = state.word()?;
        self.inner.load_state(state)
    }
}

fn faulty(id: &str, fault: Fault, at: u64) -> EnvironmentVector {
    let world =
        |at| Box::new(Faulty { inner: make(id).unwrap(), fault, at, steps: 0 }) as Box<dyn Environment>;
    EnvironmentVector::new(vec![world(u64::MAX), world(at)], Autoreset::SameStep, 1).unwrap()
}

/// Every algorithm, with the environment it is created for.
fn learners() -> Vec<(&'static str, Box<dyn Algorithm>)> {
    let (pendulum, cart) = (make("Pendulum-v1").unwrap(), make("CartPole-v1").unwrap());
    let ppo = PpoConfig { n_steps: 8, ..PpoConfig::default() };
    let mut recurrent = ppo.clone();
    recurrent.network.gru_size = Some(4);
    let mut sac = SacConfig::default();
    (sac.off_policy.buffer_size, sac.off_policy.learning_starts) = (100, 10);
    sac.network.net_arch = vec![8];
    let mut td3 = Td3Config { off_policy: sac.off_policy.clone(), ..Td3Config::default() };
    td3.network.net_arch = vec![8];
    let mut dqn = DqnConfig::default();
    (dqn.off_policy.buffer_size, dqn.off_policy.learning_starts) = (100, 10);
    vec![
        ("Pendulum-v1", Box::new(Ppo::new(&ppo, pendulum.spec()).unwrap())),
        ("CartPole-v1", Box::new(Ppo::new(&recurrent, cart.spec()).unwrap())),
        ("Pendulum-v1", Box::new(Sac::new(&sac, pendulum.spec()).unwrap())),
        ("Pendulum-v1", Box::new(Td3::new(&td3, pendulum.spec()).unwrap())),
        ("CartPole-v1", Box::new(Dqn::new(&dqn, cart.spec()).unwrap())),
    ]
}

fn first_error(learner: &mut dyn Algorithm, worlds: &mut dyn VecEnvironment) -> Error {
    (0..40).find_map(|_| learner.iterate(worlds, 1000).err()).unwrap()
}

#[test]
fn faults_are_reported_with_their_step() {
    for (fault, message) in [
        (Fault::Error, "the motor does not answer"),
        (Fault::Observation, "number 1 of observation 1 is inf"),
        (Fault::LastObservation, "is NaN"),
        (Fault::Reward, "the reward of environment 1 is NaN"),
    ] {
        for (id, mut learner) in learners() {
            let mut worlds = faulty(id, fault, 13);
            let error = first_error(&mut *learner, &mut worlds);
            let text = error.to_string();
            assert!(
                text.contains(message) && text.contains("at time step 2"),
                "{} {fault:?}: {text}",
                learner.name()
            );
            let parameters = learner.policy().parameters();
            assert!(parameters.iter().all(|parameter| parameter.is_finite()), "{}", learner.name());
        }
    }
}

/// A training that failed within an iteration resumes from the last checkpoint with the same result.
#[test]
fn checkpoints_survive_an_environment_that_fails() {
    let rounds = learners().into_iter().zip(learners()).zip(learners());
    for (index, (((id, mut broken), (_, mut resumed)), (_, mut whole))) in rounds.enumerate() {
        let folder = Folder::new(&format!("fails-{index}"));
        let mut worlds = faulty(id, Fault::Error, 23);
        while broken.iterate(&mut worlds, 1000).is_ok() {
            broken.save(&folder.checkpoints(), &worlds).unwrap();
        }
        let mut worlds = faulty(id, Fault::Error, u64::MAX);
        resumed.load(&folder.checkpoints(), &mut worlds).unwrap().unwrap();
        assert!(resumed.report().timesteps <= 2 * 22);
        let mut reference = faulty(id, Fault::Error, u64::MAX);
        for (learner, worlds) in [(&mut resumed, &mut worlds), (&mut whole, &mut reference)] {
            while learner.report().timesteps < 80 {
                learner.iterate(worlds, 1000).unwrap();
            }
        }
        let states = [resumed.saved_state(&worlds).unwrap(), whole.saved_state(&reference).unwrap()];
        assert!(states[0] == states[1], "{}", whole.name());
    }
}

#[test]
fn invalid_actions_and_observations_are_refused() {
    let mut worlds = environments("Pendulum-v1", 1, 1);
    let mut ppo = Ppo::new(&PpoConfig { n_steps: 8, ..PpoConfig::default() }, worlds.spec()).unwrap();
    ppo.iterate(&mut *worlds, 1000).unwrap();
    let mut policy: Policy = ppo.policy().clone();
    let (mut memory, mut actions) = (PolicyMemory::default(), [0.0; 1]);
    let mut act = |policy: &Policy, observations: &[f32]| {
        policy.act(&Compute::single(), observations, ActionMode::Deterministic, &mut memory, &mut actions)
    };
    act(&policy, &[1.0, 0.0, 0.5]).unwrap();
    for wrong in [&[1.0, f32::NAN, 0.0][..], &[1.0, 0.0, f32::NEG_INFINITY], &[1.0, 0.0], &[1.0; 4], &[]] {
        assert_eq!(act(&policy, wrong).unwrap_err().kind(), ErrorKind::InvalidInput, "{wrong:?}");
    }
    policy.parameters_mut()[3] = f32::NAN;
    assert_eq!(act(&policy, &[1.0, 0.0, 0.5]).unwrap_err().kind(), ErrorKind::Internal);
    assert_eq!(Policy::from_bytes(&policy.to_bytes().unwrap()).unwrap_err().kind(), ErrorKind::Format);
    ppo.set_policy(&policy).unwrap();
    assert_eq!(ppo.iterate(&mut *worlds, 1000).unwrap_err().kind(), ErrorKind::InvalidInput);
}

#[test]
fn unsupported_spaces_are_refused_at_construction() {
    let space = Space::symmetric(&[1.0]);
    let unbounded = Space::symmetric(&[f32::INFINITY]);
    let kinds = |action: &Space| {
        let spec = EnvironmentSpec::new("test", space.clone(), action.clone());
        [
            Ppo::new(&PpoConfig::default(), &spec).map(drop),
            Sac::new(&SacConfig::default(), &spec).map(drop),
            Td3::new(&Td3Config::default(), &spec).map(drop),
            Dqn::new(&DqnConfig::default(), &spec).map(drop),
        ]
        .map(|outcome| outcome.map_err(|error| error.kind()))
    };
    let no = Err(ErrorKind::Unsupported);
    assert_eq!(kinds(&space), [Ok(()), Ok(()), Ok(()), no]);
    assert_eq!(kinds(&unbounded), [Ok(()), no, no, no]);
    assert_eq!(kinds(&Space::discrete(3)), [Ok(()), no, no, Ok(())]);
    assert_eq!(kinds(&Space::MultiDiscrete(vec![2, 3])), [Ok(()), no, no, no]);
    assert_eq!(kinds(&Space::MultiBinary(vec![3])), [Ok(()), no, no, no]);
    assert_eq!(kinds(&Space::Tuple(vec![space.clone()])), [no; 4]);
    let blind = EnvironmentSpec::new("blind", Space::Tuple(vec![]), space);
    assert_eq!(Ppo::new(&PpoConfig::default(), &blind).map(drop).unwrap_err().kind(), ErrorKind::Unsupported);
}
